//! The `imp` command: arguments to one call, errors to stderr, an exit status.

fn main() {}
