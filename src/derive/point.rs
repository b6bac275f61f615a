//! Points: one lane a value, rounded to nearest, nothing proved. For normals and shading.

use crate::derive::Output;
use crate::derive::Precision;
use crate::derive::Spec;
use crate::derive::elementary;
use crate::derive::lanes::Builder;
use crate::derive::lanes::Lane;
use crate::derive::lanes::LaneOp;
use crate::derive::lanes::LaneProgram;
use crate::graph::Node;
use crate::graph::Op;
use crate::graph::Value;
use crate::graph::elementary_function;
use crate::interval::Decorated;
use crate::limits::Budget;
use crate::limits::Exceeded;

/// Lowers a spec with point arithmetic. Constants are the midpoints of their enclosures.
pub fn lower(
    spec: &Spec,
    bounds: &[Decorated],
    precision: Precision,
    budget: &Budget,
) -> Result<LaneProgram, Exceeded> {
    let roots: Vec<Value> = spec.outputs.iter().map(|output| output.value()).collect();
    let needed = spec.graph.reachable(&roots);
    let mut b = Builder::new(precision);
    let mut lanes: Vec<Option<Lane>> = vec![None; spec.graph.len()];
    for (value, node) in spec.graph.iter().filter(|(v, _)| needed[v.index()]) {
        budget.tick()?;
        budget.operations(b.count())?;
        let operands: Vec<Lane> =
            node.operands().iter().map(|v| lanes[v.index()].expect("operands are lowered first")).collect();
        let constant = node.op != Op::Entire && operands.iter().all(|&lane| b.as_number(lane).is_some());
        let lane = match node.op {
            Op::Var(id) => input(spec, &mut b, &spec.graph.variables()[id as usize]),
            _ if constant => b.near(bounds[value.index()].interval().mid()),
            _ => operation(&mut b, node, &operands),
        };
        lanes[value.index()] = Some(lane);
    }
    let outputs = spec
        .outputs
        .iter()
        .map(|output| {
            debug_assert!(matches!(output, Output::Value(_)), "points have values only");
            lanes[output.value().index()].expect("outputs are reachable")
        })
        .collect();
    Ok(b.finish(spec.inputs.len(), spec.uniforms.len(), outputs))
}

fn input(spec: &Spec, b: &mut Builder, name: &str) -> Lane {
    let slot = |list: &[String]| list.iter().position(|n| n == name).map(|i| i as u32);
    match (slot(&spec.inputs), slot(&spec.uniforms)) {
        (Some(i), _) => b.push(LaneOp::Input(i)),
        (None, Some(i)) => b.push(LaneOp::Uniform(i)),
        (None, None) => b.number(f64::NAN),
    }
}

fn operation(b: &mut Builder, node: &Node, operands: &[Lane]) -> Lane {
    let x = operands.first().copied().unwrap_or_else(|| b.zero());
    let y = operands.get(1).copied().unwrap_or(x);
    let zero = b.zero();
    match node.op {
        Op::Neg => b.neg(x),
        Op::Add => b.add(x, y),
        Op::Sub => b.sub(x, y),
        Op::Mul => b.mul(x, y),
        Op::Div => b.div(x, y),
        Op::Sqr => b.mul(x, x),
        Op::Abs => b.abs(x),
        Op::Sqrt => b.sqrt(x),
        Op::PowInt(n) => {
            let power = power(b, x, n.unsigned_abs());
            if n >= 0 {
                power
            } else {
                let one = b.number(1.0);
                b.div(one, power)
            }
        }
        Op::Min => b.min(x, y),
        Op::Max => b.max(x, y),
        Op::Hypot => {
            let (x2, y2) = (b.mul(x, x), b.mul(y, y));
            let sum = b.add(x2, y2);
            b.sqrt(sum)
        }
        Op::Floor => b.floor(x),
        Op::Ceil => b.push(LaneOp::Ceil(x)),
        Op::Round => b.round(x),
        Op::Sign => b.sign(x),
        Op::Mod => {
            let quotient = b.div(x, y);
            let whole = b.floor(quotient);
            let multiple = b.mul(y, whole);
            b.sub(x, multiple)
        }
        Op::Less | Op::LessEqual | Op::Equal => {
            let holds = match node.op {
                Op::Less => b.less(x, y),
                Op::LessEqual => b.less_equal(x, y),
                _ => b.equal(x, y),
            };
            let one = b.number(1.0);
            b.select(holds, one, zero)
        }
        Op::Select | Op::SelectJump => {
            let holds = b.less(zero, x);
            b.select(holds, y, operands[2])
        }
        Op::Kink => {
            let below = b.less(x, zero);
            b.select(below, y, operands[2])
        }
        Op::Entire => b.number(f64::NAN),
        Op::PowRatio(..) | elementary_function!() | Op::Pow | Op::Atan2 => elementary::point(b, node.op, operands),
        Op::Const(_) | Op::Var(_) | Op::Pi => unreachable!("{} is lowered elsewhere", node.op.name()),
    }
}

fn power(b: &mut Builder, x: Lane, n: u32) -> Lane {
    let mut square = x;
    let mut result: Option<Lane> = None;
    let mut rest = n;
    while rest > 0 {
        if rest % 2 == 1 {
            result = Some(result.map_or(square, |r| b.mul(r, square)));
        }
        rest /= 2;
        if rest > 0 {
            square = b.mul(square, square);
        }
    }
    result.unwrap_or_else(|| b.number(1.0))
}
