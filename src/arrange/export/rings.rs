//! The boundaries of faces as simple closed polygons, as pictures and GeoJSON want them.

use std::collections::HashMap;

use crate::arrange::export::Traced;
use crate::arrange::structure::HalfedgeId;
use crate::arrange::structure::VertexId;

/// A closed polygon; the first point is not repeated.
pub type Ring = Vec<[f64; 2]>;

impl Traced<'_> {
    /// The boundary of each face: the outer ring first, counter-clockwise, then the holes, clockwise. Edges with the same
    /// face on both sides bound nothing and are left out; where a cycle touches itself it is cut, so that no ring passes a
    /// vertex twice. Face 0 has none.
    pub(super) fn rings(&self) -> Vec<Vec<Ring>> {
        let arrangement = self.arrangement;
        let mut rings: Vec<Vec<(f64, Ring)>> = vec![Vec::new(); arrangement.faces.len()];
        let mut walked = vec![false; arrangement.halfedges.len()];
        for start in 0..arrangement.halfedges.len() as HalfedgeId {
            let face = arrangement.halfedges[start as usize].face;
            if walked[start as usize] || face == 0 || self.bounds_nothing(start) {
                continue;
            }
            let mut cycle = Vec::new();
            let mut halfedge = start;
            while !walked[halfedge as usize] {
                walked[halfedge as usize] = true;
                cycle.push(halfedge);
                halfedge = self.following(halfedge);
            }
            for simple in self.cut(&cycle) {
                let ring = self.points(&simple);
                rings[face as usize].push((area(&ring), ring));
            }
        }
        rings.into_iter().map(arranged).collect()
    }

    fn bounds_nothing(&self, halfedge: HalfedgeId) -> bool {
        let face = |halfedge: HalfedgeId| self.arrangement.halfedges[halfedge as usize].face;
        face(halfedge) == face(halfedge ^ 1)
    }

    /// The next halfedge around the face as if edges that bound nothing were not there: each of them is stepped over by
    /// turning about the vertex.
    fn following(&self, halfedge: HalfedgeId) -> HalfedgeId {
        let next = |halfedge: HalfedgeId| self.arrangement.halfedges[halfedge as usize].next;
        let mut after = next(halfedge);
        while self.bounds_nothing(after) {
            after = next(after ^ 1);
        }
        after
    }

    /// Cuts a cycle where it returns to a vertex.
    fn cut(&self, cycle: &[HalfedgeId]) -> Vec<Vec<HalfedgeId>> {
        let mut simple = Vec::new();
        let mut path: Vec<HalfedgeId> = Vec::new();
        let mut starts: HashMap<VertexId, usize> = HashMap::new();
        for &halfedge in cycle {
            starts.insert(self.arrangement.halfedges[halfedge as usize].origin, path.len());
            path.push(halfedge);
            let end = self.arrangement.halfedges[halfedge as usize ^ 1].origin;
            if let Some(&start) = starts.get(&end) {
                let ring = path.split_off(start);
                for halfedge in &ring {
                    starts.remove(&self.arrangement.halfedges[*halfedge as usize].origin);
                }
                simple.push(ring);
            }
        }
        simple
    }

    /// The points along halfedges, the last point of each left to the next one.
    fn points(&self, halfedges: &[HalfedgeId]) -> Ring {
        let mut ring = Vec::new();
        for &halfedge in halfedges {
            let line = &self.lines[halfedge as usize / 2];
            let inner = line.len().saturating_sub(1);
            match halfedge % 2 {
                0 => ring.extend(line.iter().take(inner)),
                _ => ring.extend(line.iter().rev().take(inner)),
            }
        }
        ring
    }
}

/// The largest ring first; it runs counter-clockwise, the others clockwise.
fn arranged(mut rings: Vec<(f64, Ring)>) -> Vec<Ring> {
    rings.sort_by(|(a, _), (b, _)| b.abs().total_cmp(&a.abs()));
    let oriented = rings.into_iter().enumerate().map(|(index, (area, mut ring))| {
        if (area < 0.0) == (index == 0) {
            ring.reverse();
        }
        ring
    });
    oriented.collect()
}

/// Twice the signed area, positive if counter-clockwise; relative to the first point, which keeps small rings exact enough.
fn area(ring: &Ring) -> f64 {
    let Some(&[x, y]) = ring.first() else { return 0.0 };
    let edges = ring.windows(2).map(|ends| {
        let [[ax, ay], [bx, by]] = [ends[0], ends[1]].map(|[px, py]| [px - x, py - y]);
        ax * by - bx * ay
    });
    edges.sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arrange::export::samples::sample;

    #[test]
    fn faces_have_simple_rings_of_the_right_area() {
        let sample = sample();
        let rings = sample.traced().rings();
        let areas: Vec<Vec<f64>> =
            rings.iter().map(|rings| rings.iter().map(|ring| 0.5 * area(ring)).collect()).collect();
        // A polygon of n corners in a circle has n/2 sin(2 pi/n) of the square of the radius.
        let disc = |corners: f64| 0.5 * corners * (2.0 * std::f64::consts::PI / corners).sin();
        let half = 2.25 * 0.5 * disc(80.0);
        let expected = [
            vec![],
            vec![60.0 - half, -4.0 * disc(40.0)],
            vec![20.0 - half],
            vec![half],
            vec![half],
            vec![4.0 * disc(40.0), -disc(40.0)],
            vec![disc(40.0)],
        ];
        assert_eq!(areas.len(), expected.len());
        for (face, (found, expected)) in areas.iter().zip(expected).enumerate() {
            assert_eq!(found.len(), expected.len(), "face {face}: {found:?}");
            for (found, expected) in found.iter().zip(expected) {
                // The halves of the first circle have arcs of 40 chords over different angles.
                assert!((found - expected).abs() < 0.01 * expected.abs(), "face {face}: {found} for {expected}");
            }
        }
        let mut ring = rings[1][0].clone();
        ring.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        assert!(ring.windows(2).all(|pair| pair[0] != pair[1]), "a point is passed twice");
    }
}
