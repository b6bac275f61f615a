//! Functions between two lines, against 256-bit values: containment on any interval, and how narrow the band is.

use super::elementary::{TABLE, contains};
use super::{big, cases, interval, members};
use crate::interval::{Interval, Linear};
use astro_float::{BigFloat, Consts, RoundingMode};
use fastrand::Rng;

const P: usize = 256;
const RM: RoundingMode = RoundingMode::ToEven;

/// A real function at a number where it is defined.
type Oracle = Box<dyn Fn(f64, &mut Consts) -> Option<BigFloat>>;

struct Function {
    name: String,
    line: Box<dyn Fn(Interval) -> Linear>,
    /// The real value where the function is defined.
    oracle: Oracle,
    /// Where it is smooth, for the questions about width.
    smooth: (f64, f64),
}

/// |x|^(p/q), with the sign of x where it counts; exact for whole exponents.
fn power(x: f64, p: i32, q: u32, cc: &mut Consts) -> Option<BigFloat> {
    if x < 0.0 && q.is_multiple_of(2) || x == 0.0 && p < 0 {
        return None;
    }
    let size = big(x.abs());
    let value = if x == 0.0 {
        big(0.0)
    } else if q == 1 {
        let whole = (0..p.unsigned_abs()).fold(big(1.0), |power, _| power.mul_full_prec(&size));
        if p < 0 { big(1.0).div(&whole, 2 * P, RM) } else { whole }
    } else {
        let ratio = big(p.into()).div(&big(q.into()), 2 * P, RM);
        size.pow(&ratio, P, RM, cc)
    };
    Some(if x < 0.0 && p % 2 != 0 { value.neg() } else { value })
}

fn functions() -> Vec<Function> {
    macro_rules! named {
        ($($name:ident $lo:literal $hi:literal;)*) => {
            vec![$({
                let entry = TABLE.iter().find(|entry| entry.name == stringify!($name)).expect("an oracle");
                let oracle = entry.oracle;
                Function {
                    name: entry.name.to_owned(),
                    line: Box::new(Linear::$name),
                    oracle: Box::new(move |x, cc| oracle(&big(x), cc)),
                    smooth: ($lo, $hi),
                }
            }),*]
        };
    }
    let mut all = named! {
        sqr -3.0 3.0; sqrt 0.1 9.0; cbrt 0.1 9.0; recip 0.2 5.0; abs 0.0 1.0;
        exp -3.0 3.0; exp2 -3.0 3.0; exp10 -2.0 1.0; expm1 -3.0 3.0;
        ln 0.1 9.0; log2 0.1 9.0; log10 0.1 9.0; log1p -0.9 9.0;
        sin -9.0 9.0; cos -9.0 9.0; tan -1.4 1.4; asin -0.95 0.95; acos -0.95 0.95; atan -4.0 4.0;
        sinh -3.0 3.0; cosh -3.0 3.0; tanh -3.0 3.0; asinh -4.0 4.0; acosh 1.1 9.0; atanh -0.9 0.9;
    };
    for (p, q) in [(3, 1), (4, 1), (7, 1), (-2, 1), (-3, 1), (2, 3), (1, 4), (-1, 3), (-3, 2), (5, 3), (4, 3), (7, 10)]
    {
        all.push(Function {
            name: format!("power {p}/{q}"),
            line: Box::new(move |x| Linear::pow_rational(x, p, q)),
            oracle: Box::new(move |x, cc| power(x, p, q, cc)),
            smooth: (0.2, 4.0),
        });
    }
    for exponent in [0.3, 2.5, -1.7] {
        all.push(Function {
            name: format!("pow {exponent}"),
            line: Box::new(move |x| Linear::pow(x, exponent)),
            oracle: Box::new(move |x, cc| match x {
                0.0 => (exponent > 0.0).then(|| big(0.0)),
                _ => (x > 0.0).then(|| big(x).pow(&big(exponent), P, RM, cc)),
            }),
            smooth: (0.2, 4.0),
        });
    }
    all
}

/// Whether f(x) - slope x lies in the offset.
fn holds(line: &Linear, offset: Interval, x: f64, value: &BigFloat) -> bool {
    if value.is_inf() {
        // Beyond the exponents of the oracle: only a band without bounds holds it.
        return if value.is_positive() { offset.hi().is_infinite() } else { offset.lo().is_infinite() };
    }
    let product = big(line.slope()).mul_full_prec(&big(x));
    // astro-float gets differences with 0 wrong at full precision.
    let difference = match (value.is_zero(), product.is_zero()) {
        (true, _) => product.neg(),
        (_, true) => value.clone(),
        _ => value.sub_full_prec(&product),
    };
    contains(offset, &difference)
}

/// Places across `x`, its ends among them.
fn places(rng: &mut Rng, x: Interval) -> Vec<f64> {
    let mut places = members(rng, x);
    if x.is_bounded() {
        places.extend((1..8).map(|i| (x.lo() + (x.hi() - x.lo()) * f64::from(i) / 8.0).clamp(x.lo(), x.hi())));
    }
    places.retain(|x| x.is_finite());
    places
}

#[test]
fn bands_hold_their_functions() {
    let mut cc = Consts::new().unwrap();
    for function in functions() {
        let mut rng = Rng::with_seed(50);
        for case in 0..cases(120) {
            // Half of the intervals where functions are bent, half anywhere.
            let x = if case % 2 == 0 {
                let lo = (rng.f64() - 0.5) * 12.0;
                Interval::new(lo, lo + rng.f64() * 2f64.powi(rng.i32(-50..4))).unwrap()
            } else {
                interval(&mut rng)
            };
            let line = (function.line)(x);
            assert!(line.slope().is_finite(), "{} {x}", function.name);
            for place in places(&mut rng, x) {
                if let Some(value) = (function.oracle)(place, &mut cc) {
                    assert!(
                        holds(&line, line.offset(), place, &value),
                        "{} on {x} at {place:e}: {line:?}",
                        function.name
                    );
                }
            }
        }
    }
}

