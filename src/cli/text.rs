//! The commands that read scenes and print or rewrite text: `check`, `fmt` and `emit`.

use std::path::Path;
use std::path::PathBuf;

use crate::cli::arguments::EmitArguments;
use crate::cli::failure;
use crate::cli::failure::Failure;
use crate::cli::files;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::program::scene::Scene;
use crate::session;
use crate::session::Artefact;
use crate::session::Emission;
use crate::session::Override;
use crate::session::Source;
use crate::syntax;

/// `imp check`: every message about every file, and a line of what was found in each that is fine.
pub fn check(paths: &[PathBuf]) -> Result<(), Failure> {
    let mut failure = Failure::default();
    for path in paths {
        match scene(path, &[]) {
            Ok((_, scene)) => files::print(format!("{}: {}\n", path.display(), contents(&scene)).as_bytes())?,
            Err(found) => failure.collect(Err(found)),
        }
    }
    failure.into_result()
}

/// Such as `2 surfaces, 1 parameter, 57 operations`.
fn contents(scene: &Scene) -> String {
    let shape = if scene.dimension() == 3 { "surface" } else { "curve" };
    let operations = scene.graph.iter().filter(|(_, node)| !node.operands().is_empty()).count();
    let counts = [(scene.shapes.len(), shape), (scene.parameters.len(), "parameter"), (operations, "operation")];
    let counted = counts.iter().filter(|(count, _)| *count > 0);
    let texts: Vec<String> = counted.map(|(n, what)| format!("{n} {what}{}", if *n == 1 { "" } else { "s" })).collect();
    texts.join(", ")
}

/// A file's scene with everything on the way to it. Warnings are printed.
///
/// # Errors
/// The messages of the stage that failed.
pub fn scene(path: &Path, overrides: &[Override]) -> Result<(Artefact, Scene), Failure> {
    let mut artefact = session::compile(Source::File(path), overrides);
    match artefact.scene.take() {
        Some(scene) => {
            failure::print(&artefact.sources, &artefact.diagnostics);
            Ok((artefact, scene))
        }
        None => Err(Failure::new(artefact.sources, artefact.diagnostics)),
    }
}

/// `imp fmt`: rewrites the files that are not in canonical layout; with `check`, names them instead.
pub fn format(paths: &[PathBuf], check: bool) -> Result<(), Failure> {
    let mut failure = Failure::default();
    for path in paths {
        failure.collect(format_file(path, check));
    }
    failure.into_result()
}

fn format_file(path: &Path, check: bool) -> Result<(), Failure> {
    let (sources, file) = session::read(path).map_err(|(sources, found)| Failure::new(sources, vec![found]))?;
    let text = sources.get(file).text.clone();
    let formatted = match syntax::format::format(file, &text) {
        Ok(formatted) => formatted,
        Err(found) => return Err(Failure::new(sources, found)),
    };
    if formatted == *text {
        Ok(())
    } else if check {
        let name = path.display();
        let title = format!("`{name}` is not in canonical layout");
        Err(Diagnostic::error(code::NOT_FORMATTED, title).help(format!("run `imp fmt {name}`")).into())
    } else {
        files::write(path, formatted.as_bytes())
    }
}

/// `imp emit`: one stage of the compilation on stdout. Stages before an error are printed beside the messages.
pub fn emit(arguments: &EmitArguments) -> Result<(), Failure> {
    let artefact = session::compile(Source::File(&arguments.file), &[]);
    let how = Emission {
        precision: arguments.precision.into(),
        rounding: arguments.rounding.into(),
        arithmetic: arguments.arithmetic.into(),
    };
    if let Some(text) = artefact.emit(arguments.stage.into(), how)? {
        files::print(text.as_bytes())?;
    }
    if artefact.scene.is_none() {
        return Err(Failure::new(artefact.sources, artefact.diagnostics));
    }
    failure::print(&artefact.sources, &artefact.diagnostics);
    Ok(())
}
