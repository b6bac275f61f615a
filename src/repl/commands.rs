//! The commands of the REPL: one table of names, arguments and help, and what finds a command in it.

use crate::diagnostic::code;
use crate::diagnostic::did_you_mean;
use crate::program;
use crate::repl::compare;
use crate::repl::derivative;
use crate::repl::inspect;
use crate::repl::plot;
use crate::repl::roots;
use crate::repl::state::State;
use crate::repl::state::trim;
use crate::session::answer::Choice;
use crate::session::expression::Messages;
use crate::session::expression::Snippet;

/// A command. Its first letters are enough where they fit no other one before it in the table.
pub struct Command {
    pub name: &'static str,
    /// As help shows them.
    pub arguments: &'static str,
    /// One line on what it does.
    pub help: &'static str,
    run: fn(&mut State, &Snippet) -> Result<String, Messages>,
}

const fn row(
    name: &'static str,
    arguments: &'static str,
    run: fn(&mut State, &Snippet) -> Result<String, Messages>,
    help: &'static str,
) -> Command {
    Command { name, arguments, help, run }
}

/// Every command.
pub static COMMANDS: &[Command] = &[
    row("help", "[NAME]", help, "What can be written here, or what one name means."),
    row("arith", "[NAME]", arith, "The arithmetic that encloses expressions, or another one from now on."),
    row("compare", "EXPR", compare::compare, "All arithmetics side by side over the current boxes."),
    row("bisect", "EXPR", compare::bisect, "The enclosure over 1, 2, 4, ... 1024 parts of each box, converging."),
    row("root", "EXPR in [a, b]", roots::root, "All proved zeros of an expression or equation, and what is unknown."),
    row("deriv", "EXPR, NAME", derivative::derivative, "The derivative; one variable alone need not be named."),
    row(
        "show",
        "graph|clif|asm EXPR",
        inspect::show,
        "The expression as a graph, as the code generator's input, as machine code.",
    ),
    row("time", "EXPR", inspect::time, "How long compiling takes, and one box in compiled and interpreted kernels."),
    row("plot", "EXPR [FILE.svg|FILE.png]", plot::plot, "A picture over the box of one variable, with enclosures."),
    row("load", "FILE", load, "The definitions of a file."),
    row("vars", "", vars, "All variables and definitions."),
    row("reset", "", reset, "Forgets all variables and definitions."),
    row("quit", "", quit, "Leaves, as Ctrl-D does."),
];

/// The command of that name or of a name that begins so.
fn find(word: &str) -> Option<&'static Command> {
    let exact = COMMANDS.iter().find(|command| command.name == word);
    exact.or_else(|| COMMANDS.iter().find(|command| !word.is_empty() && command.name.starts_with(word)))
}

/// Runs a line that begins with `:`.
pub fn run(state: &mut State, line: &Snippet) -> Result<String, Messages> {
    let text = line.as_str();
    let end = text.find(char::is_whitespace).unwrap_or(text.len());
    let word = &text[1..end];
    let Some(command) = find(word) else {
        let fault = line.within(0..end).fault(code::BAD_COMMAND, format!("there is no command `:{word}`"), "");
        return Err(match did_you_mean(word, COMMANDS.iter().map(|command| command.name)) {
            Some(near) => fault.help(format!("did you mean `:{near}`?")),
            None => fault.help("`:help` lists them"),
        });
    };
    let rest = trim(&line.within(end..text.len()));
    let required = !command.arguments.is_empty() && !command.arguments.starts_with('[');
    if rest.as_str().is_empty() && required {
        let fault = line.fault(code::BAD_COMMAND, format!("`:{}` needs more", command.name), "");
        return Err(fault.help(format!("write `:{} {}`", command.name, command.arguments)));
    }
    if command.arguments.is_empty() && !rest.as_str().is_empty() {
        return Err(rest.fault(code::BAD_COMMAND, format!("`:{}` stands alone", command.name), "unexpected"));
    }
    (command.run)(state, &rest)
}

const INTRODUCTION: &str = "\
x = [1, 2]              a box for x; x = 0.1 and x = pi/2 are numbers, exactly
x^2 - sin(2x)           encloses all values over the boxes: enclosure, width, decoration
let a = 3, fn f(u) = u^2, param, import \"file.imp\"    definitions as in files

decorations: com defined, continuous and bounded; dac continuous; def defined; trv nothing is known
";

fn help(state: &mut State, name: &Snippet) -> Result<String, Messages> {
    let word = name.as_str();
    if !word.is_empty() {
        return describe(state, word).ok_or_else(|| {
            let fault = name.fault(code::UNKNOWN_NAME, format!("nothing is known of `{word}`"), "");
            match did_you_mean(word, names(state).iter().map(String::as_str)) {
                Some(near) => fault.help(format!("did you mean `{near}`?")),
                None => fault.help("`:help` alone lists the commands"),
            }
        });
    }
    let usage = |command: &Command| format!(":{} {}", command.name, command.arguments);
    let width = COMMANDS.iter().map(|command| usage(command).len()).max().unwrap_or(0);
    let lines: Vec<String> =
        COMMANDS.iter().map(|command| format!("{:width$}  {}", usage(command), command.help)).collect();
    let functions: Vec<&str> = program::BUILTINS.iter().map(|builtin| builtin.name).collect();
    let mut text = format!("{INTRODUCTION}\n{}\n\n", lines.join("\n"));
    text += &wrapped("functions:", &functions, state.columns);
    text += "\nand the standard library; Tab completes, `:help NAME` explains";
    Ok(text)
}

