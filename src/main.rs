//! The `imp` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    imp::cli::main()
}
