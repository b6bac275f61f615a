//! The stretches of an arrangement's edges, one for each cell that an edge passes.

use std::collections::HashMap;

use crate::arrange::complex::Axis;
use crate::arrange::complex::Cell;
use crate::arrange::field::Function;
use crate::arrange::geometry::arc::Arc;
use crate::arrange::geometry::arc::Body;
use crate::arrange::geometry::arc::Rect;
use crate::arrange::geometry::arc::hull;
use crate::arrange::geometry::arc::slopes;
use crate::arrange::geometry::refine::Chain;
use crate::arrange::geometry::refine::Evaluate;
use crate::arrange::geometry::refine::enclose;
use crate::arrange::structure::Arrangement;
use crate::arrange::structure::Edge;
use crate::arrange::structure::EdgeKind;
use crate::arrange::structure::Site;
use crate::interval::Interval;

/// A point that an edge passes, with the node that it is.
type Station = (Rect, Option<u32>);

/// The box of a node.
pub fn place(arrangement: &Arrangement, node: u32) -> Rect {
    let node = &arrangement.complex.nodes[node as usize];
    let segment = &arrangement.complex.segments[node.segment as usize];
    match segment.axis {
        Axis::X => [node.place, Interval::point(segment.at)],
        Axis::Y => [Interval::point(segment.at), node.place],
    }
}

/// The least box that holds a cell.
fn around(cell: &Cell) -> Rect {
    cell.boxes.iter().fold([Interval::EMPTY; 2], |all, part| hull(&all, part))
}

/// The points between which an edge passes its cells, one more than those; `None` if the two do not match.
fn stations(arrangement: &Arrangement, index: usize, edge: &Edge) -> Option<Vec<Station>> {
    // A vertex on a node is the first or the last of them already.
    let inner = |side: usize| {
        let vertex = &arrangement.vertices[arrangement.halfedges[2 * index + side].origin as usize];
        matches!(vertex.site, Site::Block { .. }).then_some((vertex.vertex.area, None))
    };
    let nodes = edge.nodes.iter().map(|&node| (place(arrangement, node), Some(node)));
    let stations: Vec<Station> = inner(0).into_iter().chain(nodes).chain(inner(1)).collect();
    (stations.len() == edge.cells.len() + 1).then_some(stations)
}

/// The stretches of all edges, by edge; `functions` are those of the components. Empty where an edge has no known course.
pub fn trace(arrangement: &Arrangement, functions: &[Function], evaluate: &Evaluate) -> Vec<Chain> {
    let mut chains: Vec<Chain> = Vec::with_capacity(arrangement.edges.len());
    for (index, edge) in arrangement.edges.iter().enumerate() {
        chains.push(match edge.kind {
            EdgeKind::Frame => {
                let ends = [0, 1].map(|side| arrangement.halfedges[2 * index + side].origin as usize);
                vec![Arc::straight(ends.map(|end| arrangement.vertices[end].vertex.area))]
            }
            EdgeKind::Curve => hidden(arrangement, functions, index, edge).unwrap_or_default(),
            EdgeKind::Strip => Chain::new(),
        });
    }
    reveal(arrangement, &mut chains, evaluate);
    chains
}

/// The stretches of an edge before anything is sampled.
fn hidden(arrangement: &Arrangement, functions: &[Function], index: usize, edge: &Edge) -> Option<Chain> {
    let function = *functions.get(edge.component as usize)?;
    let stations = stations(arrangement, index, edge)?;
    let pairs = stations.windows(2).zip(&edge.cells);
    Some(
        pairs
            .map(|(pair, &cell)| {
                let body = Body::Hidden {
                    cell,
                    hull: around(&arrangement.complex.cells[cell as usize]),
                    nodes: [pair[0].1, pair[1].1],
                    longest: f64::INFINITY,
                };
                Arc { function, ends: [pair[0].0, pair[1].0], body, fixed: true }
            })
            .collect(),
    )
}

