//! Source text to tokens to AST; no meaning.

pub mod ast;
