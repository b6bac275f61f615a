//! The arrangement: vertices, halfedges, faces. Topology in indices, geometry in boxes and chains of nodes beside it.

use serde::Serialize;

use crate::arrange::complex::Complex;
use crate::arrange::complex::Vertex;
use crate::interval::Interval;

/// An index into [`Arrangement::vertices`], `halfedges`, `faces`.
pub type VertexId = u32;
pub type HalfedgeId = u32;
pub type FaceId = u32;

/// The subdivision of the domain that the curves induce. Halfedges `2e` and `2e + 1` are the two sides of edge `e`. The frame
/// (the domain's boundary with its corners) takes part in the topology and is left out of all counts.
#[derive(Debug, Clone)]
pub struct Arrangement {
    pub domain: [Interval; 2],
    /// Names of the scene's curves, by shape.
    pub curves: Vec<String>,
    pub vertices: Vec<ArrangedVertex>,
    pub halfedges: Vec<Halfedge>,
    pub edges: Vec<Edge>,
    /// Face 0 is the outside of the domain.
    pub faces: Vec<Face>,
    /// Everything that is claimed is proved: no clusters, no strips, every sign known.
    pub proved: bool,
    /// The cells from which it was built, for point location and for pictures.
    pub complex: Complex,
    pub milliseconds: f64,
}

/// A vertex in the structure.
#[derive(Debug, Clone)]
pub struct ArrangedVertex {
    pub vertex: Vertex,
    /// One halfedge that starts here; `None` for an isolated point.
    pub halfedge: Option<HalfedgeId>,
    /// The face around an isolated point.
    pub face: Option<FaceId>,
}

/// One side of an edge, with its face to the left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Halfedge {
    pub origin: VertexId,
    /// The next one around the face, counter-clockwise on an outer cycle.
    pub next: HalfedgeId,
    pub previous: HalfedgeId,
    pub face: FaceId,
}

/// What an edge is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum EdgeKind {
    /// An arc of curves.
    Curve,
    /// A part of the domain's boundary.
    Frame,
    /// The way around a hole of an unresolved region: nothing is proved of it.
    Strip,
}

/// An edge, in the direction of its even halfedge.
#[derive(Debug, Clone)]
pub struct Edge {
    pub kind: EdgeKind,
    pub component: u32,
    /// The curves that run along it (indices of the scene's shapes), rising; empty for the frame.
    pub curves: Vec<u16>,
    pub proved: bool,
    /// The nodes that it passes, from its origin to its end, and the cells between: `cells.len() == nodes.len() + 1` for an
    /// edge between vertices inside cells; at a boundary vertex the node itself is the first or last.
    pub nodes: Vec<u32>,
    pub cells: Vec<u32>,
}

/// The sign of a curve's field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Sign {
    Negative,
    Positive,
    /// Undefined there, or not decided.
    Unknown,
}

/// A face.
#[derive(Debug, Clone)]
pub struct Face {
    /// A halfedge of the outer cycle; `None` for face 0.
    pub outer: Option<HalfedgeId>,
    /// One halfedge of each cycle inside.
    pub holes: Vec<HalfedgeId>,
    /// Isolated vertices in it.
    pub isolated: Vec<VertexId>,
    /// Whether the frame is no part of its boundary.
    pub bounded: bool,
    /// The sign of each curve's field, by shape.
    pub signs: Vec<Sign>,
    /// A point of its interior; `None` for face 0.
    pub sample: Option<[f64; 2]>,
}
