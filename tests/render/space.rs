//! The ray caster against analytic hits, whatever the threads and the packing of lanes, and on the cases that must stay
//! unknown.

use std::sync::atomic::AtomicBool;
use std::sync::atomic::AtomicUsize;
use std::sync::atomic::Ordering;

use imp::derive::Precision;
use imp::derive::Rounding;
use imp::graph::Op;
use imp::interpret::Interpreter;
use imp::interval::Interval;
use imp::program::scene::Projection;
use imp::program::scene::Scene;
use imp::program::scene::Shape;
use imp::program::scene::ShapeKind;
use imp::render::Certainty;
use imp::render::Control;
use imp::render::Layers;
use imp::render::Options;
use imp::render::Picture;
use imp::render::Renderer;
use imp::render::Stop;
use imp::render::Surface;
use imp::render::render;
use imp::render::verify;

use crate::scenes::*;

fn count(picture: &Picture, certainty: Certainty) -> usize {
    picture.certainty.iter().filter(|&&c| c == certainty).count()
}

/// The ray of each drawn pixel is recovered from nothing: what is checked is that the reported bracket, distance and
/// normal agree with the sphere seen from the same eye.
#[test]
fn a_sphere_is_hit_where_it_is() {
    let scene = scene(ShapeKind::Equation, sphere);
    let picture = draw(&scene, &options(160));
    let hits = count(&picture, Certainty::Hit);
    assert!(hits > 1400, "{hits} proved hits");
    assert!(count(&picture, Certainty::Unknown) <= 4, "{:?}", picture.stats);
    let mut nearest = f64::INFINITY;
    for (index, depth) in picture.depth.iter().enumerate().filter_map(|(i, depth)| Some((i, depth.as_ref()?))) {
        let [a, b] = depth.bracket;
        assert!(a < b && a <= depth.t && depth.t <= b, "{depth:?}");
        assert_eq!(b - a, 4.0 / 65536.0, "not a cell of depth 16: {depth:?}");
        assert_eq!(a % (4.0 / 65536.0), 0.0, "not on the grid: {depth:?}");
        let normal = picture.normal[index];
        assert!((normal.iter().map(|n| n * n).sum::<f32>() - 1.0).abs() < 1e-5);
        nearest = nearest.min(depth.distance);
    }
    // The nearest point of the unit sphere lies one unit in front of its centre, on the line of sight.
    let eye = nearest + 1.0;
    let farthest = picture.depth.iter().flatten().map(|depth| depth.distance).fold(0.0, f64::max);
    assert!(farthest <= (eye * eye - 1.0).sqrt() + 1e-9, "no visible point lies behind the horizon");
    assert!(farthest > (eye * eye - 1.0).sqrt() - 0.1);
}

/// A camera on the y axis sees the sphere with rays that can be written down.
#[test]
fn brackets_hold_the_analytic_root() {
    let mut scene = scene(ShapeKind::Equation, sphere);
    scene.view.camera.position = Some([0.0, -5.0, 0.0]);
    scene.view.camera.fov = Some(40.0);
    for precision in [Precision::Single, Precision::Double] {
        let picture = draw(&scene, &Options { precision, ..options(97) });
        let pixel = 2.0 * 20f64.to_radians().tan() / 97.0;
        let mut hits = 0;
        for y in 0..97u32 {
            for x in 0..97u32 {
                // The direction is (u, 1, v), so t is measured along y.
                let (u, v) = ((f64::from(x) - 48.0) * pixel, (48.0 - f64::from(y)) * pixel);
                let (a, b) = (u * u + v * v + 1.0, -5.0);
                let discriminant = b * b - 24.0 * a;
                let depth = picture.depth[picture.index(x, y)];
                if discriminant.abs() < 1e-9 {
                    continue;
                }
                assert_eq!(depth.is_some(), discriminant > 0.0, "pixel ({x}, {y})");
                if let Some(depth) = depth {
                    let root = (-b - discriminant.sqrt()) / a;
                    assert!(depth.bracket[0] - 1e-9 <= root && root <= depth.bracket[1] + 1e-9, "{root}, {depth:?}");
                    assert!((depth.t - root).abs() < 1e-7, "{root}, {depth:?}");
                    hits += 1;
                }
            }
        }
        assert!(hits > 1000);
    }
}

