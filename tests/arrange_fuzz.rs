//! Random curves. Nothing panics, every arrangement hangs together, and what it says survives other ways to ask: another
//! number of threads, x and y exchanged, a slightly larger box, the values of plain numbers.
//!
//! `IMP_FUZZ_CASES` sets the number of scenes; a failure names its seed, and `IMP_FUZZ_SEED` starts there.

#[path = "arrange/cases.rs"]
#[allow(dead_code, reason = "the table of known arrangements is tests/arrange.rs's")]
mod cases;
#[path = "arrange/figures.rs"]
#[allow(dead_code, reason = "nothing is known of random curves to compare with")]
mod figures;
#[path = "arrange/grammar.rs"]
mod grammar;

use fastrand::Rng;
use figures::Figures;
use figures::arranged;
use grammar::Scene;
use imp::arrange::Arrangement;
use imp::arrange::Options;
use imp::arrange::structure::Sign;
use imp::interval::Interval;

const CASES: u64 = 120;

fn setting(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(default)
}

/// Coarse, so that what stays open costs little.
fn options(threads: usize, exact: bool) -> Options {
    Options { epsilon: Some(0.02), region: 64, exact, threads: Some(threads) }
}

/// All of an arrangement but the time it took.
fn content(arrangement: &Arrangement) -> String {
    let Arrangement { vertices, halfedges, edges, faces, proved, complex, .. } = arrangement;
    format!("{vertices:?}\n{halfedges:?}\n{edges:?}\n{faces:?}\n{proved}\n{complex:?}")
}

fn overlap(a: &Interval, b: &Interval) -> bool {
    a.lo() < b.hi() && b.lo() < a.hi()
}

/// Boxes of proved vertices have at most boundary points in common.
fn apart(arrangement: &Arrangement) -> Result<(), String> {
    let proved: Vec<_> = arrangement.vertices.iter().map(|v| &v.vertex).filter(|v| v.proved).collect();
    for (i, a) in proved.iter().enumerate() {
        for b in &proved[..i] {
            if a.area.iter().zip(&b.area).all(|(a, b)| overlap(a, b)) {
                return Err(format!("{a:?} and {b:?} overlap"));
            }
        }
    }
    Ok(())
}

/// The signs that faces claim are those of values at their sample points, and every sign vector that occurs has a face, if
/// curves are all that divides them.
fn signs(scene: &Scene, arrangement: &Arrangement, rng: &mut Rng) -> Result<(), String> {
    let [x, y] = scene.domain;
    for face in &arrangement.faces[1..] {
        let Some(at) = face.sample else { continue };
        if !(x[0] <= at[0] && at[0] <= x[1] && y[0] <= at[1] && at[1] <= y[1]) {
            return Err(format!("sample {at:?} outside of the domain"));
        }
        for (curve, sign) in scene.curves.iter().zip(&face.signs) {
            let contradicts = curve
                .field
                .sign(at)
                .is_some_and(|positive| *sign == if positive { Sign::Negative } else { Sign::Positive });
            if contradicts {
                return Err(format!("at {at:?} {sign:?} is claimed, the value is {}", curve.field.value(at)));
            }
        }
    }
    let divided = scene.curves.iter().all(|curve| curve.condition.is_none() && curve.field.is_continuous());
    for _ in 0..if arrangement.proved && divided { 200 } else { 0 } {
        let at = [x[0] + rng.f64() * (x[1] - x[0]), y[0] + rng.f64() * (y[1] - y[0])];
        let values: Vec<_> = scene.curves.iter().map(|curve| curve.field.sign(at)).collect();
        let fits = |sign: &Sign, value: &Option<bool>| match (sign, value) {
            (Sign::Unknown, _) | (_, None) => true,
            (sign, Some(positive)) => (*sign == Sign::Positive) == *positive,
        };
        let known = arrangement.faces[1..].iter().any(|face| face.signs.iter().zip(&values).all(|(s, v)| fits(s, v)));
        if !known {
            return Err(format!("no face has the signs {values:?} of {at:?}"));
        }
    }
    Ok(())
}

/// All that must hold of a scene; whether it is fully proved.
fn judged(scene: &Scene, rng: &mut Rng) -> Result<bool, String> {
    let text = scene.to_string();
    let exact = rng.bool();
    let one = match arranged(&text, &options(1, exact)) {
        Ok(arrangement) => arrangement,
        // A scene that Imp declines, a curve without x or y for one.
        Err(said) if !said.contains("inconsistent") => return Ok(false),
        Err(said) => return Err(said),
    };
    let figures = Figures::of(&one)?;
    let two = arranged(&text, &options(2, exact))?;
    if content(&one) != content(&two) {
        return Err("1 and 2 threads differ".to_string());
    }
    apart(&one)?;
    signs(scene, &one, rng)?;
    if !figures.proved {
        return Ok(false);
    }
    // Another subdivision must find the same.
    let exchanged = Figures::of(&arranged(&scene.exchanged().to_string(), &options(2, exact))?)?;
    if exchanged.proved && exchanged != figures {
        return Err(format!("{figures:?}, with x and y exchanged {exchanged:?}"));
    }
    if figures.all.boundary == 0 {
        let widened = Figures::of(&arranged(&scene.widened(1.0 / 4096.0).to_string(), &options(2, exact))?)?;
        if widened.proved && widened.all.boundary == 0 && widened != figures {
            return Err(format!("{figures:?}, in a box a little larger {widened:?}"));
        }
    }
    Ok(true)
}

#[test]
fn random_curves() {
    let start = setting("IMP_FUZZ_SEED", 0);
    let cases = setting("IMP_FUZZ_CASES", CASES);
    let mut proved = 0;
    for seed in start..start + cases {
        let mut rng = Rng::with_seed(seed);
        let scene = Scene::random(&mut rng);
        let outcome = std::panic::catch_unwind(|| judged(&scene, &mut rng.clone()));
        match outcome {
            Ok(Ok(all)) => proved += u64::from(all),
            Ok(Err(said)) => panic!("seed {seed}, IMP_FUZZ_SEED={seed} IMP_FUZZ_CASES=1 repeats it:\n{scene}\n{said}"),
            Err(_) => panic!("seed {seed} panics:\n{scene}"),
        }
    }
    println!("{proved} of {cases} fully proved");
    // Otherwise little would be compared.
    assert!(proved > cases / 8 || cases < CASES, "only {proved} of {cases} scenes are fully proved");
}
