//! The geometry of an arrangement's edges and faces: polylines with a proved distance, splines, lengths and areas.
//!
//! In each cell that an edge passes it is a graph over x or over y, proved by a derivative without a zero. `arc` has what
//! bounds on the slope say of such a stretch; `refine` cuts stretches until that is enough, many at once; `trace` has
//! the first ones; `area` follows the cycles of faces; [`spline`] fits Bezier curves.

mod arc;
mod area;
mod refine;
pub mod spline;
#[cfg(test)]
mod tests;
mod trace;

use serde::Serialize;

use crate::arrange::field::Fields;
use crate::arrange::field::Function;
use crate::arrange::structure::Arrangement;
use crate::interval::Interval;
use arc::middle;
use area::Walks;
use refine::Chain;
use refine::Evaluate;
use refine::refine;

/// Stretches into which all edges together may be cut for polylines.
const PIECES: usize = 1 << 22;

/// Points along an edge, from its origin to its end.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Polyline {
    /// The middles of enclosures of points of the edge. Neighbouring edges have the same point at their common vertex.
    pub points: Vec<[f64; 2]>,
    /// An upper bound of the Hausdorff distance between polyline and edge, proved if the edge is; infinite if nothing is
    /// known of the edge's course. Larger than asked where an edge ends in a vertex that could not be enclosed better.
    pub deviation: f64,
}

/// How well lengths and areas are enclosed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Precision {
    /// The wanted width of each enclosure, relative to its value.
    pub relative: f64,
    /// Stretches into which all edges together may be cut.
    pub pieces: usize,
}

impl Default for Precision {
    fn default() -> Self {
        Self { relative: 1e-6, pieces: 1 << 18 }
    }
}

/// Half a pixel of a picture of the domain with 1024 pixels along its longer side.
pub fn half_pixel(domain: &[Interval; 2]) -> f64 {
    domain[0].width().max(domain[1].width()) / 2048.0
}

/// A polyline for each edge, within the tolerance of it where that can be proved.
///
/// Parts within a vertex's cell in which the curve is no proved graph are straight, and their bound is that of the cell.
pub fn polylines(arrangement: &Arrangement, fields: &Fields, tolerance: f64) -> Vec<Polyline> {
    let evaluate = |queries: &[_]| fields.evaluate(queries);
    polylines_of(arrangement, &functions(fields), &evaluate, tolerance)
}

/// The length of each edge, unbounded above where it passes an unresolved region, or a singular point in which its slope is
/// not bounded.
pub fn lengths(arrangement: &Arrangement, fields: &Fields, precision: &Precision) -> Vec<Interval> {
    let evaluate = |queries: &[_]| fields.evaluate(queries);
    lengths_of(arrangement, &functions(fields), &evaluate, precision)
}

/// The area of each face; `None` for the outside of the domain, and for faces at the holes of unresolved regions.
pub fn areas(arrangement: &Arrangement, fields: &Fields, precision: &Precision) -> Vec<Option<Interval>> {
    let evaluate = |queries: &[_]| fields.evaluate(queries);
    areas_of(arrangement, &functions(fields), &evaluate, precision)
}

/// The functions of the components.
fn functions(fields: &Fields) -> Vec<Function> {
    fields.components.iter().map(|component| component.function).collect()
}

fn polylines_of(
    arrangement: &Arrangement,
    functions: &[Function],
    evaluate: &Evaluate,
    tolerance: f64,
) -> Vec<Polyline> {
    let mut chains = trace::trace(arrangement, functions, evaluate);
    flatten(&mut chains, evaluate, tolerance);
    let chords = |edge: usize| {
        [0, 1].map(|side| {
            middle(&arrangement.vertices[arrangement.halfedges[2 * edge + side].origin as usize].vertex.area)
        })
    };
    chains
        .iter()
        .enumerate()
        .map(|(edge, chain)| match chain.is_empty() {
            true => Polyline { points: chords(edge).to_vec(), deviation: f64::INFINITY },
            false => polyline(chain),
        })
        .collect()
}

