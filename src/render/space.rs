//! Space scenes: kernels, tiles and layers put together.

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
use crate::program::scene::Shape;
use crate::program::scene::ShapeKind;
use crate::render::Control;
use crate::render::batch::Program;
use crate::render::camera::Frame;
use crate::render::camera::Ray;
use crate::render::camera::Tile;
use crate::render::certificate::Certificate;
use crate::render::context::Refuted;
use crate::render::context::pixel;
use crate::render::geometry::Geometry;
use crate::render::geometry::shared_inputs;
use crate::render::options::Options;
use crate::render::outcome::Outcome;
use crate::render::picture::Certainty;
use crate::render::picture::Depth;
use crate::render::picture::Picture;
use crate::render::plan::Plan;
use crate::render::plan::arithmetic;
use crate::render::programs::Compiled;
use crate::render::programs::Format;
use crate::render::programs::Orders;
use crate::render::shade::Gradients;
use crate::render::shade::Shading;
use crate::render::shade::Spot;
use crate::render::stats::Evaluations;
use crate::render::stats::Stats;
use crate::render::stats::median;
use crate::render::stopped;
use crate::render::tile::Traced;
use crate::render::tile::Tracer;
use crate::render::tile::trace;

/// A shape's kernels; beams march in `T`.
struct ShapeKernels<T: Format> {
    plain: Compiled<T>,
    slope: Compiled<T>,
    ends: Compiled<f64>,
    piece: Compiled<f64>,
    /// Solids only.
    face: Option<Compiled<f64>>,
    root: Compiled<f64>,
    /// Only if some layer shows normals.
    gradient: Option<Compiled<f64>>,
}

impl<T: Format> ShapeKernels<T> {
    fn new(
        scene: &Scene,
        shape: &Shape,
        geometry: &Geometry,
        options: &Options,
        (backend, plan): (&dyn Backend, &mut Plan),
    ) -> Result<Self, Diagnostic> {
        let (beams, reason) = arithmetic(scene, shape, options.enclosures);
        plan.notes.push(format!("arithmetic of {}: {reason}", shape.name));
        let reach = Some(geometry.reach);
        let orders = Orders { scene, shape, reach, rounding: options.rounding, arithmetic: beams };
        let solid = shape.kind == ShapeKind::Region;
        let normals = wants_normals(scene, options);
        // Each kernel takes longer to compile than a thread to wake.
        let single = |spec: Spec| Compiled::<T>::new(backend, &spec).map(|kernel| (spec, kernel));
        let double = |spec: Spec| Compiled::<f64>::new(backend, &spec).map(|kernel| (spec, kernel));
        let ((plain, slope), ((ends, piece), (root, (face, gradient)))) = rayon::join(
            || rayon::join(|| single(orders.beam()), || single(orders.slope())),
            || {
                rayon::join(
                    || rayon::join(|| double(orders.ends()), || double(orders.piece())),
                    || {
                        let rest = || {
                            let face = solid.then(|| double(orders.face())).transpose();
                            (face, normals.then(|| double(orders.gradient())).transpose())
                        };
                        rayon::join(|| double(orders.root()), rest)
                    },
                )
            },
        );
        let format = T::PRECISION;
        let (plain, slope) = (
            plan.kernel(shape, "beam", format, plain?, "refutes cells of beams"),
            plan.kernel(shape, "slope", format, slope?, "settles cells in which the field is monotone along rays"),
        );
        let format = Precision::Double;
        Ok(Self {
            plain,
            slope,
            ends: plan.kernel(shape, "ends", format, ends?, "proves the signs at the ends of brackets"),
            piece: plan.kernel(shape, "piece", format, piece?, "decides on single rays what beams leave open"),
            root: plan.kernel(shape, "root", format, root?, "finds hits to shade by Newton's method"),
            face: face?.map(|face| plan.kernel(shape, "face", format, face, "decides where the domain cuts a solid")),
            gradient: gradient?.map(|gradient| {
                plan.kernel(shape, "gradient", format, gradient, "gives normals to shading or their layer")
            }),
        })
    }