/// Bounds moved inwards by what rounding to nearest would have lost, a few units in the last place, let values escape.
#[test]
fn bounds_rounded_carelessly_are_noticed() {
    let mut cc = Consts::new().unwrap();
    for function in functions().iter().filter(|function| function.name != "abs") {
        let mut rng = Rng::with_seed(51);
        let mut escapes = 0;
        for _ in 0..20 {
            let lo = function.smooth.0 + rng.f64() * 0.5 * (function.smooth.1 - function.smooth.0);
            let hi = lo + 0.3 * (function.smooth.1 - lo);
            let line = (function.line)(Interval::new(lo, hi).unwrap());
            let size = (line.slope() * lo).abs().max((line.slope() * hi).abs()).max(line.offset().mag());
            let step = 8.0 * f64::EPSILON * size;
            let careless = Interval::new(line.offset().lo() + step, line.offset().hi() - step).unwrap();
            escapes += [lo, hi]
                .into_iter()
                .filter(|&x| {
                    let value = (function.oracle)(x, &mut cc).expect("defined where smooth");
                    !holds(&line, careless, x, &value)
                })
                .count();
        }
        assert!(escapes > 10, "{}: {escapes} escapes", function.name);
    }
}

/// On no interval is there a band narrower by more than a hundredth, as far as samples can tell; and half the width
/// has a quarter of the band.
#[test]
fn bands_are_narrow() {
    let mut cc = Consts::new().unwrap();
    for function in functions().iter().filter(|function| function.name != "abs") {
        let mut rng = Rng::with_seed(52);
        for _ in 0..10 {
            let (least, most) = function.smooth;
            let (a, b) = (least + rng.f64() * (most - least), least + rng.f64() * (most - least));
            let x = Interval::new(a.min(b), a.max(b).min(a.min(b) + 2.5)).unwrap();
            if x.width() < 1e-3 {
                continue;
            }
            let line = (function.line)(x);
            let mut at = |x: f64| {
                let value = (function.oracle)(x, &mut cc).expect("defined where smooth");
                value.to_string().parse::<f64>().expect("a number")
            };
            let samples: Vec<(f64, f64)> =
                (0..=200).map(|i| x.lo() + (x.hi() - x.lo()) * f64::from(i) / 200.0).map(|x| (x, at(x))).collect();
            let width = |slope: f64| {
                let heights = samples.iter().map(|(x, y)| y - slope * x);
                let (lo, hi) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), g| (lo.min(g), hi.max(g)));
                hi - lo
            };
            let steep = samples.windows(2).map(|pair| (pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0));
            let (flattest, steepest) =
                steep.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), s| (lo.min(s), hi.max(s)));
            let slopes = (0..=400).map(|i| flattest + (steepest - flattest) * f64::from(i) / 400.0);
            let best = slopes.map(width).fold(f64::INFINITY, f64::min);
            let found = line.offset().width();
            assert!(found <= 1.01 * best + 1e-13, "{} on {x}: {found}, {best} is possible", function.name);
        }
        let centre = 0.55 * function.smooth.1 + 0.45 * function.smooth.0;
        let around = |r: f64| (function.line)(Interval::new(centre - r, centre + r).unwrap()).offset().width();
        let ratio = around(0.02) / around(0.01);
        // Four, or eight beside an inflection.
        assert!((3.8..8.5).contains(&ratio), "{}: {ratio}", function.name);
    }
}

#[test]
fn a_size_between_lines() {
    let of = |lo, hi| Linear::abs(Interval::new(lo, hi).unwrap());
    // |x| <= 0.5 x + 1.5 on [-1, 3], with equality at the ends, and |x| >= 0.5 x with equality at 0.
    assert_eq!((of(-1.0, 3.0).slope(), of(-1.0, 3.0).offset()), (0.5, Interval::new(0.0, 1.5).unwrap()));
    assert_eq!((of(-3.0, -1.0).slope(), of(-3.0, -1.0).offset()), (-1.0, Interval::ZERO));
    assert_eq!((of(0.0, 1.0).slope(), of(0.0, 1.0).offset()), (1.0, Interval::ZERO));
    assert_eq!(of(-5e-324, 5e-324).offset(), Interval::new(0.0, 5e-324).unwrap());
}

#[test]
fn what_has_no_bounds_is_flat() {
    let whole = Interval::ENTIRE;
    let pole = Interval::new(-1.0, 1.0).unwrap();
    for (line, range) in [
        (Linear::exp(whole), whole.exp()),
        (Linear::sin(whole), whole.sin()),
        (Linear::recip(pole), whole),
        (Linear::ln(pole), pole.ln()),
        (Linear::atanh(pole), whole),
        (Linear::tan(Interval::new(1.0, 2.0).unwrap()), whole),
        (Linear::sqrt(Interval::EMPTY), Interval::EMPTY),
        (Linear::ln(Interval::new(-2.0, -1.0).unwrap()), Interval::EMPTY),
        (Linear::sin(Interval::EMPTY), Interval::EMPTY),
        (Linear::abs(Interval::EMPTY), Interval::EMPTY),
        (Linear::cbrt(Interval::EMPTY), Interval::EMPTY),
    ] {
        assert_eq!((line.slope(), line.offset()), (0.0, range));
    }
}
