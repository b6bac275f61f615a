//! A certified root finder: all zeros of formulas in x on an interval, each with a proof that it is there, and with the proof
//! that no other is.
//!
//!     cargo run --release --example root_finder
//!     cargo run --release --example root_finder -- 'cos(x) = x' 'x^3 - 2x - 5 in [0, 10]'
//!     cargo run --release --example root_finder -- --time
//!
//! Without formulas it answers a set of its own and checks the answers. With `--time` it asks each of them many times and
//! compares the compiled solver with the reference search.

use std::error::Error;
use std::hint::black_box;
use std::time::Duration;
use std::time::Instant;

use imp::Function;
use imp::Interval;
use imp::Program;
use imp::RayFinder;
use imp::control::Control;
use imp::interval::Decorated;
use imp::roots::Options;
use imp::roots::Roots;
use imp::roots::Search;

/// A formula, where its zeros are searched, how many are proved, and whether that is all there is.
struct Case {
    name: &'static str,
    formula: String,
    range: [f64; 2],
    zeros: usize,
    complete: bool,
}

fn case(name: &'static str, formula: impl Into<String>, range: [f64; 2], zeros: usize, complete: bool) -> Case {
    Case { name, formula: formula.into(), range, zeros, complete }
}

fn cases() -> Vec<Case> {
    let factors: Vec<String> = (1..=20).map(|k| format!("(x - {k})")).collect();
    vec![
        case("cubic", "x^3 - x - 1/2", [-10.0, 10.0], 1, true),
        case("Wilkinson 20, as a product", factors.join(" "), [0.0, 21.0], 20, true),
        case("Chebyshev 30", chebyshev(30), [-1.0, 1.0], 30, true),
        case("cos x = x", "cos(x) - x", [-100.0, 100.0], 1, true),
        case("x sin(1/x)", "x sin(1/x)", [0.01, 1.0], 31, true),
        case("a pole is no zero", "1/x", [-1.0, 2.0], 0, true),
        case("touched, exactly", "(x - 1)^2", [0.0, 3.0], 1, false),
        case("touched, blurred", "x^2 - 2 sqrt(2) x + 2", [0.0, 3.0], 0, false),
    ]
}

/// T_n by its recurrence with doubled steps, T_2n = 2 T_n^2 - 1 and T_(2n+1) = 2 T_n T_(n+1) - x.
fn chebyshev(n: u32) -> String {
    match n {
        0 => "1".to_owned(),
        1 => "x".to_owned(),
        n if n % 2 == 0 => format!("(2 ({})^2 - 1)", chebyshev(n / 2)),
        n => format!("(2 ({}) ({}) - x)", chebyshev(n / 2), chebyshev(n / 2 + 1)),
    }
}

fn interval([lo, hi]: [f64; 2]) -> Result<Interval, String> {
    Interval::new(lo, hi).ok_or_else(|| format!("[{lo}, {hi}] is no interval"))
}

/// A formula as a function of x; of an equation, the difference of its sides.
fn function(formula: &str) -> Result<Function, imp::Error> {
    let formula = match formula.split_once('=') {
        Some((left, right)) => format!("({left}) - ({right})"),
        None => formula.to_owned(),
    };
    Function::parse(&formula, &["x"])
}

/// The first lines of an answer: a blurred zero leaves many short intervals unknown.
fn shown(found: &Roots) -> String {
    const LINES: usize = 32;
    let text = found.to_string();
    let mut lines: Vec<&str> = text.lines().take(LINES).collect();
    if text.lines().nth(LINES).is_some() {
        lines.push("and more");
    }
    lines.join("\n")
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments == ["--time"] {
        return time();
    }
    for argument in &arguments {
        let (formula, range) = match argument.rsplit_once(" in ") {
            Some((formula, range)) => (formula, range.trim().parse::<Interval>().map_err(|e| e.to_string())?),
            None => (argument.as_str(), interval([-100.0, 100.0])?),
        };
        println!("{formula} = 0 in {range}\n{}\n", shown(&function(formula)?.roots(range)?));
    }
    if arguments.is_empty() {
        for case in cases() {
            let found = function(&case.formula)?.roots(interval(case.range)?)?;
            println!("{}\n{}\n", case.name, shown(&found));
            assert_eq!(found.proved.len(), case.zeros, "{}", case.name);
            assert_eq!(found.is_complete(), case.complete, "{}", case.name);
        }
        let [near, far] = hits(&barth()?.ray_finder()?)?;
        println!("a ray meets the Barth sextic first at {near}, last at {far}");
        assert!(near.lo() > 0.0 && near.hi() < far.lo());
    }
    Ok(())
}

