//! Modal intervals against the definition of their extensions, in whole numbers and in exact rationals, and against
//! the example that the thesis of Florez works out.

use super::{big, cases, exact, is_rounded_down, is_rounded_up, number};
use crate::interval::{Interval, Modal};
use astro_float::{Consts, RoundingMode};
use fastrand::Rng;
use num_bigint::BigInt;
use num_rational::BigRational;

fn modal(lo: f64, hi: f64) -> Modal {
    Modal::new(lo, hi).unwrap()
}

/// The members that extremes of a sum, a difference, a product or a quotient need: the ends, and 0, where the greater
/// of two products with x as a factor has its kink.
fn members<T: Clone + PartialOrd>(lo: T, hi: T, zero: T) -> Vec<T> {
    let (least, greatest) = if lo <= hi { (&lo, &hi) } else { (&hi, &lo) };
    let inside = *least < zero && zero < *greatest;
    let mut members = vec![lo, hi];
    members.extend(inside.then_some(zero));
    members
}

/// The lesser or the greater of two values.
type Pick<T> = fn(T, T) -> T;

/// f* = [min_p max_i f, max_p min_i f] and f** = [max_i min_p f, min_i max_p f], where each variable comes with its
/// members and says whether it is proper.
fn extensions<T: Clone + Ord>(x: (&[T], bool), y: (&[T], bool), f: impl Fn(&T, &T) -> T) -> [(T, T); 2] {
    // `pick` of the outer variable over `pick` of the inner one.
    let nested = |x_outside: bool, outer: Pick<T>, inner: Pick<T>| {
        let (a, b) = if x_outside { (x.0, y.0) } else { (y.0, x.0) };
        let value = |a: &T, b: &T| if x_outside { f(a, b) } else { f(b, a) };
        let row = |a: &T| b.iter().map(|b| value(a, b)).reduce(inner).unwrap();
        a.iter().map(row).reduce(outer).unwrap()
    };
    let (min, max): (Pick<T>, Pick<T>) = (T::min, T::max);
    match (x.1, y.1) {
        (true, true) => [(); 2].map(|()| (nested(true, min, min), nested(true, max, max))),
        (false, false) => [(); 2].map(|()| (nested(true, max, max), nested(true, min, min))),
        // The proper variable outside for f*, inside for f**.
        (x_proper, _) => [
            (nested(x_proper, min, max), nested(x_proper, max, min)),
            (nested(!x_proper, max, min), nested(!x_proper, min, max)),
        ],
    }
}

/// An operation on modal intervals with that on members.
struct Binary<T> {
    name: &'static str,
    modal: fn(Modal, Modal) -> Option<Modal>,
    value: fn(&T, &T) -> T,
}

#[test]
fn operations_are_both_extensions_on_whole_numbers() {
    let table: &[Binary<i64>] = &[
        Binary { name: "+", modal: |x, y| Some(x + y), value: |x, y| x + y },
        Binary { name: "-", modal: |x, y| Some(x - y), value: |x, y| x - y },
        Binary { name: "*", modal: |x, y| Some(x * y), value: |x, y| x * y },
        Binary { name: "min", modal: |x, y| Some(x.min(y)), value: |x, y| *x.min(y) },
        Binary { name: "max", modal: |x, y| Some(x.max(y)), value: |x, y| *x.max(y) },
    ];
    let mut rng = Rng::with_seed(40);
    for _ in 0..cases(2000) {
        let [a, b, c, d] = [(); 4].map(|()| rng.i64(-9..10));
        let (x, y) = (modal(a as f64, b as f64), modal(c as f64, d as f64));
        // Every whole number between the ends, so that no extreme is taken for granted.
        let all = |a: i64, b: i64| (a.min(b)..=a.max(b)).collect::<Vec<_>>();
        for op in table {
            let both = extensions((&all(a, b), a <= b), (&all(c, d), c <= d), op.value);
            for (lo, hi) in both {
                let z = (op.modal)(x, y).unwrap();
                assert_eq!((z.lo(), z.hi()), (lo as f64, hi as f64), "{x:?} {} {y:?}", op.name);
            }
        }
        let squares = all(a, b).into_iter().map(|x| (x * x) as f64);
        let (least, greatest) = squares.fold((f64::INFINITY, 0.0f64), |(low, high), s| (low.min(s), high.max(s)));
        let square = if a <= b { modal(least, greatest) } else { modal(greatest, least) };
        assert_eq!(x.sqr(), square, "{x:?}");
        assert_eq!(x.powi(2), square, "{x:?}");
        assert_eq!(x.abs().sqr(), square, "{x:?}");
    }
}

