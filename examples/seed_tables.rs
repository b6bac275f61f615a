//! Prints three tables of the literature beside what Imp's own implementations of the same methods measure, as Markdown;
//! `docs/measurements/seeds.md` holds a run with remarks.
//!
//!     cargo run --release --example seed_tables            # all of them
//!     cargo run --release --example seed_tables -- newton  # one: `march`, `affine` or `newton`
//!
//! Everything runs on one thread; a time is the least of three runs. On Linux it is the processor's time of the threads
//! that search, which a busy machine disturbs least; elsewhere it is the clock's. Evaluations are exact counts.

use std::error::Error;
use std::path::Path;

use imp::accuracy::finder::Evaluations;
use imp::accuracy::finder::Finder;
use imp::accuracy::finder::Sampled;
use imp::accuracy::finder::Settings;
use imp::accuracy::finder::sample;
use imp::derive::Arithmetic;
use imp::derive::Precision;
use imp::derive::Rounding;
use imp::diagnostic::Diagnostic;
use imp::program::Scene;
use imp::render::Control;
use imp::render::Layers;
use imp::render::Options;
use imp::render::Picture;
use imp::render::Ray;
use imp::render::Renderer;
use imp::render::Stop;
use imp::session;

const REPEATS: u32 = 3;

fn main() -> Result<(), Box<dyn Error>> {
    let wanted = std::env::args().nth(1);
    let is_wanted = |name: &str| wanted.as_deref().is_none_or(|wanted| wanted == name);
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global()?;
    if is_wanted("march") {
        march()?;
    }
    if is_wanted("affine") {
        affine()?;
    }
    if is_wanted("newton") {
        newton()?;
    }
    Ok(())
}

/// A scene with the rays of a picture of it.
struct Subject {
    scene: Scene,
    rays: Vec<Option<Ray>>,
    side: u32,
}

impl Subject {
    fn new(name: &str, side: u32) -> Result<Self, Box<dyn Error>> {
        let artefact = session::compile(session::Source::File(&Path::new("examples").join(format!("{name}.imp"))), &[]);
        let messages = || imp::diagnostic::render(&artefact.sources, &artefact.diagnostics, false);
        let scene = artefact.scene.clone().ok_or_else(messages)?;
        let renderer = renderer(&scene, side, 1e-3)?;
        let rays = (0..side).flat_map(|y| (0..side).map(move |x| (x, y)));
        let rays = rays.map(|(x, y)| renderer.ray(x, y)).collect();
        Ok(Self { scene, rays, side })
    }

    /// The longest side of the domain.
    fn extent(&self) -> f64 {
        self.scene.domain.iter().map(|range| range.width()).fold(0.0, f64::max)
    }

    fn sample(&self, settings: Settings) -> Result<Sampled, Box<dyn Error>> {
        let ray = |x: u32, y: u32| self.rays[(y * self.side + x) as usize];
        let mut best: Option<Sampled> = None;
        for _ in 0..REPEATS {
            let before = busy();
            let size = (self.side, self.side);
            let mut next = sample(&self.scene, &ray, size, &settings, session::backend()).map_err(title)?;
            if let (Some(before), Some(after)) = (before, busy()) {
                next.seconds = after - before;
            }
            if best.as_ref().is_none_or(|best| next.seconds < best.seconds) {
                best = Some(next);
            }
        }
        best.ok_or_else(|| "nothing was run".into())
    }

    /// A picture by Imp's own engine, of which nothing but the depth is asked, with its time in seconds.
    fn engine(&self, epsilon: f64) -> Result<(Picture, f64), Box<dyn Error>> {
        let renderer = renderer(&self.scene, self.side, epsilon)?;
        let mut best: Option<(Picture, f64)> = None;
        for _ in 0..REPEATS {
            let before = busy();
            let picture = renderer.render(&self.scene.parameters, &Control::default()).map_err(title)?;
            let seconds = match (before, busy()) {
                (Some(before), Some(after)) => after - before,
                _ => picture.stats.render_ms / 1e3,
            };
            if best.as_ref().is_none_or(|&(_, best)| seconds < best) {
                best = Some((picture, seconds));
            }
        }
        best.ok_or_else(|| "nothing was run".into())
    }

    fn pixels(&self) -> f64 {
        f64::from(self.side) * f64::from(self.side)
    }
}

fn renderer(scene: &Scene, side: u32, epsilon: f64) -> Result<Renderer, Box<dyn Error>> {
    let options = Options {
        width: side,
        height: side,
        stop: Stop::Epsilon(epsilon),
        threads: Some(1),
        layers: Layers { color: false, depth: true, normal: false, certainty: false },
        ..Options::default()
    };
    Ok(Renderer::new(scene, &options, session::backend()).map_err(title)?)
}

