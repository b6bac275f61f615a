//! The named root finders: what they claim holds, they agree where they should, and they end.

use imp::accuracy::finder::Finder;
use imp::accuracy::finder::Sampled;
use imp::accuracy::finder::Settings;
use imp::accuracy::finder::sample;
use imp::derive::Arithmetic;
use imp::derive::Precision;
use imp::derive::Rounding;
use imp::program::Scene;
use imp::render::Certainty;
use imp::render::Control;
use imp::render::Layers;
use imp::render::Options;
use imp::render::Ray;
use imp::render::Renderer;
use imp::session;
use imp::session::Source;

const SIDE: u32 = 24;

fn scene(text: &str) -> Scene {
    let artefact = session::compile(Source::Text { name: "finders.imp", text }, &[]);
    artefact.scene.unwrap_or_else(|| panic!("{text}: {:?}", artefact.diagnostics))
}

fn settings(finder: Finder, epsilon: f64) -> Settings {
    Settings {
        finder,
        precision: Precision::Double,
        rounding: Rounding::Outward,
        arithmetic: Arithmetic::Interval,
        epsilon,
    }
}

fn renderer(scene: &Scene) -> Renderer {
    let layers = Layers { depth: true, ..Layers::default() };
    let options = Options { width: SIDE, height: SIDE, precision: Precision::Double, layers, ..Options::default() };
    Renderer::new(scene, &options, session::backend()).unwrap()
}

fn sampled(scene: &Scene, settings: &Settings) -> Sampled {
    let renderer = renderer(scene);
    sample(scene, &|x, y| renderer.ray(x, y), (SIDE, SIDE), settings, session::backend()).unwrap()
}

/// The sphere of radius 1: where its rays meet it first, if they do.
fn sphere_root(ray: &Ray) -> Option<f64> {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (a, b, c) =
        (dot(ray.direction, ray.direction), dot(ray.origin, ray.direction), dot(ray.origin, ray.origin) - 1.0);
    let discriminant = b * b - a * c;
    (discriminant >= 0.0).then(|| (-b - discriminant.sqrt()) / a)
}

#[test]
fn no_finder_passes_the_first_root_of_a_sphere() {
    let scene = scene("x^2 + y^2 + z^2 = 1\ndomain [-1.5, 1.5]^3");
    let renderer = renderer(&scene);
    for finder in Finder::ALL {
        for precision in [Precision::Single, Precision::Double] {
            for arithmetic in [Arithmetic::Interval, Arithmetic::Affine] {
                let settings = Settings { precision, arithmetic, ..settings(finder, 1e-3) };
                let sampled = sampled(&scene, &settings);
                let mut hits = 0;
                for (pixel, bracket) in sampled.depth.iter().enumerate() {
                    let ray = renderer.ray(pixel as u32 % SIDE, pixel as u32 / SIDE).unwrap();
                    match (sphere_root(&ray), bracket) {
                        // The closed form errs by some 1e-15 of the distance.
                        (Some(root), Some([start, end])) => {
                            hits += 1;
                            assert!(*start <= root + 1e-12, "{settings:?} {pixel}: {root} before {start}");
                            let proved = sampled.proved[pixel];
                            assert!(!proved || root - 1e-12 <= *end, "{settings:?} {pixel}: {root} after {end}");
                        }
                        (Some(root), None) => panic!("{settings:?} {pixel}: misses {root}"),
                        (None, _) => assert!(!sampled.proved[pixel], "{settings:?} {pixel}: proves a miss as a hit"),
                    }
                }
                let proved = sampled.proved.iter().filter(|&&proved| proved).count();
                assert!(hits > 100 && proved > hits / 2, "{settings:?}: {proved} of {hits}");
            }
        }
    }
}

