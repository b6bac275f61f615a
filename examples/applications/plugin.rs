//! Formulas typed by a user while the program runs. Each line is compiled under [`Limits::untrusted`]; a bad one is answered
//! with what is wrong and where, and changes nothing; a good one is plotted from **proved** bounds and becomes the
//! program's function, while four workers keep calling whichever is current. A worker that is in the middle of a call
//! keeps the old code alive: it is freed with the last user.
//!
//!     cargo run --release --example plugin            a script of good and bad lines
//!     cargo run --release --example plugin -- -       lines from standard input, formulas of x

use std::io::stdin;
use std::sync::Arc;
use std::sync::PoisonError;
use std::sync::RwLock;
use std::sync::atomic::AtomicBool;
use std::sync::atomic::AtomicU64;
use std::sync::atomic::Ordering;
use std::thread;
use std::time::Duration;
use std::time::Instant;

use imp::Enclosure;
use imp::Error;
use imp::Interval;
use imp::IntervalKernel;
use imp::Limits;
use imp::Loader;
use imp::Options;
use imp::PointKernel;

const WORKERS: usize = 4;
/// Parts of the range [-3, 3] of which bounds are computed, and characters of the plot.
const PARTS: usize = 60;
const RANGE: [f64; 2] = [-3.0, 3.0];

/// A formula in service.
struct Plugin {
    text: String,
    bounds: IntervalKernel,
    values: PointKernel,
    /// How often each worker has called it.
    calls: [AtomicU64; WORKERS],
}

impl Plugin {
    /// Compiles a line, or says what is wrong with it.
    fn new(line: &str) -> Result<Self, String> {
        let plugin = || {
            let function = Loader::new("formula", Limits::untrusted()).parse("")?.expression(line, &["x"])?;
            let (bounds, values) = (function.intervals(&Options::default())?, function.points(&Options::default())?);
            Ok((bounds, values))
        };
        let (bounds, values) = plugin().map_err(|said: Error| said.to_string())?;
        let function = bounds.function();
        // The coordinates y and z and the time may be used wherever they are not arguments.
        match function.variables() {
            [_] if function.outputs().len() == 1 => {}
            [_] => return Err("one number was expected, not a list".to_owned()),
            [_, others @ ..] => return Err(format!("the formula depends on {}, too", others.join(", "))),
            [] => return Err("the formula has no variable".to_owned()),
        }
        Ok(Plugin { text: line.to_owned(), bounds, values, calls: Default::default() })
    }

    /// One call as a worker makes it: bounds of all parts. Values at points of a part lie in its bounds.
    fn call(&self, worker: usize) -> Result<(), Error> {
        let enclosures = self.enclosures()?;
        let part = (self.calls[worker].fetch_add(1, Ordering::Relaxed) as usize * 7 + worker) % PARTS;
        let value = self.values.value(&[parts()[part].mid()])?;
        let [lo, hi] = [enclosures[part].lo(), enclosures[part].hi()];
        // The value itself is rounded; the bounds are not to blame for that. One that is no number lies nowhere.
        let slack = 1e-9 * (1.0 + value.abs());
        assert!(value.is_nan() || (lo - slack <= value && value <= hi + slack), "{}: {value}", self.text);
        Ok(())
    }

    fn enclosures(&self) -> Result<Vec<Enclosure>, Error> {
        let mut enclosures = vec![Enclosure::UNKNOWN; PARTS];
        self.bounds.enclose_into(&parts(), &mut enclosures)?;
        Ok(enclosures)
    }

    /// A line of characters: where the function is proved positive, negative, undefined, or none of it.
    fn plot(&self) -> Result<String, Error> {
        let character = |e: &Enclosure| match () {
            () if e.is_empty() => ' ',
            () if e.is_positive() => '+',
            () if e.is_negative() => '-',
            () => '0',
        };
        Ok(self.enclosures()?.iter().map(character).collect())
    }
}