#[test]
fn both_roundings_are_tight() {
    let table: &[Binary<BigRational>] = &[
        Binary { name: "+", modal: |x, y| Some(x + y), value: |x, y| x + y },
        Binary { name: "-", modal: |x, y| Some(x - y), value: |x, y| x - y },
        Binary { name: "*", modal: |x, y| Some(x * y), value: |x, y| x * y },
        Binary { name: "/", modal: Modal::checked_div, value: |x, y| x / y },
    ];
    let mut rng = Rng::with_seed(41);
    for _ in 0..cases(500) {
        let [a, b, c, d] = [(); 4].map(|()| number(&mut rng));
        // Half of the divisors on one side of 0.
        let d = if rng.bool() { d.copysign(c) } else { d };
        let (x, y) = (modal(a, b), modal(c, d));
        let zero = BigRational::from(BigInt::from(0));
        let between = |a: f64, b: f64| members(exact(a), exact(b), zero.clone());
        for op in table {
            let Some(outer) = (op.modal)(x, y) else {
                assert!(op.name == "/" && c.min(d) <= 0.0 && c.max(d) >= 0.0, "{x:?} / {y:?}");
                continue;
            };
            let inner = Modal::inner([x, y], |[x, y]| (op.modal)(x, y).unwrap());
            for (lo, hi) in extensions((&between(a, b), a <= b), (&between(c, d), c <= d), op.value) {
                let name = op.name;
                assert!(is_rounded_down(outer.lo(), &lo) && is_rounded_up(outer.hi(), &hi), "{x:?} {name} {y:?}");
                assert!(is_rounded_up(inner.lo(), &lo) && is_rounded_down(inner.hi(), &hi), "{x:?} {name} {y:?}");
            }
            assert!(inner.is_subset(outer));
        }
    }
}

#[test]
fn operations_are_isotonic() {
    let mut rng = Rng::with_seed(42);
    for _ in 0..cases(4000) {
        let [a, b, c, d, e, f] = [(); 6].map(|()| number(&mut rng));
        let (x, y, z) = (modal(a, b), modal(c, d), modal(e, f));
        let wider = x.join(z);
        assert!(x.is_subset(wider) && x.meet(z).is_subset(x));
        assert!((x + y).is_subset(wider + y) && (x - y).is_subset(wider - y), "{x:?}, {wider:?}, {y:?}");
        assert!((x * y).is_subset(wider * y) && (y - x).is_subset(y - wider), "{x:?}, {wider:?}, {y:?}");
        assert!(x.sqr().is_subset(wider.sqr()) && x.exp().is_subset(wider.exp()), "{x:?}, {wider:?}");
        if let Some((quotient, wide)) = y.checked_div(x).zip(y.checked_div(wider)) {
            assert!(quotient.is_subset(wide), "{y:?} / {x:?}, {wider:?}");
        }
    }
}

/// Proper intervals are those of the set-based arithmetic.
#[test]
fn proper_intervals_are_sets() {
    let mut rng = Rng::with_seed(43);
    for _ in 0..cases(3000) {
        let (x, y) = (super::interval(&mut rng), super::interval(&mut rng));
        let (a, b) = (Modal::from_interval(x).unwrap(), Modal::from_interval(y).unwrap());
        let set = |z: Modal| z.to_interval().unwrap();
        assert_eq!((set(a + b), set(a - b), set(a * b)), (x + y, x - y, x * y), "{x}, {y}");
        assert_eq!((set(a.sqr()), set(a.abs()), set(a.exp()), set(a.atan())), (x.sqr(), x.abs(), x.exp(), x.atan()));
        assert_eq!((set(a.powi(3)), set(a.powi(4)), set(a.tanh())), (x.powi(3), x.powi(4), x.tanh()), "{x}");
        assert_eq!(a.sqrt().map(set), (x.lo() >= 0.0).then(|| x.sqrt()), "{x}");
        assert_eq!(a.checked_div(b).map(set), (!y.contains(0.0)).then(|| x / y), "{x} / {y}");
    }
    assert_eq!(Modal::from_interval(Interval::EMPTY), None);
    assert_eq!(modal(2.0, 1.0).to_interval(), None);
}

