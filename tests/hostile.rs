//! Sources from people who do not mean well: each is refused within a second and 256 MB by a message that names the
//! problem, or accepted because it is harmless; through the library under `Limits::untrusted`, and by `imp check`, whose
//! limits are the default ones. Each runs in a process of its own, whose time and memory the system measures.
//!
//! `cargo test --test hostile -- --nocapture` prints the table; `IMP_ONLY=TEXT` picks cases by name, and `IMP_BLESS=1` writes
//! `tests/hostile/expected.txt` anew. The time is what the processor spent; an unoptimised build has ten times as much.
#![cfg(target_os = "linux")]

#[path = "hostile/cases.rs"]
mod cases;

use std::env;
use std::ffi::OsStr;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::Child;
use std::process::Command;
use std::process::Stdio;
use std::thread;
use std::time::Duration;
use std::time::Instant;

use imp::Error;
use imp::Function;
use imp::Loader;
use imp::Options;
use imp::diagnostic;
use imp::limits::Budget;
use imp::limits::Limits;
use imp::session;
use imp::session::Source;

/// In the environment of a process that compiles one file under the limits for strangers.
const FILE: &str = "IMP_HOSTILE_FILE";

const MEGABYTES: u64 = 256;
const SECONDS: f64 = if cfg!(debug_assertions) { 10.0 } else { 1.0 };

/// What became of a process.
struct Outcome {
    /// A code, `accepted`, or what must not happen.
    verdict: String,
    title: String,
    seconds: f64,
    megabytes: u64,
}

#[repr(C)]
#[derive(Default)]
struct Usage {
    /// User and system time, each in seconds and microseconds.
    times: [i64; 4],
    kilobytes: i64,
    rest: [i64; 13],
}

unsafe extern "C" {
    fn wait4(process: i32, status: *mut i32, options: i32, usage: *mut Usage) -> i32;
}

/// Waits for a process with what it took; ends it if it takes far too long.
fn wait(child: &Child) -> (i32, Usage) {
    const NO_HANG: i32 = 1;
    let process = child.id() as i32;
    let start = Instant::now();
    let (mut status, mut usage) = (0, Usage::default());
    loop {
        // SAFETY: both pointers are to live values of the types that Linux documents for 64-bit machines.
        let done = unsafe { wait4(process, &mut status, NO_HANG, &mut usage) };
        if done == process {
            return (status, usage);
        }
        if start.elapsed() > Duration::from_secs(60) {
            let _ = Command::new("kill").args(["-9", &process.to_string()]).status();
        }
        thread::sleep(Duration::from_millis(2));
    }
}

#[expect(clippy::zombie_processes, reason = "`wait4` waits, and says what the child has used")]
fn measure(mut command: Command, folder: &Path) -> Outcome {
    let said = folder.join("said");
    let output = fs::File::create(&said).unwrap();
    command.stdin(Stdio::null()).stdout(output.try_clone().unwrap()).stderr(output);
    let child = command.current_dir(folder).spawn().unwrap();
    let (status, usage) = wait(&child);
    let said = String::from_utf8_lossy(&fs::read(said).unwrap()).into_owned();
    let line = said.lines().find(|line| line.starts_with("error[") || line.contains("panicked"));
    let title = line.unwrap_or_default().to_owned();
    let exit = status >> 8;
    let verdict = match title.strip_prefix("error[").and_then(|rest| rest.split_once(']')) {
        None if said.contains("refused by the library") => "no code".to_owned(),
        _ if status & 0x7f != 0 => format!("signal {}", status & 0x7f),
        Some((code, _)) if exit == 1 || said.contains("refused by the library") => code.to_owned(),
        None if exit == 0 => "accepted".to_owned(),
        _ => format!("exit status {exit}"),
    };
    let [seconds, micros, more_seconds, more_micros] = usage.times;
    let seconds = (seconds + more_seconds) as f64 + (micros + more_micros) as f64 / 1e6;
    Outcome { verdict, title, seconds, megabytes: usage.kilobytes as u64 >> 10 }
}

