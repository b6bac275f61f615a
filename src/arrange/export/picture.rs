//! The picture of an arrangement: faces, edges, vertices and what is unresolved, in a frame with equal axes.

use std::collections::HashMap;

use crate::arrange::complex::Axis;
use crate::arrange::complex::VertexKind;
use crate::arrange::export::Traced;
use crate::arrange::export::drawing::Anchor;
use crate::arrange::export::drawing::Color;
use crate::arrange::export::drawing::Drawing;
use crate::arrange::export::drawing::Layer;
use crate::arrange::export::drawing::Mark;
use crate::arrange::export::drawing::Point;
use crate::arrange::export::drawing::Shape;
use crate::arrange::export::letters;
use crate::arrange::export::summary;
use crate::arrange::export::summary::Summary;
use crate::arrange::structure::ArrangedVertex;
use crate::arrange::structure::EdgeKind;
use crate::arrange::structure::Face;
use crate::arrange::structure::Sign;
use crate::interval::Interval;
use crate::interval::decimal;

/// What a picture shows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Style {
    /// Pixels across and down.
    pub size: (u32, u32),
    /// Whether the subdivision is drawn.
    pub boxes: bool,
}

impl Default for Style {
    fn default() -> Self {
        Self { size: (960, 800), boxes: false }
    }
}

const INK: Color = [40, 42, 48];
const PALE: Color = [120, 124, 132];
const PAPER: Color = [255, 255, 255];
const GRID: Color = [176, 180, 188];
/// The colour of all that is unknown, as in the certainty layer of pictures.
const UNKNOWN: Color = [213, 94, 0];
const UNKNOWN_FACE: Color = [226, 226, 226];

/// Colours of curves that stay apart for people with any colour vision (after Okabe and Ito 2008), without the one of the
/// unknown.
const CURVES: [Color; 7] =
    [[0, 114, 178], [0, 140, 100], [180, 80, 150], [110, 90, 40], [60, 150, 215], [215, 150, 0], [90, 70, 190]];

/// Pictures smaller than this have no letters.
const ROOMY: u32 = 240;

/// Names and signs that are listed before the rest is only counted.
const LISTED: usize = 12;
const LONGEST_NAME: usize = 22;

/// Points of a line nearer than this to the one before are left out, in pixels.
const STEP: f64 = 0.2;

/// The picture.
pub(super) fn draw(traced: Traced<'_>, style: &Style) -> Drawing {
    let legend = legend(traced);
    let canvas = Canvas::new(traced, style, &legend);
    let mut layers = vec![Layer { name: "faces", marks: canvas.faces() }];
    if style.boxes {
        layers.push(Layer { name: "boxes", marks: canvas.boxes() });
    }
    layers.extend([
        Layer { name: "edges", marks: canvas.edges() },
        Layer { name: "unresolved", marks: canvas.unresolved() },
        Layer { name: "vertices", marks: canvas.vertices() },
        Layer { name: "frame", marks: canvas.frame() },
        Layer { name: "labels", marks: canvas.labels(&legend) },
    ]);
    Drawing { width: style.size.0, height: style.size.1, layers }
}

/// Where everything goes.
struct Canvas<'a> {
    traced: Traced<'a>,
    /// Pixels of the domain's upper left corner.
    corner: Point,
    /// Pixels of one unit.
    scale: f64,
    /// Size of marks: 1 in a picture of 800 pixels.
    unit: f64,
    letters: Option<f64>,
}

/// A line of the legend.
enum Entry {
    Curve(usize, String),
    Vertices(VertexKind, String),
    More(String),
}

impl Entry {
    fn text(&self) -> &str {
        match self {
            Entry::Curve(_, text) | Entry::Vertices(_, text) | Entry::More(text) => text,
        }
    }
}

fn legend(traced: Traced<'_>) -> Vec<Entry> {
    let names = &traced.arrangement.curves;
    let mut entries: Vec<Entry> =
        names.iter().take(LISTED).enumerate().map(|(index, name)| Entry::Curve(index, shortened(name))).collect();
    if names.len() > LISTED {
        entries.push(Entry::More(format!("and {} more curves", names.len() - LISTED)));
    }
    let vertices = Summary::new(traced.arrangement).vertices;
    let present = vertices.rows().into_iter().filter(|(_, _, count)| *count > 0);
    entries.extend(present.map(|(kind, name, count)| Entry::Vertices(kind, format!("{name} ({count})"))));
    entries
}

