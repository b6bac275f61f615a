//! Faces: which cycle of halfedges is the outer one of its face and which are holes, decided without coordinates.
//!
//! A connected component of the graph lies in one face of the rest, so exactly one of its cycles goes around it from outside and
//! is a hole there; its other cycles are the outer ones of their faces. The frame lies in the outside, so its inner cycles
//! are outer ones. Wherever another component has a cycle in a face already known, that cycle is a hole, and all the others of
//! this component make new faces known; so all are found.

use crate::arrange::build::incidence::Incidence;
use crate::arrange::build::union::Classes;
use crate::arrange::check::Fault;
use crate::arrange::check::ensure;
use crate::arrange::complex::Axis;
use crate::arrange::complex::Complex;
use crate::arrange::structure::ArrangedVertex;
use crate::arrange::structure::Edge;
use crate::arrange::structure::EdgeKind;
use crate::arrange::structure::Face;
use crate::arrange::structure::FaceId;
use crate::arrange::structure::Halfedge;
use crate::arrange::structure::HalfedgeId;
use crate::arrange::structure::Sign;
use crate::arrange::structure::Site;

/// A cycle of halfedges.
struct Cycle {
    first: HalfedgeId,
    face: FaceId,
    /// The smallest vertex of its connected component.
    component: u32,
    /// Whether a part of the frame belongs to it.
    frame: bool,
}

/// All faces; isolated vertices get theirs.
///
/// # Errors
/// If cycles and faces do not fit.
pub fn faces(
    complex: &Complex,
    incidence: &Incidence<'_>,
    vertices: &mut [ArrangedVertex],
    halfedges: &[Halfedge],
    edges: &[Edge],
) -> Result<Vec<Face>, Fault> {
    let count = incidence.faces.iter().copied().max().unwrap_or(0) as usize + 1;
    let unknown = vec![Sign::Unknown; complex.curves.len()];
    let empty =
        Face { outer: None, holes: Vec::new(), isolated: Vec::new(), bounded: true, signs: unknown, sample: None };
    let mut faces = vec![empty; count];
    nest(&cycles(vertices.len(), halfedges, edges)?, &mut faces)?;
    for (v, vertex) in vertices.iter_mut().enumerate() {
        let (Site::Block { cell, .. }, None) = (vertex.site, vertex.halfedge) else { continue };
        let face = face_of_cell(complex, incidence, cell);
        vertex.face = Some(face);
        faces[face as usize].isolated.push(v as u32);
    }
    for (face, sample) in faces.iter_mut().zip(samples(complex, incidence, count)) {
        face.sample = sample;
    }
    Ok(faces)
}

/// The face at the start of a cell's boundary: the only one if the cell has no nodes.
fn face_of_cell(complex: &Complex, incidence: &Incidence<'_>, cell: u32) -> FaceId {
    let (segment, forward) = complex.cells[cell as usize].boundary[0][0];
    incidence.start(segment, forward)
}

/// All cycles, by their first halfedges.
fn cycles(vertices: usize, halfedges: &[Halfedge], edges: &[Edge]) -> Result<Vec<Cycle>, Fault> {
    let mut components = Classes::new(vertices);
    for sides in halfedges.chunks_exact(2) {
        components.unite(sides[0].origin, sides[1].origin);
    }
    let mut seen = vec![false; halfedges.len()];
    let mut cycles = Vec::new();
    for first in 0..halfedges.len() {
        let (mut h, mut frame) = (first, false);
        while !seen[h] {
            seen[h] = true;
            frame |= edges[h / 2].kind == EdgeKind::Frame;
            let (next, face) = (halfedges[h].next as usize, halfedges[h].face);
            ensure(halfedges[next].face == face, || format!("halfedges {h} and {next} have different faces"))?;
            h = next;
            if h == first {
                let component = components.find(halfedges[first].origin);
                cycles.push(Cycle { first: first as HalfedgeId, face, component, frame });
            }
        }
    }
    Ok(cycles)
}

