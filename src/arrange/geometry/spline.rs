//! Bezier curves along edges, fitted with Kurbo.
//!
//! The fit is one by numbers, not by proof: cubic curves with the tangents of the gradient whose area and moment match
//! (R. Levien, "Fitting cubic Bezier curves", 2021), halved until they are near enough to the polyline.

use std::ops::Range;

use kurbo::BezPath;
use kurbo::CubicBez;
use kurbo::Line;
use kurbo::ParamCurve;
use kurbo::ParamCurveNearest;
use kurbo::Point;
use kurbo::Vec2;
use kurbo::simplify::SimplifyBezPath;

use crate::arrange::field::Fields;
use crate::arrange::field::Function;
use crate::arrange::geometry::arc::Body;
use crate::arrange::geometry::arc::middle;
use crate::arrange::geometry::flatten;
use crate::arrange::geometry::functions;
use crate::arrange::geometry::polyline;
use crate::arrange::geometry::refine::Chain;
use crate::arrange::geometry::refine::Evaluate;
use crate::arrange::geometry::trace::trace;
use crate::arrange::structure::Arrangement;
use crate::interval::Interval;

/// Samples on a Bezier curve for each point of the polyline beside it.
const SAMPLES: usize = 4;

/// Bezier curves along an edge.
#[derive(Debug, Clone)]
pub struct Spline {
    /// From the edge's origin to its end; cubic curves meet in points of the polyline. Empty if nothing is known of the edge.
    pub path: BezPath,
    /// The largest distance found between curves and polyline, at many points of both: measured, not proved.
    pub measured: f64,
    /// The proved distance between polyline and edge, as in [`super::Polyline`].
    pub deviation: f64,
}

impl Spline {
    /// The distance from the edge to be expected. It is no proved bound.
    pub fn error(&self) -> f64 {
        self.measured + self.deviation
    }
}

/// A spline for each edge, near to it within the tolerance as far as can be measured.
pub fn splines(arrangement: &Arrangement, fields: &Fields, tolerance: f64) -> Vec<Spline> {
    splines_of(arrangement, &functions(fields), &|queries| fields.evaluate(queries), tolerance)
}

pub(super) fn splines_of(
    arrangement: &Arrangement,
    functions: &[Function],
    evaluate: &Evaluate,
    tolerance: f64,
) -> Vec<Spline> {
    let mut chains = trace(arrangement, functions, evaluate);
    // The polyline's distance counts twice: from the edge, and from a curve that follows the edge better than it does.
    let third = tolerance / 3.0;
    flatten(&mut chains, evaluate, third);
    let queries: Vec<_> = chains
        .iter()
        .flatten()
        .flat_map(|arc| arc.ends.map(|end| (arc.function, middle(&end).map(Interval::point))))
        .collect();
    let mut gradients = evaluate(&queries).into_iter().map(|sample| sample.slope.map(Interval::mid));
    chains
        .iter()
        .map(|chain| {
            let gradients: Vec<[f64; 2]> = gradients.by_ref().take(2 * chain.len()).collect();
            spline(chain, &gradients, third)
        })
        .collect()
}

/// The spline along stretches, with the gradients at the first and the last point of each.
fn spline(chain: &Chain, gradients: &[[f64; 2]], accuracy: f64) -> Spline {
    let points: Vec<Point> = polyline(chain).points.iter().map(|&[x, y]| Point::new(x, y)).collect();
    let mut spline = Spline {
        path: BezPath::new(),
        measured: 0.0,
        deviation: chain.iter().map(|arc| arc.deviation()).fold(0.0, f64::max),
    };
    let Some(&origin) = points.first().filter(|_| !chain.is_empty()) else {
        return Spline { deviation: f64::INFINITY, ..spline };
    };
    spline.path.move_to(origin);
    // Moments of figures far from the origin would lose digits.
    let points: Vec<Point> = points.iter().map(|&point| (point - origin).to_point()).collect();
    let pieces = points.windows(2).zip(gradients.chunks_exact(2)).zip(chain);
    let pieces: Vec<CubicBez> = pieces
        .map(|((ends, gradients), arc)| {
            let tangents = [gradients[0], gradients[1]].map(|g| tangent(g, ends[1] - ends[0]));
            hermite([ends[0], ends[1]], tangents.map(|t| t.filter(|_| matches!(arc.body, Body::Graph { .. }))))
        })
        .collect();
    // Curves are fitted to runs of stretches; what is hidden stays a line of its own.
    let mut start = 0;
    while start < chain.len() {
        let graph = |k: usize| matches!(chain[k].body, Body::Graph { .. });
        let mut end = start + 1;
        while graph(start) && end < chain.len() && graph(end) {
            end += 1;
        }
        let run = Run::new(&pieces[start..end], &points[start..=end], accuracy);
        run.fit(0..end - start, &mut |curve, distance| {
            let [a, b, c] = [curve.p1, curve.p2, curve.p3].map(|point| origin + point.to_vec2());
            spline.path.curve_to(a, b, c);
            spline.measured = spline.measured.max(distance);
        });
        start = end;
    }
    spline
}

