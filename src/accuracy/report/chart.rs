//! Charts of time against error as SVG: both axes logarithmic, the Pareto front drawn and labelled.

use std::error::Error;
use std::sync::Once;

use plotters::coord::Shift;
use plotters::coord::ranged1d::KeyPointHint;
use plotters::coord::ranged1d::NoDefaultFormatting;
use plotters::coord::ranged1d::ValueFormatter;
use plotters::prelude::*;

/// Pixels of one chart; an SVG scales to whatever room there is.
const SIZE: (u32, u32) = (1080, 520);
/// The strip of the legend at the right.
const LEGEND: u32 = 190;
/// The letters, and about how wide one is.
const LETTERS: f64 = 12.0;
const LETTER_WIDTH: f64 = 6.6;
const FONT: &str = "sans-serif";

/// Colours that stay apart for people with any colour vision (after Okabe and Ito 2008, and darker ones of the same hues).
const COLORS: [RGBColor; 12] = [
    RGBColor(0, 114, 178),
    RGBColor(86, 180, 233),
    RGBColor(0, 60, 110),
    RGBColor(213, 94, 0),
    RGBColor(230, 159, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(120, 94, 40),
    RGBColor(90, 90, 90),
    RGBColor(140, 20, 60),
    RGBColor(110, 80, 180),
    RGBColor(20, 100, 70),
];

/// The shape of a series' points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Marker {
    Circle,
    Square,
    Triangle,
    Diamond,
}

impl Marker {
    /// A shape for a series by its place.
    pub fn of(index: usize) -> Self {
        [Marker::Square, Marker::Triangle, Marker::Diamond][index % 3]
    }
}

/// One measurement; both numbers at least 0. An x of 0 is drawn at the left edge.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    pub x: f64,
    pub y: f64,
    /// Hollow points are those that prove nothing.
    pub filled: bool,
    pub front: Option<Front>,
}

/// A place on a Pareto front.
#[derive(Debug, Clone, PartialEq)]
pub struct Front {
    /// An index into the chart's fronts.
    pub front: usize,
    /// Begins with the row's number.
    pub label: String,
}

#[derive(Debug, Clone)]
pub struct Series {
    pub name: String,
    /// An index into the colours.
    pub color: usize,
    pub marker: Marker,
    pub points: Vec<Point>,
}

#[derive(Debug, Clone)]
pub struct Chart {
    pub title: String,
    pub x: String,
    pub y: String,
    pub series: Vec<Series>,
    /// What each Pareto front is one of; at most two.
    pub fronts: Vec<String>,
}

type Failure = Box<dyn Error>;

/// The name of the font that plotters measures letters by; browsers use their own.
fn register_font() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        // Without it plotters says so when it draws.
        let _ = plotters::style::register_font(FONT, FontStyle::Normal, dejavu::sans::regular());
    });
}

impl Chart {
    /// The chart as one SVG element.
    pub fn svg(&self) -> Result<String, Failure> {
        stacked(std::slice::from_ref(self))
    }
}