/// Cuts until every stretch is within the tolerance of its chord.
fn flatten(chains: &mut [Chain], evaluate: &Evaluate, tolerance: f64) {
    // Only what was cut in the last round is new, but to ask again is cheap beside the samples.
    refine(chains, evaluate, PIECES, |chains| {
        let places = chains.iter().enumerate().flat_map(|(i, chain)| (0..chain.len()).map(move |k| (i, k)));
        places.filter(|&(i, k)| !chains[i][k].fixed && chains[i][k].deviation() > tolerance).collect()
    });
}

/// The polyline through the ends of stretches.
fn polyline(chain: &Chain) -> Polyline {
    let first = chain.iter().take(1).map(|arc| middle(&arc.ends[0]));
    let points = first.chain(chain.iter().map(|arc| middle(&arc.ends[1]))).collect();
    Polyline { points, deviation: chain.iter().map(arc::Arc::deviation).fold(0.0, f64::max) }
}

fn lengths_of(
    arrangement: &Arrangement,
    functions: &[Function],
    evaluate: &Evaluate,
    precision: &Precision,
) -> Vec<Interval> {
    let mut chains = trace::trace(arrangement, functions, evaluate);
    let bounds = |chain: &Chain| chain.iter().map(arc::Arc::length).fold(Interval::ZERO, |sum, part| sum + part);
    refine(&mut chains, evaluate, precision.pieces, |chains| {
        let mut picked = Vec::new();
        for (index, chain) in chains.iter().enumerate() {
            let parts: Vec<Interval> = chain.iter().map(arc::Arc::length).collect();
            let total = parts.iter().fold(Interval::ZERO, |sum, &part| sum + part);
            if total.width() > precision.relative * total.lo() {
                let share = precision.relative * total.lo() / chain.len() as f64;
                let wide = (0..chain.len()).filter(|&k| !chain[k].fixed && parts[k].width() > share);
                picked.extend(wide.map(|k| (index, k)));
            }
        }
        picked
    });
    let length = |chain: &Chain| match chain.is_empty() {
        true => Interval::ZERO.hull(Interval::ENTIRE).abs(),
        false => bounds(chain),
    };
    chains.iter().map(length).collect()
}

fn areas_of(
    arrangement: &Arrangement,
    functions: &[Function],
    evaluate: &Evaluate,
    precision: &Precision,
) -> Vec<Option<Interval>> {
    let mut chains = trace::trace(arrangement, functions, evaluate);
    let walks = Walks::new(arrangement, &chains);
    refine(&mut chains, evaluate, precision.pieces, |chains| {
        let mut shares = vec![f64::INFINITY; chains.len()];
        for measure in walks.measures(&walks.integrals(chains)).into_iter().flatten() {
            let width = measure.area.width();
            // A face that may be empty is first enclosed better.
            let wanted =
                (precision.relative * measure.area.lo()).max(if measure.area.lo() > 0.0 { 0.0 } else { width / 4.0 });
            if width > wanted {
                let pieces: usize = measure.edges.iter().map(|&(edge, _)| chains[edge].len()).sum();
                for &(edge, _) in measure.edges {
                    shares[edge] = shares[edge].min(wanted / pieces as f64);
                }
            }
        }
        let places = chains.iter().enumerate().flat_map(|(i, chain)| (0..chain.len()).map(move |k| (i, k)));
        // The uncertainty of a stretch is its bulge to both sides.
        let wide = |arc: &arc::Arc, share: f64| !arc.fixed && arc.bulge().is_some_and(|bulge| 2.0 * bulge > share);
        places.filter(|&(i, k)| wide(&chains[i][k], shares[i])).collect()
    });
    let integrals = walks.integrals(&chains);
    walks.measures(&integrals).into_iter().map(|measure| measure.map(|measure| measure.area)).collect()
}