/// The lower end of e^X is at most e^lo and the upper one at least e^hi, in either order; inside out for inner rounding.
#[test]
fn elementary_functions_round_in_both_directions() {
    let mut cc = Consts::new().unwrap();
    let mut rng = Rng::with_seed(44);
    for _ in 0..cases(300) {
        let [a, b] = [(); 2].map(|()| rng.f64() * 40.0 - 20.0);
        let value = |x: f64, cc: &mut Consts| big(x).exp(256, RoundingMode::ToEven, cc);
        let (low, high) = (value(a, &mut cc), value(b, &mut cc));
        let (outer, inner) = (modal(a, b).exp(), Modal::inner([modal(a, b)], |[x]| x.exp()));
        assert!(big(outer.lo()) < low && big(outer.hi()) > high, "{a} {b}");
        assert!(big(inner.lo()) > low && big(inner.hi()) < high, "{a} {b}");
        let back = outer.ln().unwrap();
        assert!(
            modal(a, b).is_subset(back) && (back.lo() - a).abs() < 1e-7 && (back.hi() - b).abs() < 1e-7,
            "{back:?}"
        );
    }
    assert_eq!((modal(1.0, -1.0).ln(), modal(1.0, 0.0).ln(), modal(4.0, -0.5).sqrt()), (None, None, None));
    assert_eq!(modal(9.0, 4.0).sqrt(), Some(modal(3.0, 2.0)));
    assert_eq!((modal(8.0, -27.0).cbrt(), modal(2.0, -1.0).sqr()), (modal(2.0, -3.0), modal(4.0, 0.0)));
}

#[test]
fn lattice() {
    let (x, y) = (modal(1.0, 3.0), modal(3.0, 2.0));
    assert_eq!((x.dual(), y.prop(), x.is_proper(), y.is_proper()), (modal(3.0, 1.0), modal(2.0, 3.0), true, false));
    assert_eq!((x.meet(y), x.join(y)), (modal(3.0, 2.0), modal(1.0, 3.0)));
    assert!(y.is_subset(x) && !x.is_subset(y) && modal(0.0, 2.0).is_less_equal(y) && !x.is_less_equal(y));
    assert_eq!(-y, modal(-2.0, -3.0));
    // For every x in [1, 3] there are z in [4, 5] and y in [2, 3] with x + y = z.
    assert_eq!(x + y, modal(4.0, 5.0));
    assert_eq!(Modal::new(f64::NAN, 0.0), None);
    // Opposite infinities leave an end open.
    let (all, none) = (modal(f64::NEG_INFINITY, f64::INFINITY), modal(f64::INFINITY, f64::NEG_INFINITY));
    assert_eq!((all + none, none * modal(0.0, 0.0)), (all, modal(0.0, 0.0)));
}

/// x y / (x + y) on X = [2, 3], Y = [4, 3]: the example of the thesis for its theorems 5, 3 and 6. The function grows in
/// x and in y, while the x and the y of the denominator make it fall.
#[test]
fn theorems_of_the_thesis() {
    let (x, y) = (modal(2.0, 3.0), modal(4.0, 3.0));
    let f = |[x, y, x_below, y_below]: [Modal; 4]| (x * y).checked_div(x_below + y_below).unwrap();
    let ratio = |n: i64, d: i64| BigRational::new(BigInt::from(n), BigInt::from(d));
    // An improper variable that occurs twice becomes a point.
    let point = modal(4.0, 4.0);
    for (arguments, lo, hi) in [
        // Theorem 5: nothing but that.
        ([x, point, x, point], ratio(8, 7), ratio(2, 1)),
        // Theorem 3 for x: the falling occurrence is dualised. (The thesis prints 1.7144 for 12/7 = 1.714285...)
        ([x, point, x.dual(), point], ratio(4, 3), ratio(12, 7)),
        // Theorem 6, for x and y: the result is f* itself.
        ([x, y, x.dual(), y.dual()], ratio(4, 3), ratio(3, 2)),
    ] {
        let (outer, inner) = (f(arguments), Modal::inner(arguments, f));
        assert!(is_rounded_down(outer.lo(), &lo) && is_rounded_up(outer.hi(), &hi), "{outer:?}");
        assert!(is_rounded_up(inner.lo(), &lo) && is_rounded_down(inner.hi(), &hi), "{inner:?}");
    }
}
