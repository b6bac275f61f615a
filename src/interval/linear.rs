//! Certified linear enclosures of functions of one variable: what affine forms apply to their operand.
//!
//! Over an interval X a function f is enclosed between two parallel lines, f(x) in s x + D for every x of X at which f
//! is defined. The slope s is a number, so that nothing about it needs to be known: D encloses f(x) - s x on X for
//! whatever s there is. A good s makes D narrow (Chebyshev's minimax line where f is bent one way), and no rounding of
//! s can make it wrong.
//!
//! D comes from pieces of X on which f is convex or concave. On a convex piece [p, q] the difference g(x) = f(x) - s x
//! is convex too, whence
//! - g(x) <= max(g(p), g(q)), and
//! - g(x) >= g(u) + g'(u) (x - u) for every u of the piece: the tangent lies below. With u near the place where f'(u)
//!   = s the bound is the least value of g up to terms of second order, and it holds wherever u is.
//!
//! Both are evaluated with intervals. On concave pieces the two change sides. Between pieces, where an inflection lies
//! that is no `f64`, g is enclosed as f(Y) - s Y on the few numbers Y around it.

use super::Interval;

/// A function between two parallel lines: f(x) lies in `slope * x + offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear {
    slope: f64,
    offset: Interval,
}

impl Linear {
    /// The enclosure without a slope, which the range of the function is.
    pub(super) fn flat(range: Interval) -> Self {
        Self { slope: 0.0, offset: range }
    }

    /// A function that is `slope * x` exactly.
    pub(super) fn line(slope: f64) -> Self {
        Self { slope, offset: Interval::ZERO }
    }

    pub(super) fn new(slope: f64, offset: Interval) -> Self {
        Self { slope, offset }
    }

    /// The slope of both lines.
    pub fn slope(&self) -> f64 {
        self.slope
    }

    /// The values that f(x) - slope x can take; empty if f is nowhere defined, unbounded if it has no bounds.
    pub fn offset(&self) -> Interval {
        self.offset
    }
}

/// Which way a function is bent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Bend {
    Convex,
    Concave,
}

impl Bend {
    pub fn convex_if(convex: bool) -> Self {
        if convex { Self::Convex } else { Self::Concave }
    }

    pub fn reverse(self) -> Self {
        Self::convex_if(self == Self::Concave)
    }
}

/// A stretch on which a function is bent one way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub range: Interval,
    pub bend: Bend,
    /// The derivative takes the value s at `centre + side * distance(s)`, if anywhere on the piece: see [`Curve`].
    pub centre: f64,
    pub side: f64,
}

/// A function with what is needed to draw lines along it.
pub(super) struct Curve<F, D, U> {
    /// The function.
    pub value: F,
    /// Its derivative; only called for points of pieces.
    pub slope: D,
    /// How far from a piece's centre the derivative takes a value, up to rounding: decides how tight the enclosure is,
    /// not whether it holds. May be NaN.
    pub distance: U,
}

impl<F, D, U> Curve<F, D, U>
where
    F: Fn(Interval) -> Interval,
    D: Fn(Interval) -> Interval,
    U: Fn(f64) -> f64,
{
    /// The function on `x`, where it is defined and bent one way throughout.
    pub fn bent(&self, x: Interval, bend: Bend, side: f64) -> Linear {
        self.between_lines(x, &[Piece { range: x, bend, centre: 0.0, side }], &[])
    }

    /// The function on `x`, which has point symmetry about 0 but for a constant and is bent one way on either side.
    pub fn symmetric(&self, x: Interval, right: Bend) -> Linear {
        let left = Interval { lo: f64::NEG_INFINITY, hi: 0.0 };
        let sides = [(left, right.reverse(), -1.0), (Interval::NONNEGATIVE, right, 1.0)];
        let pieces: Vec<Piece> = sides
            .into_iter()
            .map(|(half, bend, side)| Piece { range: x.intersect(half), bend, centre: 0.0, side })
            .filter(|piece| !piece.range.is_empty())
            .collect();
        self.between_lines(x, &pieces, &[])
    }

    /// The function on `x`, which `pieces`, by rising place, and the `gaps` between them cover.
    pub fn between_lines(&self, x: Interval, pieces: &[Piece], gaps: &[Interval]) -> Linear {
        let flat = Linear::flat((self.value)(x));
        if !x.is_bounded() || x.is_singleton() || !flat.offset.is_bounded() {
            return flat;
        }
        let slope = match pieces {
            [left, right] if left.bend != right.bend => self.slope_past_inflection(x, left, right),
            _ => self.secant(x.lo(), x.hi()),
        };
        let Some(offset) = self.offset(slope, pieces, gaps) else { return flat };
        if offset.width() < flat.offset.width() { Linear::new(slope, offset) } else { flat }
    }

    /// The slope between two points of the graph.
    fn secant(&self, a: f64, b: f64) -> f64 {
        let at = |x: f64| (self.value)(Interval::point(x)).mid();
        (at(b) - at(a)) / (b - a)
    }

    /// Where the derivative takes the value `slope`, as a member of the piece.
    fn touching(&self, slope: f64, piece: &Piece) -> f64 {
        let place = piece.centre + piece.side * (self.distance)(slope);
        if place.is_nan() { piece.range.mid() } else { place.clamp(piece.range.lo(), piece.range.hi()) }
    }

    /// The slope of the narrowest band along a graph with one inflection. One of its lines passes through the end that
    /// is farther from the inflection and touches the graph beyond the inflection, or passes through the other end if
    /// that comes first. The secant's slope is stationary where it touches, so that going back and forth between place
    /// and slope converges quadratically.
    fn slope_past_inflection(&self, x: Interval, left: &Piece, right: &Piece) -> f64 {
        let far_right = right.range.width() >= left.range.width();
        let (end, mut place, piece) = if far_right { (x.hi(), x.lo(), left) } else { (x.lo(), x.hi(), right) };
        let mut slope = self.secant(place, end);
        for _ in 0..8 {
            let next = self.touching(slope, piece);
            if next == place || next == end {
                break;
            }
            place = next;
            slope = self.secant(place, end);
        }
        slope
    }

    /// Encloses f(x) - slope x on pieces and gaps; `None` if that has no bounds.
    fn offset(&self, slope: f64, pieces: &[Piece], gaps: &[Interval]) -> Option<Interval> {
        if !slope.is_finite() {
            return None;
        }
        let s = Interval::point(slope);
        let difference = |x: Interval| (self.value)(x) - s * x;
        let on_pieces = pieces.iter().map(|piece| {
            let Piece { range, bend, .. } = *piece;
            let ends = difference(Interval::point(range.lo())).hull(difference(Interval::point(range.hi())));
            let touching = Interval::point(self.touching(slope, piece));
            let tangent = difference(touching) + ((self.slope)(touching) - s) * (range - touching);
            let (lo, hi) = match bend {
                Bend::Convex => (tangent.lo(), ends.hi()),
                Bend::Concave => (ends.lo(), tangent.hi()),
            };
            // NaN if the derivative is not defined where the lines should touch.
            Interval::new(lo, hi).filter(|offset| offset.is_bounded())
        });
        let in_gaps = gaps.iter().map(|&gap| Some(difference(gap)).filter(|offset| offset.is_bounded()));
        on_pieces.chain(in_gaps).try_fold(Interval::EMPTY, |hull, offset| Some(hull.hull(offset?)))
    }
}
