//! The zero set of a field as a union of pieces.

use crate::graph::Graph;
use crate::graph::Value;
use crate::interval::Interval;

/// Part of a zero set: the points where `field` is 0 and `condition` holds.
pub struct Piece {
    pub field: Value,
    /// A truth value (0 or 1) that must be 1; `None`: no condition.
    pub condition: Option<Value>,
    /// Values at whose zeros the condition may change its truth: between them it is constant.
    pub atoms: Vec<Value>,
}

/// The field itself, until its factors are taken apart.
pub fn zero_set(_: &mut Graph, field: Value, condition: Option<Value>, _: &[Interval]) -> Vec<Piece> {
    vec![Piece { field, condition, atoms: Vec::new() }]
}
