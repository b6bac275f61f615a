//! Plane scenes: pixels as boxes.

use imp::graph::Graph;
use imp::graph::Op;
use imp::graph::Value;
use imp::interval::Interval;
use imp::program::scene::Scene;
use imp::program::scene::ShapeKind;
use imp::render::Certainty;
use imp::render::Options;
use imp::render::Picture;
use imp::session;
use imp::session::Source;

use crate::scenes::*;

fn plane(kind: ShapeKind, build: impl FnOnce(&mut Graph, Value, Value) -> Value) -> Scene {
    let mut scene = scene(kind, |graph, [x, y, _]| build(graph, x, y));
    scene.domain.truncate(2);
    scene
}

fn circle(graph: &mut Graph, x: Value, y: Value) -> Value {
    let squares = [x, y].map(|c| graph.sqr(c));
    let sum = graph.add(squares[0], squares[1]);
    let one = graph.int(1);
    graph.sub(sum, one)
}

/// The box of a pixel, widened by a little: the raster is moved against the domain by less than a twentieth of a pixel.
fn area(picture: &Picture, index: usize, slack: f64) -> [[f64; 2]; 2] {
    let size = f64::from(picture.width);
    let pixel = 4.0 / size;
    let (x, y) = ((index % picture.width as usize) as f64, (index / picture.width as usize) as f64);
    let range = |start: f64| [start - slack * pixel, start + (1.0 + slack) * pixel];
    [range(-2.0 + x * pixel), range(2.0 - (y + 1.0) * pixel)]
}

/// The least and the greatest distance of a box from the origin.
fn distances([x, y]: [[f64; 2]; 2]) -> (f64, f64) {
    let least = |[lo, hi]: [f64; 2]| {
        if lo > 0.0 {
            lo
        } else if hi < 0.0 {
            -hi
        } else {
            0.0
        }
    };
    let most = |[lo, hi]: [f64; 2]| lo.abs().max(hi.abs());
    (least(x).hypot(least(y)), most(x).hypot(most(y)))
}

