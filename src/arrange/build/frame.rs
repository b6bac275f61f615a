//! The walk along the boundary of the domain.

use crate::arrange::build::incidence::Incidence;
use crate::arrange::check::Fault;
use crate::arrange::check::ensure;
use crate::arrange::complex::Axis;
use crate::arrange::complex::Complex;

/// What one comes past, counter-clockwise from the lower left corner, which is not repeated at the end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// A corner of the domain: 0 lower left, 1 lower right, 2 upper right, 3 upper left.
    Corner(u8),
    /// The start of a segment, with the direction in which it is walked.
    Segment(u32, bool),
    /// A node on it.
    Node(u32),
}

/// Walks along the frame.
///
/// # Errors
/// If its segments do not join into the boundary of the domain.
pub fn walk(complex: &Complex, incidence: &Incidence<'_>) -> Result<Vec<Step>, Fault> {
    let [x, y] = complex.domain;
    let sides = [
        (Axis::X, y.lo(), x.lo(), x.hi()),
        (Axis::Y, x.hi(), y.lo(), y.hi()),
        (Axis::X, y.hi(), x.hi(), x.lo()),
        (Axis::Y, x.lo(), y.hi(), y.lo()),
    ];
    let mut of_sides: [Vec<u32>; 4] = Default::default();
    for (s, segment) in complex.segments.iter().enumerate().filter(|(_, segment)| segment.frame) {
        let side = sides.iter().position(|&(axis, at, ..)| segment.axis == axis && segment.at == at);
        let side = side.ok_or_else(|| Fault(format!("segment {s} is not on the frame")))?;
        of_sides[side].push(s as u32);
    }
    let mut steps = Vec::new();
    for (i, (segments, &(_, _, from, to))) in of_sides.iter_mut().zip(&sides).enumerate() {
        let forward = from < to;
        let get = |s: u32| &complex.segments[s as usize];
        segments.sort_by(|&a, &b| get(a).from.total_cmp(&get(b).from));
        if !forward {
            segments.reverse();
        }
        steps.push(Step::Corner(i as u8));
        let mut reached = from;
        for &s in segments.iter() {
            let segment = get(s);
            let (start, end) = if forward { (segment.from, segment.to) } else { (segment.to, segment.from) };
            ensure(start == reached, || format!("the frame has no segment at {reached:?}"))?;
            let side = usize::from(!forward);
            ensure(incidence.cells[s as usize][side].is_some(), || format!("segment {s} has the domain on its right"))?;
            reached = end;
            steps.push(Step::Segment(s, forward));
            let nodes = &segment.nodes;
            steps.extend((0..nodes.len()).map(|k| Step::Node(nodes[if forward { k } else { nodes.len() - 1 - k }])));
        }
        ensure(reached == to, || format!("the frame ends at {reached:?}"))?;
    }
    Ok(steps)
}
