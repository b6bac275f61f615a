//! Every operation of `imp::interval` on random arguments against MPFR with 200 bits: no value may escape, and the
//! distance of the ends from the tightest ones is printed as a table.
//!
//!     cargo run --release --bin oracle -- [cases per operation] [threads] [operations whose names hold this]

mod mpfr;
#[path = "../../../../support/reference.rs"]
mod reference;

use std::time::Instant;

use mpfr::Mpfr;
use reference::HEADER;
use reference::Operation;
use reference::REVERSE;
use reference::Tally;

fn main() {
    let mut words = std::env::args().skip(1);
    let cases: u64 = words.next().map_or(10_000, |text| text.parse().expect("a number of cases"));
    let threads: usize = words.next().map_or(0, |text| text.parse().expect("a number of threads"));
    let wanted = words.next().unwrap_or_default();
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().expect("threads start");

    println!("{cases} cases per operation, values of MPFR with {} bits\n\n{HEADER}", mpfr::PRECISION);
    let start = Instant::now();
    let (mut escapes, mut wide) = (Vec::new(), Vec::new());
    let run = |name: &str, work: &(dyn Fn(u64, u64) -> Tally + Sync)| {
        let tally = Tally::in_chunks(cases, 5_000, work);
        println!("{}", tally.row(name));
        tally
    };
    for op in Operation::all() {
        let name = format!("{op:?}");
        if name.contains(&wanted) {
            let tally = run(&name, &|seed, cases| Tally::of(op, seed, cases, &mut Mpfr));
            wide.extend(tally.widest.filter(|_| tally.lower.max(tally.upper) > op.allowance()));
            escapes.extend(tally.escape);
        }
    }
    for op in REVERSE.iter().filter(|op| op.name.contains(&wanted)) {
        escapes.extend(run(op.name, &|seed, cases| Tally::of_reverse(op, seed, cases, &mut Mpfr)).escape);
    }
    println!("\n{:.0} s", start.elapsed().as_secs_f64());
    escapes.iter().for_each(|text| println!("escape: {text}"));
    wide.iter().for_each(|text| println!("wider than allowed: {text}"));
    if !escapes.is_empty() || !wide.is_empty() {
        std::process::exit(1);
    }
}
