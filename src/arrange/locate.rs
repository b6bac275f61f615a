//! Point location: the face, edge or vertex at a point, certified or not at all.
//!
//! In its cell the point shoots at the four sides. Where a component's value along the shot has no zero (its enclosure excludes 0,
//! or it moves away from 0 from the value at the point on), the point lies beside the same parts of that component's curve as the
//! gap it hits. What is left when all components have said so are the gaps of one face.

use crate::arrange::build::union::Classes;
use crate::arrange::complex::Axis;
use crate::arrange::complex::Cell;
use crate::arrange::complex::Vertex;
use crate::arrange::field::Fields;
use crate::arrange::field::Sample;
use crate::arrange::index::BoxIndex;
use crate::arrange::structure::Arrangement;
use crate::arrange::structure::EdgeId;
use crate::arrange::structure::FaceId;
use crate::arrange::structure::Site;
use crate::arrange::structure::VertexId;
use crate::interval::Interval;
use crate::interval::Verdict;
use crate::kernel::verdict;

/// How often a shot is halved where it is not decided.
const HALVINGS: u32 = 8;

/// What is at a point.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Location {
    /// The point lies in the interior of a face; 0 is the outside of the domain.
    Face(FaceId),
    /// On an edge, not at its ends.
    Edge(EdgeId),
    Vertex(VertexId),
    /// Not decided: in or on the boundary of one of these faces, rising. Empty if the point is no point.
    Unknown(Vec<FaceId>),
}

/// The functions whose zeros are located: [`Fields`], or what stands in for them.
pub trait Components {
    /// How many there are.
    fn count(&self) -> u32;
    /// Samples of components on boxes.
    fn evaluate(&self, queries: &[(u32, [Interval; 2])]) -> Vec<Sample>;
}

impl Components for Fields {
    fn count(&self) -> u32 {
        self.components.len() as u32
    }

    fn evaluate(&self, queries: &[(u32, [Interval; 2])]) -> Vec<Sample> {
        let function = |&(component, sides): &(u32, _)| (self.components[component as usize].function, sides);
        Fields::evaluate(self, &queries.iter().map(function).collect::<Vec<_>>())
    }
}

/// Point location in an arrangement.
pub struct Locator<'a> {
    arrangement: &'a Arrangement,
    components: &'a dyn Components,
    index: BoxIndex,
    /// The cell of each box of the index.
    cells: Vec<u32>,
    /// The vertex of each block and node that has one.
    vertices: std::collections::HashMap<Site, VertexId>,
}

/// A stretch of a cell's boundary between nodes, or a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Piece {
    Gap(u32, usize),
    Node(u32),
}

/// The side of a box that a shot hits: the axis of its direction, and whether it is the upper one.
type Direction = (usize, bool);

const DIRECTIONS: [Direction; 4] = [(0, false), (0, true), (1, false), (1, true)];

impl<'a> Locator<'a> {
    /// Prepares point location; the components must be those from which the arrangement was computed.
    pub fn new(arrangement: &'a Arrangement, components: &'a dyn Components) -> Self {
        let cells = arrangement.complex.cells.iter().enumerate();
        let (cells, boxes) = cells.flat_map(|(c, cell)| cell.boxes.iter().map(move |&sides| (c as u32, sides))).unzip();
        let vertices =
            arrangement.vertices.iter().enumerate().map(|(v, vertex)| (vertex.site, v as VertexId)).collect();
        Self { arrangement, components, index: BoxIndex::new(boxes), cells, vertices }
    }

