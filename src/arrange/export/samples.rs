//! An arrangement put together by hand from the lines of its edges, with all that files must cope with: a hole, a cycle that
//! touches itself, an edge with one face on both sides, an isolated point, a cluster, curves that run together.

use std::f64::consts::PI;

use crate::arrange::check::Summary;
use crate::arrange::check::check;
use crate::arrange::complex::Block;
use crate::arrange::complex::Cell;
use crate::arrange::complex::Complex;
use crate::arrange::complex::Effort;
use crate::arrange::complex::Vertex;
use crate::arrange::complex::VertexKind;
use crate::arrange::export::Traced;
use crate::arrange::structure::ArrangedVertex;
use crate::arrange::structure::Arrangement;
use crate::arrange::structure::Edge;
use crate::arrange::structure::EdgeKind;
use crate::arrange::structure::Face;
use crate::arrange::structure::Gaps;
use crate::arrange::structure::Halfedge;
use crate::arrange::structure::Sign;
use crate::arrange::structure::Site;
use crate::interval::Interval;

/// The arrangement and the lines of its edges.
pub struct Sample {
    pub summary: Summary,
    pub arrangement: Arrangement,
    pub lines: Vec<Vec<[f64; 2]>>,
}

impl Sample {
    pub fn traced(&self) -> Traced<'_> {
        Traced { arrangement: &self.arrangement, summary: &self.summary, lines: &self.lines, areas: &[] }
    }
}

fn box_around([x, y]: [f64; 2], reach: f64) -> [Interval; 2] {
    [x, y].map(|c| Interval::new(c - reach, c + reach).unwrap())
}

fn arc([x, y]: [f64; 2], radius: f64, from: f64, to: f64) -> Vec<[f64; 2]> {
    (0..=40)
        .map(|i| from + (to - from) * f64::from(i) / 40.0)
        .map(|a| [x + radius * a.cos(), y + radius * a.sin()])
        .collect()
}

/// Faces: 1 above the line around everything, 2 below it, 3 and 4 the halves of the first circle, 5 between the two circles
/// Vertices, kind, curves and polyline of an edge.
type Drawn = ([u32; 2], EdgeKind, Vec<u16>, Vec<[f64; 2]>);

