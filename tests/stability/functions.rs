//! Functions of huge arguments, odd roots of negative numbers, powers beyond the range of the format.

use astro_float::BigFloat;
use astro_float::Consts;
use astro_float::RoundingMode;
use imp::interval::Decoration;
use imp::interval::Interval;
use imp::render::Certainty;

use crate::case::Case;
use crate::formula::Formula;
use crate::formula::point;
use crate::plain::Number;
use crate::shot::options;
use crate::shot::shoot;

/// The sine of an f64 of any size: the reduction of 2^1023 takes 1100 bits of pi.
fn exact_sine(x: f64) -> BigFloat {
    let mut constants = Consts::new().expect("memory for constants");
    BigFloat::from_f64(x, 64).sin(2048, RoundingMode::ToEven, &mut constants)
}

/// Whether a number lies in a bounded interval.
fn holds(interval: Interval, number: &BigFloat) -> bool {
    let [lo, hi] = [interval.lo(), interval.hi()].map(|end| BigFloat::from_f64(end, 64));
    lo <= *number && *number <= hi
}

/// Reduction by the rounded period, as shaders and fast-math modes do it; the libraries of C and Rust do better.
macro_rules! reduced_sine {
    ($type:ident, $x:expr) => {{
        let period = std::$type::consts::TAU;
        ($x - period * ($x / period).floor()).sin()
    }};
}

fn sine(name: &'static str, x: f64) -> Case {
    let truth = exact_sine(x);
    let formula = Formula::new("sin(x)");
    let at = [point(x)];
    let said = formula.reference(&at).interval();
    assert!(holds(said, &truth), "{said}");
    assert!(said.lo().next_up().next_up().next_up().next_up() >= said.hi(), "{said} is not tight");
    let most = Interval::new(-1.0, 1.0).expect("the ends are in order");
    formula.answers().all(&at, |said| holds(said, &truth) && most.contains_interval(said));
    let (single, double) = (reduced_sine!(f32, x as f32), reduced_sine!(f64, x));
    let off = |y: f64| y.is_nan() || (y - said.mid()).abs() >= 0.01;
    assert!(off(single.into()) && off(double), "{single}, {double}");
    Case {
        name,
        why: "Less a multiple of the rounded period 2 pi, as shaders and fast-math modes reduce (good libraries do better), nothing is left: its error, times the number of periods, exceeds a period. Imp reduces with as many digits of pi as it takes.",
        single: if single.is_finite() { format!("{single:.3} by period") } else { "not finite".to_owned() },
        double: format!("{double:.3} by period"),
        imp: said.to_string(),
        cost: String::new(),
    }
}

pub fn sine_of_1e22() -> Case {
    sine("sin(1e22)", 1e22)
}

pub fn sine_of_2_to_1023() -> Case {
    sine("sin(2^1023)", 2f64.powi(1023))
}

pub fn odd_root() -> Case {
    let (single, double) = ((-8f32).powf(1.0 / 3.0), (-8f64).powf(1.0 / 3.0));
    assert!(single.is_nan() && double.is_nan());
    let formula = Formula::new("x^(1/3)");
    let at = [point(-8.0)];
    let said = formula.reference(&at);
    assert_eq!((said.interval(), said.decoration()), (point(-2.0), Decoration::Com));
    formula.answers().all(&at, |said| said.contains(-2.0) && said.width() < 1e-5);
    assert_eq!(Formula::new("(-8)^(1/3)").folded().number().map(ToString::to_string).as_deref(), Some("-2"));
    Case {
        name: "(-8)^(1/3)",
        why: "pow is defined through the logarithm and takes 1/3 for 0.333...; with the exact exponent the odd root is real.",
        single: "NaN".to_owned(),
        double: "NaN".to_owned(),
        imp: format!("{}", said.interval()),
        cost: String::new(),
    }
}

/// For each pixel of a square picture of [-1.2, 1.2]^2 whether the astroid (cos^3 a, sin^3 a) passes through it: through the
/// pixel widened by a twentieth, and through the pixel narrowed by as much. The raster is moved by less than that.
fn astroid_pixels(size: u32) -> Vec<[bool; 2]> {
    let mut passed = vec![[false; 2]; (size * size) as usize];
    let steps = 1_000_000;
    for i in 0..steps {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(i) / f64::from(steps)).sin_cos();
        let [x, y] = [cos.powi(3), -sin.powi(3)].map(|v| (v + 1.2) / 2.4 * f64::from(size));
        for (dx, dy) in [(-0.05, -0.05), (-0.05, 0.05), (0.05, -0.05), (0.05, 0.05)] {
            passed[((y + dy) as u32 * size + (x + dx) as u32) as usize][0] = true;
        }
        let inner = |v: f64| (0.05..=0.95).contains(&v.fract());
        if inner(x) && inner(y) {
            passed[(y as u32 * size + x as u32) as usize][1] = true;
        }
    }
    passed
}

