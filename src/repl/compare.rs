//! `:compare` and `:bisect`: what the arithmetics make of one expression, at once and in parts.

use crate::derive::Extension;
use crate::interval::Decorated;
use crate::repl::plot::short;
use crate::repl::state::Prepared;
use crate::repl::state::State;
use crate::repl::table::table;
use crate::session::answer::Choice;
use crate::session::answer::width;
use crate::session::expression::Messages;
use crate::session::expression::Snippet;

/// The finest cut of `:bisect`.
const MOST_PARTS: u32 = 1024;
/// Operations that one line of `:bisect` may cost.
const MAX_OPERATIONS: f64 = 5e7;

/// All arithmetics side by side.
pub fn compare(state: &mut State, expression: &Snippet) -> Result<String, Messages> {
    let Prepared { formula, boxes, .. } = state.prepare(expression)?;
    let row = |choice: Choice| {
        let value = choice.enclose(&formula, &boxes).value;
        let operations = choice.operations(&formula).to_string();
        let (interval, decoration) = (value.interval(), value.decoration());
        [choice.to_string(), interval.to_string(), short(interval.width()), operations, decoration.to_string()]
    };
    let choices = Extension::ALL.iter().map(|extension| Choice::One(*extension)).chain([Choice::Auto]);
    let rows: Vec<[String; 5]> = choices.map(row).collect();
    Ok(table(["arithmetic", "enclosure", "width", "operations", "decoration"], &rows))
}

/// The enclosure over more and more parts of each box.
pub fn bisect(state: &mut State, expression: &Snippet) -> Result<String, Messages> {
    let prepared = state.prepare(expression)?;
    let choice = state.choice;
    // All that is not a single number is cut, also the enclosure of a decimal.
    let wide = |value: &&Decorated| value.interval().is_bounded() && !value.interval().is_singleton();
    let free = prepared.boxes.iter().filter(wide).count() as i32;
    let once = choice.operations(&prepared.formula) as f64;
    let mut rows: Vec<[String; 4]> = Vec::new();
    let mut before = f64::NAN;
    let mut parts = 1;
    while parts <= MOST_PARTS && once * f64::from(parts).powi(free) <= MAX_OPERATIONS {
        let interval = choice.enclose_in_parts(&prepared.formula, &prepared.boxes, parts).value.interval();
        let gain = before - interval.width();
        let gain = if gain.is_finite() { short(gain) } else { String::new() };
        rows.push([parts.to_string(), interval.to_string(), width(interval), gain]);
        before = interval.width();
        if free == 0 {
            break;
        }
        parts *= 2;
    }
    let mut text = table(["parts", "enclosure", "width", "narrower by"], &rows);
    if free == 0 {
        text += "\nall variables are single numbers: there is nothing to cut";
    } else if parts <= MOST_PARTS {
        text += &format!("\n{parts} parts of each of {free} boxes would take too long");
    }
    Ok(text)
}
