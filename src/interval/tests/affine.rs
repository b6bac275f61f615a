//! Affine forms against exact rationals: the form must hold the true value at the true symbols, not only somewhere.

use super::{cases, exact, interval, members};
use crate::interval::{Affine, Interval, Linear};
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
