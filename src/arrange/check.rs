//! Whether an arrangement hangs together, by Euler's formula among others, and what it has of what.

use std::collections::BTreeMap;
use std::fmt;

use serde::Serialize;

use crate::arrange::build::union::Classes;
use crate::arrange::complex::VertexKind;
use crate::arrange::field::Fields;
use crate::arrange::structure::Arrangement;
use crate::arrange::structure::EdgeKind;
use crate::arrange::structure::Sign;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::interval::Interval;
use crate::kernel::verdict;

/// What is wrong with a complex or an arrangement: always a fault of Imp.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault(pub String);

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the arrangement is inconsistent: {}", self.0)
    }
}

impl std::error::Error for Fault {}

impl From<Fault> for Diagnostic {
    fn from(fault: Fault) -> Self {
        Diagnostic::error(code::INTERNAL, fault.to_string())
    }
}

/// An error unless a condition holds.
pub(super) fn ensure(holds: bool, what: impl FnOnce() -> String) -> Result<(), Fault> {
    if holds { Ok(()) } else { Err(Fault(what())) }
}

/// Vertices by kind, without the corners of the frame.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Kinds {
    pub crossing: u64,
    pub tangency: u64,
    pub singular: u64,
    pub end: u64,
    pub boundary: u64,
    #[serde(rename = "loop")]
    pub closed: u64,
    pub cluster: u64,
}

/// What an arrangement has of what. The frame is left out, the outside too.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    pub vertices: Kinds,
    /// Edges of curves, and strips.
    pub edges: u64,
    /// Cells of the box.
    pub faces: u64,
    /// Whether everything that is claimed is proved.
    pub proved: bool,
    /// Connected components of the curves, isolated points among them. The frame connects nothing.
    pub components: u64,
    /// Vertices without edges.
    pub isolated: u64,
    /// Vertices inside the domain by the number of arms, except those with two: what does not depend on how arcs are split.
    pub degrees: BTreeMap<u32, u64>,
}

/// The summary that `imp arrange --json` prints.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    pub vertices: Kinds,
    pub edges: u64,
    pub faces: u64,
    pub proved: bool,
    /// Nodes of the quadtree, inner ones included.
    pub boxes: u64,
    pub ms: f64,
}

impl Summary {
    /// The summary of an arrangement with these counts.
    pub fn new(arrangement: &Arrangement, counts: &Counts) -> Self {
        Self {
            vertices: counts.vertices,
            edges: counts.edges,
            faces: counts.faces,
            proved: counts.proved,
            boxes: arrangement.complex.effort.boxes,
            ms: arrangement.milliseconds,
        }
    }
}

/// Checks an arrangement: next and previous are inverse and fit at the vertices; all of a cycle has one face; around each
/// vertex lie all the halfedges that start there; each cycle is the outer one or a hole of its face, each face but the
/// outside has exactly one outer one; every connected component has V - E + cycles = 2, and all together V - E + F = 1 + C,
/// with frame, outside and isolated points.
///
/// # Errors
/// The first fault found.
pub fn check(arrangement: &Arrangement) -> Result<Counts, Fault> {
    links(arrangement)?;
    rotations(arrangement)?;
    let cycles = faces(arrangement)?;
    euler(arrangement, &cycles)?;
    Ok(counts(arrangement))
}

fn links(arrangement: &Arrangement) -> Result<(), Fault> {
    let (halves, vertices) = (arrangement.halfedges.len(), arrangement.vertices.len());
    ensure(halves == 2 * arrangement.edges.len(), || format!("{halves} sides of {} edges", arrangement.edges.len()))?;
    for (h, half) in arrangement.halfedges.iter().enumerate() {
        let inside = (half.next as usize) < halves
            && (half.previous as usize) < halves
            && (half.origin as usize) < vertices
            && (half.face as usize) < arrangement.faces.len();
        ensure(inside, || format!("halfedge {h} names something that does not exist"))?;
    }
    for (h, half) in arrangement.halfedges.iter().enumerate() {
        let next = arrangement.halfedges[half.next as usize];
        ensure(next.previous as usize == h, || format!("halfedge {h} is not the previous one of its next one"))?;
        ensure(next.origin == arrangement.target(h as u32), || {
            format!("halfedge {h} does not end where the next starts")
        })?;
        ensure(next.face == half.face, || format!("halfedge {h} and the next one have different faces"))?;
    }
    Ok(())
}

