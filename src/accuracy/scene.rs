//! A scene at many levels of accuracy.

use serde::Serialize;

use crate::accuracy::Progress;
use crate::accuracy::finder;
use crate::accuracy::finder::Settings;
use crate::accuracy::level::BASELINE;
use crate::accuracy::level::Engine;
use crate::accuracy::level::Goal;
use crate::accuracy::level::Level;
use crate::accuracy::level::OWN_ENGINE;
use crate::accuracy::level::Selection;
use crate::accuracy::level::precision_name;
use crate::accuracy::level::rounding_name;
use crate::accuracy::pareto;
use crate::accuracy::picture;
use crate::accuracy::picture::Pictures;
use crate::accuracy::truth::Drawn;
use crate::accuracy::truth::Errors;
use crate::accuracy::truth::Truth;
use crate::derive::Precision;
use crate::derive::Rounding;
use crate::diagnostic::Diagnostic;
use crate::kernel::Backend;
use crate::program::scene::Scene;
use crate::render::Control;
use crate::render::Depth;
use crate::render::Enclosures;
use crate::render::Layers;
use crate::render::Options;
use crate::render::Renderer;
use crate::render::Stop;
use crate::render::Surface;
use crate::render::median;

/// How deep the reference goes: far below the finest level, and still well above the spacing of doubles.
const REFERENCE_DEPTH: u32 = 40;

/// Of a level that took longer than this, in milliseconds, the finer ones of its kind are left out.
const PATIENCE: f64 = 5_000.0;

/// No further repeats of a level that has taken this long in all, in milliseconds.
const REPEATING: f64 = 1_500.0;

/// What accuracy costs for one scene.
#[derive(Debug, Clone, Serialize)]
pub struct SceneCost {
    /// The file, as the user named it.
    pub scene: String,
    pub version: &'static str,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// 2 or 3.
    pub dimension: usize,
    /// The longest side of the domain, in the scene's units.
    pub side: f64,
    pub threads: usize,
    /// How often each level was measured; the median counts.
    pub repeats: u32,
    /// The level that ratios of time refer to.
    pub baseline: String,
    pub reference: Reference,
    /// Sorted by error, then time; levels that failed last.
    pub levels: Vec<Row>,
}

/// What everything is compared with.
#[derive(Debug, Clone, Serialize)]
pub struct Reference {
    pub name: String,
    pub ms: f64,
    /// Proved hits and misses, and what even the reference left open and no comparison uses.
    pub hits: u64,
    pub misses: u64,
    pub unknown: u64,
    /// Thin parts among the hits.
    pub thin_parts: u64,
    #[serde(skip)]
    pub color: Vec<u8>,
}

/// One level and what came of it.
#[derive(Debug, Clone, Serialize)]
pub struct Row {
    /// The place in the order, from 1.
    pub number: usize,
    pub name: String,
    pub engine: &'static str,
    pub arithmetic: &'static str,
    pub precision: &'static str,
    pub rounding: &'static str,
    /// The wanted brackets are 2^-depth of the domain's longest side.
    pub depth: Option<u32>,
    /// Pixels of this level's own picture.
    pub size: [u32; 2],
    #[serde(flatten)]
    pub outcome: Outcome,
}

#[derive(Debug, Clone, Serialize)]
#[serde(untagged)]
pub enum Outcome {
    Measured(Box<Measured>),
    /// Why there are no numbers.
    Failed {
        failure: String,
    },
}

