//! Complexes of lines and circles for tests, from formulas in floating point: nothing of the solver takes part.

use std::collections::BTreeMap;

use crate::arrange::complex::Axis;
use crate::arrange::complex::Block;
use crate::arrange::complex::Cell;
use crate::arrange::complex::Complex;
use crate::arrange::complex::Effort;
use crate::arrange::complex::Node;
use crate::arrange::complex::Segment;
use crate::arrange::complex::Vertex;
use crate::arrange::complex::VertexKind;
use crate::interval::Interval;

pub type Box2 = [Interval; 2];
type Point = [f64; 2];
/// A stretch of a line from and to, with a cell on it, and whether that cell is on side 0.
type Stretch = (f64, f64, usize, bool);

/// A curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Curve {
    /// a x + b y = c.
    Line(f64, f64, f64),
    /// Centre and radius.
    Circle(f64, f64, f64),
}

/// What a test draws.
#[derive(Debug, Clone, Default)]
pub struct Toy {
    pub curves: Vec<Curve>,
    /// Isolated points, drawn as curves of their own.
    pub points: Vec<Point>,
    /// Leaves inside of a ring around a point (radii in the maximum norm) are united to an unresolved region.
    pub ring: Option<(Point, f64, f64)>,
    /// Levels of subdivision, whatever the curves.
    pub levels: u32,
}

pub fn interval(lo: f64, hi: f64) -> Interval {
    Interval::new(lo, hi).unwrap()
}

pub fn domain() -> Box2 {
    [interval(-1.0, 1.0), interval(-1.0, 1.0)]
}

fn inside(point: Point, sides: &Box2) -> bool {
    (0..2).all(|i| sides[i].lo() < point[i] && point[i] < sides[i].hi())
}

impl Curve {
    /// Coordinates along a line parallel to an axis at which the curve crosses it.
    fn cross(self, axis: Axis, at: f64) -> Vec<f64> {
        match self {
            Curve::Line(a, b, c) => {
                let (along, across) = if axis == Axis::X { (a, b) } else { (b, a) };
                if along == 0.0 { vec![] } else { vec![(c - across * at) / along] }
            }
            Curve::Circle(x, y, r) => {
                let (along, across) = if axis == Axis::X { (x, y) } else { (y, x) };
                let square = r * r - (at - across) * (at - across);
                if square <= 0.0 { vec![] } else { vec![along - square.sqrt(), along + square.sqrt()] }
            }
        }
    }

    pub fn meet(self, other: Curve) -> Vec<Point> {
        match (self, other) {
            (Curve::Line(a, b, c), Curve::Line(d, e, f)) => {
                let det = a * e - b * d;
                if det == 0.0 { vec![] } else { vec![[(c * e - b * f) / det, (a * f - c * d) / det]] }
            }
            (Curve::Line(a, b, c), Curve::Circle(x, y, r)) => {
                let norm = a.hypot(b);
                let distance = (c - a * x - b * y) / norm;
                let square = r * r - distance * distance;
                if square <= 0.0 {
                    return vec![];
                }
                let (foot, half) = ([x + a / norm * distance, y + b / norm * distance], square.sqrt());
                [-half, half].map(|h| [foot[0] - b / norm * h, foot[1] + a / norm * h]).to_vec()
            }
            (Curve::Circle(..), Curve::Line(..)) => other.meet(self),
            (Curve::Circle(x, y, r), Curve::Circle(u, v, s)) => {
                // The radical axis.
                let (a, b) = (2.0 * (u - x), 2.0 * (v - y));
                if a == 0.0 && b == 0.0 {
                    return vec![];
                }
                Curve::Line(a, b, r * r - s * s + u * u + v * v - x * x - y * y).meet(self)
            }
        }
    }

    /// A parameter that rises along the curve, and the point of a parameter.
    fn parameter(self, point: Point) -> f64 {
        match self {
            Curve::Line(a, b, _) => a * point[1] - b * point[0],
            Curve::Circle(x, y, _) => (point[1] - y).atan2(point[0] - x),
        }
    }
}

