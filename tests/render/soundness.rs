//! Whatever is proved must survive looking: fields are sampled densely along the rays of whole pictures.

use std::path::Path;
use std::sync::Arc;

use imp::derive::Arithmetic;
use imp::derive::Output;
use imp::derive::Precision;
use imp::derive::Rounding;
use imp::derive::Spec;
use imp::interpret::Interpreter;
use imp::kernel::Backend;
use imp::kernel::Kernel;
use imp::kernel::Packet;
use imp::program::scene::COORDINATES;
use imp::program::scene::Scene;
use imp::program::scene::ShapeKind;
use imp::render::Certainty;
use imp::render::Control;
use imp::render::Enclosures;
use imp::render::Options;
use imp::render::Renderer;
use imp::render::Surface;
use imp::session;
use imp::session::Source;

use crate::scenes::*;

/// Samples along each ray.
const SAMPLES: usize = 600;

fn compile(text: &str) -> Scene {
    let artefact = session::compile(Source::Text { name: "test.imp", text }, &[]);
    artefact.scene.unwrap_or_else(|| panic!("{text}: {:?}", artefact.diagnostics))
}

/// Field and, if there is one, condition of the only shape, at points; parameters at their middle.
struct Sampler {
    kernel: Arc<dyn Kernel<f64>>,
    uniforms: Vec<f64>,
    condition: bool,
}

impl Sampler {
    fn new(scene: &Scene) -> Self {
        let shape = &scene.shapes[0];
        let mut outputs = vec![Output::Value(shape.field)];
        outputs.extend(shape.condition.map(Output::Value));
        let uniforms: Vec<String> =
            scene.graph.variables().iter().filter(|name| !COORDINATES.contains(&name.as_str())).cloned().collect();
        let value = |name: &String| scene.parameters.iter().find(|p| &p.name == name).map_or(0.0, |p| p.value.mid());
        let spec = Spec {
            graph: Arc::new(scene.graph.clone()),
            inputs: COORDINATES.map(str::to_owned).to_vec(),
            uniforms: uniforms.clone(),
            outputs,
            domain: Vec::new(),
            promises: Vec::new(),
            arithmetic: Arithmetic::Point,
            symbols: Vec::new(),
            rounding: Rounding::Nearest,
        };
        let kernel = Interpreter.compile_f64(&spec).unwrap();
        Self { kernel, uniforms: uniforms.iter().map(value).collect(), condition: shape.condition.is_some() }
    }

    /// The field at points; NaN where the condition does not hold.
    fn run(&self, points: &[[f64; 3]]) -> Vec<f64> {
        let groups = points.len().div_ceil(8);
        let mut inputs = vec![Packet::<f64>::default(); 3 * groups];
        let slots = 1 + usize::from(self.condition);
        let mut outputs = vec![Packet::<f64>::default(); slots * groups];
        for (i, point) in points.iter().enumerate() {
            for axis in 0..3 {
                inputs[3 * (i / 8) + axis].lanes_mut()[i % 8] = point[axis];
            }
        }
        self.kernel.run(&self.uniforms, &inputs, &mut outputs);
        let value = |i: usize| {
            let holds = !self.condition || outputs[slots * (i / 8) + 1].lanes()[i % 8] == 1.0;
            if holds { outputs[slots * (i / 8)].lanes()[i % 8] } else { f64::NAN }
        };
        (0..points.len()).map(value).collect()
    }
}