/// What a level costs, and what it is worth.
#[derive(Debug, Clone, Serialize)]
pub struct Measured {
    /// Time to find what every pixel sees, without compiling and shading: median, least and most of the repeats.
    pub ms: f64,
    pub ms_least: f64,
    pub ms_most: f64,
    pub repeats: u32,
    /// `ms` over the baseline's.
    pub ratio: Option<f64>,
    /// Not known of named finders.
    pub compile_ms: Option<f64>,
    /// Kernel evaluations, all kinds, and the same for one pixel.
    pub evaluations: u64,
    pub evaluations_per_pixel: f64,
    /// Pixels in which something is drawn.
    pub hits: u64,
    /// Hits and misses that are proved; with rounding to nearest none is.
    pub proved_hits: u64,
    pub proved_misses: u64,
    /// Pixels of which nothing is claimed.
    pub unknown: u64,
    #[serde(flatten)]
    pub errors: Errors,
    /// On the Pareto front of error and time.
    pub pareto: bool,
    /// The same among the root finders of the literature alone.
    pub pareto_finders: bool,
    /// On the Pareto front of the brackets' length and time among what is rounded outward.
    pub pareto_bracket: bool,
    #[serde(skip)]
    pub pictures: Pictures,
}

impl Row {
    pub fn measured(&self) -> Option<&Measured> {
        match &self.outcome {
            Outcome::Measured(measured) => Some(measured),
            Outcome::Failed { .. } => None,
        }
    }
}

/// What to measure.
#[derive(Debug, Clone, Copy)]
pub struct Request {
    pub size: (u32, u32),
    pub repeats: u32,
    pub selection: Selection,
}

/// Renders a scene at all levels of a selection.
///
/// # Errors
/// If the scene cannot be drawn at all. A level that fails is a row that says why.
pub fn of_scene(
    name: &str,
    scene: &Scene,
    request: Request,
    backend: &dyn Backend,
    progress: Progress<'_>,
) -> Result<SceneCost, Diagnostic> {
    let levels = match scene.dimension() {
        2 => Level::of_plane(request.selection, request.size),
        _ => Level::of_space(request.selection),
    };
    let steps = levels.len() * request.repeats.max(1) as usize + 1;
    progress(0, steps, "reference");
    let bench = Bench::new(scene, request, backend)?;
    let mut trials: Vec<Trial<'_>> = Vec::new();
    for (index, &level) in levels.iter().enumerate() {
        progress(index + 1, steps, &level.to_string());
        let state = match too_slow(&trials, &level) {
            Some(reason) => Err(reason),
            None => bench.first(&level).map_err(|diagnostic| diagnostic.title),
        };
        trials.push(Trial { level, state });
    }
    // Round by round, so that what else the machine does in the meantime meets all levels alike.
    for round in 1..request.repeats as usize {
        for (index, trial) in trials.iter_mut().enumerate() {
            progress(round * levels.len() + index + 1, steps, &trial.level.to_string());
            trial.repeat();
        }
    }
    progress(steps, steps, "");
    let outcomes = trials.into_iter().map(Trial::outcome).collect();
    Ok(bench.finish(name, outcomes))
}

/// One level under way, or why it failed.
struct Trial<'a> {
    level: Level,
    state: Result<Repeated<'a>, String>,
}

/// What the first run gave, and the times of all.
struct Repeated<'a> {
    runner: Runner<'a>,
    measured: Box<Measured>,
    times: Vec<f64>,
}

impl Trial<'_> {
    fn repeat(&mut self) {
        let Ok(Repeated { runner, times, .. }) = &mut self.state else { return };
        if times.iter().sum::<f64>() > REPEATING {
            return;
        }
        match runner.run() {
            Ok(run) => times.push(run.ms),
            Err(diagnostic) => self.state = Err(diagnostic.title),
        }
    }

    fn outcome(self) -> (Level, Outcome) {
        let outcome = match self.state {
            Err(failure) => Outcome::Failed { failure },
            Ok(Repeated { mut measured, times, .. }) => {
                measured.repeats = times.len() as u32;
                measured.ms_least = times.iter().copied().fold(f64::INFINITY, f64::min);
                measured.ms_most = times.iter().copied().fold(0.0, f64::max);
                measured.ms = median(times);
                Outcome::Measured(measured)
            }
        };
        (self.level, outcome)
    }
}

