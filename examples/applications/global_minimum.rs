//! The global minimum of four functions in 2 and 6 variables, **proved** by branch and bound: an interval that holds the
//! minimum, and small boxes outside of which there is no minimiser (`shared/branch.rs` says how). Imp compiles the bounds of
//! each formula and of its gradient; eight boxes are computed by one pass through the machine code.
//!
//! The search runs on one thread and on all, and must find the same to the last bit.
//!
//!     cargo run --release --example global_minimum

#[path = "shared/branch.rs"]
mod branch;
#[path = "shared/objectives.rs"]
mod objectives;

use std::error::Error;
use std::time::Instant;

use branch::Area;
use branch::heaps;
use branch::minimise;
use objectives::Compiled;
use objectives::NAMES;
use objectives::cube;
use objectives::formula;
use rayon::ThreadPoolBuilder;

/// Minimisers of Himmelblau's function: the first is exact.
const HIMMELBLAU: [[f64; 2]; 4] = [
    [3.0, 2.0],
    [-2.805_118_086_952_745, 3.131_312_518_250_573],
    [-3.779_310_253_377_747, -3.283_185_991_286_169],
    [3.584_428_340_330_491_7, -1.848_126_526_964_403_6],
];

/// Boxes are split until no side is longer.
const RESOLUTION: f64 = 1e-8;

fn main() -> Result<(), Box<dyn Error>> {
    println!(
        "{:<12} {:<9} {:<25} {:>6} {:>8} {:>10} {:>10} {:>10}",
        "function", "variables", "minimum lies in", "places", "boxes", "compile", "1 thread", "all"
    );
    for (name, side) in NAMES {
        search::<2>(name, side)?;
        search::<6>(name, side)?;
    }
    println!("all minima proved");
    Ok(())
}

fn search<const N: usize>(name: &str, side: [f64; 2]) -> Result<(), Box<dyn Error>> {
    let start = Instant::now();
    let compiled = Compiled::new::<N>(&formula(name, N))?;
    let compiling = start.elapsed();
    let one = ThreadPoolBuilder::new().num_threads(1).build()?;
    let start = Instant::now();
    let alone = one.install(|| minimise(&compiled, cube::<N>(side), RESOLUTION));
    let single = start.elapsed();
    let start = Instant::now();
    let found = minimise(&compiled, cube::<N>(side), RESOLUTION);
    let together = start.elapsed();
    assert_eq!(found, alone, "the number of threads must not show");

    let places = heaps(&found.boxes);
    let [lo, hi] = found.value;
    println!(
        "{name:<12} {N:<9} {:<25} {:>6} {:>8} {compiling:>10.1?} {single:>10.1?} {together:>10.1?}",
        format!("[{lo:.2e}, {hi:.2e}]"),
        places.len(),
        found.differentiated + found.evaluated,
    );

    // The minimum is 0, and known minimisers lie in the places, one in each.
    assert!(lo <= 0.0 && 0.0 <= hi && hi - lo < 2e-8, "{lo}, {hi}");
    let known = minimisers::<N>(name);
    assert_eq!(places.len(), known.len());
    for point in known {
        let near = |place: &Area<N>| place.iter().zip(point).all(|(s, x)| s[0] - 1e-12 <= x && x <= s[1] + 1e-12);
        assert_eq!(places.iter().filter(|place| near(place)).count(), 1, "{point:?}");
    }
    Ok(())
}

/// All minimisers, to about 1e-15.
fn minimisers<const N: usize>(name: &str) -> Vec<[f64; N]> {
    match name {
        // Each pair of variables chooses for itself.
        "Himmelblau" => (0..4usize.pow(N as u32 / 2))
            .map(|choice| std::array::from_fn(|i| HIMMELBLAU[choice / 4usize.pow(i as u32 / 2) % 4][i % 2]))
            .collect(),
        "Rosenbrock" => vec![[1.0; N]],
        _ => vec![[0.0; N]],
    }
}
