//! Lengths, areas, polylines and splines of arrangements of formulas, against known values.

use imp::arrange::Arrangement;
use imp::arrange::Fields;
use imp::arrange::Options;
use imp::arrange::build::build;
use imp::arrange::geometry::Precision;
use imp::arrange::geometry::areas;
use imp::arrange::geometry::half_pixel;
use imp::arrange::geometry::lengths;
use imp::arrange::geometry::polylines;
use imp::arrange::geometry::spline::splines;
use imp::arrange::solve;
use imp::arrange::structure::EdgeKind;
use imp::control::Control;
use imp::interval::Interval;
use imp::session;
use imp::session::Source;

fn arranged(text: &str) -> (Arrangement, Fields) {
    let artefact = session::compile(Source::Text { name: "t.imp", text }, &[]);
    let scene = artefact.scene.expect(text);
    let fields = Fields::new(&scene, session::backend()).expect(text);
    let complex = solve(&fields, &Options::default(), None, &Control::default());
    (build(complex).unwrap_or_else(|fault| panic!("{text}: {fault:?}")), fields)
}

/// The bounded faces' areas, after a check that all faces together are the domain.
fn faces(arrangement: &Arrangement, fields: &Fields) -> Vec<Interval> {
    let areas = areas(arrangement, fields, &Precision::default());
    assert_eq!(areas[0], None);
    let known: Vec<Interval> = areas[1..].iter().map(|area| area.expect("a face without an area")).collect();
    let sum = known.iter().fold(Interval::ZERO, |sum, &area| sum + area);
    let [width, height] = arrangement.domain.map(|side| Interval::point(side.hi()) - Interval::point(side.lo()));
    assert!(sum.contains_interval(width * height), "{sum:?}");
    arrangement.faces[1..].iter().zip(known).filter(|(face, _)| face.bounded).map(|(_, area)| area).collect()
}

fn total_length(arrangement: &Arrangement, fields: &Fields) -> Interval {
    let lengths = lengths(arrangement, fields, &Precision::default());
    let edges = arrangement.edges.iter().zip(lengths).filter(|(edge, _)| edge.kind == EdgeKind::Curve);
    edges.fold(Interval::ZERO, |sum, (_, length)| sum + length)
}

fn encloses(found: Interval, exact: Interval, width: f64) {
    assert!(found.contains_interval(exact) && found.width() <= width, "{found:?} is not around {exact:?}");
}

fn point(x: f64) -> Interval {
    Interval::point(x)
}

#[test]
fn a_circle() {
    let (arrangement, fields) = arranged("domain [-2, 2]^2\ncurve c: x^2 + y^2 = 1");
    encloses(faces(&arrangement, &fields)[0], Interval::PI, 1e-5);
    encloses(total_length(&arrangement, &fields), point(2.0) * Interval::PI, 1e-5);
}

#[test]
fn the_lens_of_two_circles() {
    let (arrangement, fields) = arranged("domain [-2, 3]^2\ncurve a: x^2 + y^2 = 1\ncurve b: (x - 1)^2 + y^2 = 1");
    let mut areas = faces(&arrangement, &fields);
    areas.sort_by(|a, b| a.lo().total_cmp(&b.lo()));
    // 2 pi / 3 - sqrt(3) / 2.
    let lens = point(2.0) * Interval::PI / point(3.0) - point(3.0).sqrt() * point(0.5);
    encloses(areas[0], lens, 1e-5);
    encloses(areas[1], Interval::PI - lens, 1e-5);
    encloses(areas[2], Interval::PI - lens, 1e-5);
    encloses(total_length(&arrangement, &fields), point(4.0) * Interval::PI, 1e-4);
}

#[test]
fn an_ellipse_and_an_oval_with_a_node() {
    let (arrangement, fields) = arranged("domain [-4, 4]^2\ncurve c: x^2 / 9 + y^2 / 4 = 1");
    encloses(faces(&arrangement, &fields)[0], point(6.0) * Interval::PI, 1e-4);
    // Bernoulli's lemniscate: each loop has the area 1 / 2.
    let (arrangement, fields) = arranged("domain [-2, 2]^2\ncurve c: (x^2 + y^2)^2 = x^2 - y^2");
    for area in faces(&arrangement, &fields) {
        encloses(area, point(0.5), 1e-5);
    }
}

#[test]
fn polylines_and_splines_keep_their_tolerance() {
    let (arrangement, fields) =
        arranged("domain [-2, 2]^2\ncurve a: x^2 + y^2 = 1\ncurve b: y = x^3 - x / 2\ncurve l: y = x / 3");
    let tolerance = half_pixel(&arrangement.domain);
    for line in polylines(&arrangement, &fields, tolerance) {
        assert!(line.deviation <= tolerance, "{}", line.deviation);
        assert!(line.points.len() >= 2);
    }
    for (spline, edge) in splines(&arrangement, &fields, tolerance).iter().zip(&arrangement.edges) {
        assert!(spline.error() <= tolerance, "{} {}", spline.measured, spline.deviation);
        assert!(edge.kind != EdgeKind::Curve || spline.path.segments().count() >= 1);
    }
}
