//! Where a picture's parts go: the domain in a frame with equal axes and ticks, a legend beside it, a caption below.

use crate::arrange::complex::VertexKind;
use crate::arrange::export::drawing::Anchor;
use crate::arrange::export::drawing::Color;
use crate::arrange::export::drawing::Mark;
use crate::arrange::export::drawing::Point;
use crate::arrange::export::drawing::Shape;
use crate::arrange::export::letters;
use crate::interval::Interval;

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

pub const INK: Color = [40, 42, 48];
pub const PALE: Color = [120, 124, 132];
pub const PAPER: Color = [255, 255, 255];
/// The colour of all that is unknown, as in the certainty layer of pictures.
pub const UNKNOWN: Color = [213, 94, 0];

/// Pictures smaller than this have no letters.
const ROOMY: u32 = 240;

/// Names and signs that are listed before the rest is only counted.
pub const LISTED: usize = 12;
const LONGEST_NAME: usize = 22;

/// Points of a line nearer than this to the one before are left out, in pixels.
const STEP: f64 = 0.2;

/// A line of the legend.
pub struct Entry {
    pub symbol: Symbol,
    pub text: String,
}

#[derive(Clone, Copy)]
pub enum Symbol {
    Line(Color),
    Area(Color),
    Vertex(VertexKind),
    None,
}

impl Entry {
    /// The first of a scene's curves by name.
    pub fn curves(names: &[String]) -> Vec<Self> {
        let listed = names.iter().take(LISTED).enumerate();
        let mut entries: Vec<Self> = listed
            .map(|(index, name)| Self { symbol: Symbol::Line(curve_color(index)), text: shortened(name) })
            .collect();
        if names.len() > LISTED {
            entries.push(Self { symbol: Symbol::None, text: format!("and {} more curves", names.len() - LISTED) });
        }
        entries
    }
}

fn shortened(name: &str) -> String {
    if name.chars().count() <= LONGEST_NAME {
        return name.to_owned();
    }
    name.chars().take(LONGEST_NAME - 1).chain(['…']).collect()
}

pub struct Canvas {
    domain: [Interval; 2],
    /// Pixels of the domain's upper left corner.
    corner: Point,
    /// Pixels of one unit.
    pub scale: f64,
    /// Size of marks: 1 in a picture of 800 pixels.
    pub unit: f64,
    letters: Option<f64>,
}

impl Canvas {
    pub fn new(domain: [Interval; 2], style: &Style, legend: &[Entry]) -> Self {
        let [width, height] = [style.size.0, style.size.1].map(f64::from);
        let smaller = style.size.0.min(style.size.1);
        let unit = (f64::from(smaller) / 800.0).clamp(0.4, 8.0);
        let letters = (smaller >= ROOMY).then_some((12.0 * unit).max(9.0));
        let extents = domain.map(|range| range.width().max(f64::MIN_POSITIVE));
        let edge = 6.0 * unit;
        let (mut left, mut right, mut top, mut bottom) = (edge, edge, edge, edge);
        if let Some(size) = letters {
            let widest = |texts: &mut dyn Iterator<Item = String>| {
                texts.map(|text| letters::width(size, &text)).fold(0.0, f64::max)
            };
            left += 8.0 * unit + widest(&mut ticks(domain[1]).into_iter().map(|(_, text)| text));
            right += 3.5 * size + widest(&mut legend.iter().map(|entry| entry.text.clone()));
            top += 0.5 * size;
            bottom += 4.2 * size;
        }
        let room = [width - left - right, height - top - bottom].map(|room| room.max(1.0));
        let scale = (room[0] / extents[0]).min(room[1] / extents[1]);
        let corner = [left, top + 0.5 * (room[1] - scale * extents[1])];
        Self { domain, corner, scale, unit, letters }
    }

    pub fn pixel(&self, [x, y]: [f64; 2]) -> Point {
        let [horizontal, vertical] = self.domain;
        [self.corner[0] + self.scale * (x - horizontal.lo()), self.corner[1] + self.scale * (vertical.hi() - y)]
    }

    /// A line in pixels, with no more points than show.
    pub fn line(&self, points: &[[f64; 2]]) -> Vec<Point> {
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

    pub fn rectangle(&self, [x, y]: [Interval; 2]) -> Vec<Point> {
        [[x.lo(), y.lo()], [x.hi(), y.lo()], [x.hi(), y.hi()], [x.lo(), y.hi()]]
            .map(|corner| self.pixel(corner))
            .to_vec()
    }

    /// The mark of a kind of vertex.
    pub fn symbol(&self, kind: VertexKind, centre: Point) -> Mark {
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

    pub fn frame(&self) -> Vec<Mark> {
        let domain = self.domain;
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

    pub fn labels(&self, legend: &[Entry], caption: String) -> Vec<Mark> {
        let Some(size) = self.letters else { return Vec::new() };
        let domain = self.domain;
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
        marks.push(write([left, bottom + 7.0 * self.unit + 2.8 * size], Anchor::Start, caption));
        let [mut x, mut y] = self.pixel([domain[0].hi(), domain[1].hi()]);
        (x, y) = (x + 1.2 * size, y + 0.8 * size);
        let mut curves = true;
        for entry in legend {
            if curves && matches!(entry.symbol, Symbol::Vertex(_)) {
                curves = false;
                y += 0.7 * size;
            }
            let middle = y - 0.36 * size;
            match entry.symbol {
                Symbol::Line(color) => {
                    let line = vec![[x - 0.5 * size, middle], [x + 0.7 * size, middle]];
                    marks.push(Mark::stroked(Shape::Lines(vec![line]), color, 2.6 * self.unit));
                }
                Symbol::Area(color) => {
                    let [left, right, above, below] =
                        [x - 0.4 * size, x + 0.6 * size, middle - 0.5 * size, middle + 0.5 * size];
                    let corners = vec![[left, above], [right, above], [right, below], [left, below]];
                    marks.push(Mark::outlined(Shape::Area(vec![corners]), color, PALE, 0.8 * self.unit));
                }
                Symbol::Vertex(kind) => marks.push(self.symbol(kind, [x + 0.1 * size, middle])),
                Symbol::None => {}
            }
            marks.push(write([x + 1.2 * size, y], Anchor::Start, entry.text.clone()));
            y += 1.6 * size;
        }
        marks
    }
}

/// Colours of curves that stay apart for people with any colour vision (after Okabe and Ito 2008), without the one of the
/// unknown.
pub const CURVES: [Color; 7] =
    [[0, 114, 178], [0, 140, 100], [180, 80, 150], [110, 90, 40], [60, 150, 215], [215, 150, 0], [90, 70, 190]];

pub fn curve_color(index: usize) -> Color {
    match CURVES.get(index) {
        Some(color) => *color,
        None => hue(index, 0.42, 0.62),
    }
}

/// Quiet colours for areas.
pub fn tint(index: usize) -> Color {
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
