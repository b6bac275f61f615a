//! `imp cost`: measures, prints the table and writes the files.

use std::path::Path;

use indicatif::ProgressBar;
use indicatif::ProgressDrawTarget;
use indicatif::ProgressStyle;

use crate::accuracy;
use crate::accuracy::Progress;
use crate::accuracy::Request;
use crate::accuracy::Subject;
use crate::accuracy::report;
use crate::accuracy::report::Report;
use crate::cli::arguments::CostArguments;
use crate::cli::arguments::ReportArgument;
use crate::cli::arguments::ReportFormat;
use crate::cli::eval;
use crate::cli::failure::Failure;
use crate::cli::files;
use crate::cli::text;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::session;
use crate::session::expression::Reading;
use crate::session::expression::Snippet;
use crate::session::expression::Workspace;

/// `imp cost FILE` or `imp cost EXPR NAME=VALUE...`.
pub fn cost(arguments: &CostArguments) -> Result<(), Failure> {
    check_outputs(&arguments.outputs)?;
    let path = Path::new(&arguments.subject);
    let is_scene = path.exists() || path.extension().is_some_and(|ending| ending == "imp");
    let work = || if is_scene { of_scene(path, arguments) } else { of_expression(arguments) };
    match arguments.threads {
        None => work(),
        Some(count) => {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(count.into()).build();
            let failed = |error| Diagnostic::error(code::NO_THREADS, format!("cannot start {count} threads: {error}"));
            pool.map_err(failed)?.install(work)
        }
    }
}

fn of_scene(path: &Path, arguments: &CostArguments) -> Result<(), Failure> {
    if let Some(value) = arguments.values.first() {
        let title = format!("`{value}` stands behind a scene, whose parameters are set in another way");
        return Err(Diagnostic::error(code::BAD_OPTION, title).help(format!("write `--set {value}`")).into());
    }
    let (artefact, scene) = text::scene(path, &arguments.settings)?;
    let request = Request { size: arguments.size, repeats: arguments.repeat, selection: arguments.levels.into() };
    let name = path.display().to_string();
    let cost = watched(|progress| accuracy::of_scene(&name, &scene, request, session::backend(), progress))
        .map_err(|diagnostic| Failure::new(artefact.sources, vec![diagnostic]))?;
    deliver(&cost, &arguments.outputs)
}

fn of_expression(arguments: &CostArguments) -> Result<(), Failure> {
    let workspace = Workspace::default();
    let given = eval::values(&workspace, &arguments.values)?;
    let names: Vec<&str> = given.keys().map(String::as_str).collect();
    let expression = workspace.expression(&Snippet::whole("EXPR", &arguments.subject), &names, Reading::Value)?;
    let inputs = expression.boxes(&given);
    let (graph, root) = (&*expression.graph, expression.root);
    let subject = Subject { text: &arguments.subject, graph, root, inputs: &inputs };
    let cost = watched(|progress| accuracy::of_expression(subject, arguments.repeat, session::backend(), progress));
    deliver(&cost, &arguments.outputs)
}

/// Measuring takes long enough to look first whether there is room for the results.
fn check_outputs(outputs: &[ReportArgument]) -> Result<(), Failure> {
    for (index, ReportArgument { path, .. }) in outputs.iter().enumerate() {
        if outputs[..index].iter().any(|other| other.path == *path) {
            let title = format!("two outputs would go to `{}`", path.display());
            return Err(Diagnostic::error(code::BAD_OPTION, title).into());
        }
        files::check_folder(path)?;
    }
    Ok(())
}

/// Prints the table and writes the files.
fn deliver(cost: &impl Report, outputs: &[ReportArgument]) -> Result<(), Failure> {
    files::print(report::text(cost).as_bytes())?;
    for ReportArgument { path, format } in outputs {
        let bytes = match format {
            ReportFormat::Html => cost.html()?.into_bytes(),
            ReportFormat::Svg => report::svg(cost)?.into_bytes(),
            ReportFormat::Json => report::json(cost)?.into_bytes(),
            ReportFormat::Csv => report::csv(cost)?,
        };
        files::write(path, &bytes)?;
    }
    Ok(())
}

/// Does work under a progress bar on stderr if that is a terminal; elsewhere nothing is drawn.
fn watched<T>(work: impl FnOnce(Progress<'_>) -> T) -> T {
    let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
    let style = ProgressStyle::with_template("{wide_bar} {pos}/{len} {msg}");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    let result = work(&|done, total, what| {
        bar.set_length(total as u64);
        bar.set_position(done as u64);
        bar.set_message(what.to_owned());
    });
    bar.finish_and_clear();
    result
}
