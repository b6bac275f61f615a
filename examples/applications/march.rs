//! A game's loop that draws a formula: its parameters are sliders that move with every frame, and nothing is compiled after the
//! start. Rays advance by the value of the formula over a bound of its slope, and that bound is **proved** anew for each
//! frame, by enclosing the gradient over cells that cover the room: a step can then not pass through the surface, whatever
//! the sliders say (J. C. Hart, "Sphere Tracing", 1996; D. Kalra and A. Barr, 1989). What is not proved are the last bits: values at
//! points are rounded to nearest in single precision, which the steps leave room for.
//!
//! At the end the same frames are drawn as one would without parameters, with the numbers written into the formula and all of
//! it compiled again.
//!
//!     cargo run --release --example march -- STRIP.png 120 320      120 frames, 320 pixels wide

use std::error::Error;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;
use std::time::Instant;

use imp::Columns;
use imp::Interval;
use imp::IntervalKernel;
use imp::Options;
use imp::PointKernel;
use imp::Program;
use rayon::prelude::*;

/// The scene; the sliders' values go in where they are declared.
const SCENE: &str = "
fn soft_min(a, b) = min(a, b) - blend / 4 * max(1 - abs(a - b) / blend, 0)^2
fn ball(x, y, z) = sqrt(x^2 + y^2 + z^2) - radius
fn ring(x, y, z) = sqrt((sqrt(x^2 + y^2 + 0.04) - 1.1)^2 + z^2 + 0.01) - 0.25
fn turned(x, y, z) = ring(x, y cos(turn) - z sin(turn), y sin(turn) + z cos(turn))
fn scene(x, y, z) = soft_min(ball(x, y, z), turned(x, y, z)) + bumps sin(7x) sin(7y) sin(7z)
";
/// Name and range of each slider.
const SLIDERS: [(&str, [f64; 2]); 4] =
    [("radius", [0.5, 1.0]), ("blend", [0.1, 0.8]), ("bumps", [0.0, 0.06]), ("turn", [-8.0, 8.0])];

/// The room is a cube of twice this side, in cells.
const ROOM: f64 = 2.0;
const CELLS: usize = 24;
/// A ray that is nearer to the surface than this has hit it.
const NEAR: f32 = 2e-3;
/// Part of the proved step that is taken, for the rounding of the value and of the ray.
const SAFE: f32 = 0.999;
/// The eye is on the negative z axis, and rays end this far from it.
const EYE: f32 = -4.0;
const FAR: f32 = 6.5;

/// What draws a frame; a clone shares the code.
#[derive(Clone)]
struct Scene {
    values: PointKernel<f32>,
    normals: PointKernel<f32>,
    slopes: IntervalKernel,
    /// The lower and the upper ends of the cells in x, y and z.
    cells: Arc<[[Vec<f64>; 2]; 3]>,
}

impl Scene {
    fn compile(text: &str) -> Result<Self, imp::Error> {
        let scene = Program::named("scene.imp", text)?.function("scene")?;
        let end = |i: usize| -ROOM + 2.0 * ROOM * i as f64 / CELLS as f64;
        let place = |axis: u32, cell: usize| cell / CELLS.pow(axis) % CELLS;
        let ends = |axis, next| (0..CELLS.pow(3)).map(|cell| end(place(axis, cell) + next)).collect();
        Ok(Scene {
            cells: Arc::new([0, 1, 2].map(|axis| [ends(axis, 0), ends(axis, 1)])),
            values: scene.point_kernel(&Options::default())?,
            normals: scene.point_kernel(&Options::with_gradient())?,
            slopes: scene.intervals(&Options::with_gradient())?,
        })
    }

    /// With sliders: the program that is compiled once.
    fn with_sliders() -> Result<Self, imp::Error> {
        let parameters =
            SLIDERS.map(|(name, [lo, hi])| format!("param {name} = {} in [{lo}, {hi}]\n", 0.5 * lo + 0.5 * hi));
        Self::compile(&(parameters.concat() + SCENE))
    }

    /// With the sliders' values written into it.
    fn with_constants(sliders: [f64; 4]) -> Result<Self, imp::Error> {
        let constants: Vec<_> =
            SLIDERS.iter().zip(sliders).map(|((name, _), value)| format!("let {name} = {value}\n")).collect();
        Self::compile(&(constants.concat() + SCENE))
    }

    fn set(&mut self, sliders: [f64; 4]) -> Result<(), imp::Error> {
        for ((name, _), value) in SLIDERS.into_iter().zip(sliders) {
            self.values.set(name, value)?;
            self.normals.set(name, value)?;
            self.slopes.set(name, Interval::point(value))?;
        }
        Ok(())
    }

