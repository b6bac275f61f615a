//! Finished pieces: the conditions that are needed on the zero set itself, and the atoms of these.

use std::collections::HashSet;

use num_rational::BigRational;

use super::guard::Guard;
use super::guard::Guards;
use super::guard::Sign;
use super::guard::conjunction;
use super::guard::domain;
use super::jumps;
use super::jumps::Branch;
use super::poles::fraction;
use super::rules;
use super::space::Space;
use super::sum::Sum;
use super::sum::normal;
use crate::graph::Op;
use crate::graph::Value;
use crate::interval::Interval;

/// A finished piece in the graph of its own.
#[derive(Debug, Clone, PartialEq)]
pub struct Settled {
    pub field: Value,
    pub condition: Option<Value>,
    pub atoms: Vec<Value>,
}

/// What is known of a guard where the field vanishes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Known {
    Holds,
    Fails,
    Open,
}

/// The piece that a branch is; `None` if it is proved empty.
pub fn settle(space: &mut Space, branch: Branch) -> Option<Settled> {
    let field = normal(space, branch.field);
    // Where the field is defined, its own domain needs no mention.
    let mut own = Guards::default();
    let inner = domain(space, field);
    own.assume_all(space, inner)?;
    let mut guards: Vec<Guard> = branch.guards.0.into_iter().filter(|guard| !own.0.contains(guard)).collect();
    let mut index = 0;
    while index < guards.len() {
        let guard = guards.remove(index);
        match known(space, field, guard, &guards) {
            Known::Fails => return None,
            Known::Holds => {}
            Known::Open => {
                guards.insert(index, guard);
                index += 1;
            }
        }
    }
    let condition = conjunction(space, &guards);
    let atoms = atoms(space, &guards);
    Some(Settled { field, condition, atoms })
}

/// Decides a guard where the field is 0 and the other guards hold.
fn known(space: &mut Space, field: Value, guard: Guard, others: &[Guard]) -> Known {
    let Guard::Sign(sign, value) = guard else { return Known::Open };
    if sign == Sign::NonZero && conjugate(space, field) == Some(value) {
        return Known::Holds;
    }
    // The value less a multiple of the field is the same number there.
    let (of_field, of_value) = (Sum::of(space, field), Sum::of(space, value));
    for (c, term) in &of_field.terms {
        let Some((d, _)) = of_value.terms.iter().find(|(_, t)| t == term) else { continue };
        let reduced = difference(space, value, field, &(d / c));
        let mut kept = Guards::default();
        match kept.assume(space, Guard::Sign(sign, reduced)) {
            None => return Known::Fails,
            Some(()) if kept.0.iter().all(|guard| others.contains(guard)) => return Known::Holds,
            Some(()) => {}
        }
    }
    let below = Interval::new(f64::NEG_INFINITY, 0.0).unwrap_or(Interval::ENTIRE);
    let (otherwise, allowed) = match sign {
        Sign::NonZero => (Interval::ZERO, Interval::ENTIRE),
        Sign::NonNegative | Sign::Positive => (below, -below),
    };
    match () {
        () if !vanishes(space, field, &of_value, value, otherwise) => Known::Holds,
        () if !vanishes(space, field, &of_value, value, allowed) => Known::Fails,
        () => Known::Open,
    }
}

/// value - factor field
fn difference(space: &mut Space, value: Value, field: Value, factor: &BigRational) -> Value {
    let scaled = space.times(factor, field);
    let difference = space.binary(Op::Sub, value, scaled);
    Sum::of(space, difference).build(space)
}

/// Whether the field may vanish where `value` lies in `range`; of a value c t + d, t is what is looked at.
fn vanishes(space: &mut Space, field: Value, sum: &Sum, value: Value, range: Interval) -> bool {
    let whole = space.enclosure_where(field, value, range).contains(0.0);
    match &sum.terms[..] {
        [(c, term)] if whole => {
            let [c, d] = [c, &sum.constant].map(Interval::from_rational);
            space.enclosure_where(field, *term, (range - d) / c).contains(0.0)
        }
        _ => whole,
    }
}

/// cos u for sin u, and the other way round: they have no zero in common.
fn conjugate(space: &mut Space, field: Value) -> Option<Value> {
    match space.taken(field) {
        (Op::Sin, operands) => Some(space.push(Op::Cos, &operands)),
        (Op::Cos, operands) => Some(space.push(Op::Sin, &operands)),
        _ => None,
    }
}

/// Values at whose zeros one of the guards may change.
pub fn atoms(space: &mut Space, guards: &[Guard]) -> Vec<Value> {
    let mut atoms = Vec::new();
    for &guard in guards {
        let value = match guard {
            Guard::Sign(_, value) => {
                simple(space, value, &mut atoms);
                value
            }
            Guard::Truth(value) => value,
        };
        for value in space.below(value, |_, _| false) {
            if let Some(atom) = jumps::atom(space, value) {
                simple(space, atom, &mut atoms);
            }
        }
    }
    let mut seen = HashSet::new();
    atoms.retain(|atom| seen.insert(*atom));
    atoms
}

/// The simplest values that vanish wherever this one does.
fn simple(space: &mut Space, value: Value, atoms: &mut Vec<Value>) {
    let mut open = vec![value];
    while let Some(value) = open.pop() {
        let over = fraction(space, value);
        let value = if over.d.is_some() { over.n } else { value };
        match rules::operation(space, value) {
            Some(parts) => open.extend(parts.into_iter().rev().map(|part| part.field)),
            None => {
                let value = normal(space, value);
                if !space.never_zero(value) && !jumps::is_constant_between(space, value) {
                    atoms.push(value);
                }
            }
        }
    }
}
