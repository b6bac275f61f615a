//! What a program needs to call kernels that Imp compiled ahead of time: plain types, `no_std`, no dependencies, and
//! [`include_kernels!`], which brings in the functions that a build script generated.
//!
//! ```toml
//! [dependencies]
//! imp-runtime = "0.1"
//!
//! [build-dependencies]
//! imp = "0.1"
//! ```
//!
//! ```text
//! // build.rs
//! fn main() -> Result<(), imp::Error> {
//!     imp::build(["kernels.imp"])
//! }
//!
//! // main.rs, where kernels.imp has a function f(x, y)
//! use imp_runtime::Interval;
//!
//! imp_runtime::include_kernels!();
//!
//! fn main() {
//!     let bound = kernels::f::interval([Interval::new(0.0, 1.0), Interval::point(2.0)]);
//!     println!("{bound}");
//! }
//! ```
//!
//! A program that has the whole of Imp among its dependencies finds the macro there, too: `imp::include_kernels!()`.
#![no_std]
#![warn(missing_docs)]

mod types;

pub use types::*;

/// The text of the types, which `imp build --rust` puts into the file that it writes, so that this needs no crate.
pub const SOURCE: &str = include_str!("types.rs");

/// The modules that `imp::build` generated in the build script of this package: one for each `.imp` file, in it one for
/// each function.
#[macro_export]
macro_rules! include_kernels {
    () => {
        #[allow(unused_imports)]
        use $crate as imp_types;
        include!(concat!(env!("OUT_DIR"), "/imp_kernels.rs"));
    };
}