/// The unit vector along a curve with this gradient, in the direction of its chord; `None` if they do not agree.
fn tangent(gradient: [f64; 2], chord: Vec2) -> Option<Vec2> {
    let along = Vec2::new(-gradient[1], gradient[0]);
    let along = if along.dot(chord) < 0.0 { -along } else { along };
    let unit = along / along.hypot();
    (unit.is_finite() && unit.dot(chord) > 0.0).then_some(unit)
}

/// The cubic curve between two points with the given tangents, or with that of the chord.
fn hermite(ends: [Point; 2], tangents: [Option<Vec2>; 2]) -> CubicBez {
    let chord = ends[1] - ends[0];
    let [first, last] = tangents.map(|tangent| tangent.map_or(chord, |unit| unit * chord.hypot()) / 3.0);
    CubicBez::new(ends[0], ends[0] + first, ends[1] - last, ends[1])
}

/// What curves are fitted to: a smooth path with one piece for each segment of the polyline beside it.
struct Run<'a> {
    path: SimplifyBezPath,
    pieces: &'a [CubicBez],
    points: &'a [Point],
    accuracy: f64,
}

impl<'a> Run<'a> {
    fn new(pieces: &'a [CubicBez], points: &'a [Point], accuracy: f64) -> Self {
        let mut path = BezPath::new();
        path.move_to(points[0]);
        pieces.iter().for_each(|piece| path.curve_to(piece.p1, piece.p2, piece.p3));
        Self { path: SimplifyBezPath::new(path), pieces, points, accuracy }
    }

    /// Fits one curve to a range of pieces, or halves the range; hands over curves with their measured distances.
    fn fit(&self, range: Range<usize>, accept: &mut impl FnMut(CubicBez, f64)) {
        let own = &self.points[range.start..=range.end];
        if range.len() == 1 {
            let curve = self.pieces[range.start];
            let bulge = distance(&curve, own);
            // Tangents at the ends of a long stretch may carry the curve away from a polyline that is near enough.
            match bulge <= 2.0 * self.accuracy {
                true => accept(curve, bulge),
                false => accept(hermite([own[0], own[1]], [None; 2]), 0.0),
            }
            return;
        }
        let [from, to] = [range.start, range.end].map(|at| at as f64 / self.pieces.len() as f64);
        if let Some((curve, _)) = kurbo::fit_to_cubic(&self.path, from..to, self.accuracy) {
            let curve = CubicBez::new(own[0], curve.p1, curve.p2, own[own.len() - 1]);
            let distance = distance(&curve, own);
            // The polyline itself is up to the accuracy from what was fitted.
            if distance <= 2.0 * self.accuracy {
                accept(curve, distance);
                return;
            }
        }
        let middle = range.start + range.len() / 2;
        self.fit(range.start..middle, accept);
        self.fit(middle..range.end, accept);
    }
}

/// The Hausdorff distance between a curve and a polyline, measured at the polyline's points and at many of the curve's.
fn distance(curve: &CubicBez, points: &[Point]) -> f64 {
    let to_curve = points.iter().map(|&point| curve.nearest(point, 1e-9 * curve.p0.distance(curve.p3)).distance_sq);
    let mut worst = to_curve.fold(0.0, f64::max);
    let count = SAMPLES * points.len();
    let apart = |point: Point, k: usize| Line::new(points[k], points[k + 1]).nearest(point, 0.0).distance_sq;
    let mut near = 0;
    for sample in 0..=count {
        let point = curve.eval(sample as f64 / count as f64);
        // The nearest segment moves on with the curve; where it does not, too large a distance is found.
        let mut best = apart(point, near);
        while near + 2 < points.len() {
            let next = apart(point, near + 1);
            if next > best {
                break;
            }
            (best, near) = (next, near + 1);
        }
        worst = worst.max(best);
    }
    worst.sqrt()
}
