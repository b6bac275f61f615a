//! The zero set of a formula as a union of zero sets of simpler ones, each of which interval methods can settle.
//!
//! Enclosures prove that a curve f = 0 is regular where they prove that f changes sign with a derivative that does not
//! vanish. A square never changes sign, a product has no derivative where its factors cross, near a pole nothing is
//! bounded, and at a jump nothing is continuous. Each of these is a property of the formula and not of the zero set:
//! a square is replaced by its base, a product by its factors, a quotient by its numerator, sums of two sines by the
//! factors of their product, jumps by the pieces between them. What the formula said beside its zeros (where a divisor
//! vanishes there is no value) stays as a condition of the piece.
//!
//! - `space`: the graph in which this happens, simplified as it grows;
//! - `sum`: sums as terms, products as factors, one form for the multiples of a field;
//! - `rules` and `sums`: what says the vanishing of an operation, and of a sum;
//! - `poles`: numerators; `jumps`: steps, remainders and selections;
//! - `guard`: conditions, and where a value is defined; `settle`: which of them a piece needs.

mod guard;
mod jumps;
mod poles;
mod rules;
mod settle;
mod space;
mod sum;
mod sums;

use std::collections::HashMap;

pub use poles::numerator;

use crate::graph::Graph;
use crate::graph::Value;
use crate::interval::Interval;
use guard::Guard;
use guard::Guards;
use jumps::Branch;
use settle::Settled;
use space::Space;

/// Splits that are a choice end here: jumps and minima stay where there would be more pieces.
const MAX_SPLITS: usize = 128;

/// No more pieces than this; what is left then stays as it is.
const MAX_PIECES: usize = 4096;

/// Rules that may follow one another on the way to a piece.
const MAX_STEPS: usize = 256;

/// Part of a zero set: the points where `field` is 0 and `condition` holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// Where this is a constant 0, the piece is all of the plane where the condition holds.
    pub field: Value,
    /// A truth value (0 or 1) that must be 1; where it is undefined it does not hold. `None`: no condition.
    pub condition: Option<Value>,
    /// Values at whose zeros the condition may change its truth: between them it is constant.
    pub atoms: Vec<Value>,
}

/// The points where `field` is defined and 0 and `condition` holds, as the union of pieces: exactly, on the domain given by
/// `inputs`, the bounds of each input in the order of [`Graph::variables`]. Pieces are values of `graph`; equal pieces of
/// different fields are equal values. A field or condition with derivatives across jumps stays as it is.
///
/// # Panics
/// If the number of bounds is not the number of variables.
pub fn zero_set(graph: &mut Graph, field: Value, condition: Option<Value>, inputs: &[Interval]) -> Vec<Piece> {
    let mut space = Space::new(graph.variables(), inputs);
    let mut roots = vec![field];
    roots.extend(condition);
    let roots = space.import(graph, &roots);
    let functions = roots.iter().all(|&root| space.is_function(root));
    let settled = match (functions, &roots[..]) {
        (true, &[field, ..]) => pieces(&mut space, field, roots.get(1).copied()),
        _ => {
            let atoms = condition.map(|condition| space_atoms(graph, condition, inputs)).unwrap_or_default();
            return vec![Piece { field, condition, atoms }];
        }
    };
    let mut export = |values: &[Value]| graph.import(space.graph(), values, &HashMap::new());
    let mut pieces: Vec<Piece> = Vec::new();
    for Settled { field, condition, atoms } in settled {
        let field = export(&[field])[0];
        let condition = condition.map(|condition| export(&[condition])[0]);
        let piece = Piece { field, condition, atoms: export(&atoms) };
        if !pieces.contains(&piece) {
            pieces.push(piece);
        }
    }
    pieces
}

/// The atoms of a condition as it is written.
fn space_atoms(graph: &mut Graph, condition: Value, inputs: &[Interval]) -> Vec<Value> {
    let mut space = Space::new(graph.variables(), inputs);
    let condition = space.import(graph, &[condition])[0];
    let atoms = settle::atoms(&mut space, &[Guard::Truth(condition)]);
    graph.import(space.graph(), &atoms, &HashMap::new())
}

/// The pieces in their own graph.
fn pieces(space: &mut Space, field: Value, condition: Option<Value>) -> Vec<Settled> {
    let mut settled = Vec::new();
    let mut guards = Guards::default();
    let mut given = guard::domain(space, field);
    if let Some(condition) = condition {
        given.extend(guard::domain(space, condition));
        given.push(Guard::Truth(condition));
    }
    if guards.assume_all(space, given).is_none() {
        return settled;
    }
    let mut open = vec![(Branch { field, guards }, MAX_STEPS)];
    while let Some((branch, steps)) = open.pop() {
        let count = settled.len() + open.len();
        let parts = if steps == 0 || count >= MAX_PIECES { None } else { step(space, &branch, count) };
        match parts {
            Some(parts) => open.extend(parts.into_iter().rev().map(|part| (part, steps - 1))),
            None => settled.extend(settle::settle(space, branch)),
        }
    }
    settled
}

/// What one rule makes of a branch; `None` if no rule applies.
fn step(space: &mut Space, branch: &Branch, count: usize) -> Option<Vec<Branch>> {
    let room = MAX_SPLITS.saturating_sub(count);
    let field = branch.field;
    let mut alternatives = rules::operation(space, field);
    if alternatives.is_none() && room > 1 {
        alternatives = rules::extremum(space, field);
    }
    if alternatives.is_none() {
        if let Some(parts) = jumps::split(space, branch, room) {
            return Some(parts);
        }
        alternatives = match jumps::whole_quotient(space, field) {
            Some(sine) => rules::all([sine]),
            None => sums::terms(space, field),
        };
    }
    let mut parts = Vec::new();
    for alternative in alternatives? {
        let mut guards = branch.guards.clone();
        if guards.assume_all(space, alternative.guards).is_some() {
            parts.push(Branch { field: alternative.field, guards });
        }
    }
    Some(parts)
}
