//! A tiling in which everything fits together: leaves are quartered further until the crossings on their sides can be
//! joined, or stay open.

use crate::arrange::complex::Axis;
use crate::arrange::local::Joint;
use crate::arrange::local::Place;
use crate::arrange::local::join;
use crate::arrange::sides::Crossing;
use crate::arrange::sides::Isolator;
use crate::arrange::sides::Side;
use crate::arrange::sides::sides;
use crate::arrange::subdivide::Leaf;
use crate::arrange::subdivide::Stop;
use crate::arrange::subdivide::Subdivision;
use crate::arrange::subdivide::Work;
use crate::arrange::subdivide::key;
use crate::control::Control;
use crate::interval::Interval;

/// Leaves, the sides between them, what crosses these, and how it is joined in each settled leaf.
pub struct Tiling {
    pub leaves: Vec<Leaf>,
    pub sides: Vec<Side>,
    /// By side; `None` only between open leaves or between one and the outside.
    pub crossings: Vec<Option<Vec<Crossing>>>,
    /// By leaf, with indices into its [`Tiling::places`].
    pub joints: Vec<Vec<Joint>>,
    /// By leaf: its sides counter-clockwise from the lower left corner, each with whether it is walked forwards.
    pub rings: Vec<Vec<(u32, bool)>>,
}

/// The sides of each leaf, counter-clockwise from the lower left corner; `true` where a side is walked from its lower end.
fn rings(leaves: &[Leaf], sides: &[Side]) -> Vec<Vec<(u32, bool)>> {
    // Bottom, right, top, left; each by rising coordinate, as sides are ordered.
    let mut parts: Vec<[Vec<u32>; 4]> = leaves.iter().map(|_| Default::default()).collect();
    for (index, side) in (0..).zip(sides) {
        let [before, behind] = side.leaves;
        let (of_before, of_behind) = match side.axis {
            Axis::X => (2, 0),
            Axis::Y => (1, 3),
        };
        for (leaf, part) in [(before, of_before), (behind, of_behind)] {
            if let Some(leaf) = leaf {
                parts[leaf as usize][part].push(index);
            }
        }
    }
    let ring = |[bottom, right, top, left]: [Vec<u32>; 4]| {
        let rising = bottom.into_iter().chain(right).map(|side| (side, true));
        rising.chain(top.into_iter().rev().chain(left.into_iter().rev()).map(|side| (side, false))).collect()
    };
    parts.into_iter().map(ring).collect()
}

/// The crossings along a walk over sides, as places; with each the side and its position there.
pub fn places<'a>(
    sides: &[Side],
    crossings: &'a [Option<Vec<Crossing>>],
    ring: &[(u32, bool)],
) -> Vec<(Place<'a>, u32, u32)> {
    let mut places = Vec::new();
    for &(index, forward) in ring {
        let side = &sides[index as usize];
        let found = crossings[index as usize].as_deref().unwrap_or_default();
        let place = |position: usize| {
            let Crossing { component, place, curves } = &found[position];
            (Place { component: *component, point: side.area(*place), curves }, index, position as u32)
        };
        match forward {
            true => places.extend((0..found.len()).map(place)),
            false => places.extend((0..found.len()).rev().map(place)),
        }
    }
    places
}

impl Tiling {
    /// Makes one from leaves that cover the domain.
    pub fn new(
        subdivision: &mut Subdivision<'_>,
        isolator: &mut Isolator<'_>,
        mut leaves: Vec<Leaf>,
        control: &Control<'_>,
    ) -> Self {
        loop {
            // An order of their own: a replay meets them in another one.
            leaves.sort_unstable_by_key(|leaf| key(&leaf.area));
            let sides = sides(&leaves);
            let crossings = isolator.crossings(&sides, &leaves);
            let rings = rings(&leaves, &sides);
            let mut joints = Vec::with_capacity(leaves.len());
            let mut failed = Vec::new();
            for (index, leaf) in leaves.iter().enumerate() {
                let isolated = || rings[index].iter().all(|&(side, _)| crossings[side as usize].is_some());
                let joined = match leaf {
                    Leaf { open: true, .. } => Some(Vec::new()),
                    Leaf { active, .. } if active.is_empty() => Some(Vec::new()),
                    _ if !isolated() => None,
                    leaf => {
                        let places: Vec<Place> =
                            places(&sides, &crossings, &rings[index]).into_iter().map(|(place, ..)| place).collect();
                        join(leaf, &places)
                    }
                };
                if joined.is_none() {
                    failed.push(index);
                }
                joints.push(joined.unwrap_or_default());
            }
            if failed.is_empty() {
                return Self { leaves, sides, crossings, joints, rings };
            }
            // Along a curve that is hard to tell from a side the number of leaves would double with each pass.
            let hopeless = failed.len() > subdivision.region;
            for &index in &failed {
                let flat = |&(side, _): &(u32, bool)| isolator.is_flat(&sides[side as usize]);
                let stays = hopeless || rings[index].iter().any(flat);
                leaves[index].open |= stays;
                leaves[index].hopeless |= stays;
            }
            failed.retain(|&index| !leaves[index].open);
            leaves = quarter(subdivision, leaves, &failed, control);
        }
    }

    /// Quarters the given leaves, whatever they claim, and starts over.
    pub fn refined(
        self,
        subdivision: &mut Subdivision<'_>,
        isolator: &mut Isolator<'_>,
        chosen: &[usize],
        control: &Control<'_>,
    ) -> Self {
        let leaves = quarter(subdivision, self.leaves, chosen, control);
        Self::new(subdivision, isolator, leaves, control)
    }

    /// Where the arc goes that enters a settled leaf at a crossing: side and position of its other end. `None` if it is no
    /// arc.
    pub fn follow(&self, leaf: usize, side: u32, position: u32) -> Option<(u32, u32)> {
        let places = self.places(leaf);
        let start = places.iter().position(|&(_, s, p)| (s, p) == (side, position))?;
        let other = self.joints[leaf].iter().find_map(|joint| match joint {
            Joint::Arc { ends: [a, b], .. } if *a == start => Some(*b),
            Joint::Arc { ends: [a, b], .. } if *b == start => Some(*a),
            _ => None,
        })?;
        Some((places[other].1, places[other].2))
    }

    /// The places around a leaf, counter-clockwise; with each its side and its position there.
    pub fn places(&self, leaf: usize) -> Vec<(Place<'_>, u32, u32)> {
        places(&self.sides, &self.crossings, &self.rings[leaf])
    }
}

/// Replaces the chosen leaves by the leaves of their quarters; those that are too small become open.
fn quarter(subdivision: &mut Subdivision<'_>, leaves: Vec<Leaf>, chosen: &[usize], control: &Control<'_>) -> Vec<Leaf> {
    let mut chosen = chosen.iter().copied().peekable();
    let mut kept = Vec::with_capacity(leaves.len());
    let mut works = Vec::new();
    for (index, mut leaf) in leaves.into_iter().enumerate() {
        if chosen.next_if_eq(&index).is_none() {
            kept.push(leaf);
            continue;
        }
        let stays = control.is_cancelled()
            || match &subdivision.stop {
                Stop::Epsilon(epsilon) => leaf.area.iter().all(|side| Interval::width(*side) <= *epsilon),
                Stop::At(leaves) => leaves.contains(&key(&leaf.area)),
            };
        match if stays { None } else { Work::of(&leaf).quarters() } {
            Some(quarters) => works.extend(quarters),
            None => {
                leaf.open = true;
                kept.push(leaf);
            }
        }
    }
    kept.extend(subdivision.run(works, control));
    kept
}
