//! CAPS as its source has it (Hijazi, "Feature based visualization", 2007, section 4.5; Hijazi and Breuel, "Computing
//! arrangements using subdivision and interval arithmetic", 2006), for comparison: a quadtree whose leaves are labelled
//! with the curves that could not be excluded, and the graph of its regions.
//!
//! From the source: boxes are quartered at their middle until at most one curve is left or they are as small as epsilon; a
//! single curve is proved to cross by a strictly positive and a strictly negative part; leaves of the same label are
//! merged where they share a side; a region of one curve is an edge, one of several a vertex, one of none is left out.
//!
//! Ours: a change of sign counts only inside a part where the function is proved continuous, since a pole changes sign
//! without a zero; the source does not say how small the parts of that proof may get, here they are at most
//! `proof::LEVELS` quarterings below the box and at most `proof::OPEN` undecided ones at a time; the regions of no curve
//! are given, as the faces; regions of one curve in which no crossing is proved are kept apart; a bound on the
//! tree's size. Conditions of curves are not looked at: the source has none.
//!
//! What the graph is worth is the source's own claim, which it does not prove: see [`Graph::delta`] and [`Graph::exact`].

mod proof;
mod regions;
mod trace;
mod tree;

#[cfg(test)]
mod tests;

use crate::arrange::field::Fields;
use crate::arrange::field::Function;
use crate::arrange::field::Sample;
use crate::control::Control;
use crate::interval::Interval;

pub use crate::arrange::published::tree::Leaf;
pub use crate::arrange::published::tree::Mark;
pub use crate::arrange::published::tree::Square;

/// Evaluates functions on boxes, in the order asked.
type Evaluate<'a> = dyn Fn(&[(Function, [Interval; 2])]) -> Vec<Sample> + 'a;

/// When subdivision ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// A box whose longer side is at most this is not split.
    pub epsilon: f64,
    /// Nor one this deep, the domain being at depth 0; at most [`Limits::DEEPEST`].
    pub depth: u32,
    /// Nodes of the tree. A level that would make it larger is not begun: its boxes stay as they are.
    pub nodes: u64,
}

impl Limits {
    /// Parts of a box in proofs may lie `proof::LEVELS` deeper, where the number format has hardly any places left.
    pub const DEEPEST: u32 = 40;
}

/// The source's choice in its table 4.1, with room for four million nodes.
impl Default for Limits {
    fn default() -> Self {
        Self { epsilon: 1e-6, depth: Limits::DEEPEST, nodes: 1 << 22 }
    }
}

/// What a region stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum RegionKind {
    /// No curve. A face of the arrangement shows as several of these or as none: leaves that a curve crosses are not split
    /// further and may take up all of it, or cut it into parts.
    Face,
    /// One curve, which is proved to cross some box of the region.
    Edge,
    /// One curve, which is nowhere proved to cross. The source merges these with its edges.
    Indeterminate,
    /// Several curves.
    Vertex,
}

/// Leaves with the same curves, connected through sides.
#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    pub kind: RegionKind,
    /// Curves that could not be excluded (indices of the scene's shapes), rising.
    pub curves: Vec<u16>,
    /// The smallest box around the region.
    pub area: [Interval; 2],
    pub leaves: u64,
    /// For a region of two curves, how their arms follow one another around it.
    pub contact: Option<Contact>,
}

/// What the neighbours of a region of two curves say.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Contact {
    /// Four arms that alternate: an odd number of crossings, one if there is no more than one.
    Crossing,
    /// Two arms of one curve, then two of the other: a contact or an even number of crossings.
    Touching,
    /// Anything else: other numbers of arms, a hole, a region that meets the frame or itself in a corner.
    Unclear,
}

/// Leaves of the quadtree by label.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Leaves {
    /// Proved to have no curve.
    pub empty: u64,
    /// One curve, proved to cross.
    pub crossed: u64,
    /// One curve, with no proof either way.
    pub undecided: u64,
    /// Several curves, at the limit.
    pub several: u64,
}

/// The labelled quadtree and the adjacency graph of its regions.
#[derive(Debug, Clone, PartialEq)]
pub struct Graph {
    pub domain: [Interval; 2],
    pub regions: Vec<Region>,
    /// Pairs of regions that share a stretch of side, each once, rising.
    pub adjacent: Vec<[u32; 2]>,
    /// The tree's leaves with their regions.
    pub leaves: Vec<(Leaf, u32)>,
    pub counts: Leaves,
    /// Nodes of the tree, inner ones included; parts of boxes that only proofs looked at are not.
    pub nodes: u64,
    /// Functions evaluated on boxes, for labels and for proofs.
    pub evaluations: u64,
    /// Leaves where the function takes both signs and no continuity is proved between: the source's test alone would
    /// have called them crossed.
    pub discontinuous: u64,
    /// The longer side of the boxes at which subdivision ended.
    pub terminal: f64,
    /// Whether it ended at the epsilon or depth asked for, not earlier for the tree's size or a cancellation.
    pub complete: bool,
}

impl Graph {
    /// Regions of a kind.
    pub fn count(&self, kind: RegionKind) -> usize {
        self.regions.iter().filter(|region| region.kind == kind).count()
    }

    /// The source's weak solution (page 41, stated without proof): the graph is the arrangement graph of curves that
    /// come from these by a continuous distortion of at most this at each point. Boxes end at half of it.
    pub fn delta(&self) -> f64 {
        2.0 * self.terminal
    }

    /// Whether the source's claim of exactness applies (page 41) as far as a graph shows: no region has more than two
    /// curves, and where there are two, they cross and do not touch. That curves do not cross themselves, and cross one
    /// another at most once in a region, is the other half of the premise and the caller's to know. That every other leaf
    /// is decided is our condition.
    pub fn exact(&self) -> bool {
        let crosses = |region: &Region| region.contact == Some(Contact::Crossing);
        let mut vertices = self.regions.iter().filter(|region| region.kind == RegionKind::Vertex);
        self.complete && self.counts.undecided == 0 && vertices.all(crosses)
    }
}

/// Runs the algorithm on the fields of the scene's shapes. The result does not depend on threads or machine, unless
/// `control` cancels: then boxes stay as large as they are.
pub fn solve(fields: &Fields, limits: &Limits, control: &Control) -> Graph {
    solve_with(fields.domain, &fields.shapes, limits, control, &|queries| fields.evaluate(queries))
}

/// As [`solve`], for functions that someone else evaluates.
fn solve_with(
    domain: [Interval; 2],
    shapes: &[Function],
    limits: &Limits,
    control: &Control,
    evaluate: &Evaluate,
) -> Graph {
    let tree = tree::grow(domain, shapes, limits, control, evaluate);
    regions::connect(domain, tree)
}
