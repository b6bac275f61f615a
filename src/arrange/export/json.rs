//! The whole structure as JSON; `docs/arrangement-format.md` describes it.

use serde::Serialize;
use serde::Serializer;

use crate::arrange::check::Summary;
use crate::arrange::complex::Effort;
use crate::arrange::complex::VertexKind;
use crate::arrange::export::Traced;
use crate::arrange::structure::EdgeKind;
use crate::arrange::structure::Sign;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::interval::Interval;

/// Names the format and its version.
const FORMAT: &str = "imp-arrangement-1";

#[derive(Serialize)]
struct Document<'a> {
    format: &'static str,
    domain: [Range; 2],
    curves: &'a [String],
    summary: &'a Summary,
    effort: Effort,
    vertices: Vec<Vertex<'a>>,
    halfedges: Vec<Halfedge>,
    edges: Vec<Edge<'a>>,
    faces: Vec<Face<'a>>,
}

/// Bounds, each the shortest decimal that reads back exactly.
type Range = [Number; 2];

fn range(interval: Interval) -> Range {
    [interval.lo(), interval.hi()].map(Number)
}

/// JSON has no infinite numbers; they become `"inf"` and `"-inf"`.
#[derive(Clone, Copy)]
struct Number(f64);

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.0.is_finite() {
            serializer.serialize_f64(self.0)
        } else {
            serializer.serialize_str(&self.0.to_string())
        }
    }
}

#[derive(Serialize)]
struct Vertex<'a> {
    kind: VertexKind,
    proved: bool,
    #[serde(rename = "box")]
    area: [Range; 2],
    curves: &'a [u16],
    halfedge: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    face: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    note: Option<&'a str>,
}

#[derive(Serialize)]
struct Halfedge {
    origin: u32,
    next: u32,
    previous: u32,
    twin: u32,
    face: u32,
}

#[derive(Serialize)]
struct Edge<'a> {
    kind: EdgeKind,
    curves: &'a [u16],
    proved: bool,
    /// One box around each cell that the edge passes, in order.
    boxes: Vec<[Range; 2]>,
    line: Vec<[Number; 2]>,
}

#[derive(Serialize)]
struct Face<'a> {
    outer: Option<u32>,
    holes: &'a [u32],
    isolated: &'a [u32],
    bounded: bool,
    signs: &'a [Sign],
    sample: Option<[Number; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    area: Option<Range>,
}

/// The smallest box around boxes: a cluster has many, and many edges.
fn hull(boxes: &[[Interval; 2]]) -> [Interval; 2] {
    boxes.iter().fold([Interval::EMPTY; 2], |hull, area| [hull[0].hull(area[0]), hull[1].hull(area[1])])
}

/// The structure as one JSON object.
///
/// # Errors
/// If it has no JSON form: our mistake.
pub fn json(traced: Traced<'_>) -> Result<String, Diagnostic> {
    let arrangement = traced.arrangement;
    let vertices = arrangement.vertices.iter().map(|arranged| Vertex {
        kind: arranged.vertex.kind,
        proved: arranged.vertex.proved,
        area: arranged.vertex.area.map(range),
        curves: &arranged.vertex.curves,
        halfedge: arranged.halfedge,
        face: arranged.face,
        note: arranged.vertex.note.as_deref(),
    });
    let halfedges = arrangement.halfedges.iter().enumerate().map(|(index, halfedge)| Halfedge {
        origin: halfedge.origin,
        next: halfedge.next,
        previous: halfedge.previous,
        twin: index as u32 ^ 1,
        face: halfedge.face,
    });
    let edges = arrangement.edges.iter().zip(traced.lines).map(|(edge, line)| Edge {
        kind: edge.kind,
        curves: &edge.curves,
        proved: edge.proved,
        boxes: edge
            .cells
            .iter()
            .map(|&cell| hull(&arrangement.complex.cells[cell as usize].boxes).map(range))
            .collect(),
        line: line.iter().map(|point| point.map(Number)).collect(),
    });
    let faces = arrangement.faces.iter().enumerate().map(|(index, face)| Face {
        outer: face.outer,
        holes: &face.holes,
        isolated: &face.isolated,
        bounded: face.bounded,
        signs: &face.signs,
        sample: face.sample.map(|point| point.map(Number)),
        area: traced.areas.get(index).copied().flatten().map(range),
    });
    let document = Document {
        format: FORMAT,
        domain: arrangement.domain.map(range),
        curves: &arrangement.curves,
        summary: traced.summary,
        effort: arrangement.complex.effort,
        vertices: vertices.collect(),
        halfedges: halfedges.collect(),
        edges: edges.collect(),
        faces: faces.collect(),
    };
    serde_json::to_string(&document)
        .map(|text| text + "\n")
        .map_err(|error| Diagnostic::error(code::INTERNAL, format!("cannot write the arrangement as JSON: {error}")))
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use super::*;
    use crate::arrange::export::samples::sample;

    #[test]
    fn numbers_read_back_exactly_and_indices_fit() {
        let sample = sample();
        let value: Value = serde_json::from_str(&json(sample.traced()).unwrap()).unwrap();
        assert_eq!(value["format"], FORMAT);
        let vertices = value["vertices"].as_array().unwrap();
        for (vertex, arranged) in vertices.iter().zip(&sample.arrangement.vertices) {
            for (axis, side) in arranged.vertex.area.iter().enumerate() {
                let bounds = [0, 1].map(|end| vertex["box"][axis][end].as_f64().unwrap().to_bits());
                assert_eq!(bounds, [side.lo().to_bits(), side.hi().to_bits()]);
            }
        }
        let halfedges = value["halfedges"].as_array().unwrap();
        for (index, halfedge) in halfedges.iter().enumerate() {
            let at = |name: &str| &halfedges[halfedge[name].as_u64().unwrap() as usize];
            assert_eq!(at("next")["previous"], index);
            assert_eq!(at("twin")["twin"], index);
            assert_eq!(at("next")["origin"], at("twin")["origin"]);
        }
        let counts = [vertices.len(), halfedges.len(), value["edges"].as_array().unwrap().len()];
        assert_eq!(counts, [12, 30, 15]);
        assert_eq!(value["summary"]["vertices"]["loop"], 0);
        assert_eq!(value["summary"]["faces"], 6);
        assert_eq!(value["faces"][3]["signs"][1], "negative");
    }

    #[test]
    fn infinite_bounds_are_texts() {
        assert_eq!(serde_json::to_string(&range(Interval::ENTIRE)).unwrap(), r#"["-inf","inf"]"#);
    }
}
