//! `:deriv`: symbolic derivatives.

use crate::derive;
use crate::diagnostic::code;
use crate::graph;
use crate::graph::Graph;
use crate::interval::Interval;
use crate::passes;
use crate::repl::formula::formula;
use crate::repl::state::State;
use crate::repl::state::trim;
use crate::session::expression::Messages;
use crate::session::expression::Reading;
use crate::session::expression::Snippet;

pub fn derivative(state: &mut State, arguments: &Snippet) -> Result<String, Messages> {
    let (snippet, variable) = split(state, arguments);
    let expression = state.open(&snippet, Reading::Value)?;
    let variables = expression.variables();
    let name = match (&variable, &variables[..]) {
        (Some(variable), _) => {
            state.workspace.check_variable(variable)?;
            variable.as_str()
        }
        (None, [only]) => only,
        (None, []) => {
            let fault = snippet.fault(code::DERIVATIVE_BY, "this is a constant", "no variable occurs here");
            return Err(fault.help(format!("name a variable: `:deriv {}, x`", snippet.as_str())));
        }
        (None, [first, ..]) => {
            let title = format!("this depends on {}", variables.join(", "));
            let fault = snippet.fault(code::DERIVATIVE_BY, title, "by which of them?");
            return Err(fault.help(format!("write `:deriv {}, {first}`", snippet.as_str())));
        }
    };
    let mut graph = Graph::new();
    let images = graph.import(&expression.graph, &[expression.root], &Default::default());
    let by = graph.var(name);
    let slope = derive::derivative(&mut graph, images[0], by);
    graph.add_output("f", slope);
    let anything = vec![Interval::ENTIRE; graph.variables().len()];
    let (graph, _) = passes::run(&graph, &anything);
    let Some(slope) = graph.output("f") else { return Ok(String::new()) };
    let mut text = format!("d/d{name} {} = ", snippet.as_str());
    text += &formula(&graph, slope).unwrap_or_else(|| format!("\n{graph}"));
    // Its values, where all variables have some.
    if graph.variables().iter().all(|name| state.bindings.contains_key(name) || !variables.contains(&name.as_str())) {
        let boxes = expression.boxes_for(graph.variables(), &state.bindings);
        let value = graph::enclose(&graph, &[slope], &boxes)[0];
        if !variables.is_empty() {
            text += &format!("\n  in {value}");
        }
    }
    Ok(text)
}

/// The expression, and the variable behind its last comma. Without a comma the last word is the variable if the text in
/// front of it is an expression of several variables, which needs one.
fn split<'a>(state: &State, arguments: &Snippet<'a>) -> (Snippet<'a>, Option<Snippet<'a>>) {
    let text = arguments.as_str();
    let is_name = |word: &str| !word.is_empty() && word.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '\'');
    let parts =
        |at: usize, gap: usize| (trim(&arguments.within(0..at)), Some(trim(&arguments.within(at + gap..text.len()))));
    if let Some(at) = text.rfind(',').filter(|&at| is_name(text[at + 1..].trim())) {
        return parts(at, 1);
    }
    if let Some((at, blank)) =
        text.rmatch_indices(char::is_whitespace).next().filter(|&(at, _)| is_name(text[at..].trim()))
    {
        let (front, name) = parts(at, blank.len());
        let several = state.open(&front, Reading::Value).is_ok_and(|expression| expression.variables().len() > 1);
        if several {
            return (front, name);
        }
    }
    (arguments.clone(), None)
}
