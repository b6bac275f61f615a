//! See the crate documentation.
mod exact;