    /// What is at a point. Points of the frame count as inside of the domain.
    pub fn locate(&self, point: [f64; 2]) -> Location {
        if point.iter().any(|x| x.is_nan()) {
            return Location::Unknown(Vec::new());
        }
        let Some(found) = self.index.find(point) else { return Location::Face(0) };
        let c = self.cells[found as usize];
        let cell = &self.arrangement.complex.cells[c as usize];
        let cycles: Vec<Vec<Piece>> = cell.boundary.iter().map(|cycle| self.pieces(cycle)).collect();
        if cell.blocks.is_empty() {
            return self.answer(cycles.iter().flatten().copied());
        }
        let area = |sides: [Interval; 2]| (0..2).all(|i| sides[i] == Interval::point(point[i]));
        for (b, block) in cell.blocks.iter().enumerate() {
            let exact = |vertex: &Vertex| vertex.proved && area(vertex.area);
            if block.vertex.as_ref().is_some_and(exact)
                && let Some(&v) = self.vertices.get(&Site::Block { cell: c, block: b as u32 })
            {
                return Location::Vertex(v);
            }
        }
        let leaf = self.index.get(found);
        // Only where all vertices are proved are the arms all that there is of the curves.
        let settled = cell.blocks.iter().all(|block| block.vertex.as_ref().is_none_or(|vertex| vertex.proved))
            && cycles.len() == 1
            && cell.blocks.iter().all(|block| !block.nodes.is_empty());
        let own = cell
            .blocks
            .iter()
            .flat_map(|block| &block.nodes)
            .map(|&n| self.arrangement.complex.nodes[n as usize].component);
        let mut active: Vec<u32> = if settled { own.collect() } else { (0..self.components.count()).collect() };
        active.sort_unstable();
        active.dedup();
        let at = point.map(Interval::point);
        let here = self.components.evaluate(&active.iter().map(|&component| (component, at)).collect::<Vec<_>>());
        for (&component, sample) in active.iter().zip(&here) {
            if settled
                && sample.bits & verdict::CONTINUOUS != 0
                && sample.value == Interval::ZERO
                && let Some(place) = self.on_curve(cell, &leaf, point, component)
            {
                return place;
            }
        }
        let hits = |i: usize| {
            let hit = |&way: &Direction| {
                self.hit(cell, &leaf, point, way).filter(|_| self.clear(&leaf, point, way, active[i], here[i]))
            };
            DIRECTIONS.iter().filter_map(hit).next()
        };
        if settled {
            let pieces = &cycles[0];
            let mut left: Vec<bool> = pieces.iter().map(|piece| matches!(piece, Piece::Gap(..))).collect();
            for (i, &component) in active.iter().enumerate() {
                let Some(hit) = hits(i).and_then(|hit| pieces.iter().position(|&piece| piece == hit)) else { continue };
                let mut beside = self.beside(cell, pieces, component);
                let class = beside.find(hit as u32);
                left.iter_mut().enumerate().for_each(|(k, left)| *left &= beside.find(k as u32) == class);
            }
            let left = pieces.iter().copied().zip(left).filter(|(_, left)| *left).map(|(piece, _)| piece);
            // Both sides of an edge may be the same face, so the point must be proved to be off all curves too.
            let off = here.iter().all(|sample| sample.bits & verdict::REFUTED != 0);
            return if off { self.answer(left) } else { self.undecided(left) };
        }
        // Nothing is known of the inside, so one shot must be clear of everything.
        let sure = |&way: &Direction| {
            let clear = |(&component, &sample): (&u32, &Sample)| self.clear(&leaf, point, way, component, sample);
            self.hit(cell, &leaf, point, way).filter(|_| active.iter().zip(&here).all(clear))
        };
        match DIRECTIONS.iter().find_map(sure) {
            Some(piece) => self.answer([piece].into_iter()),
            None => self.undecided(cycles.iter().flatten().copied()),
        }
    }

    /// The pieces of a boundary cycle in the order of the walk.
    fn pieces(&self, cycle: &[(u32, bool)]) -> Vec<Piece> {
        let mut pieces = Vec::new();
        for &(s, forward) in cycle {
            let start = pieces.len();
            pieces.push(Piece::Gap(s, 0));
            for (k, &node) in self.arrangement.complex.segments[s as usize].nodes.iter().enumerate() {
                pieces.extend([Piece::Node(node), Piece::Gap(s, k + 1)]);
            }
            if !forward {
                pieces[start..].reverse();
            }
        }
        pieces
    }

    fn faces(&self, pieces: impl Iterator<Item = Piece>) -> Vec<FaceId> {
        let face = |piece| if let Piece::Gap(s, k) = piece { Some(self.arrangement.gaps.face(s, k)) } else { None };
        let mut faces: Vec<FaceId> = pieces.filter_map(face).collect();
        faces.sort_unstable();
        faces.dedup();
        faces
    }

    /// The face of gaps if it is one.
    fn answer(&self, pieces: impl Iterator<Item = Piece>) -> Location {
        match self.faces(pieces)[..] {
            [face] => Location::Face(face),
            ref faces => Location::Unknown(faces.to_vec()),
        }
    }

    fn undecided(&self, pieces: impl Iterator<Item = Piece>) -> Location {
        Location::Unknown(self.faces(pieces))
    }

    /// The gap of the cell that a shot hits; `None` if it hits no boundary of the cell, or what may be a node.
    fn hit(&self, cell: &Cell, leaf: &[Interval; 2], point: [f64; 2], (axis, up): Direction) -> Option<Piece> {
        let at = if up { leaf[axis].hi() } else { leaf[axis].lo() };
        let (across, along) = (if axis == 0 { Axis::Y } else { Axis::X }, point[1 - axis]);
        cell.boundary.iter().flatten().find_map(|&(s, _)| {
            let segment = &self.arrangement.complex.segments[s as usize];
            if segment.axis != across || segment.at != at || !(segment.from..=segment.to).contains(&along) {
                return None;
            }
            let places = segment.nodes.iter().map(|&n| self.arrangement.complex.nodes[n as usize].place);
            let free = places.clone().all(|place| !place.contains(along));
            free.then(|| Piece::Gap(s, places.filter(|place| place.hi() < along).count()))
        })
    }

