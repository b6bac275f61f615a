//! The `imp` command as its users meet it: exit status, files written, and what it says about mistakes.
//!
//! `tests/cli/errors/NAME.imp` holds a mistake, `NAME.expected` what `imp check` says of it; inputs that are large or no
//! text are made here. With `IMP_BLESS=1` the messages found are written back.

#[path = "support/command.rs"]
mod command;

use std::fs;
use std::io::Read;
use std::io::Write;
use std::path::Path;
use std::path::PathBuf;
use std::process::Command;
use std::process::Stdio;

use command::command;
use command::fail;
use command::folder;
use command::run;
use command::succeed;

const SPHERE: &str = "x^2 + y^2 + z^2 = 1\n";

/// The names in a folder, sorted.
fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Width and height of a PNG file.
fn size(path: &Path) -> (u32, u32) {
    let picture = image::open(path).unwrap();
    (picture.width(), picture.height())
}

fn errors() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cli/errors")
}

/// Compares what `imp check FILE` says in the folder with the expectation of that name; a message if it differs.
fn compare(folder: &Path, name: &str) -> Option<String> {
    let output = run(folder, &["check", &format!("{name}.imp")]);
    let status = output.status.code().map_or("killed".to_owned(), |code| code.to_string());
    let (out, said) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    let found = format!("{out}{said}exit status {status}\n");
    let path = errors().join(format!("{name}.expected"));
    let expected = fs::read_to_string(&path).map(|text| text.replace("\r\n", "\n"));
    if expected.as_ref().is_ok_and(|expected| *expected == found) {
        return None;
    }
    if std::env::var_os("IMP_BLESS").is_some_and(|value| value == "1") {
        fs::write(&path, found).unwrap();
        return None;
    }
    Some(format!("=== {name}\n--- expected\n{}--- found\n{found}", expected.unwrap_or_default()))
}

#[test]
fn mistakes_get_helpful_messages() {
    let folder = errors();
    let names = names(&folder);
    let scenes: Vec<&str> = names.iter().filter_map(|name| name.strip_suffix(".imp")).collect();
    assert!(scenes.len() >= 20, "{scenes:?}");
    let faults: String = scenes.iter().filter_map(|name| compare(&folder, name)).collect();
    assert!(faults.is_empty(), "{faults}Run with IMP_BLESS=1 to accept.");
}

#[test]
fn hostile_files_get_helpful_messages() {
    let nested = |n: usize| format!("surface s: {}x{} = z\n", "(".repeat(n), ")".repeat(n));
    let mut sum = String::from("surface s: z = x");
    for i in 0..1_000_000 {
        sum += &format!(" + {}y", i % 1000);
    }
    let half_program = |n: usize| format!("let f0 = x\n{}surface s: f{n} = y + z\n", doubling(n));
    let inputs: Vec<(&str, Vec<u8>)> = vec![
        ("empty", Vec::new()),
        ("blank", b" \n\t\r\n\n".to_vec()),
        ("latin_1", b"# caf\xe9\nx^2 + y^2 + z^2 = 1\n".to_vec()),
        ("binary", (0..=255).cycle().take(5000).collect()),
        ("nested_100000", nested(100_000).into()),
        ("unclosed_100000", "(".repeat(100_000).into()),
        ("million_terms", sum.into()),
        ("doubling_60", half_program(60).into()),
        ("long_name", format!("surface s: {} = 1\n", "a".repeat(100_000)).into()),
    ];
    let folder = tempfile::tempdir().unwrap();
    let mut faults = String::new();
    for (name, bytes) in inputs {
        fs::write(folder.path().join(format!("{name}.imp")), bytes).unwrap();
        faults.extend(compare(folder.path(), name));
    }
    fs::create_dir(folder.path().join("folder.imp")).unwrap();
    faults.extend(compare(folder.path(), "folder"));
    assert!(faults.is_empty(), "{faults}Run with IMP_BLESS=1 to accept.");
}

#[test]
fn many_errors_are_counted() {
    let folder = folder(&[("many.imp", &"surface s: x + = 1\n".repeat(1000))]);
    let said = fail(folder.path(), &["check", "many.imp"]);
    assert!(said.contains("more errors are not shown") && said.matches("error[").count() <= 101, "{said}");
}

/// Definitions each of which uses the one before twice.
fn doubling(n: usize) -> String {
    (1..=n).map(|i| format!("let f{i} = f{} sin(f{})\n", i - 1, i - 1)).collect()
}

