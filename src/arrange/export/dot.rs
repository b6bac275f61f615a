//! Graphs in the language of Graphviz: vertices and edges, or faces and which of them share an edge.

use std::collections::BTreeMap;
use std::fmt::Write;

use crate::arrange::complex::VertexKind;
use crate::arrange::export::Traced;
use crate::arrange::export::kind;
use crate::arrange::structure::EdgeKind;
use crate::arrange::structure::Sign;

/// Vertices at their places, and edges; without the frame. `neato -n` keeps the places.
pub fn graph(traced: Traced<'_>) -> String {
    let arrangement = traced.arrangement;
    let mut text = "graph arrangement {\n  node [shape=point];\n".to_owned();
    // Graphviz counts in points, 72 to an inch; ten inches across.
    let [horizontal, vertical] = arrangement.domain;
    let scale = 720.0 / horizontal.width().max(vertical.width());
    for (index, vertex) in arrangement.vertices.iter().enumerate() {
        let vertex = &vertex.vertex;
        if vertex.kind == VertexKind::Corner {
            continue;
        }
        let [x, y] = traced.place(index as u32);
        let at = [scale * (x - horizontal.lo()), scale * (y - vertical.lo())];
        let (name, curves) = (kind(vertex.kind), quoted(&traced.names(&vertex.curves)));
        writeln!(
            text,
            "  v{index} [pos=\"{:.3},{:.3}!\", kind={name}, proved={}, curves={curves}];",
            at[0], at[1], vertex.proved
        )
        .expect("a string takes all text");
    }
    for (index, edge) in arrangement.edges.iter().enumerate() {
        if edge.kind == EdgeKind::Frame {
            continue;
        }
        let [from, to] = traced.ends(index);
        let curves = quoted(&traced.names(&edge.curves));
        writeln!(text, "  v{from} -- v{to} [id=e{index}, curves={curves}, proved={}];", edge.proved)
            .expect("a string takes all text");
    }
    text + "}\n"
}

/// Faces, and for each two that share edges one line with the curves between them.
pub fn dual(traced: Traced<'_>) -> String {
    let arrangement = traced.arrangement;
    let mut text = "graph faces {\n".to_owned();
    for (index, face) in arrangement.faces.iter().enumerate().skip(1) {
        let signs: String = face.signs.iter().map(|sign| symbol(*sign)).collect();
        writeln!(text, "  f{index} [signs=\"{signs}\", bounded={}];", face.bounded).expect("a string takes all text");
    }
    let mut between: BTreeMap<[u32; 2], Vec<u16>> = BTreeMap::new();
    for (edge, sides) in arrangement.edges.iter().zip(arrangement.halfedges.chunks_exact(2)) {
        let mut faces = [sides[0].face, sides[1].face];
        faces.sort_unstable();
        if edge.kind != EdgeKind::Frame && faces[0] != faces[1] {
            between.entry(faces).or_default().extend(&edge.curves);
        }
    }
    for ([a, b], mut curves) in between {
        curves.sort_unstable();
        curves.dedup();
        writeln!(text, "  f{a} -- f{b} [curves={}];", quoted(&traced.names(&curves))).expect("a string takes all text");
    }
    text + "}\n"
}

fn symbol(sign: Sign) -> char {
    match sign {
        Sign::Negative => '-',
        Sign::Positive => '+',
        Sign::Unknown => '?',
    }
}

/// A text in quotes, in which Graphviz wants only quotes escaped.
fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\\\""))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arrange::export::samples::sample;

    #[test]
    fn graphs_have_what_the_arrangement_has() {
        let text = graph(sample().traced());
        assert_eq!([text.matches("pos=").count(), text.matches(" -- ").count()], [8, 9]);
        assert!(text.contains("v10 -- v10 [id=e13, curves=\"circle <1>\", proved=true];"));
        let text = dual(sample().traced());
        assert_eq!([text.matches("signs=").count(), text.matches(" -- ").count()], [6, 6]);
        assert!(text.contains("f1 -- f2 [curves=\"line, copy\"];"), "{text}");
        assert_eq!(quoted("a\"b"), "\"a\\\"b\"");
    }
}
