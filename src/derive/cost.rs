//! What an operation costs: operations on `f64` numbers, counted and not timed, so that the choice of an arithmetic is
//! the same on every machine. Bounds rounded down and up count as two operations.

use crate::derive::Symbols;
use crate::graph::Graph;
use crate::graph::Op;
use crate::graph::Value;
use crate::graph::elementary_function;

/// An interval product of unknown signs: eight multiplications, six minima and maxima.
pub const PRODUCT: u64 = 14;
/// An elementary function of one number: reduction, polynomial, reconstruction.
const ELEMENTARY: u64 = 25;
/// An elementary function of an interval: both ends.
const FUNCTION: u64 = 2 * ELEMENTARY;

/// The natural extension of all that the roots need.
pub fn natural(graph: &Graph, roots: &[Value]) -> u64 {
    let needed = graph.reachable(roots);
    graph.iter().filter(|(value, _)| needed[value.index()]).map(|(_, node)| interval(node.op)).sum()
}

/// How many operations the root needs, without inputs and constants.
pub fn steps(graph: &Graph, root: Value) -> u64 {
    let needed = graph.reachable(&[root]);
    graph.iter().filter(|(value, node)| needed[value.index()] && node.op.arity() > 0).count() as u64
}

/// Affine forms alone: each operation on forms of as many coefficients as they can have.
pub fn affine(graph: &Graph, root: Value, symbols: Symbols) -> u64 {
    let needed = graph.reachable(&[root]);
    // Which operations brought a symbol that a value's form can have, 64 to a word.
    let mut sets: Vec<Vec<u64>> = vec![Vec::new(); graph.len()];
    let mut sum = 0;
    for (value, node) in graph.iter().filter(|(value, _)| needed[value.index()]) {
        let count = match symbols {
            Symbols::One => 1,
            Symbols::Two => 2,
            Symbols::Three => 3,
            Symbols::Full => {
                let mut set = vec![0; value.index() / 64 + 1];
                for operand in node.operands() {
                    set.iter_mut().zip(&sets[operand.index()]).for_each(|(own, theirs)| *own |= theirs);
                }
                let count = set.iter().map(|word| u64::from(word.count_ones())).sum();
                // Every operation can bring a symbol of its own, be it for a rounding.
                set[value.index() / 64] |= 1 << (value.index() % 64);
                sets[value.index()] = set;
                count
            }
        };
        sum += form(node.op, count);
    }
    sum
}

/// One operation on intervals.
fn interval(op: Op) -> u64 {
    match op {
        Op::Const(_) | Op::Var(_) | Op::Pi | Op::Entire => 0,
        Op::Neg | Op::Abs | Op::Sign | Op::Floor | Op::Ceil | Op::Round | Op::Min | Op::Max => 2,
        Op::Add | Op::Sub | Op::Less | Op::LessEqual | Op::Equal | Op::Select | Op::Kink | Op::SelectJump => 2,
        Op::Sqr | Op::Sqrt => 4,
        // Squarings and products of both ends.
        Op::PowInt(n) => 2 * u64::from(2 * n.unsigned_abs().max(1).ilog2() + 1),
        Op::Mul | Op::Div => PRODUCT,
        Op::Mod => 2 * PRODUCT,
        Op::Hypot => 10,
        Op::PowRatio(..) | Op::Pow | Op::Atan2 => 2 * FUNCTION,
        elementary_function!() => FUNCTION,
    }
}

/// One operation on forms of `n` coefficients.
fn form(op: Op, n: u64) -> u64 {
    // A number rounded both ways with the difference added to the error: four operations. The range of a form: a sum of
    // sizes and two ends.
    let (rounded, range) = (4, n + 3);
    // c + sum a_i e_i + r scaled and shifted.
    let scaled = rounded * (n + 2) + 3;
    let product = 2 * range + (2 * rounded) * (n + 1) + 6;
    // The range of the operand, the function and its slope at both ends and at the touching point, their differences to
    // the line.
    let approximated = range + 3 * FUNCTION + 20 + scaled;
    match op {
        Op::Const(_) | Op::Var(_) | Op::Pi | Op::Entire => 0,
        Op::Neg => n + 1,
        Op::Add | Op::Sub => rounded * (n + 1) + 1,
        Op::Mul => product,
        Op::Sqr | Op::PowInt(_) | Op::Sqrt | Op::Abs => range + 30 + scaled,
        Op::Min | Op::Max => 2 * rounded * (n + 1) + range + 30 + scaled,
        Op::Div => range + 30 + scaled + product,
        Op::Hypot => 3 * (range + 30 + scaled) + rounded * (n + 1),
        Op::Pow => 2 * approximated + product,
        Op::Atan2 => range + 30 + scaled + product + approximated,
        Op::Sign
        | Op::Floor
        | Op::Ceil
        | Op::Round
        | Op::Mod
        | Op::Less
        | Op::LessEqual
        | Op::Equal
        | Op::Select
        | Op::Kink
        | Op::SelectJump => range + interval(op) + 4,
        Op::PowRatio(..) | elementary_function!() => approximated,
    }
}