#[test]
fn a_formula_becomes_a_picture() {
    let folder = folder(&[("ball.imp", SPHERE)]);
    let said = succeed(folder.path(), &["render", "ball.imp"]);
    assert!(said.starts_with("ball.png: 512x512, "), "{said}");
    assert_eq!(size(&folder.path().join("ball.png")), (512, 512));
    succeed(folder.path(), &["render", "ball.imp", "-o", "small.png", "--size", "64x48", "--threads", "1"]);
    assert_eq!(size(&folder.path().join("small.png")), (64, 48));
    assert_eq!(names(folder.path()), ["ball.imp", "ball.png", "small.png"]);
}

#[test]
fn pictures_go_to_stdout() {
    let folder = folder(&[("ball.imp", SPHERE)]);
    let output = run(folder.path(), &["render", "ball.imp", "-o", "-", "--size", "16"]);
    assert!(output.status.success() && output.stdout.starts_with(b"\x89PNG"), "{output:?}");
    assert_eq!(names(folder.path()), ["ball.imp"]);
}

#[test]
fn layers_and_statistics_are_written() {
    let folder = folder(&[("ball.imp", SPHERE)]);
    let layers = ["--layer", "depth=d.png", "--layer", "normal=n.png", "--layer", "certainty=c.png"];
    let arguments =
        [&["render", "ball.imp", "--size", "40x30", "--stats", "json", "--repeat", "3"], &layers[..]].concat();
    let line = succeed(folder.path(), &arguments);
    let stats: serde_json::Value = serde_json::from_str(&line).unwrap();
    for name in ["compile_ms", "render_ms", "threads", "pixels", "hits", "proved", "unknown", "evaluations"] {
        assert!(stats.get(name).is_some(), "{name} is missing: {line}");
    }
    assert_eq!(stats["pixels"], 1200);
    for name in ["ball.png", "d.png", "n.png", "c.png"] {
        assert_eq!(size(&folder.path().join(name)), (40, 30), "{name}");
    }
}

#[test]
fn without_rounding_nothing_is_proved() {
    let folder = folder(&[("ball.imp", SPHERE)]);
    let line =
        succeed(folder.path(), &["render", "ball.imp", "--size", "32", "--rounding", "nearest", "--stats", "json"]);
    let stats: serde_json::Value = serde_json::from_str(&line).unwrap();
    assert!(stats["proved"] == 0 && stats["hits"].as_u64() > Some(0), "{line}");
}

#[test]
fn frames_are_numbered_and_differ() {
    let folder = folder(&[("wave.imp", "z = sqr(x - t)\ndomain [-1, 1]^3\n"), ("ball.imp", SPHERE)]);
    let said = succeed(folder.path(), &["render", "wave.imp", "--size", "32", "--frames", "8..11", "--fps", "10"]);
    assert_eq!(said.lines().count(), 3, "{said}");
    assert_eq!(names(folder.path()), ["ball.imp", "wave.imp", "wave_08.png", "wave_09.png", "wave_10.png"]);
    let read = |name| fs::read(folder.path().join(name)).unwrap();
    assert_ne!(read("wave_08.png"), read("wave_10.png"));
    succeed(folder.path(), &["render", "wave.imp", "--size", "32", "--set", "t=4/5", "-o", "set.png"]);
    assert_eq!(read("wave_08.png"), read("set.png"));
    assert!(fail(folder.path(), &["render", "ball.imp", "--frames", "0..2"]).contains("depends on the time"));
    assert!(fail(folder.path(), &["render", "wave.imp", "--frames", "0..2", "--set", "t=1"]).contains("both set"));
}

#[test]
fn parameters_are_set() {
    let folder =
        folder(&[("ball.imp", "param radius = 1 in [0.1, 2]\nx^2 + y^2 + z^2 = radius^2\ndomain [-2, 2]^3\n")]);
    let render = |setting: &'static str| ["render", "ball.imp", "--size", "32", "--stats", "json", "--set", setting];
    let hits = |setting| {
        let stats: serde_json::Value = serde_json::from_str(&succeed(folder.path(), &render(setting))).unwrap();
        stats["hits"].as_u64().unwrap()
    };
    assert!(hits("radius=sqrt(2)") > 2 * hits("radius=0.5"));
    for (setting, message) in [
        ("radius=3", "cannot be set to 3"),
        ("raduis=1", "did you mean `radius`?"),
        ("radius=x", "must be a constant"),
        ("radius=1 +", "value of radius"),
        ("radius", "such as a=0.5"),
    ] {
        let said = fail(folder.path(), &render(setting));
        assert!(said.contains(message), "{setting}: {said}");
    }
}

