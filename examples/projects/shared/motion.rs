//! What both projects do with bounds of the clearance: decide whether the arm's hand stays clear of a disc on the whole
//! motion, and when it touches it first if not.

use std::hint::black_box;
use std::time::Instant;

/// A disc by its centre and radius.
pub struct Disc {
    pub name: &'static str,
    pub centre: [f64; 2],
    pub radius: f64,
}

pub const DISCS: [Disc; 3] = [
    Disc { name: "box on the floor", centre: [1.9, 0.2], radius: 0.3 },
    Disc { name: "lamp", centre: [0.2, 1.2], radius: 0.2 },
    Disc { name: "shelf", centre: [1.0, 1.25], radius: 0.1 },
];

/// What is proved of the motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Contact {
    /// The hand is clear of the disc from t = 0 to t = 1.
    Never,
    /// It is clear before `from`, and inside at `to`.
    First { from: f64, to: f64 },
    /// It is clear before this time; what happens there is not decided.
    Unknown { from: f64 },
}

/// Pieces of time are not split further than this.
const FINEST: f64 = 1e-9;

/// Decides by bisection, earliest pieces first; `enclose` bounds the clearance over a piece of time. Returns the number of
/// pieces too.
pub fn first_contact(enclose: impl Fn(f64, f64) -> (f64, f64)) -> (Contact, usize) {
    let mut pieces = 0;
    let mut left = vec![(0.0, 1.0)];
    while let Some((from, to)) = left.pop() {
        pieces += 1;
        if enclose(from, to).0 > 0.0 {
            continue;
        }
        if to - from > FINEST {
            let middle = 0.5 * (from + to);
            left.push((middle, to));
            left.push((from, middle));
        } else if enclose(to, to).1 < 0.0 {
            return (Contact::First { from, to }, pieces);
        } else {
            // The hand may only graze the disc here; a little later it may be inside for certain.
            let later = to + FINEST;
            let contact = match enclose(later, later).1 < 0.0 {
                true => Contact::First { from, to: later },
                false => Contact::Unknown { from },
            };
            return (contact, pieces);
        }
    }
    (Contact::Never, pieces)
}

/// Prints and checks what `enclose`, given a disc and a piece of time, proves.
pub fn check_motion(tolerance: &str, expected: [bool; 3], enclose: impl Fn(&Disc, f64, f64) -> (f64, f64)) {
    for (disc, clear) in DISCS.iter().zip(expected) {
        let (contact, pieces) = first_contact(|from, to| enclose(disc, from, to));
        match contact {
            Contact::Never => println!("{tolerance}: clear of the {} all the time ({pieces} pieces)", disc.name),
            Contact::First { from, to } => {
                println!("{tolerance}: touches the {} first between t = {from} and {to} ({pieces} pieces)", disc.name);
            }
            Contact::Unknown { from } => {
                println!("{tolerance}: clear of the {} up to t = {from}, unknown there ({pieces} pieces)", disc.name);
            }
        }
        assert_eq!(contact == Contact::Never, clear, "{tolerance}: {}", disc.name);
    }
}

/// Boxes of (t, u, v, r), one after the other, drawn by a fixed rule: small, large, single points, unbounded.
pub fn sample(count: usize) -> Vec<[[f64; 2]; 4]> {
    let mut state = 1u64;
    let mut random = move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut interval = |i: usize| {
        let (at, wide) = (4.0 * random() - 2.0, random());
        match i % 11 {
            0 => [at, at],
            1 => [at, f64::INFINITY],
            2 => [at, at + 1e-12],
            3 => [at - 100.0 * wide, at + 100.0 * wide],
            _ => [at, at + wide],
        }
    };
    (0..count).map(|i| std::array::from_fn(|_| interval(i))).collect()
}

/// A hash (FNV-1a) of numbers, bit by bit; both zeros count as one.
pub fn hash(numbers: impl Iterator<Item = f64>) -> u64 {
    let bytes = numbers.flat_map(|number| (number + 0.0).to_bits().to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}

/// The shortest time in nanoseconds that one of `items` takes, when `work` does all of them.
pub fn nanoseconds(items: usize, mut work: impl FnMut()) -> f64 {
    let mut best = f64::INFINITY;
    for _ in 0..50 {
        let start = Instant::now();
        black_box(&mut work)();
        best = best.min(start.elapsed().as_nanos() as f64);
    }
    best / items as f64
}
