//! `:plot`: a function over the box of its one variable, with its enclosures over parts of the box as bands: as text for
//! the terminal, or as a file.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Color;
use ratatui::widgets::Widget;
use ratatui::widgets::canvas::Canvas;
use ratatui::widgets::canvas::Line;
use ratatui::widgets::canvas::Points;

use crate::derive::Extension;
use crate::diagnostic::code;
use crate::interval::Decorated;
use crate::interval::Decoration;
use crate::interval::Interval;
use crate::interval::decimal;
use crate::repl::chart;
use crate::repl::state::Prepared;
use crate::repl::state::State;
use crate::repl::state::trim;
use crate::session;
use crate::session::answer::Choice;
use crate::session::expression::Messages;
use crate::session::expression::Snippet;

/// Lines of a picture in the terminal.
const HEIGHT: u16 = 18;
/// Bands of a picture in a file, and columns of text that a band has in the terminal.
const PARTS: usize = 64;
const BAND: usize = 3;
/// Points of the curve in each band.
const POINTS: usize = 12;

/// What a picture shows.
pub struct Plot {
    /// The formula and the arithmetic of the bands.
    pub title: String,
    pub variable: String,
    pub x: (f64, f64),
    pub y: (f64, f64),
    pub bands: Vec<Band>,
}

/// One part of the box.
pub struct Band {
    pub x: (f64, f64),
    pub enclosure: Interval,
    /// Whether the function is proved continuous here, so that its points may be joined.
    pub continuous: bool,
    /// The function at some points from end to end of the part, where it is defined.
    pub points: Vec<(f64, f64)>,
}

pub fn plot(state: &mut State, arguments: &Snippet) -> Result<String, Messages> {
    let (snippet, file) = split(arguments);
    let prepared = state.prepare(&snippet)?;
    let variable = state.only_free(&snippet, &prepared)?;
    let range = prepared.boxes[variable].interval();
    if !range.is_bounded() {
        let name = &prepared.formula.variables()[variable];
        let fault = snippet.fault(code::NO_EXTENT, format!("the box of `{name}` has no ends to plot between"), "");
        return Err(fault.help(format!("give it some, such as `{name} = [-10, 10]`")));
    }
    let columns = (state.columns.saturating_sub(14)).clamp(7 * BAND, 24 * BAND) / BAND * BAND;
    let parts = if file.is_some() { PARTS } else { columns / BAND };
    let plot = compute(snippet.as_str(), &prepared, variable, state.choice, parts);
    let Some(plot) = plot else {
        return Ok(format!("undefined on all of {range}: nothing to draw"));
    };
    let Some(file) = file else { return Ok(text(&plot, columns)) };
    let path = std::path::Path::new(file.as_str());
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let bytes = if ending == "svg" { chart::svg(&plot)? } else { chart::png(&plot)? };
    session::write(path, &bytes)?;
    Ok(format!("wrote {}", path.display()))
}

/// The expression, and the file behind it.
fn split<'a>(arguments: &Snippet<'a>) -> (Snippet<'a>, Option<Snippet<'a>>) {
    let text = arguments.as_str();
    let lower = text.to_ascii_lowercase();
    if (lower.ends_with(".svg") || lower.ends_with(".png"))
        && let Some(at) = text.rfind(char::is_whitespace)
    {
        return (trim(&arguments.within(0..at)), Some(trim(&arguments.within(at..text.len()))));
    }
    (arguments.clone(), None)
}

/// Encloses and samples; `None` if the function is nowhere defined.
fn compute(title: &str, prepared: &Prepared, variable: usize, choice: Choice, parts: usize) -> Option<Plot> {
    let Prepared { formula, boxes, .. } = prepared;
    let range = boxes[variable].interval();
    let at = |share: f64| {
        let near = range.lo() * (1.0 - share) + range.hi() * share;
        near.clamp(range.lo(), range.hi())
    };
    let with = |interval: Interval| {
        let mut boxes = boxes.clone();
        boxes[variable] = Decorated::new(interval);
        boxes
    };
    let mut bands = Vec::new();
    for part in 0..parts {
        let (lo, hi) = (at(part as f64 / parts as f64), at((part + 1) as f64 / parts as f64));
        let Some(interval) = Interval::new(lo, hi) else { continue };
        let value = choice.enclose(formula, &with(interval)).value;
        let mut points = Vec::new();
        for point in 0..=POINTS {
            let share = point as f64 / POINTS as f64;
            let x = (lo * (1.0 - share) + hi * share).clamp(lo, hi);
            let y = formula.enclose(Extension::Natural, &with(Interval::point(x))).interval();
            if y.is_bounded() {
                points.push((x, y.mid()));
            }
        }
        let continuous = value.decoration() >= Decoration::Dac;
        bands.push(Band { x: (lo, hi), enclosure: value.interval(), continuous, points });
    }
    let y = visible(&bands)?;
    let title = format!("{title}, enclosed over {parts} parts ({choice})");
    let name = formula.variables()[variable].clone();
    Some(Plot { title, variable: name, x: (range.lo(), range.hi()), y, bands })
}

