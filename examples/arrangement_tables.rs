//! Prints the source's table of running times of CAPS beside what Imp measures, for the algorithm as published and for the
//! certified one, and how both grow, as Markdown; `docs/measurements/arrangements.md` holds a run with remarks.
//!
//!     cargo run --release --example arrangement_tables             # all of them
//!     cargo run --release --example arrangement_tables -- classes  # one: `classes`, `lines`, `cubics`, `epsilon`, `close`
//!
//! Times are of the clock, one run, all processors, from the compiled scene to the graph, compilation to machine code
//! included. Sizes are exact counts and do not depend on the machine, but for runs that were stopped for their time.

use std::error::Error;
use std::fmt::Write;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering;
use std::sync::mpsc;
use std::thread;
use std::time::Duration;
use std::time::Instant;

use imp::arrange;
use imp::arrange::check;
use imp::arrange::check::Counts;
use imp::arrange::field::Fields;
use imp::arrange::published;
use imp::arrange::published::Graph;
use imp::arrange::published::Limits;
use imp::arrange::published::RegionKind;
use imp::control::Control;
use imp::diagnostic::Diagnostic;
use imp::program::Scene;
use imp::session;

/// Classes of the source's table 4.1 with its tree sizes and seconds (C++, Xeon 3.6 GHz).
const CLASSES: [(&str, &str, u64, f64); 7] = [
    ("Lines (5)", "class_lines", 12097, 0.8),
    ("Algebraic curves (5)", "class_algebraic", 32875, 1.3),
    ("Degenerate (7 lines)", "class_degenerate_lines", 19546, 1.9),
    ("Degenerate (5 polynomials)", "class_degenerate_polynomials", 251440, 2.8),
    ("Trigonometric functions (3)", "class_trigonometric", 12271, 0.2),
    ("Inverse Sine (2)", "class_inverse_sine", 20800, 12.6),
    ("Arbitrary curves (10)", "class_arbitrary", 78736, 7.5),
];

/// The source's choice.
const EPSILON: f64 = 1e-6;

/// Side of the domain in all of these.
const SIDE: f64 = 20.0;

/// A run that takes longer is stopped, and what it has then is reported.
const PATIENCE: Duration = Duration::from_secs(60);

/// Room for the tree of the published algorithm.
const NODES: u64 = 1 << 23;

const SEED: u64 = 2007;

fn main() -> Result<(), Box<dyn Error>> {
    let wanted = std::env::args().nth(1);
    let is_wanted = |name: &str| wanted.as_deref().is_none_or(|wanted| wanted == name);
    if is_wanted("classes") {
        classes()?;
    }
    if is_wanted("lines") {
        growth("Random lines", &random_lines, 1)?;
    }
    if is_wanted("cubics") {
        growth("Random cubics", &random_cubics, 3)?;
    }
    if is_wanted("epsilon") {
        by_epsilon()?;
    }
    if is_wanted("close") {
        close()?;
    }
    Ok(())
}

fn classes() -> Result<(), Box<dyn Error>> {
    println!("## The classes of table 4.1\n");
    let mut counts = Table::new(
        "class | crossed | undecided | several | discontinuous | vertices \
         | edges | indeterminate | no curve | adjacencies | exact",
    );
    let mut table = Table::new(
        "class | source: tree | s | published: tree | evaluations | s \
         | certified: boxes | evaluations | s | V | E | F | proved",
    );
    let mut vertices = Table::new("class | crossing | tangency | singular | end | boundary | loop | cluster");
    for (class, file, size, seconds) in CLASSES {
        let scene = scene_of(session::Source::File(&Path::new("examples/arrangements").join(format!("{file}.imp"))))?;
        let run = published(&scene, EPSILON)?;
        let graph = &run.graph;
        let certified = certified(&scene, EPSILON)?;
        let mut cells = vec![
            class.into(),
            size.to_string(),
            seconds.to_string(),
            run.size(),
            graph.evaluations.to_string(),
            run.time(),
        ];
        cells.extend(certified.size_and_time());
        cells.extend(certified.result());
        table.row(&cells);
        let mut cells = vec![class.into()];
        cells.extend(certified.kinds().map(|kind| kind.to_string()));
        vertices.row(&cells);
        let kind = |kind| graph.count(kind).to_string();
        counts.row(&[
            class.into(),
            graph.counts.crossed.to_string(),
            graph.counts.undecided.to_string(),
            graph.counts.several.to_string(),
            graph.discontinuous.to_string(),
            kind(RegionKind::Vertex),
            kind(RegionKind::Edge),
            kind(RegionKind::Indeterminate),
            kind(RegionKind::Face),
            graph.adjacent.len().to_string(),
            yes(graph.exact()),
        ]);
    }
    table.print();
    println!("Vertices of the certified algorithm:\n");
    vertices.print();
    println!("Leaves and regions of the published algorithm:\n");
    counts.print();
    Ok(())
}