pub fn astroid() -> Case {
    let size = 50;
    let shot = shoot("curve astroid: x^(2/3) + y^(2/3) = 1\ndomain [-1.2, 1.2]^2", &options(size));
    let passed = astroid_pixels(size);
    let mut proved = [0; 4];
    for (index, &certainty) in shot.picture.certainty.iter().enumerate() {
        let (x, y) = (index as u32 % size, index as u32 / size);
        let quadrant = usize::from(2 * x >= size) + 2 * usize::from(2 * y >= size);
        match certainty {
            Certainty::Hit => {
                assert!(passed[index][0], "nothing at ({x}, {y})");
                proved[quadrant] += 1;
            }
            Certainty::Miss => assert!(!passed[index][1], "the curve is missed at ({x}, {y})"),
            _ => {}
        }
    }
    assert!(proved.iter().all(|&count| count > 20), "{proved:?}");
    // A plain program sees the curve where sampled values on both sides are numbers.
    let undefined = |at: fn(f64, f64) -> bool| {
        let places = [-0.5, 0.5].into_iter().flat_map(|x| [-0.5, 0.5].map(|y| at(x, y)));
        places.filter(|&nan| nan).count()
    };
    let single = undefined(|x, y| ((x as f32).powf(2.0 / 3.0) + (y as f32).powf(2.0 / 3.0)).is_nan());
    let double = undefined(|x, y| (x.powf(2.0 / 3.0) + y.powf(2.0 / 3.0)).is_nan());
    assert_eq!((single, double), (3, 3));
    Case {
        name: "the astroid x^(2/3) + y^(2/3) = 1",
        why: "The same powers of negative numbers: three of the four arcs are not there.",
        single: "NaN in 3 quadrants of 4".to_owned(),
        double: "NaN in 3 quadrants of 4".to_owned(),
        imp: format!("arcs proved in all four ({} pixels)", proved.iter().sum::<usize>()),
        cost: format!("{} unknown", shot.picture.stats.unknown),
    }
}

pub fn quotient_of_powers() -> Case {
    let (single, double) = (2f32.power(200) / 2f32.power(199), 1e10f64.power(200) / 1e10f64.power(199));
    assert!(single.is_nan() && double.is_nan());
    let formula = Formula::new("x^200 / x^199");
    let (small, large) = (formula.reference(&[point(2.0)]).interval(), formula.reference(&[point(1e10)]).interval());
    assert_eq!(small, point(2.0));
    formula.answers().all(&[point(2.0)], |said| said.contains(2.0));
    formula.answers().all(&[point(1e10)], |said| said.contains(1e10));
    Case {
        name: "x^200 / x^199",
        why: "2^200 overflows f32 (x = 2), 1e10^200 overflows f64 (x = 1e10), and inf / inf is no number.",
        single: "NaN".to_owned(),
        double: "NaN".to_owned(),
        imp: format!("{small} and, from unbounded powers, {large}"),
        cost: String::new(),
    }
}

pub fn inverse_powers() -> Case {
    // 1e-40 and 1e-320 are subnormal: of 24 and 53 digits few are left.
    let single = 1.0 / 10f32.power(20) / 10f32.power(20) * 1e20 * 1e20;
    let double = 1.0 / 1e8f64.power(20) / 1e8f64.power(20) * 1e160 * 1e160;
    assert!((single - 1.0).abs() > 1e-6 && (double - 1.0).abs() > 1e-6, "{single}, {double}");
    let formula = Formula::new("x^(-40) * 1e160 * 1e160");
    let said = formula.reference(&[point(1e8)]).interval();
    assert!(said.contains(1.0) && said.width() > 1e-6 && said.width() < 1e-3, "{said}");
    formula.answers().all(&[point(1e8)], |said| said.contains(1.0));
    let exact = Formula::new("(1e8)^(-40) * 1e160 * 1e160").folded();
    assert_eq!(exact.number().map(ToString::to_string).as_deref(), Some("1"));
    Case {
        name: "x^-40, scaled back to 1",
        why: "1e-40 in f32 and 1e-320 in f64 are subnormal and keep few digits (x = 10 and x = 1e8).",
        single: format!("{single:.6}"),
        double: format!("{double:.6}"),
        imp: format!("[{:.6}, {:.6}]; constants give 1", said.lo(), said.hi()),
        cost: String::new(),
    }
}

pub fn vanishing_square() -> Case {
    let (single, double) = (1e-30f32.power(2), 1e-170f64.power(2));
    assert_eq!((single, double), (0.0, 0.0));
    let formula = Formula::new("x^2");
    let said = formula.reference(&[point(1e-170)]).interval();
    assert!(said.lo() == 0.0 && said.hi() > 0.0, "{said}");
    formula.answers().all(&[point(1e-170)], |said| said.hi() > 0.0);
    let small = formula.answers().each(&[point(1e-30)]);
    let positive = |wanted: &str| small.iter().any(|(name, said)| *name == wanted && said.lo() > 0.0);
    assert!(positive("interval") && positive("kernel in f64") && !positive("kernel in f32"), "{small:?}");
    Case {
        name: "x^2 at 1e-30 (f32), 1e-170 (f64)",
        why: "The square underflows to a zero that is not there.",
        single: "0".to_owned(),
        double: "0".to_owned(),
        imp: format!("{said}: not decided; what f32 leaves open at 1e-30, f64 proves positive"),
        cost: String::new(),
    }
}