    fn bind(&self, parameters: &[Parameter], constants: &[(&str, f64)]) -> Tracer<T> {
        let ends = self.ends.bind(parameters, constants);
        Tracer {
            plain: self.plain.bind(parameters, constants),
            slope: self.slope.bind(parameters, constants),
            piece: self.piece.bind(parameters, constants),
            face: self.face.as_ref().map_or_else(|| ends.clone(), |face| face.bind(parameters, constants)),
            root: self.root.bind(parameters, constants),
            ends,
        }
    }
}

/// Whether a layer shows normals, or colours made with them.
fn wants_normals(scene: &Scene, options: &Options) -> bool {
    let lit = !matches!(&scene.view.lights, Some(lights) if lights.is_empty());
    options.layers.normal || options.layers.color && lit
}

enum Kernels {
    Single(Vec<ShapeKernels<f32>>),
    Double(Vec<ShapeKernels<f64>>),
}

/// A space scene with its kernels, ready to be rendered for any values of its parameters.
pub struct Space {
    scene: Scene,
    options: Options,
    geometry: Geometry,
    kernels: Kernels,
    pub plan: Plan,
    pub compile_ms: f64,
}

impl Space {
    pub fn new(scene: &Scene, options: &Options, backend: &dyn Backend) -> Result<Self, Diagnostic> {
        if options.certificate && options.rounding == Rounding::Nearest {
            return Err(Diagnostic::error(
                code::NO_CERTIFICATE,
                "unrounded arithmetic proves nothing, so there is no certificate of it",
            )
            .help("leave out `--rounding nearest` or `--certificate`"));
        }
        let start = Instant::now();
        let geometry = Geometry::new(scene, options)?;
        let mut plan = Plan::default();
        let kernels = match options.precision {
            Precision::Single => Kernels::Single(compile(scene, options, &geometry, backend, &mut plan)?),
            Precision::Double => Kernels::Double(compile(scene, options, &geometry, backend, &mut plan)?),
        };
        plan.describe(scene, options);
        let compile_ms = 1e3 * start.elapsed().as_secs_f64();
        Ok(Self { scene: scene.clone(), options: options.clone(), geometry, kernels, plan, compile_ms })
    }

    /// The line of a pixel.
    pub fn ray(&self, x: u32, y: u32) -> Option<Ray> {
        let camera = &self.geometry.camera;
        let holds = |tile: &&Tile| (tile.x..=tile.last_x).contains(&x) && (tile.y..=tile.last_y).contains(&y);
        let tile = *self.geometry.tiles.iter().find(holds)?;
        // A frame of this pixel alone: the tile's frame would compute all its columns and rows.
        let pixel = Tile { x, y, last_x: x, last_y: y, ..tile };
        Some(Frame::new(camera, pixel).ray(0, 0))
    }

    /// Renders with the given values of the scene's parameters, in the scene's order.
    pub fn render(&self, parameters: &[Parameter], control: &Control<'_>) -> Result<Picture, Diagnostic> {
        match &self.kernels {
            Kernels::Single(kernels) => self.render_with(kernels, parameters, control),
            Kernels::Double(kernels) => self.render_with(kernels, parameters, control),
        }
    }

    /// The colours of hits that were found in whatever way.
    pub fn paint(&self, parameters: &[Parameter], hits: &[Option<Depth>]) -> Vec<[u8; 3]> {
        match &self.kernels {
            Kernels::Single(kernels) => self.with_job(kernels, parameters, |job| job.paint(hits)),
            Kernels::Double(kernels) => self.with_job(kernels, parameters, |job| job.paint(hits)),
        }
    }

    fn render_with<T: Format>(
        &self,
        kernels: &[ShapeKernels<T>],
        parameters: &[Parameter],
        control: &Control<'_>,
    ) -> Result<Picture, Diagnostic> {
        self.with_job(kernels, parameters, |job| {
            let mut times = Vec::new();
            let mut picture = Picture::default();
            for _ in 0..self.options.repeat.max(1) {
                let start = Instant::now();
                picture = job.picture(control)?;
                times.push(1e3 * start.elapsed().as_secs_f64());
            }
            picture.stats.compile_ms = self.compile_ms;
            picture.stats.render_ms = median(times);
            Ok(picture)
        })
    }

