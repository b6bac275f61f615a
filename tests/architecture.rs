//! Layers, file sizes and headers: what no compiler checks. The layers are those of the table in `src/lib.rs`.

use std::fs;
use std::path::Path;
use std::path::PathBuf;

/// Every top-level module with its layer; a module imports only modules of a smaller number.
const LAYERS: &[(&str, u8)] = &[
    ("diagnostic", 0),
    ("control", 0),
    ("interval", 0),
    ("envelope", 1),
    ("graph", 1),
    ("limits", 1),
    ("syntax", 1),
    ("program", 2),
    ("passes", 2),
    ("derive", 3),
    ("kernel", 4),
    ("interpret", 5),
    ("codegen", 5),
    ("render", 5),
    ("arrange", 5),
    ("roots", 5),
    ("session", 6),
    ("accuracy", 6),
    ("repl", 7),
    ("library", 7),
    ("build", 8),
    ("cli", 9),
];

/// Past this a file is split.
const MAX_LINES: usize = 700;

fn layer(module: &str) -> Option<u8> {
    LAYERS.iter().find(|(name, _)| *name == module).map(|&(_, layer)| layer)
}

/// Every Rust file below `folder`, sorted.
fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        if entry.is_dir() {
            files.extend(rust_files(&entry));
        } else if entry.extension().is_some_and(|e| e == "rs") {
            files.push(entry);
        }
    }
    files.sort();
    files
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The top-level module that a file of `src` belongs to; `None` for the two crate roots.
fn module_of(file: &Path) -> Option<String> {
    let path = file.strip_prefix(root().join("src")).unwrap();
    let first = path.components().next().unwrap().as_os_str().to_str().unwrap();
    let module = first.trim_end_matches(".rs");
    (module != "lib" && module != "main").then(|| module.to_owned())
}

/// What is wrong with the imports of one file of the module `me`.
fn import_faults(me: &str, text: &str) -> Vec<String> {
    let mut faults = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let code = line.split("//").next().unwrap();
        let mut fault = |what: String| faults.push(format!("{}: {what}: {}", number + 1, line.trim()));
        if code.contains("crate::{") {
            fault("one `use crate::module::...` a line, no braces after `crate::`".to_owned());
        }
        if code.contains("super::super") {
            fault("name the path from `crate::`".to_owned());
        }
        for path in code.split("crate::").skip(1) {
            let other: String = path.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
            if other.is_empty() || other == me {
                continue;
            }
            match (layer(&other), layer(me)) {
                (Some(theirs), Some(mine)) if theirs >= mine => {
                    fault(format!("`{me}` (layer {mine}) must not import `{other}` (layer {theirs})"));
                }
                (None, _) => fault(format!("`{other}` is no module of the table of layers")),
                _ => {}
            }
        }
    }
    faults
}

#[test]
fn modules_import_only_smaller_layers() {
    let mut faults = Vec::new();
    for file in rust_files(&root().join("src")) {
        let Some(module) = module_of(&file) else { continue };
        if layer(&module).is_none() {
            faults.push(format!("{}: `{module}` has no layer", file.display()));
        }
        let text = fs::read_to_string(&file).unwrap();
        faults.extend(import_faults(&module, &text).into_iter().map(|fault| format!("{}:{fault}", file.display())));
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn the_import_check_finds_planted_faults() {
    for bad in [
        "use crate::codegen::x;",
        "use crate::session;",
        "use crate::{graph, kernel};",
        "use super::super::graph;",
        "    let x = crate::cli::run();",
        "use crate::elsewhere::x;",
    ] {
        assert_eq!(import_faults("render", bad).len(), 1, "{bad}");
    }
    assert!(import_faults("render", "use crate::kernel::Kernel; // not crate::cli").is_empty());
}

#[test]
fn files_are_short_and_open_with_their_purpose() {
    let mut faults = Vec::new();
    for folder in ["src", "tests"] {
        for file in rust_files(&root().join(folder)) {
            let text = fs::read_to_string(&file).unwrap();
            let lines = text.lines().count();
            if lines > MAX_LINES {
                faults.push(format!("{}: {lines} lines, more than {MAX_LINES}", file.display()));
            }
            if !text.starts_with("//!") {
                faults.push(format!("{}: no `//!` header", file.display()));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
