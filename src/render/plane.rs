//! Plane scenes: every pixel is a box, and each is decided as such. A curve is proved to pass through a pixel, proved
//! not to, or unknown; a pixel is proved inside a region, outside, or crossed by its boundary.
//!
//! Blocks of pixels are quartered until the field decides them (Tupper 2001); what is left of a pixel is quartered
//! further, and a part with proved opposite signs at two corners, on which the field is continuous, holds a crossing.

use std::time::Instant;

use rayon::prelude::*;

use crate::derive::Precision;
use crate::derive::Rounding;
use crate::derive::Spec;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::interval::Interval;
use crate::kernel::Backend;
use crate::kernel::verdict;
use crate::program::scene::Parameter;
use crate::program::scene::Scene;
use crate::program::scene::ShapeKind;
use crate::render::Control;
use crate::render::batch::Batch;
use crate::render::batch::Program;
use crate::render::context::proves_condition;
use crate::render::context::refutes_condition;
use crate::render::context::sign;
use crate::render::geometry::check;
use crate::render::ink;
use crate::render::march::GROUPS;
use crate::render::options::Options;
use crate::render::outcome::Surface;
use crate::render::picture::Certainty;
use crate::render::picture::Depth;
use crate::render::picture::Picture;
use crate::render::plan::Plan;
use crate::render::plan::arithmetic;
use crate::render::programs::Compiled;
use crate::render::programs::Orders;
use crate::render::stats::Evaluations;
use crate::render::stats::Stats;
use crate::render::stats::median;
use crate::render::stopped;

/// Pixels across the blocks that are tasks of their own.
const BLOCK: u32 = 64;

/// How often a pixel is quartered before it is given up as unknown.
const QUARTERINGS: usize = 6;

/// Undecided parts of one pixel at one level beyond which it is given up: a curve passes through a few, a double curve
/// through twice as many.
const PARTS: usize = 24;

/// By how much of a pixel the raster is moved against the domain, so that curves along round numbers, which axes and
/// symmetries are, do not run exactly along the edges of pixels, where no sign can be proved.
const OFFSET: [f64; 2] = [0.0137, 0.0219];

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

/// The raster of a plane scene: pixel (i, j) is [x_i, x_(i+1)] x [y_(j+1), y_j].
#[derive(Debug, Clone)]
pub struct Raster {
    /// Edges of columns, rising, and of rows, falling: shared by neighbours, so that no gap can open.
    pub x: Vec<f64>,
    pub y: Vec<f64>,
    /// The side of a pixel.
    pub pixel: f64,
    pub domain: [Interval; 2],
}

impl Raster {
    fn new(domain: &[Interval], width: u32, height: u32) -> Self {
        let domain = [domain[0], domain[1]];
        let pixel = (domain[0].width() / f64::from(width)).max(domain[1].width() / f64::from(height));
        let edges = |axis: usize, count: u32, direction: f64| {
            let centre = domain[axis].mid() + OFFSET[axis] * pixel;
            let place = |i: u32| centre + direction * pixel * (f64::from(i) - 0.5 * f64::from(count));
            (0..=count).map(place).collect()
        };
        Self { x: edges(0, width, 1.0), y: edges(1, height, -1.0), pixel, domain }
    }

    /// The part of a block of pixels that lies in the domain; `None` if there is none.
    fn clip(&self, x: u32, y: u32, size: u32) -> Option<[Interval; 2]> {
        let (right, bottom) = ((x + size).min(self.x.len() as u32 - 1), (y + size).min(self.y.len() as u32 - 1));
        let columns = Interval::new(self.x[x as usize], self.x[right as usize])?;
        let rows = Interval::new(self.y[bottom as usize], self.y[y as usize])?;
        let area = [columns.intersect(self.domain[0]), rows.intersect(self.domain[1])];
        area.iter().all(|side| !side.is_empty()).then_some(area)
    }

    /// The middle of a pixel.
    pub fn centre(&self, x: usize, y: usize) -> [f64; 2] {
        [0.5 * (self.x[x] + self.x[x + 1]), 0.5 * (self.y[y] + self.y[y + 1])]
    }
}