/// Every method that looks at single rays, or at packets, finds the same first root as Imp's own engine proves.
#[test]
fn finders_agree_with_the_engine_on_a_torus() {
    let scene = scene(
        "let R = 1\nlet r = 0.4\nsurface torus: (x^2 + y^2 + z^2 + R^2 - r^2)^2 = 4R^2 (x^2 + y^2) where z < 0.3\n\
         domain [-1.6, 1.6]^3",
    );
    let picture = renderer(&scene).render(&scene.parameters, &Control::default()).unwrap();
    for finder in Finder::ALL {
        let sampled = sampled(&scene, &settings(finder, 1e-6));
        let mut both = 0;
        for pixel in 0..sampled.depth.len() {
            let proved = match picture.certainty[pixel] {
                Certainty::Hit => picture.depth[pixel],
                Certainty::Miss => {
                    assert!(!sampled.proved[pixel], "{finder:?} proves a hit where there is none: {pixel}");
                    continue;
                }
                Certainty::Unknown | Certainty::Unverified => continue,
            };
            let first = proved.expect("a hit has a depth").bracket;
            let [start, end] = sampled.depth[pixel].unwrap_or_else(|| panic!("{finder:?} misses {pixel}"));
            assert!(start <= first[1], "{finder:?} passes the first root at {pixel}: {start} after {first:?}");
            if sampled.proved[pixel] {
                both += 1;
                // Both brackets hold the first root.
                assert!(first[0] <= end, "{finder:?} stops before the first root at {pixel}: {end}, {first:?}");
                assert!(!sampled.unknown[pixel]);
            }
        }
        let hits = picture.certainty.iter().filter(|certainty| **certainty == Certainty::Hit).count();
        assert!(hits > 90 && (both == hits || !finds_by_slope(finder)), "{finder:?} proves {both} of {hits} hits");
    }
}

/// The methods whose brackets hold a change of sign; bisection stops at the first cell that was not ruled out, and natural
/// extensions of expanded formulas leave cells before the root undecided.
fn finds_by_slope(finder: Finder) -> bool {
    use Finder::*;
    matches!(finder, Mitchell | IntervalNewton | AlefeldHansen | MrfNewton | PacketMitchell)
}

#[test]
fn mitchell_and_newton_agree() {
    let scene = scene("x^4 - 5x^2 + y^4 - 5y^2 + z^4 - 5z^2 + 11.8 = 0\ndomain [-2.4, 2.4]^3");
    let [mitchell, newton, hansen] = [Finder::Mitchell, Finder::IntervalNewton, Finder::AlefeldHansen]
        .map(|finder| sampled(&scene, &settings(finder, 1e-9)));
    let mut hits = 0;
    for pixel in 0..mitchell.depth.len() {
        for other in [&newton, &hansen] {
            if let (true, true, Some([a, b]), Some([c, d])) =
                (mitchell.proved[pixel], other.proved[pixel], mitchell.depth[pixel], other.depth[pixel])
            {
                hits += 1;
                assert!(a.max(c) <= b.min(d), "{pixel}: [{a}, {b}] and [{c}, {d}] have nothing in common");
            }
        }
    }
    assert!(hits > 300, "{hits}");
    // What the methods are for: fewer evaluations the more the slope is used.
    let bisection = sampled(&scene, &settings(Finder::Bisection, 1e-9));
    assert!(mitchell.evaluations < bisection.evaluations && hansen.evaluations < mitchell.evaluations);
}

/// One ray along the x axis from the origin.
fn along_x(text: &str, settings: &Settings) -> Sampled {
    let ray = Ray { origin: [0.0; 3], direction: [1.0, 0.0, 0.0] };
    sample(&scene(text), &|_, _| Some(ray), (1, 1), settings, session::backend()).unwrap()
}

#[test]
fn every_search_ends_near_tangents_and_at_poles() {
    for finder in Finder::ALL {
        for rounding in [Rounding::Outward, Rounding::Nearest] {
            let settings = Settings { rounding, ..settings(finder, 1e-7) };
            for exponent in (2..=12).step_by(2) {
                // Expanded, so that the enclosure does not see the square.
                let text = format!("x^2 - 10x + 25 + 1e-{exponent} + y = 0\ndomain [0, 10] x [-1, 1] x [-1, 1]");
                let near = along_x(&text, &settings);
                assert!(near.evaluations < 500_000, "{settings:?}, 1e-{exponent}: {}", near.evaluations);
                assert!(!near.proved[0], "{settings:?}: there is no root, and one is proved");
                if let Some([start, end]) = near.depth[0] {
                    // What cannot be told from a root is near the minimum.
                    assert!((start - 5.0).abs() < 1e-2 && end - start <= 1e-7, "{settings:?}: [{start}, {end}]");
                }
            }
            // The tangent itself is never missed, and never proved.
            let touching = along_x("x^2 - 10x + 25 + y = 0\ndomain [0, 10] x [-1, 1] x [-1, 1]", &settings);
            assert!(!touching.proved[0] && touching.unknown[0], "{settings:?}");
            assert!(touching.depth[0].is_some() || rounding == Rounding::Nearest, "{settings:?} misses the tangent");
            // A change of sign without a root.
            let pole = along_x("1/(x - 3) + y = 0\ndomain [0, 10] x [-1, 1] x [-1, 1]", &settings);
            assert!(!pole.proved[0] && pole.depth[0].is_none(), "{settings:?}: a pole is no root: {:?}", pole.depth[0]);
            assert!(pole.unknown[0] && pole.evaluations < 500, "{settings:?}: {}", pole.evaluations);
            // A root behind a pole, with slopes of one sign all along.
            let behind = along_x("1/(x - 3) + y = 1\ndomain [0, 10] x [-1, 1] x [-1, 1]", &settings);
            let [start, end] = behind.depth[0].unwrap_or_else(|| panic!("{settings:?} misses the root behind a pole"));
            assert!(start <= 4.0 && 4.0 <= end + 1e-7, "{settings:?}: [{start}, {end}]");
            assert!(behind.unknown[0], "{settings:?}: the pole was not ruled out");
        }
    }
}

