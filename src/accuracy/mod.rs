//! What each level of accuracy costs.

pub mod finder;
