//! The commands that compute pictures: `render` and `explain`.

use std::collections::HashSet;
use std::path::Path;
use std::path::PathBuf;
use std::time::Duration;
use std::time::Instant;

use indicatif::ProgressBar;
use indicatif::ProgressDrawTarget;
use indicatif::ProgressStyle;
use num_rational::BigRational;
use serde::Serialize;

use crate::cli::arguments::PictureArguments;
use crate::cli::arguments::RenderArguments;
use crate::cli::arguments::StatsArgument;
use crate::cli::failure;
use crate::cli::failure::Failure;
use crate::cli::files;
use crate::cli::text;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::SourceMap;
use crate::diagnostic::code;
use crate::interpret::Interpreter;
use crate::interval::Interval;
use crate::program::TIME;
use crate::program::scene::Parameter;
use crate::program::scene::Scene;
use crate::render;
use crate::render::Certificate;
use crate::render::Control;
use crate::render::Layers;
use crate::render::Options;
use crate::render::Picture;
use crate::render::Renderer;
use crate::render::Stats;
use crate::render::image;
use crate::render::image::Layer;
use crate::session;
use crate::session::Override;

/// The name that stands for stdout.
const STDOUT: &str = "-";

/// Pictures that take less time than this show no progress.
const PATIENCE: Duration = Duration::from_millis(300);

/// `imp render`: the picture, its layers and its certificate, for one or several times.
pub fn render(arguments: &RenderArguments) -> Result<(), Failure> {
    let outputs = Outputs::new(arguments)?;
    let (artefact, scene) = text::scene(&arguments.file, &arguments.picture.settings)?;
    let fail = |diagnostic| Failure::new(artefact.sources.clone(), vec![diagnostic]);
    check_time(arguments, &scene)?;
    warn_of_size(&scene);
    let renderer = Renderer::new(&scene, &options(arguments), session::backend()).map_err(fail)?;
    let numbers = arguments.frames.clone().unwrap_or(0..1);
    for number in numbers.clone() {
        let parameters = match arguments.frames {
            Some(_) => at_time(&scene, number, arguments.fps),
            None => scene.parameters.clone(),
        };
        let frame = arguments.frames.as_ref().map(|_| number);
        let picture = watched(frame, |control| renderer.render(&parameters, control)).map_err(fail)?;
        let name = |path: &Path| match arguments.frames {
            Some(_) => files::numbered(path, number, numbers.end - 1),
            None => path.to_path_buf(),
        };
        outputs.write(&picture, name)?;
        match arguments.stats {
            Some(StatsArgument::Json) => files::print(json(&picture.stats, frame).as_bytes())?,
            None if outputs.color == Path::new(STDOUT) => {}
            None => files::print(summary(&name(&outputs.color), &picture).as_bytes())?,
        }
    }
    Ok(())
}

/// `imp explain`: the plan of the picture.
pub fn explain(file: &Path, picture: &PictureArguments) -> Result<(), Failure> {
    let (artefact, scene) = text::scene(file, &picture.settings)?;
    match Renderer::new(&scene, &picture.options(), session::backend()) {
        Ok(renderer) => files::print(renderer.plan().to_string().as_bytes()),
        Err(diagnostic) => Err(Failure::new(artefact.sources, vec![diagnostic])),
    }
}

/// `imp verify` for a certificate of a picture: replays it with the reference interpreter alone.
pub fn verify(file: &Path, certificate: &[u8], settings: &[Override]) -> Result<(), Failure> {
    let (artefact, scene) = text::scene(file, settings)?;
    let certificate = Certificate::from_bytes(certificate)?;
    let report = watched(None, |control| render::verify(&scene, &certificate, &Interpreter, control));
    let report = report.map_err(|diagnostic| Failure::new(artefact.sources, vec![diagnostic]))?;
    let render::Report { counts, cells, evaluations } = report;
    let text = format!(
        "verified: {} hits and {} misses proved, {} pixels unknown; {cells} refuted cells, {evaluations} evaluations\n",
        counts.proved, counts.misses, counts.unknown,
    );
    files::print(text.as_bytes())
}

fn options(arguments: &RenderArguments) -> Options {
    let wanted = |layer| arguments.layers.iter().any(|argument| argument.layer == layer);
    Options {
        layers: Layers {
            color: true,
            depth: wanted(Layer::Depth),
            normal: wanted(Layer::Normal),
            certainty: wanted(Layer::Certainty),
        },
        certificate: arguments.certificate.is_some(),
        repeat: arguments.repeat,
        ..arguments.picture.options()
    }
}

/// The files that a picture goes to.
struct Outputs<'a> {
    color: PathBuf,
    layers: Vec<(Layer, &'a Path)>,
    certificate: Option<&'a Path>,
}

