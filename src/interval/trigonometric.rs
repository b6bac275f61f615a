//! Sine, cosine and tangent over intervals.
//!
//! No multiple of pi/2 but 0 is a rational number, so sin x and cos x of a `f64` other than 0 are never 0, and the
//! signs of their correctly rounded values (CORE-MATH) are the true ones, at 2^1023 as at 1: no other number comes
//! within 2^-1074 of a zero (the nearest is some 2^-60 away). The two signs name the quadrant of x, exactly; how many
//! quadrants an interval crosses then follows from its width to within an error that is far from mattering.

use super::Interval;

/// A stretch of the real line that is shorter than a whole turn, in quadrants [k pi/2, (k + 1) pi/2).
struct Turn {
    /// The quadrant of the lower bound, 0 to 3.
    first: u32,
    /// How many boundaries between quadrants lie in (lo, hi], 0 to 4.
    crossed: u32,
}

impl Turn {
    /// The interval must not be empty; `None` if it is as long as a turn, or nearly so, or unbounded.
    fn of(x: Interval) -> Option<Self> {
        // The constant is 2 pi rounded down, and the width is rounded up.
        let width = x.width();
        if width >= std::f64::consts::TAU {
            return None;
        }
        let (first, last) = (quadrant(x.lo()), quadrant(x.hi()));
        // The number of boundaries is known modulo 4, and at most 4, as 5 need more than 4 quadrants' length. It is 0
        // or 4 for equal quadrants: 0 if the length is at most pi/2, 4 if it is more than 3 pi/2. 3 lies between.
        let crossed = match (last + 4 - first) % 4 {
            0 if width > 3.0 => 4,
            n => n,
        };
        Some(Self { first, crossed })
    }

    /// Whether the boundary into `quadrant` is crossed.
    fn enters(&self, quadrant: u32) -> bool {
        (quadrant + 3 - self.first) % 4 < self.crossed
    }
}

/// The quadrant of the finite number `x`, modulo 4.
fn quadrant(x: f64) -> u32 {
    let (sin, cos) = core_math::sincos(x);
    match (sin >= 0.0, cos >= 0.0) {
        (true, true) => 0,
        (true, false) => 1,
        (false, false) => 2,
        (false, true) => 3,
    }
}

/// Bounds of sine or cosine between its extremes: `peak` and `trough` tell whether those are taken.
fn wave(x: Interval, f: impl Fn(f64) -> f64, exact: impl Fn(f64) -> bool, peak: bool, trough: bool) -> Interval {
    let bounds = |t: f64| {
        let nearest = f(t);
        if exact(t) { (nearest, nearest) } else { (nearest.next_down(), nearest.next_up()) }
    };
    let (a, b) = (bounds(x.lo), bounds(x.hi));
    let lo = if trough { -1.0 } else { a.0.min(b.0).max(-1.0) };
    Interval::raw(lo, if peak { 1.0 } else { a.1.max(b.1).min(1.0) })
}

impl Interval {
    /// The sine.
    pub fn sin(self) -> Self {
        if self.is_empty() {
            return self;
        }
        match Turn::of(self) {
            None => Self { lo: -1.0, hi: 1.0 },
            // The sine is 1 where quadrant 1 begins and -1 where quadrant 3 does.
            Some(turn) => wave(self, core_math::sin, |x| x == 0.0, turn.enters(1), turn.enters(3)),
        }
    }

    /// The cosine.
    pub fn cos(self) -> Self {
        if self.is_empty() {
            return self;
        }
        match Turn::of(self) {
            None => Self { lo: -1.0, hi: 1.0 },
            // The cosine is 1 where quadrant 0 begins and -1 where quadrant 2 does.
            Some(turn) => wave(self, core_math::cos, |x| x == 0.0, turn.enters(0), turn.enters(2)),
        }
    }

    /// The tangent, outside its poles: the whole line if one of those is a member.
    pub fn tan(self) -> Self {
        if self.is_empty() {
            return self;
        }
        if self.has_tangent_pole() {
            return Self::ENTIRE;
        }
        // Increasing between poles.
        let bound =
            |x: f64| if x == 0.0 { (0.0, 0.0) } else { (core_math::tan(x).next_down(), core_math::tan(x).next_up()) };
        Self::raw(bound(self.lo).0, bound(self.hi).1)
    }

    /// Whether an odd multiple of pi/2 may be a member: exact but for intervals that are about as long as a turn or
    /// longer, which have one anyway.
    pub(super) fn has_tangent_pole(self) -> bool {
        Turn::of(self).is_none_or(|turn| turn.enters(1) || turn.enters(3))
    }
}
