//! Reverse operations: which x can have led to a known result? Contraction narrows variables with them.
//!
//! `f_rev(c, x)`, here `c.f_rev(x)` as in `sqr_rev`, is the hull of all members of `x` whose value under f lies in `c`.
//! Preimages come in branches, on each of which f is monotone; every branch is met with `x` before the hull is taken,
//! so that two branches far apart narrow `x` as well as one.

use super::Interval;
use num_integer::Integer;

impl Interval {
    fn nonpositive() -> Self {
        -Self::NONNEGATIVE
    }

    /// The hull of the parts of `x` in a set and in its mirror image.
    fn both_signs(self, x: Self) -> Self {
        self.intersect(x).hull((-self).intersect(x))
    }

    /// IEEE 1788 `sqrRev`: the members of `x` whose square is in this set.
    pub fn sqr_rev(self, x: Self) -> Self {
        self.sqrt().both_signs(x)
    }

    /// IEEE 1788 `absRev`: the members of `x` whose absolute value is in this set.
    pub fn abs_rev(self, x: Self) -> Self {
        self.intersect(Self::NONNEGATIVE).both_signs(x)
    }

    /// IEEE 1788 `pownRev`: the members of `x` whose `n`-th power is in this set.
    pub fn powi_rev(self, x: Self, n: i32) -> Self {
        self.pow_rational_rev(x, n, 1)
    }

    /// The members of `x` whose power with exponent `p/q`, as of [`Interval::pow_rational`], is in this set.
    pub fn pow_rational_rev(self, x: Self, p: i32, q: u32) -> Self {
        if q == 0 || self.is_empty() {
            return Self::EMPTY;
        }
        let divisor = q.gcd(&p.unsigned_abs());
        let (p, q) = ((i64::from(p) / i64::from(divisor)) as i32, q / divisor);
        let x = if q.is_multiple_of(2) { x.intersect(Self::NONNEGATIVE) } else { x };
        if p == 0 {
            return if self.contains(1.0) { x } else { Self::EMPTY };
        }
        let Ok(root) = i32::try_from(q) else {
            // The inverse exponent is out of range: nothing is said about x.
            return x;
        };
        // On x >= 0 the inverse is the power with exponent q/p.
        let inverse = |c: Self| c.intersect(Self::NONNEGATIVE).pow_nonnegative(root * p.signum(), p.unsigned_abs());
        let right = inverse(self);
        match (q.is_multiple_of(2), p % 2 == 0) {
            (true, _) => right.intersect(x),
            (false, true) => right.both_signs(x),
            (false, false) => right.intersect(x).hull((-inverse(-self)).intersect(x)),
        }
    }

    /// IEEE 1788 `coshRev`: the members of `x` whose hyperbolic cosine is in this set.
    pub fn cosh_rev(self, x: Self) -> Self {
        self.acosh().both_signs(x)
    }

    /// IEEE 1788 `sinRev`: the members of `x` whose sine is in this set.
    pub fn sin_rev(self, x: Self) -> Self {
        // Around k pi the sine is monotone on a length of pi; its inverse there is k pi + (-1)^k arcsin.
        let branches = |c: Self| {
            let principal = c.asin();
            move |k: f64| branch(k, if k % 2.0 == 0.0 { principal } else { -principal })
        };
        // An odd function: the last solution is the first one of the mirrored question.
        between(x, first(x, 0.5, branches(self)), first(-x, 0.5, branches(-self)))
    }

    /// IEEE 1788 `cosRev`: the members of `x` whose cosine is in this set.
    pub fn cos_rev(self, x: Self) -> Self {
        // From k pi to (k + 1) pi: k pi + arccos for even k, (k + 1) pi - arccos for odd k.
        let principal = self.acos();
        let branches = |k: f64| if k % 2.0 == 0.0 { branch(k, principal) } else { branch(k + 1.0, -principal) };
        between(x, first(x, 0.0, branches), first(-x, 0.0, branches))
    }

    /// IEEE 1788 `tanRev`: the members of `x` whose tangent is in this set.
    pub fn tan_rev(self, x: Self) -> Self {
        let branches = |c: Self| {
            let principal = c.atan();
            move |k: f64| branch(k, principal)
        };
        between(x, first(x, 0.5, branches(self)), first(-x, 0.5, branches(-self)))
    }

    /// IEEE 1788 `mulRev`: the members x of `x` with b x in `c` for some b in this set. With [`Interval::ENTIRE`] for
    /// `x` it is the standard's binary form.
    pub fn mul_rev(self, c: Self, x: Self) -> Self {
        let [low, high] = self.mul_rev_to_pair(c);
        low.intersect(x).hull(high.intersect(x))
    }

    /// IEEE 1788 `mulRevToPair`, two-output division: all x with b x in `c` for some b in this set, as two sets. The
    /// second is empty unless this set reaches to both sides of 0 and `c` is away from it; then the first is the lower
    /// one.
    pub fn mul_rev_to_pair(self, c: Self) -> [Self; 2] {
        let b = self;
        if b.contains(0.0) && c.contains(0.0) {
            // 0 x = 0 for all x.
            return [Self::ENTIRE, Self::EMPTY];
        }
        if b.lo < 0.0 && b.hi > 0.0 && !c.is_empty() {
            let below = Self { lo: b.lo, hi: 0.0 };
            let above = Self { lo: 0.0, hi: b.hi };
            return if c.lo > 0.0 { [c / below, c / above] } else { [c / above, c / below] };
        }
        // An empty set where b = 0 and c is away from it.
        [c / b, Self::EMPTY]
    }

