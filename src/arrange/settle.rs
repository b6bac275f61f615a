//! What exact arithmetic makes of the clusters of polynomial curves.
//!
//! A star is proved for a box that contains the cluster. Each of its arms leaves the cluster at least once, so if the
//! cluster's boundary carries as many nodes of each component as the star has arms of it, each arm leaves once and nothing
//! else passes: the cluster is a star too.

use std::collections::HashMap;
use std::collections::HashSet;

use crate::arrange::assemble::Outcome;
use crate::arrange::assemble::users;
use crate::arrange::cluster::Cluster;
use crate::arrange::complex::Vertex;
use crate::arrange::complex::VertexKind;
use crate::arrange::exact::Contact;
use crate::arrange::exact::Finding;
use crate::arrange::exact::Star;
use crate::arrange::field::Fields;
use crate::arrange::subdivide::truth;
use crate::arrange::tiling::Tiling;
use crate::arrange::tiling::places;
use crate::interval::Interval;

/// What became of a cluster.
pub enum Settled {
    Done(Outcome),
    /// Smaller boxes may tell more: several points are in question.
    Refine,
    /// One point is proved, but arms leave the cluster and come back: with these leaves it takes in their turns.
    Absorb(Vec<usize>),
    /// It has nothing to say.
    Open,
}

/// Settles a cluster, if it can be.
pub fn settle(fields: &Fields, tiling: &Tiling, cluster: &Cluster) -> Settled {
    let nodes: Vec<u32> = cluster
        .boundary
        .iter()
        .flat_map(|ring| places(&tiling.sides, &tiling.crossings, ring))
        .map(|(place, ..)| place.component)
        .collect();
    let known: Option<Vec<usize>> =
        cluster.components.iter().map(|&component| fields.polynomials[component as usize]).collect();
    let touches_frame = cluster.boundary.iter().flatten().any(|&(side, _)| tiling.sides[side as usize].is_frame());
    let ready = !touches_frame && unconditional(fields, cluster);
    let Some(polynomials) = known.filter(|_| ready) else {
        return Settled::Open;
    };
    let count = |position: usize| nodes.iter().filter(|&&node| node == cluster.components[position]).count();
    let finding = fields.algebra.settle(&polynomials, cluster.area);
    if cluster.boundary.len() > 1 {
        // What lies in a hole lies in the box of which everything is known.
        return match finding {
            Finding::Several(_) | Finding::Unknown(_) => Settled::Refine,
            Finding::Star(_) | Finding::Arcs(_) | Finding::Nothing(_) => Settled::Absorb(holes(tiling, cluster)),
        };
    }
    match finding {
        Finding::Nothing(_) if nodes.is_empty() => Settled::Done(Outcome::Regular),
        Finding::Arcs(_) if passes(&nodes) => Settled::Done(Outcome::Regular),
        Finding::Star(star) => {
            let overlaps = |area: [Interval; 2]| (0..2).all(|axis| !area[axis].intersect(star.point[axis]).is_empty());
            let near = (0..).zip(&tiling.leaves).filter(|(_, leaf)| overlaps(leaf.area)).map(|(leaf, _)| leaf);
            let (own, other): (Vec<u32>, Vec<u32>) = near.partition(|leaf| cluster.leaves.binary_search(leaf).is_ok());
            if own.is_empty() && passes(&nodes) {
                return Settled::Done(Outcome::Regular);
            }
            // The point may lie in a settled leaf beside the cluster.
            if own.is_empty() || !other.is_empty() {
                return Settled::Refine;
            }
            let fits = (0..polynomials.len()).all(|position| count(position) == star.branches[position].arms as usize);
            if fits {
                return Settled::Done(outcome(fields, cluster, &star));
            }
            let turns = detours(tiling, cluster, star.within);
            if turns.is_empty() { Settled::Refine } else { Settled::Absorb(turns) }
        }
        Finding::Arcs(_) | Finding::Several(_) | Finding::Nothing(_) => Settled::Refine,
        Finding::Unknown(_) => Settled::Open,
    }
}

/// Whether a cluster without a vertex in it holds nothing, or a stretch of one arc: where every arc runs from side to side of
/// a box around it, what enters the cluster leaves it again, and nothing in it is closed.
fn passes(nodes: &[u32]) -> bool {
    nodes.is_empty() || matches!(nodes, [one, other] if one == other)
}

