//! `imp repl`: calculating with boxes, line by line.
//!
//! [`State`] is the whole session: a line in, a text out. What is around it only edits lines (`complete`), reads them
//! from a terminal or a pipe and prints the answers (here). One file a group of commands: `compare`, `roots`,
//! `derivative` on `formula`, `inspect`, `plot` on `chart`; `commands` is the table of all.

mod chart;
mod commands;
mod compare;
mod complete;
mod derivative;
mod formula;
mod inspect;
mod plot;
mod roots;
mod state;
mod table;

use std::env;
use std::fs;
use std::io;
use std::io::BufRead;
use std::io::IsTerminal;
use std::io::Write;
use std::path::PathBuf;

use rustyline::Config;
use rustyline::Editor;
use rustyline::config::CompletionType;
use rustyline::error::ReadlineError;
use rustyline::history::FileHistory;

use crate::diagnostic::Diagnostic;
use crate::diagnostic::SourceMap;
use crate::diagnostic::code;
use crate::repl::complete::Assistant;
use crate::session::expression::Messages;

pub use crate::repl::state::State;

const PROMPT: &str = "imp> ";

/// Runs a session on stdin and stdout until its end.
///
/// # Errors
/// If stdin cannot be read; mistakes in lines are printed, and the session goes on.
pub fn run() -> Result<(), Diagnostic> {
    let plain = env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
    let colour = io::stderr().is_terminal() && !plain;
    if io::stdin().is_terminal() && io::stdout().is_terminal() { edit(colour) } else { read(colour) }
}

/// Prints what a line gave; `false` when the session is over.
fn answer(state: &mut State, line: &str, colour: bool) -> bool {
    print(state.line(line), colour) && !state.finished()
}

/// Results on stdout, messages on stderr; `false` when nobody reads them any more.
fn print(result: Result<String, Messages>, colour: bool) -> bool {
    match result {
        Ok(text) if text.is_empty() => true,
        Ok(text) => {
            let mut out = io::stdout().lock();
            writeln!(out, "{text}").and_then(|()| out.flush()).is_ok()
        }
        Err(messages) => io::stderr().write_all(messages.render(colour).as_bytes()).is_ok(),
    }
}

/// A session with line editing.
fn edit(colour: bool) -> Result<(), Diagnostic> {
    let config = Config::builder().completion_type(CompletionType::List).auto_add_history(true).build();
    let mut editor: Editor<Assistant, FileHistory> = Editor::with_config(config).map_err(|error| broken(&error))?;
    editor.set_helper(Some(Assistant::new(State::default(), colour)));
    let history = history_file();
    if let Some(file) = &history {
        // A history that cannot be read or written is not worth a word.
        let _ = editor.load_history(file);
    }
    print(Ok("Imp encloses formulas over boxes; `:help` says how, Ctrl-D leaves.".to_owned()), colour);
    loop {
        let columns = editor.dimensions().map_or(80, |(columns, _)| usize::from(columns));
        match editor.readline(PROMPT) {
            Ok(line) => {
                let Some(assistant) = editor.helper_mut() else { return Ok(()) };
                assistant.state.set_columns(columns);
                let more = answer(&mut assistant.state, &line, colour);
                if let Some(file) = &history {
                    let _ = editor.append_history(file);
                }
                if !more {
                    return Ok(());
                }
            }
            Err(ReadlineError::Interrupted) => {}
            Err(ReadlineError::Eof) => return Ok(()),
            Err(error) => return Err(broken(&error)),
        }
    }
}

fn broken(error: &dyn std::error::Error) -> Diagnostic {
    Diagnostic::error(code::CANNOT_OPEN, format!("cannot read from the terminal: {error}"))
}

/// Where lines are remembered: in the user's folder for such things, made if it is missing.
fn history_file() -> Option<PathBuf> {
    let set = |name: &str| env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let folder = set("XDG_STATE_HOME")
        .or_else(|| set("HOME").map(|home| home.join(".local").join("state")))
        .or_else(|| set("LOCALAPPDATA"))?
        .join("imp");
    fs::create_dir_all(&folder).ok()?;
    Some(folder.join("history"))
}

/// A session whose lines come from a pipe or a file: no prompt, nothing remembered.
fn read(colour: bool) -> Result<(), Diagnostic> {
    let mut state = State::default();
    let mut input = io::stdin().lock();
    let mut pending = Vec::new();
    loop {
        let read = input.read_until(b'\n', &mut pending);
        let length =
            read.map_err(|error| Diagnostic::error(code::CANNOT_OPEN, format!("cannot read stdin: {error}")))?;
        if pending.is_empty() {
            return Ok(());
        }
        let (mut sources, end) = (SourceMap::default(), length == 0);
        let (file, fault) = sources.add_bytes("stdin", &pending);
        let more = match fault {
            Some(fault) => print(Err(Messages { sources, diagnostics: vec![fault] }), colour),
            None => {
                let text = sources.get(file).text.clone();
                if !end && State::wants_more(&text) {
                    continue;
                }
                answer(&mut state, &text, colour)
            }
        };
        pending.clear();
        if !more || end {
            return Ok(());
        }
    }
}
