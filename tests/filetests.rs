//! Tests that are readable files. `tests/filetests/FOLDER/NAME.txt` holds an input, a line `----` and the expected
//! output; each folder has one function from input to output. With `IMP_BLESS=1` the outputs found are written back.

use std::collections::HashMap;
use std::fs;
use std::io;
use std::panic::AssertUnwindSafe;
use std::panic::catch_unwind;
use std::path::Path;

use imp::derive::derivative_within;
use imp::diagnostic::FileId;
use imp::diagnostic::SourceMap;
use imp::diagnostic::render;
use imp::graph;
use imp::graph::Graph;
use imp::interval::Interval;
use imp::limits::Budget;
use imp::limits::Limits;
use imp::passes;
use imp::program;
use imp::program::Context;
use imp::program::Importer;
use imp::program::Scene;
use imp::program::scene::View;
use imp::syntax;

/// Between input and expectation, alone on its line.
const SEPARATOR: &str = "----\n";

/// Runs every file of a folder, in the order of names, and reports all that differ. A file without expectation fails,
/// and so does a folder without files.
fn check(folder: &str, run: fn(&str) -> String) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/filetests").join(folder);
    let bless = std::env::var_os("IMP_BLESS").is_some_and(|value| value == "1");
    let mut files: Vec<_> = fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|e| e == "txt"));
    files.sort();
    assert!(!files.is_empty(), "{} holds no tests", path.display());
    let mut faults = String::new();
    for file in files {
        let text = fs::read_to_string(&file).unwrap().replace("\r\n", "\n");
        let (input, expected) = match text.split_once(&format!("\n{SEPARATOR}")) {
            Some((input, expected)) => (format!("{input}\n"), Some(expected)),
            None => (format!("{}\n", text.trim_end()), None),
        };
        let Ok(mut found) = catch_unwind(AssertUnwindSafe(|| run(&input))) else {
            faults += &format!("=== {}\npanicked\n", file.display());
            continue;
        };
        if !found.ends_with('\n') {
            found.push('\n');
        }
        if expected == Some(found.as_str()) {
            continue;
        }
        if bless {
            fs::write(&file, format!("{input}{SEPARATOR}{found}")).unwrap();
        } else {
            let expected = expected.unwrap_or("(no expectation)\n");
            faults += &format!("=== {}\n--- expected\n{expected}--- found\n{found}", file.display());
        }
    }
    assert!(faults.is_empty(), "{faults}Run with IMP_BLESS=1 to accept.");
}

/// The textual form through the parser: the graph again, or the error.
fn graph_text(input: &str) -> String {
    match graph::parse(input) {
        Ok(graph) => graph.to_string(),
        Err(error) => format!("error: {error}"),
    }
}

/// A graph, and the bounds of its inputs, which are comment lines `# x in [-1, 1/2]`; other inputs are unbounded.
fn bounded_graph(input: &str) -> (Graph, Vec<Interval>) {
    let graph = graph::parse(input).unwrap();
    let bound = |name: &String| {
        let range = input.lines().find_map(|line| line.strip_prefix(&format!("# {name} in [")))?;
        let (lo, hi) = range.strip_suffix(']')?.split_once(", ")?;
        let end = |text: &str| Interval::from_rational(&text.parse().unwrap());
        Some(end(lo).hull(end(hi)))
    };
    let inputs = graph.variables().iter().map(|name| bound(name).unwrap_or(Interval::ENTIRE)).collect();
    (graph, inputs)
}

/// The graph after all passes.
fn rewritten(input: &str) -> String {
    let (graph, inputs) = bounded_graph(input);
    passes::run(&graph, &inputs).0.to_string()
}

/// What each pass did in each round.
fn rounds(input: &str) -> String {
    let (graph, inputs) = bounded_graph(input);
    passes::run(&graph, &inputs).1.iter().map(|report| report.to_string()).collect()
}

