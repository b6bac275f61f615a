//! Walks around regions of two curves to tell contacts from crossings by the order of their arms. The source says that the
//! neighbours tell (page 41) and gives no procedure; this is ours.

use std::collections::HashMap;

use crate::arrange::published::Contact;
use crate::arrange::published::Region;
use crate::arrange::published::RegionKind;
use crate::arrange::published::regions::Border;

/// A grid point.
type Corner = (u64, u64);

/// A stretch of a region's boundary with the region to its left.
#[derive(Clone, Copy)]
struct Step {
    from: Corner,
    to: Corner,
    /// The region on the other side.
    beyond: Option<u32>,
}

/// Fills in [`Region::contact`] of every region of two curves. `borders` are those between different regions.
pub(super) fn contacts(regions: &mut [Region], borders: &[Border]) {
    let mut steps: HashMap<u32, Vec<Step>> = HashMap::new();
    for border in borders {
        for upper in [false, true] {
            let Some(region) = border.sides[usize::from(upper)] else { continue };
            if regions[region as usize].kind == RegionKind::Vertex && regions[region as usize].curves.len() == 2 {
                let beyond = border.sides[usize::from(!upper)];
                steps.entry(region).or_default().push(step(border, upper, beyond));
            }
        }
    }
    for (region, steps) in steps {
        let arms = around(&steps).map(|beyond| arms(&beyond, regions));
        regions[region as usize].contact = Some(arms.map_or(Contact::Unclear, |arms| contact(&arms)));
    }
}

/// A border as the region above (or below) it walks it, counter-clockwise.
fn step(border: &Border, upper: bool, beyond: Option<u32>) -> Step {
    let [from, to] = [border.from, border.to].map(|along| match border.axis {
        0 => (border.at, along),
        _ => (along, border.at),
    });
    // The region right of a vertical line walks it downwards; the region above a horizontal one walks it to the right.
    if upper == (border.axis == 0) { Step { from: to, to: from, beyond } } else { Step { from, to, beyond } }
}

/// What lies beyond, in order around the region; `None` unless its boundary is one simple cycle.
fn around(steps: &[Step]) -> Option<Vec<Option<u32>>> {
    let next: HashMap<Corner, Step> = steps.iter().map(|step| (step.from, *step)).collect();
    if next.len() != steps.len() {
        return None;
    }
    let start = steps.first()?.from;
    let mut at = start;
    let mut beyond = Vec::with_capacity(steps.len());
    for _ in steps {
        let step = next.get(&at)?;
        beyond.push(step.beyond);
        at = step.to;
        if at == start {
            break;
        }
    }
    (at == start && beyond.len() == steps.len()).then_some(beyond)
}

/// The curves of the arms in cyclic order: stretches of the same edge region that follow one another are one arm. `None`
/// for what is no edge and no face: another vertex, the frame.
fn arms(beyond: &[Option<u32>], regions: &[Region]) -> Vec<Option<u16>> {
    let mut cycle: Vec<Option<u32>> = beyond.to_vec();
    cycle.dedup();
    if cycle.len() > 1 && cycle.first() == cycle.last() {
        cycle.pop();
    }
    let arm = |region: Option<u32>| {
        let Some(region) = region else { return Some(None) };
        let region = &regions[region as usize];
        match region.kind {
            RegionKind::Face => None,
            RegionKind::Edge => Some(region.curves.first().copied()),
            RegionKind::Indeterminate | RegionKind::Vertex => Some(None),
        }
    };
    cycle.into_iter().filter_map(arm).collect()
}

fn contact(arms: &[Option<u16>]) -> Contact {
    let &[Some(a), Some(b), Some(c), Some(d)] = arms else { return Contact::Unclear };
    if a == c && b == d && a != b {
        Contact::Crossing
    } else if a == b && c == d && a != c || a == d && b == c && a != b {
        Contact::Touching
    } else {
        Contact::Unclear
    }
}