/// Finds out which stretches are graphs.
///
/// Take the strip of a rectangular cell above the interval `T` between the two ends' coordinates `t`. If f is strictly
/// monotone along its fibres, then the stretch is a graph over `T`: it is a simple curve within the cell, and to leave the
/// strip it would have to pass the fibre of its last point before its end, or that of its first point again; but this
/// point is the only zero there.
fn reveal(arrangement: &Arrangement, chains: &mut [Chain], evaluate: &Evaluate) {
    let mut asked = Vec::new();
    let mut queries = Vec::new();
    for (chain, place) in chains.iter().enumerate().flat_map(|(i, chain)| (0..chain.len()).map(move |k| (i, k))) {
        let arc = &chains[chain][place];
        let Body::Hidden { cell, hull: room, .. } = arc.body else { continue };
        if let [whole] = arrangement.complex.cells[cell as usize].boxes[..] {
            let ends = hull(&arc.ends[0], &arc.ends[1]);
            queries.extend([[ends[0], room[1]], [room[0], ends[1]], whole].map(|strip| (arc.function, strip)));
            asked.push((chain, place));
        }
    }
    let samples = evaluate(&queries);
    let mut found = Vec::new();
    for (&(chain, place), three) in asked.iter().zip(samples.chunks_exact(3)) {
        let arc = &mut chains[chain][place];
        let Body::Hidden { cell, hull: room, nodes, ref mut longest } = arc.body else { continue };
        // A graph over the whole side of the cell is not longer than this, nor is a part of it.
        for (side, slope) in room.iter().zip(slopes(&three[2])) {
            let stretch = slope.map(|slope| Interval::ONE.hypot(Interval::point(slope.mag())));
            let bound = stretch.map(|stretch| (Interval::point(side.width()) * stretch).hi());
            *longest = bound.map_or(*longest, |bound| longest.min(bound));
        }
        let mut ways: Vec<(usize, Interval)> =
            (0..2).filter_map(|axis| Some((axis, slopes(&three[axis])[axis]?))).collect();
        ways.sort_by(|a, b| a.1.mag().total_cmp(&b.1.mag()));
        if ways.is_empty()
            && let Some(axis) = claimed(&arrangement.complex.cells[cell as usize], nodes)
        {
            ways.push((axis, Interval::ENTIRE));
        }
        if let Some(&(axis, slope)) = ways.first() {
            let body = Body::Graph { axis, reach: room[1 - axis], slope };
            found.push(((chain, place), Arc { body, fixed: false, ..arc.clone() }));
        }
    }
    // Areas go around a vertex whose arms are not all known.
    let mut arms: HashMap<u32, usize> = HashMap::new();
    for &(place, _) in &found {
        for vertex in inner(arrangement, chains, place) {
            *arms.entry(vertex).or_default() += 1;
        }
    }
    let mut all: HashMap<u32, usize> = HashMap::new();
    for &place in &asked {
        for vertex in inner(arrangement, chains, place) {
            *all.entry(vertex).or_default() += 1;
        }
    }
    found.retain(|&(place, _)| {
        let known = |vertex: u32| arrangement.vertices[vertex as usize].vertex.proved && arms[&vertex] == all[&vertex];
        inner(arrangement, chains, place).into_iter().all(known)
    });
    let (places, mut arcs): (Vec<_>, Vec<_>) = found.into_iter().unzip();
    enclose(&mut arcs, evaluate);
    for ((chain, place), arc) in places.into_iter().zip(arcs) {
        chains[chain][place] = arc;
    }
}

/// The vertices within a cell at which a stretch starts or ends.
fn inner(arrangement: &Arrangement, chains: &[Chain], (chain, place): (usize, usize)) -> Vec<u32> {
    let Body::Hidden { nodes, .. } = chains[chain][place].body else { return Vec::new() };
    let sides = (0..2).filter(|&side| nodes[side].is_none());
    sides.map(|side| arrangement.halfedges[2 * chain + side].origin).collect()
}

/// The coordinate of which the curve between two nodes of a cell is a function by construction.
fn claimed(cell: &Cell, nodes: [Option<u32>; 2]) -> Option<usize> {
    let [Some(a), Some(b)] = nodes else { return None };
    let block = cell.blocks.iter().find(|block| block.nodes.contains(&a) && block.nodes.contains(&b))?;
    match (block.vertex.is_none(), block.axis?) {
        (true, Axis::X) => Some(0),
        (true, Axis::Y) => Some(1),
        _ => None,
    }
}
