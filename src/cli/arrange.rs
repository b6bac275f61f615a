//! `imp arrange`: the arrangement of a scene's curves, in files and as a table.

use std::fmt::Write;
use std::path::Path;
use std::time::Duration;
use std::time::Instant;

use indicatif::ProgressBar;
use indicatif::ProgressDrawTarget;
use indicatif::ProgressStyle;

use crate::arrange;
use crate::arrange::Arrangement;
use crate::arrange::Fields;
use crate::arrange::certificate;
use crate::arrange::certificate::Certificate;
use crate::arrange::check;
use crate::arrange::check::Summary;
use crate::arrange::complex::VertexKind;
use crate::arrange::export;
use crate::arrange::export::Style;
use crate::arrange::export::Traced;
use crate::arrange::export::regions::Counts;
use crate::arrange::geometry;
use crate::arrange::published;
use crate::arrange::published::Limits;
use crate::cli::arguments::ArrangeArguments;
use crate::cli::arguments::DrawingArgument;
use crate::cli::arguments::DrawingFormat;
use crate::cli::arguments::MethodArgument;
use crate::cli::failure::Failure;
use crate::cli::files;
use crate::cli::text;
use crate::control::Control;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::interpret::Interpreter;
use crate::interval::Interval;
use crate::program::scene::Scene;
use crate::session;
use crate::session::Override;

/// Work that takes less time than this shows no progress.
const PATIENCE: Duration = Duration::from_millis(300);

/// Unresolved places that are listed before the rest is only counted.
const LISTED: usize = 10;

/// `imp arrange FILE`.
pub fn arrange(arguments: &ArrangeArguments) -> Result<(), Failure> {
    check_outputs(arguments)?;
    match arguments.threads {
        None => work(arguments),
        Some(count) => {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(count.into()).build();
            let failed = |error| Diagnostic::error(code::NO_THREADS, format!("cannot start {count} threads: {error}"));
            pool.map_err(failed)?.install(|| work(arguments))
        }
    }
}

fn work(arguments: &ArrangeArguments) -> Result<(), Failure> {
    let (artefact, scene) = text::scene(&arguments.file, &arguments.settings)?;
    let fail = |diagnostic| Failure::new(artefact.sources.clone(), vec![diagnostic]);
    if scene.dimension() != 2 {
        let name = arguments.file.display();
        let title = format!("`{name}` is a scene of surfaces, and an arrangement is one of curves in the plane");
        let help = format!("draw it with `imp render {name}`, or write curves in x and y and `domain [-2, 2]^2`");
        return Err(Diagnostic::error(code::BAD_OPTION, title).help(help).into());
    }
    let scene = if arguments.projective { arrange::projective(&scene).map_err(fail)? } else { scene };
    if arguments.method == MethodArgument::Published {
        return published(arguments, &Fields::new(&scene, session::backend()).map_err(fail)?);
    }
    let options =
        arrange::Options { epsilon: arguments.epsilon, exact: !arguments.no_exact, ..arrange::Options::default() };
    let (done, stopped) = files::interruptible(|cancel| {
        let arranged = watched(|progress| {
            arrange::arrange(&scene, &options, session::backend(), &Control::new(Some(progress), Some(cancel)))
        });
        deliver(arguments, &scene, &options, &arranged.map_err(fail)?)
    });
    done?;
    if stopped {
        files::leave_interrupted("stopped: what is not decided is left in clusters");
    }
    Ok(())
}

/// Prints the counts and writes the files.
fn deliver(
    arguments: &ArrangeArguments,
    scene: &Scene,
    options: &arrange::Options,
    arrangement: &Arrangement,
) -> Result<(), Failure> {
    let summary = Summary::new(arrangement, &check::check(arrangement).map_err(Diagnostic::from)?);
    if !arguments.outputs.is_empty() {
        write(arguments, arrangement, &summary, &Fields::new(scene, session::backend())?)?;
    }
    if let Some(path) = &arguments.certificate {
        let certificate = Certificate::new(scene, options, arrangement, &Interpreter)?;
        files::write(path, &certificate.to_bytes())?;
    }
    if arguments.json {
        // Numbers and fixed names always have a JSON form.
        files::print((serde_json::to_string(&summary).unwrap_or_default() + "\n").as_bytes())?;
    } else {
        files::print(table(&arguments.file, arrangement, &summary).as_bytes())?;
    }
    Ok(())
}