fn rotations(arrangement: &Arrangement) -> Result<(), Fault> {
    let mut seen = 0;
    for (v, vertex) in arrangement.vertices.iter().enumerate() {
        ensure(vertex.halfedge.is_some() != vertex.face.is_some(), || {
            format!("vertex {v} is neither isolated nor not")
        })?;
        let first = vertex.halfedge.map_or(0, |h| h as usize);
        ensure(vertex.halfedge.is_none() || first < arrangement.halfedges.len(), || {
            format!("vertex {v} has no halfedge")
        })?;
        for h in arrangement.around(v as u32) {
            let origin = arrangement.halfedges[h as usize].origin as usize;
            ensure(origin == v, || format!("halfedge {h} is around vertex {v} and starts at {origin}"))?;
            seen += 1;
        }
    }
    // Every orbit has but halfedges of its own vertex, so the sum says that each vertex has one orbit with all of them.
    ensure(seen == arrangement.halfedges.len(), || format!("{seen} of all halfedges are around vertices"))
}

/// The number of cycles that each connected component has, by the smallest vertex of the component.
fn faces(arrangement: &Arrangement) -> Result<BTreeMap<u32, u64>, Fault> {
    let mut components = components(arrangement, |_| true);
    let mut cycles: BTreeMap<u32, u64> = BTreeMap::new();
    let mut face_of = vec![None; arrangement.halfedges.len()];
    for (f, face) in arrangement.faces.iter().enumerate() {
        ensure(face.outer.is_none() == (f == 0), || {
            format!("face {f} should have an outer cycle, and only face 0 not")
        })?;
        for &first in face.outer.iter().chain(&face.holes) {
            ensure((first as usize) < face_of.len(), || format!("face {f} names halfedge {first}"))?;
            ensure(face_of[first as usize].is_none(), || format!("the cycle of halfedge {first} is named twice"))?;
            for h in arrangement.cycle(first) {
                face_of[h as usize] = Some(f);
            }
            *cycles.entry(components.find(arrangement.halfedges[first as usize].origin)).or_default() += 1;
        }
        for &v in &face.isolated {
            let known = arrangement.vertices.get(v as usize).and_then(|vertex| vertex.face);
            ensure(known == Some(f as u32), || format!("face {f} and its isolated vertex {v} disagree"))?;
        }
    }
    for (h, half) in arrangement.halfedges.iter().enumerate() {
        ensure(face_of[h] == Some(half.face as usize), || format!("the cycle of halfedge {h} is none of its face"))?;
    }
    let isolated: usize = arrangement.faces.iter().map(|face| face.isolated.len()).sum();
    let expected = arrangement.vertices.iter().filter(|v| v.face.is_some()).count();
    ensure(isolated == expected, || format!("{isolated} isolated vertices in faces, {expected} in all"))?;
    Ok(cycles)
}

/// The classes of vertices that certain edges connect.
fn components(arrangement: &Arrangement, connects: impl Fn(EdgeKind) -> bool) -> Classes {
    let mut classes = Classes::new(arrangement.vertices.len());
    for (edge, halves) in arrangement.edges.iter().zip(arrangement.halfedges.chunks_exact(2)) {
        if connects(edge.kind) {
            classes.unite(halves[0].origin, halves[1].origin);
        }
    }
    classes
}

