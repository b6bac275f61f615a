//! Open leaves united: a connected region of them is one cell, with the cycles of its boundary.

use std::collections::BTreeMap;
use std::collections::HashMap;

use crate::arrange::complex::Axis;
use crate::arrange::sides::Side;
use crate::arrange::subdivide::Leaf;
use crate::interval::Interval;

/// A connected region of open leaves.
#[derive(Debug, Clone)]
pub struct Cluster {
    /// Rising.
    pub leaves: Vec<u32>,
    /// Cycles of sides with the region to their left: the outer one first, then those around holes.
    pub boundary: Vec<Vec<(u32, bool)>>,
    /// The smallest box around it.
    pub area: [Interval; 2],
    /// The components that may meet it, rising.
    pub components: Vec<u32>,
}

/// The open leaves of a tiling, united where they touch, if only in a corner.
pub fn clusters(leaves: &[Leaf], sides: &[Side]) -> Vec<Cluster> {
    let mut parent: Vec<u32> = (0..leaves.len() as u32).collect();
    let open = |leaf: u32| leaves[leaf as usize].open;
    for side in sides {
        if let [Some(a), Some(b)] = side.leaves
            && open(a)
            && open(b)
        {
            unite(&mut parent, a, b);
        }
    }
    let mut corners: HashMap<[u64; 2], u32> = HashMap::new();
    for (index, leaf) in (0..).zip(leaves).filter(|(_, leaf)| leaf.open) {
        for x in [leaf.area[0].lo(), leaf.area[0].hi()] {
            for y in [leaf.area[1].lo(), leaf.area[1].hi()] {
                let first = *corners.entry([x.to_bits(), y.to_bits()]).or_insert(index);
                unite(&mut parent, first, index);
            }
        }
    }
    let mut groups: BTreeMap<u32, Cluster> = BTreeMap::new();
    for (index, leaf) in (0..).zip(leaves).filter(|(_, leaf)| leaf.open) {
        let cluster = groups.entry(find(&mut parent, index)).or_insert_with(|| Cluster {
            leaves: Vec::new(),
            boundary: Vec::new(),
            area: leaf.area,
            components: Vec::new(),
        });
        cluster.leaves.push(index);
        cluster.area = [0, 1].map(|axis| cluster.area[axis].hull(leaf.area[axis]));
        cluster.components.extend(leaf.active.iter().map(|active| active.component));
    }
    let mut outlines: HashMap<u32, Vec<(u32, bool)>> = HashMap::new();
    for (index, side) in (0..).zip(sides) {
        let [before, behind] = side.leaves.map(|leaf| leaf.filter(|&leaf| open(leaf)));
        // The region lies to the left of a walk to the right below it, or of one upwards on its right.
        let (leaf, forward) = match (before, behind, side.axis) {
            (Some(_), Some(_), _) | (None, None, _) => continue,
            (Some(leaf), None, Axis::X) => (leaf, false),
            (None, Some(leaf), Axis::X) => (leaf, true),
            (Some(leaf), None, Axis::Y) => (leaf, true),
            (None, Some(leaf), Axis::Y) => (leaf, false),
        };
        outlines.entry(find(&mut parent, leaf)).or_default().push((index, forward));
    }
    for (root, cluster) in &mut groups {
        cluster.components.sort_unstable();
        cluster.components.dedup();
        cluster.boundary = cycles(sides, &outlines[root]);
    }
    groups.into_values().collect()
}

fn find(parent: &mut [u32], mut item: u32) -> u32 {
    while parent[item as usize] != item {
        parent[item as usize] = parent[parent[item as usize] as usize];
        item = parent[item as usize];
    }
    item
}

/// The smaller root wins, so that groups are numbered by their first leaf.
fn unite(parent: &mut [u32], a: u32, b: u32) {
    let (a, b) = (find(parent, a), find(parent, b));
    parent[a.max(b) as usize] = a.min(b);
}

/// Start and end of a walked side.
fn ends(sides: &[Side], (index, forward): (u32, bool)) -> [[f64; 2]; 2] {
    let side = &sides[index as usize];
    let point = |along: f64| match side.axis {
        Axis::X => [along, side.at],
        Axis::Y => [side.at, along],
    };
    if forward { [point(side.from), point(side.to)] } else { [point(side.to), point(side.from)] }
}

/// Chains walked sides to cycles, the outer one first. Where two leaves of the region touch in a corner alone the walk turns
/// right, from one to the other, so that the region stays in one piece.
fn cycles(sides: &[Side], walks: &[(u32, bool)]) -> Vec<Vec<(u32, bool)>> {
    let bits = |point: [f64; 2]| point.map(f64::to_bits);
    let mut leaving: HashMap<[u64; 2], Vec<usize>> = HashMap::new();
    for (index, &walk) in walks.iter().enumerate() {
        leaving.entry(bits(ends(sides, walk)[0])).or_default().push(index);
    }
    let direction = |walk: usize| {
        let [from, to] = ends(sides, walks[walk]);
        [to[0] - from[0], to[1] - from[1]].map(|step| if step == 0.0 { 0.0 } else { step.signum() })
    };
    let mut used = vec![false; walks.len()];
    let mut cycles: Vec<(f64, Vec<(u32, bool)>)> = Vec::new();
    for start in 0..walks.len() {
        if used[start] {
            continue;
        }
        let (mut walk, mut cycle, mut area) = (start, Vec::new(), 0.0);
        let origin = ends(sides, walks[start])[0];
        loop {
            used[walk] = true;
            cycle.push(walks[walk]);
            let [from, to] = ends(sides, walks[walk]);
            // Twice the signed area, relative to a corner: rectilinear, so that only its sign matters here.
            area += (from[0] - origin[0]) * (to[1] - origin[1]) - (to[0] - origin[0]) * (from[1] - origin[1]);
            let [dx, dy] = direction(walk);
            let turn = |next: usize| {
                let [ex, ey] = direction(next);
                dx * ey - dy * ex
            };
            let next = leaving[&bits(to)].iter().copied().filter(|&next| !used[next]);
            match next.min_by(|&a, &b| turn(a).total_cmp(&turn(b))) {
                Some(next) => walk = next,
                None => break,
            }
        }
        cycles.push((area, cycle));
    }
    // The outer cycle is the one that runs counter-clockwise.
    cycles.sort_by(|a, b| b.0.total_cmp(&a.0));
    cycles.into_iter().map(|(_, cycle)| cycle).collect()
}
