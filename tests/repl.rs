//! `imp repl`: sessions as lines in and text out, the same through a pipe, and lines that nobody would type.

use std::fs;
use std::io::Write;
use std::process::Command;
use std::process::Stdio;

use imp::repl::State;

/// What a line gives, messages included.
fn say(state: &mut State, line: &str) -> String {
    match state.line(line) {
        Ok(text) => text,
        Err(messages) => messages.render(false),
    }
}

/// The answer to the last of some lines.
fn last(lines: &[&str]) -> String {
    let mut state = State::default();
    lines.iter().map(|line| say(&mut state, line)).last().unwrap_or_default()
}

#[test]
fn a_session_binds_boxes_and_encloses() {
    let mut state = State::default();
    assert_eq!(say(&mut state, "x = [1, 2]"), "x = [1, 2]");
    assert_eq!(say(&mut state, "x^2"), "[1, 4]  width 3  com");
    assert_eq!(say(&mut state, "y = 2x"), "y = [2, 4]");
    assert_eq!(say(&mut state, "let a = 3"), "defined a");
    assert_eq!(say(&mut state, "fn f(u) = a u + y"), "defined f");
    assert_eq!(say(&mut state, "f(1)"), "[5, 7]  width 2  com");
    assert_eq!(say(&mut state, "a = 1; f(1) # as a variable"), "a = [1, 1]\n[3, 5]  width 2  com");
    assert_eq!(say(&mut state, "x < 3"), "true  [1, 1]  width 0  com");
    let vars = say(&mut state, ":vars");
    assert!(vars.contains("x = [1, 2]") && vars.contains("fn f(u) = a u + y"), "{vars}");
    assert_eq!(say(&mut state, ":reset"), "");
    assert!(say(&mut state, "f(1)").contains("`f`"));
    say(&mut state, ":quit");
    assert!(state.finished());
}

#[test]
fn decorations_have_reasons() {
    let root = last(&["x = [-1, 4]", "1 + sqrt(x)"]);
    assert!(root.ends_with("trv\n  may be undefined on part of the box: sqrt of [-1, 4]"), "{root}");
    assert!(last(&["x = [0, 2]", "floor(x)"]).contains("may jump on the box"));
}

#[test]
fn messages_are_those_of_files() {
    let sine = last(&["x = 1", "sin 2x"]);
    assert!(sine.contains("line 2:1:1") && sine.contains("write `sin(2x)`"), "{sine}");
    let compare = last(&["x = 1", ":compare sin 2x"]);
    assert!(compare.contains("line 2:1:10") && compare.contains(":compare sin 2x"), "{compare}");
    assert!(last(&[":compre x"]).contains("did you mean `:compare`?"));
    assert!(last(&[":arith afine"]).contains("did you mean `affine`?"));
    assert!(last(&[":show grph x"]).contains("did you mean `graph`?"));
    assert!(last(&[":help smothstep"]).contains("did you mean `smoothstep`?"));
    assert!(last(&["x = [2, 1]"]).contains("write `[1, 2]`"));
    assert!(last(&["x"]).contains("`x` has no value"));
    assert!(last(&["sin = 3"]).contains("built-in function"));
    assert!(last(&["surface s: x^2 = 1"]).contains("a shape belongs to a scene"));
    assert!(last(&[":root"]).contains("write `:root EXPR in [a, b]`"));
    assert!(last(&[":root x^2 - 2"]).contains("in [-10, 10]"));
    assert!(last(&[":root x y in [0, 1]"]).contains("give one of them a number"));
    assert!(last(&[":plot x"]).contains("has no value"));
    assert!(last(&["x = 1", ":plot x"]).contains("such as `x = [-1, 1]`"));
}

#[test]
fn a_failed_line_changes_nothing() {
    let mut state = State::default();
    say(&mut state, "let a = 2");
    for wrong in
        ["let a = b", "a = q", "let a = sin 2x", "fn a(u) = u +", "import \"no/such.imp\"", ":load no/such.imp"]
    {
        assert!(state.line(wrong).is_err(), "{wrong}");
    }
    assert_eq!(say(&mut state, "a"), "[2, 2]  width 0  com");
}

