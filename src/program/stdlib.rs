//! The standard library: the files of `stdlib/`, embedded. Its names are visible without import and come after a file's
//! own and imported ones. A file of it is parsed only when one of its names is used.

use std::collections::HashMap;
use std::sync::OnceLock;

/// The path under which a file is imported and shown in messages, and its text.
pub(super) const FILES: &[(&str, &str)] = &[
    ("std/functions.imp", include_str!("../../stdlib/functions.imp")),
    ("std/shapes.imp", include_str!("../../stdlib/shapes.imp")),
    ("std/plane.imp", include_str!("../../stdlib/plane.imp")),
    ("std/csg.imp", include_str!("../../stdlib/csg.imp")),
    ("std/transforms.imp", include_str!("../../stdlib/transforms.imp")),
    ("std/surfaces.imp", include_str!("../../stdlib/surfaces.imp")),
    ("std/curves.imp", include_str!("../../stdlib/curves.imp")),
];

/// A function of the standard library, for completion and help.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LibraryDoc {
    /// Such as `std/shapes.imp`.
    pub file: &'static str,
    pub name: &'static str,
    /// Name and parameters as written, such as `sphere(radius = 1, center = [0, 0, 0])`.
    pub signature: &'static str,
    /// The comment lines above it, without `#`.
    pub doc: &'static str,
}

impl LibraryDoc {
    /// The comment with its `#` signs taken away.
    pub fn text(&self) -> String {
        let lines: Vec<&str> = self.doc.lines().map(|line| line.trim_start_matches('#').trim()).collect();
        lines.join("\n")
    }
}

/// Every function of the standard library in the order of its files.
pub fn stdlib_docs() -> &'static [LibraryDoc] {
    static DOCS: OnceLock<Vec<LibraryDoc>> = OnceLock::new();
    DOCS.get_or_init(|| FILES.iter().flat_map(|(file, text)| file_docs(file, text)).collect())
}

/// Which file of [`FILES`] defines a name.
pub(super) fn defining_file(name: &str) -> Option<usize> {
    static INDEX: OnceLock<HashMap<&'static str, usize>> = OnceLock::new();
    let index = INDEX.get_or_init(|| {
        let position = |file| FILES.iter().position(|(path, _)| *path == file);
        stdlib_docs().iter().filter_map(|doc| Some((doc.name, position(doc.file)?))).collect()
    });
    index.get(name).copied()
}

/// The functions of one file. Library files start each definition at the first column with `fn`; a test holds them to it.
fn file_docs(file: &'static str, text: &'static str) -> Vec<LibraryDoc> {
    let mut docs = Vec::new();
    let mut comment = None;
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        if line.starts_with('#') {
            let from = comment.map_or(start, |(from, _)| from);
            comment = Some((from, start + line.len()));
        } else {
            if line.starts_with("fn ") {
                let signature = signature(&text[start + "fn ".len()..]);
                let name = signature.split('(').next().unwrap_or(signature);
                let doc = comment.map_or("", |(from, to)| &text[from..to]);
                docs.push(LibraryDoc { file, name, signature, doc });
            }
            comment = None;
        }
        start += line.len();
    }
    docs
}

/// The text up to the bracket that closes the first one.
fn signature(text: &str) -> &str {
    let mut depth = 0;
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            b'(' | b'[' => depth += 1,
            b')' | b']' if depth == 1 => return &text[..=at],
            b')' | b']' => depth -= 1,
            _ => {}
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_function_is_documented_and_defined_once() {
        for (i, doc) in stdlib_docs().iter().enumerate() {
            assert!(!doc.text().trim().is_empty(), "{} in {} has no comment", doc.name, doc.file);
            assert!(doc.signature.ends_with(')'), "{}", doc.signature);
            assert!(stdlib_docs()[..i].iter().all(|other| other.name != doc.name), "{} is defined twice", doc.name);
        }
    }

    #[test]
    fn definitions_start_at_the_first_column() {
        for (file, text) in FILES {
            let count = text.matches("fn ").count();
            assert_eq!(file_docs(file, text).len(), count, "{file}: a `fn` elsewhere than at the start of a line");
        }
    }

    #[test]
    fn signatures_keep_their_defaults() {
        assert_eq!(signature("f(a, b = [0, (1)]) = a + b"), "f(a, b = [0, (1)])");
        assert_eq!(defining_file("sphere"), Some(1));
        assert_eq!(defining_file("no_such_function"), None);
    }
}
