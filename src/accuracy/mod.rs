//! What accuracy costs: a scene rendered at many levels of accuracy and measured against a reference of much higher
//! accuracy, or an expression enclosed in every way that Imp knows.
//!
//! [`of_scene`] and [`of_expression`] measure; their results are plain data, serialised once: the JSON of `imp cost` is
//! the data, its tables, charts and pages (`report`) are views of it.

mod expression;
pub mod finder;
mod level;
mod number;
mod pareto;
mod picture;
mod range;
pub mod report;
mod scene;
mod truth;

pub use expression::Enclosed;
pub use expression::ExpressionCost;
pub use expression::Method;
pub use expression::Subject;
pub use expression::of_expression;
pub use level::Selection;
pub use scene::Measured;
pub use scene::Outcome;
pub use scene::Reference;
pub use scene::Request;
pub use scene::Row;
pub use scene::SceneCost;
pub use scene::of_scene;
pub use truth::Errors;

/// Watches measuring: called with steps done, steps in all and what comes next.
pub type Progress<'a> = &'a dyn Fn(usize, usize, &str);
