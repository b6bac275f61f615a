//! Random inputs for the front end: soups of tokens, and programs with bytes changed. Nothing may panic, every span
//! lies in its text, and what reads without errors is formatted to the same tree once and for all.
//!
//! `IMP_FUZZ_CASES` sets the number of cases (a few thousand by default); a failure names its seed, and
//! `IMP_FUZZ_SEED` starts there.

use std::fs;
use std::path::Path;

use imp::diagnostic::Diagnostic;
use imp::diagnostic::FileId;
use imp::diagnostic::SourceMap;
use imp::diagnostic::render;
use imp::syntax;
use imp::syntax::ast::Expr;
use imp::syntax::ast::Statement;
use imp::syntax::dump;

const FILE: FileId = FileId(0);
const CASES: u64 = 3_000;

/// Programs to change; between them they use all of the language.
const PROGRAMS: &[&str] = &[
    "# Barth\nlet phi = (1 + sqrt(5)) / 2\nsurface barth: 4(phi^2 x^2 - y^2)(phi^2 y^2 - z^2) = (1 + 2phi)\n    where x^2 < 3\ndomain [-2, 2]^3\n",
    "fn f(a, b = 2) = if a < b then -a^2 else |a - |b||\nparam k = 0.5 in [0, 1]; curve c: y = f(x, b = k)\n",
    "import \"a.imp\"\ncamera(position = [4, 3, 2], fov = 30)\nx² + π·y ≤ 0x1.8p+1 and not (y >= 2) or z != .5e-3\n",
    "domain [-1, 1] x [0, 2] × [0, 1]\nsurface s: max(x, y,\n  z) <= 2^-x y # end\n  - 3(z)\n",
    "surface t: ||x| - 1| + |y|^2 = |z|^2/(2x) * 3 / 4\n",
];

const WORDS: &[&str] = &[
    "x",
    "y",
    "f",
    "sin",
    "phi'",
    "2",
    ".5",
    "1e3",
    "0x1p2",
    "0x1f",
    "1e9999999999",
    "let",
    "fn",
    "param",
    "surface",
    "curve",
    "domain",
    "import",
    "where",
    "in",
    "if",
    "then",
    "else",
    "and",
    "or",
    "not",
    "+",
    "-",
    "-",
    "*",
    "/",
    "^",
    "=",
    "!=",
    "<",
    "<=",
    ">",
    ">=",
    "(",
    ")",
    "(",
    ")",
    "[",
    "]",
    "|",
    "|",
    "|",
    ",",
    ":",
    ";",
    "\n",
    "\n  ",
    "# c\n",
    "\"t\"",
    "\"",
    "²",
    "⁻¹",
    "×",
    "π",
    "≤",
    "**",
    "==",
    "&&",
    "!",
    "@",
    "{",
    "}",
    "é",
    "\u{301}",
    "\t",
    "\r\n",
    "\r",
    "\0",
];

fn soup(rng: &mut fastrand::Rng) -> String {
    let blanks = rng.bool();
    (0..rng.usize(0..40))
        .flat_map(|_| [WORDS[rng.usize(..WORDS.len())], if blanks || rng.u8(..4) == 0 { " " } else { "" }])
        .collect()
}

/// Mostly well-formed expressions, so that the formatter gets work.
fn formula(rng: &mut fastrand::Rng, depth: u32) -> String {
    if depth == 0 {
        let atoms = ["x", "y", "2", "0.5", "phi", "f(x)", "π", "x²", "3e2"];
        return atoms[rng.usize(..atoms.len())].to_string();
    }
    let blank = ["", " ", "  ", "\n    "][rng.usize(..4)];
    let part = |rng: &mut fastrand::Rng| formula(rng, depth - 1);
    let (a, b) = (part(rng), part(rng));
    match rng.u8(..14) {
        0 | 1 => format!("{a}{blank}+ {b}"),
        2 => format!("{a} -{blank}{b}"),
        3 => format!("{a}{blank}*{blank}{b}"),
        4 => format!("({a}) / ({b})"),
        5 => format!("({a}){blank}^2"),
        6 => format!("-{blank}{a}"),
        7 => format!("({blank}{a}) ({b})"),
        8 => format!("2{a}"),
        9 => format!("|{a}|"),
        10 => format!("g({a},{blank}k ={b})"),
        11 => format!("[{a},{b}{blank}]"),
        12 => format!("(if {a} < {b} then {a} else {b})"),
        _ => format!("({a} = {b} and not {a} <= {b})"),
    }
}

fn mutated(rng: &mut fastrand::Rng, programs: &[String]) -> Vec<u8> {
    let mut bytes = programs[rng.usize(..programs.len())].clone().into_bytes();
    if bytes.len() > 2_000 {
        let start = rng.usize(..bytes.len() - 1_000);
        bytes = bytes[start..start + 1_000].to_vec();
    }
    for _ in 0..rng.usize(1..6) {
        let at = rng.usize(..bytes.len().max(1)).min(bytes.len());
        match rng.u8(..5) {
            0 => drop(bytes.drain(at..(at + rng.usize(0..8)).min(bytes.len()))),
            1 if at < bytes.len() => bytes[at] = rng.u8(..),
            2 => drop(bytes.splice(at..at, WORDS[rng.usize(..WORDS.len())].bytes())),
            3 => bytes.truncate(at),
            _ => {
                let from = rng.usize(..=bytes.len());
                let piece = bytes[from..(from + rng.usize(0..20)).min(bytes.len())].to_vec();
                drop(bytes.splice(at..at, piece));
            }
        }
    }
    bytes
}

