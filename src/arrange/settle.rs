//! What exact arithmetic makes of the clusters of polynomial curves.
//!
//! A star is proved for a box that contains the cluster. Each of its arms leaves the cluster at least once, so if the
//! cluster's boundary carries as many nodes of each component as the star has arms of it, each arm leaves once and nothing
//! else passes: the cluster is a star too.

use crate::arrange::assemble::Outcome;
use crate::arrange::assemble::users;
use crate::arrange::cluster::Cluster;
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
    let ready = cluster.boundary.len() == 1 && !touches_frame && unconditional(fields, cluster);
    let Some(polynomials) = known.filter(|_| ready) else {
        return Settled::Open;
    };
    let count = |position: usize| nodes.iter().filter(|&&node| node == cluster.components[position]).count();
    let finding = fields.algebra.settle(&polynomials, cluster.area);
    if std::env::var("DBG").is_ok() { eprintln!("{:?} nodes {} leaves {} -> {:?}", cluster.area, nodes.len(), cluster.leaves.len(), finding); }
    match finding {
        Finding::Nothing(_) if nodes.is_empty() => Settled::Done(Outcome::Regular),
        Finding::Star(star) => {
            let fits = (0..polynomials.len()).all(|position| count(position) == star.branches[position].arms as usize);
            if fits {
                return Settled::Done(outcome(fields, cluster, &star));
            }
            let around = absorbed(tiling, cluster, star.within);
            if around.is_empty() { Settled::Refine } else { Settled::Absorb(around) }
        }
        Finding::Arcs(arcs) if nodes.len() == 2 && arcs.counts.iter().sum::<u32>() == 1 => {
            Settled::Done(Outcome::Regular)
        }
        Finding::Arcs(_) | Finding::Several(_) | Finding::Nothing(_) => Settled::Refine,
        Finding::Unknown(_) => Settled::Open,
    }
}

/// The settled leaves over the smallest box around a cluster, as far as they lie in a box of which everything is known.
fn absorbed(tiling: &Tiling, cluster: &Cluster, within: [Interval; 2]) -> Vec<usize> {
    let over = |area: [Interval; 2]| {
        (0..2).all(|axis| {
            let (own, hull) = (area[axis], cluster.area[axis]);
            own.lo() < hull.hi() && own.hi() > hull.lo() && own.subset(within[axis])
        })
    };
    (0..tiling.leaves.len()).filter(|&leaf| !tiling.leaves[leaf].open && over(tiling.leaves[leaf].area)).collect()
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
    let mut curves: Vec<u16> =
        through().flat_map(|(position, _)| users(fields, cluster.components[position])).collect();
    curves.sort_unstable();
    curves.dedup();
    let singular = through().any(|(_, branch)| branch.singular);
    let crosses = star.contacts.iter().any(|&(_, _, contact)| contact != Contact::Touching);
    let kind = match () {
        () if curves.len() == 1 || singular => VertexKind::Singular,
        () if crosses => VertexKind::Crossing,
        () => VertexKind::Tangency,
    };
    // The point lies in the cluster: outside, everything is settled.
    let area = [0, 1].map(|axis| star.point[axis].intersect(cluster.area[axis]));
    let area = if area.iter().any(|side: &Interval| side.is_empty()) { cluster.area } else { area };
    Outcome::Vertex { kind, area, proved: true, note: None }
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
    Outcome::Vertex { kind: VertexKind::Cluster, area: cluster.area, proved: false, note }
}