fn shortened(name: &str) -> String {
    if name.chars().count() <= LONGEST_NAME {
        return name.to_owned();
    }
    name.chars().take(LONGEST_NAME - 1).chain(['…']).collect()
}

impl<'a> Canvas<'a> {
    fn new(traced: Traced<'a>, style: &Style, legend: &[Entry]) -> Self {
        let [width, height] = [style.size.0, style.size.1].map(f64::from);
        let smaller = style.size.0.min(style.size.1);
        let unit = (f64::from(smaller) / 800.0).clamp(0.4, 8.0);
        let letters = (smaller >= ROOMY).then_some((12.0 * unit).max(9.0));
        let ranges = traced.arrangement.domain;
        let extents = ranges.map(|range| range.width().max(f64::MIN_POSITIVE));
        let edge = 6.0 * unit;
        let (mut left, mut right, mut top, mut bottom) = (edge, edge, edge, edge);
        if let Some(size) = letters {
            let widest = |texts: &mut dyn Iterator<Item = String>| {
                texts.map(|text| letters::width(size, &text)).fold(0.0, f64::max)
            };
            left += 8.0 * unit + widest(&mut ticks(ranges[1]).into_iter().map(|(_, text)| text));
            right += 3.5 * size + widest(&mut legend.iter().map(|entry| entry.text().to_owned()));
            top += 0.5 * size;
            bottom += 4.2 * size;
        }
        let room = [width - left - right, height - top - bottom].map(|room| room.max(1.0));
        let scale = (room[0] / extents[0]).min(room[1] / extents[1]);
        let corner = [left, top + 0.5 * (room[1] - scale * extents[1])];
        Self { traced, corner, scale, unit, letters }
    }

    fn pixel(&self, [x, y]: [f64; 2]) -> Point {
        let [horizontal, vertical] = self.traced.arrangement.domain;
        [self.corner[0] + self.scale * (x - horizontal.lo()), self.corner[1] + self.scale * (vertical.hi() - y)]
    }

    /// A line in pixels, with no more points than show.
    fn line(&self, points: &[[f64; 2]]) -> Vec<Point> {
        let mut line: Vec<Point> = Vec::new();
        for (index, &point) in points.iter().enumerate() {
            let [x, y] = self.pixel(point);
            let near = line.last().is_some_and(|[px, py]| (x - px).abs().max((y - py).abs()) < STEP);
            if !near || index + 1 == points.len() {
                line.push([x, y]);
            }
        }
        line
    }