/// Gives every cycle to its face, as the outer one or as a hole.
fn nest(cycles: &[Cycle], faces: &mut [Face]) -> Result<(), Fault> {
    let vertices = cycles.iter().map(|cycle| cycle.component as usize + 1).max().unwrap_or(0);
    let (mut of_component, mut of_face) = (vec![Vec::new(); vertices], vec![Vec::new(); faces.len()]);
    for (c, cycle) in cycles.iter().enumerate() {
        of_component[cycle.component as usize].push(c);
        of_face[cycle.face as usize].push(c);
    }
    let mut known = vec![false; vertices];
    let mut queue = std::collections::VecDeque::from([0]);
    faces[0].bounded = false;
    while let Some(face) = queue.pop_front() {
        for &hole in &of_face[face] {
            let hole: &Cycle = &cycles[hole];
            if faces[face].outer == Some(hole.first) {
                continue;
            }
            ensure(!known[hole.component as usize], || format!("two cycles of one component are in face {face}"))?;
            known[hole.component as usize] = true;
            faces[face].holes.push(hole.first);
            for cycle in of_component[hole.component as usize].iter().map(|&c| &cycles[c]) {
                if cycle.first == hole.first {
                    continue;
                }
                let inner = &mut faces[cycle.face as usize];
                let new = inner.outer.is_none() && cycle.face != 0;
                ensure(new, || format!("face {} has two outer cycles", cycle.face))?;
                inner.outer = Some(cycle.first);
                inner.bounded = !cycle.frame;
                queue.push_back(cycle.face as usize);
            }
        }
    }
    let lost = faces.iter().skip(1).position(|face| face.outer.is_none());
    ensure(lost.is_none(), || format!("a face has no outer cycle: {lost:?} after the outside"))?;
    ensure(cycles.iter().all(|cycle| known[cycle.component as usize]), || "a component lies in no face".to_owned())
}

/// A point of each face: the centre of its widest cell that no curve enters, or the middle of its widest gap, whichever has more
/// room. Gaps of the frame count only for faces that have nothing else.
fn samples(complex: &Complex, incidence: &Incidence<'_>, count: usize) -> Vec<Option<[f64; 2]>> {
    // Whether inside the domain, then the width.
    let mut best = vec![((false, 0.0), None); count];
    let mut offer = |face: FaceId, worth: (bool, f64), point: [f64; 2]| {
        let best = &mut best[face as usize];
        if worth > best.0 {
            *best = (worth, Some(point));
        }
    };
    for (c, cell) in complex.cells.iter().enumerate() {
        let ([sides], true) = (&cell.boxes[..], cell.blocks.is_empty()) else { continue };
        if let [Some(x), Some(y)] = sides.map(|side| middle(side.lo(), side.hi())) {
            let [width, height] = sides.map(|side| side.hi() - side.lo());
            offer(face_of_cell(complex, incidence, c as u32), (true, width.min(height)), [x, y]);
        }
    }
    for (segment, &first) in complex.segments.iter().zip(&incidence.first) {
        for k in 0..=segment.nodes.len() {
            let place = |k: usize| complex.nodes[segment.nodes[k] as usize].place;
            let from = if k == 0 { segment.from } else { place(k - 1).hi() };
            let to = if k == segment.nodes.len() { segment.to } else { place(k).lo() };
            let Some(middle) = middle(from, to) else { continue };
            let point = match segment.axis {
                Axis::X => [middle, segment.at],
                Axis::Y => [segment.at, middle],
            };
            offer(incidence.faces[first as usize + k], (!segment.frame, to - from), point);
        }
    }
    best.into_iter().map(|(_, point)| point).collect()
}

/// A number about half way and strictly between.
fn middle(from: f64, to: f64) -> Option<f64> {
    let middle = f64::midpoint(from, to);
    (from < middle && middle < to).then_some(middle)
}
