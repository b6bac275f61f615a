//! Formulas whose zeros are known by construction: none may be lost, and what is said of each must be true.

use fastrand::Rng;
use imp::interval::Interval;
use imp::roots::Roots;
use num_bigint::BigInt;
use num_rational::BigRational;

use crate::answers::Finder;

/// A zero, and whether the function changes its sign there, differentiably and with a slope.
#[derive(Debug, Clone)]
struct Planted {
    at: BigRational,
    simple: bool,
}

fn rational(x: f64) -> BigRational {
    BigRational::from_float(x).expect("a finite number")
}

/// Whether an interval holds a rational number, exactly.
fn holds(x: Interval, number: &BigRational) -> bool {
    let above = x.lo() == f64::NEG_INFINITY || rational(x.lo()) <= *number;
    above && (x.hi() == f64::INFINITY || *number <= rational(x.hi()))
}

/// Everything that was said about a function with exactly these zeros in the range.
fn check(what: &str, found: &Roots, zeros: &[Planted]) {
    let count = |x: Interval| zeros.iter().filter(|zero| holds(x, &zero.at)).count();
    for root in &found.proved {
        assert!(count(root.bracket) >= 1, "{what}: there is no zero in {root}\n{found}");
        if let Some(alone) = root.alone {
            assert_eq!(count(alone), 1, "{what}: not alone in {root}\n{found}");
            assert!(alone.contains_interval(root.bracket), "{what}: {root}");
        }
    }
    for zero in zeros {
        let proved = found.proved.iter().any(|root| holds(root.bracket, &zero.at));
        let unknown = found.unknown.iter().any(|x| holds(*x, &zero.at));
        assert!(proved || unknown, "{what}: lost {}\n{found}", zero.at);
        if zero.simple && !found.exhausted {
            assert!(proved, "{what}: {} is not proved\n{found}", zero.at);
        }
    }
    for pair in found.proved.windows(2) {
        assert!(pair[0].bracket.hi() < pair[1].bracket.lo(), "{what}: {found}");
    }
}

fn written(number: &BigRational) -> String {
    format!("({}/{})", number.numer(), number.denom())
}

/// A product of linear factors with random rational zeros in (-4, 4), some of them double or triple, as text.
fn product(rng: &mut Rng) -> (String, Vec<Planted>) {
    let mut zeros: Vec<Planted> = Vec::new();
    let mut factors = Vec::new();
    for _ in 0..rng.usize(1..6) {
        let denominator = [1, 2, 8, 3, 7, 10][rng.usize(0..6)];
        let at = BigRational::new(BigInt::from(rng.i32(-3 * denominator..=3 * denominator)), denominator.into());
        if zeros.iter().any(|zero| zero.at == at) {
            continue;
        }
        let power = [1, 1, 1, 2, 3][rng.usize(0..5)];
        factors.push(match power {
            1 => format!("(x - {})", written(&at)),
            power => format!("(x - {})^{power}", written(&at)),
        });
        zeros.push(Planted { at, simple: power == 1 });
    }
    (factors.join(" * "), zeros)
}

/// A function with the same zeros, by what is around the product or beside it.
fn disguised(rng: &mut Rng, product: &str, zeros: Vec<Planted>) -> (String, Vec<Planted>) {
    let touching = |zeros: Vec<Planted>| zeros.into_iter().map(|zero| Planted { simple: false, ..zero }).collect();
    let lowest = rational(-0.3);
    match rng.usize(0..12) {
        0 => (product.to_owned(), zeros),
        1 => (format!("atan({product})"), zeros),
        2 => (format!("expm1({product} / 8)"), zeros),
        3 => (format!("sinh(({product}) / 64)"), zeros),
        // No zero of the sine but 0 is reached.
        4 => (format!("sin(atan({product}))"), zeros),
        5 => (format!("({product}) / (x - 0.3001)"), zeros),
        6 => (format!("({product}) / (x^2 + 1/10)"), zeros),
        7 => (format!("|{product}|"), touching(zeros)),
        8 => (format!("({product}) * (1 + floor(x)^2)"), zeros.into_iter().map(unless_whole).collect()),
        // The domain ends at -0.3, where there is another zero.
        9 => {
            let mut zeros: Vec<Planted> = zeros.into_iter().filter(|zero| zero.at > rational(-0.25)).collect();
            zeros.push(Planted { at: BigRational::new((-1).into(), 4.into()), simple: false });
            (format!("({product}) * sqrt(x + 1/4)"), zeros)
        }
        10 => {
            let kept = zeros.into_iter().filter(|zero| zero.at > lowest).collect();
            (format!("({product}) * exp(ln(x + 0.3) / 2)"), above(kept))
        }
        _ => (format!("cbrt({product})"), touching(zeros)),
    }
}

/// At whole numbers the factor jumps: the product is continuous only at its zeros.
fn unless_whole(zero: Planted) -> Planted {
    Planted { simple: zero.simple && !zero.at.is_integer(), ..zero }
}

/// The domain is x > -3/10.
fn above(zeros: Vec<Planted>) -> Vec<Planted> {
    let end = BigRational::new((-3).into(), 10.into());
    zeros.into_iter().filter(|zero| zero.at > end).collect()
}

#[test]
fn planted_zeros_are_never_lost() {
    let mut rng = Rng::with_seed(11);
    for case in 0..crate::random::cases() {
        let (text, zeros) = product(&mut rng);
        let (text, zeros) = disguised(&mut rng, &text, zeros);
        for finder in Finder::ALL {
            let found = finder.roots(&text, -4.0, 4.0);
            check(&format!("case {case}, {finder:?}, {text}"), &found, &zeros);
        }
    }
}

/// Expanded polynomials, whose zeros rounding errors blur; the coefficients are exact rationals.
#[test]
fn expanded_polynomials_keep_their_zeros() {
    let mut rng = Rng::with_seed(12);
    for case in 0..crate::random::cases() {
        let mut zeros: Vec<BigRational> = Vec::new();
        let mut coefficients = vec![BigRational::from_integer(1.into())];
        for _ in 0..rng.usize(1..9) {
            let at = BigRational::new(rng.i32(-24..=24).into(), 8.into());
            if zeros.contains(&at) {
                continue;
            }
            let mut next = vec![BigRational::from_integer(0.into()); coefficients.len() + 1];
            for (power, coefficient) in coefficients.iter().enumerate() {
                next[power + 1] += coefficient;
                next[power] -= coefficient * &at;
            }
            coefficients = next;
            zeros.push(at);
        }
        let terms: Vec<String> =
            coefficients.iter().enumerate().map(|(power, c)| format!("{} * x^{power}", written(c))).collect();
        let text = terms.join(" + ");
        let planted: Vec<Planted> = zeros.into_iter().map(|at| Planted { at, simple: true }).collect();
        for finder in [Finder::Reference, Finder::Compiled] {
            let found = finder.roots(&text, -3.0, 3.0);
            check(&format!("case {case}, {finder:?}, {text}"), &found, &planted);
        }
    }
}

/// Zeros of cos n t are those of a Chebyshev polynomial, wherever its range is cut.
#[test]
fn zeros_at_cuts_and_ends_are_found_once() {
    for n in 1..=12 {
        let text = format!("sin({n} pi x)");
        for finder in [Finder::Reference, Finder::Compiled] {
            let found = finder.roots(&text, 0.0, 1.0);
            let zeros: Vec<Planted> =
                (0..=n).map(|k| Planted { at: BigRational::new(k.into(), n.into()), simple: k > 0 && k < n }).collect();
            check(&text, &found, &zeros);
        }
    }
}