fn spans_of(found: &[Diagnostic], text: &str) {
    for diagnostic in found {
        assert!(!diagnostic.title.is_empty());
        for label in &diagnostic.labels {
            inside(label.span.start, label.span.end, text);
        }
    }
}

fn inside(start: u32, end: u32, text: &str) {
    assert!(start <= end && text.get(start as usize..end as usize).is_some(), "span {start}..{end}");
}

/// Every part lies in the whole.
fn spans_of_expr(expr: &Expr, text: &str) {
    inside(expr.span.start, expr.span.end, text);
    expr.parts(|part| {
        assert!(expr.span.start <= part.span.start && part.span.end <= expr.span.end);
        spans_of_expr(part, text);
    });
}

fn spans_of_statement(statement: &Statement, text: &str) {
    inside(statement.span.start, statement.span.end, text);
    statement.kind.expressions(|expr| {
        assert!(statement.span.start <= expr.span.start && expr.span.end <= statement.span.end);
        spans_of_expr(expr, text);
    });
}

/// The comments of a text without errors, in order: `#` stands nowhere else but in quotes.
fn comments(text: &str) -> Vec<String> {
    let behind = |line: &str| {
        let unquoted = line.char_indices().scan(false, |quoted, (i, c)| {
            *quoted ^= c == '"';
            Some((i, c == '#' && !*quoted))
        });
        unquoted.filter(|(_, hash)| *hash).map(|(i, _)| line[i..].trim_end().to_string()).next()
    };
    text.split(['\n', '\r']).filter_map(behind).collect()
}

/// All that must hold for any text; whether it reads without errors.
fn check(text: &str) -> bool {
    let mut map = SourceMap::default();
    let file = map.add("fuzz.imp", text);
    let (module, found) = syntax::parse(file, text);
    spans_of(&found, text);
    module.statements.iter().for_each(|s| spans_of_statement(s, text));
    render(&map, &found, text.len().is_multiple_of(2));
    dump::tokens(text);
    syntax::wants_more(text);
    match syntax::parse_expression(FILE, text) {
        Ok(expr) => spans_of_expr(&expr, text),
        Err(found) => {
            assert!(!found.is_empty());
            spans_of(&found, text);
        }
    }
    let tree = dump::ast(&module);
    let good = found.is_empty();
    match syntax::format::format(FILE, text) {
        Err(found) => assert!(!found.is_empty()),
        Ok(formatted) => {
            assert!(found.is_empty());
            let (again, found) = syntax::parse(FILE, &formatted);
            assert!(found.is_empty(), "formatted:\n{formatted}\n{}", found[0].title);
            assert_eq!(tree, dump::ast(&again), "formatted:\n{formatted}");
            assert_eq!(formatted, syntax::format::format(FILE, &formatted).unwrap(), "formatted twice");
            assert_eq!(comments(text), comments(&formatted));
            assert!(formatted.lines().all(|l| l.trim_end() == l), "blanks at line ends:\n{formatted}");
        }
    }
    good
}

fn setting(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(default)
}

/// The files of the repository that are written in the language.
fn imp_files(folder: &str) -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|e| e.path());
    let mut files: Vec<_> = entries.filter(|p| p.extension().is_some_and(|e| e == "imp")).collect();
    files.sort();
    files.iter().map(|f| fs::read_to_string(f).unwrap()).collect()
}

fn programs() -> Vec<String> {
    let own = PROGRAMS.iter().copied().map(String::from);
    own.chain(imp_files("stdlib")).chain(imp_files("examples")).collect()
}

#[test]
fn the_programs_themselves_are_good() {
    for program in programs() {
        let found = syntax::parse(FILE, &program).1;
        assert!(found.is_empty(), "{program}\n{found:?}");
        check(&program);
    }
}

#[test]
fn nothing_panics() {
    let programs = programs();
    let start = setting("IMP_FUZZ_SEED", 0);
    let cases = setting("IMP_FUZZ_CASES", CASES);
    let mut good = 0;
    for seed in start..start + cases {
        let mut rng = fastrand::Rng::with_seed(seed);
        let text = match seed % 3 {
            0 => soup(&mut rng),
            1 => {
                let depth = rng.u32(1..5);
                let (a, b) = (formula(&mut rng, depth), formula(&mut rng, 1));
                let open = ["", "let a = ", "surface s: ", "fn f(a,b = 1)= ", "   "][rng.usize(..5)];
                format!("{open}{a}\n\n\n# c\nlet b = {b}; curve c: {a} = {b} where x<1")
            }
            _ => {
                let bytes = mutated(&mut rng, &programs);
                let mut map = SourceMap::default();
                let (file, fault) = map.add_bytes("fuzz.imp", &bytes);
                assert_eq!(fault.is_some(), std::str::from_utf8(&bytes).is_err());
                render(&map, fault.as_slice(), false);
                map.get(file).text.to_string()
            }
        };
        let outcome = std::panic::catch_unwind(|| check(&text));
        good += u64::from(matches!(outcome, Ok(true)));
        assert!(outcome.is_ok(), "seed {seed}, IMP_FUZZ_SEED={seed} IMP_FUZZ_CASES=1 repeats it:\n{text}");
    }
    // Otherwise the formatter would hardly be tried.
    assert!(good > cases / 10 || cases < CASES, "only {good} of {cases} inputs read without errors");
}
