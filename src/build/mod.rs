//! Kernels ahead of time: objects, static libraries, and the text with which C and Rust programs call them. Nothing of Imp
//! is in such a program.

mod archive;
mod export;
mod header;
mod interface;
mod names;
mod rust;
mod script;

pub use crate::codegen::object::Level;
pub use crate::derive::Precision;
pub use export::Export;
pub use export::Selection;
pub use export::static_library;
pub use interface::Kernel;
pub use script::Build;
pub use script::all_levels;
pub use script::build;
