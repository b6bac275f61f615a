//! Plane scenes: every pixel is a box, and each is decided as such. A curve is proved to pass through a pixel, proved
//! not to, or unknown; a pixel is proved inside a region, outside, or crossed by its boundary.
//!
//! Blocks of pixels are quartered until the field decides them (Tupper 2001, `block`). What stays open of single pixels is
//! settled with gradients (`pixel`), on the pieces of the zero set (`system`) and with jumps taken out (`jumps`).

mod block;
mod jumps;
mod kernels;
mod pixel;
pub mod raster;
mod search;
mod solution;
mod system;

use std::time::Instant;

use rayon::prelude::*;

use crate::derive::Precision;
use crate::derive::Rounding;
use crate::derive::Spec;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::kernel::Backend;
use crate::program::scene::Parameter;
use crate::program::scene::Scene;
use crate::program::scene::ShapeKind;
use crate::render::Control;
use crate::render::batch::Program;
use crate::render::geometry::check;
use crate::render::ink;
use crate::render::options::Options;
use crate::render::outcome::Surface;
use crate::render::picture::Certainty;
use crate::render::picture::Depth;
use crate::render::picture::Picture;
use crate::render::plan::Plan;
use crate::render::plan::arithmetic;
use crate::render::plane::block::BLOCK;
use crate::render::plane::block::Decided;
use crate::render::plane::block::Decider;
use crate::render::plane::kernels::Kernels;
use crate::render::plane::raster::Raster;
use crate::render::plane::system::specs;
use crate::render::programs::Compiled;
use crate::render::programs::Orders;
use crate::render::stats::Evaluations;
use crate::render::stats::Stats;
use crate::render::stats::median;
use crate::render::stopped;

/// What is known of a pixel and one shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// No point of the pixel belongs to the shape.
    Outside,
    /// Every point of the pixel belongs to the region.
    Inside,
    /// The zero set, or the region's boundary, is proved to pass through the pixel.
    Crossed,
    Unknown,
}

/// A shape's kernels.
struct ShapeKernels {
    region: Compiled<f64>,
    systems: Kernels,
    gradient: Option<Compiled<f64>>,
}

/// A plane scene with its kernels, ready to be rendered for any values of its parameters.
pub struct Plane {
    scene: Scene,
    options: Options,
    kernels: Vec<ShapeKernels>,
    pub plan: Plan,
    pub compile_ms: f64,
}

impl Plane {
    pub fn new(scene: &Scene, options: &Options, backend: &dyn Backend) -> Result<Self, Diagnostic> {
        if options.certificate {
            return Err(Diagnostic::error(code::NO_CERTIFICATE, "plane scenes have no certificate")
                .help("render without `--certificate`, or use `imp arrange`, whose results can be verified"));
        }
        check(scene, options)?;
        let start = Instant::now();
        let mut plan = Plan::default();
        let mut kernels = Vec::new();
        for shape in &scene.shapes {
            let (chosen, reason) = arithmetic(scene, shape, options.enclosures);
            plan.notes.push(format!("arithmetic of {}: {reason}", shape.name));
            let rounding = options.rounding;
            let orders = Orders { scene, shape, reach: None, rounding, arithmetic: chosen };
            let compiled = |spec: Spec| Compiled::new(backend, &spec).map(|kernel| (spec, kernel));
            let (double, region) = (Precision::Double, compiled(orders.region())?);
            let region = plan.kernel(shape, "box", double, region, "decides pixels and blocks of them");
            let gradient = match options.layers.color {
                true => Some(plan.kernel(
                    shape,
                    "gradient",
                    double,
                    compiled(orders.gradient())?,
                    "gives strokes their width",
                )),
                false => None,
            };
            let systems = Kernels::new(specs(&orders), shape, &mut plan, backend)?;
            kernels.push(ShapeKernels { region, systems, gradient });
        }
        plan.describe(scene, options);
        let compile_ms = 1e3 * start.elapsed().as_secs_f64();
        Ok(Self { scene: scene.clone(), options: options.clone(), kernels, plan, compile_ms })
    }

    pub fn render(&self, parameters: &[Parameter], control: &Control<'_>) -> Result<Picture, Diagnostic> {
        let Options { width, height, .. } = self.options;
        let raster = Raster::new(&self.scene.domain, width, height);
        let mut times = Vec::new();
        let mut picture = Picture::default();
        for _ in 0..self.options.repeat.max(1) {
            let start = Instant::now();
            picture = self.picture(&raster, parameters, control)?;
            times.push(1e3 * start.elapsed().as_secs_f64());
        }
        picture.stats.compile_ms = self.compile_ms;
        picture.stats.render_ms = median(times);
        Ok(picture)
    }

