//! The arguments of every command, as clap reads them.

use std::ops::Range;
use std::path::PathBuf;

use clap::Parser;
use clap::Subcommand;
use clap::ValueEnum;

use crate::accuracy::Selection;
use crate::build::Kernel;
use crate::cli::values;
use crate::codegen::object::Level;
use crate::derive::Arithmetic;
use crate::derive::Precision;
use crate::derive::Rounding;
use crate::render::Enclosures;
use crate::render::Options;
use crate::render::Stop;
use crate::render::image::Layer;
use crate::session::Override;
use crate::session::Stage;

/// A compiler from formulas to native interval code: implicit surfaces and curves with proofs.
#[derive(Debug, Parser)]
#[command(name = "imp", version, max_term_width = 100, subcommand_required = true, arg_required_else_help = true)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Draw a scene.
    Render(Box<RenderArguments>),
    /// Check a certificate of a picture or an arrangement with the reference interpreter alone.
    Verify {
        #[arg(value_name = "FILE")]
        file: PathBuf,
        /// What `imp render` or `imp arrange` wrote with `--certificate OUT`.
        #[arg(value_name = "OUT")]
        certificate: PathBuf,
        /// Values of parameters, as they were set for it. Repeatable.
        #[arg(long = "set", value_name = "NAME=VALUE", value_parser = values::setting)]
        settings: Vec<Override>,
    },
    /// Compute the arrangement of a scene's curves: vertices, edges, faces, and how much of it is proved.
    Arrange(Box<ArrangeArguments>),
    /// Say which kernels, rays and effects a picture will run, and why.
    Explain {
        #[arg(value_name = "FILE")]
        file: PathBuf,
        #[command(flatten)]
        picture: PictureArguments,
    },
    /// Report mistakes in scenes without drawing them.
    Check {
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
    },
    /// Bring scenes into canonical layout, in place.
    Fmt {
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
        /// Change nothing; fail if a file is not in canonical layout.
        #[arg(long)]
        check: bool,
    },
    /// Print a stage of the compilation.
    Emit(EmitArguments),
    /// Enclose the values of an expression over a box.
    Eval(EvalArguments),
    /// Measure what accuracy costs: a scene at many levels of accuracy, or an expression in every arithmetic.
    Cost(CostArguments),
    /// Compile functions for other programs: an object, a static library, a C header, Rust functions.
    Build(BuildArguments),
    /// Calculate with boxes interactively; `:help` there says how.
    Repl,
}

#[derive(Debug, clap::Args)]
pub struct EvalArguments {
    /// An expression such as 'x^2 - 1'; with --json a file of requests, `-` for stdin.
    #[arg(value_name = "EXPR", allow_hyphen_values = true)]
    pub expression: String,
    /// A number such as `x=0.1` (one tenth exactly) or `a=pi/2`, or a box such as `x=[1,2]`.
    #[arg(value_name = "NAME=VALUE", conflicts_with = "json")]
    pub values: Vec<String>,
    /// interval, affine, centred and others, `auto` for what they prove together, `all` for one line of each
    /// [default: auto; with --json: interval].
    #[arg(long, value_name = "NAME")]
    pub arithmetic: Option<String>,
    /// A file whose `let`, `fn` and `param` the expression may use.
    #[arg(long, value_name = "FILE")]
    pub definitions: Option<PathBuf>,
    /// Answer requests, one JSON object a line: {"expr": "x^2 - 1", "vars": {"x": ["-1", "2"]}}.
    #[arg(long)]
    pub json: bool,
}

/// What a picture is computed with; shared by all commands that compute one.
#[derive(Debug, clap::Args)]
pub struct PictureArguments {
    /// Pixels across and down; one number for a square.
    #[arg(long, value_name = "WxH", default_value = "512x512", value_parser = values::size)]
    pub size: (u32, u32),
    /// What encloses the field over beams of pixels.
    #[arg(long, value_enum, default_value_t = EnclosuresArgument::Auto)]
    pub arithmetic: EnclosuresArgument,
    /// Format in which beams march; what single precision leaves open is tried in double.
    #[arg(long, value_enum, default_value_t = PrecisionArgument::F32)]
    pub precision: PrecisionArgument,
    /// With `nearest` nothing is proved.
    #[arg(long, value_enum, default_value_t = RoundingArgument::Outward)]
    pub rounding: RoundingArgument,
    #[command(flatten)]
    pub stop: StopArguments,
    /// Worker threads [default: one per processor]. The picture does not depend on them.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Value of a parameter or of the time `t`: a constant such as 0.1 (one tenth exactly) or pi/2. Repeatable.
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = values::setting)]
    pub settings: Vec<Override>,
    /// Draw poles where the field changes sign too; they stay unknown.
    #[arg(long)]
    pub poles: bool,
}

