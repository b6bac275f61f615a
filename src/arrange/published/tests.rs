//! The algorithm on functions whose arrangements are known, evaluated with reference intervals.

use super::Contact;
use super::Evaluate;
use super::Graph;
use super::Limits;
use super::RegionKind;
use super::solve_with;
use crate::arrange::field::Sample;
use crate::control::Control;
use crate::interval::Interval;
use crate::kernel::verdict;

type Curve = fn(Interval, Interval) -> Interval;

fn number(x: f64) -> Interval {
    Interval::point(x)
}

/// Enclosures with the verdicts that follow; continuous wherever bounded, which is so for everything used here.
fn sample(value: Interval) -> Sample {
    let mut bits = 0;
    if value.is_empty() {
        bits |= verdict::EMPTY;
    } else if value.lo() > 0.0 {
        bits |= verdict::POSITIVE;
    } else if value.hi() < 0.0 {
        bits |= verdict::NEGATIVE;
    }
    if value.is_bounded() {
        bits |= verdict::CONTINUOUS;
    }
    Sample { value, slope: [Interval::ENTIRE; 2], bits }
}

fn solve_in(side: f64, curves: &[Curve], limits: &Limits) -> Graph {
    let range = Interval::new(-side, side).unwrap();
    let shapes: Vec<u32> = (0..curves.len() as u32).collect();
    let evaluate: &Evaluate = &|queries| {
        let one = |&(function, [x, y]): &(u32, [Interval; 2])| sample(curves[function as usize](x, y));
        queries.iter().map(one).collect()
    };
    solve_with([range, range], &shapes, limits, &Control::default(), evaluate)
}

/// On a box around the origin whose middle lines avoid the points of interest.
fn solve(curves: &[Curve], epsilon: f64) -> Graph {
    solve_in(10.3, curves, &Limits { epsilon, ..Limits::default() })
}

fn kinds(graph: &Graph) -> [usize; 4] {
    [RegionKind::Vertex, RegionKind::Edge, RegionKind::Indeterminate, RegionKind::Face].map(|kind| graph.count(kind))
}

const RISING: Curve = |x, y| y - x + number(0.3);
const FALLING: Curve = |x, y| y + x - number(0.7);
const CIRCLE: Curve = |x, y| x.sqr() + y.sqr() - number(4.0);
const PARABOLA: Curve = |x, y| y - x.sqr();

#[test]
fn two_lines_cross_once() {
    let graph = solve(&[RISING, FALLING], 1e-3);
    assert_eq!(kinds(&graph)[..3], [1, 4, 0]);
    assert!(graph.count(RegionKind::Face) >= 4);
    let vertex = graph.regions.iter().find(|region| region.kind == RegionKind::Vertex).unwrap();
    assert_eq!(vertex.contact, Some(Contact::Crossing));
    assert!(vertex.area[0].contains(0.5) && vertex.area[1].contains(0.2));
    assert!(graph.terminal <= 1e-3 && graph.delta() == 2.0 * graph.terminal);
    assert!(graph.complete);
    // The vertex is adjacent to the four edges.
    let vertex = graph.regions.iter().position(|region| region.kind == RegionKind::Vertex).unwrap() as u32;
    let beside = graph.adjacent.iter().filter(|pair| pair.contains(&vertex)).flatten();
    let is_edge = |id: &&u32| graph.regions[**id as usize].kind == RegionKind::Edge;
    assert_eq!(beside.filter(is_edge).count(), 4);
}

#[test]
fn a_curve_alone_is_one_leaf() {
    let graph = solve(&[CIRCLE], 1e-3);
    assert_eq!(kinds(&graph)[0], 0);
    // One curve is not refined: the root itself has just one candidate, and is proved to be crossed.
    assert_eq!((graph.nodes, graph.counts.crossed), (1, 1));
    assert!(graph.exact());
}

#[test]
fn a_tangent_is_told_from_a_crossing() {
    let tangent: Curve = |x, y| y - number(2.0) * number(0.7) * x + number(0.7).sqr();
    let graph = solve(&[PARABOLA, tangent], 1e-4);
    let contacts: Vec<_> = graph.regions.iter().filter_map(|region| region.contact).collect();
    assert!(!contacts.contains(&Contact::Crossing) && !contacts.is_empty(), "{contacts:?}");
    assert!(!graph.exact());
}

