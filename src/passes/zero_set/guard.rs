//! What must hold beside the vanishing of a field: signs of values, and truth values of other kinds.

use std::collections::HashMap;
use std::collections::HashSet;

use num_rational::BigRational;
use num_traits::One;
use num_traits::Signed;
use num_traits::Zero;

use super::poles::fraction;
use super::space::Space;
use super::sum::Sum;
use super::sum::normal;
use super::sum::primitive;
use crate::graph::Op;
use crate::graph::Value;
use crate::interval::Interval;

/// A sign that a value has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Sign {
    NonZero,
    NonNegative,
    Positive,
}

/// Something that holds at a point or does not; where a value is undefined it does not.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Guard {
    Sign(Sign, Value),
    /// A truth value that is 1.
    Truth(Value),
}

/// Guards that hold together. Where the values of all earlier guards are defined, and these hold, so are the values of a
/// guard: what says where a value is defined comes before it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Guards(pub Vec<Guard>);

impl Guards {
    /// Adds a guard, in simpler ones where possible and not at all where bounds prove it; `None` if it is refuted.
    #[must_use]
    pub fn assume(&mut self, space: &mut Space, guard: Guard) -> Option<()> {
        let mut open = vec![guard];
        while let Some(guard) = open.pop() {
            let parts = match guard {
                Guard::Sign(sign, value) => sign_parts(space, sign, value)?,
                Guard::Truth(truth) => truth_parts(space, truth)?,
            };
            match parts {
                Parts::Split(parts) => open.extend(parts.into_iter().rev()),
                Parts::Whole(guard) if self.0.contains(&guard) => {}
                Parts::Whole(guard) => self.0.push(guard),
            }
        }
        Some(())
    }

    /// Adds all of them.
    #[must_use]
    pub fn assume_all(&mut self, space: &mut Space, guards: impl IntoIterator<Item = Guard>) -> Option<()> {
        guards.into_iter().try_for_each(|guard| self.assume(space, guard))
    }
}

/// A guard in parts, or as one that has none.
enum Parts {
    Split(Vec<Guard>),
    Whole(Guard),
}

/// Simpler guards; `None` if there is no point in the domain at which the sign is that.
fn sign_parts(space: &mut Space, sign: Sign, value: Value) -> Option<Parts> {
    let range = space.enclosure(value);
    let (proved, refuted) = match sign {
        Sign::NonZero => (!range.contains(0.0), range == Interval::ZERO),
        Sign::NonNegative => (range.lo() >= 0.0, range.hi() < 0.0),
        Sign::Positive => (range.lo() > 0.0, range.hi() <= 0.0),
    };
    if refuted || range.is_empty() {
        return None;
    }
    if proved {
        return Some(Parts::Split(Vec::new()));
    }
    let of = |sign: Sign, values: &[Value]| Some(Parts::Split(values.iter().map(|&v| Guard::Sign(sign, v)).collect()));
    let (op, operands) = space.taken(value);
    match (sign, op, &operands[..]) {
        (Sign::NonZero, Op::Mul, parts) => return of(Sign::NonZero, parts),
        (Sign::NonZero, Op::Div, &[n, _]) => return of(Sign::NonZero, &[n]),
        (Sign::NonZero, Op::Neg | Op::Abs | Op::Sqr | Op::Sqrt | Op::Cbrt | Op::PowInt(1..), parts) => {
            return of(Sign::NonZero, parts);
        }
        (Sign::Positive, Op::Abs | Op::Sqr, parts) => return of(Sign::NonZero, parts),
        (Sign::Positive, Op::PowInt(n @ 1..), parts) if n % 2 == 0 => return of(Sign::NonZero, parts),
        (Sign::Positive, Op::Sqrt, parts) => return of(Sign::Positive, parts),
        (_, Op::Cbrt | Op::Sinh | Op::Asinh | Op::Tanh | Op::Atanh | Op::Asin | Op::Atan, parts) => {
            return of(sign, parts);
        }
        (_, Op::PowInt(n @ 1..), parts) if n % 2 != 0 => return of(sign, parts),
        (Sign::NonNegative | Sign::Positive, Op::Min, parts) => return of(sign, parts),
        _ => {}
    }
    let over = fraction(space, value);
    if let Some(d) = over.d {
        let same_sign = match sign {
            Sign::NonZero => over.n,
            // n / d and n d have one sign; that d is not 0 is said before.
            _ => space.binary(Op::Mul, over.n, d),
        };
        return of(sign, &[same_sign]);
    }
    if let Some(parts) = bounded(space, sign, value) {
        return Some(parts);
    }
    let value = if sign == Sign::NonZero { normal(space, value) } else { primitive(space, value) };
    Some(Parts::Whole(Guard::Sign(sign, value)))
}