/// Why a level is not worth waiting for: a coarser one of its kind took too long.
fn too_slow(trials: &[Trial<'_>], level: &Level) -> Option<String> {
    trials.iter().filter(|trial| trial.level.same_but_goal(level)).find_map(|trial| {
        let ms = trial.state.as_ref().ok()?.times[0];
        (ms > PATIENCE).then(|| format!("left out: {} took {:.1} s", trial.level, 1e-3 * ms))
    })
}

/// What one run of a level gave.
struct Run {
    drawn: Drawn,
    ms: f64,
    evaluations: u64,
}

/// Everything that the levels of one scene share.
struct Bench<'a> {
    scene: &'a Scene,
    request: Request,
    backend: &'a dyn Backend,
    /// The renderer of the reference, which knows the rays and paints the pictures.
    painter: Renderer,
    truth: Truth,
    reference: Reference,
}

impl<'a> Bench<'a> {
    fn new(scene: &'a Scene, request: Request, backend: &'a dyn Backend) -> Result<Self, Diagnostic> {
        let (width, height) = request.size;
        let layers = Layers { depth: true, ..Layers::default() };
        let finest = Level { precision: Precision::Double, goal: Goal::Depth(REFERENCE_DEPTH), ..BASELINE };
        let options = Options { layers, ..options(&finest, Enclosures::Auto, request.size) };
        let painter = Renderer::new(scene, &options, backend)?;
        let picture = painter.render(&scene.parameters, &Control::default())?;
        let drawn = Drawn::new(&picture);
        let lengths = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        // The pixels of a plane scene have no rays; there is no depth to be measured.
        let lengths = lengths.map(|(x, y)| painter.ray(x, y).map_or(1.0, |ray| length(ray.direction)));
        let side = scene.domain.iter().map(|range| range.width()).fold(0.0, f64::max);
        let truth = Truth::new(&drawn, width, lengths.collect(), side);
        let reference = Reference {
            name: match scene.dimension() {
                2 => format!("imp auto f64 outward {width}x{height}"),
                _ => finest.to_string(),
            },
            ms: picture.stats.render_ms,
            hits: picture.stats.proved,
            misses: picture.stats.misses,
            unknown: picture.stats.unknown,
            thin_parts: truth.thin_parts(),
            color: picture::png(width, &picture.color),
        };
        Ok(Self { scene, request, backend, painter, truth, reference })
    }