#[test]
fn parallel_rays_hit_a_torus_and_planes() {
    let mut torus = scene(ShapeKind::Equation, |graph, [x, y, z]| {
        let around = graph.push(Op::Hypot, &[x, y]);
        let big = graph.int(1);
        let off = graph.sub(around, big);
        let (off, z) = (graph.sqr(off), graph.sqr(z));
        let tube = graph.add(off, z);
        let small = number(graph, 4, 25);
        graph.sub(tube, small)
    });
    torus.view.camera.projection = Some(Projection::Orthographic);
    torus.view.camera.position = Some([0.0, 0.0, 3.0]);
    torus.view.camera.target = Some([0.0, 0.0, 0.0]);
    torus.view.camera.fov = Some(60.0);
    let picture = draw(&torus, &options(90));
    let pixel = 2.0 * 3.0 * 30f64.to_radians().tan() / 90.0;
    for y in 0..90u32 {
        for x in 0..90u32 {
            let (u, v) = ((f64::from(x) - 44.5) * pixel, (44.5 - f64::from(y)) * pixel);
            let square = 0.16 - (u.hypot(v) - 1.0).powi(2);
            if square.abs() < 1e-6 {
                continue;
            }
            let depth = picture.depth[picture.index(x, y)];
            assert_eq!(depth.is_some(), square > 0.0, "pixel ({x}, {y})");
            if let Some(depth) = depth {
                assert!((depth.t - (3.0 - square.sqrt())).abs() < 1e-6, "{depth:?}");
            }
        }
    }
    // Two planes that cross: x y = 0. On their common line the field has no sign change along rays in a plane only.
    let planes = scene(ShapeKind::Equation, |graph, [x, y, _]| graph.mul(x, y));
    let picture = draw(&planes, &options(64));
    assert!(count(&picture, Certainty::Hit) > 900, "{:?}", picture.stats);
    assert!(count(&picture, Certainty::Unknown) < 32, "{:?}", picture.stats);
}

/// Everything but the time it took.
fn fingerprint(picture: &Picture) -> String {
    let Picture { certainty, color, depth, normal, stats, .. } = picture;
    format!("{certainty:?} {color:?} {depth:?} {normal:?} {:?}", stats.evaluations)
}

#[test]
fn threads_do_not_show() {
    let scene = scene(ShapeKind::Equation, |graph, p| {
        let square = square_length(graph, p);
        let wave = graph.int(9);
        let wave = graph.mul(wave, p[0]);
        let wave = graph.unary(Op::Sin, wave);
        let sum = graph.add(square, wave);
        let one = graph.int(2);
        graph.sub(sum, one)
    });
    let pictures: Vec<String> =
        [1, 2, 5].map(|threads| fingerprint(&draw(&scene, &Options { threads: Some(threads), ..options(150) }))).into();
    assert!(pictures[0] == pictures[1] && pictures[1] == pictures[2]);
}

/// Either backend is right, so proved pixels may differ in number but never in what they say.
#[test]
fn backends_never_contradict_each_other() {
    let scene = scene(ShapeKind::Equation, sphere);
    let options = options(48);
    let compiled = draw(&scene, &options);
    let reference = render(&scene, &options, &Interpreter, &Control::default()).unwrap();
    for (a, b) in compiled.certainty.iter().zip(&reference.certainty) {
        let contradiction = matches!((a, b), (Certainty::Hit, Certainty::Miss) | (Certainty::Miss, Certainty::Hit));
        assert!(!contradiction);
    }
}

/// (r^2 - 0.64)^2 = 0: no sign changes anywhere, so no hit may be proved.
#[test]
fn a_double_sphere_stays_unknown() {
    for stop in [Stop::Depth(10), Stop::Depth(16), Stop::Tolerance(1e-3)] {
        let scene = scene(ShapeKind::Equation, |graph, p| {
            let square = square_length(graph, p);
            let radius = number(graph, 16, 25);
            let off = graph.sub(square, radius);
            graph.sqr(off)
        });
        let picture = draw(&scene, &Options { stop, ..options(64) });
        assert_eq!(picture.stats.proved, 0);
        assert!(picture.stats.unknown > 100 && picture.stats.misses > 1000, "{:?}", picture.stats);
        assert_eq!(picture.stats.hits, picture.stats.unknown, "what is unknown is drawn all the same");
    }
}

