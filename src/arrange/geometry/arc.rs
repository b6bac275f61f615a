//! A stretch of a curve between two of its points, and what bounds on its slope say of it.
//!
//! Notation: the stretch is the graph of `u` over `t`, where `t` is the coordinate `axis` and `u` the other one, over an
//! interval of length `h`; its difference quotients lie in `[m, M]`, that of its chord is `c`. All bounds follow from this
//! alone, so the curve may have corners.

use crate::arrange::field::Function;
use crate::arrange::field::Sample;
use crate::interval::Interval;
use crate::kernel::verdict;

/// Enclosures of the coordinates of a point, or a box.
pub type Rect = [Interval; 2];

/// A stretch of an edge.
#[derive(Debug, Clone)]
pub struct Arc {
    /// The function whose zero it is.
    pub function: Function,
    /// The first and the last point, each somewhere in its box.
    pub ends: [Rect; 2],
    pub body: Body,
    /// Cannot be cut further.
    pub fixed: bool,
}

/// What is known of a stretch between its ends.
#[derive(Debug, Clone)]
pub enum Body {
    /// A graph over the coordinate `axis`: enclosures of the other coordinate and of the difference quotients (all reals if
    /// nothing is known of them).
    Graph { axis: usize, reach: Interval, slope: Interval },
    /// A simple curve within a cell, between nodes or a node and a vertex, not longer than `longest`.
    Hidden { cell: u32, hull: Rect, nodes: [Option<u32>; 2], longest: f64 },
}

/// The slopes of the curve f = 0 as a graph over x and over y, where they are proved bounded in a box that was sampled:
/// along the curve f_x dx + f_y dy = 0. Where f_y has no zero, f is strictly monotone along each vertical line of the box,
/// so that the curve has at most one point there; likewise with x and y exchanged.
pub fn slopes(sample: &Sample) -> [Option<Interval>; 2] {
    let [by_x, by_y] = sample.slope;
    let quotient = |along: Interval, across: Interval| {
        let regular = sample.bits & verdict::CONTINUOUS != 0 && !across.is_empty() && !across.contains(0.0);
        Some(-along / across).filter(|slope| regular && slope.is_bounded())
    };
    [quotient(by_x, by_y), quotient(by_y, by_x)]
}

/// Half the diagonal of a box, rounded up: how far a point of it can be from its middle.
pub fn radius(rect: &Rect) -> f64 {
    let [x, y] = rect.map(|side| Interval::point(side.rad()));
    x.hypot(y).hi()
}

/// The middle of a box.
pub fn middle(rect: &Rect) -> [f64; 2] {
    rect.map(Interval::mid)
}

/// The least box that holds both.
pub fn hull(a: &Rect, b: &Rect) -> Rect {
    [a[0].hull(b[0]), a[1].hull(b[1])]
}

impl Arc {
    /// A line segment along an axis between two points, both exactly on the line.
    pub fn straight(ends: [Rect; 2]) -> Self {
        let [a, b] = &ends;
        let axis = usize::from((b[1] - a[1]).mag() > (b[0] - a[0]).mag());
        let body = Body::Graph { axis, reach: a[1 - axis].hull(b[1 - axis]), slope: Interval::ZERO };
        Self { function: 0, ends, body, fixed: true }
    }

    /// A box that holds it.
    pub fn extent(&self) -> Rect {
        match self.body {
            Body::Graph { axis, reach, .. } => {
                let mut rect = hull(&self.ends[0], &self.ends[1]);
                rect[1 - axis] = reach;
                rect
            }
            Body::Hidden { hull, .. } => hull,
        }
    }

    /// The difference of the ends' coordinates.
    fn step(&self) -> [Interval; 2] {
        [0, 1].map(|k| self.ends[1][k] - self.ends[0][k])
    }

    /// The slope of the chord between the ends.
    fn chord(&self, axis: usize, slope: Interval) -> Interval {
        let step = self.step();
        if step[axis].contains(0.0) {
            return slope;
        }
        // The chord's slope is a difference quotient of the curve.
        let both = (step[1 - axis] / step[axis]).intersect(slope);
        if both.is_empty() { slope } else { both }
    }

    /// How far the stretch can be from its chord, along `u`; an upper bound.
    ///
    /// From its left end the graph rises by at most `M` per unit, and it must still fall to its right end by at least `m`
    /// per unit: with `t` a share `p` of the way, the distance above the chord is at most both `p h (M - c)` and
    /// `(1 - p) h (c - m)`. The two are equal at their highest common value `h (M - c) (c - m) / (M - m)`, which by the
    /// inequality of the means is at most `h (M - m) / 4`. Below the chord the same holds with `m` and `M` exchanged.
    fn sag(&self, axis: usize, slope: Interval) -> f64 {
        if !slope.is_bounded() {
            return f64::INFINITY;
        }
        let run = self.step()[axis].abs();
        let [least, greatest] = [slope.lo(), slope.hi()].map(Interval::point);
        let spread = greatest - least;
        let most = (run * spread * Interval::point(0.25)).hi();
        if spread.lo() <= 0.0 {
            return most;
        }
        let chord = self.chord(axis, slope);
        (run * (greatest - chord) * (chord - least) / spread).hi().min(most).max(0.0)
    }