    /// Binds the kernels to parameters, then works with them.
    fn with_job<T: Format, R>(
        &self,
        kernels: &[ShapeKernels<T>],
        parameters: &[Parameter],
        work: impl FnOnce(&Job<T>) -> R,
    ) -> R {
        let constants = shared_inputs(&self.geometry);
        let shapes = &self.scene.shapes;
        let tracers: Vec<Tracer<T>> = kernels.iter().map(|kernels| kernels.bind(parameters, &constants)).collect();
        let gradients: Vec<Option<(Program<f64>, f64)>> = kernels
            .iter()
            .map(|kernels| {
                let program = kernels.gradient.as_ref()?.bind(parameters, &[]);
                let usual = Gradients::usual(&program, &self.scene.domain);
                Some((program, usual))
            })
            .collect();
        let shading = Shading::new(&self.scene.view, &self.geometry.camera, shapes.len());
        work(&Job { space: self, parameters, tracers: &tracers, gradients: &gradients, shading: &shading })
    }
}

fn compile<T: Format>(
    scene: &Scene,
    options: &Options,
    geometry: &Geometry,
    backend: &dyn Backend,
    plan: &mut Plan,
) -> Result<Vec<ShapeKernels<T>>, Diagnostic> {
    scene.shapes.iter().map(|shape| ShapeKernels::new(scene, shape, geometry, options, (backend, plan))).collect()
}

/// One picture under way.
struct Job<'a, T: Format> {
    space: &'a Space,
    parameters: &'a [Parameter],
    tracers: &'a [Tracer<T>],
    gradients: &'a [Option<(Program<f64>, f64)>],
    shading: &'a Shading,
}

/// A finished tile; its planes are empty if every pixel is a proved miss.
#[derive(Default)]
struct Finished {
    certainty: Vec<Certainty>,
    depth: Vec<Option<Depth>>,
    color: Vec<[u8; 3]>,
    normal: Vec<[f32; 3]>,
    covers: Vec<(Vec<Refuted>, Vec<Outcome>)>,
    hits: u64,
    evaluations: Evaluations,
}