#[test]
fn counts_and_brackets_do_not_depend_on_threads() {
    let scene = scene("x^2 y^2 + y^2 z^2 + x^2 z^2 + x y z = 0\ndomain [-0.56, 0.56]^3");
    for finder in Finder::ALL {
        let runs = [1, 3].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let mut run = pool.install(|| sampled(&scene, &settings(finder, 1e-4)));
            run.seconds = 0.0;
            run
        });
        assert_eq!(runs[0], runs[1], "{finder:?}");
        let kinds = runs[0].by_kind;
        assert_eq!(runs[0].evaluations, kinds.fields + kinds.slopes + kinds.points);
    }
}

#[test]
fn nothing_is_proved_to_nearest() {
    let scene = scene("x^2 + y^2 + z^2 = 1\ndomain [-1.5, 1.5]^3");
    for finder in Finder::ALL {
        let sampled = sampled(&scene, &Settings { rounding: Rounding::Nearest, ..settings(finder, 1e-3) });
        assert!(sampled.proved.iter().all(|proved| !proved) && sampled.unknown.iter().all(|&unknown| unknown));
        assert!(sampled.depth.iter().flatten().count() > 100);
    }
}

#[test]
fn the_nearest_of_several_shapes_counts() {
    let scene =
        scene("surface far: x = 4\nsurface near: x = 2\nsurface none: x = 40\ndomain [0, 10] x [-1, 1] x [-1, 1]");
    let ray = Ray { origin: [0.0; 3], direction: [1.0, 0.0, 0.0] };
    for finder in Finder::ALL {
        let found = sample(&scene, &|_, _| Some(ray), (1, 1), &settings(finder, 1e-3), session::backend()).unwrap();
        let [start, end] = found.depth[0].expect("there is a plane");
        assert!(start <= 2.0 && 2.0 <= end && end - start < 0.01, "{finder:?}: [{start}, {end}]");
    }
}

#[test]
fn mistakes_are_named() {
    let solid = scene("surface ball: x^2 + y^2 + z^2 <= 1\ndomain [-1.5, 1.5]^3");
    let cast = |scene: &Scene, settings: &Settings| {
        sample(scene, &|_, _| None, (1, 1), settings, session::backend()).map_err(|diagnostic| diagnostic.title)
    };
    for finder in Finder::ALL {
        assert_eq!(cast(&solid, &settings(finder, 1e-3)).is_ok(), finder.handles_solids(), "{finder:?}");
    }
    let plane = scene("curve c: x^2 + y^2 = 1");
    assert!(cast(&plane, &settings(Finder::Bisection, 1e-3)).unwrap_err().contains("plane"));
    assert!(cast(&solid, &settings(Finder::Bisection, 0.0)).unwrap_err().contains("positive"));
    let points = Settings { arithmetic: Arithmetic::Point, ..settings(Finder::Bisection, 1e-3) };
    assert!(cast(&solid, &points).unwrap_err().contains("enclosures"));
    // A solid's hit is where rays enter it.
    let renderer = renderer(&solid);
    for finder in Finder::ALL.into_iter().filter(|finder| finder.handles_solids()) {
        let sampled = sampled(&solid, &settings(finder, 1e-6));
        let mut hits = 0;
        for (pixel, bracket) in sampled.depth.iter().enumerate() {
            let Some([start, end]) = bracket else { continue };
            let ray = renderer.ray(pixel as u32 % SIDE, pixel as u32 / SIDE).unwrap();
            if let (Some(root), true) = (sphere_root(&ray), sampled.proved[pixel]) {
                hits += 1;
                assert!(*start <= root + 1e-12 && root - 1e-12 <= *end, "{finder:?}");
            }
        }
        assert!(hits > 50, "{finder:?}: {hits}");
    }
}
