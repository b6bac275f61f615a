//! Arrangements of lines and circles whose figures are known by hand.

use std::collections::BTreeMap;

use crate::arrange::build::build;
use crate::arrange::build::toy::Curve::Circle;
use crate::arrange::build::toy::Curve::Line;
use crate::arrange::build::toy::Toy;
use crate::arrange::check::Counts;
use crate::arrange::check::check;
use crate::arrange::complex::VertexKind;
use crate::arrange::structure::Arrangement;
use crate::arrange::structure::EdgeKind;

fn built(toy: &Toy) -> (Arrangement, Counts) {
    let arrangement = build(toy.complex()).unwrap();
    let counts = check(&arrangement).unwrap();
    (arrangement, counts)
}

/// Crossings, boundary and loop vertices, edges, faces, components.
fn figures(toy: &Toy) -> [u64; 6] {
    let counts = built(toy).1;
    let kinds = counts.vertices;
    assert!(counts.proved);
    [kinds.crossing, kinds.boundary, kinds.closed, counts.edges, counts.faces, counts.components]
}

#[test]
fn situations_known_by_hand() {
    assert_eq!(figures(&Toy::default()), [0, 0, 0, 0, 1, 0]);
    assert_eq!(figures(&Toy::of(&[])), [0, 0, 0, 0, 1, 0]);
    for levels in 0..4 {
        assert_eq!(figures(&Toy { levels, ..Toy::of(&[Line(1.0, 2.0, 0.3)]) }), [0, 2, 0, 1, 2, 1]);
        assert_eq!(
            figures(&Toy { levels, ..Toy::of(&[Line(1.0, 2.0, 0.3), Line(1.0, -1.0, 0.1)]) }),
            [1, 4, 0, 4, 4, 1]
        );
    }
    let ring = Circle(0.1, 0.05, 0.7);
    assert_eq!(figures(&Toy::of(&[ring])), [0, 0, 1, 1, 2, 1]);
    assert_eq!(figures(&Toy::of(&[Circle(-0.2, 0.0, 0.5), Circle(0.2, 0.1, 0.5)])), [2, 0, 0, 4, 4, 1]);
    assert_eq!(figures(&Toy::of(&[ring, Circle(0.1, 0.05, 0.4)])), [0, 0, 2, 2, 3, 2]);
    assert_eq!(figures(&Toy::of(&[Circle(-0.5, 0.0, 0.3), Circle(0.5, 0.1, 0.3)])), [0, 0, 2, 2, 3, 2]);
    // A circle in one of the four faces of two crossing lines.
    let lines = [Line(1.0, 0.1, 0.03), Line(0.1, 1.0, 0.07)];
    assert_eq!(figures(&Toy::of(&[lines[0], lines[1], Circle(0.5, 0.5, 0.3)])), [1, 4, 1, 5, 5, 2]);
    // A circle that the frame cuts in four places.
    assert_eq!(figures(&Toy::of(&[Circle(0.9, 0.9, 0.5)])), [0, 2, 0, 1, 2, 1]);
    assert_eq!(figures(&Toy::of(&[Circle(0.1, 0.02, 1.2)])), [0, 8, 0, 4, 5, 4]);
    assert_eq!(figures(&Toy::of(&[Circle(0.0, 0.0, 2.0)])), [0, 0, 0, 0, 1, 0]);
}

#[test]
fn nested_circles_nest() {
    let circles: Vec<_> = (1..8).map(|k| Circle(0.05, 0.03, 0.12 * f64::from(k))).collect();
    let (arrangement, counts) = built(&Toy::of(&circles));
    assert_eq!((counts.faces, counts.components, counts.vertices.closed), (8, 7, 7));
    let rings = arrangement.faces.iter().filter(|face| face.bounded && face.holes.len() == 1).count();
    let discs = arrangement.faces.iter().filter(|face| face.bounded && face.holes.is_empty()).count();
    assert_eq!((rings, discs), (6, 1));
    let outermost = arrangement.faces.iter().skip(1).find(|face| !face.bounded).unwrap();
    assert_eq!(outermost.holes.len(), 1);
}

#[test]
fn an_isolated_point_in_a_ring() {
    let toy =
        Toy { points: vec![[0.1, 0.55]], levels: 5, ..Toy::of(&[Circle(0.1, 0.05, 0.7), Circle(0.1, 0.05, 0.3)]) };
    let (arrangement, counts) = built(&toy);
    assert_eq!((counts.faces, counts.isolated, counts.components, counts.vertices.singular), (3, 1, 3, 1));
    assert_eq!(counts.degrees, BTreeMap::from([(0, 1)]));
    let face = arrangement.faces.iter().find(|face| !face.isolated.is_empty()).unwrap();
    assert!(face.bounded && face.holes.len() == 1);
}

