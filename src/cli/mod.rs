//! The command line: arguments to one call, results to stdout or files, messages to stderr, and an exit status: 0 done,
//! 1 the user's mistake, 2 ours, 130 interrupted.

mod arguments;
mod arrange;
mod build;
mod cost;
mod eval;
mod failure;
mod files;
mod render;
mod text;
mod values;

use std::io;
use std::panic;
use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering;

use clap::Parser;

use crate::arrange::certificate::Certificate;
use crate::cli::arguments::Arguments;
use crate::cli::arguments::Command;
use crate::cli::failure::Failure;
use crate::repl;
use crate::session;
use crate::session::Override;

/// Runs the command that the process was given.
pub fn main() -> ExitCode {
    files::exit_on_interrupt();
    panic::set_hook(Box::new(report_panic));
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version come this way too. A reader that is gone needs no message.
            let _ = error.print();
            return ExitCode::from(u8::from(error.use_stderr()));
        }
    };
    match panic::catch_unwind(|| run(&arguments.command)) {
        Ok(Ok(())) => ExitCode::SUCCESS,
        Ok(Err(failure)) => {
            failure.print();
            ExitCode::from(failure.status())
        }
        Err(_) => ExitCode::from(failure::OURS),
    }
}

fn run(command: &Command) -> Result<(), Failure> {
    match command {
        Command::Render(arguments) => render::render(arguments),
        Command::Verify { file, certificate, settings } => verify(file, certificate, settings),
        Command::Explain { file, picture } => render::explain(file, picture),
        Command::Check { files } => text::check(files),
        Command::Fmt { files, check } => text::format(files, *check),
        Command::Emit(arguments) => text::emit(arguments),
        Command::Eval(arguments) => eval::eval(arguments),
        Command::Repl => Ok(repl::run()?),
        Command::Arrange(arguments) => arrange::arrange(arguments),
        Command::Cost(arguments) => cost::cost(arguments),
        Command::Build(arguments) => build::build(arguments),
    }
}

/// `imp verify`: the file's first bytes say what it certifies.
fn verify(file: &Path, certificate: &Path, settings: &[Override]) -> Result<(), Failure> {
    let bytes = session::bytes(certificate)?;
    match Certificate::is_one(&bytes) {
        true => arrange::verify(file, &bytes, settings),
        false => render::verify(file, &bytes, settings),
    }
}

/// Says of the first panic, on whichever thread, that it is not the user's fault.
fn report_panic(info: &panic::PanicHookInfo) {
    static REPORTED: AtomicBool = AtomicBool::new(false);
    if REPORTED.swap(true, Ordering::Relaxed) {
        return;
    }
    let place = info.location().map_or(String::new(), |location| format!(" ({location})"));
    let what = info.payload_as_str().unwrap_or("no message");
    let title = format!("this is a bug in Imp, not in your input: {what}{place}");
    let mut message = format!("error[{}]: {title}\n", crate::diagnostic::code::INTERNAL);
    message += "  = help: please report it with the command and the files that it read\n";
    let backtrace = std::backtrace::Backtrace::capture();
    if backtrace.status() == std::backtrace::BacktraceStatus::Captured {
        message += &backtrace.to_string();
    }
    let _ = io::Write::write_all(&mut io::stderr(), message.as_bytes());
}