    /// IEEE 1788 `powRev1`: the members x of `x` with x^b in `c`, as of [`Interval::pow`], for some b in this set.
    pub fn pow_rev1(self, c: Self, x: Self) -> Self {
        let (b, x) = (self, x.intersect(Self::NONNEGATIVE));
        // x = c^(1/b), on the two sides of b = 0, and x^0 = 1 for all x > 0.
        let inverse = |b: Self| if b == Self::ZERO { Self::EMPTY } else { c.pow(b.recip()).intersect(x) };
        let sides = inverse(b.intersect(Self::NONNEGATIVE)).hull(inverse(b.intersect(Self::nonpositive())));
        if b.contains(0.0) && c.contains(1.0) { sides.hull(x) } else { sides }
    }

    /// IEEE 1788 `powRev2`: the members x of `x` with a^x in `c`, as of [`Interval::pow`], for some a in this set.
    pub fn pow_rev2(self, c: Self, x: Self) -> Self {
        // x ln a = ln c; and 0^x = 0 for x > 0.
        let logarithms = self.ln().mul_rev(c.ln(), x);
        let zero = self.contains(0.0) && c.contains(0.0);
        if zero { logarithms.hull(x.intersect(Self::NONNEGATIVE)) } else { logarithms }
    }

    /// IEEE 1788 `atan2Rev1`: the members y of `y` with atan2(y, x) in `c` for some x in this set.
    pub fn atan2_rev1(self, c: Self, y: Self) -> Self {
        quadrants(c).fold(Self::EMPTY, |hull, quadrant| {
            let x = if quadrant.left { -self } else { self }.intersect(Self::NONNEGATIVE);
            // y = x tan; on the axis x = 0, where the angle is a right one, any y of that side.
            let size =
                if quadrant.slope.hi.is_infinite() && x.contains(0.0) { Self::NONNEGATIVE } else { x * quadrant.slope };
            hull.hull(if quadrant.lower { -size } else { size }.intersect(y))
        })
    }

    /// IEEE 1788 `atan2Rev2`: the members x of `x` with atan2(y, x) in `c` for some y in this set.
    pub fn atan2_rev2(self, c: Self, x: Self) -> Self {
        quadrants(c).fold(Self::EMPTY, |hull, quadrant| {
            let y = if quadrant.lower { -self } else { self }.intersect(Self::NONNEGATIVE);
            // x = y / tan; on the axis y = 0, where the tangent is 0, any x of that side.
            let size = if quadrant.slope.lo == 0.0 && y.contains(0.0) { Self::NONNEGATIVE } else { y / quadrant.slope };
            hull.hull(if quadrant.left { -size } else { size }.intersect(x))
        })
    }
}

/// The part of a set of angles in one quadrant.
struct Quadrant {
    left: bool,
    lower: bool,
    /// The size of the tangent, in [0, inf].
    slope: Interval,
}

/// The parts of a set of angles in (-pi, pi] by quadrants, their common bounds in both.
fn quadrants(c: Interval) -> impl Iterator<Item = Quadrant> {
    let quadrant = move |left: bool, lower: bool| {
        let c = if lower { -c } else { c };
        let c = if left { Interval::PI - c } else { c };
        // The angle from the x axis, at most pi/2, where the tangent is taken as unbounded.
        let c = c.intersect(Interval { lo: 0.0, hi: Interval::HALF_PI.hi });
        let increasing = |x: f64| Interval::point(x.min(Interval::HALF_PI.lo)).tan();
        let slope = (!c.is_empty()).then(|| {
            let hi = if c.hi > Interval::HALF_PI.lo { f64::INFINITY } else { increasing(c.hi).hi };
            Interval::raw(increasing(c.lo).lo, hi)
        });
        slope.map(|slope| Quadrant { left, lower, slope })
    };
    [(false, false), (true, false), (false, true), (true, true)].into_iter().filter_map(move |(l, b)| quadrant(l, b))
}

/// pi less the lower bound of [`Interval::PI`]: 1.22464679914735317722...e-16, just below the `f64` written here.
const PI_REST: Interval = Interval { lo: 1.2246467991473532e-16f64.next_down(), hi: 1.2246467991473532e-16 };

/// `k pi + principal`, where `k` is a whole number of at most 2^50.
fn branch(k: f64, principal: Interval) -> Interval {
    let k = Interval::point(k);
    // One rounding of k times the long part of pi, beside those of much smaller numbers.
    k.mul_add(Interval::point(Interval::PI.lo), k * PI_REST + principal)
}

/// A bound of all solutions in `x`, from below: `branches(k)` encloses those in [(k - shift) pi, (k + 1 - shift) pi].
/// `None` if there is none.
fn first(x: Interval, shift: f64, branches: impl Fn(f64) -> Interval) -> Option<f64> {
    if x.is_empty() || branches(0.0).is_empty() {
        return None;
    }
    // So far out, where neighbours are an eighth apart and more, x.lo itself is near enough.
    if x.lo.abs() > 1e15 {
        return Some(x.lo);
    }
    // The quotient is off by less than 1, and a branch lies in every window: three windows hold the first solution, and
    // one below makes up for the error.
    let k = (x.lo / std::f64::consts::PI + shift).floor();
    let solutions = (-1..=2).map(|i| branches(k + f64::from(i)).intersect(x)).fold(Interval::EMPTY, Interval::hull);
    (!solutions.is_empty()).then_some(solutions.lo)
}

/// The set from the first solution to the last one, given as the first of the mirrored question.
fn between(x: Interval, first: Option<f64>, mirrored: Option<f64>) -> Interval {
    match (first, mirrored) {
        (Some(lo), Some(hi)) if lo <= -hi => Interval::raw(lo, -hi).intersect(x),
        _ => Interval::EMPTY,
    }
}
