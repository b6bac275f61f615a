//! Functions with jumps: the constants between them, and where they are.

use num_rational::BigRational;
use num_traits::One;

use super::guard::Guard;
use super::guard::Guards;
use super::guard::Sign;
use super::space::Space;
use crate::graph::Op;
use crate::graph::Value;

/// Steps beyond are not numbered: all whole numbers up to here are exact in double precision.
const WHOLE: f64 = 9_007_199_254_740_992.0;

/// A field with what holds beside.
#[derive(Debug, Clone)]
pub struct Branch {
    pub field: Value,
    pub guards: Guards,
}

/// One of the values that a function takes between jumps.
struct Case {
    value: Value,
    guards: Vec<Guard>,
}

/// The first operation with jumps that the field needs, replaced by each of the values that it takes; `None` if there is
/// none, or if all of them together take more than `room` values.
pub fn split(space: &mut Space, branch: &Branch, room: usize) -> Option<Vec<Branch>> {
    let jumps: Vec<Value> = jumps(space, branch.field);
    let mut total = 1usize;
    for &jump in &jumps {
        total = total.checked_mul(count(space, jump)?).filter(|&total| total <= room)?;
    }
    // Arms of a selection come after it: where they are not selected, nothing in them need be defined.
    let outside = space.below(branch.field, |op, _| op == Op::Select);
    let first = *jumps.iter().find(|jump| outside.contains(jump))?;
    let replaced = match space.shape(first) {
        // Whatever else depends on the condition is decided with it.
        (Op::Select, &[condition, ..]) => condition,
        _ => first,
    };
    let mut branches = Vec::new();
    for case in cases(space, first)? {
        let field = space.substitute(branch.field, replaced, case.value);
        let mut guards = Guards::default();
        let old = branch.guards.0.iter().map(|&guard| match guard {
            Guard::Sign(sign, value) => Guard::Sign(sign, space.substitute(value, replaced, case.value)),
            Guard::Truth(value) => Guard::Truth(space.substitute(value, replaced, case.value)),
        });
        let old: Vec<Guard> = old.collect();
        if guards.assume_all(space, old).and_then(|()| guards.assume_all(space, case.guards)).is_some() {
            branches.push(Branch { field, guards });
        }
    }
    Some(branches)
}

/// Operations with jumps below a value, operands before users; nothing inside conditions and comparisons, which are split as
/// wholes.
fn jumps(space: &Space, value: Value) -> Vec<Value> {
    let comparison = |op: Op| matches!(op, Op::Less | Op::LessEqual | Op::Equal);
    let below = space.below(value, |op, place| comparison(op) || op == Op::Select && place == 0);
    let jump = |&v: &Value| {
        let op = space.shape(v).0;
        comparison(op) || matches!(op, Op::Select | Op::Sign | Op::Floor | Op::Ceil | Op::Round | Op::Mod)
    };
    below.into_iter().filter(jump).collect()
}

/// The whole numbers in the enclosure of a value.
fn steps(space: &Space, value: Value) -> Option<std::ops::RangeInclusive<i64>> {
    let range = space.enclosure(value);
    let inside = range.lo() >= -WHOLE && range.hi() <= WHOLE;
    inside.then(|| range.lo() as i64..=range.hi() as i64)
}

/// How many values an operation with jumps takes between them.
fn count(space: &mut Space, value: Value) -> Option<usize> {
    let steps = match space.taken(value) {
        (Op::Mod, operands) => {
            let floor = quotient_floor(space, &operands);
            steps(space, floor)?
        }
        (Op::Select | Op::Less | Op::LessEqual | Op::Equal, _) => return Some(2),
        _ => steps(space, value)?,
    };
    usize::try_from(steps.end() - steps.start() + 1).ok()
}

/// floor(x / y)
fn quotient_floor(space: &mut Space, operands: &[Value]) -> Value {
    let quotient = space.push(Op::Div, operands);
    space.unary(Op::Floor, quotient)
}

