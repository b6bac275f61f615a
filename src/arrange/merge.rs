//! What two arrangements over the same domain have in common, as a start for the arrangement of all their curves.

use crate::arrange::complex::Complex;
use crate::arrange::index::BoxIndex;
use crate::interval::Interval;

/// The leaves of the common refinement of the tilings of two complexes over the same domain: of any two boxes that overlap, the
/// smaller one. Sorted by their lower left corners. Both tilings come from the same rule of subdivision, so one of two such
/// boxes always contains the other; `None` if that is not so, or the domains differ.
pub fn common_refinement(a: &Complex, b: &Complex) -> Option<Vec<[Interval; 2]>> {
    if a.domain != b.domain {
        return None;
    }
    let [a, b] = [a, b].map(|complex| {
        let boxes: Vec<_> = complex.cells.iter().flat_map(|cell| cell.boxes.iter().copied()).collect();
        BoxIndex::new(boxes)
    });
    let mut leaves = inner(&a, &b, true)?;
    leaves.extend(inner(&b, &a, false)?);
    leaves.sort_by(|p, q| p[0].lo().total_cmp(&q[0].lo()).then(p[1].lo().total_cmp(&q[1].lo())));
    Some(leaves)
}

/// The boxes of one tiling that lie in one of the other, and of those in both only if `equal`; `None` if one overlaps
/// another and neither contains the other.
fn inner(own: &BoxIndex, other: &BoxIndex, equal: bool) -> Option<Vec<[Interval; 2]>> {
    let mut leaves = Vec::new();
    for &leaf in own.boxes() {
        let middle = leaf.map(|side| f64::midpoint(side.lo(), side.hi()));
        let around = other.get(other.find(middle)?);
        let within = |p: [Interval; 2], q: [Interval; 2]| q[0].contains_interval(p[0]) && q[1].contains_interval(p[1]);
        match (within(leaf, around), within(around, leaf)) {
            (true, same) => leaves.extend((!same || equal).then_some(leaf)),
            (false, true) => {}
            (false, false) => return None,
        }
    }
    Some(leaves)
}

#[cfg(test)]
mod tests {
    use super::common_refinement;
    use crate::arrange::build::toy::Curve::Circle;
    use crate::arrange::build::toy::Curve::Line;
    use crate::arrange::build::toy::Toy;
    use crate::interval::Interval;

    fn contains(a: &[Interval; 2], b: &[Interval; 2]) -> bool {
        a[0].contains_interval(b[0]) && a[1].contains_interval(b[1])
    }

    #[test]
    fn the_finer_leaf_wins() {
        // Crossings close together in different places: fine leaves here and there.
        let a = Toy::of(&[Line(1.0, 0.2, 0.5), Line(1.0, 0.21, 0.5), Line(1.0, 0.23, 0.501), Circle(0.5, 0.1, 0.4)])
            .complex();
        let b = Toy::of(&[Line(0.1, 1.0, -0.5), Line(0.11, 1.0, -0.5), Line(0.13, 1.0, -0.501)]).complex();
        let leaves = common_refinement(&a, &b).unwrap();
        let both: Vec<_> =
            [&a, &b].into_iter().flat_map(|c| c.cells.iter().flat_map(|cell| cell.boxes.clone())).collect();
        let area = |leaves: &[[Interval; 2]]| -> f64 {
            leaves.iter().map(|[x, y]| (x.hi() - x.lo()) * (y.hi() - y.lo())).sum()
        };
        assert!((area(&leaves) - 4.0).abs() < 1e-12);
        assert!(leaves.len() > a.cells.len().max(b.cells.len()));
        for leaf in &leaves {
            // It is a leaf of one, and lies in leaves of both.
            assert_eq!(both.iter().filter(|other| contains(other, leaf)).count(), 2);
            assert!(both.contains(leaf));
        }
        assert_eq!(common_refinement(&b, &a).unwrap(), leaves);
        assert_eq!(common_refinement(&a, &a).unwrap().len(), a.cells.len());
    }

    #[test]
    fn other_tilings_are_refused() {
        let a = Toy::of(&[]).complex();
        let mut b = a.clone();
        b.domain[0] = Interval::new(-1.0, 2.0).unwrap();
        assert!(common_refinement(&a, &b).is_none());
        let mut b = a.clone();
        let [x, y] = b.cells[0].boxes[0];
        b.cells[0].boxes[0] = [Interval::new(x.lo() - 0.01, x.hi() - 0.01).unwrap(), y];
        assert!(common_refinement(&a, &b).is_none());
    }
}