#[test]
fn lines_go_on_until_they_are_complete() {
    for open in ["let a = (1 +", "fn f(x) = ", "max(1,", "let a = 1 +\n  2 *"] {
        assert!(State::wants_more(open), "{open}");
    }
    for complete in ["", "x", "let a = 1", "max(1, 2)", ":compare (1 +", "(1 +\n\n", "sin 2x"] {
        assert!(!State::wants_more(complete), "{complete}");
    }
    assert_eq!(last(&["let a = (1 +\n  2)", "a"]), "[3, 3]  width 0  com");
}

#[test]
fn arithmetics_side_by_side() {
    let table = last(&["x = [4, 6]", ":compare x(10 - x)"]);
    assert!(table.lines().next().unwrap().starts_with("arithmetic"), "{table}");
    let row = |name: &str| table.lines().find(|line| line.split(' ').next() == Some(name)).unwrap().to_owned();
    assert!(row("interval").contains("[16, 36]"), "{table}");
    for name in ["affine1", "affine", "intersected", "centred", "centred2", "auto"] {
        assert!(row(name).contains("com"), "{table}");
    }
    let affine = last(&["x = [4, 6]", ":arith interval", "x(10 - x)"]);
    assert_eq!(affine, "[16, 36]  width 20  com");
    assert!(last(&[":arith"]).contains("centred2"));
}

#[test]
fn enclosures_converge_in_parts() {
    let table = last(&["x = [4, 6]", ":arith interval", ":bisect x(10 - x)"]);
    let widths: Vec<f64> =
        table.lines().skip(1).map(|line| line.split_whitespace().nth(3).unwrap().parse().unwrap()).collect();
    assert_eq!(widths.len(), 11, "{table}");
    assert!(widths.windows(2).all(|pair| pair[1] < pair[0]), "{table}");
    assert!(widths[0] == 20.0 && widths[10] < 1.03 && widths[10] >= 1.0, "{table}");
}

#[test]
fn roots_are_proved_or_unknown() {
    let golden = last(&[":root x^2 = x + 1 in [-2, 2]"]);
    assert!(golden.starts_with("2 proved roots:"), "{golden}");
    assert!(golden.contains("1.61803398874989") && golden.contains("-0.61803398874989"), "{golden}");
    assert!(golden.ends_with("no other root in [-2, 2]: proved"), "{golden}");
    let pole = last(&[":root tan(x) + 1 in [1, 3]"]);
    assert!(pole.contains("1 proved root:") && pole.contains("unknown") && pole.contains("2.35619449019234"), "{pole}");
    assert!(last(&["fn f(u) = u^3 - 2", ":root f in [0, 2]"]).contains("1.25992104989487"));
    assert!(last(&["a = 0.1", ":root a x = 1 in [0, 20]"]).contains("1 proved root"));
    assert!(last(&["x = 1", ":root x^2 = 2 in [0, 2]"]).contains("1 proved root"));
    assert_eq!(last(&[":root x^2 + 1 in [-5, 5]"]), "no root in [-5, 5]: proved");
}

#[test]
fn derivatives_are_formulas() {
    assert_eq!(last(&[":deriv x^3"]), "d/dx x^3 = 3*x^2");
    assert!(last(&["x = [0, 1]", ":deriv sin(x)"]).contains("d/dx sin(x) = cos(x)\n  in ["));
    assert!(last(&[":deriv x^2 * y, y"]).ends_with("= x^2"));
    assert!(last(&[":deriv x^2*y x"]).contains("d/dx x^2*y"));
    assert!(last(&[":deriv x y"]).contains("by which of them?"));
}

#[test]
fn stages_are_shown() {
    assert!(last(&[":show graph x^2 + 1"]).contains("out f"));
    let mut state = State::default();
    for stage in ["clif", "asm"] {
        match state.line(&format!(":show {stage} x^2 + 1")) {
            Ok(text) => assert!(text.lines().count() > 5, "{text}"),
            // The code generator does not know every machine.
            Err(messages) => assert_ne!(messages.diagnostics[0].code, "E0901"),
        }
    }
    let times = last(&["x = [1, 2]", ":time x^2 + 1"]);
    assert!(times.contains("interpreted") && times.contains(" ns"), "{times}");
}

