//! Cutting stretches of curves: interval Newton on fibres, many stretches per round.

use crate::arrange::field::Function;
use crate::arrange::field::Sample;
use crate::arrange::geometry::arc::Arc;
use crate::arrange::geometry::arc::Body;
use crate::arrange::geometry::arc::Rect;
use crate::arrange::geometry::arc::slopes;
use crate::interval::Interval;

/// Samples functions on boxes: [`crate::arrange::field::Fields::evaluate`].
pub type Evaluate<'a> = dyn Fn(&[(Function, Rect)]) -> Vec<Sample> + 'a;

/// The stretches of an edge from its origin to its end, each starting where the one before ends.
pub type Chain = Vec<Arc>;

/// Rounds of cutting; each of them at most doubles the number of stretches.
const ROUNDS: usize = 40;
/// Steps of Newton's method: once it converges it doubles the digits, before that it may have to halve a few times.
const STEPS: usize = 24;

/// Cuts the stretches that `wanted` names (by chain, then by place, rising) until it names none, or only such that cannot
/// be cut, or `limit` stretches are reached.
pub fn refine(
    chains: &mut [Chain],
    evaluate: &Evaluate,
    limit: usize,
    mut wanted: impl FnMut(&[Chain]) -> Vec<(usize, usize)>,
) {
    for _ in 0..ROUNDS {
        let mut picked = wanted(chains);
        picked.retain(|&(chain, place)| !chains[chain][place].fixed);
        let room = limit.saturating_sub(chains.iter().map(Vec::len).sum());
        picked.truncate(room);
        if picked.is_empty() {
            return;
        }
        cut(chains, &picked, evaluate);
    }
}

/// Cuts stretches in two, or marks them as fixed.
fn cut(chains: &mut [Chain], picked: &[(usize, usize)], evaluate: &Evaluate) {
    let arcs: Vec<&Arc> = picked.iter().map(|&(chain, place)| &chains[chain][place]).collect();
    let points = cuts(&arcs, evaluate);
    let mut halves: Vec<Arc> = Vec::with_capacity(2 * picked.len());
    for (arc, point) in arcs.iter().zip(&points) {
        if let Some(point) = *point {
            for ends in [[arc.ends[0], point], [point, arc.ends[1]]] {
                halves.push(Arc { ends, ..(*arc).clone() });
            }
        }
    }
    halves.iter_mut().for_each(narrow);
    enclose(&mut halves, evaluate);
    let mut halves = halves.into_iter();
    let mut next = picked.iter().zip(points).peekable();
    for (index, chain) in chains.iter_mut().enumerate() {
        if next.peek().is_none_or(|(at, _)| at.0 != index) {
            continue;
        }
        let mut longer = Vec::with_capacity(chain.len() + 1);
        for (place, mut arc) in std::mem::take(chain).into_iter().enumerate() {
            match next.next_if(|(at, _)| **at == (index, place)) {
                Some((_, Some(_))) => longer.extend(halves.by_ref().take(2)),
                Some((_, None)) => {
                    arc.fixed = true;
                    longer.push(arc);
                }
                None => longer.push(arc),
            }
        }
        *chain = longer;
    }
}

