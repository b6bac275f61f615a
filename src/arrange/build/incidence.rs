//! Who meets whom in a complex: the cells on both sides of each segment, the block of each node on both sides, the gaps; and
//! whether the complex keeps its invariants.
//!
//! Side 0 of a segment is the cell that walks it from `from` to `to`, side 1 the one that walks it back; either has the segment
//! with itself to the left. Side 0 of a node is that of its segment.

use crate::arrange::build::union::Classes;
use crate::arrange::check::Fault;
use crate::arrange::check::ensure;
use crate::arrange::complex::Block;
use crate::arrange::complex::Cell;
use crate::arrange::complex::Complex;
use crate::arrange::structure::FaceId;

/// A node as a cell sees it: the node, and the side on which the cell is.
pub type Arm = (u32, usize);

/// Whether all of a cell's boundary cycles border on the same face within it, unless arms part it: if it has just one, or if
/// nothing but possibly an isolated point is proved to be in it.
pub fn surrounds(cell: &Cell) -> bool {
    let empty = |block: &Block| block.nodes.is_empty() && block.vertex.as_ref().is_some_and(|vertex| vertex.proved);
    cell.boundary.len() == 1 || cell.blocks.iter().all(empty)
}

/// The tables.
pub struct Incidence<'a> {
    complex: &'a Complex,
    /// The cells on both sides of each segment.
    pub cells: Vec<[Option<u32>; 2]>,
    /// The block of each node in the cell of either side.
    blocks: Vec<[Option<u32>; 2]>,
    /// The number of each segment's first gap.
    pub first: Vec<u32>,
    /// Of each node: the gap before it by rising coordinate; the next number is the gap after it.
    gap: Vec<u32>,
    /// Gaps that lie in the same face.
    classes: Classes,
    /// The face of each gap, from 1 by each face's first gap.
    pub faces: Vec<FaceId>,
    /// The arms of each block by cell, block and boundary cycle, in the order of the walk along the cycle.
    pub arms: Vec<Vec<Vec<Vec<Arm>>>>,
}

impl<'a> Incidence<'a> {
    /// Reads a complex.
    ///
    /// # Errors
    /// If it breaks an invariant.
    pub fn new(complex: &'a Complex) -> Result<Self, Fault> {
        let mut first = Vec::with_capacity(complex.segments.len());
        let mut gap = vec![u32::MAX; complex.nodes.len()];
        let mut gaps = 0;
        for (s, segment) in complex.segments.iter().enumerate() {
            first.push(gaps);
            for (k, &node) in segment.nodes.iter().enumerate() {
                let known = complex.nodes.get(node as usize).is_some_and(|node| node.segment as usize == s);
                ensure(known && gap[node as usize] == u32::MAX, || format!("segment {s} and node {node} disagree"))?;
                gap[node as usize] = gaps + k as u32;
            }
            gaps += segment.nodes.len() as u32 + 1;
        }
        if let Some(node) = gap.iter().position(|&gap| gap == u32::MAX) {
            return Err(Fault(format!("node {node} is on no segment")));
        }
        let mut incidence = Self {
            complex,
            cells: vec![[None; 2]; complex.segments.len()],
            blocks: vec![[None; 2]; complex.nodes.len()],
            first,
            gap,
            classes: Classes::new(gaps as usize),
            faces: Vec::with_capacity(gaps as usize),
            arms: Vec::with_capacity(complex.cells.len()),
        };
        for (c, cell) in complex.cells.iter().enumerate() {
            incidence.walk(c as u32, cell)?;
        }
        for (s, segment) in complex.segments.iter().enumerate() {
            let count = incidence.cells[s].iter().flatten().count();
            ensure(count == 2 - usize::from(segment.frame), || format!("segment {s} has {count} cells"))?;
        }
        for (c, cell) in complex.cells.iter().enumerate() {
            incidence.join(c as u32, cell)?;
        }
        let mut count = 0;
        for gap in 0..gaps {
            // A class is named by its smallest member, which has its face by now.
            let class = incidence.classes.find(gap);
            let face = incidence.faces.get(class as usize).copied().unwrap_or(count + 1);
            count = count.max(face);
            incidence.faces.push(face);
        }
        Ok(incidence)
    }

    /// Enters a cell's boundary and blocks.
    fn walk(&mut self, c: u32, cell: &Cell) -> Result<(), Fault> {
        ensure(cell.boundary.iter().all(|cycle| !cycle.is_empty()), || {
            format!("cell {c} has an empty boundary cycle")
        })?;
        ensure(!cell.boundary.is_empty(), || format!("cell {c} has no boundary"))?;
        for &(s, forward) in cell.boundary.iter().flatten() {
            let cells = self.cells.get_mut(s as usize).ok_or_else(|| Fault(format!("cell {c} names segment {s}")))?;
            let side = usize::from(!forward);
            ensure(cells[side].is_none(), || format!("segment {s} has several cells on one side"))?;
            ensure(cells[1 - side] != Some(c), || format!("segment {s} has cell {c} on both sides"))?;
            cells[side] = Some(c);
        }
        for (b, block) in cell.blocks.iter().enumerate() {
            for &node in &block.nodes {
                let segment = self.complex.nodes.get(node as usize).map(|node| node.segment as usize);
                let side = segment.and_then(|s| self.cells[s].iter().position(|&cell| cell == Some(c)));
                let side =
                    side.ok_or_else(|| Fault(format!("cell {c} joins node {node}, which is not on its boundary")))?;
                let owner = &mut self.blocks[node as usize][side];
                ensure(owner.is_none(), || format!("cell {c} joins node {node} twice"))?;
                *owner = Some(b as u32);
            }
            self.arc(block).map_err(|what| Fault(format!("cell {c}: {what}")))?;
        }
        Ok(())
    }