/// Charts below each other in one SVG element.
pub fn stacked(charts: &[Chart]) -> Result<String, Failure> {
    register_font();
    let mut svg = String::new();
    {
        let size = (SIZE.0, SIZE.1 * charts.len().max(1) as u32);
        let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        root.fill(&WHITE)?;
        for (area, chart) in root.split_evenly((charts.len().max(1), 1)).iter().zip(charts) {
            draw(area, chart)?;
        }
        root.present()?;
    }
    Ok(svg)
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

fn draw(area: &Area, chart: &Chart) -> Result<(), Failure> {
    let (plot, legend) = area.split_horizontally(SIZE.0 - LEGEND);
    let points = || chart.series.iter().flat_map(|series| &series.points);
    let x = Axis::new(points().map(|point| point.x));
    let y = Axis::new(points().map(|point| point.y));
    let mut context = ChartBuilder::on(&plot)
        .caption(&chart.title, (FONT, 17))
        .margin(10)
        .x_label_area_size(44)
        .y_label_area_size(62)
        .build_cartesian_2d(x.clone(), y.clone())?;
    context
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(RGBColor(226, 226, 230))
        .axis_style(RGBColor(90, 90, 95))
        .label_style((FONT, LETTERS))
        .x_desc(&chart.x)
        .y_desc(&chart.y)
        .axis_desc_style((FONT, 13))
        .draw()?;
    let mut boxes: Vec<Frame> = Vec::new();
    for front in 0..chart.fronts.len() {
        let steps = staircase(chart, front, &x, &y);
        let corners: Vec<(i32, i32)> = steps.iter().map(|step| context.backend_coord(step)).collect();
        boxes.extend(corners.windows(2).map(|ends| Frame::around(ends[0], ends[1], 2)));
        context.draw_series(LineSeries::new(steps, line(front)))?;
    }
    let mut labels = Vec::new();
    for series in &chart.series {
        let color = COLORS[series.color % COLORS.len()];
        for point in &series.points {
            let at = context.backend_coord(&(x.place(point.x), y.place(point.y)));
            let reach = if point.front.is_some() { 7 } else { 4 };
            mark(&plot, at, series.marker, color, point.filled)?;
            if point.front.is_some() {
                plot.draw(&Circle::new(relative(&plot, at), reach, BLACK.stroke_width(1)))?;
            }
            boxes.push(Frame::around(at, at, reach));
            labels.extend(point.front.as_ref().map(|front| (at, front.label.as_str())));
        }
    }
    write_labels(&plot, &context.plotting_area().get_pixel_range(), labels, boxes)?;
    write_legend(&legend, chart)
}

/// A position of the whole picture as one of an area's own.
fn relative(area: &Area, (x, y): (i32, i32)) -> (i32, i32) {
    let (base_x, base_y) = area.get_base_pixel();
    (x - base_x, y - base_y)
}

/// One point of a series at a position of the whole picture.
fn mark(area: &Area, at: (i32, i32), marker: Marker, color: RGBColor, filled: bool) -> Result<(), Failure> {
    let (x, y) = relative(area, at);
    let corners: &[(i32, i32)] = match marker {
        Marker::Circle => {
            let style = if filled { color.filled() } else { color.stroke_width(1) };
            area.draw(&Circle::new((x, y), 4, style))?;
            return Ok(());
        }
        Marker::Square => &[(-4, -4), (4, -4), (4, 4), (-4, 4), (-4, -4)],
        Marker::Triangle => &[(0, -5), (5, 4), (-5, 4), (0, -5)],
        Marker::Diamond => &[(0, -5), (5, 0), (0, 5), (-5, 0), (0, -5)],
    };
    let corners: Vec<(i32, i32)> = corners.iter().map(|(dx, dy)| (x + dx, y + dy)).collect();
    if filled {
        area.draw(&Polygon::new(corners, color.filled()))?;
    } else {
        area.draw(&PathElement::new(corners, color.stroke_width(1)))?;
    }
    Ok(())
}

/// The line of a front.
fn line(front: usize) -> ShapeStyle {
    if front == 0 { RGBColor(130, 130, 135).stroke_width(2) } else { RGBColor(190, 170, 130).stroke_width(1) }
}

/// The boundary of what a front beats: from each of its points level to the next one's error.
fn staircase(chart: &Chart, front: usize, x: &Axis, y: &Axis) -> Vec<(f64, f64)> {
    let points = chart.series.iter().flat_map(|series| &series.points);
    let on_front = points.filter(|point| point.front.as_ref().is_some_and(|place| place.front == front));
    let mut front: Vec<(f64, f64)> = on_front.map(|point| (x.place(point.x), y.place(point.y))).collect();
    front.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.total_cmp(&a.1)));
    let mut steps: Vec<(f64, f64)> = Vec::new();
    for &(to, lower) in &front {
        steps.extend(steps.last().map(|&(_, upper)| (to, upper)));
        steps.push((to, lower));
    }
    // Nothing is beaten to the left of the first; to the right of the last everything slower is.
    steps.extend(front.last().map(|&(_, lower)| (x.to, lower)));
    steps
}

/// A rectangle in pixels of the whole picture.
#[derive(Debug, Clone, Copy)]
struct Frame {
    left: i32,
    top: i32,
    right: i32,
    bottom: i32,
}

impl Frame {
    /// The rectangle with these opposite corners, and a margin around it.
    fn around(a: (i32, i32), b: (i32, i32), margin: i32) -> Self {
        Self {
            left: a.0.min(b.0) - margin,
            top: a.1.min(b.1) - margin,
            right: a.0.max(b.0) + margin,
            bottom: a.1.max(b.1) + margin,
        }
    }

