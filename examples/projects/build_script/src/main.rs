//! Does a robot's arm stay clear of what stands around, on its whole motion and for all lengths of its links within
//! tolerance? The bounds that decide it come from `arm.imp`, which the build script compiles: the program holds machine
//! code for them and nothing of Imp. It checks its answers, and prints a hash of many bounds, bit by bit, and what calls
//! cost; `../compare.sh` sets that beside the project that compiles at run time.

#[path = "../../shared/motion.rs"]
mod motion;

use std::hint::black_box;

use arm::clearance;
use imp_runtime::Error;
use imp_runtime::Interval;
use imp_runtime::Verdict;
use motion::Disc;

imp_runtime::include_kernels!();

fn main() -> Result<(), Error> {
    assert!(arm::level() > 0, "no kernel runs on this processor");
    let variables = |disc: &Disc, from: f64, to: f64| {
        let [u, v] = disc.centre.map(Interval::point);
        [Interval::new(from, to), u, v, Interval::point(disc.radius)]
    };
    motion::check_motion("exact lengths", [true, true, false], |disc, from, to| {
        let bound = clearance::interval(variables(disc, from, to)).interval;
        (bound.lo, bound.hi)
    });
    let tolerant = |half: f64| clearance::Parameters {
        upper: Interval::new(1.0 - half, 1.0 + half),
        lower: Interval::new(0.75 - half, 0.75 + half),
    };
    let checked = tolerant(0.01).checked()?;
    motion::check_motion("1 cm more or less", [true, true, false], |disc, from, to| {
        let bound = checked.interval(variables(disc, from, to)).interval;
        (bound.lo, bound.hi)
    });
    let refused = tolerant(0.5).checked().expect_err("the range ends at 0.9");
    println!("refused: {refused}");

    bits()?;
    times()
}

/// Bounds and values by the thousand, bit by bit.
fn bits() -> Result<(), Error> {
    let boxes = motion::sample(4099);
    let rows: Vec<[Interval; 4]> = boxes.iter().map(|row| row.map(|[lo, hi]| Interval::new(lo, hi))).collect();
    let mut enclosures = vec![Interval::ENTIRE; rows.len() * 5];
    let mut verdicts = vec![Verdict::default(); rows.len() * 5];
    clearance::interval_gradient_rows(&rows, &mut enclosures, Some(&mut verdicts))?;
    let results = enclosures.iter().zip(&verdicts);
    let numbers = results.flat_map(|(interval, verdict)| [interval.lo, interval.hi, f64::from(verdict.0)]);
    println!("bits of bounds: {:016x}", motion::hash(numbers));
    let points: Vec<[f64; 4]> = boxes.iter().map(|row| row.map(|[lo, _]| lo)).collect();
    let mut values = vec![0.0; points.len() * 5];
    clearance::gradient_rows(&points, &mut values)?;
    println!("bits of values: {:016x}", motion::hash(values.into_iter()));
    Ok(())
}

fn times() -> Result<(), Error> {
    let one = [Interval::new(0.2, 0.3), Interval::point(1.0), Interval::point(0.5), Interval::point(0.1)];
    let rows = vec![one; 4096];
    let mut enclosures = vec![Interval::ENTIRE; rows.len()];
    let single = motion::nanoseconds(10_000, || {
        for _ in 0..10_000 {
            black_box(clearance::interval(black_box(one)));
        }
    });
    let shoulder = motion::nanoseconds(10_000, || {
        for _ in 0..10_000 {
            black_box(arm::shoulder::interval(black_box([one[0]])));
        }
    });
    let batch = motion::nanoseconds(rows.len(), || {
        clearance::interval_rows(black_box(&rows), &mut enclosures, None).expect("the lengths agree");
    });
    let flat: Vec<f64> = (0..4).flat_map(|i| [vec![one[i].lo; 4096], vec![one[i].hi; 4096]].concat()).collect();
    let mut ends = vec![0.0; 2 * 4096];
    let columns = motion::nanoseconds(rows.len(), || {
        clearance::interval_columns(black_box(&flat), &mut ends, None).expect("the lengths agree");
    });
    println!("one box of a line: {shoulder:.1} ns");
    println!("one box: {single:.1} ns");
    println!("a box of 4096 in rows: {batch:.1} ns");
    println!("a box of 4096 in columns: {columns:.1} ns");
    Ok(())
}