impl Toy {
    pub fn of(curves: &[Curve]) -> Self {
        Self { curves: curves.to_vec(), levels: 3, ..Self::default() }
    }

    pub fn crossings(&self) -> Vec<(usize, usize, Point)> {
        let mut all = Vec::new();
        for (i, &c) in self.curves.iter().enumerate() {
            for (j, &d) in self.curves.iter().enumerate().skip(i + 1) {
                all.extend(c.meet(d).into_iter().map(|p| (i, j, p)).filter(|(.., p)| inside(*p, &domain())));
            }
        }
        all
    }

    /// Leaves of a quadtree with at most one crossing or isolated point in each.
    pub fn leaves(&self) -> Vec<Box2> {
        let marks: Vec<Point> = self.crossings().into_iter().map(|(.., p)| p).chain(self.points.clone()).collect();
        let (mut open, mut leaves) = (vec![(domain(), 0)], Vec::new());
        while let Some((sides, level)) = open.pop() {
            let count = marks.iter().filter(|p| inside(**p, &sides)).count();
            if level >= self.levels && (count < 2 || level > 40) {
                leaves.push(sides);
                continue;
            }
            let [x, y] = sides;
            let mid = |i: Interval, ratio: f64| i.lo() + ratio * (i.hi() - i.lo());
            let (u, v) = (mid(x, 0.4871), mid(y, 0.5213));
            for x in [interval(u, x.hi()), interval(x.lo(), u)] {
                for y in [interval(v, y.hi()), interval(y.lo(), v)] {
                    open.push(([x, y], level + 1));
                }
            }
        }
        leaves
    }

    /// The complex over the leaves.
    pub fn complex(&self) -> Complex {
        let (mut ring, mut cells) = (Vec::new(), Vec::new());
        for leaf in self.leaves() {
            let middle = leaf.map(|side| f64::midpoint(side.lo(), side.hi()));
            let far = |to: Point| (middle[0] - to[0]).abs().max((middle[1] - to[1]).abs());
            if self.ring.is_some_and(|(centre, from, to)| (from..to).contains(&far(centre))) {
                ring.push(leaf);
            } else {
                cells.push(vec![leaf]);
            }
        }
        if !ring.is_empty() {
            cells.push(ring);
        }
        self.complex_of(&cells)
    }

    /// The complex over given cells; those of several boxes are unresolved.
    pub fn complex_of(&self, cells: &[Vec<Box2>]) -> Complex {
        let (mut segments, mut cells) = tile(cells);
        let mut nodes = Vec::new();
        for (s, segment) in segments.iter_mut().enumerate() {
            let mut places: Vec<(f64, usize)> = Vec::new();
            for (i, curve) in self.curves.iter().enumerate() {
                places.extend(curve.cross(segment.axis, segment.at).into_iter().map(|place| (place, i)));
            }
            places.retain(|place| (segment.from..segment.to).contains(&place.0));
            places.sort_by(|a, b| a.0.total_cmp(&b.0));
            for (place, i) in places {
                segment.nodes.push(nodes.len() as u32);
                let place = interval(place - 1e-14, place + 1e-14);
                nodes.push(Node { segment: s as u32, place, component: i as u32, curves: vec![i as u16] });
            }
        }
        for cell in &mut cells {
            cell.blocks = self.blocks(cell, &segments, &nodes);
        }
        let curves = (0..self.curves.len() + self.points.len()).map(|i| format!("c{i}")).collect();
        Complex { domain: domain(), curves, segments, nodes, cells, effort: Effort::default() }
    }