const BARTH: &str = "let phi = (1 + sqrt(5)) / 2\n\
    fn barth(x, y, z) = 4(phi^2 x^2 - y^2)(phi^2 y^2 - z^2)(phi^2 z^2 - x^2) - (1 + 2phi)(x^2 + y^2 + z^2 - 1)^2";
const ORIGIN: [f64; 3] = [1.5, 1.25, 1.375];
const DIRECTION: [f64; 3] = [-1.0, -0.75, -0.875];

fn barth() -> Result<Function, imp::Error> {
    Program::parse(BARTH)?.function("barth")
}

/// The first and the last hit of a ray.
fn hits(finder: &RayFinder) -> Result<[Interval; 2], Box<dyn Error>> {
    let found = finder.roots(&ORIGIN, &DIRECTION, interval([0.0, 4.0])?)?;
    match (found.first(), found.proved.last()) {
        (Some(near), Some(far)) if found.is_complete() => Ok([near.bracket, far.bracket]),
        _ => Err(found.to_string().into()),
    }
}

/// The shortest time of an answer, and how many roots it proves.
fn shortest(mut ask: impl FnMut() -> Roots) -> (Duration, usize) {
    let roots = ask().proved.len();
    let start = Instant::now();
    let mut best = Duration::MAX;
    while start.elapsed() < Duration::from_millis(200) {
        let before = Instant::now();
        black_box(ask());
        best = best.min(before.elapsed());
    }
    (best, roots)
}

fn report(name: &str, compiled: (Duration, usize), reference: (Duration, usize)) {
    let each = |(time, roots): (Duration, usize)| time.as_secs_f64() * 1e6 / roots.max(1) as f64;
    let ratio = reference.0.as_secs_f64() / compiled.0.as_secs_f64();
    println!(
        "{name:<28} {:>3} roots {:>9.2} us a root, reference {:>10.1} us, {ratio:>7.1} times",
        compiled.1,
        each(compiled),
        each(reference)
    );
}

/// Compiled solvers against the reference search, in one run. Making the reference search is part of its time, which is
/// small beside the search.
fn time() -> Result<(), Box<dyn Error>> {
    let (options, control) = (Options::default(), Control::default());
    for case in cases().iter().take(5) {
        let function = function(&case.formula)?;
        let (graph, root, range) = (function.graph(), function.values()[0], interval(case.range)?);
        let finder = function.root_finder("x")?;
        let compiled = shortest(|| finder.roots(range));
        let reference = shortest(|| Search::new(graph, root, &[Decorated::ENTIRE], 0).run(range, &options, &control));
        report(case.name, compiled, reference);
    }
    kepler()?;

    let barth = barth()?;
    let finder = barth.ray_finder()?;
    let range = interval([0.0, 4.0])?;
    let compiled = shortest(|| finder.roots(&ORIGIN, &DIRECTION, range).unwrap_or_default());
    let boxes = [Decorated::ENTIRE; 3];
    // The function's variables are the first inputs of its graph.
    let axes: Vec<&str> = barth.graph().variables()[..3].iter().map(String::as_str).collect();
    let reference = shortest(|| {
        let search = Search::along_ray(barth.graph(), barth.values()[0], &boxes, &axes, &ORIGIN, &DIRECTION);
        search.run(range, &options, &control)
    });
    report("Barth sextic along a ray", compiled, reference);
    Ok(())
}

/// Kepler's equation for a hundred pairs of eccentricity and mean anomaly: one kernel, other parameters each time.
fn kepler() -> Result<(), Box<dyn Error>> {
    let (options, control) = (Options::default(), Control::default());
    let function = Function::parse("u - e sin(u) - m", &["u", "e", "m"])?;
    let (graph, root, range) = (function.graph(), function.values()[0], interval([0.0, 7.0])?);
    let mut finder = function.root_finder("u")?;
    let pairs: Vec<[f64; 2]> = (0..100).map(|i| [f64::from(i % 10) / 10.0, 0.06 * f64::from(i)]).collect();
    let all = |ask: &mut dyn FnMut([f64; 2]) -> Roots| {
        let mut together = Roots::default();
        pairs.iter().for_each(|&pair| together.proved.extend(ask(pair).proved));
        together
    };
    let compiled = shortest(|| {
        all(&mut |[e, m]| {
            let set = finder.set("e", Interval::point(e)).and_then(|()| finder.set("m", Interval::point(m)));
            set.map(|()| finder.roots(range)).unwrap_or_default()
        })
    });
    let reference = shortest(|| {
        all(&mut |[e, m]| {
            let number = |x| Decorated::new(Interval::point(x));
            Search::new(graph, root, &[Decorated::ENTIRE, number(e), number(m)], 0).run(range, &options, &control)
        })
    });
    report("Kepler, e and M swept", compiled, reference);
    Ok(())
}
