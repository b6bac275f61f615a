//! Questions about an arrangement: walks, faces by their signs, neighbours, ways from face to face, the nearest vertex.

use std::collections::VecDeque;

use crate::arrange::complex::VertexKind;
use crate::arrange::structure::Arrangement;
use crate::arrange::structure::Edge;
use crate::arrange::structure::EdgeId;
use crate::arrange::structure::EdgeKind;
use crate::arrange::structure::Face;
use crate::arrange::structure::FaceId;
use crate::arrange::structure::HalfedgeId;
use crate::arrange::structure::Sign;
use crate::arrange::structure::VertexId;
use crate::interval::Interval;

/// The nearest vertex.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    pub vertex: VertexId,
    /// Encloses the distance to the nearest vertex, whichever it is.
    pub distance: Interval,
    /// Whether no other vertex can be as near.
    pub unique: bool,
}

impl Arrangement {
    /// The two halfedges of an edge.
    pub fn sides(edge: EdgeId) -> [HalfedgeId; 2] {
        [2 * edge, 2 * edge + 1]
    }

    /// The halfedges of all cycles of a face: the outer one first, then those of its holes.
    pub fn boundary(&self, face: FaceId) -> impl Iterator<Item = HalfedgeId> + '_ {
        let face = &self.faces[face as usize];
        face.outer.iter().chain(&face.holes).flat_map(|&first| self.cycle(first))
    }

    /// The faces of the box whose signs satisfy a condition.
    pub fn faces_where(&self, mut condition: impl FnMut(&[Sign]) -> bool) -> Vec<FaceId> {
        let faces = self.faces.iter().enumerate().skip(1);
        faces.filter(|(_, face)| condition(&face.signs)).map(|(f, _)| f as FaceId).collect()
    }

    /// The dual graph without the frame: edges on the boundary of a face, each with the face behind it, by edge. An edge with
    /// the face on both sides is listed twice.
    pub fn neighbours(&self, face: FaceId) -> Vec<(EdgeId, FaceId)> {
        let crossable = |h: &HalfedgeId| self.edges[Self::edge_of(*h) as usize].kind != EdgeKind::Frame;
        let behind = |h| (Self::edge_of(h), self.halfedges[Self::twin(h) as usize].face);
        let mut all: Vec<_> = self.boundary(face).filter(crossable).map(behind).collect();
        all.sort_unstable();
        all
    }

    /// Whether one can go from a face to another through permitted faces and across permitted edges (never across the frame): the
    /// faces on a way that crosses the fewest edges, both ends included. Both ends must be permitted too.
    pub fn connected(
        &self,
        from: FaceId,
        to: FaceId,
        mut allowed: impl FnMut(&Face) -> bool,
        mut crossable: impl FnMut(&Edge) -> bool,
    ) -> Option<Vec<FaceId>> {
        let mut before: Vec<Option<FaceId>> = vec![None; self.faces.len()];
        if !allowed(self.faces.get(from as usize)?) || self.faces.get(to as usize).is_none() {
            return None;
        }
        before[from as usize] = Some(from);
        let mut queue = VecDeque::from([from]);
        while let Some(face) = queue.pop_front() {
            if face == to {
                let step = |&face: &FaceId| before[face as usize].filter(|&previous| previous != face);
                let mut way: Vec<_> = std::iter::successors(Some(to), step).collect();
                way.reverse();
                return Some(way);
            }
            for (edge, next) in self.neighbours(face) {
                let new = before[next as usize].is_none();
                if new && crossable(&self.edges[edge as usize]) && allowed(&self.faces[next as usize]) {
                    before[next as usize] = Some(face);
                    queue.push_back(next);
                }
            }
        }
        None
    }

    /// The vertex nearest to a point, corners of the frame left aside; `None` if there is none or the point is not finite. If
    /// several may be the nearest, that with the smallest upper bound.
    pub fn nearest_vertex(&self, point: [f64; 2]) -> Option<Nearest> {
        let at = point.map(Interval::point);
        let vertices = self.vertices.iter().enumerate().filter(|(_, v)| v.vertex.kind != VertexKind::Corner);
        let distance = |area: [Interval; 2]| (area[0] - at[0]).hypot(area[1] - at[1]);
        let mut all = vertices.map(|(v, vertex)| (v as VertexId, distance(vertex.vertex.area)));
        let first = all.next().filter(|(_, distance)| !distance.is_empty())?;
        let (mut best, mut lowest, mut second) = (first, first.1.lo(), f64::INFINITY);
        for next in all {
            lowest = lowest.min(next.1.lo());
            let (better, worse) = if next.1.hi() < best.1.hi() { (next, best) } else { (best, next) };
            (best, second) = (better, second.min(worse.1.lo()));
        }
        // Of all others none is below `second`.
        let distance = Interval::new(lowest, best.1.hi())?;
        Some(Nearest { vertex: best.0, distance, unique: second > best.1.hi() })
    }
}