/// The messages about a file, as the user sees them.
fn syntax_errors(input: &str) -> String {
    let mut map = SourceMap::default();
    let file = map.add("test.imp", input);
    render(&map, &syntax::parse(file, input).1, false)
}

/// The trees of a file without errors.
fn syntax_trees(input: &str) -> String {
    let (module, found) = syntax::parse(FileId(0), input);
    assert!(found.is_empty(), "{found:?}");
    syntax::dump::ast(&module)
}

#[test]
fn graph() {
    check("graph", graph_text);
}

#[test]
fn passes() {
    check("passes", rewritten);
    check("rounds", rounds);
}

#[test]
fn syntax() {
    check("syntax_errors", syntax_errors);
    check("syntax_ast", syntax_trees);
    check("syntax_tokens", syntax::dump::tokens);
    check("syntax_format", |input| syntax::format::format(FileId(0), input).unwrap());
}

/// Files held in memory, for `import`.
struct Files(HashMap<String, String>);

impl Importer for Files {
    fn read(&self, path: &Path, _: usize) -> io::Result<String> {
        self.0.get(&*path.to_string_lossy()).cloned().ok_or_else(|| io::ErrorKind::NotFound.into())
    }

    fn names(&self, _: &Path) -> Vec<String> {
        let mut names: Vec<String> = self.0.keys().cloned().collect();
        names.sort();
        names
    }
}

/// A source file through parser and resolver: the scene as text, or the messages. Further files follow lines such as
/// `== part.imp`; a line `set NAME = VALUE` at the very start sets a parameter from outside.
fn resolved(input: &str) -> String {
    let mut overrides = Vec::new();
    let mut input = input;
    while let Some((line, rest)) = input.strip_prefix("set ").and_then(|rest| rest.split_once('\n')) {
        let (name, value) = line.split_once(" = ").unwrap();
        overrides.push((name.to_owned(), Interval::point(value.parse().unwrap())));
        input = rest;
    }
    let mut parts = input.split("== ");
    let main = parts.next().unwrap();
    let files = parts.map(|part| part.split_once('\n').unwrap()).map(|(name, text)| (name.to_owned(), text.to_owned()));
    let importer = Files(files.collect());
    let differentiate = |graph: &mut Graph, f, by, budget: &Budget| derivative_within(graph, f, by, budget);
    let budget = Budget::new(&Limits::default());
    let context =
        Context { importer: &importer, differentiate: &differentiate, overrides: &overrides, budget: &budget };
    let mut sources = SourceMap::default();
    let file = sources.add("main.imp", main);
    let (scene, diagnostics) = program::resolve(&mut sources, file, syntax::parse(file, main), &context);
    match scene {
        Some(scene) => format!("{}{}", scene_text(&scene), render(&sources, &diagnostics, false)),
        None => render(&sources, &diagnostics, false),
    }
}

fn scene_text(scene: &Scene) -> String {
    let ranges: Vec<String> = scene.domain.iter().map(|range| format!("[{}, {}]", range.lo(), range.hi())).collect();
    let chosen = if scene.domain_given { "" } else { " (chosen)" };
    let mut text = format!("domain {}{chosen}\n", ranges.join(" x "));
    for shape in &scene.shapes {
        let condition = shape.condition.map(|value| format!(" where {value}")).unwrap_or_default();
        text += &format!("{:?} {} = {}{condition}\n", shape.kind, shape.name, shape.field);
    }
    for parameter in &scene.parameters {
        let range = parameter.range.map(|range| format!(" in [{}, {}]", range.lo(), range.hi())).unwrap_or_default();
        text += &format!("param {} = {}{range}\n", parameter.name, parameter.value.mid());
    }
    if scene.view != View::default() {
        text += &format!("{:?}\n", scene.view);
    }
    text + &scene.graph.to_string()
}

#[test]
fn program() {
    check("program", resolved);
    check("program_errors", resolved);
}
