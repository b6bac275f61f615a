//! What other programs link: source text to functions, functions to kernels, kernels to bounds and values. Everything here
//! is at the root of the crate, too.

mod enclosure;
mod error;
mod function;
mod interval_kernel;
mod kernel;
mod point_kernel;
mod program;
mod root_finder;

pub use enclosure::Enclosure;
pub use enclosure::Verdict;
pub use error::Error;
pub use error::Report;
pub use function::Function;
pub use function::Options;
pub use interval_kernel::Columns;
pub use interval_kernel::IntervalKernel;
pub use kernel::Compile;
pub use point_kernel::PointKernel;
pub use program::Loader;
pub use program::Program;
pub use program::Refused;
pub use root_finder::RayFinder;
pub use root_finder::RootFinder;