    /// Whether an arc joins two nodes of the same curves.
    fn arc(&self, block: &Block) -> Result<(), &'static str> {
        if block.vertex.is_some() {
            return Ok(());
        }
        let [p, q] = block.nodes[..] else { return Err("an arc does not join two nodes") };
        let [p, q] = [p, q].map(|node| &self.complex.nodes[node as usize]);
        if p.component != q.component || p.curves != q.curves {
            return Err("an arc changes its curves on the way");
        }
        Ok(())
    }

    /// The nodes of a cycle as the cell sees them, in the order of the walk.
    fn along(&self, cycle: &'a [(u32, bool)]) -> impl Iterator<Item = Arm> + 'a {
        let segments = &self.complex.segments;
        cycle.iter().flat_map(move |&(s, forward)| {
            let nodes = &segments[s as usize].nodes;
            let count = nodes.len();
            (0..count).map(move |k| if forward { (nodes[k], 0) } else { (nodes[count - 1 - k], 1) })
        })
    }

    /// Collects the arms of a cell's blocks and unites the gaps that no block parts.
    fn join(&mut self, c: u32, cell: &'a Cell) -> Result<(), Fault> {
        let mut arms = vec![vec![Vec::new(); cell.boundary.len()]; cell.blocks.len()];
        for (k, cycle) in cell.boundary.iter().enumerate() {
            for (i, &(s, forward)) in cycle.iter().enumerate() {
                let (t, ahead) = cycle[(i + 1) % cycle.len()];
                // No curve passes through a corner.
                let (end, start) = (self.end_gap(s, forward), self.end_gap(t, !ahead));
                self.classes.unite(end, start);
            }
            let mut open: Vec<(u32, usize)> = Vec::new();
            for (node, side) in self.along(cycle).collect::<Vec<_>>() {
                let block = self.blocks[node as usize][side];
                let block = block.ok_or_else(|| Fault(format!("cell {c} leaves node {node} alone")))?;
                let own: &mut Vec<Arm> = &mut arms[block as usize][k];
                own.push((node, side));
                // Blocks that do not cross are open in the order of a stack.
                let count = own.len();
                if count == 1 {
                    open.push((block, 0));
                }
                ensure(open.last().is_some_and(|last| last.0 == block), || format!("two blocks of cell {c} cross"))?;
                if cell.boundary.len() == 1 && count == cell.blocks[block as usize].nodes.len() {
                    open.pop();
                }
            }
        }
        if surrounds(cell) {
            let starts: Vec<u32> = cell.boundary.iter().map(|cycle| self.end_gap(cycle[0].0, !cycle[0].1)).collect();
            starts.windows(2).for_each(|pair| self.classes.unite(pair[0], pair[1]));
        }
        let simple = surrounds(cell) || matches!(&cell.blocks[..], [block] if block.vertex.is_some());
        ensure(simple, || format!("cell {c} has holes and is not one vertex"))?;
        let lone = cell.blocks.len() == 1 || cell.blocks.iter().all(|block| !block.nodes.is_empty());
        ensure(lone, || format!("cell {c} has an isolated point beside something else"))?;
        for cycle in arms.iter().flatten() {
            for (i, &arm) in cycle.iter().enumerate() {
                let next = cycle[(i + 1) % cycle.len()];
                let (after, before) = (self.after(arm), self.before(next));
                self.classes.unite(after, before);
            }
        }
        self.arms.push(arms);
        Ok(())
    }

    /// The gap at the end of a segment, or at its start.
    fn end_gap(&self, segment: u32, end: bool) -> u32 {
        let s = segment as usize;
        self.first[s] + if end { self.complex.segments[s].nodes.len() as u32 } else { 0 }
    }

    /// The face at the start of a segment, walked in a direction.
    pub fn start(&self, segment: u32, forward: bool) -> FaceId {
        self.faces[self.end_gap(segment, !forward) as usize]
    }

    /// The face to the left of whoever passes a node, leaving the cell on that side.
    pub fn left(&self, arm: Arm) -> FaceId {
        self.faces[self.after(arm) as usize]
    }

    /// The face to the right.
    pub fn right(&self, arm: Arm) -> FaceId {
        self.faces[self.before(arm) as usize]
    }

    /// The gap just after a node on the walk of the cell on that side.
    fn after(&self, (node, side): Arm) -> u32 {
        self.gap[node as usize] + u32::from(side == 0)
    }

    /// The gap just before it.
    fn before(&self, (node, side): Arm) -> u32 {
        self.after((node, 1 - side))
    }

    /// The cell on a side of a node; `None` outside the domain.
    pub fn cell(&self, (node, side): Arm) -> Option<u32> {
        self.cells[self.complex.nodes[node as usize].segment as usize][side]
    }

    /// The block that has the node in the cell on that side.
    pub fn block(&self, (node, side): Arm) -> Option<u32> {
        self.blocks[node as usize][side]
    }

    /// The node at the other end of the arc that begins at `arm`, seen from the same cell.
    pub fn across(&self, arm: Arm, cell: u32, block: u32) -> Option<Arm> {
        self.arms[cell as usize][block as usize].iter().flatten().copied().find(|&other| other != arm)
    }
}