/// c - |u| >= 0 as two bounds of u, c - max(u, v) >= 0 as one bound of each, and c + min(u, v) >= 0 likewise. The other
/// way round there is a choice.
fn bounded(space: &mut Space, sign: Sign, value: Value) -> Option<Parts> {
    let sum = Sum::of(space, value);
    let &[(ref c, term)] = &sum.terms[..] else { return None };
    let (op, operands) = space.taken(term);
    let c = c.clone();
    if sign == Sign::NonZero {
        return None;
    }
    let (all, sides) = match (op, &operands[..]) {
        (Op::Abs, &[u]) => (c.is_negative(), vec![(c.clone(), u), (-c, u)]),
        (Op::Max, &[u, v]) => (c.is_negative(), vec![(c.clone(), u), (c, v)]),
        (Op::Min, &[u, v]) => (c.is_positive(), vec![(c.clone(), u), (c, v)]),
        _ => return None,
    };
    let sides: Vec<Value> =
        sides.into_iter().map(|side| Sum { terms: vec![side], constant: sum.constant.clone() }.build(space)).collect();
    if all {
        return Some(Parts::Split(sides.into_iter().map(|side| Guard::Sign(sign, side)).collect()));
    }
    let truths: Vec<Value> = sides.into_iter().map(|side| truth(space, Guard::Sign(sign, side))).collect();
    let either = space.push(Op::Max, &truths);
    Some(Parts::Split(vec![Guard::Truth(either)]))
}

/// A truth value as signs of differences; `None` if it is nowhere 1.
fn truth_parts(space: &mut Space, value: Value) -> Option<Parts> {
    let range = space.enclosure(value);
    if range.is_empty() || range.hi() < 1.0 {
        return None;
    }
    let (op, operands) = space.taken(value);
    let split = |guards: Vec<Guard>| Some(Parts::Split(guards));
    match (op, &operands[..]) {
        _ if range == Interval::ONE => split(Vec::new()),
        (Op::Min, &[a, b]) => split(vec![Guard::Truth(a), Guard::Truth(b)]),
        (Op::Select, &[a, b, no]) if space.number(no).is_some_and(Zero::is_zero) => {
            split(vec![Guard::Truth(a), Guard::Truth(b)])
        }
        (Op::Less, &[a, b]) => {
            let difference = space.binary(Op::Sub, b, a);
            split(vec![Guard::Sign(Sign::Positive, difference)])
        }
        (Op::LessEqual, &[a, b]) => {
            let difference = space.binary(Op::Sub, b, a);
            split(vec![Guard::Sign(Sign::NonNegative, difference)])
        }
        (Op::Sub, &[one, not]) if space.number(one).is_some_and(One::is_one) => {
            let (op, operands) = space.taken(not);
            match (op, &operands[..]) {
                (Op::Less, &[a, b]) => split(vec![Guard::Truth(space.binary(Op::LessEqual, b, a))]),
                (Op::LessEqual, &[a, b]) => split(vec![Guard::Truth(space.binary(Op::Less, b, a))]),
                (Op::Equal, &[a, b]) => {
                    let difference = space.binary(Op::Sub, a, b);
                    split(vec![Guard::Sign(Sign::NonZero, difference)])
                }
                (Op::Max, &[a, b]) => {
                    let parts = [a, b].map(|part| Guard::Truth(space.binary(Op::Sub, one, part)));
                    split(parts.to_vec())
                }
                _ => Some(Parts::Whole(Guard::Truth(value))),
            }
        }
        _ => Some(Parts::Whole(Guard::Truth(value))),
    }
}

/// A guard as a truth value.
pub fn truth(space: &mut Space, guard: Guard) -> Value {
    let zero = space.int(0);
    match guard {
        Guard::Truth(value) => value,
        Guard::Sign(Sign::Positive, value) => space.binary(Op::Less, zero, value),
        Guard::Sign(Sign::NonNegative, value) => space.binary(Op::LessEqual, zero, value),
        Guard::Sign(Sign::NonZero, value) => {
            let (one, equal) = (space.int(1), space.binary(Op::Equal, zero, value));
            space.binary(Op::Sub, one, equal)
        }
    }
}

