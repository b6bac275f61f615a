//! Kernels ahead of time.

pub mod header;
pub mod interface;
mod names;
pub mod rust;