/// The values that an operation takes, each with where it does.
fn cases(space: &mut Space, value: Value) -> Option<Vec<Case>> {
    let (op, operands) = space.taken(value);
    let half = BigRational::new(1.into(), 2.into());
    if let Op::Select | Op::Less | Op::LessEqual | Op::Equal = op {
        let truth = if op == Op::Select { operands[0] } else { value };
        let (zero, one) = (space.int(0), space.int(1));
        let negated = space.binary(Op::Sub, one, truth);
        let case = |value: Value, truth: Value| Case { value, guards: vec![Guard::Truth(truth)] };
        return Some(vec![case(one, truth), case(zero, negated)]);
    }
    let u = operands[0];
    let range = match op {
        Op::Mod => {
            let floor = quotient_floor(space, &operands);
            steps(space, floor)?
        }
        _ => steps(space, value)?,
    };
    let mut cases = Vec::new();
    for k in range {
        let number = BigRational::from_integer(k.into());
        // (lower bound, whether it belongs to the step), (upper bound, likewise)
        let (lo, hi) = match op {
            Op::Floor => ((number.clone(), true), (&number + BigRational::one(), false)),
            Op::Ceil => ((&number - BigRational::one(), false), (number.clone(), true)),
            // Halves away from zero.
            Op::Round => ((&number - &half, k > 0), (&number + &half, k < 0)),
            Op::Sign => {
                let guard = match k {
                    0 => {
                        let zero = space.int(0);
                        Guard::Truth(space.binary(Op::Equal, zero, u))
                    }
                    _ => Guard::Sign(Sign::Positive, space.times(&number, u)),
                };
                cases.push(Case { value: space.constant(number), guards: vec![guard] });
                continue;
            }
            Op::Mod => {
                cases.push(remainder(space, u, operands[1], number));
                continue;
            }
            _ => return None,
        };
        let bound = |space: &mut Space, factor: i64, (bound, included): (BigRational, bool)| {
            let scaled = space.times(&BigRational::from_integer(factor.into()), u);
            let difference = space.plus(scaled, &(bound * BigRational::from_integer((-factor).into())));
            Guard::Sign(if included { Sign::NonNegative } else { Sign::Positive }, difference)
        };
        let guards = vec![bound(space, 1, lo), bound(space, -1, hi)];
        cases.push(Case { value: space.constant(number), guards });
    }
    Some(cases)
}

/// x - k y where k = floor(x / y).
fn remainder(space: &mut Space, x: Value, y: Value, k: BigRational) -> Case {
    let multiple = space.times(&k, y);
    let value = space.binary(Op::Sub, x, multiple);
    let next = space.times(&(k + BigRational::one()), y);
    let left = space.binary(Op::Sub, next, x);
    // 0 <= x - k y < y for y > 0, and all signs the other way round for y < 0.
    let range = space.enclosure(y);
    let bounds = [(Sign::NonNegative, value), (Sign::Positive, left)];
    let guards = bounds.map(|(sign, bound)| {
        let bound = match () {
            () if range.lo() >= 0.0 => bound,
            () if range.hi() <= 0.0 => space.unary(Op::Neg, bound),
            () => space.binary(Op::Mul, bound, y),
        };
        Guard::Sign(sign, bound)
    });
    Case { value, guards: guards.to_vec() }
}

/// mod(x, y) = 0 as sin(pi x / y) = 0: x / y is a whole number.
pub fn whole_quotient(space: &mut Space, field: Value) -> Option<Value> {
    let (op, operands) = space.taken(field);
    if op != Op::Mod {
        return None;
    }
    let quotient = space.push(Op::Div, &operands);
    Some(sine_of_whole(space, Op::Sin, quotient))
}

/// sin(pi u), which vanishes at whole numbers, or cos(pi u), which does at halves.
fn sine_of_whole(space: &mut Space, op: Op, u: Value) -> Value {
    let pi = space.push(Op::Pi, &[]);
    let angle = space.binary(Op::Mul, pi, u);
    space.unary(op, angle)
}

/// A value at whose zeros an operation may jump.
pub fn atom(space: &mut Space, value: Value) -> Option<Value> {
    let (op, operands) = space.taken(value);
    match (op, &operands[..]) {
        (Op::Floor | Op::Ceil, &[u]) => Some(sine_of_whole(space, Op::Sin, u)),
        (Op::Round, &[u]) => Some(sine_of_whole(space, Op::Cos, u)),
        (Op::Sign, &[u]) | (Op::Atan2, &[u, _]) => Some(u),
        (Op::Mod, _) => whole_quotient(space, value),
        (Op::Less | Op::LessEqual | Op::Equal, _) => Some(space.push(Op::Sub, &operands)),
        _ => None,
    }
}

/// Whether a value changes at jumps alone: it has no zeros of its own then, but whole regions of them.
pub fn is_constant_between(space: &Space, value: Value) -> bool {
    let step = |op: Op, _: usize| matches!(op, Op::Floor | Op::Ceil | Op::Round | Op::Sign);
    space.below(value, step).iter().all(|&v| !matches!(space.shape(v).0, Op::Var(_)))
}