    fn picture(&self, raster: &Raster, parameters: &[Parameter], control: &Control<'_>) -> Result<Picture, Diagnostic> {
        let Options { width, height, .. } = self.options;
        let pixels = width as usize * height as usize;
        let mut stats = Stats { pixels: pixels as u64, threads: rayon::current_num_threads(), ..Stats::default() };
        let corners: Vec<(u32, u32)> = (0..height)
            .step_by(BLOCK as usize)
            .flat_map(|y| (0..width).step_by(BLOCK as usize).map(move |x| (x, y)))
            .collect();
        let mut places: Vec<Vec<Place>> = Vec::new();
        for (kernels, shape) in self.kernels.iter().zip(&self.scene.shapes) {
            let (program, bound) = (kernels.region.bind(parameters, &[]), kernels.systems.bind(parameters));
            let solid = shape.kind == ShapeKind::Region;
            let decided: Vec<Option<Decided>> = corners
                .par_iter()
                .map(|&(x, y)| {
                    let decided = (!control.is_cancelled()).then(|| {
                        let mut decider = Decider::new(raster, &program, &bound, solid, shape.condition.is_some());
                        (decider.block(x, y), decider.evaluations())
                    });
                    control.advance(corners.len() * self.kernels.len());
                    decided
                })
                .collect();
            let mut whole = vec![Place::Outside; pixels];
            for (&(x, y), decided) in corners.iter().zip(decided) {
                let (block, (beam, piece)) = decided.ok_or_else(stopped)?;
                stats.evaluations += Evaluations { beam, piece, ..Evaluations::default() };
                let columns = (width - x).min(BLOCK) as usize;
                for (row, places) in block.chunks(BLOCK as usize).take((height - y).min(BLOCK) as usize).enumerate() {
                    let to = (y as usize + row) * width as usize + x as usize;
                    whole[to..to + columns].copy_from_slice(&places[..columns]);
                }
            }
            places.push(whole);
        }
        control.reset();
        let certainty: Vec<Certainty> = (0..pixels).map(|index| self.certainty(&places, index)).collect();
        let count = |kind: Certainty| certainty.iter().filter(|&&c| c == kind).count() as u64;
        (stats.proved, stats.misses) = (count(Certainty::Hit), count(Certainty::Miss));
        stats.unknown = count(Certainty::Unknown) + count(Certainty::Unverified);
        let drawn = |index: usize| places.iter().any(|places| places[index] != Place::Outside);
        stats.hits = (0..pixels).filter(|&index| drawn(index)).count() as u64;
        let mut picture = Picture { width, height, certainty, stats, ..Picture::default() };
        if self.options.layers.depth {
            picture.depth = (0..pixels).map(|index| nearest(&places, index)).collect();
        }
        if self.options.layers.color {
            let gradients: Vec<Option<Program<f64>>> = self
                .kernels
                .iter()
                .map(|kernels| kernels.gradient.as_ref().map(|gradient| gradient.bind(parameters, &[])))
                .collect();
            let canvas = ink::Canvas { scene: &self.scene, raster, places: &places, gradients: &gradients };
            let (color, evaluations) = canvas.draw();
            picture.color = color;
            picture.stats.evaluations.gradient += evaluations;
        }
        Ok(picture)
    }

    /// A pixel is a proved hit if some shape is proved to be there; it is unknown only if that decides whether anything is.
    fn certainty(&self, places: &[Vec<Place>], index: usize) -> Certainty {
        let any = |place: Place| places.iter().any(|places| places[index] == place);
        match self.options.rounding {
            Rounding::Nearest => Certainty::Unverified,
            Rounding::Outward if any(Place::Unknown) => Certainty::Unknown,
            Rounding::Outward if any(Place::Crossed) || any(Place::Inside) => Certainty::Hit,
            Rounding::Outward => Certainty::Miss,
        }
    }
}

/// The first shape that is drawn in a pixel.
fn nearest(places: &[Vec<Place>], index: usize) -> Option<Depth> {
    let shape = places.iter().position(|places| places[index] != Place::Outside)?;
    Some(Depth { shape: shape as u16, surface: Surface::Field, bracket: [0.0; 2], t: 0.0, distance: 0.0 })
}