/// The algorithm as its source has it.
fn published(arguments: &ArrangeArguments, fields: &Fields) -> Result<(), Failure> {
    let other =
        arguments.outputs.iter().find(|output| matches!(output.format, DrawingFormat::Json | DrawingFormat::GeoJson));
    if arguments.certificate.is_some() || other.is_some() {
        let title =
            "the published algorithm makes pictures and a graph of regions, but no structure and no certificate";
        return Err(Diagnostic::error(code::BAD_OPTION, title).help("write SVG, PNG or DOT").into());
    }
    let limits = Limits { epsilon: arguments.epsilon.unwrap_or(Limits::default().epsilon), ..Limits::default() };
    let start = Instant::now();
    let (graph, stopped) = files::interruptible(|cancel| {
        watched(|progress| published::solve(fields, &limits, &Control::new(Some(progress), Some(cancel))))
    });
    let counts = Counts::new(&graph, 1e3 * start.elapsed().as_secs_f64());
    let style = Style { size: arguments.size, boxes: arguments.boxes };
    for DrawingArgument { path, format } in &arguments.outputs {
        let drawing = || export::regions::draw(&graph, &fields.curves, &style);
        let bytes = match format {
            DrawingFormat::Svg => export::svg::svg(&drawing()).into_bytes(),
            DrawingFormat::Png => export::png::png(&drawing())?,
            _ => export::regions::dot(&graph).into_bytes(),
        };
        files::write(path, &bytes)?;
    }
    let text = match arguments.json {
        // Numbers and fixed names always have a JSON form.
        true => serde_json::to_string(&counts).unwrap_or_default() + "\n",
        false => {
            let Counts { vertices, edges, faces, indeterminate, exact, delta, boxes, ms } = counts;
            let exact = if exact { "its claim of exactness applies" } else { "its claim of exactness does not apply" };
            format!(
                "{}: regions of the published algorithm: {vertices} vertices, {edges} edges, {faces} faces, {indeterminate} undecided\n  {exact}; delta {delta:.1e}\n  {boxes} boxes, {ms:.1} ms\n",
                arguments.file.display(),
            )
        }
    };
    files::print(text.as_bytes())?;
    if stopped {
        files::leave_interrupted("stopped: what was still open is left as it was");
    }
    Ok(())
}

/// `imp verify` for a certificate of an arrangement: everything is decided again with the reference interpreter alone.
pub fn verify(file: &Path, certificate: &[u8], settings: &[Override]) -> Result<(), Failure> {
    let (artefact, scene) = text::scene(file, settings)?;
    let certificate = Certificate::from_bytes(certificate)?;
    let report = watched(|progress| {
        certificate::verify(&scene, &certificate, &Interpreter, &Control::new(Some(progress), None))
    });
    let report = report.map_err(|diagnostic| Failure::new(artefact.sources, vec![diagnostic]))?;
    let certificate::Report { summary: Summary { vertices, edges, faces, proved, .. }, leaves, evaluations } = report;
    let count: u64 = export::kinds(&vertices).iter().map(|(_, count)| count).sum();
    let proved = if proved { "all proved" } else { "not all proved, as it says" };
    let text = format!(
        "verified: {count} vertices, {edges} edges, {faces} faces; {proved}; {leaves} boxes, {evaluations} evaluations\n"
    );
    files::print(text.as_bytes())
}

/// Arranging may take long enough to look first whether there is room for the results.
fn check_outputs(arguments: &ArrangeArguments) -> Result<(), Failure> {
    let drawings = arguments.outputs.iter().map(|output| output.path.as_path());
    let paths: Vec<&Path> = drawings.chain(arguments.certificate.as_deref()).collect();
    for (index, path) in paths.iter().enumerate() {
        if paths[..index].contains(path) {
            let title = format!("two outputs would go to `{}`", path.display());
            return Err(Diagnostic::error(code::BAD_OPTION, title).into());
        }
        files::check_folder(path)?;
    }
    Ok(())
}