/// Processor time of all threads but the main one so far, in seconds: kernels are compiled and proofs made by the main
/// thread, and what is measured runs in others. `None` where the system does not say.
fn busy() -> Option<f64> {
    let main = std::process::id().to_string();
    let mut total = 0.0;
    for task in std::fs::read_dir("/proc/self/task").ok()? {
        let task = task.ok()?;
        if *task.file_name() == *main {
            continue;
        }
        let times = std::fs::read_to_string(task.path().join("schedstat")).ok()?;
        total += times.split(' ').next()?.parse::<f64>().ok()? / 1e9;
    }
    Some(total)
}

fn title(diagnostic: Diagnostic) -> String {
    diagnostic.title
}

fn hits(sampled: &Sampled) -> usize {
    sampled.depth.iter().flatten().count()
}

fn proved(sampled: &Sampled) -> usize {
    sampled.proved.iter().filter(|&&proved| proved).count()
}

/// Evaluations a pixel: of the field over intervals, of its slope, of the field at points.
fn by_kind(sampled: &Sampled, pixels: f64) -> String {
    let Evaluations { fields, slopes, points } = sampled.by_kind;
    let [fields, slopes, points] = [fields, slopes, points].map(|count| count as f64 / pixels);
    format!("{fields:.1}, {slopes:.1}, {points:.1}")
}

/// All evaluations of a picture by Imp's own engine.
fn evaluations(picture: &Picture) -> u64 {
    let e = picture.stats.evaluations;
    e.beam + e.slope + e.root + e.ends + e.piece + e.face
}

/// Knoll et al. 2007, table 1, which is Hijazi 2008, table 6.1: frames per second at 512x512.
fn march() -> Result<(), Box<dyn Error>> {
    const SIDE: u32 = 512;
    const FINDERS: [Finder; 5] =
        [Finder::KMarch, Finder::TMarch, Finder::PacketMitchell, Finder::Mitchell, Finder::Bisection];
    // By function and depth: K-march, t-march, Mitchell in 2x2 packets.
    const THEIRS: [(&str, u32, [f64; 3]); 4] = [
        ("trilinear", 10, [10.6, 9.9, 1.20]),
        ("trilinear", 22, [2.8, 0.31, 0.75]),
        ("mitchell", 10, [5.9, 5.7, 0.61]),
        ("mitchell", 22, [1.3, 1.0, 0.24]),
    ];
    println!("## K-march, t-march, Mitchell (Knoll et al. 2007, table 1)\n");
    println!(
        "| function | d | method | their time / K | f32 nearest: time / K | F, F', points a pixel | hits | f64 outward: time / K | F, F', points a pixel | hits | proved |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    for (name, depth, fps) in THEIRS {
        let subject = Subject::new(name, SIDE)?;
        let epsilon = subject.extent() * (-f64::from(depth)).exp2();
        let mut first: Option<[f64; 2]> = None;
        for (index, finder) in FINDERS.into_iter().enumerate() {
            let settings = Settings {
                finder,
                precision: Precision::Single,
                rounding: Rounding::Nearest,
                arithmetic: Arithmetic::Interval,
                epsilon,
            };
            let nearest = subject.sample(settings)?;
            let outward =
                subject.sample(Settings { precision: Precision::Double, rounding: Rounding::Outward, ..settings })?;
            let [single, double] = *first.get_or_insert([nearest.seconds, outward.seconds]);
            let theirs = fps.get(index).map_or("".to_owned(), |own| format!("{:.2}", fps[0] / own));
            println!(
                "| {name} | {depth} | {} | {theirs} | {:.2} | {} | {} | {:.2} | {} | {} | {} |",
                finder.name(),
                nearest.seconds / single,
                by_kind(&nearest, subject.pixels()),
                hits(&nearest),
                outward.seconds / double,
                by_kind(&outward, subject.pixels()),
                hits(&outward),
                proved(&outward),
            );
        }
        let (picture, seconds) = subject.engine(epsilon)?;
        let [single, double] = first.unwrap_or_default().map(|first| seconds / first);
        println!(
            "| {name} | {depth} | Imp | | {single:.3} | | | {double:.3} | {:.1} | {} | {} |",
            evaluations(&picture) as f64 / subject.pixels(),
            picture.stats.hits,
            picture.stats.proved
        );
    }
    println!();
    Ok(())
}

