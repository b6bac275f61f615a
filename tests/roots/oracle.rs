//! Signs of formulas at numbers, to 320 bits.

use astro_float::BigFloat;
use astro_float::Consts;
use astro_float::Radix;
use astro_float::RoundingMode;
use imp::graph::Graph;
use imp::graph::Op;
use imp::graph::Value;

const P: usize = 320;
const RM: RoundingMode = RoundingMode::None;

/// The value of a function of x alone; `None` where it is undefined.
pub fn value(graph: &Graph, f: Value, x: f64, cc: &mut Consts) -> Option<BigFloat> {
    let mut values: Vec<Option<BigFloat>> = Vec::new();
    for (value, node) in graph.iter() {
        let operand = |i: usize| values[node.operands()[i].index()].clone();
        values.push(match (node.op, graph.as_constant(value)) {
            (_, Some(number)) => {
                let mut whole = |text: String| BigFloat::parse(&text, Radix::Dec, P, RM, cc);
                let (above, below) = (whole(number.numer().to_string()), whole(number.denom().to_string()));
                Some(above.div(&below, P, RM))
            }
            (Op::Var(_), _) => Some(BigFloat::from_f64(x, P)),
            (op, _) if op.arity() == 1 => operand(0).and_then(|x| unary(op, &x, cc)),
            (op, _) => operand(0).zip(operand(1)).and_then(|(x, y)| binary(op, &x, &y)),
        });
    }
    values.swap_remove(f.index())
}

/// The sign of that value: -1, 0 or 1; `None` too if it is lost in the rounding errors of the oracle.
pub fn sign(graph: &Graph, f: Value, x: f64, cc: &mut Consts) -> Option<i32> {
    let value = value(graph, f, x, cc)?;
    let doubt = BigFloat::from_f64(2f64.powi(-200), P);
    match () {
        _ if value.is_zero() => Some(0),
        _ if value.abs().cmp(&doubt)? < 0 => None,
        _ if value.is_negative() => Some(-1),
        _ => Some(1),
    }
}

fn unary(op: Op, x: &BigFloat, cc: &mut Consts) -> Option<BigFloat> {
    let positive = x.is_positive() && !x.is_zero();
    Some(match op {
        Op::Neg => x.neg(),
        Op::Sqr => x.mul(x, P, RM),
        Op::PowInt(n) if n >= 0 => (0..n).fold(BigFloat::from_f64(1.0, P), |power, _| power.mul(x, P, RM)),
        Op::Abs => x.abs(),
        Op::Sqrt if positive || x.is_zero() => x.sqrt(P, RM),
        Op::Ln if positive => x.ln(P, RM, cc),
        Op::Exp => x.exp(P, RM, cc),
        Op::Sin => x.sin(P, RM, cc),
        Op::Cos => x.cos(P, RM, cc),
        Op::Atan => x.atan(P, RM, cc),
        Op::Tanh => x.tanh(P, RM, cc),
        _ => return None,
    })
}

fn binary(op: Op, x: &BigFloat, y: &BigFloat) -> Option<BigFloat> {
    let less = x.cmp(y)? < 0;
    Some(match op {
        Op::Add => x.add(y, P, RM),
        Op::Sub => x.sub(y, P, RM),
        Op::Mul => x.mul(y, P, RM),
        Op::Div if !y.is_zero() => x.div(y, P, RM),
        Op::Min => if less { x } else { y }.clone(),
        Op::Max => if less { y } else { x }.clone(),
        _ => return None,
    })
}