/// A point of the curve in the middle of each stretch; `None` where it cannot be enclosed better than the stretch.
fn cuts(arcs: &[&Arc], evaluate: &Evaluate) -> Vec<Option<Rect>> {
    let mut points: Vec<Option<Rect>> = arcs.iter().map(|arc| guess(arc)).collect();
    let mut open: Vec<usize> = (0..arcs.len()).filter(|&i| points[i].is_some()).collect();
    for step in 0..STEPS {
        if open.is_empty() {
            break;
        }
        let mut queries = Vec::with_capacity(2 * open.len());
        for &i in &open {
            let (Body::Graph { axis, .. }, Some(fibre)) = (&arcs[i].body, points[i]) else { continue };
            let mut centre = fibre;
            centre[1 - axis] = Interval::point(fibre[1 - axis].mid());
            queries.extend([(arcs[i].function, centre), (arcs[i].function, fibre)]);
        }
        let samples = evaluate(&queries);
        let mut still = Vec::new();
        for (&i, pair) in open.iter().zip(samples.chunks_exact(2)) {
            let (Body::Graph { axis, .. }, Some(mut fibre)) = (&arcs[i].body, points[i]) else { continue };
            // The curve has a point on this fibre, and f is monotone along it if the derivative has no zero.
            if slopes(&pair[1])[*axis].is_none() {
                // What was proved on the whole stretch still encloses the point, if not well.
                points[i] = points[i].filter(|_| step > 0);
                continue;
            }
            let across = fibre[1 - axis];
            let newton = Interval::point(across.mid()) - pair[0].value / pair[1].slope[1 - axis];
            let better = newton.intersect(across);
            if better.is_empty() {
                points[i] = None;
                continue;
            }
            fibre[1 - axis] = better;
            points[i] = Some(fibre);
            if better.width() < 0.75 * across.width() {
                still.push(i);
            }
        }
        open = still;
    }
    points
}

/// The fibre in the middle of a stretch, with what its slope says of the point there.
fn guess(arc: &Arc) -> Option<Rect> {
    let Body::Graph { axis, reach, .. } = arc.body else { return None };
    let [from, to] = arc.ends.map(|end| end[axis]);
    let (first, last) = if from.hi() < to.lo() { (from.hi(), to.lo()) } else { (to.hi(), from.lo()) };
    let gap = Interval::new(first, last)?;
    let middle = gap.mid();
    if !(first < middle && middle < last) {
        return None;
    }
    let at = Interval::point(middle);
    let across = reach.intersect(from_ends(arc, at));
    let mut fibre = [at; 2];
    fibre[1 - axis] = across;
    (!across.is_empty()).then_some(fibre)
}

/// What the slope of a graph says of the other coordinate at `t`, seen from both ends.
fn from_ends(arc: &Arc, t: Interval) -> Interval {
    let Body::Graph { axis, slope, .. } = arc.body else { return Interval::ENTIRE };
    let [a, b] = arc.ends.map(|end| end[1 - axis] + slope * (t - end[axis]));
    a.intersect(b)
}

/// Shrinks the reach of a graph to what its slope allows.
fn narrow(arc: &mut Arc) {
    let Body::Graph { axis, reach, .. } = arc.body else { return };
    let [from, to] = arc.ends.map(|end| end[axis]);
    let tight = from_ends(arc, from.hull(to)).intersect(reach);
    if !tight.is_empty()
        && let Body::Graph { reach, .. } = &mut arc.body
    {
        *reach = tight;
    }
}

/// Samples the gradient on the boxes of graphs for tighter slopes; a steep graph is taken over the other coordinate where
/// that is proved possible.
pub fn enclose(arcs: &mut [Arc], evaluate: &Evaluate) {
    let queries: Vec<_> = arcs.iter().map(|arc| (arc.function, arc.extent())).collect();
    for ((arc, sample), (_, extent)) in arcs.iter_mut().zip(evaluate(&queries)).zip(queries) {
        let Body::Graph { axis, reach, slope } = arc.body else { continue };
        let found = slopes(&sample);
        let tight = found[axis].map_or(slope, |new| new.intersect(slope));
        let slope = if tight.is_empty() { slope } else { tight };
        arc.body = match found[1 - axis] {
            // The stretch is connected and meets each fibre of its box at most once: its ends bound the new parameter.
            Some(other) if slope.mag() > 1.0 && other.mag() < slope.mag() => {
                Body::Graph { axis: 1 - axis, reach: extent[axis], slope: other }
            }
            _ => Body::Graph { axis, reach, slope },
        };
        narrow(arc);
    }
}