    /// A bound of the slope wherever the scene is not proved to be solid: the steepest of the cells.
    fn steepest(&self) -> Result<f64, imp::Error> {
        // A quarter of the cells at a time, each on a thread.
        let part = CELLS.pow(3).div_ceil(4);
        let steepest = (0..4).into_par_iter().map(|task| {
            let range = |column: &Vec<f64>| task * part..((task + 1) * part).min(column.len());
            let boxes = self.cells.each_ref().map(|side| side.each_ref().map(|column| &column[range(column)]));
            let mut found = Columns::default();
            self.slopes.enclose_columns(&boxes, &mut found)?;
            let square = |i: usize, k: usize| {
                let (lo, hi) = (found.lo[i][k].abs(), found.hi[i][k].abs());
                // An end that is no number stands for an infinite one.
                if lo.is_nan() || hi.is_nan() { f64::INFINITY } else { lo.max(hi).powi(2) }
            };
            let cells = (0..found.lo[0].len()).filter(|&k| !found.verdict[0][k].is_negative());
            Ok(cells.map(|k| square(1, k) + square(2, k) + square(3, k)).fold(0.0, f64::max).sqrt() * (1.0 + 1e-9))
        });
        steepest.try_reduce(|| 0.0, |a, b| Ok(a.max(b)))
    }

    /// Draws the scene; returns the colours, the distance along each ray (infinite where nothing is hit), and the bound of the slope.
    fn draw(&self, width: usize, height: usize) -> Result<Frame, imp::Error> {
        let slope = self.steepest()?;
        let step = SAFE / slope as f32;
        let mut frame = Frame { colours: vec![[0; 3]; width * height], depths: vec![0.0; width * height], slope };
        // Some rows at a time, so that thousands of rays share a call.
        let rows = 8 * width;
        frame.colours.par_chunks_mut(rows).zip(frame.depths.par_chunks_mut(rows)).enumerate().try_for_each(
            |(band, (colours, depths))| {
                let mut rays: Vec<Ray> =
                    (0..colours.len()).map(|k| Ray::new(band * rows + k, k, width, height)).collect();
                depths.fill(f32::INFINITY);
                self.march(&mut rays, step, depths)?;
                self.shade(&mut rays, depths, colours)
            },
        )?;
        Ok(frame)
    }

    /// Moves all rays until each has hit the surface, or passed the room.
    fn march(&self, rays: &mut Vec<Ray>, step: f32, depths: &mut [f32]) -> Result<(), imp::Error> {
        let mut going = rays.clone();
        let mut points: [Vec<f32>; 3] = Default::default();
        let mut values = Vec::new();
        while !going.is_empty() {
            columns(&going, &mut points);
            values.resize(going.len(), 0.0);
            self.values.values_columns(&points.each_ref().map(Vec::as_slice), &mut [&mut values])?;
            let mut value = values.iter();
            going.retain_mut(|ray| {
                let value = *value.next().unwrap_or(&0.0);
                if value < NEAR {
                    depths[ray.pixel] = ray.at;
                    return false;
                }
                ray.at += value * step;
                ray.at < FAR
            });
        }
        rays.retain_mut(|ray| {
            ray.at = depths[ray.pixel];
            ray.at.is_finite()
        });
        Ok(())
    }

    /// Colours by the surface's normal.
    fn shade(&self, rays: &mut [Ray], depths: &[f32], colours: &mut [[u8; 3]]) -> Result<(), imp::Error> {
        let mut points: [Vec<f32>; 3] = Default::default();
        columns(rays, &mut points);
        let mut gradient: [Vec<f32>; 4] = std::array::from_fn(|_| vec![0.0; rays.len()]);
        let mut outputs = gradient.each_mut().map(Vec::as_mut_slice);
        self.normals.values_columns(&points.each_ref().map(Vec::as_slice), &mut outputs)?;
        for (colour, depth) in colours.iter_mut().zip(depths) {
            *colour = if depth.is_finite() { [0; 3] } else { [28, 32, 44] };
        }
        for (k, ray) in rays.iter().enumerate() {
            let normal = [1, 2, 3].map(|i| gradient[i][k]);
            let length = normal.iter().map(|n| n * n).sum::<f32>().sqrt();
            let light = (0.5 * normal[0] + 0.6 * normal[1] - 0.62 * normal[2]) / length;
            let shade = 0.25 + 0.75 * light.max(0.0);
            colours[ray.pixel] = [235.0, 180.0, 110.0].map(|c: f32| (c * shade) as u8);
        }
        Ok(())
    }
}

#[derive(PartialEq)]
struct Frame {
    colours: Vec<[u8; 3]>,
    depths: Vec<f32>,
    slope: f64,
}

#[derive(Clone)]
struct Ray {
    /// Of its band.
    pixel: usize,
    direction: [f32; 3],
    at: f32,
}

impl Ray {
    fn new(index: usize, pixel: usize, width: usize, height: usize) -> Self {
        let (i, j) = ((index % width) as f32, (index / width) as f32);
        let (u, v) = (2.0 * (i + 0.5) / width as f32 - 1.0, (height as f32 - 2.0 * (j + 0.5)) / width as f32);
        let direction = [0.5 * u, 0.5 * v, 1.0];
        let length = direction.iter().map(|d| d * d).sum::<f32>().sqrt();
        // The room begins at z = -ROOM; before it nothing is known.
        Ray { pixel, direction: direction.map(|d| d / length), at: (-ROOM as f32 - EYE) * length }
    }