    fn blocks(&self, cell: &Cell, segments: &[Segment], nodes: &[Node]) -> Vec<Block> {
        let mut around: Vec<u32> = Vec::new();
        for &(s, forward) in cell.boundary.iter().flatten() {
            let on = segments[s as usize].nodes.iter().copied();
            if forward { around.extend(on) } else { around.extend(on.rev()) }
        }
        let vertex = |kind, area: Box2, curves: Vec<u16>| {
            Some(Vertex { kind, area, proved: kind != VertexKind::Cluster, curves, note: None })
        };
        let [sides] = cell.boxes[..] else {
            let curves = (0..self.curves.len() as u16).collect();
            let area = domain();
            return vec![Block { nodes: around, vertex: vertex(VertexKind::Cluster, area, curves), axis: None }];
        };
        // Arcs with their range of parameters.
        let mut arcs: Vec<(usize, [f64; 2], [u32; 2])> = Vec::new();
        for (i, &curve) in self.curves.iter().enumerate() {
            let mut own: Vec<(f64, u32)> = (around.iter().copied())
                .filter(|&n| nodes[n as usize].component == i as u32)
                .map(|n| (curve.parameter(point(&nodes[n as usize], segments)), n))
                .collect();
            own.sort_by(|a, b| a.0.total_cmp(&b.0));
            for (k, &(from, first)) in own.iter().enumerate() {
                let (mut to, second) = own[(k + 1) % own.len()];
                let within = match curve {
                    Curve::Line(..) => k % 2 == 0,
                    Curve::Circle(x, y, r) => {
                        if to <= from {
                            to += std::f64::consts::TAU;
                        }
                        let angle = f64::midpoint(from, to);
                        inside([x + r * angle.cos(), y + r * angle.sin()], &sides)
                    }
                };
                if within {
                    arcs.push((i, [from, to], [first, second]));
                }
            }
        }
        // Arcs that meet in a crossing become one block.
        let mut group: Vec<usize> = (0..arcs.len()).collect();
        let mut marks: Vec<(usize, Point)> = Vec::new();
        for (i, j, p) in self.crossings().into_iter().filter(|(.., p)| inside(*p, &sides)) {
            let on = |i: usize| {
                let at = self.curves[i].parameter(p);
                let holds =
                    |[from, to]: [f64; 2]| [at, at + std::f64::consts::TAU].iter().any(|a| (from..to).contains(a));
                arcs.iter().position(|arc| arc.0 == i && holds(arc.1)).unwrap()
            };
            let (a, b) = (group[on(i)], group[on(j)]);
            group.iter_mut().filter(|g| **g == b).for_each(|g| *g = a);
            marks.iter_mut().filter(|m| m.0 == b).for_each(|m| m.0 = a);
            marks.push((a, p));
        }
        let mut blocks = Vec::new();
        for g in 0..arcs.len() {
            let members: Vec<_> =
                arcs.iter().zip(&group).filter(|(_, group)| **group == g).map(|(arc, _)| arc).collect();
            let mut of_block: Vec<u32> = members.iter().flat_map(|arc| arc.2).collect();
            of_block.sort_by_key(|n| around.iter().position(|m| m == n));
            let here: Vec<_> = marks.iter().filter(|m| m.0 == g).map(|m| m.1).collect();
            let mut curves: Vec<u16> = members.iter().map(|arc| arc.0 as u16).collect();
            curves.sort_unstable();
            curves.dedup();
            match here[..] {
                _ if of_block.is_empty() => {}
                [] => blocks.push(Block { nodes: of_block, vertex: None, axis: Some(Axis::X) }),
                [p] => {
                    let area = p.map(|p| interval(p - 1e-14, p + 1e-14));
                    blocks.push(Block {
                        nodes: of_block,
                        vertex: vertex(VertexKind::Crossing, area, curves),
                        axis: None,
                    });
                }
                _ => blocks.push(Block {
                    nodes: of_block,
                    vertex: vertex(VertexKind::Cluster, sides, curves),
                    axis: None,
                }),
            }
        }
        for (k, p) in self.points.iter().enumerate().filter(|(_, p)| inside(**p, &sides)) {
            let curves = vec![(self.curves.len() + k) as u16];
            let area = p.map(Interval::point);
            blocks.push(Block { nodes: vec![], vertex: vertex(VertexKind::Singular, area, curves), axis: None });
        }
        blocks
    }
}

