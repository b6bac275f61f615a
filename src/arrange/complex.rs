//! What subdivision leaves: cells that tile the domain, the segments between them, the nodes where curves cross segments,
//! and how nodes are joined within each cell. All of the topology is in here, none of it in coordinates.
//!
//! Invariants. Cells cover the domain and overlap only in their boundaries. No curve passes through an end of a segment.
//! Along a segment the nodes are in rising order and at different places; at each of them exactly one curve crosses. The
//! blocks of a cell partition the nodes on its boundary and do not cross each other: in the cyclic order of the boundary no
//! two blocks alternate.

use serde::Deserialize;
use serde::Serialize;

use crate::interval::Interval;

/// The direction of a segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Axis {
    /// Along x, at a fixed y.
    X,
    /// Along y, at a fixed x.
    Y,
}

/// A stretch of the boundary between two cells, or between a cell and the outside: as long as both sides stay the same.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment {
    pub axis: Axis,
    /// The fixed coordinate.
    pub at: f64,
    /// The ends of the other coordinate, `from < to`.
    pub from: f64,
    pub to: f64,
    /// Nodes on it, by rising coordinate.
    pub nodes: Vec<u32>,
    /// On the boundary of the domain: only one cell has it.
    pub frame: bool,
}

/// Where a curve crosses a segment, transversally and proved.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    pub segment: u32,
    /// Encloses the coordinate along the segment; disjoint from those of the segment's other nodes.
    pub place: Interval,
    /// The component of [`crate::arrange::field::Fields`] that crosses.
    pub component: u32,
    /// The curves (indices of the scene's shapes) that the component belongs to here, rising; never empty.
    pub curves: Vec<u16>,
}

/// A cell: one box, or the union of connected boxes that stayed open.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    pub boxes: Vec<[Interval; 2]>,
    /// Cycles of segments with the cell to their left: the outer boundary first, counter-clockwise, then one clockwise
    /// cycle for each hole (clusters only). `true`: the segment is walked from `from` to `to`.
    pub boundary: Vec<Vec<(u32, bool)>>,
    pub blocks: Vec<Block>,
}

/// Nodes of a cell that are joined inside it.
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    /// In the order of the cell's boundary.
    pub nodes: Vec<u32>,
    /// The vertex in which the arms of all nodes meet; `None` if the block is an arc from one node to the other of the same
    /// component, and then there are exactly two.
    pub vertex: Option<Vertex>,
    /// For an arc: the coordinate of which the curve is a function in this cell (`Axis::X`: y is a function of x).
    pub axis: Option<Axis>,
}

/// A point where something happens.
#[derive(Debug, Clone, PartialEq)]
pub struct Vertex {
    pub kind: VertexKind,
    /// Encloses it.
    pub area: [Interval; 2],
    /// Whether the kind, and that there is exactly one such point with just these arms, is proved.
    pub proved: bool,
    /// The curves through it (indices of the scene's shapes), rising.
    pub curves: Vec<u16>,
    /// What is known otherwise, for people.
    pub note: Option<String>,
}

/// Kinds of vertices. `Corner` belongs to the frame and is not counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum VertexKind {
    /// Different curves cross.
    Crossing,
    /// Different curves touch.
    Tangency,
    /// A singular point of a curve, an isolated point among them.
    Singular,
    /// A curve ends where its condition does.
    End,
    /// A curve meets the boundary of the domain.
    Boundary,
    /// A point chosen on a closed curve that meets nothing.
    Loop,
    /// An unresolved region, taken as one vertex.
    Cluster,
    /// A corner of the domain.
    Corner,
}

/// The cell complex of an arrangement.
#[derive(Debug, Clone, PartialEq)]
pub struct Complex {
    pub domain: [Interval; 2],
    /// Names of the scene's curves, by shape.
    pub curves: Vec<String>,
    pub segments: Vec<Segment>,
    pub nodes: Vec<Node>,
    pub cells: Vec<Cell>,
    /// What the solver did.
    pub effort: Effort,
}

/// What an arrangement took.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Effort {
    /// Nodes of the quadtree, inner ones included.
    pub boxes: u64,
    /// Enclosures evaluated.
    pub evaluations: u64,
    /// Clusters handed to exact arithmetic, and how many of them it settled.
    pub exact: u64,
    pub settled: u64,
}
