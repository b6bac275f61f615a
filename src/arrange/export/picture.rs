//! The picture of an arrangement: faces, edges, vertices and what is unresolved.

use std::collections::HashMap;

use crate::arrange::check::Summary;
use crate::arrange::complex::Axis;
use crate::arrange::complex::VertexKind;
use crate::arrange::export::Traced;
use crate::arrange::export::canvas::Canvas;
use crate::arrange::export::canvas::Entry;
use crate::arrange::export::canvas::LISTED;
use crate::arrange::export::canvas::Style;
use crate::arrange::export::canvas::Symbol;
use crate::arrange::export::canvas::UNKNOWN;
use crate::arrange::export::canvas::curve_color;
use crate::arrange::export::canvas::tint;
use crate::arrange::export::drawing::Color;
use crate::arrange::export::drawing::Drawing;
use crate::arrange::export::drawing::Layer;
use crate::arrange::export::drawing::Mark;
use crate::arrange::export::drawing::Shape;
use crate::arrange::export::kind;
use crate::arrange::export::kinds;
use crate::arrange::structure::ArrangedVertex;
use crate::arrange::structure::EdgeKind;
use crate::arrange::structure::Face;
use crate::arrange::structure::Sign;
use crate::interval::Interval;
use crate::interval::decimal;

const GRID: Color = [176, 180, 188];
const UNKNOWN_FACE: Color = [226, 226, 226];

/// The picture, in the layers `faces`, `boxes`, `edges`, `unresolved`, `vertices`, `frame` and `labels`.
pub fn draw(traced: Traced<'_>, style: &Style) -> Drawing {
    let legend = legend(traced);
    let canvas = Canvas::new(traced.arrangement.domain, style, &legend);
    let painter = Painter { traced, canvas };
    let mut layers = vec![Layer { name: "faces", marks: painter.faces() }];
    if style.boxes {
        layers.push(Layer { name: "boxes", marks: painter.boxes() });
    }
    layers.extend([
        Layer { name: "edges", marks: painter.edges() },
        Layer { name: "unresolved", marks: painter.unresolved() },
        Layer { name: "vertices", marks: painter.vertices() },
        Layer { name: "frame", marks: painter.canvas.frame() },
        Layer { name: "labels", marks: painter.canvas.labels(&legend, caption(traced)) },
    ]);
    Drawing { width: style.size.0, height: style.size.1, layers }
}

fn legend(traced: Traced<'_>) -> Vec<Entry> {
    let mut entries = Entry::curves(&traced.arrangement.curves);
    for (of, count) in kinds(&traced.summary.vertices).into_iter().filter(|(_, count)| *count > 0) {
        entries.push(Entry { symbol: Symbol::Vertex(of), text: format!("{} ({count})", kind(of)) });
    }
    entries
}

struct Painter<'a> {
    traced: Traced<'a>,
    canvas: Canvas,
}