impl<'a> Outputs<'a> {
    /// # Errors
    /// If two outputs share a file, or a picture's file has the ending of another format.
    fn new(arguments: &'a RenderArguments) -> Result<Self, Failure> {
        let stem = arguments.file.file_stem().unwrap_or_default();
        let color = arguments.output.clone().unwrap_or_else(|| Path::new(stem).with_extension("png"));
        let layers: Vec<(Layer, &Path)> = arguments.layers.iter().map(|l| (l.layer, l.path.as_path())).collect();
        let outputs = Self { color, layers, certificate: arguments.certificate.as_deref() };
        let mut seen = HashSet::new();
        let pictures: Vec<&Path> = [outputs.color.as_path()].into_iter().chain(layers_of(&outputs)).collect();
        for path in &pictures {
            let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
            if let Some(ending) = ending.filter(|ending| ending != "png") {
                let title = format!("pictures are written as PNG, not as {ending}: `{}`", path.display());
                let help = format!("write `{}`", path.with_extension("png").display());
                return Err(Diagnostic::error(code::BAD_OPTION, title).help(help).into());
            }
        }
        for path in pictures.into_iter().chain(outputs.certificate) {
            let device = path.exists() && !path.is_file();
            if !device && !seen.insert(path) {
                let title = format!("two outputs would go to `{}`", path.display());
                return Err(Diagnostic::error(code::BAD_OPTION, title).into());
            }
        }
        Ok(outputs)
    }

    fn write(&self, picture: &Picture, name: impl Fn(&Path) -> PathBuf) -> Result<(), Failure> {
        let color = image::png(picture, Layer::Color);
        if self.color == Path::new(STDOUT) {
            files::print(&color)?;
        } else {
            files::write(&name(&self.color), &color)?;
        }
        for (layer, path) in &self.layers {
            files::write(&name(path), &image::png(picture, *layer))?;
        }
        if let (Some(path), Some(certificate)) = (self.certificate, &picture.certificate) {
            files::write(&name(path), &certificate.to_bytes())?;
        }
        Ok(())
    }
}

fn layers_of<'a>(outputs: &Outputs<'a>) -> impl Iterator<Item = &'a Path> {
    outputs.layers.iter().map(|&(_, path)| path)
}

/// Frames need a scene that moves, and a time that nothing else sets.
fn check_time(arguments: &RenderArguments, scene: &Scene) -> Result<(), Failure> {
    if arguments.frames.is_none() {
        return Ok(());
    }
    let title = if arguments.picture.settings.iter().any(|setting| setting.name == TIME) {
        "`--frames` and `--set t=...` both set the time".to_owned()
    } else if scene.parameters.iter().all(|parameter| parameter.name != TIME) {
        format!("nothing in `{}` depends on the time `t`, so all frames would be the same", arguments.file.display())
    } else {
        return Ok(());
    };
    Err(Diagnostic::error(code::BAD_OPTION, title).into())
}

/// The parameters with the time of a frame, exactly.
fn at_time(scene: &Scene, frame: u64, fps: u32) -> Vec<Parameter> {
    let time = Interval::from_rational(&BigRational::new(frame.into(), fps.into()));
    let mut parameters = scene.parameters.clone();
    for parameter in parameters.iter_mut().filter(|parameter| parameter.name == TIME) {
        parameter.value = time;
    }
    parameters
}

/// Operations from which on compiling takes long enough to be worth a word.
const LARGE: usize = 2_000;

fn warn_of_size(scene: &Scene) {
    let operations = scene.graph.iter().filter(|(_, node)| !node.operands().is_empty()).count();
    if operations > LARGE {
        let title = format!("these formulas have {operations} operations: compiling them takes a while");
        failure::print(&SourceMap::default(), &[Diagnostic::warning(code::LARGE_FORMULA, title)]);
    }
}

/// Statistics as one line of JSON, with the number of the frame if there are several.
fn json(stats: &Stats, frame: Option<u64>) -> String {
    #[derive(Serialize)]
    struct Line<'a> {
        #[serde(skip_serializing_if = "Option::is_none")]
        frame: Option<u64>,
        #[serde(flatten)]
        stats: &'a Stats,
    }
    // Numbers and fixed names always have a JSON form.
    serde_json::to_string(&Line { frame, stats }).unwrap_or_default() + "\n"
}

/// What was drawn and how much of it is proved, on one line.
fn summary(path: &Path, picture: &Picture) -> String {
    let Stats { compile_ms, render_ms, proved, unknown, misses, .. } = &picture.stats;
    let Picture { width, height, .. } = picture;
    format!(
        "{}: {width}x{height}, {proved} hits and {misses} misses proved, {unknown} unknown; compiled in {compile_ms:.1} ms, rendered in {render_ms:.1} ms\n",
        path.display(),
    )
}

/// Does work under a progress bar on stderr if that is a terminal; elsewhere nothing is drawn.
fn watched<T>(frame: Option<u64>, work: impl FnOnce(&Control) -> T) -> T {
    let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
    let style = ProgressStyle::with_template("{prefix}{wide_bar} {pos}/{len} tiles, {eta} to go");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    if let Some(frame) = frame {
        bar.set_prefix(format!("frame {frame} "));
    }
    let start = Instant::now();
    let watch = |done: usize, total: usize| {
        if start.elapsed() > PATIENCE {
            bar.set_length(total as u64);
            bar.set_position(done as u64);
        }
    };
    let result = work(&Control::new(Some(&watch), None));
    bar.finish_and_clear();
    result
}
