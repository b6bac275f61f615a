//! How large the *computed* ends of every value can be: the license to leave the 0 inf guard out of a product.
//!
//! The bounds over the domain enclose the real values; computed ends lie further out by rounding. This analysis follows
//! the computed ends themselves: each operation's largest result from its operands' largest, widened by more than the
//! operation can round. It knows only operations whose ends are bounded by their operands' ends; for all others the
//! answer is infinite, which costs a guard and no soundness.

use crate::derive::Precision;
use crate::derive::Spec;
use crate::graph::Op;
use crate::interval::Decorated;

/// Relative and absolute slack of one operation: at least one rounding of the precision, and the smallest number.
const SLACK: f64 = 1.0 + 1.0 / (1u64 << 20) as f64;
const TINY: f64 = 1e-37;

/// For every value an upper bound of the magnitude of its computed ends, or infinity.
pub fn bounds(spec: &Spec, real: &[Decorated], precision: Precision) -> Vec<f64> {
    let limit = match precision {
        Precision::Single => f64::from(f32::MAX) / 4.0,
        Precision::Double => f64::MAX / 4.0,
    };
    let mut magnitudes: Vec<f64> = Vec::with_capacity(spec.graph.len());
    let mut constant: Vec<bool> = Vec::with_capacity(spec.graph.len());
    for (value, node) in spec.graph.iter() {
        let at = |i: usize| magnitudes[node.operands()[i].index()];
        let own = real[value.index()].interval();
        let computed = match node.op {
            Op::Const(_) | Op::Pi => own.mag(),
            Op::Var(id) => input(spec, &spec.graph.variables()[id as usize]),
            Op::Neg | Op::Abs => at(0),
            Op::Add | Op::Sub => at(0) + at(1),
            Op::Mul => at(0) * at(1),
            Op::Sqr => at(0) * at(0),
            // Each of the n factors brings its own slack.
            Op::PowInt(n) if n >= 0 => (at(0) * SLACK).powi(n),
            Op::Sqrt => at(0).sqrt(),
            Op::Min | Op::Max => at(0).max(at(1)),
            Op::Hypot => at(0).hypot(at(1)),
            Op::Sin | Op::Cos | Op::Tanh | Op::Sign | Op::Less | Op::LessEqual | Op::Equal => 1.0,
            Op::Asin | Op::Acos | Op::Atan | Op::Atan2 => 4.0,
            Op::Floor | Op::Ceil | Op::Round => at(0) + 1.0,
            Op::Mod => at(1),
            Op::Select | Op::Kink => at(1).max(at(2)),
            Op::Exp => at(0).exp() * 2.0,
            Op::Exp2 => at(0).exp2() * 2.0,
            Op::Sinh | Op::Cosh | Op::Expm1 => at(0).exp() * 2.0 + 1.0,
            Op::PowInt(_)
            | Op::PowRatio(..)
            | Op::Cbrt
            | Op::Exp10
            | Op::Ln
            | Op::Log1p
            | Op::Log2
            | Op::Log10
            | Op::Tan
            | Op::Asinh
            | Op::Acosh
            | Op::Atanh
            | Op::Div
            | Op::Pow
            | Op::SelectJump
            | Op::Entire => f64::INFINITY,
        };
        // A constant subgraph is stored as its enclosure, whatever computes it.
        let is_constant = !matches!(node.op, Op::Var(_) | Op::Entire)
            && node.operands().iter().all(|operand| constant[operand.index()]);
        constant.push(is_constant);
        let computed = if is_constant && !own.is_empty() { own.mag() } else { computed };
        // A clipped value is as large as its range, whatever computes it.
        let clipped = spec.domain.iter().filter(|(v, _)| *v == value).map(|(_, range)| range.mag());
        let computed = clipped.fold(computed, f64::min);
        let widened = computed * SLACK + TINY;
        magnitudes.push(if widened < limit { widened } else { f64::INFINITY });
    }
    magnitudes
}

/// A promised input is as large as its promise.
fn input(spec: &Spec, name: &str) -> f64 {
    let promised = spec.promises.iter().filter(|(n, _)| n == name).map(|(_, range)| range.mag());
    promised.fold(f64::INFINITY, f64::min)
}
