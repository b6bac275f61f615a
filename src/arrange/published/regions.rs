//! Region labelling and region adjacency: leaves of the same label that share a stretch of side are one region.

use crate::arrange::build::union::Classes;
use crate::arrange::published::Graph;
use crate::arrange::published::Leaves;
use crate::arrange::published::Region;
use crate::arrange::published::RegionKind;
use crate::arrange::published::trace;
use crate::arrange::published::tree::Labels;
use crate::arrange::published::tree::Leaf;
use crate::arrange::published::tree::Mark;
use crate::arrange::published::tree::Square;
use crate::arrange::published::tree::Tree;
use crate::interval::Interval;

/// A leaf's side, in units of the smallest boxes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    /// The coordinate that is fixed along it.
    at: u64,
    from: u64,
    to: u64,
    leaf: u32,
}

/// A stretch of side between two leaves, or between a leaf and the outside.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Border {
    /// 0: fixed x, running along y; 1: fixed y, running along x.
    pub(super) axis: usize,
    pub(super) at: u64,
    pub(super) from: u64,
    pub(super) to: u64,
    /// The leaf (later the region) below `at` and the one above.
    pub(super) sides: [Option<u32>; 2],
}

/// Makes the graph of a tree.
pub(super) fn connect(domain: [Interval; 2], tree: Tree) -> Graph {
    let finest = tree.leaves.iter().map(|leaf| leaf.square.level).max().unwrap_or(0);
    let mut borders = borders(&tree.leaves, finest);

    // Leaves to regions, numbered by their first leaf.
    let mut groups = Classes::new(tree.leaves.len());
    for border in &borders {
        if let [Some(a), Some(b)] = border.sides
            && tree.leaves[a as usize].label == tree.leaves[b as usize].label
        {
            groups.unite(a, b);
        }
    }
    let mut regions: Vec<Region> = Vec::new();
    let mut region_of_root: Vec<Option<u32>> = vec![None; tree.leaves.len()];
    let mut counts = Leaves::default();
    let mut leaves = Vec::with_capacity(tree.leaves.len());
    for (i, &leaf) in (0u32..).zip(&tree.leaves) {
        let id = *region_of_root[groups.find(i) as usize].get_or_insert_with(|| {
            regions.push(new_region(domain, &tree.labels, leaf));
            regions.len() as u32 - 1
        });
        let region = &mut regions[id as usize];
        let area = leaf.square.area(domain);
        region.area = [0, 1].map(|axis| region.area[axis].hull(area[axis]));
        region.leaves += 1;
        match leaf.mark {
            Mark::Empty => counts.empty += 1,
            Mark::Undecided => counts.undecided += 1,
            Mark::Several => counts.several += 1,
            Mark::Crossed => {
                counts.crossed += 1;
                region.kind = RegionKind::Edge;
            }
        }
        leaves.push((leaf, id));
    }

    // What borders on what.
    for border in &mut borders {
        border.sides = border.sides.map(|side| side.map(|leaf| leaves[leaf as usize].1));
    }
    borders.retain(|border| border.sides[0] != border.sides[1]);
    let pair = |border: &Border| match border.sides {
        [Some(a), Some(b)] => Some([a.min(b), a.max(b)]),
        _ => None,
    };
    let mut adjacent: Vec<[u32; 2]> = borders.iter().filter_map(pair).collect();
    adjacent.sort_unstable();
    adjacent.dedup();
    trace::contacts(&mut regions, &borders);

    Graph {
        domain,
        regions,
        adjacent,
        leaves,
        counts,
        nodes: tree.nodes,
        evaluations: tree.evaluations,
        discontinuous: tree.discontinuous,
        terminal: tree.terminal,
        complete: tree.complete,
    }
}

/// A region of no leaf yet, for leaves like this one.
fn new_region(domain: [Interval; 2], labels: &Labels, leaf: Leaf) -> Region {
    let curves = labels.curves(leaf.label).to_vec();
    let kind = match curves.len() {
        0 => RegionKind::Face,
        1 => RegionKind::Indeterminate,
        _ => RegionKind::Vertex,
    };
    Region { kind, curves, area: leaf.square.area(domain), leaves: 0, contact: None }
}

/// All stretches between leaves: along each axis the upper sides of leaves and the lower ones, both sorted, are walked
/// side by side.
fn borders(leaves: &[Leaf], finest: u32) -> Vec<Border> {
    let end = 1u64 << finest;
    let mut borders = Vec::new();
    for axis in 0..2 {
        let side = |leaf: u32, square: Square, upper: bool| {
            let scale = |i: u64| i << (finest - square.level);
            let (across, along) = if axis == 0 { (square.x, square.y) } else { (square.y, square.x) };
            Side { at: scale(across + u64::from(upper)), from: scale(along), to: scale(along + 1), leaf }
        };
        let all = |upper: bool| {
            let mut sides: Vec<Side> = (0u32..).zip(leaves).map(|(i, leaf)| side(i, leaf.square, upper)).collect();
            sides.sort_unstable();
            sides
        };
        let frame = |upper: bool| {
            move |side: &Side| Border {
                axis,
                at: side.at,
                from: side.from,
                to: side.to,
                sides: if upper { [Some(side.leaf), None] } else { [None, Some(side.leaf)] },
            }
        };
        // Upper sides belong to the leaves below a line, lower sides to those above it.
        let (below, above) = (all(true), all(false));
        borders.extend(below.iter().filter(|side| side.at == end).map(frame(true)));
        borders.extend(above.iter().filter(|side| side.at == 0).map(frame(false)));
        let mut above = above.iter().skip_while(|side| side.at == 0).copied().peekable();
        for low in below.iter().filter(|side| side.at != end) {
            while let Some(high) = above.peek().copied()
                && (high.at, high.from) < (low.at, low.to)
            {
                let (from, to) = (low.from.max(high.from), low.to.min(high.to));
                borders.push(Border { axis, at: low.at, from, to, sides: [Some(low.leaf), Some(high.leaf)] });
                if high.to > low.to {
                    break;
                }
                above.next();
            }
        }
    }
    borders
}
