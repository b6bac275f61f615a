//! Points in arrangements of lines and circles, whose place is known from the formulas.

use crate::arrange::build::build;
use crate::arrange::build::toy::Curve;
use crate::arrange::build::toy::Curve::Circle;
use crate::arrange::build::toy::Curve::Line;
use crate::arrange::build::toy::Toy;
use crate::arrange::complex::VertexKind;
use crate::arrange::field::Sample;
use crate::arrange::locate::Components;
use crate::arrange::locate::Location;
use crate::arrange::locate::Locator;
use crate::arrange::structure::Arrangement;
use crate::arrange::structure::FaceId;
use crate::interval::Interval;
use crate::interval::Verdict;
use crate::kernel::verdict;

impl Components for Toy {
    fn count(&self) -> u32 {
        self.curves.len() as u32
    }

    fn evaluate(&self, queries: &[(u32, [Interval; 2])]) -> Vec<Sample> {
        let point = Interval::point;
        let sample = |&(component, [x, y]): &(u32, [Interval; 2])| {
            let (value, slope) = match self.curves[component as usize] {
                Line(a, b, c) => (point(a) * x + point(b) * y - point(c), [point(a), point(b)]),
                Circle(u, v, r) => {
                    let (x, y) = (x - point(u), y - point(v));
                    (x.sqr() + y.sqr() - point(r).sqr(), [point(2.0) * x, point(2.0) * y])
                }
            };
            let sign = match (value.is_positive(), value.is_negative()) {
                (Verdict::Proved, _) => verdict::POSITIVE,
                (_, Verdict::Proved) => verdict::NEGATIVE,
                _ => 0,
            };
            Sample { value, slope, bits: sign | verdict::CONTINUOUS }
        };
        queries.iter().map(sample).collect()
    }
}

/// On which sides of the curves a point is; `None` very near to one.
fn sides(curves: &[Curve], [x, y]: [f64; 2]) -> Option<Vec<bool>> {
    let side = |&curve: &Curve| {
        let f = match curve {
            Line(a, b, c) => a * x + b * y - c,
            Circle(u, v, r) => (x - u).hypot(y - v) - r,
        };
        (f.abs() > 1e-9).then_some(f > 0.0)
    };
    curves.iter().map(side).collect()
}

fn located(toy: &Toy, arrangement: &Arrangement, points: impl Iterator<Item = [f64; 2]>) -> usize {
    let locator = Locator::new(arrangement, toy);
    let of_face = |face: FaceId| sides(&toy.curves, arrangement.faces[face as usize].sample.unwrap()).unwrap();
    let (mut found, mut all) = (0, 0);
    for point in points {
        let Some(truth) = sides(&toy.curves, point) else { continue };
        all += 1;
        match locator.locate(point) {
            Location::Face(face) => {
                found += 1;
                assert_eq!(of_face(face), truth, "{point:?} {face}");
            }
            Location::Unknown(faces) => assert!(faces.iter().any(|&face| of_face(face) == truth), "{point:?}"),
            other => panic!("{point:?} is said to be at {other:?}"),
        }
    }
    assert!(found * 100 >= all * 98, "{found} of {all}");
    found
}

#[test]
fn random_points_lie_in_their_faces() {
    let mut random = fastrand::Rng::with_seed(7);
    let mut number = |size: f64| (random.f64() * 2.0 - 1.0) * size;
    // In these convex or simple situations the sides of the curves tell the faces apart.
    let lines: Vec<_> = (0..12).map(|_| Line(number(1.0), number(1.0), number(0.4))).collect();
    let circles = [Circle(-0.2, 0.0, 0.5), Circle(0.2, 0.1, 0.5), Line(0.3, 1.0, 0.07), Circle(0.7, -0.7, 0.1)];
    for curves in [&lines[..], &circles[..], &lines[..1], &[]] {
        for levels in [4, 5] {
            let toy = Toy { levels, ..Toy::of(curves) };
            let arrangement = build(toy.complex()).unwrap();
            let points: Vec<_> = (0..1500).map(|_| [number(1.0), number(1.0)]).collect();
            assert!(located(&toy, &arrangement, points.into_iter()) > 1400);
            // Close to crossings, and on the sides and corners of cells.
            let near: Vec<_> = (toy.crossings().into_iter())
                .flat_map(|(.., p)| [1e-2, 1e-4, 1e-6].map(|size| [p[0] + number(size), p[1] + number(size)]))
                .collect();
            located(&toy, &arrangement, near.into_iter());
            let boxes = arrangement.complex.cells.iter().flat_map(|cell| cell.boxes.clone());
            let on: Vec<_> =
                boxes.flat_map(|[x, y]| [[x.lo(), y.lo()], [x.lo(), y.lo() * 0.3 + y.hi() * 0.7]]).collect();
            located(&toy, &arrangement, on.into_iter());
        }
    }
}