#[test]
fn a_pole_is_no_zero() {
    // 1/(x - 0.1) changes sign and has no zero; the second curve makes the tree descend to it.
    let pole: Curve = |x, _| number(1.0) / (x - number(0.1));
    let graph = solve(&[pole], 1e-2);
    assert_eq!(graph.counts.crossed, 0);
    assert_eq!(graph.counts.undecided, graph.discontinuous);
    assert_eq!(kinds(&graph), [0, 0, 1, 0]);
    // The source's test is kept where the function is continuous: next to the pole, (x - 3) / (x - 0.1) has a zero.
    let both: Curve = |x, _| (x - number(3.0)) / (x - number(0.1));
    assert_eq!(solve(&[both], 1e-2).counts.crossed, 1);
}

#[test]
fn a_double_curve_stays_undecided() {
    let double: Curve = |x, y| (x - y + number(0.3)).sqr();
    let graph = solve(&[double, FALLING], 1e-2);
    assert!(graph.counts.undecided > 0 && graph.discontinuous == 0);
    assert!(graph.count(RegionKind::Indeterminate) > 0 && !graph.exact());
}

#[test]
fn curves_that_miss_the_box_leave_one_face() {
    let far: Curve = |x, y| x + y - number(100.0);
    let graph = solve(&[far, far], 1e-3);
    assert_eq!((kinds(&graph), graph.nodes), ([0, 0, 0, 1], 1));
    assert!(graph.adjacent.is_empty());
}

#[test]
fn regions_are_the_connected_sets_of_equal_leaves() {
    let graph = solve(&[RISING, FALLING, CIRCLE, PARABOLA], 0.05);
    // By brute force: leaves that share more than a corner.
    let areas: Vec<[Interval; 2]> = graph.leaves.iter().map(|(leaf, _)| leaf.square.area(graph.domain)).collect();
    let mut adjacent = Vec::new();
    let mut reached: Vec<usize> = (0..areas.len()).collect();
    for a in 0..areas.len() {
        for b in 0..a {
            let shared = [0, 1].map(|axis| areas[a][axis].intersect(areas[b][axis]));
            let touch = shared.iter().all(|range| !range.is_empty());
            if !touch || shared.iter().all(|range| range.is_singleton()) {
                continue;
            }
            let (left, right) = (graph.leaves[a], graph.leaves[b]);
            if left.0.label == right.0.label {
                assert_eq!(left.1, right.1);
                let (old, new) = (reached[a], reached[b]);
                reached.iter_mut().filter(|id| **id == old).for_each(|id| *id = new);
            } else {
                adjacent.push([left.1.min(right.1), left.1.max(right.1)]);
            }
        }
    }
    adjacent.sort_unstable();
    adjacent.dedup();
    assert_eq!(graph.adjacent, adjacent);
    reached.sort_unstable();
    reached.dedup();
    assert_eq!(reached.len(), graph.regions.len());
}

#[test]
fn leaves_tile_and_every_split_makes_four() {
    let graph = solve(&[RISING, FALLING, CIRCLE], 1e-2);
    let area = |level: u32| 0.25f64.powi(level as i32);
    let total: f64 = graph.leaves.iter().map(|(leaf, _)| area(leaf.square.level)).sum();
    assert_eq!(total, 1.0);
    assert_eq!(graph.nodes, (4 * graph.leaves.len() as u64 - 1) / 3);
    let leaves = graph.counts;
    assert_eq!(leaves.empty + leaves.crossed + leaves.undecided + leaves.several, graph.leaves.len() as u64);
}

#[test]
fn the_bound_on_nodes_and_the_depth_hold() {
    // The same line twice: nothing but the limits ends the descent.
    let small = Limits { nodes: 1000, ..Limits::default() };
    let graph = solve_in(10.0, &[RISING, RISING], &small);
    assert!(!graph.complete && graph.nodes <= 1000 && graph.terminal > 0.01);
    let shallow = Limits { depth: 4, ..Limits::default() };
    let graph = solve_in(10.0, &[RISING, RISING], &shallow);
    assert!(graph.complete && graph.terminal == 20.0 / 16.0 && graph.counts.several > 16);
}

#[test]
fn cancelling_ends_it_with_what_there_is() {
    let cancel = std::sync::atomic::AtomicBool::new(true);
    let range = Interval::new(-1.0, 1.0).unwrap();
    let never: &Evaluate = &|_| panic!("cancelled before");
    let control = Control::new(None, Some(&cancel));
    let graph = solve_with([range, range], &[0, 1], &Limits::default(), &control, never);
    assert!(!graph.complete);
    assert_eq!((graph.leaves.len(), graph.counts.several), (1, 1));
}