/// Where a node is.
fn point(node: &Node, segments: &[Segment]) -> Point {
    let segment = &segments[node.segment as usize];
    let place = f64::midpoint(node.place.lo(), node.place.hi());
    if segment.axis == Axis::X { [place, segment.at] } else { [segment.at, place] }
}

/// The segments between cells, and the cells with their boundaries.
pub fn tile(cells: &[Vec<Box2>]) -> (Vec<Segment>, Vec<Cell>) {
    let mut lines: BTreeMap<(bool, u64), Vec<Stretch>> = BTreeMap::new();
    for (c, [x, y]) in cells.iter().enumerate().flat_map(|(c, boxes)| boxes.iter().map(move |sides| (c, sides))) {
        let key = |at: f64| (at + 8.0).to_bits();
        lines.entry((false, key(y.lo()))).or_default().push((x.lo(), x.hi(), c, true));
        lines.entry((false, key(y.hi()))).or_default().push((x.lo(), x.hi(), c, false));
        lines.entry((true, key(x.lo()))).or_default().push((y.lo(), y.hi(), c, false));
        lines.entry((true, key(x.hi()))).or_default().push((y.lo(), y.hi(), c, true));
    }
    let mut at_of: BTreeMap<u64, f64> = BTreeMap::new();
    for side in cells.iter().flatten().flatten() {
        for at in [side.lo(), side.hi()] {
            at_of.insert((at + 8.0).to_bits(), at);
        }
    }
    let mut segments: Vec<Segment> = Vec::new();
    let mut sides: Vec<[Option<usize>; 2]> = Vec::new();
    for (&(vertical, key), stretches) in &lines {
        let mut ends: Vec<f64> = stretches.iter().flat_map(|s| [s.0, s.1]).collect();
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        for pair in ends.windows(2) {
            let cell =
                |left: bool| stretches.iter().find(|s| s.3 == left && s.0 <= pair[0] && pair[1] <= s.1).map(|s| s.2);
            let both = [cell(true), cell(false)];
            if both[0] == both[1] {
                continue;
            }
            let axis = if vertical { Axis::Y } else { Axis::X };
            let frame = both.contains(&None);
            segments.push(Segment { axis, at: at_of[&key], from: pair[0], to: pair[1], nodes: vec![], frame });
            sides.push(both);
        }
    }
    let boundary = |c: usize| {
        let mut own: Vec<(u32, bool)> = Vec::new();
        for (s, both) in sides.iter().enumerate() {
            own.extend(both.iter().position(|&cell| cell == Some(c)).map(|side| (s as u32, side == 0)));
        }
        let end = |(s, forward): (u32, bool), at_end: bool| {
            let s = &segments[s as usize];
            let along = if forward == at_end { s.to } else { s.from };
            if s.axis == Axis::X { [along, s.at] } else { [s.at, along] }
        };
        let mut cycles: Vec<(f64, Vec<(u32, bool)>)> = Vec::new();
        while let Some(first) = own.pop() {
            let (mut cycle, mut area) = (vec![first], 0.0);
            loop {
                let last = *cycle.last().unwrap();
                let (from, to) = (end(last, false), end(last, true));
                area += (from[0] * to[1] - to[0] * from[1]) / 2.0;
                let Some(next) = own.iter().position(|&s| end(s, false) == to) else { break };
                cycle.push(own.remove(next));
            }
            cycles.push((area, cycle));
        }
        cycles.sort_by(|a, b| b.0.total_cmp(&a.0));
        cycles.into_iter().map(|(_, cycle)| cycle).collect()
    };
    let cell = |(c, boxes): (usize, &Vec<Box2>)| Cell { boxes: boxes.clone(), boundary: boundary(c), blocks: vec![] };
    let cells = cells.iter().enumerate().map(cell).collect();
    (segments, cells)
}