/// y = 1 / x has a pole at x = 0, which its numerator refutes.
#[test]
fn a_rational_pole_is_refuted() {
    let mut scene = scene(ShapeKind::Equation, |graph, [x, y, _]| {
        let one = graph.int(1);
        let inverse = graph.div(one, x);
        graph.sub(y, inverse)
    });
    scene.view.camera.position = Some([3.0, -9.0, 1.0]);
    let picture = draw(&scene, &Options { certificate: true, ..options(64) });
    assert!(picture.stats.proved > 500 && picture.stats.unknown < 16, "{:?}", picture.stats);
    let report = verify(&scene, &picture.certificate.unwrap(), &Interpreter, &Control::default()).unwrap();
    assert_eq!(report.counts.proved, picture.stats.proved);
}

/// y = cbrt(1 / x): a pole that no numerator refutes, since it is inside a root. The sheets are hits, the pole is not.
#[test]
fn a_pole_is_no_hit() {
    let mut scene = scene(ShapeKind::Equation, |graph, [x, y, _]| {
        let one = graph.int(1);
        let inverse = graph.div(one, x);
        let root = graph.unary(Op::Cbrt, inverse);
        graph.sub(y, root)
    });
    scene.view.camera.position = Some([3.0, -9.0, 1.0]);
    let picture = draw(&scene, &options(64));
    assert!(picture.stats.proved > 300 && picture.stats.unknown > 30, "{:?}", picture.stats);
    for (index, depth) in picture.depth.iter().enumerate() {
        let Some(depth) = depth else { continue };
        if picture.certainty[index] == Certainty::Hit {
            assert!(depth.bracket[1] - depth.bracket[0] < 1e-3, "{depth:?}");
        }
    }
    // Drawn where a sign changes without continuity, if that is asked for, and never proved there.
    let with_poles = draw(&scene, &Options { poles: true, ..options(64) });
    assert!(with_poles.stats.hits >= picture.stats.hits);
    assert_eq!(with_poles.stats.proved, picture.stats.proved);
}

/// A thin shell seen along its silhouette: x^2 + y^2 + z^2 = 1 and a plate of thickness 2e-4.
#[test]
fn thin_things_are_not_lost() {
    let plate = scene(ShapeKind::Region, |graph, [_, _, z]| {
        let distance = graph.unary(Op::Abs, z);
        let half = number(graph, 1, 10_000);
        graph.sub(distance, half)
    });
    let mut plate = plate;
    plate.view.camera.position = Some([0.0, -8.0, 0.5]);
    let picture = draw(&plate, &options(96));
    // The plate fills the middle of the picture as wide as the domain.
    assert!(picture.stats.hits > 150, "{:?}", picture.stats);
    assert!(picture.stats.unknown * 20 < picture.stats.hits, "{:?}", picture.stats);
}

#[test]
fn solids_are_cut_by_the_domain() {
    // The half space z <= 0, seen from above: everything that enters the domain below the plane shows its face.
    let mut half = scene(ShapeKind::Region, |_, [_, _, z]| z);
    half.view.camera.position = Some([3.0, -9.0, 4.0]);
    let picture = draw(&half, &options(80));
    let mut faces = [0usize; 2];
    for (index, depth) in picture.depth.iter().enumerate() {
        let Some(depth) = depth else { continue };
        match depth.surface {
            Surface::Field => {
                faces[0] += 1;
                assert!(picture.normal[index][2] > 0.999);
            }
            Surface::Face(axis) => {
                faces[1] += 1;
                let normal = picture.normal[index];
                assert_eq!(normal[usize::from(axis)], if axis == 1 { -1.0 } else { 1.0 });
            }
            other => panic!("{other:?}"),
        }
    }
    assert!(faces[0] > 300 && faces[1] > 300, "{faces:?}");
    assert!(picture.stats.unknown < 40, "{:?}", picture.stats);
}

#[test]
fn conditions_cut_and_keep_proofs() {
    let mut scene = scene(ShapeKind::Equation, sphere);
    // Only the upper half of the sphere.
    let z = scene.graph.var("z");
    let zero = scene.graph.int(0);
    scene.shapes[0].condition = Some(scene.graph.push(Op::Less, &[zero, z]));
    let whole = draw(&self::scene(ShapeKind::Equation, sphere), &options(96));
    let picture = draw(&scene, &options(96));
    assert!(picture.stats.proved > 300 && picture.stats.proved < whole.stats.proved);
    assert!(picture.stats.unknown < 20, "{:?}", picture.stats);
}

