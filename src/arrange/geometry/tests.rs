//! Edges and faces of small arrangements made by hand, with fields evaluated by [`Interval`].

use super::*;
use crate::arrange::complex::Axis;
use crate::arrange::complex::Block;
use crate::arrange::complex::Cell;
use crate::arrange::complex::Complex;
use crate::arrange::complex::Effort;
use crate::arrange::complex::Node;
use crate::arrange::complex::Segment;
use crate::arrange::complex::Vertex;
use crate::arrange::complex::VertexKind;
use crate::arrange::field::Sample;
use crate::arrange::structure::ArrangedVertex;
use crate::arrange::structure::Edge;
use crate::arrange::structure::EdgeKind;
use crate::arrange::structure::Face;
use crate::arrange::structure::Gaps;
use crate::arrange::structure::Halfedge;
use crate::arrange::structure::Site;
use crate::kernel::verdict;
use arc::Arc;
use arc::Body;
use arc::Rect;

/// A value with its partial derivatives.
type Jet = (Interval, [Interval; 2]);

fn interval(lo: f64, hi: f64) -> Interval {
    Interval::new(lo, hi).unwrap()
}

fn point(x: f64) -> Interval {
    Interval::point(x)
}

/// Evaluates functions, continuous everywhere.
fn fields(functions: &[fn(Rect) -> Jet]) -> impl Fn(&[(Function, Rect)]) -> Vec<Sample> {
    move |queries| {
        let sample = |&(function, rect): &(Function, Rect)| {
            let (value, slope) = functions[function as usize](rect);
            Sample { value, slope, bits: verdict::CONTINUOUS }
        };
        queries.iter().map(sample).collect()
    }
}

fn circle([x, y]: Rect) -> Jet {
    (x.sqr() + y.sqr() - Interval::ONE, [x * point(2.0), y * point(2.0)])
}

fn parabola([x, y]: Rect) -> Jet {
    (y - x.sqr(), [x * point(-2.0), Interval::ONE])
}

fn rising([x, y]: Rect) -> Jet {
    (y - x * point(0.5), [point(-0.5), Interval::ONE])
}

fn falling([x, y]: Rect) -> Jet {
    (y + x * point(0.5), [point(0.5), Interval::ONE])
}

