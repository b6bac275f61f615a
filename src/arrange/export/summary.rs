//! What an arrangement consists of, in numbers.

use serde::Serialize;

use crate::arrange::complex::VertexKind;
use crate::arrange::structure::Arrangement;
use crate::arrange::structure::EdgeKind;

/// Vertices by kind; corners of the domain are not counted.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Vertices {
    pub crossing: usize,
    pub tangency: usize,
    pub singular: usize,
    pub end: usize,
    pub boundary: usize,
    #[serde(rename = "loop")]
    pub closed: usize,
    pub cluster: usize,
}

impl Vertices {
    /// The kinds with their names and counts.
    pub fn rows(&self) -> [(VertexKind, &'static str, usize); 7] {
        [
            (VertexKind::Crossing, "crossing", self.crossing),
            (VertexKind::Tangency, "tangency", self.tangency),
            (VertexKind::Singular, "singular", self.singular),
            (VertexKind::End, "end", self.end),
            (VertexKind::Boundary, "boundary", self.boundary),
            (VertexKind::Loop, "loop", self.closed),
            (VertexKind::Cluster, "cluster", self.cluster),
        ]
    }

    pub fn total(&self) -> usize {
        self.rows().iter().map(|&(_, _, count)| count).sum()
    }
}

/// The line that `imp arrange --json` prints.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Summary {
    pub vertices: Vertices,
    /// Without those of the frame.
    pub edges: usize,
    /// Without the outside of the domain.
    pub faces: usize,
    /// Whether everything that is claimed is proved.
    pub proved: bool,
    /// Nodes of the quadtree.
    pub boxes: u64,
    pub ms: f64,
}

impl Summary {
    pub fn new(arrangement: &Arrangement) -> Self {
        let mut vertices = Vertices::default();
        for vertex in &arrangement.vertices {
            match vertex.vertex.kind {
                VertexKind::Crossing => vertices.crossing += 1,
                VertexKind::Tangency => vertices.tangency += 1,
                VertexKind::Singular => vertices.singular += 1,
                VertexKind::End => vertices.end += 1,
                VertexKind::Boundary => vertices.boundary += 1,
                VertexKind::Loop => vertices.closed += 1,
                VertexKind::Cluster => vertices.cluster += 1,
                VertexKind::Corner => {}
            }
        }
        Self {
            vertices,
            edges: arrangement.edges.iter().filter(|edge| edge.kind != EdgeKind::Frame).count(),
            faces: arrangement.faces.len().saturating_sub(1),
            proved: arrangement.proved,
            boxes: arrangement.complex.effort.boxes,
            ms: arrangement.milliseconds,
        }
    }
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