/// Looks along every ray of a picture for what its certainty excludes. At most one pixel in `share` may be unknown.
fn look(text: &str, options: &Options, share: usize) {
    let scene = compile(text);
    let renderer = Renderer::new(&scene, options, backend().as_ref()).unwrap();
    let picture = renderer.render(&scene.parameters, &Control::default()).unwrap();
    let sampler = Sampler::new(&scene);
    let region = scene.shapes[0].kind == ShapeKind::Region;
    let mut proved = [0usize; 2];
    for (y, x) in (0..options.height).flat_map(|y| (0..options.width).map(move |x| (y, x))) {
        let index = picture.index(x, y);
        let place = format!("pixel ({x}, {y}) of {text}");
        let ray = renderer.ray(x, y).unwrap();
        let (mut entry, mut exit) = (0.0f64, f64::INFINITY);
        for axis in 0..3 {
            let ends = [scene.domain[axis].lo(), scene.domain[axis].hi()]
                .map(|face| (face - ray.origin[axis]) / ray.direction[axis]);
            entry = entry.max(ends[0].min(ends[1]));
            exit = exit.min(ends[0].max(ends[1]));
        }
        let (end, bracket) = match (picture.certainty[index], picture.depth[index]) {
            (Certainty::Hit, Some(depth)) => (depth.bracket[0], Some(depth)),
            (Certainty::Miss, None) => (exit, None),
            (Certainty::Hit, None) | (Certainty::Miss, Some(_)) => panic!("{place} contradicts itself"),
            _ => continue,
        };
        proved[usize::from(bracket.is_some())] += 1;
        // A little inside, since the entry computed here is rounded.
        let (entry, end) = (entry + 1e-9 * entry.abs(), end - 1e-9 * end.abs());
        let at = |t: f64| [0, 1, 2].map(|axis| ray.origin[axis] + t * ray.direction[axis]);
        if entry < end {
            let points: Vec<[f64; 3]> =
                (0..SAMPLES).map(|i| at(entry + (end - entry) * i as f64 / (SAMPLES - 1) as f64)).collect();
            let values = sampler.run(&points);
            // Rounding can turn a value close to 0 to the other side.
            let scale = values.iter().filter(|v| v.is_finite()).fold(0.0f64, |m, v| m.max(v.abs())) * 1e-12;
            for pair in values.windows(2) {
                if region {
                    assert!(pair.iter().all(|&v| v.is_nan() || v >= -scale), "{place}: inside before its hit");
                } else {
                    let change = pair[0].min(pair[1]) < -scale && pair[0].max(pair[1]) > scale;
                    // A pole changes sign through large values.
                    assert!(
                        !change || pair[0].abs().min(pair[1].abs()) > 1.0,
                        "{place}: a zero before its hit, {pair:?}"
                    );
                }
            }
        }
        if let Some(depth) = bracket.filter(|depth| depth.surface == Surface::Field) {
            let [a, b] = depth.bracket;
            let signs = sampler.run(&[at(a), at(b)]);
            assert!(signs[0] * signs[1] < 1e-18, "{place}: no change of sign in {:?}, {signs:?}", depth.bracket);
        }
    }
    assert!(proved[1] > 20 && proved[0] > 20, "{text}: {proved:?} proved misses and hits");
    let unknown = picture.stats.unknown as usize;
    assert!(unknown <= (proved[0] + proved[1]) / share, "{text}: {unknown} unknown, {proved:?}");
}

#[test]
fn proofs_survive_sampling() {
    for text in [
        "x^2 + y^2 + z^2 = 1",
        "x^4 - 5x^2 + y^4 - 5y^2 + z^4 - 5z^2 + 11.8 = 0\ndomain [-3, 3]^3",
        "x^2 y^2 + y^2 z^2 + x^2 z^2 + x y z = 0\ndomain [-1, 1]^3",
        "sin(x) cos(y) + sin(y) cos(z) + sin(z) cos(x) = 0\ndomain [-4, 4]^3",
        "z = sin(3 x) / (1 + x^2 + y^2)",
        "sqrt(x^2 + y^2) + |z| = 1.5",
        "max(|x|, |y|, |z|) = 1",
        "y = tan(x)\ndomain [-2, 2]^3",
        "y = x / (x^2 - 0.5)\ndomain [-2, 2]^3",
        "x^2 + y^2 = ln(2 + z)",
        "surface s: x^2 + y^2 + z^2 = 1 where x + y < z",
        "min(x^2 + y^2, y^2 + z^2) <= 0.3",
        "x + y z <= 0.2",
        "max(x^2 + y^2 + z^2 - 2, 0.4 - x^2 - z^2) <= 0",
        "exp(-x^2 - y^2) >= z^2",
    ] {
        look(text, &options(40), 20);
    }
    // A jump past 0 is no zero, but no enclosure says so.
    for text in ["floor(x) + y^2 + z^2 = 1", "mod(x, 0.7) + y^2 = z"] {
        look(text, &options(40), 1);
    }
}

#[test]
fn so_do_those_of_other_choices() {
    let text = "4(2.618 x^2 - y^2)(2.618 y^2 - z^2)(2.618 z^2 - x^2) = 4.236 (x^2 + y^2 + z^2 - 1)^2";
    for options in [
        Options { enclosures: Enclosures::Affine, ..options(48) },
        Options { enclosures: Enclosures::Centred, ..options(48) },
        Options { precision: Precision::Double, ..options(48) },
        Options { stop: imp::render::Stop::Depth(5), ..options(48) },
        Options { stop: imp::render::Stop::Depth(44), ..options(48) },
        Options { stop: imp::render::Stop::Tolerance(1e-5), ..options(48) },
        Options { stop: imp::render::Stop::Epsilon(0.3), ..options(48) },
    ] {
        look(text, &options, 20);
    }
    for view in
        ["projection = \"orthographic\"", "position = [0, 0, 0.2], fov = 120", "position = [100, 200, 300], fov = 1"]
    {
        look(&format!("{text}\ncamera({view})"), &options(48), 20);
    }
}

#[test]
fn examples_are_drawn() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    for name in ["barth_sextic", "heart", "icosahedron_csg", "trott", "superquadric_200"] {
        let artefact = session::compile(Source::File(&folder.join(name).with_extension("imp")), &[]);
        let picture = draw(&artefact.scene.unwrap(), &options(72));
        assert!(picture.stats.proved > 100 && picture.stats.unknown < 8, "{name}: {:?}", picture.stats);
    }
}