fn parts() -> Vec<Interval> {
    let end = |i: usize| RANGE[0] + (RANGE[1] - RANGE[0]) * i as f64 / PARTS as f64;
    (0..PARTS).filter_map(|i| Interval::new(end(i), end(i + 1))).collect()
}

/// Ends the work when it goes, by whatever way.
struct Stop<'a>(&'a AtomicBool);

impl Drop for Stop<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Lines, and whether they are formulas.
fn script() -> Vec<(String, bool)> {
    let lines = [
        ("x^2 - 2", true),
        ("sin 2x", false),
        ("sin(2x) + x/3", true),
        ("sqrt(1 - x^2)", true),
        ("sqrt(1 - y^2)", false),
        ("[x, x^2]", false),
        ("1/x", true),
        ("(x + 1", false),
        ("x +* 2", false),
        ("", false),
        ("exp(-x^2) - 1/2", true),
        ("import \"/etc/passwd\"", false),
        ("f(x)", false),
        ("1/2x", false),
        ("if x < 0 then -1 else x", true),
        ("pi", true),
        ("\u{202e}x", false),
    ];
    let mut script: Vec<_> = lines.map(|(line, good)| (line.to_owned(), good)).to_vec();
    script.push(("(".repeat(100_000), false));
    script.push((format!("x{}", " + x".repeat(100_000)), false));
    script.push(((0..20_000).map(|i| format!("sin({i}x) + ")).collect::<String>() + "x", false));
    script.push(("atan(x)^3 - x/10".to_owned(), true));
    script
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let by_hand = std::env::args().nth(1).as_deref() == Some("-");
    let current = RwLock::new(Arc::new(Plugin::new("x")?));
    let get = || Arc::clone(&current.read().unwrap_or_else(PoisonError::into_inner));
    let done = AtomicBool::new(false);
    let work = |worker: usize| {
        while !done.load(Ordering::Relaxed) {
            get().call(worker)?;
        }
        Ok::<(), Error>(())
    };
    let work = &work;
    thread::scope(|scope| {
        let stop = Stop(&done);
        let workers: Vec<_> = (0..WORKERS).map(|worker| scope.spawn(move || work(worker))).collect();
        let mut take = |line: &str| -> Result<bool, Error> {
            let start = Instant::now();
            let plugin = match Plugin::new(line) {
                Ok(plugin) => plugin,
                Err(said) => {
                    // Of a line without end the beginning is enough.
                    let lines = said.lines().map(|line| line.chars().take(100).collect::<String>());
                    println!("refused in {:.1?}\n{}\n", start.elapsed(), lines.collect::<Vec<_>>().join("\n"));
                    return Ok(false);
                }
            };
            println!("{line}\n  [{}]  compiled in {:.1?}\n", plugin.plot()?, start.elapsed());
            let plugin = Arc::new(plugin);
            *current.write().unwrap_or_else(PoisonError::into_inner) = Arc::clone(&plugin);
            // Nobody is held up; wait until everyone has called the new one.
            while plugin.calls.iter().any(|calls| calls.load(Ordering::Relaxed) == 0) {
                if workers.iter().any(|worker| worker.is_finished()) {
                    break;
                }
                thread::sleep(Duration::from_micros(100));
            }
            Ok(true)
        };
        let outcome = if by_hand {
            stdin().lines().map_while(Result::ok).try_for_each(|line| take(&line).map(|_| ()))
        } else {
            play(&mut take)
        };
        drop(stop);
        for worker in workers {
            worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))?;
        }
        Ok(outcome?)
    })
}

/// Takes the lines of the script, each as it should be taken.
fn play(take: &mut impl FnMut(&str) -> Result<bool, Error>) -> Result<(), Error> {
    let script = script();
    for (i, (line, good)) in script.iter().enumerate() {
        let taken = take(line)?;
        assert_eq!(taken, *good, "line {}: {:.60}", i + 1, line);
    }
    let good = script.iter().filter(|(_, good)| *good).count();
    println!("{good} formulas taken, {} refused; the workers called all of them", script.len() - good);
    Ok(())
}
