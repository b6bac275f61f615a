//! From a tiling to the cell complex: nodes and segments are numbered, joints become blocks, vertices are narrowed down.

use std::collections::HashMap;

use crate::arrange::cluster::Cluster;
use crate::arrange::complex::Axis;
use crate::arrange::complex::Block;
use crate::arrange::complex::Cell;
use crate::arrange::complex::Complex;
use crate::arrange::complex::Effort;
use crate::arrange::complex::Node;
use crate::arrange::complex::Segment;
use crate::arrange::complex::Vertex;
use crate::arrange::complex::VertexKind;
use crate::arrange::field::Fields;
use crate::arrange::field::Function;
use crate::arrange::local::Joint;
use crate::arrange::newton::Pair;
use crate::arrange::newton::refine;
use crate::arrange::tiling::Tiling;
use crate::arrange::tiling::places;
use crate::interval::Interval;

/// What is known of a cluster beyond its boundary.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// One vertex with all nodes as arms.
    Vertex(Vertex),
    /// A regular arc, or nothing at all.
    Regular,
}

/// A block, and the functions whose common zero its vertex is.
struct Pending {
    cell: usize,
    block: usize,
    functions: [Function; 2],
}

/// Assembles the complex. `outcomes` says of each cluster what it is.
pub fn assemble(fields: &Fields, tiling: &Tiling, clusters: &[Cluster], outcomes: Vec<Outcome>) -> Complex {
    let mut complex = Complex {
        domain: fields.domain,
        curves: fields.curves.clone(),
        segments: Vec::new(),
        nodes: Vec::new(),
        cells: Vec::new(),
        effort: Effort::default(),
    };
    // Sides inside clusters are no segments.
    let mut segments: Vec<Option<u32>> = vec![None; tiling.sides.len()];
    let mut nodes: HashMap<(u32, u32), u32> = HashMap::new();
    for (index, side) in tiling.sides.iter().enumerate() {
        if side.leaves.iter().all(|leaf| leaf.is_some_and(|leaf| tiling.leaves[leaf as usize].open)) {
            continue;
        }
        let id = complex.segments.len() as u32;
        segments[index] = Some(id);
        let mut own = Vec::new();
        for (position, crossing) in (0..).zip(tiling.crossings[index].as_deref().unwrap_or_default()) {
            if crossing.curves.is_empty() {
                continue;
            }
            nodes.insert((index as u32, position), complex.nodes.len() as u32);
            own.push(complex.nodes.len() as u32);
            complex.nodes.push(Node {
                segment: id,
                place: crossing.place,
                component: crossing.component,
                curves: crossing.curves.clone(),
            });
        }
        let (axis, at, from, to) = (side.axis, side.at, side.from, side.to);
        complex.segments.push(Segment { axis, at, from, to, nodes: own, frame: side.is_frame() });
    }
    let walked = |ring: &[(u32, bool)]| -> Vec<(u32, bool)> {
        ring.iter().filter_map(|&(side, forward)| Some((segments[side as usize]?, forward))).collect()
    };
    let mut pending = Vec::new();
    for (index, leaf) in tiling.leaves.iter().enumerate().filter(|(_, leaf)| !leaf.open) {
        let places = tiling.places(index);
        let node = |place: usize| nodes[&(places[place].1, places[place].2)];
        let mut blocks = Vec::new();
        for joint in &tiling.joints[index] {
            let function = |of: u8| fields.components[leaf.active[usize::from(of)].component as usize].function;
            let (arms, kind, pair, axis): (Vec<usize>, _, _, Option<Axis>) = match joint {
                Joint::Cross { arms, of } => {
                    let pair = [function(of[0]), function(of[1])];
                    (arms.to_vec(), Some(VertexKind::Crossing), Some(pair), None)
                }
                Joint::End { arms, of } => {
                    let atom = leaf.active[usize::from(*of)].atom;
                    (arms.clone(), Some(VertexKind::End), atom.map(|atom| [function(*of), atom]), None)
                }
                Joint::Arc { ends, axis } => (ends.to_vec(), None, None, Some(*axis)),
            };
            let arms: Vec<u32> = arms.into_iter().map(node).collect();
            if let Some(functions) = pair {
                pending.push(Pending { cell: complex.cells.len(), block: blocks.len(), functions });
            }
            let vertex = kind.map(|kind| vertex(&complex, kind, &arms, leaf.area));
            blocks.push(Block { nodes: arms, vertex, axis });
        }
        complex.cells.push(Cell { boxes: vec![leaf.area], boundary: vec![walked(&tiling.rings[index])], blocks });
    }
    for (cluster, outcome) in clusters.iter().zip(outcomes) {
        let places: Vec<_> =
            cluster.boundary.iter().map(|ring| places(&tiling.sides, &tiling.crossings, ring)).collect();
        let arms = places.iter().flatten().filter_map(|&(_, side, position)| nodes.get(&(side, position)).copied());
        let arms: Vec<u32> = arms.collect();
        let blocks = match outcome {
            Outcome::Regular if arms.is_empty() => Vec::new(),
            Outcome::Regular => vec![Block { nodes: arms, vertex: None, axis: None }],
            Outcome::Vertex(vertex) => vec![Block { nodes: arms, vertex: Some(vertex), axis: None }],
        };
        complex.cells.push(Cell {
            boxes: cluster.leaves.iter().map(|&leaf| tiling.leaves[leaf as usize].area).collect(),
            boundary: cluster.boundary.iter().map(|ring| walked(ring)).collect(),
            blocks,
        });
    }
    complex.effort.evaluations += locate(fields, &mut complex, &pending);
    complex
}

/// The curves that a component belongs to, rising.
pub fn users(fields: &Fields, component: u32) -> Vec<u16> {
    let mut curves: Vec<u16> = fields.components[component as usize].uses.iter().map(|used| used.curve).collect();
    curves.sort_unstable();
    curves.dedup();
    curves
}

fn curves(complex: &Complex, arms: &[u32]) -> Vec<u16> {
    let mut curves: Vec<u16> =
        arms.iter().flat_map(|&arm| complex.nodes[arm as usize].curves.iter().copied()).collect();
    curves.sort_unstable();
    curves.dedup();
    curves
}

/// A vertex of a settled leaf: where two components of one curve cross it has a singular point.
fn vertex(complex: &Complex, kind: VertexKind, arms: &[u32], area: [Interval; 2]) -> Vertex {
    let curves = curves(complex, arms);
    let of = |arm: u32| &complex.nodes[arm as usize].curves;
    // Arms of the two components alternate.
    let itself = kind == VertexKind::Crossing && of(arms[0]).iter().any(|curve| of(arms[1]).contains(curve));
    let kind = if itself { VertexKind::Singular } else { kind };
    Vertex { kind, area, proved: true, curves, note: None }
}

/// Narrows the vertices of settled leaves, all together.
fn locate(fields: &Fields, complex: &mut Complex, pending: &[Pending]) -> u64 {
    let pair = |pending: &Pending| Pair { functions: pending.functions, area: complex.cells[pending.cell].boxes[0] };
    let mut pairs: Vec<Pair> = pending.iter().map(pair).collect();
    let evaluations = refine(fields, &mut pairs);
    for (Pending { cell, block, .. }, pair) in pending.iter().zip(pairs) {
        if let Some(vertex) = &mut complex.cells[*cell].blocks[*block].vertex {
            vertex.area = pair.area;
        }
    }
    evaluations
}
