//! How nodes are joined within a settled leaf.
//!
//! A component that is a function of one coordinate in the leaf meets its boundary in simple roots, and along that coordinate
//! it enters and leaves in turn: its nodes, sorted, pair up into arcs. Two arcs whose ends alternate on the boundary cross
//! (Jordan), an odd number of times; the leaf's claims allow at most one.

use crate::arrange::complex::Axis;
use crate::arrange::subdivide::Leaf;
use crate::interval::Interval;

/// A crossing of a component with the boundary of a leaf, in counter-clockwise order.
#[derive(Debug, Clone)]
pub struct Place<'a> {
    pub component: u32,
    pub point: [Interval; 2],
    pub curves: &'a [u16],
}

/// What joins places of a leaf; indices are into the places.
#[derive(Debug, Clone, PartialEq)]
pub enum Joint {
    /// From one place to another.
    Arc { ends: [usize; 2], axis: Axis },
    /// Two arcs that cross: of components `active[of[0]]`, `active[of[1]]`, with four arms in cyclic order.
    Cross { arms: [usize; 4], of: [u8; 2] },
    /// An arc along which the curves change, from the places that still carry some.
    End { arms: Vec<usize>, of: u8 },
}

/// The joints of a settled leaf; `None` if its places contradict its claims, or there are several crossings.
pub fn join(leaf: &Leaf, places: &[Place<'_>]) -> Option<Vec<Joint>> {
    let mut arcs: Vec<([usize; 2], u8)> = Vec::new();
    for (index, active) in leaf.active.iter().enumerate() {
        let along = active.axis? as usize;
        let mut own: Vec<usize> = (0..places.len()).filter(|&p| places[p].component == active.component).collect();
        own.sort_by(|&a, &b| places[a].point[along].lo().total_cmp(&places[b].point[along].lo()));
        let apart = own.windows(2).all(|w| places[w[0]].point[along].hi() < places[w[1]].point[along].lo());
        if !own.len().is_multiple_of(2) || !apart {
            return None;
        }
        arcs.extend(own.chunks(2).map(|ends| ([ends[0].min(ends[1]), ends[0].max(ends[1])], index as u8)));
    }
    let mut joints = Vec::new();
    let mut crossed = vec![false; arcs.len()];
    for second in 1..arcs.len() {
        for first in 0..second {
            let ([a, b], i) = arcs[first];
            let ([c, d], j) = arcs[second];
            if !((a < c && c < b && b < d) || (c < a && a < d && d < b)) {
                continue;
            }
            // Where arcs cross all conditions are decided, so that an arc has the same curves at both ends. Without any it is
            // no part of the picture.
            let dropped = places[a].curves.is_empty() || places[c].curves.is_empty();
            let allowed = i != j && leaf.crossing.contains(&(i.min(j), i.max(j)));
            if !allowed || !dropped && !joints.is_empty() {
                return None;
            }
            if dropped {
                continue;
            }
            let mut arms = [a, b, c, d];
            arms.sort_unstable();
            (crossed[first], crossed[second]) = (true, true);
            joints.push(Joint::Cross { arms, of: [i, j] });
        }
    }
    for (&(ends, index), _) in arcs.iter().zip(&crossed).filter(|&(_, &crossed)| !crossed) {
        let active = &leaf.active[usize::from(index)];
        let [one, other] = ends.map(|end| places[end].curves);
        if one != other {
            let arms = ends.into_iter().filter(|&end| !places[end].curves.is_empty()).collect();
            joints.push(Joint::End { arms, of: index });
        } else if active.atom.is_some() {
            // The same at both ends, but where the atom vanishes a point may be missing, or there alone.
            return None;
        } else if !one.is_empty() {
            joints.push(Joint::Arc { ends, axis: active.axis? });
        }
    }
    Some(joints)
}