fn euler(arrangement: &Arrangement, cycles: &BTreeMap<u32, u64>) -> Result<(), Fault> {
    let mut classes = components(arrangement, |_| true);
    let mut excess: BTreeMap<u32, i64> = BTreeMap::new();
    for v in 0..arrangement.vertices.len() as u32 {
        *excess.entry(classes.find(v)).or_default() += 1;
    }
    for halves in arrangement.halfedges.chunks_exact(2) {
        *excess.entry(classes.find(halves[0].origin)).or_default() -= 1;
    }
    for (component, excess) in &excess {
        // An isolated point is in its face, without a cycle.
        let cycles = cycles.get(component).map_or(1, |&n| n as i64);
        ensure(excess + cycles == 2, || format!("the component of vertex {component} is not plane"))?;
    }
    let [v, e, f] = [arrangement.vertices.len(), arrangement.edges.len(), arrangement.faces.len()];
    let c = excess.len();
    ensure(v + f == 1 + c + e, || format!("V = {v}, E = {e}, F = {f}, C = {c}: V - E + F is not 1 + C"))
}

fn counts(arrangement: &Arrangement) -> Counts {
    let mut classes = components(arrangement, |kind| kind != EdgeKind::Frame);
    let mut counts = Counts {
        edges: arrangement.edges.iter().filter(|edge| edge.kind != EdgeKind::Frame).count() as u64,
        faces: arrangement.faces.len().saturating_sub(1) as u64,
        proved: arrangement.proved,
        ..Counts::default()
    };
    let mut roots: Vec<u32> = Vec::new();
    for (v, vertex) in arrangement.vertices.iter().enumerate() {
        let kinds = &mut counts.vertices;
        let count = match vertex.vertex.kind {
            VertexKind::Crossing => &mut kinds.crossing,
            VertexKind::Tangency => &mut kinds.tangency,
            VertexKind::Singular => &mut kinds.singular,
            VertexKind::End => &mut kinds.end,
            VertexKind::Boundary => &mut kinds.boundary,
            VertexKind::Loop => &mut kinds.closed,
            VertexKind::Cluster => &mut kinds.cluster,
            VertexKind::Corner => continue,
        };
        *count += 1;
        roots.push(classes.find(v as u32));
        let degree = arrangement.around(v as u32).count() as u32;
        counts.isolated += u64::from(degree == 0);
        if degree != 2 && vertex.vertex.kind != VertexKind::Boundary {
            *counts.degrees.entry(degree).or_default() += 1;
        }
    }
    roots.sort_unstable();
    roots.dedup();
    counts.components = roots.len() as u64;
    counts
}

/// Fills in the signs of the curves' fields at the sample points of all faces: one batch of evaluations.
pub fn signs(arrangement: &mut Arrangement, fields: &Fields) {
    let faces = arrangement.faces.iter_mut().filter_map(|face| face.sample.map(|sample| (face, sample)));
    let (mut faces, samples): (Vec<_>, Vec<_>) = faces.unzip();
    let queries: Vec<_> = samples
        .iter()
        .flat_map(|sample| fields.shapes.iter().map(move |&shape| (shape, sample.map(Interval::point))))
        .collect();
    let bits: Vec<u32> = fields.evaluate(&queries).iter().map(|sample| sample.bits).collect();
    if fields.shapes.is_empty() {
        return;
    }
    for (face, bits) in faces.iter_mut().zip(bits.chunks_exact(fields.shapes.len())) {
        face.signs = bits.iter().map(|&bits| sign(bits)).collect();
    }
}

/// The sign that verdict bits at a point prove. A value that may be undefined there has none.
fn sign(bits: u32) -> Sign {
    match (bits & verdict::CONTINUOUS != 0, bits & (verdict::POSITIVE | verdict::NEGATIVE)) {
        (true, verdict::POSITIVE) => Sign::Positive,
        (true, verdict::NEGATIVE) => Sign::Negative,
        _ => Sign::Unknown,
    }
}