    fn rectangle(&self, [x, y]: [Interval; 2]) -> Vec<Point> {
        [[x.lo(), y.lo()], [x.hi(), y.lo()], [x.hi(), y.hi()], [x.lo(), y.hi()]].map(|corner| self.pixel(corner)).to_vec()
    }

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
            let rings = rings.iter().map(|ring| self.line(ring)).collect();
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
        if let Some(area) = self.traced.areas.get(index) {
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
            ends.map(|end| self.pixel(end)).to_vec()
        });
        vec![Mark::stroked(Shape::Lines(sides.collect()), GRID, 0.6 * self.unit)]
    }

    /// Where several curves run together, they take turns in dashes.
    fn edges(&self) -> Vec<Mark> {
        let mut marks = Vec::new();
        let width = 2.2 * self.unit;
        for (index, edge) in self.traced.arrangement.edges.iter().enumerate() {
            if edge.kind != EdgeKind::Curve {
                continue;
            }
            let line = self.line(&self.traced.lines[index]);
            let proved = if edge.proved { "" } else { ", not proved" };
            let title = format!("edge {index} of {}{proved}", self.traced.names(&edge.curves));
            for (turn, &curve) in edge.curves.iter().enumerate() {
                let shape = Shape::Lines(vec![line.clone()]);
                let mark = Mark::stroked(shape, curve_color(curve.into()), width).titled(title.clone());
                let (count, dash) = (edge.curves.len() as f64, 9.0 * self.unit);
                marks.push(match turn {
                    0 => mark,
                    _ => mark.dashed([dash * (count - turn as f64), dash * (count + turn as f64)]),
                });
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
                let boxes = cell.boxes.iter().map(|area| self.rectangle(*area));
                marks.extend(boxes.map(|corners| Mark::filled(Shape::Area(vec![corners]), UNKNOWN)));
            }
        }
        for (edge, line) in arrangement.edges.iter().zip(self.traced.lines) {
            if edge.kind == EdgeKind::Strip || !edge.proved {
                let (width, dash) = (1.4 * self.unit, [2.0 * self.unit, 5.0 * self.unit]);
                marks.push(Mark::stroked(Shape::Lines(vec![self.line(line)]), UNKNOWN, width).dashed(dash));
            }
        }
        let open = arrangement.vertices.iter().filter(|vertex| !vertex.vertex.proved);
        for ArrangedVertex { vertex, .. } in open {
            // Seen however small it is.
            let centre = self.pixel(vertex.area.map(Interval::mid));
            let reach = 0.5 * self.scale * vertex.area[0].width().hypot(vertex.area[1].width());
            let shape = Shape::Disc { centre, radius: (reach + 4.0 * self.unit).max(9.0 * self.unit) };
            marks.push(Mark::stroked(shape, UNKNOWN, 2.4 * self.unit));
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
        let kind = summary::kind(vertex.kind);
        let names = self.traced.names(&vertex.curves);
        let mut title = format!("vertex {index}: {kind}, {proved}\n{names}\nx in {x}\ny in {y}");
        if let Some(note) = &vertex.note {
            title += &format!("\n{note}");
        }
        self.symbol(vertex.kind, self.pixel(vertex.area.map(Interval::mid))).titled(title)
    }

    /// The mark of a kind of vertex.
    fn symbol(&self, kind: VertexKind, centre: Point) -> Mark {
        let disc = |radius: f64| Shape::Disc { centre, radius: radius * self.unit };
        let thin = 1.3 * self.unit;
        let corners = |offsets: [[f64; 2]; 4]| {
            let [x, y] = centre;
            Shape::Area(vec![offsets.map(|[dx, dy]| [x + dx * self.unit, y + dy * self.unit]).to_vec()])
        };
        let square = |half: f64| corners([[-half, -half], [half, -half], [half, half], [-half, half]]);
        let diamond = |half: f64| corners([[0.0, -half], [half, 0.0], [0.0, half], [-half, 0.0]]);
        match kind {
            VertexKind::Crossing => Mark::filled(disc(3.4), INK),
            VertexKind::Tangency => Mark::outlined(disc(4.0), PAPER, INK, 1.8 * self.unit),
            VertexKind::Singular => Mark::outlined(diamond(6.2), [250, 214, 70], INK, thin),
            VertexKind::End => Mark::outlined(square(3.4), PAPER, INK, thin),
            VertexKind::Boundary | VertexKind::Corner => Mark::filled(square(2.6), PALE),
            VertexKind::Loop => Mark::outlined(disc(2.8), PAPER, PALE, thin),
            VertexKind::Cluster => Mark::outlined(square(3.6), UNKNOWN, INK, thin),
        }
    }

    fn frame(&self) -> Vec<Mark> {
        let domain = self.traced.arrangement.domain;
        let mut marks = vec![Mark::stroked(Shape::Area(vec![self.rectangle(domain)]), PALE, self.unit)];
        let length = 5.0 * self.unit;
        let below = ticks(domain[0]).into_iter().map(|(x, _)| {
            let [x, y] = self.pixel([x, domain[1].lo()]);
            vec![[x, y], [x, y + length]]
        });
        let beside = ticks(domain[1]).into_iter().map(|(y, _)| {
            let [x, y] = self.pixel([domain[0].lo(), y]);
            vec![[x, y], [x - length, y]]
        });
        marks.push(Mark::stroked(Shape::Lines(below.chain(beside).collect()), PALE, self.unit));
        marks
    }

    fn labels(&self, legend: &[Entry]) -> Vec<Mark> {
        let Some(size) = self.letters else { return Vec::new() };
        let domain = self.traced.arrangement.domain;
        let write = |at: Point, anchor: Anchor, text: String| Mark::filled(Shape::Text { at, anchor, size, text }, INK);
        let mut marks = Vec::new();
        for (x, text) in ticks(domain[0]) {
            let [x, y] = self.pixel([x, domain[1].lo()]);
            marks.push(write([x, y + 7.0 * self.unit + size], Anchor::Middle, text));
        }
        for (y, text) in ticks(domain[1]) {
            let [x, y] = self.pixel([domain[0].lo(), y]);
            marks.push(write([x - 8.0 * self.unit, y + 0.36 * size], Anchor::End, text));
        }
        let [left, bottom] = self.pixel([domain[0].lo(), domain[1].lo()]);
        marks.push(write([left, bottom + 7.0 * self.unit + 2.8 * size], Anchor::Start, caption(self.traced)));
        let [mut x, mut y] = self.pixel([domain[0].hi(), domain[1].hi()]);
        (x, y) = (x + 1.2 * size, y + 0.8 * size);
        let mut curves = true;
        for entry in legend {
            if curves && matches!(entry, Entry::Vertices(..)) {
                curves = false;
                y += 0.7 * size;
            }
            let middle = y - 0.36 * size;
            match entry {
                Entry::Curve(index, _) => {
                    let line = vec![[x - 0.5 * size, middle], [x + 0.7 * size, middle]];
                    marks.push(Mark::stroked(Shape::Lines(vec![line]), curve_color(*index), 2.6 * self.unit));
                }
                Entry::Vertices(kind, _) => marks.push(self.symbol(*kind, [x + 0.1 * size, middle])),
                Entry::More(_) => {}
            }
            marks.push(write([x + 1.2 * size, y], Anchor::Start, entry.text().to_owned()));
            y += 1.6 * size;
        }
        marks
    }
}

