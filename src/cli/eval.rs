//! `imp eval`: one expression over one box as text, or a stream of JSON lines.

mod lines;
mod number;
mod request;

use crate::cli::arguments::EvalArguments;
use crate::cli::failure::Failure;
use crate::cli::files;
use crate::derive::Extension;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::interval::Decorated;
use crate::session::answer::Choice;
use crate::session::answer::width;
use crate::session::expression::Bindings;
use crate::session::expression::Expression;
use crate::session::expression::Messages;
use crate::session::expression::Reading;
use crate::session::expression::Snippet;
use crate::session::expression::Workspace;

/// The choice of arithmetic that asks for every one of them.
const ALL: &str = "all";

pub fn eval(arguments: &EvalArguments) -> Result<(), Failure> {
    let mut workspace = Workspace::default();
    if let Some(path) = &arguments.definitions {
        let path = path.display().to_string();
        workspace.load(&Snippet::whole("--definitions", &path), &Bindings::new())?;
    }
    if arguments.json {
        return lines::serve(&arguments.expression, workspace, arguments.arithmetic.as_deref());
    }
    let given = values(&workspace, &arguments.values)?;
    let names: Vec<&str> = given.keys().map(String::as_str).collect();
    let expression = workspace.expression(&Snippet::whole("EXPR", &arguments.expression), &names, Reading::Value)?;
    let text = match arguments.arithmetic.as_deref() {
        Some(ALL) => compare(&expression, &given),
        name => answer(&expression, &given, name.map_or(Ok(Choice::Auto), Choice::from_name)?),
    };
    files::print(text.as_bytes())
}

/// The values of all arguments `NAME=VALUE`; the messages about all of them.
pub fn values(workspace: &Workspace, arguments: &[String]) -> Result<Bindings, Failure> {
    let mut given = Bindings::new();
    let mut failure = Failure::default();
    for argument in arguments {
        let found = value(workspace, argument).map_err(Failure::from).and_then(|(name, value)| {
            match given.insert(name.clone(), value) {
                None => Ok(()),
                Some(_) => Err(Diagnostic::error(code::SET_TWICE, format!("`{name}` is given twice")).into()),
            }
        });
        failure.collect(found);
    }
    failure.into_result().map(|()| given)
}

fn value(workspace: &Workspace, argument: &str) -> Result<(String, Decorated), Messages> {
    let Some(equals) = argument.find('=') else {
        let whole = Snippet::whole("argument", argument);
        let fault = whole.fault(code::BAD_ARGUMENT, "this gives no variable a value", "no `=`");
        return Err(fault.help("write a name and its value, such as `x=0.5` or `x=[0, 1]`"));
    };
    let name = argument[..equals].trim();
    let whole = Snippet::whole("argument", argument);
    workspace.check_variable(&whole.within(0..equals))?;
    let title = format!("value of {name}");
    let snippet = Snippet { name: &title, text: argument, part: equals + 1..argument.len() };
    let value = workspace.value(&snippet, &Bindings::new())?;
    Ok((name.to_owned(), value))
}

fn answer(expression: &Expression, given: &Bindings, choice: Choice) -> String {
    let formula = expression.formula();
    let answer = choice.enclose(&formula, &expression.boxes_for(formula.variables(), given));
    answer.line(expression, &expression.boxes(given), choice) + "\n"
}

/// Every arithmetic in a line of its own.
fn compare(expression: &Expression, given: &Bindings) -> String {
    let formula = expression.formula();
    let boxes = expression.boxes_for(formula.variables(), given);
    let line = |extension: &Extension| {
        let value = formula.enclose(*extension, &boxes);
        format!("{extension:<14}{}  width {}  {}\n", value.interval(), width(value.interval()), value.decoration())
    };
    Extension::ALL.iter().map(line).collect()
}