/// A shape's kernels.
struct ShapeKernels {
    region: Compiled<f64>,
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
            kernels.push(ShapeKernels { region, gradient });
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
            let program = kernels.region.bind(parameters, &[]);
            let solid = shape.kind == ShapeKind::Region;
            let decided: Vec<Option<(Vec<Place>, u64)>> = corners
                .par_iter()
                .map(|&(x, y)| {
                    let decided = (!control.is_cancelled()).then(|| {
                        let mut decider = Decider::new(raster, &program, solid, shape.condition.is_some());
                        (decider.block(x, y), decider.batch.evaluations)
                    });
                    control.advance(corners.len() * self.kernels.len());
                    decided
                })
                .collect();
            let mut whole = vec![Place::Outside; pixels];
            for (&(x, y), decided) in corners.iter().zip(decided) {
                let (block, evaluations) = decided.ok_or_else(stopped)?;
                stats.evaluations += Evaluations { beam: evaluations, ..Evaluations::default() };
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

/// A square of pixels to be decided.
#[derive(Debug, Clone, Copy)]
struct Square {
    x: u32,
    y: u32,
    size: u32,
}

impl Square {
    /// Column and row of each of its pixels.
    fn places(self) -> impl Iterator<Item = (u32, u32)> {
        (self.y..self.y + self.size).flat_map(move |y| (self.x..self.x + self.size).map(move |x| (x, y)))
    }
}

/// A part of a pixel to be decided.
#[derive(Debug, Clone, Copy)]
struct Patch {
    /// The pixel's index in its block.
    pixel: usize,
    area: [Interval; 2],
}

/// Decides the pixels of one block.
struct Decider<'a> {
    raster: &'a Raster,
    batch: Batch<f64>,
    solid: bool,
    condition: bool,
}

/// What one evaluation says of an area.
#[derive(Debug, Clone, Copy)]
enum Finding {
    Outside,
    Inside,
    /// Undecided; whether the field is continuous and the condition holds on all of it.
    Open(bool),
}

impl<'a> Decider<'a> {
    fn new(raster: &'a Raster, program: &Program<f64>, solid: bool, condition: bool) -> Self {
        Self { raster, batch: Batch::new(program, GROUPS), solid, condition }
    }

    /// The places of the block's pixels, row by row, [`BLOCK`] a row.
    fn block(&mut self, x: u32, y: u32) -> Vec<Place> {
        let mut places = vec![Place::Outside; (BLOCK * BLOCK) as usize];
        let mut squares = vec![Square { x, y, size: BLOCK }];
        let mut patches = Vec::new();
        while !squares.is_empty() {
            let areas: Vec<Option<[Interval; 2]>> =
                squares.iter().map(|square| self.raster.clip(square.x, square.y, square.size)).collect();
            let inside: Vec<[Interval; 2]> = areas.iter().flatten().copied().collect();
            let mut findings = self.evaluate(&inside).into_iter();
            let mut next = Vec::new();
            for (square, area) in squares.into_iter().zip(areas) {
                let Some(area) = area else { continue };
                let finding = findings.next().expect("one finding for each area");
                match finding {
                    Finding::Outside => {}
                    Finding::Inside => {
                        let last = (self.raster.x.len() as u32 - 2, self.raster.y.len() as u32 - 2);
                        for (column, row) in square.places().filter(|&(column, row)| column <= last.0 && row <= last.1)
                        {
                            // The square may reach beyond the domain.
                            if self.raster.clip(column, row, 1).is_some() {
                                places[((row - y) * BLOCK + column - x) as usize] = Place::Inside;
                            }
                        }
                    }
                    Finding::Open(_) if square.size == 1 => {
                        patches.push(Patch { pixel: ((square.y - y) * BLOCK + square.x - x) as usize, area });
                    }
                    Finding::Open(_) => {
                        let (width, height) = (self.raster.x.len() as u32 - 1, self.raster.y.len() as u32 - 1);
                        let half = square.size / 2;
                        next.extend(
                            [(0, 0), (half, 0), (0, half), (half, half)]
                                .map(|(dx, dy)| Square { x: square.x + dx, y: square.y + dy, size: half })
                                .into_iter()
                                .filter(|square| square.x < width && square.y < height),
                        );
                    }
                }
            }
            squares = next;
        }
        self.quarter(patches, &mut places);
        places
    }

