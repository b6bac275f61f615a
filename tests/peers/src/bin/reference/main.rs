//! One call of each operation of `imp::interval` beside inari 2.0 (tightest intervals; MPFR for elementary functions), and
//! two formulas as whole expressions of intervals, in one run on one core: ns a call and their ratio.
//!
//! Both sides get the same boxes. They are timed in turn, round by round, and the medians over the rounds are printed: on
//! a noisy machine the ratio says more than either time. inari's intervals are the tightest, so that each of Imp's must
//! contain inari's, which is checked on the way.

mod peer;

use std::hint::black_box;
use std::time::Instant;

use fastrand::Rng;
use imp::interval::Interval;
use inari::Interval as Peer;

const ITEMS: usize = 256;
const ROUNDS: usize = 151;

/// Where the lower ends of the boxes are, by variable.
type Ranges = [(f64, f64); 3];

fn main() {
    println!("ns a call, {ITEMS} boxes 0 to 0.1 wide, median of {ROUNDS} rounds; ratio = inari / Imp\n");
    println!("| {:34} |     Imp |   inari |   ratio |", "operation");
    println!("|{}|--------:|--------:|--------:|", "-".repeat(36));
    peer::compare_all();
}

/// Times both sides on the same boxes and prints a row; without a peer, Imp alone.
fn compare<P: Fn(&[Peer; 3]) -> Peer>(
    name: &str,
    ranges: Ranges,
    ours: impl Fn(&[Interval; 3]) -> Interval,
    peer: Option<P>,
) {
    let mut rng = Rng::with_seed(1);
    let ends: Vec<[(f64, f64); 3]> = (0..ITEMS)
        .map(|_| {
            ranges.map(|(from, to)| {
                let lo = from + (to - from) * rng.f64();
                (lo, lo + 0.1 * rng.f64())
            })
        })
        .collect();
    let boxes: Vec<_> = ends.iter().map(|x| x.map(|(lo, hi)| Interval::new(lo, hi).expect("a range"))).collect();
    let peer_boxes: Vec<_> =
        ends.iter().map(|x| x.map(|(lo, hi)| inari::interval!(lo, hi).expect("a range"))).collect();

    let mut times = [Vec::new(), Vec::new()];
    for _ in 0..ROUNDS {
        times[0].push(nanoseconds(&boxes, &ours));
        if let Some(peer) = &peer {
            times[1].push(nanoseconds(&peer_boxes, peer));
        }
    }
    let [imp, other] = times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times.get(times.len() / 2).copied()
    });
    let imp = imp.expect("rounds");
    let Some((other, peer)) = other.zip(peer) else {
        println!("| {name:34} | {imp:7.1} |         |         |");
        return;
    };
    println!("| {name:34} | {imp:7.1} | {other:7.1} | {:7.2} |", other / imp);
    for (x, z) in boxes.iter().zip(&peer_boxes) {
        let (wide, tight) = (ours(x), peer(z));
        assert!(wide.lo() <= tight.inf() && tight.sup() <= wide.hi(), "{name} of {x:?}: {wide} is not around {tight}");
    }
}

/// The time of one call, averaged over the boxes; neither boxes nor results can be optimised away.
fn nanoseconds<T, R>(boxes: &[T], f: impl Fn(&T) -> R) -> f64 {
    let start = Instant::now();
    for x in black_box(boxes) {
        black_box(f(black_box(x)));
    }
    start.elapsed().as_secs_f64() * 1e9 / boxes.len() as f64
}
