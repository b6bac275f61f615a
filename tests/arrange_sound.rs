//! Scenes made to deceive the solver of arrangements: each once showed, or could have shown, something false as proved.

use imp::arrange::Arrangement;
use imp::arrange::Options;
use imp::arrange::arrange;
use imp::arrange::complex::VertexKind;
use imp::control::Control;
use imp::session::{self, Source};

fn arranged(text: &str) -> Arrangement {
    let artefact = session::compile(Source::Text { name: "scene.imp", text }, &[]);
    let scene = artefact.scene.unwrap_or_else(|| panic!("{:?}", artefact.diagnostics));
    arrange(&scene, &Options::default(), session::backend(), &Control::default()).expect("this is a plane scene")
}

/// The x of all vertices of a kind, rising.
fn places(arrangement: &Arrangement, kind: VertexKind) -> Vec<f64> {
    let vertices = arrangement.vertices.iter().map(|v| &v.vertex).filter(|v| v.kind == kind);
    let mut places: Vec<f64> = vertices.map(|v| v.area[0].mid()).collect();
    places.sort_by(f64::total_cmp);
    places
}

#[test]
fn formulas_of_one_shape_keep_their_parameters() {
    // Eight lines share a kernel that takes their constants as inputs; parameters are no constants, whatever their names.
    let mut scene = "param a = 0.1 in [0, 1]\nparam c0 = 0.5 in [0, 1]\ndomain [-2, 2]^2\n".to_owned();
    for k in 1..=8 {
        scene += &format!("curve a{k}: x = a + 0.{k}\ncurve b{k}: x = c0 + 1.0{k}\n");
    }
    let found = places(&arranged(&scene), VertexKind::Boundary);
    let mut expected: Vec<f64> =
        (1..=8).flat_map(|k| [0.1 + f64::from(k) / 10.0, 1.5 + f64::from(k) / 100.0]).collect();
    expected.sort_by(f64::total_cmp);
    assert_eq!(found.len(), 32);
    for (pair, x) in found.chunks(2).zip(expected) {
        assert!(pair.iter().all(|found| (found - x).abs() < 1e-9), "{pair:?} {x}");
    }
}

#[test]
fn an_overflow_proves_nothing() {
    let huge = arranged("curve a: 10^160 y + x = 0\ncurve b: 10^160 (y - x^2 + 0.01) + x = 0\ndomain [-1, 1]^2");
    assert!(places(&huge, VertexKind::Crossing).len() == 2 || !huge.proved);
}

#[test]
fn single_points_of_a_condition_are_not_lost() {
    for scene in [
        "curve a: y = 0 where x >= 0 and x <= 0",
        "curve a: y = 0 where x != 0",
        "curve a: y / x = 0",
        "curve a: y = 0\ncurve b: y = 0 where x >= 0 and x <= 0",
    ] {
        let arrangement = arranged(&format!("{scene}\ndomain [-1, 1]^2"));
        assert!(!arrangement.proved, "{scene}");
        assert!(!places(&arrangement, VertexKind::Cluster).is_empty(), "{scene}");
    }
}

#[test]
fn curves_end_where_their_own_condition_does() {
    let ends = arranged("curve a: y = 0 where x > 0 and x > 0.3\ncurve b: y = 0 where x > 0.1\ndomain [-1, 1]^2");
    let found = places(&ends, VertexKind::End);
    assert!(found.len() == 2 && (found[0] - 0.1).abs() < 1e-12 && (found[1] - 0.3).abs() < 1e-12, "{found:?}");
}

#[test]
fn vertices_name_the_curves_through_them() {
    // The origin is an isolated point of the cubic, so none of the four arms belongs to it.
    let point = arranged("curve a: y^2 = x^2 (x - 1)\ncurve b: y = 2x\ndomain [-1.9, 2.1]^2");
    let origin = point.vertices.iter().find(|v| v.vertex.kind == VertexKind::Singular).expect("it is singular");
    assert_eq!(origin.vertex.curves, [0, 1]);
    assert!(point.proved);
    // A line through a crossing of two lines that are one curve.
    let lines = arranged("curve a: x y = 0\ncurve b: y = x\ndomain [-1, 1.1] x [-1.2, 1]");
    assert_eq!(places(&lines, VertexKind::Singular).len(), 1);
    assert!(lines.proved);
}

#[test]
fn merged_scenes_have_the_overlay_of_their_arrangements() {
    let scene = |text: &str| session::compile(Source::Text { name: "scene.imp", text }, &[]).scene.expect("a scene");
    let circle = scene("param r = 1 in [0, 2]\ncurve c: x^2 + y^2 = r^2\ndomain [-3, 3]^2");
    let other = scene("param r = 1 in [0, 2]\ncurve c: (x - 1)^2 + y^2 = r^2\ndomain [-3, 3]^2");
    let both = imp::arrange::merge(&circle, &other).expect("they agree");
    assert_eq!(both.shapes.iter().map(|shape| &shape.name[..]).collect::<Vec<_>>(), ["c", "c2"]);
    let overlay = arrange(&both, &Options::default(), session::backend(), &Control::default()).expect("a plane scene");
    assert_eq!((places(&overlay, VertexKind::Crossing).len(), overlay.faces.len(), overlay.proved), (2, 5, true));
    for wrong in ["param r = 2 in [0, 2]\ncurve d: x = r\ndomain [-3, 3]^2", "curve d: x = y\ndomain [-3, 2]^2"] {
        assert!(imp::arrange::merge(&circle, &scene(wrong)).is_err());
    }
}

#[test]
fn the_plane_has_its_points_at_infinity() {
    let arranged = |curves: &str| {
        let text = format!("{curves}\ndomain [-1, 1]^2");
        let scene = session::compile(Source::Text { name: "scene.imp", text: &text }, &[]).scene.expect("a scene");
        let whole = imp::arrange::projective(&scene).expect("polynomials");
        arrange(&whole, &Options::default(), session::backend(), &Control::default()).expect("a plane scene")
    };
    // Parallel lines meet at infinity, in two directions, which exact arithmetic proves; oblique ones meet once besides.
    let parallel = arranged("curve a: y = x\ncurve b: y = x + 1");
    assert!(parallel.proved);
    assert_eq!(places(&parallel, VertexKind::Crossing).len(), 2);
    // A hyperbola goes to infinity in four directions, a parabola touches it in one.
    let hyperbola = arranged("curve h: x y = 1");
    assert_eq!((places(&hyperbola, VertexKind::Crossing).len(), hyperbola.proved), (4, true));
    let text = "curve s: y = sin(x)\ndomain [-1, 1]^2";
    let sine = session::compile(Source::Text { name: "scene.imp", text }, &[]).scene.expect("a scene");
    assert!(imp::arrange::projective(&sine).is_err());
}