/// Does nothing but in a process that was started for one case: kernels of the first and of the last function, and the scene.
#[test]
fn compile_one_file() {
    let Some(file) = env::var_os(FILE) else { return };
    let file = Path::new(&file);
    let result = Loader::new("", Limits::untrusted()).open(file).and_then(|program| {
        program.refused().first().map_or(Ok(()), |refused| Err(refused.error.clone()))?;
        let functions = program.functions();
        functions.iter().take(1).chain(functions.iter().skip(1).last()).try_for_each(kernels)
    });
    let budget = Budget::new(&Limits::untrusted());
    let artefact = session::compile_within(Source::File(file), &[], &budget);
    match result {
        Err(Error::Other(found)) => println!("\nerror[{}]: {}\nrefused by the library", found.code, found.title),
        Err(error) => println!("\n{error}\nrefused by the library"),
        Ok(()) if artefact.scene.is_none() => {
            let said = diagnostic::render(&artefact.sources, &artefact.diagnostics, false);
            println!("\n{said}\nrefused by the library");
        }
        Ok(()) => {}
    }
}

/// Bounds, bounds with a gradient, and points.
fn kernels(function: &Function) -> Result<(), Error> {
    function.intervals(&Options::default())?;
    function.intervals(&Options { gradient: true, ..Options::default() })?;
    function.points(&Options::default())?;
    Ok(())
}

fn command(program: impl AsRef<OsStr>, arguments: &[&str]) -> Command {
    let mut command = Command::new(program);
    command.args(arguments);
    command
}

#[test]
fn every_source_is_refused_or_harmless() {
    let only = env::var("IMP_ONLY").unwrap_or_default();
    let expected_path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/hostile/expected.txt");
    let (mut faults, mut verdicts) = (String::new(), String::new());
    println!("{:34} {:>8} {:>6} {:>4}   {:>8} {:>6} {:>4}", "", "library", "ms", "MB", "check", "ms", "MB");
    for case in cases::all().iter().filter(|case| case.name.contains(&only)) {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("main.imp");
        let library = || {
            let mut library = command(env::current_exe().unwrap(), &["--exact", "compile_one_file", "--nocapture"]);
            library.env(FILE, &file);
            library
        };
        let check = || command(env!("CARGO_BIN_EXE_imp"), &["check", "main.imp"]);
        // Of a text that is too large, a smaller one of its kind says more.
        let outcome = |limits: Limits, command: &dyn Fn() -> Command| {
            case.write(folder.path(), 1);
            let whole = measure(command(), folder.path());
            let divisor = fs::metadata(&file).unwrap().len() as usize * 11 / 10 / limits.source_bytes + 1;
            if divisor == 1 || whole.verdict != "E0402" {
                return whole;
            }
            case.write(folder.path(), divisor);
            let part = measure(command(), folder.path());
            let larger = whole.megabytes.max(part.megabytes);
            Outcome { seconds: whole.seconds.max(part.seconds), megabytes: larger, ..part }
        };
        let outcomes = [outcome(Limits::untrusted(), &library), outcome(Limits::default(), &check)];
        let mut row = format!("{:34}", case.name);
        for (outcome, how) in outcomes.iter().zip(["the library", "`imp check`"]) {
            let Outcome { verdict, title, seconds, megabytes } = outcome;
            let _ = write!(row, " {verdict:>8} {:>6.0} {megabytes:>4}  ", seconds * 1e3);
            let named = verdict == "accepted" && case.harmless.is_some() || verdict.len() == 5 && !title.is_empty();
            if !named || verdict.starts_with("E09") {
                let _ = writeln!(faults, "{}: {how}: {verdict}: {title}", case.name);
            }
            if *seconds > SECONDS || *megabytes > MEGABYTES {
                let _ = writeln!(faults, "{}: {how}: {seconds:.2} s, {megabytes} MB", case.name);
            }
        }
        println!("{row} {}", outcomes[0].title);
        let _ = writeln!(verdicts, "{}: {}, {}", case.name, outcomes[0].verdict, outcomes[1].verdict);
    }
    if only.is_empty() && env::var_os("IMP_BLESS").is_some_and(|value| value == "1") {
        fs::write(&expected_path, &verdicts).unwrap();
    }
    let expected = fs::read_to_string(&expected_path).unwrap_or_default();
    for line in verdicts.lines().filter(|line| !expected.lines().any(|expected| expected == *line)) {
        let _ = writeln!(faults, "not as expected: {line}");
    }
    assert!(faults.is_empty(), "\n{faults}");
}
