//! What a parsed file means: names, kinds, modules and the standard library; AST to graph and [`scene::Scene`].
//!
//! [`resolve()`], [`resolve_expression`] and [`resolve_functions`] are the ways in. In the order of the work:
//!
//! - `import`, `stdlib`, `names`, `scan`: all files, what each name means, and an order of evaluation;
//! - `values`, `lower`, `algebra`, `call`, `exponent`: expressions to graph values, with every function inlined;
//! - `settings`, `domain`, `enclose`: the scene around the formulas;
//! - `errors`: every message, in one place.

mod algebra;
mod builtins;
mod call;
mod domain;
mod enclose;
mod errors;
mod exponent;
mod export;
mod import;
mod lower;
mod names;
mod resolve;
mod scan;
pub mod scene;
mod settings;
mod stdlib;
mod values;

pub use builtins::BUILTINS;
pub use builtins::Builtin;
pub use builtins::TIME;
pub use export::Function;
pub use export::Functions;
pub use export::Refused;
pub use export::resolve_functions;
pub use export::with_expression;
pub use import::Embedded;
pub use import::FileSystem;
pub use import::Importer;
pub use resolve::Context;
pub use resolve::Differentiate;
pub use resolve::Expression;
pub use resolve::resolve;
pub use resolve::resolve_constant;
pub use resolve::resolve_expression;
pub use scene::Scene;
pub use settings::SETTINGS;
pub use settings::Setting;
pub use stdlib::LibraryDoc;
pub use stdlib::stdlib_docs;