#[test]
fn wrong_arguments_are_the_users_mistake() {
    let folder = folder(&[("ball.imp", SPHERE)]);
    let cases: &[(&[&str], &str)] = &[
        (&[], "Usage"),
        (&["rendr", "ball.imp"], "render"),
        (&["render"], "FILE"),
        (&["render", "bal.imp"], "did you mean `ball.imp`?"),
        (&["render", "ball"], "did you mean `ball.imp`?"),
        (&["render", "."], "is a folder"),
        (&["render", "no/such.imp"], "nor a folder"),
        (&["render", "ball.imp", "--size", "0x5"], "1 to"),
        (&["render", "ball.imp", "--size", "big"], "640x480"),
        (&["render", "ball.imp", "--depth", "5", "--epsilon", "0.1"], "cannot be used with"),
        (&["render", "ball.imp", "--epsilon", "0"], "above 0"),
        (&["render", "ball.imp", "--threads", "0"], "threads"),
        (&["render", "ball.imp", "--frames", "5..1"], "smaller"),
        (&["render", "ball.imp", "--layer", "alpha=a.png"], "depth, normal and certainty"),
        (&["render", "ball.imp", "-o", "ball.jpg"], "write `ball.png`"),
        (&["render", "ball.imp", "-o", "ball.imp"], "PNG"),
        (&["render", "ball.imp", "-o", "a.png", "--layer", "depth=a.png"], "two outputs"),
        (&["render", "ball.imp", "-o", "no/a.png"], "there is no folder `no`"),
        (&["render", "ball.imp", "-o", "."], "it is a folder"),
        (&["emit", "tokns", "ball.imp"], "tokens"),
    ];
    for (arguments, message) in cases {
        let said = fail(folder.path(), arguments);
        assert!(said.contains(message), "{arguments:?}: {said}");
        assert_eq!(names(folder.path()), ["ball.imp"], "{arguments:?}");
    }
    assert!(succeed(folder.path(), &["--help"]).contains("render"));
    assert!(succeed(folder.path(), &["--version"]).starts_with("imp "));
}

#[test]
fn check_goes_through_all_files() {
    let folder = folder(&[("a.imp", "x + = 1"), ("b.imp", SPHERE), ("c.imp", "q = x")]);
    let output = run(folder.path(), &["check", "a.imp", "b.imp", "c.imp"]);
    let (out, said) = (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap());
    assert_eq!(output.status.code(), Some(1));
    assert!(out.starts_with("b.imp: 1 surface"), "{out}");
    assert!(said.contains("a.imp:1") && said.contains("c.imp:1"), "{said}");
}

#[test]
fn fmt_rewrites_in_place() {
    let folder = folder(&[("a.imp", "let  a=1\nx ^2+y^ 2 + z^2=a"), ("b.imp", SPHERE), ("c.imp", "x + = 1\n")]);
    let text = |name| fs::read_to_string(folder.path().join(name)).unwrap();
    assert!(fail(folder.path(), &["fmt", "--check", "a.imp", "b.imp"]).contains("`a.imp` is not in canonical layout"));
    assert_eq!(text("a.imp"), "let  a=1\nx ^2+y^ 2 + z^2=a");
    assert!(fail(folder.path(), &["fmt", "a.imp", "b.imp", "c.imp"]).contains("c.imp:1"));
    assert_eq!(text("a.imp"), "let a = 1\nx^2 + y^2 + z^2 = a\n");
    assert_eq!(text("c.imp"), "x + = 1\n");
    succeed(folder.path(), &["fmt", "--check", "a.imp", "b.imp"]);
    assert_eq!(names(folder.path()), ["a.imp", "b.imp", "c.imp"]);
}