    /// A level after its first run, with its errors and its pictures; where it stands among the others is not known yet.
    fn first(&self, level: &Level) -> Result<Repeated<'_>, Diagnostic> {
        let runner = Runner::new(self, level)?;
        let Run { drawn, ms, evaluations } = runner.run()?;
        let cell = match level.goal {
            Goal::Depth(depth) => self.truth.side * (-f64::from(depth)).exp2(),
            Goal::Size(..) => self.truth.side,
        };
        let mut errors = self.truth.judge(&drawn, cell);
        if self.scene.dimension() == 2 {
            errors.leave_out_depths();
        }
        let counted = |wanted: &dyn Fn(bool, bool) -> bool| {
            drawn.hits.iter().zip(&drawn.proved).filter(|&(hit, &proved)| wanted(hit.is_some(), proved)).count() as u64
        };
        let marks = level.rounding == Rounding::Outward;
        let measured = Measured {
            ms,
            ms_least: ms,
            ms_most: ms,
            repeats: 1,
            ratio: None,
            compile_ms: runner.compile_ms(),
            evaluations,
            evaluations_per_pixel: evaluations as f64 / (f64::from(runner.size.0) * f64::from(runner.size.1)),
            hits: counted(&|hit, _| hit),
            proved_hits: counted(&|hit, proved| hit && proved),
            proved_misses: counted(&|hit, proved| !hit && proved),
            unknown: drawn.unknown.iter().filter(|&&unknown| unknown).count() as u64,
            errors,
            pareto: false,
            pareto_finders: false,
            pareto_bracket: false,
            pictures: Pictures {
                color: runner.color(&drawn)?,
                errors: picture::png(self.truth.width, &picture::error_map(&self.truth, &drawn, marks)),
            },
        };
        Ok(Repeated { runner, measured: Box::new(measured), times: vec![ms] })
    }

    /// Ratios, fronts and the order of all levels, of which the first is the baseline.
    fn finish(&self, name: &str, outcomes: Vec<(Level, Outcome)>) -> SceneCost {
        let rows = outcomes.into_iter().map(|(level, outcome)| row(&level, self.request.size, outcome));
        let mut rows: Vec<Row> = rows.collect();
        let baseline = rows.first().map_or_else(String::new, |row| row.name.clone());
        let unit = rows.first().and_then(Row::measured).map(|measured| measured.ms);
        // Who has no number takes no part.
        let front = |rows: &[Row], number: &dyn Fn(&Row, &Measured) -> Option<f64>| {
            let point = |row: &Row| row.measured().and_then(|m| Some((number(row, m)?, m.ms)));
            let points: Vec<(f64, f64)> = rows.iter().map(|row| point(row).unwrap_or((f64::NAN, f64::NAN))).collect();
            pareto::front(&points)
        };
        let by_error = front(&rows, &|_, m| Some(m.errors.error));
        let of_finders = front(&rows, &|row, m| (row.engine != OWN_ENGINE).then_some(m.errors.error));
        // A bracket is a claim, which only rounding outward makes.
        let outward = rounding_name(Rounding::Outward);
        let by_bracket = front(&rows, &|row, m| m.errors.bracket_median.filter(|_| row.rounding == outward));
        for (index, row) in rows.iter_mut().enumerate() {
            if let Outcome::Measured(measured) = &mut row.outcome {
                measured.ratio = unit.map(|unit| measured.ms / unit);
                measured.pareto = by_error[index];
                measured.pareto_finders = of_finders[index];
                measured.pareto_bracket = by_bracket[index];
            }
        }
        let key = |row: &Row| row.measured().map_or((f64::INFINITY, f64::INFINITY), |m| (m.errors.error, m.ms));
        rows.sort_by(|a, b| key(a).0.total_cmp(&key(b).0).then(key(a).1.total_cmp(&key(b).1)));
        for (number, row) in rows.iter_mut().enumerate() {
            row.number = number + 1;
        }
        let (width, height) = self.request.size;
        SceneCost {
            scene: name.to_owned(),
            version: env!("CARGO_PKG_VERSION"),
            size: [width, height],
            dimension: self.scene.dimension(),
            side: self.truth.side,
            threads: rayon::current_num_threads(),
            repeats: self.request.repeats,
            baseline,
            reference: self.reference.clone(),
            levels: rows,
        }
    }
}

fn row(level: &Level, (width, height): (u32, u32), outcome: Outcome) -> Row {
    let (depth, size) = match level.goal {
        Goal::Depth(depth) => (Some(depth), [width, height]),
        Goal::Size(width, height) => (None, [width, height]),
    };
    Row {
        number: 0,
        name: level.to_string(),
        engine: level.engine.name(),
        arithmetic: level.engine.arithmetic(),
        precision: precision_name(level.precision),
        rounding: rounding_name(level.rounding),
        depth,
        size,
        outcome,
    }
}

/// The renderer's options for a level of Imp's own engine. Nothing is shaded, so that times are those of finding hits.
fn options(level: &Level, enclosures: Enclosures, (width, height): (u32, u32)) -> Options {
    let stop = match level.goal {
        Goal::Depth(depth) => Stop::Depth(depth),
        Goal::Size(..) => Stop::default(),
    };
    let layers = Layers { color: false, depth: true, normal: false, certainty: false };
    let (precision, rounding) = (level.precision, level.rounding);
    Options { width, height, enclosures, precision, rounding, stop, layers, ..Options::default() }
}

fn length(vector: [f64; 3]) -> f64 {
    vector.iter().map(|component| component * component).sum::<f64>().sqrt()
}

/// A level ready to run.
struct Runner<'a> {
    bench: &'a Bench<'a>,
    method: Method,
    /// Pixels of its own picture.
    size: (u32, u32),
}

enum Method {
    Imp { renderer: Box<Renderer>, level: Level, enclosures: Enclosures },
    Finder(Settings),
}

