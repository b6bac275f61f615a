//! What exact arithmetic can say of curves near a point.

use crate::interval::Interval;

/// What is proved of the union of zero sets in a box that contains the area asked for.
#[derive(Debug, Clone, PartialEq)]
pub enum Finding {
    /// One point with arms, each from the point to the boundary of the box, and nothing else.
    Star(Star),
    /// Arcs that neither meet nor turn, each a function of one coordinate from one side of the box to the opposite one.
    Arcs(Arcs),
    /// No zeros in the box.
    Nothing([Interval; 2]),
    /// More than one point is in question, or may be: nothing is proved.
    Several(&'static str),
    /// Nothing is proved.
    Unknown(&'static str),
}

/// Arcs through a box.
#[derive(Debug, Clone, PartialEq)]
pub struct Arcs {
    /// The box.
    pub within: [Interval; 2],
    /// The number of arcs, by polynomial as asked.
    pub counts: Vec<u32>,
}

/// A point where curves meet, or one curve with itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Star {
    /// The box of which this is said.
    pub within: [Interval; 2],
    /// Encloses the point.
    pub point: [Interval; 2],
    /// The polynomials asked, in their order.
    pub branches: Vec<Branch>,
    /// The polynomials (by position in the question) whose arms meet the boundary of the box, in counter-clockwise order;
    /// one entry for each arm, the first one anywhere.
    pub around: Vec<usize>,
    /// How two polynomials that are both regular in the point meet there, by positions in the question.
    pub contacts: Vec<(usize, usize, Contact)>,
    /// Only one curve passes, and it is regular in the point: nothing but an arc.
    pub regular: bool,
}

/// One polynomial at the point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Branch {
    /// Whether its zero set contains the point. A polynomial that does not has no zeros in the box.
    pub through: bool,
    /// Arms from the point to the boundary of the box; none where the point is isolated.
    pub arms: u32,
    /// Whether both of its derivatives vanish in the point.
    pub singular: bool,
}

/// How two regular curves meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Contact {
    /// They cross with different tangents.
    Transversal,
    /// They cross with a common tangent.
    Crossing,
    /// They touch.
    Touching,
}
