//! The arrangement: vertices, halfedges, faces. Topology in indices, geometry in boxes and chains of nodes beside it.

use serde::Deserialize;
use serde::Serialize;

use crate::arrange::complex::Complex;
use crate::arrange::complex::Vertex;
use crate::interval::Interval;

/// An index into [`Arrangement::vertices`], `halfedges`, `edges`, `faces`.
pub type VertexId = u32;
pub type HalfedgeId = u32;
pub type EdgeId = u32;
pub type FaceId = u32;

/// The component of an edge that lies on no curve, of the frame or of a strip.
pub const NO_COMPONENT: u32 = u32::MAX;

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
    /// Everything that is claimed is proved: every vertex is, and there are no clusters and no strips. A sign that is
    /// [`Sign::Unknown`] claims nothing, so it does not count against it.
    pub proved: bool,
    /// The cells from which it was built, for point location and for pictures.
    pub complex: Complex,
    /// The face of each gap between nodes.
    pub gaps: Gaps,
    /// The edge through each node of the complex.
    pub node_edges: Vec<EdgeId>,
    pub milliseconds: f64,
}

/// The stretches of segments between nodes: a segment with n nodes has n + 1, numbered by rising coordinate. No curve meets
/// a gap, so each lies in one face.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Gaps {
    /// The number of each segment's first gap, by segment.
    pub first: Vec<u32>,
    /// The face of each gap.
    pub faces: Vec<FaceId>,
}

impl Gaps {
    /// The face of a segment's gap: gap k lies between its nodes k - 1 and k.
    pub fn face(&self, segment: u32, gap: usize) -> FaceId {
        self.faces[self.first[segment as usize] as usize + gap]
    }
}

/// Where in the complex a vertex is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Site {
    /// Block `block` of cell `cell`.
    Block { cell: u32, block: u32 },
    /// A node: of the frame, or of a closed curve.
    Node(u32),
    /// A corner of the domain.
    Corner,
}

/// A vertex in the structure.
#[derive(Debug, Clone)]
pub struct ArrangedVertex {
    pub vertex: Vertex,
    pub site: Site,
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
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
    /// The component of the fields that it is a part of, or [`NO_COMPONENT`].
    pub component: u32,
    /// The curves that run along it (indices of the scene's shapes), rising; empty for the frame.
    pub curves: Vec<u16>,
    /// Whether it is proved from end to end. What is outside of the areas of its ends always is, so this says that
    /// both its ends are proved and that it is no strip.
    pub proved: bool,
    /// The nodes that it passes, from its origin to its end, and the cells between: `cells.len() == nodes.len() + 1` for an
    /// edge between vertices inside cells; where an end is itself a node (a boundary or loop vertex), that node is the first
    /// or last, with one cell fewer for each such end. A frame edge has the nodes of its ends and the cells along it.
    pub nodes: Vec<u32>,
    pub cells: Vec<u32>,
}

/// The sign of a curve's field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
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
    /// The sign of each curve's field at `sample`, by shape; the same in all of the face where the field is continuous and
    /// its curve has no condition. All unknown until [`crate::arrange::check::signs`] has run.
    pub signs: Vec<Sign>,
    /// A point of the face: of its interior, or of the frame if no segment inside the domain meets the face. `None` for
    /// face 0, and if the face is too thin for a floating-point number.
    pub sample: Option<[f64; 2]>,
}

impl Arrangement {
    /// The other side of the same edge.
    pub fn twin(halfedge: HalfedgeId) -> HalfedgeId {
        halfedge ^ 1
    }

    /// The edge of a halfedge.
    pub fn edge_of(halfedge: HalfedgeId) -> EdgeId {
        halfedge / 2
    }

    /// The vertex at which a halfedge ends.
    pub fn target(&self, halfedge: HalfedgeId) -> VertexId {
        self.halfedges[Self::twin(halfedge) as usize].origin
    }

    /// The halfedges of the cycle of a halfedge, beginning with it.
    pub fn cycle(&self, halfedge: HalfedgeId) -> impl Iterator<Item = HalfedgeId> + '_ {
        self.orbit(halfedge, |h| self.halfedges[h as usize].next)
    }

    /// The halfedges that start at a vertex, counter-clockwise; none at an isolated point.
    pub fn around(&self, vertex: VertexId) -> impl Iterator<Item = HalfedgeId> + '_ {
        let first = self.vertices[vertex as usize].halfedge;
        first.into_iter().flat_map(|first| self.orbit(first, |h| Self::twin(self.halfedges[h as usize].previous)))
    }

    /// What a permutation of the halfedges makes of one until it comes back to it; cut off after all halfedges, so that a
    /// faulty structure ends too.
    fn orbit(&self, first: HalfedgeId, step: impl Fn(HalfedgeId) -> HalfedgeId) -> impl Iterator<Item = HalfedgeId> {
        std::iter::successors(Some(first), move |&h| Some(step(h)).filter(|&h| h != first)).take(self.halfedges.len())
    }
}