impl<'a> Runner<'a> {
    fn new(bench: &'a Bench<'a>, level: &Level) -> Result<Self, Diagnostic> {
        let (epsilon, size) = match level.goal {
            Goal::Depth(depth) => (bench.truth.side * (-f64::from(depth)).exp2(), bench.request.size),
            Goal::Size(width, height) => (bench.truth.side, (width, height)),
        };
        let Level { precision, rounding, .. } = *level;
        let method = match level.engine {
            Engine::Imp(enclosures) => {
                let renderer = Renderer::new(bench.scene, &options(level, enclosures, size), bench.backend)?;
                Method::Imp { renderer: Box::new(renderer), level: *level, enclosures }
            }
            Engine::Finder(finder, arithmetic) => {
                Method::Finder(Settings { finder, precision, rounding, arithmetic, epsilon })
            }
        };
        Ok(Self { bench, method, size })
    }

    fn run(&self) -> Result<Run, Diagnostic> {
        match &self.method {
            Method::Imp { renderer, .. } => {
                let picture = renderer.render(&self.bench.scene.parameters, &Control::default())?;
                let drawn = self.in_reference_pixels(Drawn::new(&picture));
                Ok(Run { drawn, ms: picture.stats.render_ms, evaluations: picture.stats.evaluations.total() })
            }
            Method::Finder(settings) => {
                let Bench { scene, painter, backend, .. } = self.bench;
                let sampled = finder::sample(scene, &|x, y| painter.ray(x, y), self.size, settings, *backend)?;
                let ms = 1e3 * sampled.seconds;
                let hit = |(index, bracket): (usize, Option<[f64; 2]>)| {
                    bracket.map(|bracket| {
                        let t = 0.5 * (bracket[0] + bracket[1]);
                        let distance = t * self.bench.truth.speed[index];
                        // Finders do not tell shapes apart; all are painted as the first.
                        Depth { shape: 0, surface: Surface::Field, bracket, t, distance }
                    })
                };
                let hits = sampled.depth.into_iter().enumerate().map(hit).collect();
                let proved = sampled.unknown.iter().map(|unknown| !unknown).collect();
                let drawn = Drawn { hits, proved, unknown: sampled.unknown };
                Ok(Run { drawn, ms, evaluations: sampled.evaluations })
            }
        }
    }

    /// The answer for the pixels of the reference: that of the pixel that holds the centre of each. A proof about a larger
    /// box says nothing of the smaller one.
    fn in_reference_pixels(&self, drawn: Drawn) -> Drawn {
        let (width, height) = self.bench.request.size;
        if self.size == (width, height) {
            return drawn;
        }
        let place = |i: u32, of: u32, own: u32| (u64::from(2 * i + 1) * u64::from(own) / u64::from(2 * of)) as usize;
        let own = |(x, y)| place(y, height, self.size.1) * self.size.0 as usize + place(x, width, self.size.0);
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let indices: Vec<usize> = pixels.map(own).collect();
        Drawn {
            hits: indices.iter().map(|&index| drawn.hits[index]).collect(),
            proved: vec![false; indices.len()],
            unknown: indices.iter().map(|&index| drawn.unknown[index]).collect(),
        }
    }

    fn compile_ms(&self) -> Option<f64> {
        match &self.method {
            Method::Imp { renderer, .. } => Some(renderer.compile_ms()),
            Method::Finder(_) => None,
        }
    }

    /// The level's picture as the bytes of a PNG file.
    fn color(&self, drawn: &Drawn) -> Result<Vec<u8>, Diagnostic> {
        let Bench { scene, painter, backend, .. } = self.bench;
        match &self.method {
            Method::Imp { level, enclosures, .. } if scene.dimension() == 2 => {
                let options = Options { layers: Layers::default(), ..options(level, *enclosures, self.size) };
                let picture = Renderer::new(scene, &options, *backend)?;
                let picture = picture.render(&scene.parameters, &Control::default())?;
                Ok(picture::png(picture.width, &picture.color))
            }
            _ => Ok(picture::png(self.size.0, &painter.paint(&scene.parameters, &drawn.hits))),
        }
    }
}
