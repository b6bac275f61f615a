//! Imp compiles formulas to native interval code.
//!
//! Layers, lowest first; a module imports only modules of a smaller number, and `tests/architecture.rs` holds that.
//!
//! | no. | modules |
//! |---|---|
//! | 0 | [`diagnostic`], [`interval`] |
//! | 1 | [`graph`], [`syntax`] |
//! | 2 | [`program`], [`passes`] |
//! | 3 | [`mod@derive`] |
//! | 4 | [`kernel`] |
//! | 5 | [`interpret`], [`codegen`], [`render`] |
//! | 6 | [`session`] |
//! | 7 | [`cli`] |

pub mod cli;
pub mod codegen;
pub mod derive;
pub mod diagnostic;
pub mod graph;
pub mod interpret;
pub mod interval;
pub mod kernel;
pub mod passes;
pub mod program;
pub mod render;
pub mod session;
pub mod syntax;