fn caption(traced: Traced<'_>) -> String {
    let summary = Summary::new(traced.arrangement);
    let Summary { edges, faces, .. } = summary;
    let proved = if summary.proved { "all proved" } else { "not all proved" };
    format!("{} vertices, {edges} edges, {faces} faces: {proved}", summary.vertices.total())
}

/// An interval with its bounds as shortest decimals.
fn range(interval: Interval) -> String {
    format!("[{}, {}]", decimal(interval.lo()), decimal(interval.hi()))
}

fn curve_color(index: usize) -> Color {
    match CURVES.get(index) {
        Some(color) => *color,
        None => hue(index, 0.42, 0.62),
    }
}

fn tint(index: usize) -> Color {
    hue(index, if index.is_multiple_of(2) { 0.93 } else { 0.89 }, 0.55)
}

/// Colours one after the other around the wheel by the golden angle, of a given lightness and saturation (HSL).
fn hue(index: usize, lightness: f64, saturation: f64) -> Color {
    let turn = (0.58 + index as f64 * 0.618_033_988_749_895).fract();
    let reach = saturation * lightness.min(1.0 - lightness);
    [0.0, 8.0, 4.0].map(|shift| {
        let k = (shift + 12.0 * turn) % 12.0;
        let part = lightness - reach * (k - 3.0).min(9.0 - k).clamp(-1.0, 1.0);
        (255.0 * part).round() as u8
    })
}

/// Round numbers in a range with their texts.
fn ticks(range: Interval) -> Vec<(f64, String)> {
    let length = range.width() / 6.0;
    if !(length > 0.0 && length < f64::INFINITY) {
        return Vec::new();
    }
    let power = 10f64.powf(length.log10().floor());
    let step = [1.0, 2.0, 5.0].into_iter().find(|factor| factor * power >= 0.7 * length).unwrap_or(10.0) * power;
    let places = (-(step * 1.000_001).log10().floor()).clamp(0.0, 17.0) as usize;
    let (first, last) = ((range.lo() / step).ceil(), (range.hi() / step).floor());
    let plain = range.mag() < 1e7 && step > 1e-9;
    let count = (last - first).clamp(-1.0, 20.0) as i64;
    let values = (0..=count).map(|index| (first + index as f64) * step + 0.0);
    values.map(|value| (value, if plain { format!("{value:.places$}") } else { format!("{value:e}") })).collect()
}