    /// An upper bound of the Hausdorff distance between the stretch and the segment between the middles of its ends.
    pub fn deviation(&self) -> f64 {
        // Both lie in the box, and each point of one is as near to an end as the box is wide.
        let [width, height] = self.extent().map(|side| Interval::point(side.width()));
        let mut distance = width.hypot(height).hi();
        if let Body::Graph { axis, reach, slope } = self.body {
            let sag = self.sag(axis, slope).min(reach.width());
            distance = distance.min(sag);
            let chord = self.chord(axis, slope);
            // Each point of the chord is the foot of one of the curve, since the foot moves without jumps from end to end.
            // If the curve never turns back against the chord, feet stay between the ends too, and what counts is the
            // distance at right angles to the chord.
            if slope.is_bounded() && (Interval::ONE + slope * chord).lo() > 0.0 {
                let stretch = Interval::ONE.hypot(Interval::point(chord.mig()));
                distance = distance.min((Interval::point(sag) / stretch).hi());
            }
        }
        // Segments whose ends are near are near.
        let ends = radius(&self.ends[0]).max(radius(&self.ends[1]));
        (Interval::point(distance) + Interval::point(ends)).hi()
    }

    /// Encloses the length; unbounded above where nothing bounds the slope.
    ///
    /// The length is the integral of the convex function `g(s) = sqrt(1 + s^2)` of the slope, whose mean is `c`. By Jensen's
    /// inequality it is at least `h g(c)`, the chord's length; since `g` lies below its secant over `[m, M]`, it is at most
    /// `h` times the value of that secant at `c`. The difference is of the third order in `h`.
    pub fn length(&self) -> Interval {
        let step = self.step();
        let least = step[0].hypot(step[1]).lo().max(0.0);
        let mut most = match self.body {
            Body::Graph { .. } => f64::INFINITY,
            Body::Hidden { longest, .. } => longest,
        };
        if let Body::Graph { axis, slope, .. } = self.body
            && slope.is_bounded()
        {
            let [first, last] = [slope.lo(), slope.hi()].map(Interval::point);
            let [low, high] = [first, last].map(|s| Interval::ONE.hypot(s));
            let spread = last - first;
            let mean = if spread.lo() > 0.0 {
                let share = ((self.chord(axis, slope) - first) / spread).intersect(Interval::UNIT);
                let share = if share.is_empty() { Interval::UNIT } else { share };
                low + share * (high - low)
            } else {
                low.hull(high)
            };
            most = (step[axis].abs() * mean).hi();
        }
        Interval::new(least, most.max(least)).unwrap_or(Interval::ENTIRE)
    }

    /// Encloses the integral of (x dy - y dx) / 2 along the stretch, with coordinates relative to `origin`; `None` if it is
    /// hidden in its cell.
    ///
    /// It is the same integral along the chord, and the signed area between the two. Where the graph is at most `d` from the
    /// chord by [`Arc::sag`], it stays below the triangle over the chord with the height `d`: the area is at most
    /// `h d / 2 <= h^2 (M - m) / 8`, and also at most that of the box.
    pub fn integral(&self, origin: [f64; 2]) -> Option<Interval> {
        let bulge = Interval::point(self.bulge()?);
        Some(cross(&self.ends[0], &self.ends[1], origin) + (-bulge).hull(bulge))
    }

    /// The bound on the area between stretch and chord.
    pub fn bulge(&self) -> Option<f64> {
        let Body::Graph { axis, reach, slope } = self.body else { return None };
        let run = self.step()[axis].abs();
        let boxed = (run * Interval::point(reach.width())).hi();
        let sag = self.sag(axis, slope);
        let bent = if sag.is_finite() { (run * Interval::point(sag) * Interval::point(0.5)).hi() } else { sag };
        Some(bent.min(boxed))
    }
}

/// The integral of (x dy - y dx) / 2 along the segment from `a` to `b`.
pub fn cross(a: &Rect, b: &Rect, origin: [f64; 2]) -> Interval {
    let [x, y] = [0, 1].map(|k| a[k] - Interval::point(origin[k]));
    (x * (b[1] - a[1]) - y * (b[0] - a[0])) * Interval::point(0.5)
}