/// The values to show: all bands if they are not much taller than the curve, else the curve without its extremes, so
/// that a pole does not flatten everything else.
fn visible(bands: &[Band]) -> Option<(f64, f64)> {
    let mut values: Vec<f64> = bands.iter().flat_map(|band| band.points.iter().map(|&(_, y)| y)).collect();
    values.sort_by(f64::total_cmp);
    let at = |share: f64| values.get(((values.len() as f64 - 1.0) * share).round() as usize).copied();
    let enclosures = bands.iter().map(|band| band.enclosure).filter(|enclosure| !enclosure.is_empty());
    let hull = enclosures.fold(Interval::EMPTY, Interval::hull);
    let (lo, hi) = match (at(0.0), at(1.0)) {
        (Some(lo), Some(hi)) => (lo, hi),
        // Nowhere sampled, perhaps enclosed.
        _ if hull.is_bounded() => (hull.lo(), hull.hi()),
        _ => return None,
    };
    let (low, high) = (at(0.04).unwrap_or(lo), at(0.96).unwrap_or(hi));
    let spread = high - low;
    let tame = hi - lo <= 20.0 * spread || spread == 0.0;
    let (lo, hi) = if tame { (lo, hi) } else { (low - spread, high + spread) };
    let (lo, hi) = match hull.is_bounded() && tame && hull.width() <= 3.0 * (hi - lo) {
        true => (hull.lo(), hull.hi()),
        false => (lo, hi),
    };
    // A constant gets some height, and nothing gets more than numbers have.
    let margin = if hi > lo { 0.03 * (hi - lo) } else { 0.5 * lo.abs().max(1.0) };
    let (lo, hi) = (lo - margin, hi + margin);
    (lo.is_finite() && hi.is_finite() && (hi - lo).is_finite() && hi > lo).then_some((lo, hi))
}

/// The picture as text: the curve in Braille dots, bands shaded.
fn text(plot: &Plot, columns: usize) -> String {
    let area = Rect::new(0, 0, columns as u16, HEIGHT);
    let mut buffer = Buffer::empty(area);
    let canvas = Canvas::default().x_bounds([plot.x.0, plot.x.1]).y_bounds([plot.y.0, plot.y.1]).paint(|context| {
        for band in &plot.bands {
            if !band.continuous {
                context.draw(&Points::new(&band.points, Color::Reset));
                continue;
            }
            for pair in band.points.windows(2) {
                let [(x1, y1), (x2, y2)] = [pair[0], pair[1]];
                context.draw(&Line { x1, y1, x2, y2, color: Color::Reset });
            }
        }
    });
    canvas.render(area, &mut buffer);
    let labels = [short(plot.y.1), short(plot.y.0)];
    let margin = labels.iter().map(|label| label.chars().count()).max().unwrap_or(0);
    let mut lines = vec![plot.title.clone()];
    for row in 0..HEIGHT {
        let label = match row {
            0 => &labels[0],
            _ if row + 1 == HEIGHT => &labels[1],
            _ => "",
        };
        let cells: String = (0..columns).map(|column| cell(plot, &buffer, column, row)).collect();
        lines.push(format!("{label:>margin$} │{}", cells.trim_end()));
    }
    let (left, right) = (short(plot.x.0), short(plot.x.1));
    let middle = format!("{:^1$}", plot.variable, columns.saturating_sub(left.len() + right.len()));
    lines.push(format!("{:margin$} └{}", "", "─".repeat(columns)));
    lines.push(format!("{:margin$}  {left}{middle}{right}", ""));
    lines.join("\n")
}

/// One character: what the canvas drew, else the shade of a band.
fn cell(plot: &Plot, buffer: &Buffer, column: usize, row: u16) -> String {
    let drawn = buffer.cell((column as u16, row)).map_or(" ", |cell| cell.symbol());
    if !matches!(drawn, " " | "\u{2800}") {
        return drawn.to_owned();
    }
    let height = (plot.y.1 - plot.y.0) / f64::from(HEIGHT);
    let middle = plot.y.1 - height * (f64::from(row) + 0.5);
    let shaded = plot.bands.get(column / BAND).is_some_and(|band| {
        let enclosure = band.enclosure;
        enclosure.lo() <= middle + height / 2.0 && enclosure.hi() >= middle - height / 2.0
    });
    if shaded { "░" } else { " " }.to_owned()
}

/// A number with a few digits.
pub fn short(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 || !x.is_finite() {
        return decimal(x);
    }
    if !(1e-3..1e5).contains(&size) {
        return format!("{x:.2e}");
    }
    let places = (3 - size.log10().floor() as i32).clamp(0, 6) as usize;
    let text = format!("{x:.places$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}