#[test]
fn points_on_curves_and_nowhere() {
    let toy =
        Toy { levels: 4, points: vec![[-0.5, 0.5]], ..Toy::of(&[Line(1.0, -1.0, 0.25), Circle(0.5, -0.5, 0.3125)]) };
    let arrangement = build(toy.complex()).unwrap();
    let locator = Locator::new(&arrangement, &toy);
    let on = |location| match location {
        Location::Edge(edge) => arrangement.edges[edge as usize].curves[0],
        other => panic!("{other:?}"),
    };
    assert_eq!(on(locator.locate([0.375, 0.125])), 0);
    assert_eq!(on(locator.locate([0.5 + 0.1875, -0.5 + 0.25])), 1);
    let vertex = |location| match location {
        Location::Vertex(v) => arrangement.vertices[v as usize].vertex.kind,
        other => panic!("{other:?}"),
    };
    assert_eq!(vertex(locator.locate([1.0, 0.75])), VertexKind::Boundary);
    assert_eq!(vertex(locator.locate([-0.5, 0.5])), VertexKind::Singular);
    assert_eq!(locator.locate([1.5, 0.0]), Location::Face(0));
    assert_eq!(locator.locate([f64::INFINITY, 0.0]), Location::Face(0));
    assert_eq!(locator.locate([f64::NAN, 0.0]), Location::Unknown(vec![]));
    // So near that the enclosure of the value holds 0, but it is not 0: two faces are possible.
    let Location::Unknown(faces) = locator.locate([0.5 + 0.3125 * 0.28, -0.5 + 0.3125 * 0.96]) else { panic!() };
    assert_eq!(faces.len(), 2);
}

#[test]
fn an_unresolved_region_says_what_it_sees() {
    let toy = Toy { ring: Some(([0.0, 0.0], 0.3, 0.7)), levels: 4, ..Toy::of(&[Line(1.0, 0.2, 0.03)]) };
    let arrangement = build(toy.complex()).unwrap();
    let locator = Locator::new(&arrangement, &toy);
    let face = |point| match locator.locate(point) {
        Location::Face(face) => face,
        other => panic!("{other:?}"),
    };
    // In the ring, but the way out is free; what is left and right of the hole is not connected outside of the ring.
    assert_eq!(face([-0.68, 0.0]), face([-0.9, 0.0]));
    assert_ne!(face([0.68, 0.0]), face([-0.9, 0.0]));
    // In the middle of the ring no shot meets its boundary.
    let Location::Unknown(faces) = locator.locate([-0.5, 0.0]) else { panic!() };
    assert_eq!(faces.len(), 4);
}

#[test]
fn ways_from_face_to_face() {
    let toy = Toy::of(&[Circle(0.1, 0.05, 0.7), Circle(0.1, 0.05, 0.4), Line(1.0, 0.0, 0.1)]);
    let arrangement = build(toy.complex()).unwrap();
    let locator = Locator::new(&arrangement, &toy);
    let face = |point| match locator.locate(point) {
        Location::Face(face) => face,
        other => panic!("{other:?}"),
    };
    let [left, right, out] = [[-0.1, 0.1], [0.3, 0.1], [-0.9, 0.9]].map(face);
    assert_eq!(arrangement.neighbours(left).len(), 2);
    assert_eq!(arrangement.connected(left, right, |_| true, |_| true), Some(vec![left, right]));
    // Across circles only.
    let circles = |edge: &crate::arrange::structure::Edge| edge.curves != [2];
    assert_eq!(arrangement.connected(left, right, |_| true, circles), None);
    assert_eq!(arrangement.connected(left, out, |_| true, circles).map(|way| way.len()), Some(3));
    assert_eq!(arrangement.connected(left, out, |face| face.bounded, |_| true), None);
    assert_eq!(arrangement.connected(left, 99, |_| true, |_| true), None);
    assert_eq!(arrangement.faces_where(|_| true).len(), arrangement.faces.len() - 1);
    // Around every vertex lie its arms; every boundary is closed.
    let sum: usize = (0..arrangement.vertices.len()).map(|v| arrangement.around(v as u32).count()).sum();
    assert_eq!(sum, arrangement.halfedges.len());
    let sum: usize = (0..arrangement.faces.len()).map(|f| arrangement.boundary(f as u32).count()).sum();
    assert_eq!(sum, arrangement.halfedges.len());
}

#[test]
fn the_nearest_vertex() {
    let toy = Toy::of(&[Line(1.0, 0.1, 0.03), Line(0.1, 1.0, 0.07), Line(1.0, -1.0, 0.5)]);
    let arrangement = build(toy.complex()).unwrap();
    let mut random = fastrand::Rng::with_seed(8);
    for _ in 0..200 {
        let point = [random.f64() * 2.0 - 1.0, random.f64() * 2.0 - 1.0];
        let nearest = arrangement.nearest_vertex(point).unwrap();
        let distances = arrangement.vertices.iter().filter(|v| v.vertex.kind != VertexKind::Corner).map(|v| {
            let [x, y] = v.vertex.area.map(|side| f64::midpoint(side.lo(), side.hi()));
            (x - point[0]).hypot(y - point[1])
        });
        let least = distances.fold(f64::INFINITY, f64::min);
        assert!(nearest.unique && (nearest.distance.lo() - least).abs() < 1e-12);
        assert!(nearest.distance.hi() - nearest.distance.lo() < 1e-12 && nearest.distance.contains(least));
    }
    assert!(arrangement.nearest_vertex([f64::NAN, 0.0]).is_none());
    assert!(build(Toy::default().complex()).unwrap().nearest_vertex([0.0, 0.0]).is_none());
}