impl<T: Format> Job<'_, T> {
    fn picture(&self, control: &Control<'_>) -> Result<Picture, Diagnostic> {
        let tiles = &self.space.geometry.tiles;
        let finished: Vec<Option<Finished>> = tiles
            .par_iter()
            .map(|&tile| {
                let finished = (!control.is_cancelled()).then(|| self.tile(tile));
                control.advance(tiles.len());
                finished
            })
            .collect();
        control.reset();
        let finished: Option<Vec<Finished>> = finished.into_iter().collect();
        let finished = finished.ok_or_else(stopped)?;
        Ok(self.assemble(finished))
    }

    fn tile(&self, tile: Tile) -> Finished {
        let Space { scene, options, geometry, .. } = self.space;
        let frame = Frame::new(&geometry.camera, tile);
        let mut finished = Finished::default();
        let mut traced = Vec::with_capacity(self.tracers.len());
        for (tracer, shape) in self.tracers.iter().zip(&scene.shapes) {
            let context = geometry.context(&frame, scene, shape);
            let Traced { outcomes, cover, evaluations } = trace(context, tracer, geometry.effort);
            finished.evaluations += evaluations;
            if options.certificate {
                finished.covers.push((cover, inside(&frame, &outcomes)));
            }
            traced.push(outcomes);
        }
        if traced.iter().all(Vec::is_empty) && options.rounding == Rounding::Outward {
            return finished;
        }
        let (width, height) = frame.size();
        let mut spots: Vec<(usize, Spot)> = Vec::new();
        finished.certainty.reserve((width * height) as usize);
        for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
            let (winner, certainty) = nearest(&traced, pixel(x, y).into(), options.rounding);
            finished.certainty.push(certainty);
            let spot = winner.map(|(shape, outcome)| {
                let solid = scene.shapes[shape].kind == ShapeKind::Region;
                (outcome, Spot { ray: frame.ray(x, y), t: outcome.t, shape, surface: outcome.surface, solid })
            });
            if options.layers.depth {
                finished.depth.push(spot.as_ref().map(|(outcome, spot)| depth(outcome, spot)));
            }
            spots.extend(spot.map(|(_, spot)| ((y * width + x) as usize, spot)));
        }
        finished.hits = spots.len() as u64;
        self.shade(&frame, &spots, &mut finished);
        finished
    }

    /// Fills the layers of colour and normal.
    fn shade(&self, frame: &Frame, spots: &[(usize, Spot)], finished: &mut Finished) {
        let Space { scene, options, .. } = self.space;
        let (width, height) = frame.size();
        if options.layers.color {
            finished.color.reserve((width * height) as usize);
            for y in frame.tile.y..=frame.tile.last_y {
                let row = finished.color.len();
                finished.color.resize(row + width as usize, self.shading.background(y));
            }
        }
        if options.layers.normal {
            finished.normal = vec![[0.0; 3]; (width * height) as usize];
        }
        for (shape, gradient) in self.gradients.iter().enumerate() {
            let spots: Vec<&(usize, Spot)> = spots.iter().filter(|(_, spot)| spot.shape == shape).collect();
            if spots.is_empty() {
                continue;
            }
            let Some((program, usual)) = gradient else {
                for (index, _) in spots.iter().filter(|_| options.layers.color) {
                    finished.color[*index] = self.shading.flat(shape);
                }
                continue;
            };
            let mut gradients = Gradients::new(program, *usual, &scene.domain);
            let plain: Vec<Spot> = spots.iter().map(|(_, spot)| *spot).collect();
            for ((index, spot), normal) in spots.into_iter().zip(gradients.normals(&plain)) {
                if options.layers.color {
                    let lit = self.shading.is_lit();
                    finished.color[*index] =
                        if lit { self.shading.color(spot, normal) } else { self.shading.flat(shape) };
                }
                if options.layers.normal {
                    finished.normal[*index] = normal.as_vec3().into();
                }
            }
            finished.evaluations.gradient += gradients.evaluations();
        }
    }

    fn paint(&self, hits: &[Option<Depth>]) -> Vec<[u8; 3]> {
        let Space { scene, geometry, .. } = self.space;
        let mut color = self.backdrop();
        for &tile in &geometry.tiles {
            let frame = Frame::new(&geometry.camera, tile);
            let (width, height) = frame.size();
            let place = |y: u32| ((tile.y + y) * geometry.camera.width + tile.x) as usize;
            let mut spots: Vec<(usize, Spot)> = Vec::new();
            for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
                let hit = hits.get(place(y) + x as usize).copied().flatten();
                spots.extend(hit.map(|Depth { shape, surface, t, .. }| {
                    let shape = usize::from(shape);
                    let solid = scene.shapes[shape].kind == ShapeKind::Region;
                    let spot = Spot { ray: frame.ray(x, y), t, shape, surface, solid };
                    ((y * width + x) as usize, spot)
                }));
            }
            let mut finished = Finished::default();
            self.shade(&frame, &spots, &mut finished);
            for y in 0..height {
                copy_row(&mut color, place(y), &finished.color, y as usize, width as usize);
            }
        }
        color
    }

    /// The colours of a picture in which nothing is drawn.
    fn backdrop(&self) -> Vec<[u8; 3]> {
        let Options { width, height, layers, .. } = self.space.options;
        let mut colors = Vec::new();
        if layers.color {
            colors.reserve(width as usize * height as usize);
            for y in 0..height {
                colors.resize(colors.len() + width as usize, self.shading.background(y));
            }
        }
        colors
    }

    fn assemble(&self, finished: Vec<Finished>) -> Picture {
        let Space { options, geometry, .. } = self.space;
        let (width, height) = (options.width, options.height);
        let pixels = geometry.camera.pixels();
        let plane = |wanted: bool| if wanted { pixels } else { 0 };
        let mut picture = Picture {
            width,
            height,
            certainty: vec![Certainty::Miss; pixels],
            color: self.backdrop(),
            depth: vec![None; plane(options.layers.depth)],
            normal: vec![[0.0; 3]; plane(options.layers.normal)],
            stats: Stats::default(),
            certificate: None,
        };
        let mut covers = Vec::new();
        for (tile, finished) in geometry.tiles.iter().zip(finished) {
            let columns = (tile.last_x - tile.x + 1) as usize;
            for (row, y) in (tile.y..=tile.last_y).enumerate() {
                let to = picture.index(tile.x, y);
                if finished.certainty.is_empty() {
                    break;
                }
                copy_row(&mut picture.certainty, to, &finished.certainty, row, columns);
                copy_row(&mut picture.color, to, &finished.color, row, columns);
                copy_row(&mut picture.depth, to, &finished.depth, row, columns);
                copy_row(&mut picture.normal, to, &finished.normal, row, columns);
            }
            picture.stats.evaluations += finished.evaluations;
            picture.stats.hits += finished.hits;
            covers.push(finished.covers);
        }
        let count = |kind: Certainty| picture.certainty.iter().filter(|&&c| c == kind).count() as u64;
        picture.stats.pixels = pixels as u64;
        picture.stats.threads = rayon::current_num_threads();
        picture.stats.proved = count(Certainty::Hit);
        picture.stats.misses = count(Certainty::Miss);
        picture.stats.unknown = count(Certainty::Unknown) + count(Certainty::Unverified);
        if options.certificate {
            picture.certificate = Some(Certificate::new(
                (&self.space.scene, self.parameters),
                (options, &geometry.camera),
                &picture.stats,
                covers,
            ));
        }
        picture
    }
}

