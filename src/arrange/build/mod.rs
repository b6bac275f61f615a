//! From the cell complex to vertices, halfedges and faces. No coordinate decides anything inside the domain: vertices and
//! edges follow the blocks, faces are classes of gaps between nodes, and the order around a vertex is that of the nodes on
//! its cell's boundary.

mod faces;
mod frame;
mod graph;
mod incidence;
#[cfg(test)]
mod tests;
#[cfg(test)]
pub(super) mod toy;
pub(super) mod union;

use crate::arrange::build::graph::Graph;
use crate::arrange::build::incidence::Incidence;
use crate::arrange::check;
use crate::arrange::check::Fault;
use crate::arrange::complex::Complex;
use crate::arrange::complex::VertexKind;
use crate::arrange::structure::Arrangement;
use crate::arrange::structure::EdgeKind;
use crate::arrange::structure::Gaps;

/// Builds the arrangement that a complex describes, and checks it. Signs and time are left for the caller to fill in.
/// Everything is numbered in an order that depends on the complex alone: vertices by cell, then along the frame from the
/// lower left corner, then on closed curves; edges of curves before strips before the frame; faces by their first gap.
///
/// # Errors
/// If the complex breaks its invariants, or the result does not pass [`check::check`].
pub fn build(complex: Complex) -> Result<Arrangement, Fault> {
    let incidence = Incidence::new(&complex)?;
    let mut graph = Graph::new(&complex, &incidence)?;
    let halfedges = graph.halfedges()?;
    let faces = faces::faces(&complex, &incidence, &mut graph.vertices, &halfedges, &graph.edges)?;
    let Graph { vertices, edges, node_edges, .. } = graph;
    let gaps = Gaps { first: incidence.first, faces: incidence.faces };
    let proved = vertices.iter().all(|v| v.vertex.proved && v.vertex.kind != VertexKind::Cluster)
        && edges.iter().all(|edge| edge.kind != EdgeKind::Strip);
    let arrangement = Arrangement {
        domain: complex.domain,
        curves: complex.curves.clone(),
        vertices,
        halfedges,
        edges,
        faces,
        proved,
        complex,
        gaps,
        node_edges,
        milliseconds: 0.0,
    };
    check::check(&arrangement)?;
    Ok(arrangement)
}