#[test]
fn an_unresolved_ring_has_a_hole() {
    let ring = Some(([0.0, 0.0], 0.3, 0.7));
    let alone = Toy { ring, levels: 4, ..Toy::default() };
    let (arrangement, counts) = built(&alone);
    assert_eq!((counts.vertices.cluster, counts.edges, counts.faces, counts.proved), (1, 1, 2, false));
    assert_eq!(arrangement.edges.iter().filter(|edge| edge.kind == EdgeKind::Strip).count(), 1);
    // A line through the ring and its hole: two arms outwards, and one edge that crosses the hole from arm to arm.
    let crossed = Toy { curves: vec![Line(1.0, 0.2, 0.03)], ..alone.clone() };
    let counts = built(&crossed).1;
    assert_eq!((counts.vertices.cluster, counts.vertices.boundary, counts.edges, counts.faces), (1, 2, 4, 4));
    // Three arms inwards and more outwards, with a circle in the hole.
    let curves = vec![Line(1.0, 0.2, 0.03), Line(0.3, 1.0, -0.02), Circle(0.02, 0.01, 0.11)];
    let counts = built(&Toy { curves, levels: 5, ..alone.clone() }).1;
    assert_eq!((counts.vertices.crossing, counts.vertices.boundary, counts.proved), (5, 4, false));
    // In the hole 4 + 4 + 4 edges, outwards 4, one strip; in the hole 4 faces in the circle and 4 around, outside 4.
    assert_eq!((counts.edges, counts.faces), (17, 12));
    // A circle half in the hole and half in the ring, so that no arm leads outwards.
    let counts = built(&Toy { curves: vec![Circle(0.3, 0.01, 0.15)], levels: 5, ..alone.clone() }).1;
    assert_eq!((counts.faces, counts.components, counts.edges), (3, 1, 2));
    // A ring that turns out to be empty, or to hold just a point.
    let mut complex = alone.complex();
    let cell = complex.cells.iter().position(|cell| cell.boundary.len() == 2).unwrap();
    complex.cells[cell].blocks[0].vertex.as_mut().unwrap().proved = true;
    complex.cells[cell].blocks[0].vertex.as_mut().unwrap().kind = VertexKind::Singular;
    let counts = check(&build(complex.clone()).unwrap()).unwrap();
    assert_eq!((counts.isolated, counts.edges, counts.faces, counts.proved), (1, 0, 1, true));
    complex.cells[cell].blocks.clear();
    assert_eq!(check(&build(complex).unwrap()).unwrap().faces, 1);
    // A circle that only the hole sees, and one around all.
    let (curves, ring) = (vec![Circle(0.02, 0.01, 0.11), Circle(0.0, 0.0, 0.99)], Some(([0.0, 0.0], 0.3, 0.6)));
    let counts = built(&Toy { curves, levels: 5, ring, ..alone }).1;
    assert_eq!((counts.faces, counts.components, counts.edges), (4, 3, 3));
}

#[test]
fn two_holes_in_one_region() {
    // A grid whose cells but two are united.
    let toy = Toy { levels: 3, ..Toy::of(&[Line(0.02, 1.0, 0.1), Line(1.0, 0.3, 0.05)]) };
    let mut boxes = toy.leaves();
    boxes.sort_by(|a, b| (a[0].lo(), a[1].lo()).partial_cmp(&(b[0].lo(), b[1].lo())).unwrap());
    let holes = [boxes.remove(8 * 5 + 3), boxes.remove(8 + 4)];
    let mut cells = vec![boxes];
    cells.extend(holes.map(|hole| vec![hole]));
    let complex = toy.complex_of(&cells);
    assert_eq!(complex.cells[0].boundary.len(), 3);
    let counts = check(&build(complex).unwrap()).unwrap();
    assert_eq!(counts.vertices.cluster, 1);
    // Of the holes' faces each edge through a hole makes one more.
    let through = counts.edges - 2 - counts.vertices.boundary;
    assert_eq!((counts.vertices.boundary, counts.faces), (4, 4 + 2 + through));
}