fn write(
    arguments: &ArrangeArguments,
    arrangement: &Arrangement,
    summary: &Summary,
    fields: &Fields,
) -> Result<(), Failure> {
    let tolerance = arguments.tolerance.unwrap_or_else(|| geometry::half_pixel(&arrangement.domain));
    // A graph has no lines.
    let wants_lines = arguments.outputs.iter().any(|output| output.format != DrawingFormat::Dot);
    let lines: Vec<Vec<[f64; 2]>> = match wants_lines {
        true => geometry::polylines(arrangement, fields, tolerance).into_iter().map(|line| line.points).collect(),
        false => Vec::new(),
    };
    let wants_areas = arguments.outputs.iter().any(|output| output.format == DrawingFormat::Json);
    let areas = match wants_areas {
        true => geometry::areas(arrangement, fields, &geometry::Precision::default()),
        false => Vec::new(),
    };
    let traced = Traced { arrangement, summary, lines: &lines, areas: &areas };
    let style = Style { size: arguments.size, boxes: arguments.boxes };
    for DrawingArgument { path, format } in &arguments.outputs {
        let bytes = match format {
            DrawingFormat::Svg => export::svg::svg(&export::picture::draw(traced, &style)).into_bytes(),
            DrawingFormat::Png => export::png::png(&export::picture::draw(traced, &style))?,
            DrawingFormat::Json => export::json::json(traced)?.into_bytes(),
            DrawingFormat::GeoJson => export::geojson::geojson(traced).into_bytes(),
            DrawingFormat::Dot if arguments.dual => export::dot::dual(traced).into_bytes(),
            DrawingFormat::Dot => export::dot::graph(traced).into_bytes(),
        };
        files::write(path, &bytes)?;
    }
    Ok(())
}

/// What there is of what, how much of it is proved, and where it is not.
fn table(path: &Path, arrangement: &Arrangement, summary: &Summary) -> String {
    let Summary { vertices, edges, faces, proved, boxes, ms } = summary;
    let rows = export::kinds(vertices);
    let total: u64 = rows.iter().map(|(_, count)| count).sum();
    let open: Vec<_> = arrangement.vertices.iter().filter(|vertex| !vertex.vertex.proved).collect();
    let said = match (proved, open.len()) {
        (true, _) => "all proved".to_owned(),
        (false, 0) => "not all proved".to_owned(),
        (false, 1) => "1 vertex is not proved".to_owned(),
        (false, count) => format!("{count} vertices are not proved"),
    };
    let name = path.display();
    let mut text = format!("{name}: {total} vertices, {edges} edges, {faces} faces; {said}\n");
    for (kind, count) in rows.into_iter().filter(|(_, count)| *count > 0) {
        let of_kind = open.iter().filter(|vertex| vertex.vertex.kind == kind).count();
        let note =
            if of_kind > 0 && kind != VertexKind::Cluster { format!(", {of_kind} not proved") } else { String::new() };
        push(&mut text, format!("  {:<9} {count:>7}{note}", export::kind(kind)));
    }
    for vertex in open.iter().take(LISTED) {
        let [x, y] = vertex.vertex.area.map(Interval::mid);
        let [width, height] = vertex.vertex.area.map(Interval::width);
        let curves: Vec<&str> =
            vertex.vertex.curves.iter().map(|&curve| arrangement.curves[usize::from(curve)].as_str()).collect();
        let note = vertex.vertex.note.as_ref().map_or(String::new(), |note| format!(": {note}"));
        let (kind, curves) = (export::kind(vertex.vertex.kind), curves.join(", "));
        push(&mut text, format!("  {kind} of {curves} near ({x:.9}, {y:.9}), {width:.1e} by {height:.1e}{note}"));
    }
    if open.len() > LISTED {
        push(&mut text, format!("  and {} more that are not proved", open.len() - LISTED));
    }
    push(&mut text, format!("  {boxes} boxes, {ms:.1} ms"));
    text
}

fn push(text: &mut String, line: String) {
    writeln!(text, "{line}").expect("a string takes all text");
}

/// Does work under a progress bar on stderr if that is a terminal; elsewhere nothing is drawn.
fn watched<T>(work: impl FnOnce(&(dyn Fn(usize, usize) + Sync)) -> T) -> T {
    let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
    let style = ProgressStyle::with_template("{wide_bar} {pos}/{len} boxes");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    let start = Instant::now();
    let watch = |done: usize, total: usize| {
        if start.elapsed() > PATIENCE {
            bar.set_length(total as u64);
            bar.set_position(done as u64);
        }
    };
    let result = work(&watch);
    bar.finish_and_clear();
    result
}
