//! The global minimum of four functions in 2 and 6 variables by branch and bound, on Imp's kernels and on intervals of inari
//! 2.0 in plain Rust, in one run. The algorithm is the same to the line, that of Imp's example `global_minimum`; only the
//! evaluation differs. Imp derives the gradients, on inari's side they are written by hand (`by_hand.rs`).
//!
//! Equal numbers of boxes are the sign of a fair comparison. Where they differ by a few, Imp's elementary functions were an ulp
//! or two wider than inari's, which are the tightest there are.
//!
//!     cargo run --release --bin minimum

#[path = "../../../../../examples/applications/shared/branch.rs"]
mod branch;
mod by_hand;
#[path = "../../../../../examples/applications/shared/objectives.rs"]
mod objectives;

use std::error::Error;
use std::time::Instant;

use branch::Minimum;
use branch::Objective;
use branch::heaps;
use branch::minimise;
use by_hand::Ackley;
use by_hand::ByHand;
use by_hand::Function;
use by_hand::Himmelblau;
use by_hand::Rastrigin;
use by_hand::Rosenbrock;
use objectives::Compiled;
use objectives::NAMES;
use objectives::cube;
use objectives::formula;
use rayon::ThreadPool;
use rayon::ThreadPoolBuilder;

const RESOLUTION: f64 = 1e-8;
const ROUNDS: usize = 7;

fn main() -> Result<(), Box<dyn Error>> {
    let threads = rayon::current_num_threads();
    println!(
        "branch and bound to boxes of {RESOLUTION:e}; ms, medians of {ROUNDS} rounds in turn; ratio = inari / Imp; 1 and {threads} threads"
    );
    println!(
        "| function | n | boxes Imp | boxes inari | compile | Imp, 1 | inari, 1 | ratio | Imp, {threads} | inari, {threads} | ratio |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    both::<2, _>(0, Himmelblau)?;
    both::<6, _>(0, Himmelblau)?;
    both::<2, _>(1, Rosenbrock)?;
    both::<6, _>(1, Rosenbrock)?;
    both::<2, _>(2, Ackley)?;
    both::<6, _>(2, Ackley)?;
    both::<2, _>(3, Rastrigin)?;
    both::<6, _>(3, Rastrigin)
}

fn both<const N: usize, F: Function<N>>(index: usize, function: F) -> Result<(), Box<dyn Error>> {
    let (name, side) = NAMES[index];
    let start = Instant::now();
    let compiled = Compiled::new::<N>(&formula(name, N))?;
    let compiling = start.elapsed();
    let by_hand = ByHand(function);
    let pools = [ThreadPoolBuilder::new().num_threads(1).build()?, ThreadPoolBuilder::new().build()?];
    let mut times: [[Vec<f64>; 2]; 2] = Default::default();
    let mut found = [None, None];
    for _ in 0..ROUNDS {
        for (pool, times) in pools.iter().zip(&mut times) {
            found[0] = Some(timed::<N>(&compiled, side, pool, &mut times[0]));
            found[1] = Some(timed::<N>(&by_hand, side, pool, &mut times[1]));
        }
    }
    let [Some(ours), Some(theirs)] = found else { return Err("no round was run".into()) };
    // Both are proved, so both hold the minimum, and the same places.
    assert!(ours.value[0] <= theirs.value[1] && theirs.value[0] <= ours.value[1]);
    assert_eq!(heaps(&ours.boxes).len(), heaps(&theirs.boxes).len());
    let count = |found: &Minimum<N>| found.differentiated + found.evaluated;
    print!("| {name} | {N} | {} | {} | {:.1} |", count(&ours), count(&theirs), 1e3 * compiling.as_secs_f64());
    for times in &mut times {
        let [ours, theirs] = times.each_mut().map(median);
        print!(" {ours:.3} | {theirs:.3} | {:.1} |", theirs / ours);
    }
    println!();
    Ok(())
}

fn timed<const N: usize>(f: &impl Objective<N>, side: [f64; 2], pool: &ThreadPool, times: &mut Vec<f64>) -> Minimum<N> {
    pool.install(|| {
        let start = Instant::now();
        let found = minimise(f, cube::<N>(side), RESOLUTION);
        times.push(1e3 * start.elapsed().as_secs_f64());
        found
    })
}

fn median(times: &mut Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}