/// Hijazi 2008, table 7.1: frames per second at 1024x1024, by bisection of t to 2^-11.
fn affine() -> Result<(), Box<dyn Error>> {
    const SIDE: u32 = 256;
    const EPSILON: f64 = 1.0 / 2048.0;
    // Interval and reduced affine arithmetic; none where they had no affine form.
    const THEIRS: [(&str, Option<[f64; 2]>); 16] = [
        ("sphere", Some([75.0, 147.0])),
        ("steiner_1", Some([34.0, 40.0])),
        ("mitchell", Some([16.0, 58.0])),
        ("teardrop", Some([102.0, 115.0])),
        ("bretzel_4", Some([78.0, 48.0])),
        ("klein_bottle", Some([30.0, 110.0])),
        ("tangle", Some([15.0, 68.0])),
        ("decocube", Some([28.0, 27.0])),
        ("barth_sextic", Some([31.0, 76.0])),
        ("barth_decic", Some([4.9, 15.6])),
        ("superquadric_200", Some([119.0, 8.3])),
        ("icosahedron_csg", None),
        ("superquadric_csg", None),
        ("sinusoid_blob", None),
        ("cloth", None),
        ("water", None),
    ];
    println!("## Interval against affine arithmetic (Hijazi 2008, table 7.1)\n");
    println!(
        "| function | their RAA / IA | IA: evaluations a pixel | AF1: evaluations a pixel | IA / AF1 evaluations | nearest: speed AF1 / IA | outward: speed AF1 / IA | outward IA: ms | Imp: ms | speed Imp / IA | hits IA | hits AF1 | hits Imp |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    for (name, fps) in THEIRS {
        let subject = Subject::new(name, SIDE)?;
        let measure = |arithmetic, rounding| {
            let finder = Finder::Bisection;
            let precision = Precision::Single;
            subject.sample(Settings { finder, precision, rounding, arithmetic, epsilon: EPSILON })
        };
        let [ia, raa] =
            [measure(Arithmetic::Interval, Rounding::Nearest)?, measure(Arithmetic::Affine, Rounding::Nearest)?];
        let [ia_out, raa_out] =
            [measure(Arithmetic::Interval, Rounding::Outward)?, measure(Arithmetic::Affine, Rounding::Outward)?];
        let (picture, seconds) = subject.engine(EPSILON)?;
        let theirs = fps.map_or("".to_owned(), |[ia, raa]| format!("{:.2}", raa / ia));
        println!(
            "| {name} | {theirs} | {:.1} | {:.1} | {:.2} | {:.2} | {:.2} | {:.1} | {:.1} | {:.1} | {} | {} | {} |",
            ia.evaluations as f64 / subject.pixels(),
            raa.evaluations as f64 / subject.pixels(),
            ia.evaluations as f64 / raa.evaluations as f64,
            ia.seconds / raa.seconds,
            ia_out.seconds / raa_out.seconds,
            1e3 * ia_out.seconds,
            1e3 * seconds,
            ia_out.seconds / seconds,
            hits(&ia),
            hits(&raa),
            picture.stats.hits,
        );
    }
    println!();
    Ok(())
}

/// Flórez 2008, table 4.1: seconds at 300x300.
fn newton() -> Result<(), Box<dyn Error>> {
    const SIDE: u32 = 300;
    const FINDERS: [Finder; 5] =
        [Finder::Mitchell, Finder::IntervalNewton, Finder::AlefeldHansen, Finder::MrfRo, Finder::MrfNewton];
    const THEIRS: [(&str, [f64; 5]); 8] = [
        ("sphere", [20.0, 28.0, 27.0, 48.0, 55.0]),
        ("teardrop", [36.0, 47.0, 46.0, 103.0, 96.0]),
        ("chubs", [98.0, 94.0, 92.0, 188.0, 174.0]),
        ("crosscap", [80.0, 96.0, 99.0, 105.0, 151.0]),
        ("gumdrop_torus", [240.0, 260.0, 202.0, 541.0, 380.0]),
        ("horned_cube", [99.0, 180.0, 166.0, 272.0, 283.0]),
        ("mcmullen_k3", [102.0, 123.0, 110.0, 276.0, 221.0]),
        ("kusner_schmitt", [75.0, 94.0, 86.0, 210.0, 173.0]),
    ];
    for epsilon in [1e-3, 1e-7, 1e-12] {
        println!("## Root finders with derivatives (Flórez 2008, table 4.1), epsilon {epsilon:e}\n");
        println!(
            "| surface | method | their time / Mitchell | time / Mitchell | evaluations a pixel: F, F', points | all / Mitchell | hits | proved |"
        );
        println!("|---|---|---|---|---|---|---|---|");
        for (name, theirs) in THEIRS {
            let subject = Subject::new(name, SIDE)?;
            let mut first: Option<(f64, u64)> = None;
            for (finder, seconds) in FINDERS.into_iter().zip(theirs) {
                let sampled = subject.sample(Settings {
                    finder,
                    precision: Precision::Double,
                    rounding: Rounding::Outward,
                    arithmetic: Arithmetic::Interval,
                    epsilon,
                })?;
                let (time, count) = *first.get_or_insert((sampled.seconds, sampled.evaluations));
                println!(
                    "| {name} | {} | {:.2} | {:.2} | {} | {:.2} | {} | {} |",
                    finder.name(),
                    seconds / theirs[0],
                    sampled.seconds / time,
                    by_kind(&sampled, subject.pixels()),
                    sampled.evaluations as f64 / count as f64,
                    hits(&sampled),
                    proved(&sampled),
                );
            }
        }
        println!();
    }
    Ok(())
}