/// All of them as one truth value, which is defined even where a later one alone is not; `None` if there are none.
pub fn conjunction(space: &mut Space, guards: &[Guard]) -> Option<Value> {
    let mut all = None;
    for &guard in guards.iter().rev() {
        let this = truth(space, guard);
        all = Some(match all {
            None => this,
            Some(rest) if space.total(this) && space.total(rest) => space.binary(Op::Min, this, rest),
            Some(rest) => {
                let zero = space.int(0);
                space.push(Op::Select, &[this, rest, zero])
            }
        });
    }
    all
}

/// Where a value is defined.
pub fn domain(space: &mut Space, value: Value) -> Vec<Guard> {
    // Selections inside arms first, operands before users.
    let mut arms = HashMap::new();
    for inner in space.below(value, |_, _| false) {
        if let (Op::Select, &[condition, yes, no]) = space.shape(inner)
            && !space.total(inner)
        {
            let one = space.int(1);
            let [yes, no] = [yes, no].map(|arm| {
                let guards = outside_arms(space, arm, &arms);
                conjunction(space, &guards).unwrap_or(one)
            });
            let selected = (yes != one || no != one).then(|| space.push(Op::Select, &[condition, yes, no]));
            arms.insert(inner, selected);
        }
    }
    outside_arms(space, value, &arms)
}

/// Where a value is defined, with what is known of the arms of selections.
fn outside_arms(space: &mut Space, value: Value, arms: &HashMap<Value, Option<Value>>) -> Vec<Guard> {
    let mut guards = Vec::new();
    // Arms need to be defined only where they are selected.
    for value in space.below(value, |op, place| op == Op::Select && place > 0) {
        match arms.get(&value) {
            Some(selected) => guards.extend(selected.map(Guard::Truth)),
            None if space.total(value) => {}
            None => guards.extend(domain_of_node(space, value)),
        }
    }
    let mut seen = HashSet::new();
    guards.retain(|guard| seen.insert(*guard));
    guards
}

/// Where an operation is defined, if its operands are.
fn domain_of_node(space: &mut Space, value: Value) -> Vec<Guard> {
    let (op, operands) = space.taken(value);
    let sign = |sign: Sign, value: Value| vec![Guard::Sign(sign, value)];
    let one = BigRational::one;
    let below = |space: &mut Space, u: Value| {
        let negative = space.unary(Op::Neg, u);
        space.plus(negative, &one())
    };
    match (op, &operands[..]) {
        (Op::Sqrt, &[u]) => sign(Sign::NonNegative, u),
        (Op::Ln | Op::Log2 | Op::Log10, &[u]) => sign(Sign::Positive, u),
        (Op::Log1p, &[u]) => sign(Sign::Positive, space.plus(u, &one())),
        (Op::Tan, &[u]) => sign(Sign::NonZero, space.unary(Op::Cos, u)),
        (Op::Asin | Op::Acos, &[u]) => {
            [below(space, u), space.plus(u, &one())].map(|v| Guard::Sign(Sign::NonNegative, v)).to_vec()
        }
        (Op::Atanh, &[u]) => [below(space, u), space.plus(u, &one())].map(|v| Guard::Sign(Sign::Positive, v)).to_vec(),
        (Op::Acosh, &[u]) => sign(Sign::NonNegative, space.plus(u, &-one())),
        (Op::Div | Op::Mod, &[_, u]) => sign(Sign::NonZero, u),
        (Op::PowInt(n), &[u]) if n < 0 => sign(Sign::NonZero, u),
        (Op::PowRatio(p, q), &[u]) => match (p < 0, q % 2 == 0) {
            (true, true) => sign(Sign::Positive, u),
            (true, false) => sign(Sign::NonZero, u),
            (false, true) => sign(Sign::NonNegative, u),
            (false, false) => Vec::new(),
        },
        (Op::Pow, &[u, v]) => {
            // u > 0, or u = 0 and v > 0.
            let [inside, edge, rising] = [(Sign::Positive, u), (Sign::NonNegative, u), (Sign::Positive, v)]
                .map(|(s, value)| truth(space, Guard::Sign(s, value)));
            let edge = space.binary(Op::Min, edge, rising);
            vec![Guard::Truth(space.binary(Op::Max, inside, edge))]
        }
        (Op::Atan2, &[u, v]) => {
            let parts = [u, v].map(|part| truth(space, Guard::Sign(Sign::NonZero, part)));
            vec![Guard::Truth(space.push(Op::Max, &parts))]
        }
        _ => Vec::new(),
    }
}