/// The settled leaves through which curves leave a cluster and come back to it, inside a box of which everything is known.
fn detours(tiling: &Tiling, cluster: &Cluster, within: [Interval; 2]) -> Vec<usize> {
    let owns = |leaf: u32| cluster.leaves.binary_search(&leaf).is_ok();
    let mut found = Vec::new();
    for &(side, _) in cluster.boundary.iter().flatten() {
        for position in 0..tiling.crossings[side as usize].as_ref().map_or(0, Vec::len) as u32 {
            let mut path = Vec::new();
            let (mut side, mut position) = (side, position);
            let mut from = tiling.sides[side as usize].leaves.into_iter().flatten().find(|&leaf| owns(leaf));
            let returned = loop {
                let next = tiling.sides[side as usize].leaves.into_iter().flatten().find(|&leaf| Some(leaf) != from);
                let Some(leaf) = next else { break false };
                if owns(leaf) {
                    break true;
                }
                let inside = (0..2).all(|axis| tiling.leaves[leaf as usize].area[axis].subset(within[axis]));
                let Some(onward) = tiling.follow(leaf as usize, side, position).filter(|_| inside) else { break false };
                path.push(leaf as usize);
                (from, side, position) = (Some(leaf), onward.0, onward.1);
            };
            if returned {
                found.extend(path);
            }
        }
    }
    found.sort_unstable();
    found.dedup();
    found
}

/// The leaves in the holes of a cluster.
fn holes(tiling: &Tiling, cluster: &Cluster) -> Vec<usize> {
    let mut neighbours: HashMap<u32, Vec<u32>> = HashMap::new();
    for side in &tiling.sides {
        if let [Some(a), Some(b)] = side.leaves {
            neighbours.entry(a).or_default().push(b);
            neighbours.entry(b).or_default().push(a);
        }
    }
    let mut seen: HashSet<u32> = cluster.leaves.iter().copied().collect();
    let mut found = Vec::new();
    let rims = cluster.boundary[1..].iter().flatten();
    let mut stack: Vec<u32> = rims.flat_map(|&(side, _)| tiling.sides[side as usize].leaves).flatten().collect();
    while let Some(leaf) = stack.pop() {
        if seen.insert(leaf) {
            found.push(leaf as usize);
            stack.extend(&neighbours[&leaf]);
        }
    }
    found
}

/// Whether every use of the cluster's components holds on all of it.
fn unconditional(fields: &Fields, cluster: &Cluster) -> bool {
    let uses = cluster.components.iter().flat_map(|&component| &fields.components[component as usize].uses);
    let queries: Vec<_> = uses.filter_map(|used| Some((used.condition?, cluster.area))).collect();
    fields.evaluate(&queries).iter().all(|sample| truth(sample) == Some(true))
}

/// The vertex, or the arc, that a star is.
fn outcome(fields: &Fields, cluster: &Cluster, star: &Star) -> Outcome {
    if star.regular {
        return Outcome::Regular;
    }
    let through = || star.branches.iter().enumerate().filter(|(_, branch)| branch.through);
    // By component, so that a curve of two components here, which crosses or touches itself, is listed twice.
    let mut curves: Vec<u16> = through().flat_map(|(p, _)| users(fields, cluster.components[p])).collect();
    curves.sort_unstable();
    let listed = curves.len();
    curves.dedup();
    let singular = curves.len() < listed || through().any(|(_, branch)| branch.singular);
    let crosses = star.contacts.iter().any(|&(_, _, contact)| contact != Contact::Touching);
    let kind = match () {
        () if singular => VertexKind::Singular,
        () if crosses => VertexKind::Crossing,
        () => VertexKind::Tangency,
    };
    Outcome::Vertex(Vertex { kind, area: star.point, proved: true, curves, note: None })
}

/// A cluster of which nothing more is known.
pub fn unresolved(fields: &Fields, tiling: &Tiling, cluster: &Cluster) -> Outcome {
    let sides = || cluster.boundary.iter().flatten();
    let frame = sides().any(|&(side, _)| tiling.sides[side as usize].is_frame());
    let arms: usize = sides().map(|&(side, _)| tiling.crossings[side as usize].as_ref().map_or(0, Vec::len)).sum();
    let mut curves: Vec<u16> = cluster.components.iter().flat_map(|&component| users(fields, component)).collect();
    curves.sort_unstable();
    curves.dedup();
    let names: Vec<&str> = curves.iter().map(|&curve| fields.curves[usize::from(curve)].as_str()).collect();
    let what = match (frame, arms, curves.len()) {
        (true, ..) => "at the boundary of the domain, where it is open how the curves meet it",
        (_, 0, _) => "an isolated point, a small closed curve, or nothing",
        (_, _, 1) => "a singular point, or parts of the curve that come this close",
        _ => "a point where curves meet, or curves that come this close",
    };
    let note = Some(format!("{what}: {} with {arms} branches", names.join(", ")));
    Outcome::Vertex(Vertex { kind: VertexKind::Cluster, area: cluster.area, proved: false, curves, note })
}
