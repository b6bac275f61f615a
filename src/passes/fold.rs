//! Exact constant folding.

use num_rational::BigRational;
use num_traits::One;
use num_traits::Zero;

use super::builder::Builder;
use super::exact::exact;
use crate::graph::Op;
use crate::graph::Value;

/// An operation on rational numbers becomes its value where that is rational, and a selection whose condition is a number
/// becomes the selected arm, whatever the other arm is: it contributes neither value nor domain.
pub fn rewrite(g: &mut Builder, op: Op, operands: &[Value]) -> Option<Value> {
    if let (Op::Select | Op::SelectJump, &[condition, yes, no]) = (op, operands) {
        let condition = g.number(condition)?;
        return if condition.is_one() { Some(yes) } else { condition.is_zero().then_some(no) };
    }
    if operands.is_empty() {
        return None;
    }
    let numbers: Vec<&BigRational> = operands.iter().map(|&v| g.number(v)).collect::<Option<_>>()?;
    let value = exact(op, &numbers)?;
    Some(g.constant(value))
}