#[test]
fn pictures_show_curve_and_bands() {
    let mut state = State::default();
    say(&mut state, "x = [-2, 2]");
    let picture = say(&mut state, ":plot x^3 - x");
    assert!(picture.contains('░') && picture.contains("└"), "{picture}");
    assert!(picture.chars().any(|c| ('\u{2801}'..='\u{28FF}').contains(&c)), "{picture}");
    assert!(say(&mut state, "a = 0.1; b = 2").starts_with("a = ["));
    assert!(say(&mut state, ":plot a x^b").contains('░'));
    let folder = tempfile::tempdir().unwrap();
    for (name, start) in [("a.svg", &b"<svg"[..]), ("a.png", &b"\x89PNG"[..])] {
        let path = folder.path().join(name);
        let answer = say(&mut state, &format!(":plot 1/x {}", path.display()));
        assert!(answer.starts_with("wrote "), "{answer}");
        assert!(fs::read(&path).unwrap().starts_with(start), "{name}");
    }
    assert!(
        say(&mut state, &format!(":plot x {}", folder.path().join("no/a.png").display()))
            .contains("there is no folder")
    );
}

#[test]
fn files_are_loaded_and_loaded_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("part.imp");
    let load = format!(":load {}", path.display());
    let mut state = State::default();
    fs::write(&path, "let a = 2\nfn f(u) = a u\n").unwrap();
    assert!(say(&mut state, &load).ends_with(": a f"));
    assert_eq!(say(&mut state, "f(3)"), "[6, 6]  width 0  com");
    fs::write(&path, "let a = 5\nfn f(u) = a u\n").unwrap();
    assert_eq!(say(&mut state, "f(3)"), "[6, 6]  width 0  com");
    say(&mut state, &load);
    assert_eq!(say(&mut state, "f(3)"), "[15, 15]  width 0  com");
    fs::write(&path, "let a = \n").unwrap();
    assert!(say(&mut state, &load).contains("part.imp:1:"));
    assert_eq!(say(&mut state, "f(3)"), "[15, 15]  width 0  com");
}

#[test]
fn a_pipe_is_a_session_without_a_prompt() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_imp"))
        .arg("repl")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let lines = b"x = [1, 2]\nlet a = (1 +\n 2)\r\na x\nsin 2x\n\xff\n\n# nothing\n:compare\nx^2";
    child.stdin.take().unwrap().write_all(lines).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{output:?}");
    let (out, errors) = (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap());
    assert_eq!(out, "x = [1, 2]\ndefined a\n[3, 6]  width 3  com\n[1, 4]  width 3  com\n");
    assert!(errors.contains("write `sin(2x)`") && errors.contains("not text in UTF-8"), "{errors}");
    assert!(errors.contains("write `:compare EXPR`"), "{errors}");
}

/// Random lines of pieces that mean something: nothing panics, and every answer ends.
#[test]
fn no_line_breaks_a_session() {
    const PIECES: &[&str] = &[
        "x",
        "y",
        "z",
        "t",
        "f",
        "a",
        "sin",
        "sqrt",
        "ln",
        "deriv",
        "sphere",
        "(",
        ")",
        "[",
        "]",
        "|",
        "^",
        "*",
        "/",
        "+",
        "-",
        " ",
        " ",
        ",",
        ";",
        "=",
        "<",
        "==",
        "1",
        "0",
        "2.5",
        "1e9",
        "0x1p-1074",
        "1e400",
        "pi",
        "inf",
        "entire",
        "empty",
        "let ",
        "fn ",
        "param ",
        "import ",
        "in ",
        "if ",
        " then ",
        " else ",
        ":compare ",
        ":bisect ",
        ":root ",
        ":deriv ",
        ":show graph ",
        ":plot ",
        ":help ",
        ":arith ",
        ":vars",
        ":",
        "\"",
        "#",
        "\n",
        "'",
        "é",
        "\u{0}",
        "[-1, 1]",
        "[1, 2]",
        "x = [0, 1]",
        "fn f(u) = ",
        " in [-1, 2]",
    ];
    let mut random = fastrand::Rng::with_seed(11);
    let mut state = State::default();
    for number in 0..3000 {
        if number % 50 == 0 {
            state = State::default();
            say(&mut state, "x = [-1, 2]");
        }
        let pieces = random.usize(1..10);
        let line: String = (0..pieces).map(|_| PIECES[random.usize(..PIECES.len())]).collect();
        State::wants_more(&line);
        let answer = say(&mut state, &line);
        assert!(!answer.contains("E0901"), "{line:?}: {answer}");
    }
}