/// that touch, 6 inside the inner one.
pub fn sample() -> Sample {
    let kinds = [
        (VertexKind::Corner, [0.0, 0.0]),
        (VertexKind::Corner, [10.0, 0.0]),
        (VertexKind::Corner, [10.0, 8.0]),
        (VertexKind::Corner, [0.0, 8.0]),
        (VertexKind::Boundary, [0.0, 2.0]),
        (VertexKind::Boundary, [10.0, 2.0]),
        (VertexKind::Crossing, [1.0, 2.0]),
        (VertexKind::Crossing, [4.0, 2.0]),
        (VertexKind::Cluster, [2.5, 3.5]),
        (VertexKind::End, [2.5, 6.0]),
        (VertexKind::Tangency, [9.0, 5.0]),
        (VertexKind::Singular, [5.0, 7.0]),
    ];
    let curve = EdgeKind::Curve;
    let (frame, c) = (EdgeKind::Frame, [2.5, 2.0]);
    let edges: Vec<Drawn> = vec![
        ([0, 1], frame, vec![], vec![[0.0, 0.0], [10.0, 0.0]]),
        ([1, 5], frame, vec![], vec![[10.0, 0.0], [10.0, 2.0]]),
        ([5, 2], frame, vec![], vec![[10.0, 2.0], [10.0, 8.0]]),
        ([2, 3], frame, vec![], vec![[10.0, 8.0], [0.0, 8.0]]),
        ([3, 4], frame, vec![], vec![[0.0, 8.0], [0.0, 2.0]]),
        ([4, 0], frame, vec![], vec![[0.0, 2.0], [0.0, 0.0]]),
        ([4, 6], curve, vec![0], vec![[0.0, 2.0], [1.0, 2.0]]),
        ([6, 7], curve, vec![0], vec![[1.0, 2.0], [4.0, 2.0]]),
        ([7, 5], curve, vec![0, 3], vec![[4.0, 2.0], [10.0, 2.0]]),
        ([7, 8], curve, vec![1], arc(c, 1.5, 0.0, 0.5 * PI)),
        ([8, 6], curve, vec![1], arc(c, 1.5, 0.5 * PI, PI)),
        ([6, 7], curve, vec![1], arc(c, 1.5, PI, 2.0 * PI)),
        ([8, 9], curve, vec![2], vec![[2.5, 3.5], [2.7, 4.5], [2.5, 6.0]]),
        ([10, 10], curve, vec![1], arc([7.0, 5.0], 2.0, 0.0, 2.0 * PI)),
        ([10, 10], curve, vec![2], arc([8.0, 5.0], 1.0, 0.0, 2.0 * PI)),
    ];
    // The face to the left of each even halfedge, and of each odd one.
    let sides: [[u32; 2]; 15] = [
        [2, 0],
        [2, 0],
        [1, 0],
        [1, 0],
        [1, 0],
        [2, 0],
        [1, 2],
        [3, 4],
        [1, 2],
        [3, 1],
        [3, 1],
        [4, 2],
        [1, 1],
        [5, 1],
        [6, 5],
    ];
    let next: [[u32; 2]; 15] = [
        [2, 11],
        [17, 1],
        [6, 3],
        [8, 5],
        [12, 7],
        [0, 9],
        [21, 10],
        [18, 22],
        [4, 23],
        [20, 16],
        [14, 24],
        [15, 13],
        [25, 19],
        [29, 27],
        [28, 26],
    ];
    let mut halfedges = vec![Halfedge { origin: 0, next: 0, previous: 0, face: 0 }; 2 * edges.len()];
    for (edge, (ends, ..)) in edges.iter().enumerate() {
        for side in 0..2 {
            let halfedge = &mut halfedges[2 * edge + side];
            (halfedge.origin, halfedge.next, halfedge.face) = (ends[side], next[edge][side], sides[edge][side]);
            halfedges[next[edge][side] as usize].previous = (2 * edge + side) as u32;
        }
    }
    let vertex = |kind, at| Vertex {
        kind,
        area: box_around(at, if kind == VertexKind::Cluster { 0.1 } else { 1e-12 }),
        proved: kind != VertexKind::Cluster,
        curves: vec![0, 1],
        note: (kind == VertexKind::Cluster).then(|| "open at \"epsilon\" <1e-6>".to_owned()),
    };
    let halfedge_at = |id: u32| halfedges.iter().position(|h| h.origin == id).map(|index| index as u32);
    let vertices: Vec<ArrangedVertex> = (0u32..)
        .zip(kinds)
        .map(|(id, (kind, at))| {
            let halfedge = halfedge_at(id);
            ArrangedVertex {
                vertex: vertex(kind, at),
                site: Site::Corner,
                halfedge,
                face: halfedge.is_none().then_some(1),
            }
        })
        .collect();
    let face = |outer: Option<u32>, holes: Vec<u32>, bits: u32| Face {
        outer,
        holes,
        isolated: if outer == Some(4) { vec![11] } else { vec![] },
        bounded: !matches!(outer, None | Some(0 | 4)),
        signs: (0..4).map(|bit| if bits >> bit & 1 == 1 { Sign::Negative } else { Sign::Positive }).collect(),
        sample: outer.map(|_| [1.0, 1.0]),
    };
    let mut faces = vec![
        face(None, vec![1], 0),
        face(Some(4), vec![27], 0),
        face(Some(0), vec![], 1),
        face(Some(14), vec![], 2),
        face(Some(15), vec![], 3),
        face(Some(26), vec![], 4),
        face(Some(28), vec![], 6),
    ];
    faces[0].signs = vec![Sign::Unknown; 4];
    let cluster = Block { nodes: vec![], vertex: Some(vertices[8].vertex.clone()), axis: None };
    let complex = Complex {
        domain: [Interval::new(0.0, 10.0).unwrap(), Interval::new(0.0, 8.0).unwrap()],
        curves: ["line", "circle <1>", "arc & co", "copy"].map(str::to_owned).to_vec(),
        segments: vec![],
        nodes: vec![],
        cells: vec![Cell { boxes: vec![box_around([2.5, 3.5], 0.1)], boundary: vec![], blocks: vec![cluster] }],
        effort: Effort { boxes: 345, evaluations: 6789, exact: 1, settled: 0 },
    };
    let lines = edges.iter().map(|(.., line)| line.clone()).collect();
    let edges = edges.into_iter().map(|(_, kind, curves, _)| Edge {
        kind,
        component: 0,
        curves,
        proved: true,
        nodes: vec![],
        cells: vec![],
    });
    let arrangement = Arrangement {
        domain: complex.domain,
        curves: complex.curves.clone(),
        vertices,
        halfedges,
        edges: edges.collect(),
        faces,
        proved: false,
        complex,
        gaps: Gaps::default(),
        node_edges: vec![],
        milliseconds: 1.5,
    };
    let summary = Summary::new(&arrangement, &check(&arrangement).unwrap());
    Sample { arrangement, summary, lines }
}
