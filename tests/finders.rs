//! The named root finders: what they claim holds, they agree where they should, and they end.

use imp::accuracy::finder::Finder;
use imp::accuracy::finder::Sampled;
use imp::accuracy::finder::Settings;
use imp::accuracy::finder::sample;
use imp::derive::Arithmetic;
use imp::derive::Precision;
use imp::derive::Rounding;
use imp::program::Scene;
use imp::render::Control;
use imp::render::Options;
use imp::render::Picture;
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
    let options = Options { width: SIDE, height: SIDE, precision: Precision::Double, ..Options::default() };
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
