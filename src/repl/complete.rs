//! Completion of names, their help as a hint while typing, and when a text is complete.

use std::borrow::Cow;

use rustyline::Context;
use rustyline::Helper;
use rustyline::Result;
use rustyline::completion::Completer;
use rustyline::completion::FilenameCompleter;
use rustyline::completion::Pair;
use rustyline::highlight::Highlighter;
use rustyline::hint::Hint;
use rustyline::hint::Hinter;
use rustyline::validate::ValidationContext;
use rustyline::validate::ValidationResult;
use rustyline::validate::Validator;

use crate::repl::commands;
use crate::repl::state::State;

/// What the line editor asks of a session.
pub struct Assistant {
    pub state: State,
    pub colour: bool,
    files: FilenameCompleter,
}

impl Assistant {
    pub fn new(state: State, colour: bool) -> Self {
        Self { state, colour, files: FilenameCompleter::new() }
    }
}

impl Helper for Assistant {}

/// Where the name that ends at `end` begins; `:` belongs to a command at the start of a line.
fn word_start(line: &str, end: usize) -> usize {
    let before = &line[..end];
    let name = before.trim_end_matches(|c: char| c.is_alphanumeric() || c == '_' || c == '\'');
    if name.trim_start() == ":" { name.len() - 1 } else { name.len() }
}

/// Whether a file is to be named at this place.
fn names_file(line: &str) -> bool {
    let line = line.trim_start();
    line.starts_with(":load ") || line.starts_with("import \"")
}

impl Completer for Assistant {
    type Candidate = Pair;

    fn complete(&self, line: &str, position: usize, context: &Context<'_>) -> Result<(usize, Vec<Pair>)> {
        if names_file(line) {
            return self.files.complete(line, position, context);
        }
        let start = word_start(line, position);
        let word = &line[start..position];
        if word.is_empty() {
            return Ok((start, Vec::new()));
        }
        let pair = |name: String| {
            let meaning = commands::describe(&self.state, &name);
            let first = meaning.as_deref().and_then(|meaning| meaning.lines().next());
            let display = first.filter(|_| name.len() > word.len()).unwrap_or(&name).to_owned();
            Pair { display, replacement: name }
        };
        let names = commands::names(&self.state).into_iter().filter(|name| name.starts_with(word));
        Ok((start, names.map(pair).collect()))
    }
}

/// The rest of a name that may be meant, or the help on one that is written.
pub struct Suggestion {
    shown: String,
    completion: Option<String>,
}

impl Hint for Suggestion {
    fn display(&self) -> &str {
        &self.shown
    }

    fn completion(&self) -> Option<&str> {
        self.completion.as_deref()
    }
}

impl Hinter for Assistant {
    type Hint = Suggestion;

    fn hint(&self, line: &str, position: usize, _: &Context<'_>) -> Option<Suggestion> {
        if position < line.len() {
            return None;
        }
        // Inside the brackets of a call its function is explained.
        let called = line.strip_suffix('(').unwrap_or(line);
        let word = &called[word_start(called, called.len())..];
        if word.is_empty() {
            return None;
        }
        let room = self.state.columns().saturating_sub(line.chars().count() + 12);
        let clipped = |text: &str| text.lines().next().unwrap_or_default().chars().take(room).collect::<String>();
        if let Some(meaning) = commands::describe(&self.state, word).filter(|_| word.len() > 1) {
            return Some(Suggestion { shown: format!("   {}", clipped(&meaning)), completion: None });
        }
        let names = commands::names(&self.state);
        let mut fitting = names.iter().filter(|name| name.starts_with(word) && word.len() > 1);
        let (only, None) = (fitting.next()?, fitting.next()) else { return None };
        let rest = only[word.len()..].to_owned();
        Some(Suggestion { shown: rest.clone(), completion: Some(rest) })
    }
}

impl Highlighter for Assistant {
    fn highlight_hint<'h>(&self, hint: &'h str) -> Cow<'h, str> {
        if self.colour { format!("\x1b[2m{hint}\x1b[0m").into() } else { hint.into() }
    }

    fn highlight_prompt<'b, 's: 'b, 'p: 'b>(&'s self, prompt: &'p str, _: bool) -> Cow<'b, str> {
        if self.colour { format!("\x1b[1m{prompt}\x1b[0m").into() } else { prompt.into() }
    }
}

impl Validator for Assistant {
    fn validate(&self, context: &mut ValidationContext<'_>) -> Result<ValidationResult> {
        let more = State::wants_more(context.input());
        Ok(if more { ValidationResult::Incomplete } else { ValidationResult::Valid(None) })
    }
}