/// How both algorithms grow with the number of curves of a degree.
fn growth(title: &str, make: &dyn Fn(usize) -> String, degree: usize) -> Result<(), Box<dyn Error>> {
    println!("## {title}\n");
    let mut table = Table::new(
        "n | published: tree | tree / (K log2(L/eps)) | vertices | edges | s \
         | certified: boxes | evaluations | s | boxes / K | V | E | F | proved",
    );
    let mut patient = true;
    for n in [10, 20, 50, 100, 200, 500, 1000] {
        let scene = scene_of(session::Source::Text { name: title, text: &make(n) })?;
        let run = published(&scene, EPSILON)?;
        // The source sums over all ordered pairs.
        let bezout = (n * (n - 1) * degree * degree) as f64;
        let bound = bezout * (SIDE / EPSILON).log2();
        let mut cells = vec![
            n.to_string(),
            run.size(),
            if run.graph.complete { format!("{:.2}", run.graph.nodes as f64 / bound) } else { "-".into() },
            run.graph.count(RegionKind::Vertex).to_string(),
            run.graph.count(RegionKind::Edge).to_string(),
            run.time(),
        ];
        // What was stopped for its time is not tried with more.
        if patient {
            let certified = certified(&scene, EPSILON)?;
            patient = !certified.stopped;
            cells.extend(certified.size_and_time());
            cells.push(format!("{:.2}", certified.boxes as f64 / bezout));
            cells.extend(certified.result());
        } else {
            cells.extend(["-"; 8].map(String::from));
        }
        table.row(&cells);
    }
    table.print();
    Ok(())
}

/// How both depend on epsilon.
fn by_epsilon() -> Result<(), Box<dyn Error>> {
    println!("## Twenty lines, twenty cubics, and epsilon\n");
    let mut table = Table::new(
        "epsilon | log2(L/eps) | lines, published: tree | s | certified: boxes | s | clusters \
         | cubics, published: tree | s | certified: boxes | s | clusters",
    );
    let lines = scene_of(session::Source::Text { name: "lines", text: &random_lines(20) })?;
    let cubics = scene_of(session::Source::Text { name: "cubics", text: &random_cubics(20) })?;
    for exponent in [1, 2, 3, 4, 6, 8, 10] {
        let epsilon = 10f64.powi(-exponent);
        let mut cells = vec![format!("1e-{exponent}"), format!("{:.1}", (SIDE / epsilon).log2())];
        for scene in [&lines, &cubics] {
            let run = published(scene, epsilon)?;
            let certified = certified(scene, epsilon)?;
            cells.extend([run.size(), run.time(), certified.boxes.to_string(), certified.time()]);
            cells.push(certified.counts.vertices.cluster.to_string());
        }
        table.row(&cells);
    }
    table.print();
    Ok(())
}

