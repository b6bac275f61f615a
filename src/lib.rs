//! Imp compiles formulas to native interval code: implicit surfaces and curves with proofs.
//!
//! # A tour
//!
//! [`session::compile`] takes a file or a text through all stages up to a scene and keeps each of them:
//!
//! ```
//! use imp::session::{self, Source};
//!
//! let text = "param r = 1 in [0.5, 2]\nsurface ball: x^2 + y^2 + z^2 = r^2";
//! let artefact = session::compile(Source::Text { name: "ball.imp", text }, &[]);
//! let scene = artefact.scene.expect("this is a scene");
//! assert_eq!(scene.shapes[0].name, "ball");
//! ```
//!
//! A mistake is a [`diagnostic::Diagnostic`], which knows its place and often an edit to try:
//!
//! ```
//! use imp::diagnostic;
//! use imp::session::{self, Source};
//!
//! let artefact = session::compile(Source::Text { name: "wave.imp", text: "z = sin 2x" }, &[]);
//! let said = diagnostic::render(&artefact.sources, &artefact.diagnostics, false);
//! assert!(said.contains("wave.imp:1:5") && said.contains("write `sin(2x)`"));
//! ```
//!
//! [`render::Renderer`] compiles the kernels that a picture needs, once for all values of the parameters, and says of every
//! pixel what is proved:
//!
//! ```
//! use imp::render::{Certainty, Control, Options, Renderer};
//! use imp::session::{self, Source};
//!
//! let artefact = session::compile(Source::Text { name: "ball.imp", text: "x^2 + y^2 + z^2 = 1" }, &[]);
//! let scene = artefact.scene.expect("this is a scene");
//! let options = Options { width: 64, height: 64, ..Options::default() };
//! let renderer = Renderer::new(&scene, &options, session::backend())?;
//! let picture = renderer.render(&scene.parameters, &Control::default())?;
//! assert_eq!(picture.certainty[picture.index(32, 32)], Certainty::Hit);
//! assert_eq!(picture.certainty[picture.index(0, 0)], Certainty::Miss);
//! let png: Vec<u8> = imp::render::image::png(&picture, imp::render::image::Layer::Color);
//! # Ok::<(), imp::diagnostic::Diagnostic>(())
//! ```
//!
//! Below that, [`interval`] is an interval arithmetic of its own:
//!
//! ```
//! use imp::interval::Interval;
//!
//! let tenth = Interval::from_rational(&"1/10".parse().expect("a rational number"));
//! assert!(tenth.lo() < tenth.hi());
//! let x = Interval::new(-1.0, 2.0).expect("the ends are in order");
//! assert_eq!(x.sqr(), Interval::new(0.0, 4.0).expect("the ends are in order"));
//! ```
//!
//! # Layers
//!
//! A module imports only modules of a smaller number, and `tests/architecture.rs` holds that. Equal numbers do not see
//! each other: the ray caster never learns that Cranelift exists, and the code generator never learns what a pixel is.
//!
//! | no. | modules |
//! |---|---|
//! | 0 | [`diagnostic`]: where source text lives, messages; [`interval`]: intervals, decorations, affine forms; [`control`]: progress and cancellation |
//! | 1 | [`graph`]: hash-consed SSA over exact real operations; [`syntax`]: tokens, grammar, tree, no meaning; [`envelope`]: files of certificates |
//! | 2 | [`program`]: names, kinds, modules, the standard library, scenes; [`passes`]: folding and rewriting |
//! | 3 | [`mod@derive`]: gradients, formulas along rays, interval and affine programs of lanes |
//! | 4 | [`kernel`]: what consumers call: packets of boxes in, enclosures and verdicts out |
//! | 5 | [`interpret`]: the reference kernel; [`codegen`]: the compiled ones; [`render`]: pictures and their proofs; [`arrange`]: arrangements of curves; [`roots`]: all zeros of a function |
//! | 6 | [`session`]: source to scene in one function, and the choice of the backend; [`accuracy`]: what accuracy costs |
//! | 7 | [`repl`]: calculating with boxes interactively |
//! | 8 | [`cli`]: the `imp` command |
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
pub mod passes;
pub mod program;
pub mod render;
pub mod repl;
pub mod roots;
pub mod session;
pub mod syntax;
