//! An arrangement in files: pictures (SVG, PNG), data (JSON, GeoJSON) and the graph (DOT).

mod canvas;
pub mod dot;
pub mod drawing;
pub mod geojson;
pub mod json;
mod letters;
mod paint;
pub mod picture;
pub mod png;
pub mod regions;
mod rings;
pub mod svg;

use crate::arrange::check::Kinds;
use crate::arrange::check::Summary;
use crate::arrange::complex::VertexKind;
use crate::arrange::structure::Arrangement;
use crate::arrange::structure::VertexId;
use crate::interval::Interval;

pub use canvas::Style;

/// The kinds of vertices with how many there are.
pub fn kinds(kinds: &Kinds) -> [(VertexKind, u64); 7] {
    [
        (VertexKind::Crossing, kinds.crossing),
        (VertexKind::Tangency, kinds.tangency),
        (VertexKind::Singular, kinds.singular),
        (VertexKind::End, kinds.end),
        (VertexKind::Boundary, kinds.boundary),
        (VertexKind::Loop, kinds.closed),
        (VertexKind::Cluster, kinds.cluster),
    ]
}

/// The name of a kind of vertex.
pub fn kind(kind: VertexKind) -> &'static str {
    match kind {
        VertexKind::Crossing => "crossing",
        VertexKind::Tangency => "tangency",
        VertexKind::Singular => "singular",
        VertexKind::End => "end",
        VertexKind::Boundary => "boundary",
        VertexKind::Loop => "loop",
        VertexKind::Cluster => "cluster",
        VertexKind::Corner => "corner",
    }
}

/// An arrangement with the geometry that its files show.
#[derive(Debug, Clone, Copy)]
pub struct Traced<'a> {
    pub arrangement: &'a Arrangement,
    pub summary: &'a Summary,
    /// By edge, in the direction of its even halfedge: points from its origin to its end, both included.
    pub lines: &'a [Vec<[f64; 2]>],
    /// Enclosures of the faces' areas, by face, where they are known; empty if none was asked for.
    pub areas: &'a [Option<Interval>],
}

impl Traced<'_> {
    /// Where a vertex is drawn: the middle of its enclosure.
    fn place(&self, vertex: VertexId) -> [f64; 2] {
        self.arrangement.vertices[vertex as usize].vertex.area.map(Interval::mid)
    }

    /// The names of curves, as in `circle, line`.
    fn names(&self, curves: &[u16]) -> String {
        let names: Vec<&str> =
            curves.iter().map(|&curve| self.arrangement.curves[usize::from(curve)].as_str()).collect();
        names.join(", ")
    }

    /// Where an even halfedge `2e` starts and where it ends.
    fn ends(&self, edge: usize) -> [VertexId; 2] {
        [2 * edge, 2 * edge + 1].map(|halfedge| self.arrangement.halfedges[halfedge].origin)
    }
}

#[cfg(test)]
mod samples;
