//! The four functions and their gradients on intervals of inari, in plain Rust: what one writes without a compiler of
//! formulas. Boxes come as columns and go through one at a time.

use imp::kernel::Real;
use imp::kernel::verdict;
use inari::Interval;
use inari::const_interval;
use inari::interval;

use crate::branch::Bounds;
use crate::branch::Objective;
use crate::branch::Side;

const LANES: usize = <f64 as Real>::LANES;

/// A function with its gradient, on one box.
pub trait Function<const N: usize>: Sync {
    fn value(x: &[Interval; N]) -> Interval;
    fn gradient(x: &[Interval; N]) -> (Interval, [Interval; N]);
}

/// A [`Function`] under branch and bound.
pub struct ByHand<F>(pub F);

impl<const N: usize, F: Function<N>> Objective<N> for ByHand<F> {
    fn values(&self, count: usize, boxes: &[Side], values: &mut [Bounds]) {
        for (g, (boxes, value)) in boxes.chunks_exact(N).zip(values).enumerate() {
            for k in 0..LANES.min(count - g * LANES) {
                write(value, k, F::value(&read(boxes, k)));
            }
        }
    }

    fn slopes(&self, count: usize, boxes: &[Side], slopes: &mut [Bounds]) {
        for (g, (boxes, bounds)) in boxes.chunks_exact(N).zip(slopes.chunks_exact_mut(N + 1)).enumerate() {
            for k in 0..LANES.min(count - g * LANES) {
                let (value, gradient) = F::gradient(&read::<N>(boxes, k));
                write(&mut bounds[0], k, value);
                for (bound, slope) in bounds[1..].iter_mut().zip(gradient) {
                    write(bound, k, slope);
                }
            }
        }
    }
}

fn read<const N: usize>(boxes: &[Side], k: usize) -> [Interval; N] {
    std::array::from_fn(|i| interval!(-boxes[i][0].0[k], boxes[i][1].0[k]).unwrap_or(Interval::ENTIRE))
}

/// All four functions are continuous everywhere.
fn write(bounds: &mut Bounds, k: usize, value: Interval) {
    bounds[0].0[k] = -value.inf();
    bounds[1].0[k] = value.sup();
    bounds[2].0[k] = f64::from_verdict(verdict::CONTINUOUS);
}

macro_rules! whole {
    ($value:expr) => {
        const_interval!($value, $value)
    };
}

/// The number of variables.
fn dimension<const N: usize>() -> Interval {
    interval!(N as f64, N as f64).unwrap_or(Interval::ENTIRE)
}

pub struct Himmelblau;

impl<const N: usize> Function<N> for Himmelblau {
    fn value(x: &[Interval; N]) -> Interval {
        let mut sum = whole!(0.0);
        for pair in x.chunks_exact(2) {
            let (a, b) = (pair[0].sqr() + pair[1] - whole!(11.0), pair[0] + pair[1].sqr() - whole!(7.0));
            sum += a.sqr() + b.sqr();
        }
        sum
    }

    fn gradient(x: &[Interval; N]) -> (Interval, [Interval; N]) {
        let mut sum = whole!(0.0);
        let mut slopes = [whole!(0.0); N];
        for (pair, slope) in x.chunks_exact(2).zip(slopes.chunks_exact_mut(2)) {
            let (a, b) = (pair[0].sqr() + pair[1] - whole!(11.0), pair[0] + pair[1].sqr() - whole!(7.0));
            sum += a.sqr() + b.sqr();
            slope[0] = whole!(4.0) * pair[0] * a + whole!(2.0) * b;
            slope[1] = whole!(2.0) * a + whole!(4.0) * pair[1] * b;
        }
        (sum, slopes)
    }
}

pub struct Rosenbrock;

impl<const N: usize> Function<N> for Rosenbrock {
    fn value(x: &[Interval; N]) -> Interval {
        let terms = x.windows(2).map(|x| whole!(100.0) * (x[1] - x[0].sqr()).sqr() + (whole!(1.0) - x[0]).sqr());
        terms.fold(whole!(0.0), |sum, term| sum + term)
    }

    fn gradient(x: &[Interval; N]) -> (Interval, [Interval; N]) {
        let mut sum = whole!(0.0);
        let mut slopes = [whole!(0.0); N];
        for i in 0..N - 1 {
            let (bend, rest) = (x[i + 1] - x[i].sqr(), whole!(1.0) - x[i]);
            sum += whole!(100.0) * bend.sqr() + rest.sqr();
            slopes[i] = slopes[i] - whole!(400.0) * bend * x[i] - whole!(2.0) * rest;
            slopes[i + 1] = whole!(200.0) * bend;
        }
        (sum, slopes)
    }
}

pub struct Ackley;

impl Ackley {
    /// The two exponentials and the radius.
    fn parts<const N: usize>(x: &[Interval; N]) -> [Interval; 3] {
        let n = dimension::<N>();
        let squares = x.iter().fold(whole!(0.0), |sum, x| sum + x.sqr());
        let waves = x.iter().fold(whole!(0.0), |sum, x| sum + (Interval::TAU * *x).cos());
        let radius = (squares / n).sqrt();
        [(-(radius / whole!(5.0))).exp(), (waves / n).exp(), radius]
    }
}

impl<const N: usize> Function<N> for Ackley {
    fn value(x: &[Interval; N]) -> Interval {
        let [bell, waves, _] = Ackley::parts(x);
        whole!(20.0) + Interval::E - whole!(20.0) * bell - waves
    }

    fn gradient(x: &[Interval; N]) -> (Interval, [Interval; N]) {
        let [bell, waves, radius] = Ackley::parts(x);
        let n = dimension::<N>();
        let (outer, inner) = (whole!(4.0) * bell / (n * radius), Interval::TAU * waves / n);
        let slopes = x.map(|x| {
            // At the kink the quotient has no value: whatever the slope is there, nothing is said of it.
            let outer = if radius.contains(0.0) { Interval::ENTIRE } else { outer * x };
            outer + inner * (Interval::TAU * x).sin()
        });
        (whole!(20.0) + Interval::E - whole!(20.0) * bell - waves, slopes)
    }
}

pub struct Rastrigin;

impl<const N: usize> Function<N> for Rastrigin {
    fn value(x: &[Interval; N]) -> Interval {
        x.iter()
            .fold(whole!(10.0) * dimension::<N>(), |sum, x| sum + x.sqr() - whole!(10.0) * (Interval::TAU * *x).cos())
    }

    fn gradient(x: &[Interval; N]) -> (Interval, [Interval; N]) {
        let twenty = whole!(20.0);
        let slopes = x.map(|x| whole!(2.0) * x + twenty * Interval::PI * (Interval::TAU * x).sin());
        (Self::value(x), slopes)
    }
}