    /// Decides pixels that are undecided as a whole.
    fn quarter(&mut self, mut patches: Vec<Patch>, places: &mut [Place]) {
        // A pixel with one part inside a region and one outside is crossed by the region's boundary.
        let mut outside = vec![false; places.len()];
        for level in 0..=QUARTERINGS {
            let areas: Vec<[Interval; 2]> = patches.iter().map(|patch| patch.area).collect();
            let findings = self.evaluate(&areas);
            let mut open = Vec::new();
            for (patch, finding) in patches.iter().zip(findings) {
                match finding {
                    Finding::Outside => outside[patch.pixel] = true,
                    Finding::Inside if places[patch.pixel] == Place::Outside => places[patch.pixel] = Place::Inside,
                    Finding::Inside => {}
                    Finding::Open(sound) => open.push((*patch, sound)),
                }
            }
            for (patch, signs) in
                open.iter().filter(|(_, sound)| *sound).zip(self.corners(&open)).map(|((p, _), s)| (p, s))
            {
                let both = [verdict::POSITIVE, verdict::NEGATIVE].iter().all(|&wanted| signs.contains(&wanted));
                if both {
                    places[patch.pixel] = Place::Crossed;
                }
            }
            for patch in &patches {
                if outside[patch.pixel] && places[patch.pixel] == Place::Inside {
                    places[patch.pixel] = Place::Crossed;
                }
            }
            open.retain(|(patch, _)| places[patch.pixel] != Place::Crossed);
            // Patches of a pixel are neighbours in the list, since their parents were.
            let crowded: Vec<bool> = {
                let runs = open.chunk_by(|a, b| a.0.pixel == b.0.pixel);
                runs.flat_map(|run| std::iter::repeat_n(run.len() > PARTS, run.len())).collect()
            };
            patches = Vec::new();
            for ((patch, _), crowded) in open.into_iter().zip(crowded) {
                if crowded || level == QUARTERINGS {
                    places[patch.pixel] = Place::Unknown;
                } else {
                    patches.extend(quarters(patch.area).map(|area| Patch { area, ..patch }));
                }
            }
            if patches.is_empty() {
                return;
            }
        }
    }

    fn evaluate(&mut self, areas: &[[Interval; 2]]) -> Vec<Finding> {
        let mut findings = Vec::with_capacity(areas.len());
        for areas in areas.chunks(self.batch.capacity()) {
            for (lane, area) in areas.iter().enumerate() {
                for (axis, side) in area.iter().enumerate() {
                    self.batch.set_range(lane, axis, side.lo(), side.hi());
                }
            }
            self.batch.run(areas.len());
            findings.extend((0..areas.len()).map(|lane| self.finding(lane)));
        }
        findings
    }

    fn finding(&self, lane: usize) -> Finding {
        let bits = self.batch.bits(lane, 0);
        let condition = if self.condition { self.batch.bits(lane, 1) } else { !verdict::REFUTED | verdict::POSITIVE };
        let sound = bits & verdict::CONTINUOUS != 0 && proves_condition(condition);
        let numerator = 1 + usize::from(self.condition);
        let no_zero = numerator < self.batch.output_slots() && sign(self.batch.bits(lane, numerator)) != 0;
        if bits & verdict::EMPTY != 0 || no_zero || refutes_condition(condition) {
            return Finding::Outside;
        }
        match (sign(bits), self.solid) {
            (0, _) => Finding::Open(sound),
            (verdict::NEGATIVE, true) if sound => Finding::Inside,
            (verdict::NEGATIVE, true) => Finding::Open(sound),
            _ => Finding::Outside,
        }
    }

    /// The proved signs at the corners of those areas on which a change of sign is a crossing.
    fn corners(&mut self, open: &[(Patch, bool)]) -> Vec<[u32; 4]> {
        let sound = open.iter().filter(|(_, sound)| *sound);
        let points: Vec<[f64; 2]> = sound
            .flat_map(|(Patch { area: [x, y], .. }, _)| {
                [[x.lo(), y.lo()], [x.hi(), y.lo()], [x.lo(), y.hi()], [x.hi(), y.hi()]]
            })
            .collect();
        let mut signs = Vec::with_capacity(points.len());
        for points in points.chunks(self.batch.capacity()) {
            for (lane, point) in points.iter().enumerate() {
                for (axis, &coordinate) in point.iter().enumerate() {
                    self.batch.set_range(lane, axis, coordinate, coordinate);
                }
            }
            self.batch.run(points.len());
            signs.extend((0..points.len()).map(|lane| sign(self.batch.bits(lane, 0))));
        }
        signs.chunks_exact(4).map(|s| [s[0], s[1], s[2], s[3]]).collect()
    }
}

/// The four parts of an area, which share their ends.
fn quarters([x, y]: [Interval; 2]) -> [[Interval; 2]; 4] {
    let halves = |side: Interval| {
        let middle = side.mid();
        [(side.lo(), middle), (middle, side.hi())].map(|(lo, hi)| Interval::new(lo, hi).unwrap_or(side))
    };
    let ([left, right], [low, high]) = (halves(x), halves(y));
    [[left, low], [right, low], [left, high], [right, high]]
}