#[test]
fn nearer_shapes_hide_farther_ones() {
    let mut scene = scene(ShapeKind::Equation, sphere);
    // A second sphere around it hides the first altogether.
    let p = ["x", "y", "z"].map(|name| scene.graph.var(name));
    let square = square_length(&mut scene.graph, p);
    let two = scene.graph.int(2);
    let field = scene.graph.sub(square, two);
    let outer = Shape { name: "surface2".to_owned(), field, ..scene.shapes[0].clone() };
    scene.shapes.push(outer);
    let picture = draw(&scene, &options(96));
    assert!(picture.depth.iter().flatten().all(|depth| depth.shape == 1));
    assert!(picture.stats.proved > 500 && picture.stats.unknown < 10, "{:?}", picture.stats);
}

#[test]
fn unrounded_arithmetic_proves_nothing() {
    let scene = scene(ShapeKind::Equation, sphere);
    let picture = draw(&scene, &Options { rounding: Rounding::Nearest, ..options(64) });
    assert_eq!((picture.stats.proved, picture.stats.misses), (0, 0));
    assert!(picture.stats.hits > 200);
    assert!(picture.certainty.iter().all(|&c| c == Certainty::Unverified));
    assert!(
        render(
            &scene,
            &Options { rounding: Rounding::Nearest, certificate: true, ..options(64) },
            backend().as_ref(),
            &Control::default()
        )
        .is_err()
    );
}

#[test]
fn work_can_be_stopped() {
    let scene = scene(ShapeKind::Equation, sphere);
    let cancel = AtomicBool::new(true);
    let result = render(&scene, &options(64), backend().as_ref(), &Control::new(None, Some(&cancel)));
    assert_eq!(result.unwrap_err().code, "E0504");
    let steps = AtomicUsize::new(0);
    let count = |_: usize, _: usize| {
        steps.fetch_add(1, Ordering::Relaxed);
    };
    render(&scene, &options(130), backend().as_ref(), &Control::new(Some(&count), None)).unwrap();
    assert_eq!(steps.load(Ordering::Relaxed), 9);
}

#[test]
fn impossible_pictures_are_refused() {
    let scene = scene(ShapeKind::Equation, sphere);
    let code = |scene: &Scene, options: &Options| {
        render(scene, options, backend().as_ref(), &Control::default()).unwrap_err().code
    };
    assert_eq!(code(&scene, &Options { width: 0, ..options(64) }), "E0503");
    let mut blind = scene.clone();
    blind.view.camera.fov = Some(-3.0);
    assert_eq!(code(&blind, &options(8)), "E0501");
    let mut flat = scene.clone();
    flat.domain[1] = Interval::point(1.0);
    assert_eq!(code(&flat, &options(8)), "E0502");
    flat.domain[1] = Interval::ENTIRE;
    assert_eq!(code(&flat, &options(8)), "E0502");
}

#[test]
fn odd_cameras_are_drawn() {
    let inside = |position, target, fov| {
        let mut scene = scene(ShapeKind::Equation, sphere);
        scene.view.camera.position = Some(position);
        scene.view.camera.target = Some(target);
        scene.view.camera.fov = Some(fov);
        draw(&scene, &options(40)).stats
    };
    // From inside the sphere every ray hits it.
    let stats = inside([0.0; 3], [1.0, 0.0, 0.0], 150.0);
    assert!(stats.proved + 8 >= stats.pixels, "{stats:?}");
    // Straight down, along the usual up direction.
    assert!(inside([0.0, 0.0, 6.0], [0.0; 3], 30.0).proved > 100);
    // Away from everything.
    assert_eq!(inside([0.0, 0.0, 6.0], [0.0, 0.0, 7.0], 30.0).misses, 1600);
    // From far away.
    assert!(inside([0.0, -1e6, 0.0], [0.0; 3], 1e-4).proved > 100);
}

#[test]
fn layers_that_nobody_asked_for_are_not_computed() {
    let scene = scene(ShapeKind::Equation, sphere);
    let layers = Layers { color: false, depth: true, normal: false, certainty: false };
    let picture = draw(&scene, &Options { layers, ..options(64) });
    assert_eq!(picture.stats.evaluations.gradient, 0);
    assert!(picture.color.is_empty() && picture.normal.is_empty() && !picture.depth.is_empty());
    let mut dark = scene;
    dark.view.lights = Some(Vec::new());
    let layers = Layers::default();
    let picture = draw(&dark, &Options { layers, ..options(64) });
    assert_eq!(picture.stats.evaluations.gradient, 0);
    let plan = Renderer::new(&dark, &options(64), backend().as_ref()).unwrap().plan().to_string();
    assert!(plan.contains("kernel surface1.beam") && plan.contains("flat"), "{plan}");
}
