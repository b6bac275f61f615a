//! Areas of faces by Green's theorem.
//!
//! The area of a face is the integral of (x dy - y dx) / 2 along its cycles, which run with the face to their left. Where a
//! stretch is hidden in a cell D, the walk goes around: a simple curve from `a` to `b` on the boundary of D, closed by
//! that boundary from `b` counter-clockwise to `a`, bounds a part of D to its left, whose area lies between 0 and that of D.
//! So the integral along the hidden curve is this area less the integral along the boundary from `b` to `a`.

use std::collections::HashMap;

use crate::arrange::complex::Axis;
use crate::arrange::geometry::arc::Arc;
use crate::arrange::geometry::arc::Body;
use crate::arrange::geometry::arc::Rect;
use crate::arrange::geometry::arc::cross;
use crate::arrange::geometry::refine::Chain;
use crate::arrange::geometry::trace::place;
use crate::arrange::structure::Arrangement;
use crate::arrange::structure::HalfedgeId;
use crate::interval::Interval;

/// A cell's outer boundary as a polygon.
struct Outline {
    corners: Vec<Rect>,
    /// Which corners are nodes.
    nodes: HashMap<u32, usize>,
    area: Interval,
}

/// What does not change when edges are cut: the cycles of all faces.
pub struct Walks {
    origin: [f64; 2],
    domain: Interval,
    faces: Vec<Option<Walk>>,
}

/// The boundary of a face.
struct Walk {
    /// Edges with the face to one side only; `true` to the left.
    edges: Vec<(usize, bool)>,
    /// The part of the integral that does not depend on how edges are cut.
    rest: Interval,
}

/// A face's area, and the edges on which it depends.
pub struct Measure<'a> {
    pub area: Interval,
    pub edges: &'a [(usize, bool)],
}

impl Walks {
    pub fn new(arrangement: &Arrangement, chains: &[Chain]) -> Self {
        let [width, height] = arrangement.domain;
        let origin = [width.mid(), height.mid()];
        let domain = [width, height].map(|side| Interval::point(side.hi()) - Interval::point(side.lo()));
        let mut outlines = HashMap::new();
        let faces =
            (0..arrangement.faces.len()).map(|face| walk(arrangement, chains, face, origin, &mut outlines)).collect();
        Self { origin, domain: domain[0] * domain[1], faces }
    }

    /// Encloses the integral along each edge's stretches that are not hidden.
    pub fn integrals(&self, chains: &[Chain]) -> Vec<Interval> {
        let known = |chain: &Chain| {
            chain.iter().filter_map(|arc| arc.integral(self.origin)).fold(Interval::ZERO, |sum, part| sum + part)
        };
        chains.iter().map(known).collect()
    }

    /// Encloses the areas, by face.
    pub fn measures(&self, integrals: &[Interval]) -> Vec<Option<Measure<'_>>> {
        self.faces.iter().map(|walk| Some(self.measure(walk.as_ref()?, integrals))).collect()
    }

    fn measure<'a>(&self, walk: &'a Walk, integrals: &[Interval]) -> Measure<'a> {
        let signed = walk.edges.iter().map(|&(edge, left)| if left { integrals[edge] } else { -integrals[edge] });
        let area = signed.fold(walk.rest, |sum, part| sum + part);
        Measure { area: area.intersect(Interval::ZERO.hull(self.domain)), edges: &walk.edges }
    }
}

/// The boundary of a face; `None` for the outside, and if a part of it is not known.
fn walk(
    arrangement: &Arrangement,
    chains: &[Chain],
    face: usize,
    origin: [f64; 2],
    outlines: &mut HashMap<u32, Option<Outline>>,
) -> Option<Walk> {
    let (record, mut rest) = (&arrangement.faces[face], Interval::ZERO);
    record.outer?;
    let mut edges = Vec::new();
    for &start in record.outer.iter().chain(&record.holes) {
        let cycle = cycle(arrangement, start)?;
        for &halfedge in &cycle {
            let (edge, left) = (halfedge as usize / 2, halfedge % 2 == 0);
            if chains[edge].is_empty() {
                return None;
            }
            // An edge with the same face to both sides is walked twice, in opposite directions.
            if arrangement.halfedges[halfedge as usize ^ 1].face as usize != face {
                edges.push((edge, left));
            }
        }
        for (cell, [from, to]) in hidden(chains, &cycle)? {
            let outline = outlines.entry(cell).or_insert_with(|| Outline::new(arrangement, cell, origin)).as_ref()?;
            rest = rest + outline.around(from, to, origin)?;
        }
    }
    for &vertex in &record.isolated {
        let vertex = &arrangement.vertices[vertex as usize].vertex;
        if !vertex.proved {
            // Whatever lies there may enclose faces of its own.
            let [width, height] = vertex.area.map(|side| Interval::point(side.width()));
            rest = rest + (-(width * height)).hull(Interval::ZERO);
        }
    }
    Some(Walk { edges, rest })
}