/// How far a hit is refined; at most one of them.
#[derive(Debug, clap::Args)]
#[group(multiple = false)]
pub struct StopArguments {
    /// Refine hits to cells of 2^-N of the domain [default: 16].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=48))]
    pub depth: Option<u32>,
    /// Refine hits to cells no longer than E.
    #[arg(long, value_name = "E", value_parser = values::positive)]
    pub epsilon: Option<f64>,
    /// Refine hits to cells over which the field varies by no more than D.
    #[arg(long, value_name = "D", value_parser = values::positive)]
    pub tolerance: Option<f64>,
}

#[derive(Debug, clap::Args)]
pub struct RenderArguments {
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// PNG file to write, `-` for stdout [default: FILE with the ending .png, in the current folder].
    #[arg(short, long, value_name = "OUT.png")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub picture: PictureArguments,
    /// Frames A up to but not including B, each its own numbered file, at time t = frame / FPS.
    #[arg(long, value_name = "A..B", value_parser = values::frames)]
    pub frames: Option<Range<u64>>,
    /// Frames in one unit of time.
    #[arg(long, value_name = "FPS", default_value_t = 25, requires = "frames",
          value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub fps: u32,
    /// Write a further layer: depth, normal or certainty, as in `--layer depth=depth.png`. Repeatable.
    #[arg(long = "layer", value_name = "LAYER=FILE", value_parser = values::layer)]
    pub layers: Vec<LayerArgument>,
    /// Print times and counts on stdout, one object a picture.
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub stats: Option<StatsArgument>,
    /// Compute the picture N times and report the median time.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub repeat: u32,
    /// Write what `imp verify` needs to check every proof in the picture.
    #[arg(long, value_name = "OUT")]
    pub certificate: Option<PathBuf>,
}

/// A layer and the file it goes to.
#[derive(Debug, Clone)]
pub struct LayerArgument {
    pub layer: Layer,
    pub path: PathBuf,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum StatsArgument {
    Json,
}

#[derive(Debug, clap::Args)]
pub struct ArrangeArguments {
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Write a picture, the structure or its graph: the ending says which. Repeatable.
    #[arg(short, long = "output", value_name = "OUT.svg|png|json|geojson|dot", value_parser = values::drawing)]
    pub outputs: Vec<DrawingArgument>,
    /// Boxes with both sides at most E are not split; what is open there stays a cluster [default: 2^-30 of the domain].
    #[arg(long, value_name = "E", value_parser = values::positive)]
    pub epsilon: Option<f64>,
    /// What decides.
    #[arg(long, value_enum, default_value_t = MethodArgument::Certified)]
    pub method: MethodArgument,
    /// Print one JSON object instead of a table.
    #[arg(long)]
    pub json: bool,
    /// Value of a parameter or of the time `t`. Repeatable.
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = values::setting)]
    pub settings: Vec<Override>,
    /// Worker threads [default: one per processor]. The arrangement does not depend on them.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Pixels of a picture across and down; one number for a square.
    #[arg(long, value_name = "WxH", default_value = "960x800", value_parser = values::size)]
    pub size: (u32, u32),
    /// How far an edge's polyline may be from its curve [default: half a pixel of 1024 along the domain].
    #[arg(long, value_name = "T", value_parser = values::positive)]
    pub tolerance: Option<f64>,
    /// Draw the boxes of the subdivision too.
    #[arg(long)]
    pub boxes: bool,
    /// Write the graph of faces to DOT files instead of that of vertices.
    #[arg(long)]
    pub dual: bool,
    /// Settle nothing with exact arithmetic.
    #[arg(long)]
    pub no_exact: bool,
    /// Arrange the whole plane, drawn in a disc whose circle is at infinity; polynomial curves only.
    #[arg(long, conflicts_with = "certificate")]
    pub projective: bool,
    /// Write what `imp verify` needs to check the arrangement.
    #[arg(long, value_name = "OUT")]
    pub certificate: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum MethodArgument {
    /// Interval proofs and exact arithmetic: what is not proved is said.
    Certified,
    /// CAPS as its source has it, for comparison: a labelled quadtree and the graph of its regions.
    Published,
}