/// The cycles of a face, the outer one first; the outside has no outer one.
type Cycles<'a> = &'a [&'a [u32]];

/// An arrangement from vertices, edges with their vertices, and the cycles of faces.
fn arrange(complex: Complex, vertices: &[Vertex], edges: &[([u32; 2], Edge)], faces: &[Cycles]) -> Arrangement {
    let mut halfedges: Vec<Halfedge> = edges
        .iter()
        .flat_map(|(ends, _)| ends.map(|origin| Halfedge { origin, next: 0, previous: 0, face: 0 }))
        .collect();
    let mut records = Vec::new();
    for (face, cycles) in faces.iter().enumerate() {
        for cycle in *cycles {
            for (k, &halfedge) in cycle.iter().enumerate() {
                let next = cycle[(k + 1) % cycle.len()];
                halfedges[halfedge as usize].face = face as u32;
                halfedges[halfedge as usize].next = next;
                halfedges[next as usize].previous = halfedge;
            }
        }
        let (outer, holes) = if face == 0 { (&cycles[..0], *cycles) } else { cycles.split_at(1) };
        records.push(Face {
            outer: outer.first().map(|cycle| cycle[0]),
            holes: holes.iter().map(|cycle| cycle[0]).collect(),
            isolated: Vec::new(),
            bounded: false,
            signs: Vec::new(),
            sample: None,
        });
    }
    Arrangement {
        domain: complex.domain,
        curves: complex.curves.clone(),
        vertices: vertices
            .iter()
            .map(|vertex| {
                let site = match vertex.kind {
                    VertexKind::Corner => Site::Corner,
                    VertexKind::Boundary | VertexKind::Loop => Site::Node(0),
                    _ => Site::Block { cell: 0, block: 0 },
                };
                ArrangedVertex { vertex: vertex.clone(), site, halfedge: None, face: None }
            })
            .collect(),
        halfedges,
        edges: edges.iter().map(|(_, edge)| edge.clone()).collect(),
        faces: records,
        proved: true,
        complex,
        gaps: Gaps::default(),
        node_edges: Vec::new(),
        milliseconds: 0.0,
    }
}

fn vertex(kind: VertexKind, area: Rect) -> Vertex {
    Vertex { kind, area, proved: true, curves: vec![0], note: None }
}

fn frame(ends: [u32; 2]) -> ([u32; 2], Edge) {
    let edge = Edge {
        kind: EdgeKind::Frame,
        component: 0,
        curves: Vec::new(),
        proved: true,
        nodes: Vec::new(),
        cells: Vec::new(),
    };
    (ends, edge)
}

fn curve(ends: [u32; 2], component: u32, nodes: &[u32], cells: &[u32]) -> ([u32; 2], Edge) {
    let (nodes, cells) = (nodes.to_vec(), cells.to_vec());
    (ends, Edge { kind: EdgeKind::Curve, component, curves: vec![0], proved: true, nodes, cells })
}

fn corners([x, y]: Rect) -> [Vertex; 4] {
    [[x.lo(), y.lo()], [x.hi(), y.lo()], [x.hi(), y.hi()], [x.lo(), y.hi()]]
        .map(|corner| vertex(VertexKind::Corner, corner.map(point)))
}

fn segment(axis: Axis, at: f64, [from, to]: [f64; 2], nodes: &[u32]) -> Segment {
    Segment { axis, at, from, to, nodes: nodes.to_vec(), frame: false }
}

fn node(segment: u32, place: Interval) -> Node {
    Node { segment, place, component: 0, curves: vec![0] }
}

fn complex(domain: Rect, segments: Vec<Segment>, nodes: Vec<Node>, cells: Vec<Cell>) -> Complex {
    Complex { domain, curves: vec!["c".into()], segments, nodes, cells, effort: Effort::default() }
}

/// The unit circle: cells to its right, top, left and bottom, with vertical tangents inside the first and the third.
/// `known`: whether the top cell says that the circle is a graph there.
fn disc(known: bool) -> Arrangement {
    let domain = [interval(-1.5, 1.5); 2];
    let high = point(0.75).sqrt();
    let nodes = vec![node(0, high), node(1, high), node(2, -high), node(3, -high)];
    let (up, down) = ([0.25, 1.5], [-1.5, -0.25]);
    let segments = vec![
        segment(Axis::Y, 0.5, up, &[0]),
        segment(Axis::Y, -0.5, up, &[1]),
        segment(Axis::Y, -0.5, down, &[2]),
        segment(Axis::Y, 0.5, down, &[3]),
        segment(Axis::X, 1.5, [-0.5, 0.5], &[]),
        segment(Axis::X, 0.25, [-0.5, 0.5], &[]),
    ];
    let cell = |x: [f64; 2], y: [f64; 2], axis, nodes: [u32; 2], boundary: &[(u32, bool)]| Cell {
        boxes: vec![[interval(x[0], x[1]), interval(y[0], y[1])]],
        boundary: vec![boundary.to_vec()],
        blocks: vec![Block { nodes: nodes.to_vec(), vertex: None, axis }],
    };
    let top_axis = known.then_some(Axis::X);
    let cells = vec![
        cell([-0.5, 0.5], up, top_axis, [0, 1], &[(5, true), (0, true), (4, false), (1, false)]),
        cell([-1.5, -0.5], [-1.5, 1.5], Some(Axis::Y), [1, 2], &[]),
        cell([-0.5, 0.5], down, Some(Axis::X), [2, 3], &[]),
        cell([0.5, 1.5], [-1.5, 1.5], Some(Axis::Y), [3, 0], &[]),
    ];
    let mut vertices = corners(domain).to_vec();
    vertices.push(vertex(VertexKind::Loop, [point(0.5), high]));
    let edges =
        [frame([0, 1]), frame([1, 2]), frame([2, 3]), frame([3, 0]), curve([4, 4], 0, &[0, 1, 2, 3, 0], &[0, 1, 2, 3])];
    let faces: [Cycles; 3] = [&[&[7, 5, 3, 1]], &[&[0, 2, 4, 6], &[9]], &[&[8]]];
    arrange(complex(domain, segments, nodes, cells), &vertices, &edges, &faces)
}

/// The samples of a field, but in the top cell of the disc nothing is known.
fn blind(queries: &[(Function, Rect)]) -> Vec<Sample> {
    let mut samples = fields(&[circle])(queries);
    for (sample, (_, [x, y])) in samples.iter_mut().zip(queries) {
        if x.mag() <= 0.5 && y.lo() >= 0.25 {
            sample.bits = 0;
        }
    }
    samples
}

const FINE: Precision = Precision { relative: 1e-7, pieces: 1 << 18 };

#[test]
fn the_area_and_the_length_of_a_disc() {
    let (disc, evaluate) = (disc(true), fields(&[circle]));
    let areas = areas_of(&disc, &[0], &evaluate, &FINE);
    assert_eq!(areas[0], None);
    let (ring, inner) = (areas[1].unwrap(), areas[2].unwrap());
    assert!(inner.contains_interval(Interval::PI), "{inner:?}");
    assert!(inner.width() < 1e-6, "{}", inner.width());
    assert!(ring.contains_interval(point(9.0) - Interval::PI) && ring.width() < 1e-6, "{ring:?}");
    assert!((ring + inner).contains(9.0));

    let lengths = lengths_of(&disc, &[0], &evaluate, &FINE);
    assert!(lengths[4].contains_interval(Interval::PI * point(2.0)), "{:?}", lengths[4]);
    assert!(lengths[4].width() < 1e-6, "{}", lengths[4].width());
    assert_eq!(lengths[..4], [point(3.0); 4]);
}

#[test]
fn an_area_whose_boundary_is_hidden_in_a_cell() {
    let disc = disc(false);
    let areas = areas_of(&disc, &[0], &blind, &FINE);
    let (ring, inner) = (areas[1].unwrap(), areas[2].unwrap());
    // The cell is 1 by 1.25: all of it may belong to one or to the other.
    let cell = 2.0 * (0.5 * (point(0.75).sqrt().lo()) - 0.125);
    let outside = 1.25 - cell;
    assert!(inner.contains_interval(Interval::PI) && ring.contains_interval(point(9.0) - Interval::PI));
    assert!(inner.width() < 1.25 + 1e-5 && outside > 0.0, "{inner:?}");
    assert!((ring + inner).contains(9.0));
    let lengths = lengths_of(&disc, &[0], &blind, &FINE);
    assert!(lengths[4].hi() == f64::INFINITY && lengths[4].lo() > 6.2 && lengths[4].lo() < 6.29);
    let lines = polylines_of(&disc, &[0], &blind, 1e-3);
    assert!(lines[4].deviation >= 0.13 && lines[4].deviation <= 1.25f64.hypot(1.0) + 1e-12);
}

#[test]
fn a_disc_with_a_graph_of_unknown_slope() {
    let disc = disc(true);
    // The slope is known again once the pieces are small.
    let evaluate = |queries: &[(Function, Rect)]| {
        let mut samples = fields(&[circle])(queries);
        for (sample, (_, [x, y])) in samples.iter_mut().zip(queries) {
            if x.width() > 0.3 && x.mag() <= 0.5 && y.lo() >= 0.25 {
                sample.bits = 0;
            }
        }
        samples
    };
    let areas = areas_of(&disc, &[0], &evaluate, &FINE);
    let inner = areas[2].unwrap();
    assert!(inner.contains_interval(Interval::PI) && inner.width() < 1e-6, "{inner:?}");
}

/// The distance of a point from a polyline.
fn distance([x, y]: [f64; 2], points: &[[f64; 2]]) -> f64 {
    let apart = |pair: &[[f64; 2]]| {
        let ([ax, ay], [bx, by]) = (pair[0], pair[1]);
        let (dx, dy) = (bx - ax, by - ay);
        let share = (((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
        (x - ax - share * dx).hypot(y - ay - share * dy)
    };
    points.windows(2).map(apart).fold(f64::INFINITY, f64::min)
}

#[test]
fn polylines_of_a_circle_are_as_near_as_they_say() {
    let (disc, evaluate) = (disc(true), fields(&[circle]));
    let mut counts = Vec::new();
    for tolerance in [1e-1, half_pixel(&disc.domain), 1e-5] {
        let line = &polylines_of(&disc, &[0], &evaluate, tolerance)[4];
        assert!(line.deviation <= tolerance, "{}", line.deviation);
        assert!(line.points.iter().all(|&[x, y]| (x.hypot(y) - 1.0).abs() < 1e-12));
        let samples = 20 * line.points.len();
        let found = (0..samples)
            .map(|k| {
                let angle = std::f64::consts::TAU * (k as f64) / (samples as f64);
                distance([angle.cos(), angle.sin()], &line.points)
            })
            .fold(0.0, f64::max);
        assert!(found <= line.deviation, "{found} > {}", line.deviation);
        // The bound is not much more than what is needed.
        assert!(line.deviation < 12.0 * found + 1e-12, "{found} {}", line.deviation);
        counts.push(line.points.len());
    }
    assert!(counts[0] < counts[1] && counts[1] < counts[2], "{counts:?}");
    assert_eq!(polylines_of(&disc, &[0], &evaluate, 1e-3)[1].points, [[1.5, -1.5], [1.5, 1.5]]);
}

#[test]
fn a_spline_of_a_circle_needs_few_curves() {
    let (disc, evaluate) = (disc(true), fields(&[circle]));
    let spline = &spline::splines_of(&disc, &[0], &evaluate, 1e-4)[4];
    assert!(spline.error() <= 1e-4, "{spline:?}");
    let curves: Vec<kurbo::PathSeg> = spline.path.segments().collect();
    assert!((4..=16).contains(&curves.len()), "{}", curves.len());
    for curve in &curves {
        for k in 0..=50 {
            let point = kurbo::ParamCurve::eval(curve, f64::from(k) / 50.0);
            assert!((point.x.hypot(point.y) - 1.0).abs() < spline.error());
        }
    }
}

/// y = x^2 in one cell from side to side.
fn bowl() -> Arrangement {
    let domain = [interval(-1.0, 1.0), interval(-1.0, 2.0)];
    let segments = vec![
        segment(Axis::Y, -1.0, [-1.0, 2.0], &[0]),
        segment(Axis::Y, 1.0, [-1.0, 2.0], &[1]),
        segment(Axis::X, -1.0, [-1.0, 1.0], &[]),
        segment(Axis::X, 2.0, [-1.0, 1.0], &[]),
    ];
    let cell = Cell {
        boxes: vec![domain],
        boundary: vec![vec![(2, true), (1, true), (3, false), (0, false)]],
        blocks: vec![Block { nodes: vec![0, 1], vertex: None, axis: Some(Axis::X) }],
    };
    let mut vertices = corners(domain).to_vec();
    vertices.push(vertex(VertexKind::Boundary, [point(-1.0), point(1.0)]));
    vertices.push(vertex(VertexKind::Boundary, [point(1.0), point(1.0)]));
    let edges = [
        curve([4, 5], 0, &[0, 1], &[0]),
        frame([0, 1]),
        frame([1, 5]),
        frame([5, 2]),
        frame([2, 3]),
        frame([3, 4]),
        frame([4, 0]),
    ];
    let faces: [Cycles; 3] = [&[&[13, 11, 9, 7, 5, 3]], &[&[1, 12, 2, 4]], &[&[0, 6, 8, 10]]];
    let nodes = vec![node(0, point(1.0)), node(1, point(1.0))];
    arrange(complex(domain, segments, nodes, vec![cell]), &vertices, &edges, &faces)
}

#[test]
fn the_segment_of_a_parabola() {
    let (bowl, evaluate) = (bowl(), fields(&[parabola]));
    let areas = areas_of(&bowl, &[0], &evaluate, &FINE);
    let third = |n: f64| point(n) / point(3.0);
    let (below, above) = (areas[1].unwrap(), areas[2].unwrap());
    assert!(below.contains_interval(third(8.0)) && below.width() < 1e-6, "{below:?}");
    // Above the line y = 1 it is the rectangle, below it the segment of Archimedes.
    let segment = above - point(2.0);
    assert!(segment.contains_interval(third(4.0)) && segment.width() < 1e-6, "{above:?}");
    // Twice the integral of sqrt(1 + 4 x^2) from 0 to 1: sqrt(5) + asinh(2) / 2.
    let exact = point(5.0).sqrt() + point(2.0).asinh() * point(0.5);
    let length = lengths_of(&bowl, &[0], &evaluate, &FINE)[0];
    assert!(length.contains_interval(exact) && length.width() < 1e-6, "{length:?}");
}

#[test]
fn a_cap_on_the_pieces_holds() {
    let (bowl, evaluate) = (bowl(), fields(&[parabola]));
    let rough = Precision { relative: 1e-12, pieces: 20 };
    let areas = areas_of(&bowl, &[0], &evaluate, &rough);
    let above = areas[2].unwrap();
    assert!(above.contains_interval(point(10.0) / point(3.0)) && above.width() > 1e-4, "{above:?}");
}

/// y = x / 2 and y = -x / 2, crossing in the only cell.
fn cross(proved: bool) -> Arrangement {
    let domain = [interval(-1.0, 1.0); 2];
    let half = point(0.5);
    let segments = vec![
        segment(Axis::Y, -1.0, [-1.0, 1.0], &[0, 1]),
        segment(Axis::Y, 1.0, [-1.0, 1.0], &[2, 3]),
        segment(Axis::X, -1.0, [-1.0, 1.0], &[]),
        segment(Axis::X, 1.0, [-1.0, 1.0], &[]),
    ];
    let nodes = vec![node(0, -half), node(0, half), node(1, -half), node(1, half)];
    let centre = Vertex { proved, ..vertex(VertexKind::Crossing, [interval(-1e-12, 1e-12); 2]) };
    let cell = Cell {
        boxes: vec![domain],
        boundary: vec![vec![(2, true), (1, true), (3, false), (0, false)]],
        blocks: vec![Block { nodes: vec![2, 3, 1, 0], vertex: Some(centre.clone()), axis: None }],
    };
    let mut vertices = corners(domain).to_vec();
    for (x, y) in [(-1.0, -half), (-1.0, half), (1.0, -half), (1.0, half)] {
        vertices.push(vertex(VertexKind::Boundary, [point(x), y]));
    }
    vertices.push(centre);
    let edges = [
        curve([4, 8], 0, &[0], &[0]),
        curve([5, 8], 1, &[1], &[0]),
        curve([8, 6], 1, &[2], &[0]),
        curve([8, 7], 0, &[3], &[0]),
        frame([0, 1]),
        frame([1, 6]),
        frame([6, 7]),
        frame([7, 2]),
        frame([2, 3]),
        frame([3, 5]),
        frame([5, 4]),
        frame([4, 0]),
    ];
    let faces: [Cycles; 5] = [
        &[&[23, 21, 19, 17, 15, 13, 11, 9]],
        &[&[8, 10, 5, 1, 22]],
        &[&[4, 12, 7]],
        &[&[6, 14, 16, 18, 2]],
        &[&[0, 3, 20]],
    ];
    arrange(complex(domain, segments, nodes, vec![cell]), &vertices, &edges, &faces)
}

#[test]
fn lines_are_exact_up_to_their_vertices() {
    let (arrangement, evaluate) = (cross(true), fields(&[rising, falling]));
    let areas = areas_of(&arrangement, &[0, 1], &evaluate, &Precision::default());
    for (area, exact) in areas[1..].iter().zip([1.5, 0.5, 1.5, 0.5]) {
        let area = area.unwrap();
        assert!(area.contains(exact) && area.width() < 1e-11, "{area:?}");
    }
    for line in &polylines_of(&arrangement, &[0, 1], &evaluate, 1e-3)[..4] {
        assert_eq!(line.points.len(), 2);
        assert!(line.deviation < 2e-12 && line.points.contains(&[0.0, 0.0]));
    }
    for length in &lengths_of(&arrangement, &[0, 1], &evaluate, &Precision::default())[..4] {
        assert!(length.contains_interval(point(1.25).sqrt()) && length.width() < 1e-11, "{length:?}");
    }
    // Arms of an unproved vertex are hidden, and its cell is the whole domain; but the curves are graphs in it.
    let areas = areas_of(&cross(false), &[0, 1], &evaluate, &Precision::default());
    assert_eq!(areas[1..], [Some(interval(0.0, 4.0)); 4]);
    for length in &lengths_of(&cross(false), &[0, 1], &evaluate, &Precision::default())[..4] {
        assert!(length.lo() > 1.1 && length.hi() < 2.0 * 1.25f64.sqrt() + 1e-9, "{length:?}");
    }
}

#[test]
fn the_bound_on_the_sag_is_reached() {
    // Up with slope 2 for a third of the way, down with slope -1 for the rest: the chord is level.
    let ends = [[point(0.0); 2], [point(3.0), point(0.0)]];
    let body = Body::Graph { axis: 0, reach: interval(-10.0, 10.0), slope: interval(-1.0, 2.0) };
    let arc = Arc { function: 0, ends, body, fixed: false };
    assert!((2.0..2.0 + 1e-12).contains(&arc.deviation()), "{}", arc.deviation());
    // It encloses the triangle, 3, and has the length of the two legs.
    assert!((3.0..3.0 + 1e-12).contains(&arc.bulge().unwrap()));
    let legs = point(5.0).sqrt() + point(8.0).sqrt();
    assert!((legs.hi() - arc.length().hi()).abs() < 1e-12 && arc.length().lo() == 3.0, "{:?}", arc.length());
    // With any chord between, the bound is at most (M - m) h / 4.
    for (rise, bound) in [(1.5, 2.25), (3.0, 2.0), (6.0, 1e-300)] {
        let ends = [[point(0.0); 2], [point(3.0), point(rise)]];
        let arc = Arc { ends, ..arc.clone() };
        assert!(arc.deviation() <= bound, "{rise} {}", arc.deviation());
    }
}