#[test]
fn every_stage_is_emitted() {
    let folder = folder(&[("ball.imp", "surface ball: x^2 + y^2 + z^2 = 1\n"), ("bad.imp", "surface s: x = q\n")]);
    for (stage, part) in [
        ("tokens", "surface"),
        ("ast", "(surface ball"),
        ("graph", "out ball = "),
        ("passes", "# algebra"),
        ("interval", "# ball"),
        ("affine", "# ball"),
        ("gradient", "dball/dx"),
        ("clif", "function"),
        ("asm", "ret"),
    ] {
        let text = succeed(folder.path(), &["emit", stage, "ball.imp"]);
        assert!(text.contains(part), "{stage}: {text}");
    }
    let output = run(folder.path(), &["emit", "ast", "bad.imp"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(!output.stdout.is_empty() && !output.stderr.is_empty(), "{output:?}");
}

#[test]
fn certificates_are_verified() {
    let folder = folder(&[("ball.imp", "param r = 1 in [0.5, 2]\nx^2 + y^2 + z^2 = r\n"), ("egg.imp", SPHERE)]);
    let render = |set, name| ["render", "ball.imp", "--size", "48", "--set", set, "--certificate", name];
    succeed(folder.path(), &render("r=0.7", "ball.proof"));
    let said = succeed(folder.path(), &["verify", "ball.imp", "ball.proof", "--set", "r=0.7"]);
    assert!(said.starts_with("verified: ") && !said.contains(" 0 hits"), "{said}");
    // Of another scene, of other parameters, damaged, none at all.
    fail(folder.path(), &["verify", "egg.imp", "ball.proof"]);
    fail(folder.path(), &["verify", "ball.imp", "ball.proof", "--set", "r=0.8"]);
    let bytes = fs::read(folder.path().join("ball.proof")).unwrap();
    fs::write(folder.path().join("half.proof"), &bytes[..bytes.len() / 2]).unwrap();
    fail(folder.path(), &["verify", "ball.imp", "half.proof", "--set", "r=0.7"]);
    fail(folder.path(), &["verify", "ball.imp", "ball.imp"]);
    fail(folder.path(), &["verify", "ball.imp", "no.proof"]);
}

#[test]
fn explain_tells_the_plan() {
    let folder = folder(&[("ball.imp", SPHERE)]);
    assert!(succeed(folder.path(), &["explain", "ball.imp"]).contains("kernel"));
}

/// Every scene printed in README.md is one.
#[test]
fn scenes_of_the_readme_are_right() {
    let readme = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md")).unwrap();
    let scenes: Vec<&str> = readme.split("```imp\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    assert!(scenes.len() >= 4);
    for scene in scenes {
        let folder = folder(&[("scene.imp", scene)]);
        succeed(folder.path(), &["render", "scene.imp", "--size", "32"]);
        succeed(folder.path(), &["fmt", "scene.imp"]);
    }
}

/// `imp emit ... | head -1`: a reader that leaves is no error.
#[test]
fn a_closed_pipe_is_no_error() {
    let folder = folder(&[("ball.imp", SPHERE)]);
    let mut command = command(folder.path(), &["emit", "interval", "ball.imp", "--precision", "f64"]);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut first = [0];
    let mut out = child.stdout.take().unwrap();
    out.read_exact(&mut first).unwrap();
    drop(out);
    let output = child.wait_with_output().unwrap();
    assert!(output.stderr.is_empty() && output.status.code() == Some(0), "{output:?}");
}

/// Ctrl-C in the middle of a long picture leaves nothing behind.
#[cfg(unix)]
#[test]
fn an_interrupt_leaves_no_file() {
    let folder = folder(&[("ball.imp", SPHERE)]);
    let arguments = ["render", "ball.imp", "--size", "2048", "--repeat", "1000000", "--stats", "json"];
    let mut child = command(folder.path(), &arguments).stdout(Stdio::piped()).spawn().unwrap();
    // The handler is in place long before the first of a million pictures is done.
    std::thread::sleep(std::time::Duration::from_secs(1));
    let killed = Command::new("sh").args(["-c", &format!("kill -INT {}", child.id())]).status().unwrap();
    assert!(killed.success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(names(folder.path()), ["ball.imp"]);
}

/// Scenes from stdin, by the name that the system has for it.
#[cfg(target_os = "linux")]
#[test]
fn a_scene_may_come_from_a_pipe() {
    let folder = folder(&[]);
    let mut command = command(folder.path(), &["render", "/dev/stdin", "-o", "a.png", "--size", "8"]);
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::null()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(SPHERE.as_bytes()).unwrap();
    assert!(child.wait().unwrap().success());
    assert_eq!(names(folder.path()), ["a.png"]);
}