    fn meets(&self, other: &Frame) -> bool {
        self.left < other.right && other.left < self.right && self.top < other.bottom && other.top < self.bottom
    }
}

/// Writes labels beside their points where they hide neither points nor each other. Where the whole text finds no room its
/// number may, which is the first word; the table has the rest.
fn write_labels(
    area: &Area,
    (columns, rows): &(std::ops::Range<i32>, std::ops::Range<i32>),
    labels: Vec<((i32, i32), &str)>,
    mut taken: Vec<Frame>,
) -> Result<(), Failure> {
    let number = |text: &str| text.split(' ').next().unwrap_or_default().to_owned();
    for (at, text) in labels {
        for text in [text.to_owned(), number(text)] {
            let (width, height) = ((text.chars().count() as f64 * LETTER_WIDTH) as i32, LETTERS as i32 + 2);
            let rays = [(1, -1), (1, 0), (1, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (0, 1)];
            let places = [10, 16, 26, 40].into_iter().flat_map(|distance| {
                rays.map(|(dx, dy)| {
                    let left = match dx {
                        1 => at.0 + distance,
                        -1 => at.0 - distance - width,
                        _ => at.0 - width / 2,
                    };
                    let top = at.1 + dy * distance - height / 2;
                    Frame { left, top, right: left + width, bottom: top + height }
                })
            });
            let fits = |frame: &Frame| {
                let inside = columns.start <= frame.left
                    && frame.right <= columns.end
                    && rows.start <= frame.top
                    && frame.bottom <= rows.end;
                inside && !taken.iter().any(|other| other.meets(frame))
            };
            if let Some(frame) = places.into_iter().find(fits) {
                let corner = relative(area, (frame.left, frame.top));
                // A line leads to a label that is not beside its point.
                let near = (at.0.clamp(frame.left, frame.right), at.1.clamp(frame.top, frame.bottom));
                if (near.0 - at.0).abs().max((near.1 - at.1).abs()) > 12 {
                    let line = vec![relative(area, at), relative(area, near)];
                    area.draw(&PathElement::new(line, RGBColor(150, 150, 155).stroke_width(1)))?;
                }
                area.draw(&Text::new(text, corner, (FONT, LETTERS)))?;
                taken.push(frame);
                break;
            }
        }
    }
    Ok(())
}

fn write_legend(area: &Area, chart: &Chart) -> Result<(), Failure> {
    let (base_x, base_y) = area.get_base_pixel();
    let mut y = 50;
    for series in chart.series.iter().filter(|series| !series.points.is_empty()) {
        let color = COLORS[series.color % COLORS.len()];
        mark(area, (base_x + 12, base_y + y), series.marker, color, true)?;
        area.draw(&Text::new(series.name.clone(), (24, y - 7), (FONT, LETTERS)))?;
        y += 20;
    }
    y += 8;
    let grey = RGBColor(90, 90, 90);
    mark(area, (base_x + 12, base_y + y), Marker::Circle, grey, true)?;
    area.draw(&Text::new("filled: rounded outward", (24, y - 7), (FONT, LETTERS)))?;
    mark(area, (base_x + 12, base_y + y + 20), Marker::Circle, grey, false)?;
    area.draw(&Text::new("hollow: to nearest", (24, y + 13), (FONT, LETTERS)))?;
    area.draw(&Circle::new((12, y + 40), 7, BLACK.stroke_width(1)))?;
    area.draw(&Text::new("ringed: Pareto front of", (24, y + 33), (FONT, LETTERS)))?;
    for (front, name) in chart.fronts.iter().enumerate() {
        let y = y + 60 + 20 * front as i32;
        area.draw(&PathElement::new(vec![(5, y), (19, y)], line(front)))?;
        area.draw(&Text::new(name.clone(), (24, y - 7), (FONT, LETTERS)))?;
    }
    Ok(())
}

/// A logarithmic axis; its own coordinate is the decimal exponent.
#[derive(Debug, Clone, PartialEq)]
struct Axis {
    from: f64,
    to: f64,
    ticks: Vec<f64>,
    /// Where 0 is drawn, if any number is 0.
    zero: Option<f64>,
}

impl Axis {
    fn new(numbers: impl Iterator<Item = f64> + Clone) -> Self {
        let exponents = numbers.clone().filter(|n| *n > 0.0 && n.is_finite()).map(f64::log10);
        let least = exponents.clone().fold(f64::INFINITY, f64::min);
        let most = exponents.fold(f64::NEG_INFINITY, f64::max);
        let (least, most) = if least <= most { (least, most) } else { (-1.0, 0.0) };
        let margin = 0.06 * (most - least).max(0.5);
        let has_zero = numbers.into_iter().any(|n| n == 0.0);
        let zero = has_zero.then_some(least - 2.5 * margin);
        let (from, to) = (zero.unwrap_or(least) - margin, most + margin);
        // 1, 2, 5 in each decade while there are few of them, else every so many decades.
        let decades = (most - least).max(0.5);
        let digits: &[f64] = if decades <= 2.5 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let step = (decades / 9.0).ceil().max(1.0) as i32;
        let whole = (least - margin).floor() as i32..=to.ceil() as i32;
        let places = whole.filter(|decade| decade % step == 0);
        let mut ticks: Vec<f64> =
            places.flat_map(|decade| digits.iter().map(move |digit| f64::from(decade) + digit.log10())).collect();
        ticks.retain(|tick| (least - margin..=to).contains(tick));
        ticks.extend(zero);
        Self { from, to, ticks, zero }
    }

    fn place(&self, number: f64) -> f64 {
        match self.zero {
            Some(zero) if number == 0.0 => zero,
            _ => number.log10().clamp(self.from, self.to),
        }
    }

    /// The label of a place.
    fn text(&self, exponent: f64) -> String {
        if self.zero == Some(exponent) {
            return "0".to_owned();
        }
        let decade = (exponent + 1e-9).floor();
        let digit = 10f64.powf(exponent - decade).round();
        if (-3.0..=4.0).contains(&decade) {
            let places = (-decade).max(0.0) as usize;
            format!("{:.places$}", digit * 10f64.powf(decade))
        } else {
            format!("{digit}e{decade}")
        }
    }
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, exponent: &f64, (start, end): (i32, i32)) -> i32 {
        let share = (exponent - self.from) / (self.to - self.from);
        start + (share * f64::from(end - start)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        self.ticks.clone()
    }

    fn range(&self) -> std::ops::Range<f64> {
        self.from..self.to
    }
}

impl ValueFormatter<f64> for Axis {
    fn format(exponent: &f64) -> String {
        format!("1e{exponent}")
    }

    fn format_ext(&self, exponent: &f64) -> String {
        self.text(*exponent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_hold_all_numbers_and_have_a_place_for_zero() {
        let numbers = [0.0, 1e-17, 3.0, 250.0];
        let axis = Axis::new(numbers.into_iter());
        let places: Vec<f64> = numbers.iter().map(|&n| axis.place(n)).collect();
        assert!(places.windows(2).all(|pair| pair[0] < pair[1]), "{places:?}");
        assert!(axis.from < places[0] && places[3] < axis.to);
        assert!(axis.ticks.len() >= 4 && axis.ticks.len() <= 12, "{:?}", axis.ticks);
        assert_eq!(
            (axis.text(axis.place(0.0)), axis.text(-14.0), axis.text(2.0)),
            ("0".into(), "1e-14".into(), "100".into())
        );
        // One number, or none, still makes an axis.
        assert!(Axis::new([5.0].into_iter()).ticks.len() >= 2);
        assert!(!Axis::new([].into_iter()).ticks.is_empty());
    }

    #[test]
    fn charts_are_drawn_with_their_labels() {
        let point = |x: f64, y: f64, label: Option<&str>| {
            let front = label.map(|label| Front { front: 0, label: label.to_owned() });
            Point { x, y, filled: true, front }
        };
        let points = vec![point(1e-3, 9.0, Some("1 left")), point(0.0, 20.0, None), point(0.1, 2.0, Some("2 <right>"))];
        let series = vec![Series { name: "imp".to_owned(), color: 0, marker: Marker::Circle, points }];
        let chart = Chart {
            title: "T".to_owned(),
            x: "error".to_owned(),
            y: "ms".to_owned(),
            series,
            fronts: vec!["all".to_owned()],
        };
        let svg = chart.svg().unwrap();
        assert!(svg.contains("1 left") && svg.contains("2 &lt;right&gt;") && svg.ends_with("</svg>\n"));
        assert_eq!(svg.matches("<svg").count(), 1);
    }
}