#[test]
fn random_lines_have_the_faces_of_their_crossings() {
    let mut random = fastrand::Rng::with_seed(4);
    for count in [3, 10, 50] {
        let line = |_| {
            let (angle, offset) = (random.f64() * std::f64::consts::TAU, random.f64() * 0.8);
            Line(angle.cos(), angle.sin(), offset)
        };
        let toy = Toy::of(&(0..count).map(line).collect::<Vec<_>>());
        let crossings = toy.crossings().len() as u64;
        let (arrangement, counts) = built(&toy);
        assert_eq!(counts.vertices.cluster, 0);
        assert_eq!((counts.vertices.crossing, counts.vertices.boundary), (crossings, 2 * count));
        assert_eq!((counts.faces, counts.edges), (1 + count + crossings, count + 2 * crossings));
        // The sample point of each face lies on its own combination of sides.
        let sides = |[x, y]: [f64; 2]| -> Vec<bool> {
            toy.curves.iter().map(|&line| matches!(line, Line(a, b, c) if a * x + b * y > c)).collect()
        };
        let samples: Vec<_> = arrangement.faces.iter().filter_map(|face| face.sample).collect();
        let mut signs: Vec<_> = samples.into_iter().map(sides).collect();
        signs.sort();
        signs.dedup();
        assert_eq!(signs.len() as u64, counts.faces);
    }
}

#[test]
fn random_circles_keep_euler() {
    let mut random = fastrand::Rng::with_seed(5);
    for _ in 0..20 {
        let mut circle = |_| {
            let r = 0.15 + random.f64() * 0.4;
            Circle((random.f64() * 2.0 - 1.0) * (0.99 - r), (random.f64() * 2.0 - 1.0) * (0.99 - r), r)
        };
        let toy = Toy { levels: 4, ..Toy::of(&(0..8).map(&mut circle).collect::<Vec<_>>()) };
        let crossings = toy.crossings().len() as u64;
        let (_, counts) = built(&toy);
        assert_eq!((counts.vertices.cluster, counts.vertices.crossing), (0, crossings));
        assert_eq!(counts.edges, 2 * crossings + counts.vertices.closed);
        assert_eq!(counts.faces, 1 + crossings + counts.components);
    }
}

#[test]
fn edges_name_their_nodes_and_cells() {
    let (arrangement, _) =
        built(&Toy { levels: 4, ..Toy::of(&[Circle(-0.2, 0.0, 0.5), Line(1.0, 0.2, 0.03), Circle(0.7, 0.7, 0.1)]) });
    for (e, edge) in arrangement.edges.iter().enumerate().filter(|(_, edge)| edge.kind == EdgeKind::Curve) {
        let ends = [arrangement.halfedges[2 * e].origin, arrangement.halfedges[2 * e + 1].origin];
        let kind = |v: u32| arrangement.vertices[v as usize].vertex.kind;
        let on_node = ends.iter().filter(|&&v| matches!(kind(v), VertexKind::Boundary | VertexKind::Loop)).count();
        assert_eq!(edge.cells.len() + on_node, edge.nodes.len() + 1);
        assert!(edge.proved);
        for node in &edge.nodes {
            assert_eq!(arrangement.node_edges[*node as usize], e as u32);
            // On both sides of a node are the two faces of its edge.
            let segment = arrangement.complex.nodes[*node as usize].segment;
            let k = arrangement.complex.segments[segment as usize].nodes.iter().position(|n| n == node).unwrap();
            let mut beside = [k, k + 1].map(|gap| arrangement.gaps.face(segment, gap));
            let mut faces = [0, 1].map(|side| arrangement.halfedges[2 * e + side].face);
            beside.sort_unstable();
            faces.sort_unstable();
            assert_eq!(beside, faces);
        }
    }
}

#[test]
fn broken_complexes_are_faults() {
    let toy = Toy { levels: 2, ..Toy::of(&[Line(1.0, 0.2, 0.03), Line(0.3, 1.0, -0.02)]) };
    let good = toy.complex();
    let arcs = good.cells.iter().position(|cell| cell.blocks.iter().any(|block| block.vertex.is_none())).unwrap();
    let crossing = good.cells.iter().position(|cell| cell.blocks.iter().any(|block| block.vertex.is_some())).unwrap();
    let mut broken = vec![good.clone(); 7];
    broken[0].cells[arcs].blocks.clear();
    broken[1].cells[arcs].blocks[0].nodes.pop();
    broken[2].cells[arcs].boundary[0].pop();
    broken[3].nodes[0].component = 7;
    broken[4].segments.iter_mut().find(|segment| segment.frame).unwrap().at = 0.5;
    let parts = broken[5].cells[crossing].blocks[0].nodes.clone();
    let arc = broken[1].cells[arcs].blocks[0].clone();
    broken[5].cells[crossing].blocks = [[0, 2], [1, 3]]
        .map(|pair| crate::arrange::complex::Block { nodes: pair.map(|k| parts[k]).to_vec(), ..arc.clone() })
        .to_vec();
    broken[6].cells[arcs].boundary.clear();
    for (i, broken) in broken.into_iter().enumerate() {
        assert!(build(broken).is_err(), "{i}");
    }
    let mut arrangement = build(good).unwrap();
    arrangement.halfedges.swap(0, 1);
    assert!(check(&arrangement).is_err());
}
