//! The packet ray caster and the plotter of plane scenes: from a scene and options to a picture that says of every
//! pixel what is proved.
//!
//! Stages of a space scene, tile by tile: `march` moves beams of pixels front to back until each is refuted or in a
//! cell where the field is monotone along the rays, `solve` finds the zeros there, `finish` takes single rays through
//! everything else, `shade` turns hits into colours. `plane` decides pixels as boxes.

mod batch;
mod camera;
mod certificate;
mod context;
mod extent;
mod finish;
mod geometry;
mod grid;
pub mod image;
mod ink;
mod march;
mod options;
mod outcome;
mod picture;
mod plan;
mod plane;
mod programs;
mod shade;
mod solve;
mod space;
mod stats;
mod tile;
mod verify;

pub use crate::control::Control;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::kernel::Backend;
use crate::program::scene::Parameter;
use crate::program::scene::Scene;

pub(crate) use batch::Batch;
pub(crate) use batch::Program;
pub use camera::Ray;
pub use certificate::Certificate;
pub use options::Enclosures;
pub use options::Layers;
pub use options::Options;
pub use options::Stop;
pub use outcome::Surface;
pub use picture::Certainty;
pub use picture::Depth;
pub use picture::Picture;
pub use plan::Plan;
pub use plan::Planned;
pub(crate) use programs::Compiled;
pub(crate) use programs::Format;
pub(crate) use programs::less_half;
pub(crate) use programs::simplify;
pub use stats::Evaluations;
pub use stats::Stats;
pub use stats::median;
pub use verify::Report;
pub use verify::verify;

/// What becomes of a picture whose control was set to stop.
fn stopped() -> Diagnostic {
    Diagnostic::error(code::STOPPED, "stopped before the picture was complete")
}

/// A scene with its kernels, ready to be rendered for any values of its parameters: an animation compiles once.
pub struct Renderer {
    engine: Engine,
    threads: Option<rayon::ThreadPool>,
}

enum Engine {
    Space(Box<space::Space>),
    Plane(Box<plane::Plane>),
}

impl Renderer {
    /// Compiles what the plan needs.
    ///
    /// # Errors
    /// If the scene cannot be drawn (`E05..`), or the backend fails.
    pub fn new(scene: &Scene, options: &Options, backend: &dyn Backend) -> Result<Self, Diagnostic> {
        let threads = match options.threads {
            None => None,
            Some(count) => {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build();
                let failed =
                    |error| Diagnostic::error(code::NO_THREADS, format!("cannot start {count} threads: {error}"));
                Some(pool.map_err(failed)?)
            }
        };
        let engine = match scene.dimension() {
            2 => Engine::Plane(Box::new(plane::Plane::new(scene, options, backend)?)),
            _ => Engine::Space(Box::new(space::Space::new(scene, options, backend)?)),
        };
        Ok(Self { engine, threads })
    }

    /// What will run, and why.
    pub fn plan(&self) -> &Plan {
        match &self.engine {
            Engine::Space(space) => &space.plan,
            Engine::Plane(plane) => &plane.plan,
        }
    }

    /// Time that the kernels took to compile, in milliseconds.
    pub fn compile_ms(&self) -> f64 {
        match &self.engine {
            Engine::Space(space) => space.compile_ms,
            Engine::Plane(plane) => plane.compile_ms,
        }
    }

    /// The exact line o + t d of a pixel, to which everything proved of it refers; `None` in a plane scene or outside the
    /// picture.
    pub fn ray(&self, x: u32, y: u32) -> Option<Ray> {
        match &self.engine {
            Engine::Space(space) => space.ray(x, y),
            Engine::Plane(_) => None,
        }
    }

    /// The colours of hits that were found in whatever way, given for every pixel of the picture, row by row. Empty in a
    /// plane scene, and if the options ask for no colour.
    ///
    /// # Panics
    /// If a hit names a shape that the scene does not have: our mistake.
    pub fn paint(&self, parameters: &[Parameter], hits: &[Option<Depth>]) -> Vec<[u8; 3]> {
        match &self.engine {
            Engine::Space(space) => space.paint(parameters, hits),
            Engine::Plane(_) => Vec::new(),
        }
    }

    /// Renders with the given values of the scene's parameters, in the scene's order.
    ///
    /// # Errors
    /// If the work is cancelled (`E0504`).
    pub fn render(&self, parameters: &[Parameter], control: &Control<'_>) -> Result<Picture, Diagnostic> {
        let work = || match &self.engine {
            Engine::Space(space) => space.render(parameters, control),
            Engine::Plane(plane) => plane.render(parameters, control),
        };
        match &self.threads {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }
}

/// Renders a scene with the values that its parameters have in it.
///
/// # Errors
/// As [`Renderer::new`] and [`Renderer::render`].
pub fn render(
    scene: &Scene,
    options: &Options,
    backend: &dyn Backend,
    control: &Control<'_>,
) -> Result<Picture, Diagnostic> {
    Renderer::new(scene, options, backend)?.render(&scene.parameters, control)
}
