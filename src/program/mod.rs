//! See the crate documentation.

pub mod scene;