/// Words in lines that are not too long.
fn wrapped(first: &str, words: &[&str], columns: usize) -> String {
    let mut text = first.to_owned();
    let mut column = first.len();
    for word in words {
        if column + 1 + word.len() > columns {
            text.push_str("\n ");
            column = 1;
        }
        text.push(' ');
        text.push_str(word);
        column += 1 + word.len();
    }
    text
}

/// All names that have a meaning.
pub fn names(state: &State) -> Vec<String> {
    let commands = COMMANDS.iter().map(|command| format!(":{}", command.name));
    let builtins = program::BUILTINS.iter().map(|builtin| builtin.name.to_owned());
    let library = program::stdlib_docs().iter().map(|doc| doc.name.to_owned());
    let own = state.workspace.definitions().filter_map(|(name, _)| name.map(str::to_owned));
    let imported = state.workspace.imported().iter().map(|(name, _)| name.clone());
    let variables = state.bindings.keys().cloned();
    let mut all: Vec<String> =
        variables.chain(own).chain(imported).chain(builtins).chain(library).chain(commands).collect();
    all.extend(["pi", "tau", "e"].map(str::to_owned));
    all.sort();
    all.dedup();
    all
}

/// What one name means, the first line being the short form.
pub fn describe(state: &State, name: &str) -> Option<String> {
    if let Some(value) = state.bindings.get(name) {
        return Some(format!("{name} = {}", value.interval()));
    }
    if let Some((_, written)) = state.workspace.definitions().find(|(defined, _)| *defined == Some(name)) {
        return Some(written.to_owned());
    }
    if let Some((_, written)) = state.workspace.imported().iter().find(|(defined, _)| defined == name) {
        return Some(written.clone());
    }
    let command = name.strip_prefix(':').unwrap_or(name);
    if let Some(command) = COMMANDS.iter().find(|other| other.name == command) {
        return Some(format!(":{} {}: {}", command.name, command.arguments, command.help));
    }
    if let Some(builtin) = program::BUILTINS.iter().find(|builtin| builtin.name == name) {
        let more = if builtin.variadic { ", ..." } else { "" };
        return Some(format!("{name}({}{more}): {}", builtin.parameters.join(", "), builtin.help));
    }
    if let Some(doc) = program::stdlib_docs().iter().find(|doc| doc.name == name) {
        return Some(format!("{}: {}", doc.signature, doc.text()));
    }
    match name {
        "pi" => Some("pi = 3.14159..., exactly".to_owned()),
        "tau" => Some("tau = 2 pi, exactly".to_owned()),
        "e" => Some("e = exp(1), exactly".to_owned()),
        _ => None,
    }
}

fn arith(state: &mut State, name: &Snippet) -> Result<String, Messages> {
    if name.as_str().is_empty() {
        let all: Vec<&str> = Choice::names().collect();
        return Ok(format!("{}\n{}", state.choice, wrapped("there are", &all, state.columns)));
    }
    match Choice::from_name(name.as_str()) {
        Ok(choice) => {
            state.choice = choice;
            Ok(String::new())
        }
        Err(diagnostic) => {
            let mut messages = name.fault(diagnostic.code, diagnostic.title, "");
            for help in diagnostic.help {
                messages = messages.help(help);
            }
            Err(messages)
        }
    }
}

fn load(state: &mut State, path: &Snippet) -> Result<String, Messages> {
    let text = path.as_str();
    // Quotes may be written, as after `import`.
    let inner = text.strip_prefix('"').and_then(|rest| rest.strip_suffix('"'));
    let path = if inner.is_some() { path.within(1..text.len() - 1) } else { path.clone() };
    state.workspace.load(&path, &state.bindings)?;
    let names: Vec<&str> = state.workspace.imported().iter().map(|(name, _)| name.as_str()).collect();
    Ok(wrapped(&format!("loaded {}:", path.as_str()), &names, state.columns))
}

fn vars(state: &mut State, _: &Snippet) -> Result<String, Messages> {
    let variables = state.bindings.iter().map(|(name, value)| format!("{name} = {}", value.interval()));
    let definitions = state.workspace.definitions().map(|(name, written)| match name {
        Some(_) => written.to_owned(),
        None => format!("import {}", written.trim_start_matches("import").trim()),
    });
    let all: Vec<String> = variables.chain(definitions).collect();
    Ok(if all.is_empty() { "nothing is defined".to_owned() } else { all.join("\n") })
}

fn reset(state: &mut State, _: &Snippet) -> Result<String, Messages> {
    state.workspace = Default::default();
    state.bindings.clear();
    Ok(String::new())
}

fn quit(state: &mut State, _: &Snippet) -> Result<String, Messages> {
    state.finish();
    Ok(String::new())
}