/// The outcomes of the pixels inside the picture, row by row.
fn inside(frame: &Frame, outcomes: &[Outcome]) -> Vec<Outcome> {
    let (width, height) = frame.size();
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| pixel(x, y)));
    pixels.map(|pixel| outcomes.get(usize::from(pixel)).copied().unwrap_or(Outcome::MISS)).collect()
}

fn copy_row<P: Copy>(plane: &mut [P], to: usize, tile: &[P], row: usize, columns: usize) {
    if !plane.is_empty() {
        plane[to..to + columns].copy_from_slice(&tile[row * columns..(row + 1) * columns]);
    }
}

/// What is drawn in a pixel, of several shapes, and what is proved of it: the nearest hit, if its own is proved and every
/// other shape is refuted up to the end of its bracket.
fn nearest(traced: &[Vec<Outcome>], index: usize, rounding: Rounding) -> (Option<(usize, Outcome)>, Certainty) {
    let outcomes = || traced.iter().enumerate().filter_map(|(shape, outcomes)| Some((shape, outcomes.get(index)?)));
    let mut winner: Option<(usize, Outcome)> = None;
    for (shape, outcome) in outcomes().filter(|(_, outcome)| outcome.drawn) {
        if winner.is_none_or(|(_, nearest)| outcome.t < nearest.t) {
            winner = Some((shape, *outcome));
        }
    }
    let unknown = match winner {
        None => outcomes().any(|(_, outcome)| outcome.unknown),
        Some((shape, hit)) => {
            hit.unknown || outcomes().any(|(other, outcome)| other != shape && outcome.clear < hit.bracket[1])
        }
    };
    let certainty = match (rounding, unknown, winner.is_some()) {
        (Rounding::Nearest, ..) => Certainty::Unverified,
        (Rounding::Outward, true, _) => Certainty::Unknown,
        (Rounding::Outward, false, true) => Certainty::Hit,
        (Rounding::Outward, false, false) => Certainty::Miss,
    };
    (winner, certainty)
}

fn depth(outcome: &Outcome, spot: &Spot) -> Depth {
    let Ray { direction, .. } = spot.ray;
    let distance = outcome.t * glam::DVec3::from(direction).length();
    Depth { shape: spot.shape as u16, surface: outcome.surface, bracket: outcome.bracket, t: outcome.t, distance }
}
