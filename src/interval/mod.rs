//! Placeholder until the arithmetic lands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval;