/// The worst case: lines that are close all along, or for long.
fn close() -> Result<(), Box<dyn Error>> {
    /// Above the gaps of the last rows, so that it ends the descent there.
    const EPSILON: f64 = 1e-4;
    println!("## Two close lines, epsilon 1e-4\n");
    let mut table = Table::new(
        "k | parallel, published: tree | vertices | s | certified: boxes | crossings | proved | s \
         | angle, published: tree | vertices | s | certified: boxes | crossings | proved | s",
    );
    for k in (2..=24).step_by(2) {
        let gap = 2f64.powi(-k);
        // 3, 4 and 5 make the distance that of the constants; an angle of 2^-k turns the slope by as much.
        let parallel = format!("curve a: 3x + 4y = 1.3\ncurve b: 3x + 4y = 1.3 + 5 * {gap:?}\ndomain [-10, 10]^2\n");
        let angle = format!("curve a: 3x + 4y = 1.3\ncurve b: 3x + 4y = 1.3 + {gap:?}(4x - 3y)\ndomain [-10, 10]^2\n");
        let mut cells = vec![k.to_string()];
        for text in [&parallel, &angle] {
            let scene = scene_of(session::Source::Text { name: "close", text })?;
            let run = published(&scene, EPSILON)?;
            let certified = certified(&scene, EPSILON)?;
            cells.extend([run.size(), run.graph.count(RegionKind::Vertex).to_string(), run.time()]);
            cells.extend([certified.boxes.to_string(), certified.counts.vertices.crossing.to_string()]);
            cells.extend([yes(certified.counts.proved), certified.time()]);
        }
        table.row(&cells);
    }
    table.print();
    Ok(())
}

/// Lines as in the source's analysis: a point of the box and an angle, both uniform.
fn random_lines(n: usize) -> String {
    let mut random = fastrand::Rng::with_seed(SEED);
    let mut text = String::from("domain [-10, 10]^2\n");
    for i in 0..n {
        let [x, y] = point(&mut random);
        let (sin, cos) = (random.f64() * std::f64::consts::TAU).sin_cos();
        let _ = writeln!(text, "curve c{i}: ({sin:.6})x + ({:.6})y = {:.6}", -cos, sin * x - cos * y);
    }
    text
}

/// Cubics whose coefficients are uniform when the box is scaled to [-1, 1]^2, but for the constant, which makes the curve pass
/// through a point of the box.
fn random_cubics(n: usize) -> String {
    let mut random = fastrand::Rng::with_seed(SEED);
    let mut text = String::from("let u = x / 10\nlet v = y / 10\ndomain [-10, 10]^2\n");
    for i in 0..n {
        let [x, y] = point(&mut random).map(|coordinate| coordinate / 10.0);
        let mut constant = 0.0;
        let _ = write!(text, "curve c{i}: ");
        for (a, b) in [(3, 0), (2, 1), (1, 2), (0, 3), (2, 0), (1, 1), (0, 2), (1, 0), (0, 1)] {
            let coefficient = 2.0 * random.f64() - 1.0;
            constant -= coefficient * x.powi(a) * y.powi(b);
            let _ = write!(text, "({coefficient:.6})");
            for (name, exponent) in [("u", a), ("v", b)] {
                let _ = match exponent {
                    0 => Ok(()),
                    1 => write!(text, "*{name}"),
                    _ => write!(text, "*{name}^{exponent}"),
                };
            }
            text.push_str(" + ");
        }
        let _ = writeln!(text, "({constant:.6}) = 0");
    }
    text
}

fn point(random: &mut fastrand::Rng) -> [f64; 2] {
    [0, 1].map(|_| SIDE * random.f64() - SIDE / 2.0)
}

fn scene_of(source: session::Source) -> Result<Scene, Box<dyn Error>> {
    let artefact = session::compile(source, &[]);
    let messages = || imp::diagnostic::render(&artefact.sources, &artefact.diagnostics, false);
    Ok(artefact.scene.clone().ok_or_else(messages)?)
}

/// A run of the published algorithm.
struct Published {
    graph: Graph,
    seconds: f64,
    stopped: bool,
}

impl Published {
    fn size(&self) -> String {
        let size = self.graph.nodes;
        if self.graph.complete { size.to_string() } else { format!("{size} (cut at {:.1e})", self.graph.terminal) }
    }