impl Painter<'_> {
    /// Faces with the same signs have the same colour.
    fn faces(&self) -> Vec<Mark> {
        let mut colors: HashMap<&[Sign], usize> = HashMap::new();
        let mut marks = Vec::new();
        for ((index, face), rings) in self.traced.arrangement.faces.iter().enumerate().zip(self.traced.rings()) {
            if rings.is_empty() {
                continue;
            }
            let next = colors.len();
            let color = match face.signs.contains(&Sign::Unknown) {
                true => UNKNOWN_FACE,
                false => tint(*colors.entry(&face.signs).or_insert(next)),
            };
            let rings = rings.iter().map(|ring| self.canvas.line(ring)).collect();
            marks.push(Mark::filled(Shape::Area(rings), color).titled(self.face_title(index, face)));
        }
        marks
    }

    fn face_title(&self, index: usize, face: &Face) -> String {
        let names = &self.traced.arrangement.curves;
        let signs = face.signs.iter().zip(names).take(LISTED).map(|(sign, name)| match sign {
            Sign::Negative => format!("{name} < 0"),
            Sign::Positive => format!("{name} > 0"),
            Sign::Unknown => format!("{name} unknown"),
        });
        let mut lines = vec![format!("face {index}{}", if face.bounded { "" } else { ", cut by the frame" })];
        lines.extend(signs);
        if names.len() > LISTED {
            lines.push(format!("and {} more curves", names.len() - LISTED));
        }
        if let Some(Some(area)) = self.traced.areas.get(index) {
            lines.push(format!("area in {}", range(*area)));
        }
        lines.join("\n")
    }

    /// The sides of all cells.
    fn boxes(&self) -> Vec<Mark> {
        let sides = self.traced.arrangement.complex.segments.iter().filter(|segment| !segment.frame).map(|segment| {
            let ends = match segment.axis {
                Axis::X => [[segment.from, segment.at], [segment.to, segment.at]],
                Axis::Y => [[segment.at, segment.from], [segment.at, segment.to]],
            };
            ends.map(|end| self.canvas.pixel(end)).to_vec()
        });
        vec![Mark::stroked(Shape::Lines(sides.collect()), GRID, 0.6 * self.canvas.unit)]
    }

    /// Where several curves run together, they take turns in dashes.
    fn edges(&self) -> Vec<Mark> {
        let mut marks = Vec::new();
        let width = 2.2 * self.canvas.unit;
        for (index, edge) in self.traced.arrangement.edges.iter().enumerate() {
            if edge.kind != EdgeKind::Curve {
                continue;
            }
            let line = self.canvas.line(&self.traced.lines[index]);
            let proved = if edge.proved { "" } else { ", not proved" };
            let title = format!("edge {index} of {}{proved}", self.traced.names(&edge.curves));
            for (turn, &curve) in edge.curves.iter().enumerate() {
                let shape = Shape::Lines(vec![line.clone()]);
                let mark = Mark::stroked(shape, curve_color(curve.into()), width).titled(title.clone());
                let rest = (edge.curves.len() - turn) as f64;
                let dash = 10.0 * self.canvas.unit;
                marks.push(if turn == 0 { mark } else { mark.dashed([dash * rest, dash * turn as f64]) });
            }
        }
        marks
    }

    fn unresolved(&self) -> Vec<Mark> {
        let arrangement = self.traced.arrangement;
        let mut marks = Vec::new();
        for cell in &arrangement.complex.cells {
            let open = cell.blocks.iter().filter_map(|block| block.vertex.as_ref()).any(|vertex| !vertex.proved);
            if open {
                let boxes = cell.boxes.iter().map(|area| self.canvas.rectangle(*area));
                marks.extend(boxes.map(|corners| Mark::filled(Shape::Area(vec![corners]), UNKNOWN)));
            }
        }
        for (edge, line) in arrangement.edges.iter().zip(self.traced.lines) {
            // Other edges are proved but for their ends, which have marks of their own.
            if edge.kind == EdgeKind::Strip {
                let (width, dash) = (1.4 * self.canvas.unit, [2.0 * self.canvas.unit, 5.0 * self.canvas.unit]);
                marks.push(Mark::stroked(Shape::Lines(vec![self.canvas.line(line)]), UNKNOWN, width).dashed(dash));
            }
        }
        let open = arrangement.vertices.iter().filter(|vertex| !vertex.vertex.proved);
        for ArrangedVertex { vertex, .. } in open {
            // Seen however small it is.
            let centre = self.canvas.pixel(vertex.area.map(Interval::mid));
            let reach = 0.5 * self.canvas.scale * vertex.area[0].width().hypot(vertex.area[1].width());
            let shape = Shape::Disc { centre, radius: (reach + 4.0 * self.canvas.unit).max(9.0 * self.canvas.unit) };
            marks.push(Mark::stroked(shape, UNKNOWN, 2.4 * self.canvas.unit));
        }
        marks
    }

    fn vertices(&self) -> Vec<Mark> {
        let vertices = self.traced.arrangement.vertices.iter().enumerate();
        let shown = vertices.filter(|(_, vertex)| vertex.vertex.kind != VertexKind::Corner);
        shown.map(|(index, vertex)| self.vertex(index, vertex)).collect()
    }

    fn vertex(&self, index: usize, ArrangedVertex { vertex, .. }: &ArrangedVertex) -> Mark {
        let [x, y] = vertex.area.map(range);
        let proved = if vertex.proved { "proved" } else { "not proved" };
        let name = kind(vertex.kind);
        let names = self.traced.names(&vertex.curves);
        let mut title = format!("vertex {index}: {name}, {proved}\n{names}\nx in {x}\ny in {y}");
        if let Some(note) = &vertex.note {
            title += &format!("\n{note}");
        }
        self.canvas.symbol(vertex.kind, self.canvas.pixel(vertex.area.map(Interval::mid))).titled(title)
    }
}

fn caption(traced: Traced<'_>) -> String {
    let Summary { vertices, edges, faces, proved, .. } = traced.summary;
    let count: u64 = kinds(vertices).iter().map(|(_, count)| count).sum();
    let proved = if *proved { "all proved" } else { "not all proved" };
    format!("{count} vertices, {edges} edges, {faces} faces: {proved}")
}

/// An interval with its bounds as shortest decimals.
fn range(interval: Interval) -> String {
    format!("[{}, {}]", decimal(interval.lo()), decimal(interval.hi()))
}
