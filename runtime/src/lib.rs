//! What a program needs to call kernels that Imp compiled ahead of time: plain types, `no_std`, no dependencies, and
//! [`include_kernels!`], which brings in the functions that a build script generated.
//!
//! ```toml
//! [dependencies]
//! imp = { package = "imp-runtime", version = "0.1" }
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
//! // main.rs
//! imp::include_kernels!();
//!
//! fn main() {
//!     let bound = kernels::f::interval([imp::Interval::new(0.0, 1.0), imp::Interval::new(0.0, 1.0)]);
//!     println!("{bound}");
//! }
//! ```
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
