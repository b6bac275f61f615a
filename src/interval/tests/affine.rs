//! Affine forms against exact rationals: the form must hold the true value at the true symbols, not only somewhere.

use super::{cases, exact, interval, members};
use crate::interval::{Affine, Form, FullAffine, Interval, Linear};
use fastrand::Rng;
use num_rational::BigRational;
use num_traits::{Signed, Zero};

const N: usize = 3;

/// A value computed twice: as a form, and exactly at chosen values of the symbols.
#[derive(Clone)]
struct Pair {
    form: Affine<N>,
    value: BigRational,
}

/// |value - (c + a . e)| <= error.
fn holds(pair: &Pair, symbols: &[BigRational; N]) -> bool {
    if !pair.form.is_bounded() {
        return true;
    }
    let terms = pair.form.coefficients().iter().zip(symbols).map(|(a, e)| exact(*a) * e);
    let affine = terms.fold(exact(pair.form.centre()), |sum, term| sum + term);
    (&pair.value - affine).abs() <= exact(pair.form.error())
}

fn square(x: &Affine<N>) -> Affine<N> {
    x.apply(&Linear::sqr(x.to_interval()))
}

#[test]
fn forms_hold_their_values() {
    let mut rng = Rng::with_seed(40);
    for case in 0..cases(300) {
        let mut symbols = [BigRational::zero(), BigRational::zero(), BigRational::zero()];
        let mut pool = Vec::new();
        for (i, symbol) in symbols.iter_mut().enumerate() {
            // Half of the cases in the range where pictures live, half anywhere.
            let x = if case % 2 == 0 {
                let lo = (rng.f64() - 0.5) * 10.0;
                Interval::new(lo, lo + rng.f64()).unwrap()
            } else {
                interval(&mut rng)
            };
            let a = members(&mut rng, x)[rng.usize(0..5)];
            let form = Affine::from_interval(x, i);
            assert!(form.to_interval().contains_interval(x), "{x}");
            if form.is_bounded() && x.rad() > 0.0 {
                *symbol = (exact(a) - exact(x.mid())) / exact(x.rad());
                assert!(symbol.abs() <= exact(1.0));
            }
            pool.push(Pair { form, value: exact(a) });
        }
        for step in 0..8 {
            let (x, y) = (pool[rng.usize(0..pool.len())].clone(), pool[rng.usize(0..pool.len())].clone());
            let next = match rng.u32(0..6) {
                0 => Pair { form: x.form + y.form, value: x.value + y.value },
                1 => Pair { form: x.form - y.form, value: x.value - y.value },
                2 => Pair { form: -x.form, value: -x.value },
                3 => Pair { form: square(&x.form), value: &x.value * &x.value },
                4 => {
                    let k = interval(&mut rng);
                    let factor = members(&mut rng, k)[rng.usize(0..5)];
                    Pair { form: x.form.scale(k), value: x.value * exact(factor) }
                }
                _ => Pair { form: x.form * y.form, value: x.value * y.value },
            };
            assert!(holds(&next, &symbols), "case {case} step {step}: {:?}", next.form);
            let set = next.form.to_interval();
            let above = set.lo().is_infinite() || exact(set.lo()) <= next.value;
            assert!(above && (set.hi().is_infinite() || exact(set.hi()) >= next.value), "case {case}: {set}");
            // Denominators grow without end otherwise.
            if next.value.denom().bits() < 20_000 {
                pool.push(next);
            }
        }
    }
}

#[test]
fn shared_symbols_cancel() {
    let x = Affine::<N>::from_interval(Interval::new(1.0, 3.0).unwrap(), 0);
    assert_eq!((x - x).to_interval(), Interval::ZERO);
    assert_eq!((x + x).to_interval(), Interval::new(2.0, 6.0).unwrap());
    // With x = 2 + e, x^2 - 2x is 2e + e^2 = 0.5 + 2e up to 0.5: [-2, 3]. Its range is [-1, 3]; intervals give [-5, 7].
    let y = square(&x) - x.scale(Interval::point(2.0));
    assert_eq!(y.to_interval(), Interval::new(-2.0, 3.0).unwrap());
}