/// A file for an arrangement and what goes into it.
#[derive(Debug, Clone)]
pub struct DrawingArgument {
    pub path: PathBuf,
    pub format: DrawingFormat,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DrawingFormat {
    Svg,
    Png,
    Json,
    GeoJson,
    Dot,
}

#[derive(Debug, clap::Args)]
pub struct EmitArguments {
    #[arg(value_name = "STAGE")]
    pub stage: StageArgument,
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Format of the kernel, for stages from interval on.
    #[arg(long, value_enum, default_value_t = PrecisionArgument::F32)]
    pub precision: PrecisionArgument,
    /// Rounding of the kernel.
    #[arg(long, value_enum, default_value_t = RoundingArgument::Outward)]
    pub rounding: RoundingArgument,
    /// What the kernel of the stages clif and asm computes on.
    #[arg(long, value_enum, default_value_t = KernelArgument::Interval)]
    pub arithmetic: KernelArgument,
}

#[derive(Debug, clap::Args)]
pub struct BuildArguments {
    /// Definitions; its name is what symbols begin with.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Write an object.
    #[arg(short, long, value_name = "OUT.o")]
    pub output: Option<PathBuf>,
    /// Write a header for C and C++.
    #[arg(long, value_name = "OUT.h")]
    pub header: Option<PathBuf>,
    /// Write Rust functions, in a file that needs no crate.
    #[arg(long, value_name = "OUT.rs")]
    pub rust: Option<PathBuf>,
    /// Write a static library with the object in it.
    #[arg(long = "static", value_name = "libOUT.a")]
    pub archive: Option<PathBuf>,
    /// What to make of each function [default: value,gradient,interval,interval_gradient].
    #[arg(long, value_enum, value_name = "KERNEL,...", value_delimiter = ',')]
    pub kernels: Vec<ExportArgument>,
    /// Names of functions [default: all that take numbers].
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    pub functions: Vec<String>,
    /// Format of all numbers.
    #[arg(long, value_enum, default_value_t = PrecisionArgument::F64)]
    pub precision: PrecisionArgument,
    /// Levels of x86-64, of which the object chooses the best that the processor has [default: all].
    #[arg(long, value_enum, value_name = "LEVEL,...", value_delimiter = ',')]
    pub levels: Vec<LevelArgument>,
    /// Processor, under Linux [default: this machine's].
    #[arg(long, value_enum)]
    pub target: Option<TargetArgument>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
#[value(rename_all = "snake_case")]
pub enum ExportArgument {
    /// Values at points.
    Value,
    /// Values and partial derivatives at points.
    Gradient,
    /// Enclosures over boxes.
    Interval,
    /// Enclosures of values and partial derivatives over boxes.
    IntervalGradient,
    /// Enclosures over boxes with affine forms.
    Affine,
    /// The same of partial derivatives too.
    AffineGradient,
}

impl From<ExportArgument> for Kernel {
    fn from(kernel: ExportArgument) -> Self {
        match kernel {
            ExportArgument::Value => Kernel::Value,
            ExportArgument::Gradient => Kernel::Gradient,
            ExportArgument::Interval => Kernel::Interval,
            ExportArgument::IntervalGradient => Kernel::IntervalGradient,
            ExportArgument::Affine => Kernel::Affine,
            ExportArgument::AffineGradient => Kernel::AffineGradient,
        }
    }
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum LevelArgument {
    /// SSE4.2: any processor since 2009.
    V2,
    /// AVX2 and FMA.
    V3,
    /// AVX-512.
    V4,
}

impl From<LevelArgument> for Level {
    fn from(level: LevelArgument) -> Self {
        match level {
            LevelArgument::V2 => Level::V2,
            LevelArgument::V3 => Level::V3,
            LevelArgument::V4 => Level::V4,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum TargetArgument {
    #[value(name = "x86_64")]
    X86_64,
    Aarch64,
}

#[derive(Debug, clap::Args)]
pub struct CostArguments {
    /// A scene, or an expression such as 'x*(10-x)'. What exists or ends in .imp is a scene.
    #[arg(value_name = "FILE|EXPR", allow_hyphen_values = true)]
    pub subject: String,
    /// What the variables of an expression are, such as `x=[4,6]`.
    #[arg(value_name = "NAME=VALUE")]
    pub values: Vec<String>,
    /// Write a page, charts, data or a table: the ending says which. Repeatable.
    #[arg(short, long = "output", value_name = "OUT.html|svg|json|csv", value_parser = values::report)]
    pub outputs: Vec<ReportArgument>,
    /// Pixels across and down; one number for a square.
    #[arg(long, value_name = "WxH", default_value = "192x192", value_parser = values::size)]
    pub size: (u32, u32),
    /// Measure each level N times and take the median time; slow levels are measured less often.
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=1_000))]
    pub repeat: u32,
    /// How many levels of a scene are compared.
    #[arg(long, value_enum, default_value_t = LevelsArgument::Usual)]
    pub levels: LevelsArgument,
    /// Worker threads [default: one per processor].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Value of a parameter of the scene or of the time `t`. Repeatable.
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = values::setting)]
    pub settings: Vec<Override>,
}

/// A file for measurements and what goes into it.
#[derive(Debug, Clone)]
pub struct ReportArgument {
    pub path: PathBuf,
    pub format: ReportFormat,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReportFormat {
    Html,
    Svg,
    Json,
    Csv,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum LevelsArgument {
    /// A few of each kind.
    Few,
    /// Every engine, arithmetic, format and rounding at several depths.
    Usual,
    /// Every combination at every depth, which takes minutes.
    All,
}

impl From<LevelsArgument> for Selection {
    fn from(levels: LevelsArgument) -> Self {
        match levels {
            LevelsArgument::Few => Selection::Few,
            LevelsArgument::Usual => Selection::Usual,
            LevelsArgument::All => Selection::All,
        }
    }
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum StageArgument {
    /// Tokens as the grammar reads them.
    Tokens,
    /// The syntax tree.
    Ast,
    /// The formulas as one graph.
    Graph,
    /// The graph after each pass that changed it.
    Passes,
    /// Program that encloses each field over boxes.
    Interval,
    /// The same with affine forms.
    Affine,
    /// Fields and their derivatives as a graph.
    Gradient,
    /// Input of the code generator.
    Clif,
    /// Machine code.
    Asm,
}

impl PictureArguments {
    /// The renderer's options; the layers and what else only `imp render` offers are left at their defaults.
    pub fn options(&self) -> Options {
        let StopArguments { depth, epsilon, tolerance } = self.stop;
        let (width, height) = self.size;
        Options {
            width,
            height,
            enclosures: self.arithmetic.into(),
            precision: self.precision.into(),
            rounding: self.rounding.into(),
            stop: match (depth, epsilon, tolerance) {
                (Some(depth), _, _) => Stop::Depth(depth),
                (_, Some(epsilon), _) => Stop::Epsilon(epsilon),
                (_, _, Some(tolerance)) => Stop::Tolerance(tolerance),
                (None, None, None) => Stop::default(),
            },
            threads: self.threads.map(usize::from),
            poles: self.poles,
            ..Options::default()
        }
    }
}

impl From<StageArgument> for Stage {
    fn from(stage: StageArgument) -> Self {
        match stage {
            StageArgument::Tokens => Stage::Tokens,
            StageArgument::Ast => Stage::Ast,
            StageArgument::Graph => Stage::Graph,
            StageArgument::Passes => Stage::Passes,
            StageArgument::Interval => Stage::Interval,
            StageArgument::Affine => Stage::Affine,
            StageArgument::Gradient => Stage::Gradient,
            StageArgument::Clif => Stage::Clif,
            StageArgument::Asm => Stage::Asm,
        }
    }
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum PrecisionArgument {
    F32,
    F64,
}

impl From<PrecisionArgument> for Precision {
    fn from(precision: PrecisionArgument) -> Self {
        match precision {
            PrecisionArgument::F32 => Precision::Single,
            PrecisionArgument::F64 => Precision::Double,
        }
    }
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum RoundingArgument {
    /// Every enclosure holds.
    Outward,
    /// As the source papers did it: nothing is proved.
    Nearest,
}

impl From<RoundingArgument> for Rounding {
    fn from(rounding: RoundingArgument) -> Self {
        match rounding {
            RoundingArgument::Outward => Rounding::Outward,
            RoundingArgument::Nearest => Rounding::Nearest,
        }
    }
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum EnclosuresArgument {
    /// The natural interval extension.
    Interval,
    /// Affine forms intersected with it.
    Affine,
    /// The natural extension, with centred forms for beams of every size rather than small ones.
    Centred,
    /// Intervals or affine forms, by a trial that counts operations.
    Auto,
}

impl From<EnclosuresArgument> for Enclosures {
    fn from(enclosures: EnclosuresArgument) -> Self {
        match enclosures {
            EnclosuresArgument::Interval => Enclosures::Interval,
            EnclosuresArgument::Affine => Enclosures::Affine,
            EnclosuresArgument::Centred => Enclosures::Centred,
            EnclosuresArgument::Auto => Enclosures::Auto,
        }
    }
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum KernelArgument {
    Interval,
    Affine,
}

impl From<KernelArgument> for Arithmetic {
    fn from(arithmetic: KernelArgument) -> Self {
        match arithmetic {
            KernelArgument::Interval => Arithmetic::Interval,
            KernelArgument::Affine => Arithmetic::Affine,
        }
    }
}
