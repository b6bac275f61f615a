//! Imp compiles formulas to native interval code: certified bounds, values and gradients, pictures and arrangements, with
//! proofs.
//!
//! A formula is a text in Imp's language; a [`Program`] reads it, a [`Function`] of it becomes a kernel, and the kernel
//! bounds the function's values over boxes, rounding errors included:
//!
//! ```
//! use imp::{Interval, Options, Program};
//!
//! let program = Program::parse("fn f(x, y) = (x^2 + y - 11)^2 + (x + y^2 - 7)^2")?;
//! let kernel = program.function("f")?.intervals(&Options::default())?;
//! let unit = Interval::try_from(-1.0..=1.0)?;
//! let bound = kernel.enclose(&[unit, unit])?;
//! assert_eq!(bound.interval, Interval::try_from(106.0..=208.0)?);
//! assert!(bound.is_positive());     // proved: the function has no zero in this box
//! # Ok::<(), imp::Error>(())
//! ```
//!
//! # A tour
//!
//! 1. [From text to functions](#from-text-to-functions)
//! 2. [Bounds over boxes](#bounds-over-boxes)
//! 3. [Many boxes at once](#many-boxes-at-once)
//! 4. [Parameters](#parameters)
//! 5. [Values and gradients](#values-and-gradients)
//! 6. [How a function is compiled](#how-a-function-is-compiled)
//! 7. [Roots](#roots)
//! 8. [Pictures and arrangements](#pictures-and-arrangements)
//! 9. [Mistakes](#mistakes)
//! 10. [Formulas from strangers](#formulas-from-strangers)
//! 11. [Kernels without Imp](#kernels-without-imp)
//! 12. [Below the library](#below-the-library)
//!
//! ## From text to functions
//!
//! [`Program::parse`] takes a text, [`Program::open`] a file with its imports. Its functions are each `fn` of numbers, each `let`
//! that depends on the coordinates `x`, `y`, `z`, and each shape, as the formula that is 0 on it. A function whose value is a list
//! has several outputs. [`Program::expression`] makes a function of a further text, such as one that a user has typed:
//!
//! ```
//! use imp::Program;
//!
//! let program = Program::parse(
//!     "param arm = 1 in [0.5, 2]
//!      fn hand(p, q) = [arm cos(p) + cos(p + q), arm sin(p) + sin(p + q)]
//!      let bowl = x^2 + y^2
//!      surface ball: x^2 + y^2 + z^2 = 1",
//! )?;
//! let signatures: Vec<String> = program.functions().iter().map(|f| format!("{f:?}")).collect();
//! assert_eq!(signatures, ["hand(p, q; arm)", "bowl(x, y)", "ball(x, y, z)"]);
//! assert_eq!(program.function("hand")?.outputs(), ["hand[1]", "hand[2]"]);
//! let typed = program.expression("sqrt(bowl) - arm/2", &["x", "y"])?;
//! assert_eq!(typed.variables(), ["x", "y"]);
//! # Ok::<(), imp::Error>(())
//! ```
//!
//! ## Bounds over boxes
//!
//! An [`IntervalKernel`] answers with an [`Enclosure`]: an interval that holds every value of the function on the box, and
//! what is proved besides. A function is evaluated where it is defined; `is_continuous` proves that this was everywhere. So a
//! sign change proves a zero, while a pole, which changes its sign too, is told apart:
//!
//! ```
//! use imp::{Interval, Options, Program};
//!
//! let program = Program::parse("fn f(u) = 1/(u - 1) \n fn g(u) = u^3 - u - 1")?;
//! let f = program.function("f")?.intervals(&Options::default())?;
//! let g = program.function("g")?.intervals(&Options::default())?;
//! for (kernel, has_root) in [(f, false), (g, true)] {
//!     let below = kernel.enclose(&[Interval::point(0.5)])?;
//!     let above = kernel.enclose(&[Interval::point(1.5)])?;
//!     assert!(below.is_negative() && above.is_positive());
//!     assert_eq!(kernel.enclose(&[Interval::try_from(0.5..=1.5)?])?.is_continuous(), has_root);
//! }
//! # Ok::<(), imp::Error>(())
//! ```
//!
//! ## Many boxes at once
//!
//! A kernel computes 8 boxes at a time (16 in single precision), so that a call for one box leaves most of it unused. Rows
//! of boxes go through [`IntervalKernel::enclose_into`], or [`IntervalKernel::par_enclose_into`] on all threads of rayon's pool;
//! columns through [`IntervalKernel::enclose_columns`]:
//!
//! ```
//! use imp::{Columns, Enclosure, Interval, Options, Program};
//!
//! let program = Program::parse("fn f(x, y) = sin(x) + y^2")?;
//! let kernel = program.function("f")?.intervals(&Options::default())?;
//! // Rows: x and y of the first box, then of the second.
//! let boxes: Vec<Interval> = (0..2000).map(|i| Interval::point(f64::from(i) / 100.0)).collect();
//! let mut rows = vec![Enclosure::UNKNOWN; 1000];
//! kernel.par_enclose_into(&boxes, &mut rows)?;
//! // Columns: the lower and the upper ends of all x, then of all y.
//! let x: Vec<f64> = (0..1000).map(|i| f64::from(2 * i) / 100.0).collect();
//! let y: Vec<f64> = (0..1000).map(|i| f64::from(2 * i + 1) / 100.0).collect();
//! let mut columns = Columns::default();
//! kernel.enclose_columns(&[[&x, &x], [&y, &y]], &mut columns)?;
//! assert_eq!(columns.hi[0][7], rows[7].hi());
//! # Ok::<(), imp::Error>(())
//! ```
//!
//! ## Parameters
//!
//! A `param` is an argument of the machine code: another value compiles nothing. It may be an interval, for what is known to a
//! tolerance only. Kernels are cheap to clone, and each clone has values of its own:
//!
//! ```
//! use imp::{Error, Interval, Options, Program};
//!
//! let program = Program::parse("param r = 1 in [0, 10] \n fn f(x) = x^2 - r^2")?;
//! let one = program.function("f")?.intervals(&Options::default())?;
//! let measured = one.clone().with("r", Interval::try_from(1.9..=2.1)?)?;
//! assert_eq!(one.enclose(&[Interval::point(3.0)])?.interval, Interval::point(8.0));
//! assert!(measured.enclose(&[Interval::point(3.0)])?.interval.width() > 0.7);
//! assert!(matches!(one.with("r", Interval::point(11.0)), Err(Error::OutOfRange { .. })));
//! # Ok::<(), imp::Error>(())
//! ```
//!
//! ## Values and gradients
//!
//! A [`PointKernel`] computes in ordinary floating point, which proves nothing. With [`Options::gradient`] either kind of
//! kernel gives the partial derivatives, too, each value followed by its own:
//!
//! ```
//! use imp::{Options, Program};
//!
//! let program = Program::parse("fn f(x, y) = x^2 y")?;
//! let kernel = program.function("f")?.points(&Options::with_gradient())?;
//! assert_eq!(kernel.outputs(), ["f", "df/dx", "df/dy"]);
//! let mut values = [0.0; 6];
//! kernel.values_into(&[3.0, 5.0, 1.0, 2.0], &mut values)?;
//! assert_eq!(values, [45.0, 30.0, 9.0, 2.0, 4.0, 1.0]);
//! # Ok::<(), imp::Error>(())
//! ```
//!
//! ## How a function is compiled
//!
//! [`Options`] has the arithmetic, the rounding, the domain and the gradient; the precision is a type. What is known of the
//! variables makes code shorter and bounds narrower; affine forms remember that a variable occurs twice:
//!
//! ```
//! use imp::{Function, Interval, IntervalKernel, Options};
//!
//! let f = Function::parse("x(10 - x)", &["x"])?;
//! let at = [Interval::try_from(4.0..=6.0)?];
//! let natural = f.intervals(&Options::default())?.enclose(&at)?;
//! let affine = f.intervals(&Options { affine: true, ..Options::default() })?.enclose(&at)?;
//! assert_eq!(natural.interval, Interval::try_from(16.0..=36.0)?);
//! assert!(affine.interval.width() < 2.1 && affine.interval.contains(25.0));
//! let single: IntervalKernel<f32> = f.interval_kernel(&Options::default())?;
//! assert_eq!(single.enclose(&at)?.interval, natural.interval);
//! # Ok::<(), imp::Error>(())
//! ```
//!
//! ## Roots
//!
//! [`Function::roots`] finds all zeros in an interval. Each bracket is proved to hold one, and nothing else outside of what is
//! said to be unknown. [`Function::root_finder`] compiles the search once for many values of the other variables and parameters,
//! [`Function::ray_finder`] for many lines through space:
//!
//! ```
//! use glam::DVec3;
//! use imp::{Interval, Program};
//!
//! let program = Program::parse("fn kepler(e, m, u) = u - e sin(u) - m\n surface ball: x^2 + y^2 + z^2 = 1")?;
//! let mut orbit = program.function("kepler")?.root_finder("u")?;
//! orbit.set("e", Interval::point(0.5))?;
//! for m in [0.5, 1.0, 1.5] {
//!     orbit.set("m", Interval::point(m))?;
//!     let found = orbit.roots(Interval::try_from(0.0..=7.0)?);
//!     assert!(found.is_complete() && found.proved.len() == 1);
//!     assert!(found.proved[0].bracket.width() < 1e-14);
//! }
//! let rays = program.function("ball")?.ray_finder()?;
//! let (eye, towards) = (DVec3::new(0.0, 0.0, 5.0), DVec3::NEG_Z);
//! let hits = rays.roots(&eye.to_array(), &towards.to_array(), Interval::try_from(0.0..=100.0)?)?;
//! assert!(hits.first().expect("the ray meets the ball").bracket.contains(4.0));
//! # Ok::<(), imp::Error>(())
//! ```
//!
//! ## Pictures and arrangements
//!
//! A program with shapes is a scene. [`Program::render`] draws it, and says of every pixel what is proved;
//! [`render::Renderer`] draws it again with other values of its parameters. [`Program::arrange`] cuts the plane along its
//! curves:
//!
//! ```
//! use imp::Program;
//! use imp::render::{self, Certainty};
//!
//! let ball = Program::parse("x^2 + y^2 + z^2 = 1")?;
//! let picture = ball.render(&render::Options { width: 64, height: 64, ..Default::default() })?;
//! assert_eq!(picture.certainty[picture.index(32, 32)], Certainty::Hit);
//! assert_eq!(picture.certainty[picture.index(0, 0)], Certainty::Miss);
//! let image: image::RgbImage = picture.image();
//! assert_eq!(image.dimensions(), (64, 64));
//!
//! let circles = Program::parse("x^2 + y^2 = 1 \n (x - 1)^2 + y^2 = 1 \n domain [-3, 3]^2")?;
//! let arrangement = circles.arrange(&Default::default())?;
//! let counts = imp::arrange::check::check(&arrangement).map_err(imp::diagnostic::Diagnostic::from)?;
//! assert!(counts.proved && counts.vertices.crossing == 2 && counts.faces == 4);
//! # Ok::<(), imp::Error>(())
//! ```
//!
//! ## Mistakes
//!
//! There is one [`Error`]. What is wrong with a text is a list of [`diagnostic::Diagnostic`]s, each with its code, its place and
//! often an edit to try; the error prints them with excerpts:
//!
//! ```
//! use imp::{Error, Program};
//!
//! let error = Program::named("wave.imp", "fn f(x) = sin 2x\nfn g(y) = y + q").unwrap_err();
//! assert!(error.to_string().contains("wave.imp:1:11") && error.to_string().contains("write `sin(2x)`"));
//! let Error::Source(report) = error else { unreachable!("the text has mistakes") };
//! let codes: Vec<&str> = report.diagnostics().iter().map(|d| d.code).collect();
//! assert_eq!(codes, ["E0111", "E0201"]);
//! let label = &report.diagnostics()[1].labels[0];
//! assert_eq!((report.place(label.span), report.text(label.span)), (("wave.imp", 2, 15), "q"));
//! # let _ = Error::Source(report);
//! ```
//!
//! ## Formulas from strangers
//!
//! Texts are bounded in size, depth, memory and time. [`Limits::default`] is generous; [`Limits::untrusted`] is for what
//! arrives over a network:
//!
//! ```
//! use imp::{Limits, Loader};
//!
//! let loader = Loader::new("form field", Limits::untrusted());
//! for hostile in ["(".repeat(60_000), "x^(10^9) = 1".to_owned(), "import \"/etc/passwd\"".to_owned()] {
//!     assert!(loader.parse(&hostile).is_err());
//! }
//! assert!(loader.parse("fn f(x) = x^2").is_ok());
//! ```
//!
//! ## Kernels without Imp
//!
//! `imp build FILE -o kernel.o --header kernel.h --rust kernel.rs` compiles ahead of time, and [`build()`] does in a build script.
//! The program that is shipped then has the machine code alone: no Cranelift, no Imp, no allocation. `examples/projects/`
//! and `examples/embedding/` have programs in Rust, C and Python.
//!
//! ## Below the library
//!
//! [`session::compile`] takes a source through all stages up to a scene and keeps each of them, [`interval`] is an interval
//! arithmetic of its own, and [`kernel`] is what all consumers call:
//!
//! ```
//! use imp::Interval;
//!
//! let tenth = Interval::from_rational(&"1/10".parse().expect("a rational number"));
//! assert!(tenth.lo() < tenth.hi());
//! let x = Interval::try_from(-1.0..=2.0)?;
//! assert_eq!(x.sqr(), Interval::try_from(0.0..=4.0)?);
//! # Ok::<(), imp::Error>(())
//! ```
//!
//! # Layers
//!
//! A module imports only modules of a smaller number, and `tests/architecture.rs` holds that. Equal numbers do not see
//! each other: the ray caster never learns that Cranelift exists, and the code generator never learns what a pixel is.
//!
//! | no. | modules |
//! |---|---|
//! | 0 | [`diagnostic`]: where source text lives, messages; [`interval`]: intervals, decorations, affine forms; [`control`]: progress and cancellation; [`limits`]: what a source may cost |
//! | 1 | [`graph`]: hash-consed SSA over exact real operations; [`syntax`]: tokens, grammar, tree, no meaning; [`envelope`]: files of certificates; [`limits`]: what a source may cost |
//! | 2 | [`program`]: names, kinds, modules, the standard library, scenes; [`passes`]: folding and rewriting |
//! | 3 | [`mod@derive`]: gradients, formulas along rays, interval and affine programs of lanes |
//! | 4 | [`kernel`]: what consumers call: packets of boxes in, enclosures and verdicts out |
//! | 5 | [`interpret`]: the reference kernel; [`codegen`]: the compiled ones; [`render`]: pictures and their proofs; [`arrange`]: arrangements of curves; [`roots`]: all zeros of a function |
//! | 6 | [`session`]: source to scene in one function, and the choice of the backend; [`accuracy`]: what accuracy costs |
//! | 7 | [`library`]: what other programs call; [`repl`]: calculating with boxes interactively |
//! | 8 | [`mod@build`]: kernels ahead of time |
//! | 9 | [`cli`]: the `imp` command |
//!
//! # What holds everywhere
//!
//! - A value is a set until someone asks for a point: constants are exact in the graph and enclosed in kernels.
//! - An interval question has three answers, and "unknown" is never shown as "proved".
//! - Derivations and rewrites may tighten an enclosure; they never lose a point and never forget where a value is
//!   undefined. A row that would needs a side condition, which bounds over the domain prove.
//! - Directed rounding is named in one place for Rust ([`interval::round`]) and one for machine code (`codegen`).
//! - No input makes it panic. What a user can get wrong is a diagnostic; the exceptions are documented contracts between
//!   modules.

pub mod accuracy;
pub mod arrange;
pub mod build;
pub mod cli;
pub mod codegen;
pub mod control;
pub mod derive;
pub mod diagnostic;
pub mod envelope;
pub mod graph;
pub mod interpret;
pub mod interval;
pub mod kernel;
pub mod library;
pub mod limits;
pub mod passes;
pub mod program;
pub mod render;
pub mod repl;
pub mod roots;
pub mod session;
pub mod syntax;

pub use build::build;
pub use derive::Rounding;
pub use imp_runtime::include_kernels;
pub use interval::Interval;
pub use library::Columns;
pub use library::Enclosure;
pub use library::Error;
pub use library::Function;
pub use library::IntervalKernel;
pub use library::Loader;
pub use library::Options;
pub use library::PointKernel;
pub use library::Program;
pub use library::RayFinder;
pub use library::RootFinder;
pub use library::Verdict;
pub use limits::Limits;