/// The halfedges of a cycle; `None` if it does not close.
fn cycle(arrangement: &Arrangement, start: HalfedgeId) -> Option<Vec<HalfedgeId>> {
    let mut cycle = vec![start];
    loop {
        let next = arrangement.halfedges[*cycle.last()? as usize].next;
        if next == start {
            return Some(cycle);
        }
        if cycle.len() > arrangement.halfedges.len() {
            return None;
        }
        cycle.push(next);
    }
}

/// The hidden parts of a cycle: their cells, and the nodes between which they are walked. Two stretches that meet in a
/// vertex within a cell are one part.
fn hidden(chains: &[Chain], cycle: &[HalfedgeId]) -> Option<Vec<(u32, [u32; 2])>> {
    let mut stretches = Vec::new();
    for &halfedge in cycle {
        let chain = &chains[halfedge as usize / 2];
        let mut push = |arc: &Arc, back: bool| {
            stretches.push(match arc.body {
                Body::Hidden { cell, nodes: [a, b], .. } => Some((cell, if back { [b, a] } else { [a, b] })),
                Body::Graph { .. } => None,
            });
        };
        if halfedge % 2 == 0 {
            chain.iter().for_each(|arc| push(arc, false));
        } else {
            chain.iter().rev().for_each(|arc| push(arc, true));
        }
    }
    let mut parts = Vec::new();
    for (index, stretch) in stretches.iter().enumerate() {
        let Some((cell, [from, to])) = *stretch else { continue };
        match (from, to) {
            (Some(from), Some(to)) => parts.push((cell, [from, to])),
            // The way on from a vertex is looked for where the way there is.
            (None, _) => {
                let before = stretches[(index + stretches.len() - 1) % stretches.len()];
                before.filter(|&(other, nodes)| other == cell && nodes[1].is_none())?;
            }
            (Some(from), None) => {
                let (other, nodes) = stretches[(index + 1) % stretches.len()]?;
                let to = nodes[1].filter(|_| other == cell && nodes[0].is_none())?;
                parts.push((cell, [from, to]));
            }
        }
    }
    Some(parts)
}

impl Outline {
    fn new(arrangement: &Arrangement, cell: u32, origin: [f64; 2]) -> Option<Self> {
        let boundary = arrangement.complex.cells[cell as usize].boundary.first()?;
        let (mut corners, mut nodes) = (Vec::new(), HashMap::new());
        for &(segment, forward) in boundary {
            let segment = &arrangement.complex.segments[segment as usize];
            let start = Interval::point(if forward { segment.from } else { segment.to });
            let at = Interval::point(segment.at);
            corners.push(if segment.axis == Axis::X { [start, at] } else { [at, start] });
            let mut on: Vec<u32> = segment.nodes.clone();
            if !forward {
                on.reverse();
            }
            for node in on {
                nodes.insert(node, corners.len());
                corners.push(place(arrangement, node));
            }
        }
        let sides = corners.iter().zip(corners.iter().cycle().skip(1));
        let area = sides.map(|(a, b)| cross(a, b, origin)).fold(Interval::ZERO, |sum, part| sum + part);
        Some(Self { corners, nodes, area })
    }

    /// The integral along a hidden curve between two nodes.
    fn around(&self, from: u32, to: u32, origin: [f64; 2]) -> Option<Interval> {
        let (from, to) = (*self.nodes.get(&from)?, *self.nodes.get(&to)?);
        if from == to {
            // To a vertex and back.
            return Some(Interval::ZERO);
        }
        let mut boundary = Interval::ZERO;
        let mut corner = to;
        while corner != from {
            let next = (corner + 1) % self.corners.len();
            boundary = boundary + cross(&self.corners[corner], &self.corners[next], origin);
            corner = next;
        }
        Some(Interval::ZERO.hull(self.area) - boundary)
    }
}
