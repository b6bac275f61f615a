//! Certificates are accepted by the reference alone, and rejected if anything in them or behind them is wrong.

use std::sync::Arc;

use imp::derive::Output;
use imp::derive::Spec;
use imp::diagnostic::Diagnostic;
use imp::graph::Op;
use imp::interpret::Interpreter;
use imp::kernel::Backend;
use imp::kernel::Kernel;
use imp::kernel::Packet;
use imp::kernel::Real;
use imp::kernel::verdict;
use imp::program::scene::Scene;
use imp::program::scene::ShapeKind;
use imp::render::Certificate;
use imp::render::Control;
use imp::render::Options;
use imp::render::Picture;
use imp::render::render;
use imp::render::verify;

use crate::scenes::*;

fn prove(scene: &Scene, size: u32) -> Picture {
    draw(scene, &Options { certificate: true, ..options(size) })
}

fn check(scene: &Scene, certificate: &Certificate) -> Result<(), Diagnostic> {
    verify(scene, certificate, &Interpreter, &Control::default()).map(|_| ())
}

/// A sphere that only its upper part belongs to, next to a solid cut by the domain.
fn mixed() -> Scene {
    let mut scene = scene(ShapeKind::Equation, sphere);
    let [x, z] = ["x", "z"].map(|name| scene.graph.var(name));
    let zero = scene.graph.int(0);
    scene.shapes[0].condition = Some(scene.graph.push(Op::Less, &[zero, z]));
    let wall = number(&mut scene.graph, 5, 4);
    let field = scene.graph.add(x, wall);
    let solid = imp::program::scene::Shape {
        name: "solid".to_owned(),
        kind: ShapeKind::Region,
        field,
        condition: None,
        ..scene.shapes[0].clone()
    };
    scene.shapes.push(solid);
    scene
}

#[test]
fn what_was_proved_is_verified() {
    for scene in [scene(ShapeKind::Equation, sphere), mixed()] {
        let picture = prove(&scene, 72);
        let certificate = picture.certificate.unwrap();
        let report = verify(&scene, &certificate, &Interpreter, &Control::default()).unwrap();
        assert_eq!(report.counts.proved, picture.stats.proved);
        assert_eq!(report.counts.misses, picture.stats.misses);
        assert!(report.counts.proved > 300 && report.cells > 100);
        let bytes = certificate.to_bytes();
        assert_eq!(Certificate::from_bytes(&bytes).unwrap(), certificate);
    }
}

#[test]
fn a_damaged_certificate_is_rejected() {
    let scene = scene(ShapeKind::Equation, sphere);
    let bytes = prove(&scene, 40).certificate.unwrap().to_bytes();
    let mut rng = fastrand::Rng::with_seed(7);
    for _ in 0..60 {
        let mut damaged = bytes.clone();
        match rng.u8(..3) {
            0 => damaged.truncate(rng.usize(..bytes.len())),
            1 => damaged.push(rng.u8(..)),
            _ => damaged[rng.usize(..bytes.len())] ^= 1 << rng.u8(..8),
        }
        let rejected = match Certificate::from_bytes(&damaged) {
            Err(error) => error.code == "E0507",
            // The first bytes of a zlib stream have bits that say nothing of the data.
            Ok(read) => read == Certificate::from_bytes(&bytes).unwrap() || check(&scene, &read).is_err(),
        };
        assert!(rejected);
    }
}

#[test]
fn a_certificate_fits_one_scene() {
    let certificate = prove(&scene(ShapeKind::Equation, sphere), 32).certificate.unwrap();
    let other = scene(ShapeKind::Equation, |graph, p| {
        let square = square_length(graph, p);
        let less = number(graph, 99, 100);
        graph.sub(square, less)
    });
    assert_eq!(check(&other, &certificate).unwrap_err().code, "E0508");
}

/// A backend whose verdicts are wrong for some boxes: it claims a sign where there is none.
struct Broken;

struct BrokenKernel<T: Real> {
    sound: Arc<dyn Kernel<T>>,
    slot: usize,
}

impl<T: Real> Kernel<T> for BrokenKernel<T> {
    fn input_slots(&self) -> usize {
        self.sound.input_slots()
    }

    fn output_slots(&self) -> usize {
        self.sound.output_slots()
    }

    fn run(&self, uniforms: &[T], inputs: &[Packet<T>], outputs: &mut [Packet<T>]) {
        self.sound.run(uniforms, inputs, outputs);
        let slots = self.output_slots();
        let (groups, width) = (outputs.chunks_exact_mut(slots), self.input_slots());
        for (group, inputs) in groups.zip(inputs.chunks_exact(width)) {
            for (lane, bits) in group[self.slot].lanes_mut().iter_mut().enumerate() {
                // Slots 6 and 7 are the cell: every short one that ends beyond 6.9 is called positive. The sphere's
                // nearest point is at 7.
                let (start, end) = (-inputs[6].lanes()[lane].to_f64(), inputs[7].lanes()[lane].to_f64());
                if end > 6.9 && end - start < 0.5 {
                    *bits = T::from_verdict(verdict::POSITIVE | verdict::CONTINUOUS);
                }
            }
        }
    }
}

fn breaks(spec: &Spec) -> bool {
    spec.outputs.len() == 1 && matches!(spec.outputs[0], Output::Refutation(_))
}

impl Backend for Broken {
    fn compile_f32(&self, spec: &Spec) -> Result<Arc<dyn Kernel<f32>>, Diagnostic> {
        let sound = backend().compile_f32(spec)?;
        Ok(if breaks(spec) { Arc::new(BrokenKernel { sound, slot: 0 }) } else { sound })
    }

    fn compile_f64(&self, spec: &Spec) -> Result<Arc<dyn Kernel<f64>>, Diagnostic> {
        backend().compile_f64(spec)
    }
}

#[test]
fn a_broken_kernel_is_found_out() {
    let mut scene = scene(ShapeKind::Equation, sphere);
    scene.view.camera.position = Some([0.0, -8.0, 0.0]);
    let options = Options { certificate: true, ..options(40) };
    let sound = draw(&scene, &options);
    let broken = render(&scene, &options, &Broken, &Control::default()).unwrap();
    assert!(broken.stats.proved < sound.stats.proved, "the fault has no effect");
    let error = check(&scene, &broken.certificate.unwrap()).unwrap_err();
    assert_eq!(error.code, "E0509");
    assert!(error.title.contains("not refuted"), "{}", error.title);
}
