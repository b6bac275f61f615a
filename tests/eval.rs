//! `imp eval` as its users meet it: enclosures and messages as text, and the stream of JSON lines, in which every line
//! has its answer, whatever it holds and however it arrives.

use std::fs;
use std::io::BufRead;
use std::io::BufReader;
use std::io::Write;
use std::path::Path;
use std::process::Command;
use std::process::Output;
use std::process::Stdio;

use serde_json::Value;

fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_imp"));
    command.arg("eval").args(arguments).env_remove("NO_COLOR");
    command
}

fn run(arguments: &[&str]) -> Output {
    command(arguments).output().unwrap()
}

/// Runs a command that must succeed; its stdout.
fn succeed(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert!(output.status.success() && output.stderr.is_empty(), "{arguments:?}: {output:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// Runs a command that must fail as the user's mistake; its stderr.
fn fail(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert_eq!(output.status.code(), Some(1), "{arguments:?}: {output:?}");
    assert!(output.stdout.is_empty(), "{arguments:?}: {output:?}");
    String::from_utf8(output.stderr).unwrap()
}

/// What a stream of requests is answered, line by line.
fn stream(requests: &[u8], arguments: &[&str]) -> Vec<String> {
    let mut child = command(&[&["--json", "-"], arguments].concat())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut stdin = child.stdin.take().unwrap();
    let output = std::thread::scope(|scope| {
        scope.spawn(move || stdin.write_all(requests).unwrap());
        child.wait_with_output().unwrap()
    });
    assert!(output.status.success() && output.stderr.is_empty(), "{:?}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap().lines().map(str::to_owned).collect()
}

/// The code of an answer that is an error.
fn code(answer: &str) -> String {
    let value: Value = serde_json::from_str(answer).unwrap();
    value["error"]["code"].as_str().unwrap_or_else(|| panic!("{answer}")).to_owned()
}

#[test]
fn a_box_gives_enclosure_width_and_decoration() {
    assert_eq!(succeed(&["x^2 - 1", "x=[-1,2]"]), "[-1, 3]  width 4  com\n");
    assert_eq!(succeed(&["x^2 + y", "x=0.5", "y=1/4"]), "[0.5, 0.5]  width 0  com\n");
    // Decimals are the real numbers written, and hexadecimal floats are exact.
    let [tenth, exact] = [succeed(&["x", "x=0.1"]), succeed(&["x", "x=0x1.8p+1"])];
    assert!(tenth.starts_with("[0.09999999999999999, 0.1]"), "{tenth}");
    assert!(exact.starts_with("[3, 3]"), "{exact}");
    let sine = succeed(&["sin(x)", "x=[0, pi/2]"]);
    assert!(sine.starts_with("[0, 1]"), "{sine}");
    assert!(succeed(&["-x", "x=1"]).starts_with("[-1, -1]"));
    assert!(succeed(&["-1"]).starts_with("[-1, -1]"));
    assert!(succeed(&["x < 3", "x=[1, 2]"]).starts_with("true"));
}

#[test]
fn what_com_lacks_has_a_reason() {
    let root = succeed(&["sqrt(x)", "x=[-1,4]"]);
    assert!(root.starts_with("[0, 2]  width 2  trv"), "{root}");
    assert!(root.contains("may be undefined on part of the box: sqrt of [-1, 4]"), "{root}");
    assert!(succeed(&["ln(x)", "x=-1"]).contains("[empty]"));
    assert!(succeed(&["1/x", "x=[1, inf]"]).contains("dac"));
}

#[test]
fn arithmetics_are_chosen_by_name() {
    assert!(succeed(&["x(10 - x)", "x=[4,6]", "--arithmetic", "interval"]).starts_with("[16, 36]"));
    // Together they prove more than the natural extension.
    let auto = succeed(&["x(10 - x)", "x=[4,6]"]);
    let width = |text: &str| text.split("width ").nth(1).unwrap().split(' ').next().unwrap().parse::<f64>().unwrap();
    assert!(width(&auto) < 4.0, "{auto}");
    let all = succeed(&["x(10 - x)", "x=[4,6]", "--arithmetic", "all"]);
    assert!(all.lines().count() >= 11 && all.contains("centred2"), "{all}");
    for line in all.lines() {
        let ends = line.split(['[', ']']).nth(1).unwrap();
        let (lo, hi) = ends.split_once(", ").unwrap();
        // The exact range is [24, 25].
        assert!(lo.parse::<f64>().unwrap() <= 24.0 && hi.parse::<f64>().unwrap() >= 25.0, "{line}");
    }
    assert!(fail(&["x", "x=1", "--arithmetic", "afine"]).contains("did you mean `affine`?"));
}

#[test]
fn definitions_come_from_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("part.imp");
    fs::write(&file, "let a = 3\nfn f(u) = a u^2\nparam b = 2 in [0, 4]\n").unwrap();
    let file = file.to_str().unwrap();
    assert_eq!(succeed(&["f(x) + b", "x=[1,2]", "--definitions", file]), "[5, 14]  width 9  com\n");
    assert!(fail(&["1", "--definitions", "no/such/file.imp"]).contains("no such file"));
}

#[test]
fn mistakes_are_shown_where_they_are() {
    let sine = fail(&["sin 2x", "x=1"]);
    assert!(sine.contains("EXPR:1:1") && sine.contains("write `sin(2x)`"), "{sine}");
    assert!(fail(&["x + yy", "x=1"]).contains("unknown name `yy`"));
    assert!(fail(&["x"]).contains("give it one: `x=0.5`"));
    assert!(fail(&["x", "x=[2,1]"]).contains("write `[1, 2]`"));
    assert!(fail(&["x", "x=1 +"]).contains("value of x:1:"));
    assert!(fail(&["x", "x=1/0"]).contains("not defined"));
    assert!(fail(&["x", "sin=1"]).contains("built-in function"));
    assert!(fail(&["x", "2x=1"]).contains("not a name"));
    assert!(fail(&["x", "x"]).contains("such as `x=0.5`"));
    assert!(fail(&["x", "x=1", "x=2"]).contains("given twice"));
    // Both are reported in one run.
    let both = fail(&["x", "x=[2,1]", "y=["]);
    assert!(both.contains("value of x") && both.contains("value of y"), "{both}");
    assert!(fail(&["--json", "no/such/file"]).contains("nor a folder"));
}

#[test]
fn every_line_has_its_answer_in_order() {
    let mut requests = Vec::new();
    let mut expected = Vec::new();
    for i in 0..20_000u32 {
        let (line, answer) = match i % 10 {
            3 => (b"{\"expr\": \"x\", ".to_vec(), Err("E0422")),
            5 => (b"{\"expr\": \"x\xff\"}".to_vec(), Err("E0401")),
            7 => (format!("{{\"expr\": \"x + {i} +\", \"vars\": {{\"x\": \"1\"}}}}").into_bytes(), Err("E0114")),
            8 => (b" \t ".to_vec(), Ok(None)),
            _ => {
                let line = format!("{{\"expr\": \"x + {}\", \"vars\": {{\"x\": [\"{i}\", \"{i}.5\"]}}}}", i % 40);
                let answer =
                    format!("{{\"lo\": \"{}\", \"hi\": \"{}.5\", \"decoration\": \"com\"}}", i + i % 40, i + i % 40);
                (line.into_bytes(), Ok(Some(answer)))
            }
        };
        requests.extend(line);
        requests.push(b'\n');
        expected.extend(answer.transpose());
    }
    let answers = stream(&requests, &[]);
    assert_eq!(answers.len(), expected.len());
    for (answer, expected) in answers.iter().zip(&expected) {
        match expected {
            Ok(expected) => assert_eq!(answer, expected),
            Err(expected) => assert_eq!(code(answer), *expected, "{answer}"),
        }
    }
}

#[test]
fn hostile_lines_do_not_stop_the_stream() {
    let good = r#"{"expr": "1"}"#;
    let deep = format!(r#"{{"expr": {}"#, "[".repeat(100_000));
    let nested = format!(r#"{{"expr": "{}1{}"}}"#, "(".repeat(10_000), ")".repeat(10_000));
    let long = format!(r#"{{"expr": "{}"}}"#, "1 + ".repeat(5_000_000));
    let doubling = format!(r#"{{"expr": "{}x", "vars": {{"x": "2"}}}}"#, "exp(".repeat(3000));
    let lines = [good, "null", "1e999999", &deep, &nested, &long, &doubling, "{}", "\u{feff}", good];
    // The last line lacks its end.
    let answers = stream(lines.join("\n").as_bytes(), &[]);
    assert_eq!(answers.len(), lines.len());
    let one = r#"{"lo": "1", "hi": "1", "decoration": "com"}"#;
    assert!(answers[0] == one && answers[lines.len() - 1] == one);
    for answer in &answers[1..lines.len() - 1] {
        assert_eq!(code(answer).len(), 5, "{answer}");
        assert!(answer.len() < 2000, "{}", answer.len());
    }
    assert!(stream(b"", &[]).is_empty());
}

#[test]
fn a_program_can_ask_and_read_in_turns() {
    let mut child = command(&["--json", "-"]).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let mut stdin = child.stdin.take().unwrap();
    let mut answers = BufReader::new(child.stdout.take().unwrap()).lines();
    for i in 0..50 {
        // The next question is only asked when this one is answered.
        writeln!(stdin, r#"{{"expr": "sqr(x)", "vars": {{"x": "{i}"}}}}"#).unwrap();
        let answer = answers.next().unwrap().unwrap();
        assert_eq!(answer, format!(r#"{{"lo": "{0}", "hi": "{0}", "decoration": "com"}}"#, i * i));
    }
    drop(stdin);
    assert!(answers.next().is_none() && child.wait().unwrap().success());
}

#[test]
fn numbers_read_back_exactly() {
    let mut random = fastrand::Rng::with_seed(3);
    let mut requests = String::new();
    let mut numbers = Vec::new();
    while numbers.len() < 2000 {
        let number = f64::from_bits(random.u64(..));
        if number.is_finite() {
            requests += &format!("{{\"expr\": \"x\", \"vars\": {{\"x\": \"{number:?}\"}}}}\n");
            numbers.push(number);
        }
    }
    for (answer, number) in stream(requests.as_bytes(), &[]).iter().zip(numbers) {
        let value: Value = serde_json::from_str(answer).unwrap();
        let end = |name: &str| value[name].as_str().unwrap().parse::<f64>().unwrap();
        // The shortest decimal of a number is hardly ever that number: one end is, the other its neighbour.
        assert!(end("lo") <= number && number <= end("hi"), "{number}: {answer}");
        assert!(end("lo") >= number.next_down() && end("hi") <= number.next_up(), "{number}: {answer}");
        assert!(end("lo") == number || end("hi") == number, "{number}: {answer}");
    }
}

#[test]
fn requests_may_come_from_a_file_and_name_an_arithmetic() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("requests.jsonl");
    let request = r#"{"expr": "x(10 - x)", "vars": {"x": ["4", "6"]}}"#;
    fs::write(&file, format!("{request}\n")).unwrap();
    let path = file.to_str().unwrap();
    assert_eq!(succeed(&["--json", path]), "{\"lo\": \"16\", \"hi\": \"36\", \"decoration\": \"com\"}\n");
    assert_ne!(succeed(&["--json", path, "--arithmetic", "auto"]), succeed(&["--json", path]));
    let named = r#"{"expr": "x(10 - x)", "vars": {"x": ["4", "6"]}, "arithmetic": "auto"}"#;
    assert_eq!(stream(named.as_bytes(), &[]).concat() + "\n", succeed(&["--json", path, "--arithmetic", "auto"]));
    assert!(Path::new(path).exists());
}