    fn point(&self, at: f32) -> [f32; 3] {
        let [x, y, z] = self.direction.map(|d| d * at);
        [x, y, z + EYE]
    }
}

fn columns(rays: &[Ray], points: &mut [Vec<f32>; 3]) {
    points.iter_mut().for_each(Vec::clear);
    for ray in rays {
        for (column, x) in points.iter_mut().zip(ray.point(ray.at)) {
            column.push(x);
        }
    }
}

struct Clock(Instant);

impl Clock {
    /// The time since the last lap.
    fn lap(&mut self) -> Duration {
        std::mem::replace(&mut self.0, Instant::now()).elapsed()
    }
}

/// What the player does: each slider swings over its range at its own pace.
fn sliders(frame: usize) -> [f64; 4] {
    std::array::from_fn(|i| {
        let (_, [lo, hi]) = SLIDERS[i];
        let swing = 0.5 - 0.5 * (frame as f64 * [0.11, 0.17, 0.23, 0.013][i]).cos();
        lo + (hi - lo) * swing
    })
}

/// No ray went through the surface: tiny steps along some rays find nothing before the depth that was found.
fn check(scene: &Scene, frame: &Frame, width: usize, height: usize) -> Result<usize, imp::Error> {
    let mut checked = 0;
    for index in (0..width * height).step_by(101) {
        let ray = Ray::new(index, 0, width, height);
        let depth = frame.depths[index].min(FAR);
        let points: Vec<f32> =
            (0..).map(|k| ray.at + k as f32 * 1e-3).take_while(|at| *at < depth).flat_map(|at| ray.point(at)).collect();
        let mut values = vec![0.0; points.len() / 3];
        scene.values.values_into(&points, &mut values)?;
        assert!(values.iter().all(|value| *value > 0.0), "ray {index} went through the surface before {depth}");
        checked += values.len();
    }
    Ok(checked)
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().map_or_else(|| std::env::temp_dir().join("imp_march.png"), PathBuf::from);
    let frames: usize = arguments.next().map_or(Ok(24), |frames| frames.parse())?;
    let width: usize = arguments.next().map_or(Ok(128), |width| width.parse())?;
    let height = width * 3 / 4;

    let start = Instant::now();
    let mut scene = Scene::with_sliders()?;
    println!("compiled in {:.1?}", start.elapsed());
    let mut strip = image::RgbImage::new(6 * width as u32, height as u32);
    let (mut time, mut last, mut differing, mut checked) = (Duration::ZERO, None, 0, 0);
    let mut slopes = [f64::INFINITY, 0.0];
    for number in 0..frames {
        let start = Instant::now();
        scene.set(sliders(number))?;
        let frame = scene.draw(width, height)?;
        time += start.elapsed();
        slopes = [slopes[0].min(frame.slope), slopes[1].max(frame.slope)];
        if number % frames.div_ceil(6) == 0 {
            checked += check(&scene, &frame, width, height)?;
            let left = number / frames.div_ceil(6) * width;
            for (k, colour) in frame.colours.iter().enumerate() {
                strip.put_pixel((left + k % width) as u32, (k / width) as u32, image::Rgb(*colour));
            }
        }
        differing += usize::from(last.as_ref().is_none_or(|last| *last != frame));
        last = Some(frame);
    }
    let each = 1e3 * time.as_secs_f64() / frames as f64;
    println!(
        "{frames} frames of {width} by {height}: {each:.2} ms each, {:.0} a second; all from one compilation",
        1e3 / each
    );
    println!(
        "slope proved at most {:.2} to {:.2}; {differing} frames differ from the one before",
        slopes[0], slopes[1]
    );
    println!("no ray went through the surface ({checked} points tried)");
    assert!(slopes[1] < 20.0 && differing == frames);

    // The same with constants: what moving a slider costs where a formula cannot have parameters.
    let mut times = [Duration::ZERO; 3];
    let few = frames.min(6);
    for number in 0..few {
        let mut clock = Clock(Instant::now());
        let constant = Scene::with_constants(sliders(number))?;
        times[0] += clock.lap();
        let frame = constant.draw(width, height)?;
        times[1] += clock.lap();
        scene.set(sliders(number))?;
        let with_sliders = scene.draw(width, height)?;
        times[2] += clock.lap();
        let hits = |frame: &Frame| frame.depths.iter().filter(|depth| depth.is_finite()).count() as f64;
        assert!((hits(&frame) - hits(&with_sliders)).abs() <= 0.01 * hits(&frame) + 4.0, "the same picture");
    }
    let [compiling, drawing, sliding] = times.map(|time| 1e3 * time.as_secs_f64() / few as f64);
    println!("compiled again for each frame: {compiling:.2} ms to compile and {drawing:.2} ms to draw");
    println!("with sliders: {sliding:.2} ms, {:.1} times as fast", (compiling + drawing) / sliding);
    strip.save(&path)?;
    println!("wrote {}", path.display());
    Ok(())
}