#[test]
fn what_is_not_finite_is_unbounded() {
    let wide = Affine::<N>::from_interval(Interval::new(1.0, f64::INFINITY).unwrap(), 0);
    assert_eq!(wide, Affine::UNBOUNDED);
    assert_eq!(Affine::<N>::constant(Interval::EMPTY), Affine::UNBOUNDED);
    let large = Affine::<N>::constant(Interval::point(f64::MAX));
    for form in
        [large + large, large * large, square(&large), -wide, wide - wide, wide * large, large.scale(Interval::ENTIRE)]
    {
        assert_eq!(form.to_interval(), Interval::ENTIRE);
    }
    let zero = Affine::<N>::constant(Interval::ZERO);
    assert_eq!((wide * zero).to_interval(), Interval::ENTIRE);
}

/// The check above is sharp enough to notice a sum that is rounded to nearest with nothing set aside for it.
#[test]
fn a_sum_without_its_error_is_noticed() {
    let mut rng = Rng::with_seed(41);
    let symbols = [BigRational::zero(), BigRational::zero(), BigRational::zero()];
    let noticed = (0..100).filter(|_| {
        let (a, b) = (rng.f64(), rng.f64());
        let form = Affine::constant(Interval::point(a + b));
        !holds(&Pair { form, value: exact(a) + exact(b) }, &symbols)
    });
    assert!(noticed.count() > 30);
}

/// Full forms: values at the true symbols, with every error a symbol that the next results share.
#[test]
fn full_forms_hold_their_values() {
    let mut rng = Rng::with_seed(42);
    for case in 0..cases(300) {
        // The place of the value between the ends of the symbol, by symbol; those that are claimed come later.
        let mut symbols: Vec<BigRational> = Vec::new();
        let mut pool: Vec<(FullAffine, BigRational)> = Vec::new();
        for _ in 0..3 {
            let lo = (rng.f64() - 0.5) * 10.0;
            let x = Interval::new(lo, lo + rng.f64()).unwrap();
            let a = members(&mut rng, x)[rng.usize(0..5)];
            pool.push((Form::from_interval(x, symbols.len()), exact(a)));
            symbols.push((exact(a) - exact(x.mid())) / exact(x.rad()));
        }
        for step in 0..8 {
            let ((x, a), (y, b)) = (pool[rng.usize(0..pool.len())].clone(), pool[rng.usize(0..pool.len())].clone());
            let (form, value) = match rng.u32(0..4) {
                0 => (x + y, a + b),
                1 => (x - y, a - b),
                2 => (x.apply(&Linear::sqr(x.to_interval())), &a * &a),
                _ => (x * y, a * b),
            };
            let terms = form.coefficients().terms().iter();
            let affine =
                terms.fold(exact(form.centre()), |sum, &(i, coefficient)| sum + exact(coefficient) * &symbols[i]);
            let rest = &value - affine;
            assert!(rest.abs() <= exact(form.error()), "case {case} step {step}: {form:?}");
            if value.denom().bits() > 3000 {
                break;
            }
            // The error's share becomes the value of the symbol that stands for it.
            let size = exact(form.error());
            symbols.push(if size.is_zero() { BigRational::zero() } else { rest / size });
            pool.push((form.claim(symbols.len() - 1), value));
        }
    }
}

#[test]
fn opposite_factors_have_a_product_of_one_sign() {
    // (5 + e)(5 - e) = 25 - e^2, of which AF1 sees |e^2| <= 1 alone.
    let x = FullAffine::from_interval(Interval::new(4.0, 6.0).unwrap(), 0);
    let ten = Form::constant(Interval::point(10.0));
    assert_eq!((x.clone() * (ten - x)).to_interval(), Interval::new(24.0, 25.0).unwrap());
    let x = Affine::<1>::from_interval(Interval::new(4.0, 6.0).unwrap(), 0);
    let ten = Affine::constant(Interval::point(10.0));
    assert_eq!((x * (ten - x)).to_interval(), Interval::new(24.0, 26.0).unwrap());
}
