//! Faces, edges and vertices as GeoJSON (RFC 7946). Positions are coordinates of the plane, not longitudes and latitudes:
//! the format knows no others, and readers take them as they are.

use geojson::Feature;
use geojson::FeatureCollection;
use geojson::GeometryValue;
use geojson::feature::Id;
use serde_json::Value;
use serde_json::json;

use crate::arrange::complex::VertexKind;
use crate::arrange::export::Traced;
use crate::arrange::export::rings::Ring;
use crate::arrange::structure::EdgeKind;

/// Everything but the frame, as one FeatureCollection: faces as polygons with holes, edges as lines, vertices as points.
pub fn geojson(traced: Traced<'_>) -> String {
    let mut features = faces(traced);
    features.extend(edges(traced));
    features.extend(vertices(traced));
    FeatureCollection { bbox: None, features, foreign_members: None }.to_string() + "\n"
}

fn feature(id: String, geometry: Option<GeometryValue>, properties: Value) -> Feature {
    let properties = match properties {
        Value::Object(properties) => Some(properties),
        _ => None,
    };
    Feature {
        bbox: None,
        geometry: geometry.map(Into::into),
        id: Some(Id::String(id)),
        properties,
        foreign_members: None,
    }
}

fn faces(traced: Traced<'_>) -> Vec<Feature> {
    let faces = traced.arrangement.faces.iter().zip(traced.rings()).enumerate().skip(1);
    let features = faces.map(|(index, (face, rings))| {
        let properties = json!({
            "is": "face",
            "bounded": face.bounded,
            "signs": face.signs,
            "sample": face.sample,
        });
        // Three different points make a polygon; a face whose picture has fewer is listed without one.
        let outline = rings.first().is_some_and(|ring| ring.len() > 2);
        let rings = rings.into_iter().filter(|ring| ring.len() > 2).map(closed);
        feature(format!("f{index}"), outline.then(|| GeometryValue::new_polygon(rings)), properties)
    });
    features.collect()
}

/// The first point is repeated at the end.
fn closed(mut ring: Ring) -> Ring {
    ring.extend(ring.first().copied());
    ring
}

fn edges(traced: Traced<'_>) -> Vec<Feature> {
    let edges = traced.arrangement.edges.iter().zip(traced.lines).enumerate();
    let shown = edges.filter(|(_, (edge, _))| edge.kind != EdgeKind::Frame);
    let features = shown.map(|(index, (edge, line))| {
        let [from, to] = traced.ends(index);
        let properties = json!({
            "is": "edge",
            "kind": edge.kind,
            "curves": curves(traced, &edge.curves),
            "proved": edge.proved,
            "from": format!("v{from}"),
            "to": format!("v{to}"),
        });
        feature(format!("e{index}"), Some(GeometryValue::new_line_string(line.iter().copied())), properties)
    });
    features.collect()
}

fn vertices(traced: Traced<'_>) -> Vec<Feature> {
    let vertices = traced.arrangement.vertices.iter().map(|arranged| &arranged.vertex).enumerate();
    let shown = vertices.filter(|(_, vertex)| vertex.kind != VertexKind::Corner);
    let features = shown.map(|(index, vertex)| {
        let [x, y] = vertex.area;
        let mut properties = json!({
            "is": "vertex",
            "kind": vertex.kind,
            "curves": curves(traced, &vertex.curves),
            "proved": vertex.proved,
            "box": [[x.lo(), x.hi()], [y.lo(), y.hi()]],
        });
        if let Some(note) = &vertex.note {
            properties["note"] = json!(note);
        }
        let at = traced.place(index as u32);
        feature(format!("v{index}"), Some(GeometryValue::new_point(at)), properties)
    });
    features.collect()
}

fn curves<'a>(traced: Traced<'a>, curves: &[u16]) -> Vec<&'a str> {
    curves.iter().map(|&curve| traced.arrangement.curves[usize::from(curve)].as_str()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arrange::export::samples::sample;

    #[test]
    fn what_is_written_reads_back_and_winds_as_asked() {
        let text = geojson(sample().traced());
        let read: FeatureCollection = text.parse::<geojson::GeoJson>().unwrap().try_into().unwrap();
        let of = |what: &str| -> Vec<&Feature> {
            read.features.iter().filter(|feature| feature.property("is") == Some(&json!(what))).collect()
        };
        assert_eq!([of("face").len(), of("edge").len(), of("vertex").len()], [6, 9, 8]);
        for feature in of("face") {
            let Some(GeometryValue::Polygon { coordinates }) = feature.geometry.as_ref().map(|g| &g.value) else {
                panic!("{feature:?}");
            };
            for (index, ring) in coordinates.iter().enumerate() {
                assert_eq!(ring.first(), ring.last());
                // RFC 7946, 3.1.6: outer rings counter-clockwise, holes clockwise.
                let doubled: f64 = ring.windows(2).map(|ends| ends[0][0] * ends[1][1] - ends[1][0] * ends[0][1]).sum();
                assert_eq!(doubled > 0.0, index == 0, "{:?}", feature.id);
            }
        }
        let cluster = of("vertex").into_iter().find(|v| v.property("proved") == Some(&json!(false))).unwrap();
        assert_eq!(cluster.property("note"), Some(&json!("open at \"epsilon\" <1e-6>")));
    }
}