#[test]
fn a_circle_is_proved_pixel_by_pixel() {
    let picture = draw(&plane(ShapeKind::Equation, circle), &options(150));
    assert_eq!(picture.stats.unknown, 0, "{:?}", picture.stats);
    assert!(picture.stats.proved > 250);
    for (index, &certainty) in picture.certainty.iter().enumerate() {
        let (wide, narrow) = (distances(area(&picture, index, 0.05)), distances(area(&picture, index, -0.05)));
        match certainty {
            Certainty::Hit => assert!(wide.0 <= 1.0 && 1.0 <= wide.1, "pixel {index}"),
            Certainty::Miss => assert!(!(narrow.0 < 1.0 && 1.0 < narrow.1), "pixel {index}"),
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn a_disc_is_filled() {
    let picture = draw(&plane(ShapeKind::Region, circle), &options(120));
    assert_eq!(picture.stats.unknown, 0, "{:?}", picture.stats);
    let share = picture.stats.proved as f64 / picture.stats.pixels as f64;
    assert!((share - std::f64::consts::PI / 16.0).abs() < 0.02, "{share}");
}

#[test]
fn axes_of_symmetry_are_found() {
    // x y = 0 runs along round numbers, where pixels would have their edges if the raster were not moved.
    let picture = draw(&plane(ShapeKind::Equation, |graph, x, y| graph.mul(x, y)), &options(128));
    assert_eq!(picture.stats.proved, 255, "{:?}", picture.stats);
}

#[test]
fn poles_are_not_proved() {
    // y = 1 / x: the pole is the y axis; the curve comes near it only at the picture's edge.
    let hyperbola = plane(ShapeKind::Equation, |graph, x, y| {
        let one = graph.int(1);
        let inverse = graph.div(one, x);
        graph.sub(y, inverse)
    });
    let picture = draw(&hyperbola, &options(101));
    for row in 0..101 {
        assert_ne!(picture.certainty[row * 101 + 50], Certainty::Hit, "row {row}");
    }
    assert!(picture.stats.proved > 100);
}

#[test]
fn double_curves_are_curves() {
    let double = plane(ShapeKind::Equation, |graph, x, y| {
        let field = circle(graph, x, y);
        graph.sqr(field)
    });
    let picture = draw(&double, &options(64)).stats;
    let simple = draw(&plane(ShapeKind::Equation, circle), &options(64)).stats;
    assert_eq!((picture.proved, picture.unknown), (simple.proved, 0));
}

/// A plane scene from its text.
fn text(text: &str) -> Scene {
    let artefact = session::compile(Source::Text { name: "relation.imp", text }, &[]);
    artefact.scene.unwrap_or_else(|| panic!("{:?}", artefact.diagnostics))
}

#[test]
fn steps_are_not_joined() {
    // Six steps; nothing between them, and nothing unknown. Pixel k is [k / 10 - 2.95, (k + 1) / 10 - 2.95], moved by less
    // than a twentieth.
    let picture = draw(&text("curve c: y = floor(x)\ndomain [-2.95, 2.95]^2"), &options(59));
    assert_eq!(picture.stats.unknown, 0, "{:?}", picture.stats);
    for (index, &certainty) in picture.certainty.iter().enumerate() {
        let row = 58 - index / 59;
        assert!(certainty == Certainty::Miss || row % 10 == 9, "column {}, row {row}", index % 59);
    }
    assert!((50..=60).contains(&picture.stats.proved), "{:?}", picture.stats);
    for relation in ["y = mod(x, 1)", "y = (if x < 0.1 then x else 2 - x)", "y = floor(x) + floor(2x) / 4"] {
        let stats = draw(&text(&format!("curve c: {relation}\ndomain [-2.95, 2.95]^2")), &options(90)).stats;
        assert_eq!(stats.unknown, 0, "{relation}: {stats:?}");
    }
}

#[test]
fn equations_of_steps_have_areas() {
    // Six squares along the diagonal, each ten pixels wide and touching eleven.
    let picture = draw(&text("curve c: floor(x) = floor(y)\ndomain [-2.95, 2.95]^2"), &options(59)).stats;
    assert_eq!(picture.unknown, 0, "{picture:?}");
    assert!((580..=726).contains(&picture.proved), "{picture:?}");
}

#[test]
fn two_equations_hold_at_points() {
    let size = &options(100);
    let none = draw(&text("curve c: y = x and y = x + 1e-5\ndomain [-10, 10]^2"), size).stats;
    assert_eq!((none.proved, none.unknown), (0, 0), "{none:?}");
    let four = draw(&text("curve c: y = x^2 - 4 and x^2 + y^2 = 16\ndomain [-10, 10]^2"), size).stats;
    // y = -4 with a double contact at x = 0, which no interval can decide, and y = 3 at two points.
    assert_eq!((four.proved, four.unknown), (2, 1), "{four:?}");
    let right = draw(&text("curve c: y = x^2 - 4 and x^2 + y^2 = 16 and x > 0.5\ndomain [-10, 10]^2"), size).stats;
    assert_eq!((right.proved, right.unknown), (1, 0), "{right:?}");
    let same = draw(&text("curve c: y = x and 2y = 2x\ndomain [-10, 10]^2"), size).stats;
    assert!(same.misses <= same.pixels - 199, "{same:?}");
}

#[test]
fn dense_oscillations_are_proved() {
    // Beyond x + y = 7 the curves are closer than pixels. Open stay pixels that only the tips of the waves may reach, at
    // y - x = 1 and -1: 68 of them.
    let scene = text("curve c: y - x = sin(exp(x + y))\ndomain [-10, 10]^2");
    let picture = draw(&scene, &options(128));
    assert!(picture.stats.proved > 850 && picture.stats.unknown < 80, "{:?}", picture.stats);
    let single = draw(&scene, &Options { threads: Some(1), ..options(128) });
    assert_eq!(picture.certainty, single.certainty);
}

#[test]
fn crossings_of_families_of_curves_are_proved() {
    let picture = draw(&text("curve c: sin(x) = cos(y)\ndomain [-10, 10]^2"), &options(128)).stats;
    assert_eq!(picture.unknown, 0, "{picture:?}");
    let waves = draw(&text("curve c: sin(x^2 + y^2) = cos(x y)\ndomain [-5, 5]^2"), &options(128)).stats;
    assert!(waves.unknown < 8, "{waves:?}");
}

#[test]
fn regions_with_jumps_are_decided() {
    let picture = draw(&text("curve c: y < floor(x)\ndomain [-2.95, 2.95]^2"), &options(59)).stats;
    assert_eq!(picture.unknown, 0, "{picture:?}");
}

#[test]
fn conditions_cut_curves() {
    let mut scene = plane(ShapeKind::Equation, circle);
    let x = scene.graph.var("x");
    let zero = scene.graph.int(0);
    scene.shapes[0].condition = Some(scene.graph.push(Op::Less, &[zero, x]));
    let half = draw(&scene, &options(150)).stats;
    let whole = draw(&plane(ShapeKind::Equation, circle), &options(150)).stats;
    assert!(half.unknown <= 4 && (half.proved as f64 / whole.proved as f64 - 0.5).abs() < 0.03, "{half:?}");
}

#[test]
fn wide_pictures_show_no_more_than_the_domain() {
    let mut scene = plane(ShapeKind::Region, |graph, x, _| {
        let three = graph.int(3);
        graph.sub(x, three)
    });
    scene.domain[1] = Interval::new(-1.0, 1.0).unwrap();
    let picture = draw(&scene, &Options { width: 80, height: 80, ..options(80) });
    // The domain is 80 by 40 pixels; the rows at its edges lie in it partly.
    assert!(picture.stats.proved >= 80 * 40 && picture.stats.proved <= 80 * 42, "{:?}", picture.stats);
}