    /// Whether a component is proved to have no zero from a point to a side of its box. `here` is its sample at the point.
    fn clear(
        &self,
        leaf: &[Interval; 2],
        point: [f64; 2],
        (axis, up): Direction,
        component: u32,
        here: Sample,
    ) -> bool {
        if here.bits & verdict::REFUTED == 0 {
            return false;
        }
        let end = if up { leaf[axis].hi() } else { leaf[axis].lo() };
        let mut open = vec![(point[axis], end, 0)];
        while let Some((from, to, halved)) = open.pop() {
            let mut shot = point.map(Interval::point);
            let Some(part) = Interval::new(from.min(to), from.max(to)) else { return false };
            shot[axis] = part;
            let [sample] = self.components.evaluate(&[(component, shot)])[..] else { return false };
            // Away from 0 from here on, if this part begins at the point.
            let away = if up { sample.slope[axis] } else { -sample.slope[axis] };
            let grows = match here.bits & (verdict::POSITIVE | verdict::NEGATIVE) {
                verdict::POSITIVE => away.is_nonnegative() == Verdict::Proved,
                verdict::NEGATIVE => (-away).is_nonnegative() == Verdict::Proved,
                _ => false,
            };
            let monotone = grows && from == point[axis] && sample.bits & verdict::CONTINUOUS != 0;
            if monotone || sample.bits & verdict::REFUTED != 0 {
                continue;
            }
            let middle = f64::midpoint(from, to);
            if halved == HALVINGS || middle == from || middle == to {
                return false;
            }
            open.extend([(middle, to, halved + 1), (from, middle, halved + 1)]);
        }
        true
    }

    /// Which pieces of the boundary lie beside the same parts of a component's curve: the pieces cut by that component's
    /// nodes alone, and joined around its arms.
    fn beside(&self, cell: &Cell, pieces: &[Piece], component: u32) -> Classes {
        let count = pieces.len();
        let mut classes = Classes::new(count);
        let own = |piece: Piece| match piece {
            Piece::Node(n) => self.arrangement.complex.nodes[n as usize].component == component,
            Piece::Gap(..) => false,
        };
        for k in 0..count {
            let next = (k + 1) % count;
            if !own(pieces[k]) && !own(pieces[next]) {
                classes.unite(k as u32, next as u32);
            }
        }
        for block in &cell.blocks {
            let of_block = |piece: Piece| matches!(piece, Piece::Node(n) if own(piece) && block.nodes.contains(&n));
            let arms: Vec<usize> = (0..count).filter(|&k| of_block(pieces[k])).collect();
            for (i, &arm) in arms.iter().enumerate() {
                let next = arms[(i + 1) % arms.len()];
                classes.unite(((arm + 1) % count) as u32, ((next + count - 1) % count) as u32);
            }
        }
        classes
    }

    /// The edge or vertex at a point where a component's value is 0, if the point can be told to be of the curve: at an
    /// isolated node, or on an arc over a coordinate along which the component has no other zero.
    fn on_curve(&self, cell: &Cell, leaf: &[Interval; 2], point: [f64; 2], component: u32) -> Option<Location> {
        let complex = &self.arrangement.complex;
        for &(s, _) in cell.boundary.iter().flatten() {
            let segment = &complex.segments[s as usize];
            let (across, along) = if segment.axis == Axis::X { (1, 0) } else { (0, 1) };
            for &n in segment.nodes.iter().filter(|_| segment.at == point[across]) {
                let node = &complex.nodes[n as usize];
                if node.component == component && node.place.contains(point[along]) {
                    let vertex = self.vertices.get(&Site::Node(n)).copied();
                    let edge = self.arrangement.node_edges[n as usize];
                    return Some(vertex.map_or(Location::Edge(edge), Location::Vertex));
                }
            }
        }
        // A line across the box of the leaf is one across the cell only if that is all of the cell. An arc from one side of the
        // line to the other meets it, then, where the component has its only zero there.
        let arcs = cell.blocks.iter().filter(|block| block.vertex.is_none() && cell.boxes.len() == 1);
        for block in arcs {
            let first =
                block.nodes.iter().map(|&n| &complex.nodes[n as usize]).find(|node| node.component == component);
            if first.is_none() {
                continue;
            }
            for along in 0..2 {
                let mut line = *leaf;
                line[along] = Interval::point(point[along]);
                let [sample] = self.components.evaluate(&[(component, line)])[..] else { return None };
                let single =
                    sample.slope[1 - along].is_zero() == Verdict::Refuted && sample.bits & verdict::CONTINUOUS != 0;
                let place = |n: u32| {
                    let node = &complex.nodes[n as usize];
                    let segment = &complex.segments[node.segment as usize];
                    if (segment.axis == Axis::X) == (along == 0) { node.place } else { Interval::point(segment.at) }
                };
                let [from, to] = block.nodes[..] else { continue };
                let (from, to) = (place(from), place(to));
                let spans = |a: Interval, b: Interval| a.hi() < point[along] && point[along] < b.lo();
                if single && (spans(from, to) || spans(to, from)) {
                    return Some(Location::Edge(self.arrangement.node_edges[block.nodes[0] as usize]));
                }
            }
        }
        None
    }
}

#[cfg(test)]
mod tests;
