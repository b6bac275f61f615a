//! `:root`: the zeros of an expression as text.

use crate::control::Control;
use crate::diagnostic::code;
use crate::interval::Interval;
use crate::repl::plot::short;
use crate::repl::state::State;
use crate::repl::state::is_number;
use crate::repl::state::trim;
use crate::roots::Options;
use crate::roots::Root;
use crate::roots::Roots;
use crate::roots::Search;
use crate::session::expression::Messages;
use crate::session::expression::Reading;
use crate::session::expression::Snippet;

/// Lines of one kind that are shown.
const MAX_SHOWN: usize = 24;

pub fn root(state: &mut State, arguments: &Snippet) -> Result<String, Messages> {
    let text = arguments.as_str();
    let at = text.rmatch_indices("in").map(|(at, _)| at).find(|&at| {
        let blank = |c: char| c.is_whitespace() || c == ')' || c == ']';
        text[..at].ends_with(blank) && text[at + 2..].trim_start().starts_with('[')
    });
    let Some(at) = at else {
        let fault = arguments.fault(code::BAD_COMMAND, "where should zeros be searched?", "no `in [a, b]`");
        return Err(fault.help(format!("write `:root {} in [-10, 10]`", text.trim_end())));
    };
    let snippet = trim(&arguments.within(0..at));
    let range = state.workspace.value(&trim(&arguments.within(at + 2..text.len())), &state.bindings)?.interval();
    let expression = state.open(&snippet, Reading::Zero)?;
    if expression.condition {
        let fault = snippet.fault(code::WRONG_KIND, "an inequality has no zeros", "a number or an equation is needed");
        return Err(fault.help("write an expression, or an equation such as `cos(x) = x`"));
    }
    let boxes = expression.boxes(&state.bindings);
    let names = expression.graph.variables();
    // What has no number yet is what is searched for, and a variable alone whatever it has.
    let variables = expression.variables();
    let searched = |i: &usize| match variables[..] {
        [only] => names[*i] == only,
        _ => !is_number(boxes[*i]),
    };
    let free: Vec<usize> = (0..boxes.len()).filter(searched).collect();
    let variable = match free[..] {
        [only] => only,
        [] => {
            let fault = snippet.fault(code::NO_VALUE, "nothing varies here", "every variable is a number");
            let help = match variables.first() {
                Some(name) => format!("`{name}` has a number; give it a box, such as `{name} = [0, 1]`"),
                None => "write an expression in x".to_owned(),
            };
            return Err(fault.help(help));
        }
        [first, second, ..] => {
            let (first, second) = (&names[first], &names[second]);
            let title = format!("zeros of one variable are searched, and this has `{first}` and `{second}`");
            let fault = snippet.fault(code::BAD_COMMAND, title, "depends on both");
            return Err(fault.help(format!("give one of them a number, such as `{second} = 0.5`")));
        }
    };
    let search = Search::new(&expression.graph, expression.root, &boxes, variable);
    let roots = search.run(range, &Options::default(), &Control::default());
    Ok(report(&roots, range))
}

fn report(roots: &Roots, range: Interval) -> String {
    if range.is_empty() {
        return "there is nothing in the empty set".to_owned();
    }
    let count = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    let mut lines = Vec::new();
    if !roots.proved.is_empty() {
        lines.push(format!("{}:", count(roots.proved.len(), "proved root")));
        lines.extend(shown(&roots.proved, one));
    }
    let other = if roots.proved.is_empty() { "no root" } else { "no other root" };
    if roots.unknown.is_empty() {
        lines.push(format!("{other} in {range}: proved"));
    } else {
        lines.push("unknown, perhaps a root that is touched, a pole or a jump:".to_owned());
        lines.extend(shown(&roots.unknown, |x| format!("  {x}  width {}", short(x.width()))));
        lines.push(format!("{other} in the rest of {range}: proved"));
    }
    if roots.exhausted {
        lines.push("the search ended early: a shorter interval shows more".to_owned());
    }
    lines.join("\n")
}

fn one(root: &Root) -> String {
    let bracket = root.bracket;
    let place = match bracket.is_singleton() {
        true => format!("  {bracket}  exact"),
        false => format!("  {bracket}  width {}", short(bracket.width())),
    };
    match root.alone {
        Some(alone) => format!("{place}, the only one in {alone}"),
        None => format!("{place}, at least one"),
    }
}

fn shown<T>(items: &[T], text: impl Fn(&T) -> String) -> Vec<String> {
    let mut lines: Vec<String> = items.iter().take(MAX_SHOWN).map(text).collect();
    if items.len() > MAX_SHOWN {
        lines.push(format!("  and {} more", items.len() - MAX_SHOWN));
    }
    lines
}