    fn time(&self) -> String {
        seconds(self.seconds, self.stopped)
    }
}

fn published(scene: &Scene, epsilon: f64) -> Result<Published, Box<dyn Error>> {
    let start = Instant::now();
    let fields = Fields::new(scene, session::backend()).map_err(title)?;
    let limits = Limits { epsilon, nodes: NODES, ..Limits::default() };
    let (graph, stopped) = patiently(|control| published::solve(&fields, &limits, control));
    Ok(Published { graph, seconds: start.elapsed().as_secs_f64(), stopped })
}

/// A run of the certified algorithm.
struct Certified {
    counts: Counts,
    boxes: u64,
    evaluations: u64,
    seconds: f64,
    stopped: bool,
}

impl Certified {
    fn size_and_time(&self) -> [String; 3] {
        [self.boxes.to_string(), self.evaluations.to_string(), self.time()]
    }

    fn result(&self) -> [String; 4] {
        let vertices: u64 = self.kinds().iter().sum();
        [vertices.to_string(), self.counts.edges.to_string(), self.counts.faces.to_string(), yes(self.counts.proved)]
    }

    fn kinds(&self) -> [u64; 7] {
        let kinds = &self.counts.vertices;
        [kinds.crossing, kinds.tangency, kinds.singular, kinds.end, kinds.boundary, kinds.closed, kinds.cluster]
    }

    fn time(&self) -> String {
        seconds(self.seconds, self.stopped)
    }
}

fn certified(scene: &Scene, epsilon: f64) -> Result<Certified, Box<dyn Error>> {
    let start = Instant::now();
    let options = arrange::Options { epsilon: Some(epsilon), ..arrange::Options::default() };
    let (arrangement, stopped) = patiently(|control| arrange::arrange(scene, &options, session::backend(), control));
    let arrangement = arrangement.map_err(title)?;
    let seconds = start.elapsed().as_secs_f64();
    let counts = check::check(&arrangement)?;
    let effort = arrangement.complex.effort;
    Ok(Certified { counts, boxes: effort.boxes, evaluations: effort.evaluations, seconds, stopped })
}

/// Runs work that is cancelled when it takes too long, and says whether it was.
fn patiently<T>(work: impl FnOnce(&Control) -> T) -> (T, bool) {
    let cancel = AtomicBool::new(false);
    let (done, wait) = mpsc::channel::<()>();
    let flag = &cancel;
    let result = thread::scope(|scope| {
        scope.spawn(move || {
            if wait.recv_timeout(PATIENCE) == Err(mpsc::RecvTimeoutError::Timeout) {
                flag.store(true, Ordering::Relaxed);
            }
        });
        let result = work(&Control::new(None, Some(flag)));
        drop(done);
        result
    });
    (result, cancel.load(Ordering::Relaxed))
}

fn seconds(seconds: f64, stopped: bool) -> String {
    let mark = if stopped { " (stopped)" } else { "" };
    if seconds < 0.1 { format!("{seconds:.3}{mark}") } else { format!("{seconds:.1}{mark}") }
}

fn yes(answer: bool) -> String {
    if answer { "yes" } else { "no" }.into()
}

fn title(diagnostic: Diagnostic) -> String {
    diagnostic.title
}

/// A Markdown table, printed row by row so that a long run shows how far it is.
struct Table {
    rows: Vec<String>,
}

impl Table {
    /// The heads of the columns, with bars between.
    fn new(heads: &str) -> Self {
        let heads: Vec<&str> = heads.split(" | ").collect();
        let rule = vec!["---"; heads.len()];
        Self { rows: vec![line(&heads), line(&rule)] }
    }

    fn row(&mut self, cells: &[String]) {
        let cells: Vec<&str> = cells.iter().map(String::as_str).collect();
        eprintln!("{}", line(&cells));
        self.rows.push(line(&cells));
    }

    fn print(&self) {
        println!("{}\n", self.rows.join("\n"));
    }
}

fn line(cells: &[&str]) -> String {
    format!("| {} |", cells.join(" | "))
}
