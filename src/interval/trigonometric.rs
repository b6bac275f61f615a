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
    /// Sines of both bounds, rounded to nearest.
    sines: [f64; 2],
    /// Cosines of both bounds.
    cosines: [f64; 2],
}

impl Turn {
    /// The interval must not be empty; `None` if it is as long as a turn, or nearly so, or unbounded.
    fn of(x: Interval) -> Option<Self> {
        // The constant is 2 pi rounded down, and the width is rounded up.
        let width = x.width();
        if width >= std::f64::consts::TAU {
            return None;
        }
        let (low, high) = (core_math::sincos(x.lo), core_math::sincos(x.hi));
        let (first, last) = (quadrant(low), quadrant(high));
        // The number of boundaries is known modulo 4, and at most 4, as 5 need more than 4 quadrants' length. It is 0
        // or 4 for equal quadrants: 0 if the length is at most pi/2, 4 if it is more than 3 pi/2. 3 lies between.
        let crossed = match (last + 4 - first) % 4 {
            0 if width > 3.0 => 4,
            n => n,
        };
        Some(Self { first, crossed, sines: [low.0, high.0], cosines: [low.1, high.1] })
    }

    /// Whether the boundary into `quadrant` is crossed.
    fn enters(&self, quadrant: u32) -> bool {
        (quadrant + 3 - self.first) % 4 < self.crossed
    }
}

/// The quadrant of a number with this sine and cosine, modulo 4.
fn quadrant((sin, cos): (f64, f64)) -> u32 {
    match (sin >= 0.0, cos >= 0.0) {
        (true, true) => 0,
        (true, false) => 1,
        (false, false) => 2,
        (false, true) => 3,
    }
}

/// Bounds of sine or cosine between its extremes, from the rounded values at both ends: `peak` and `trough` tell
/// whether the extremes are taken.
fn wave(x: Interval, [a, b]: [f64; 2], peak: bool, trough: bool) -> Interval {
    // The values at 0 are exact, and no others (Lindemann).
    let (a_exact, b_exact) = (x.lo == 0.0, x.hi == 0.0);
    let down = |value: f64, exact| if exact { value } else { value.next_down() };
    let up = |value: f64, exact| if exact { value } else { value.next_up() };
    let lo = if trough { -1.0 } else { down(a, a_exact).min(down(b, b_exact)).max(-1.0) };
    Interval::raw(lo, if peak { 1.0 } else { up(a, a_exact).max(up(b, b_exact)).min(1.0) })
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
            Some(turn) => wave(self, turn.sines, turn.enters(1), turn.enters(3)),
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
            Some(turn) => wave(self, turn.cosines, turn.enters(0), turn.enters(2)),
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
        // Increasing between poles, and exact where it is 0: at 0 alone.
        let (lo, hi) = (core_math::tan(self.lo), core_math::tan(self.hi));
        Self::raw(if lo == 0.0 { lo } else { lo.next_down() }, if hi == 0.0 { hi } else { hi.next_up() })
    }

    /// Whether an odd multiple of pi/2 may be a member: exact but for intervals that are about as long as a turn or
    /// longer, which have one anyway.
    pub(super) fn has_tangent_pole(self) -> bool {
        let principal = Self { lo: -Self::HALF_PI.lo, hi: Self::HALF_PI.lo };
        if principal.contains_interval(self) {
            return false;
        }
        Turn::of(self).is_none_or(|turn| turn.enters(1) || turn.enters(3))
    }
}
