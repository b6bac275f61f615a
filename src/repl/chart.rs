//! Pictures of `:plot` as SVG and PNG.

use std::io::Cursor;

use image::ImageFormat;
use image::RgbImage;
use plotters::chart::ChartBuilder;
use plotters::coord::Shift;
use plotters::drawing::DrawingArea;
use plotters::drawing::DrawingAreaErrorKind;
use plotters::drawing::IntoDrawingArea;
use plotters::element::Circle;
use plotters::element::PathElement;
use plotters::element::Rectangle;
use plotters::prelude::BitMapBackend;
use plotters::prelude::DrawingBackend;
use plotters::prelude::SVGBackend;
use plotters::style::BLACK;
use plotters::style::Color;
use plotters::style::FontStyle;
use plotters::style::RGBColor;
use plotters::style::WHITE;
use plotters::style::register_font;

use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::repl::plot::Plot;
use crate::repl::plot::short;

/// Pixels across and down.
const SIZE: (u32, u32) = (900, 560);
const FONT: &str = "sans-serif";
const BAND: RGBColor = RGBColor(160, 196, 232);
const CURVE: RGBColor = RGBColor(20, 60, 120);

/// # Errors
/// If drawing fails, which is no fault of the user's.
pub fn svg(plot: &Plot) -> Result<Vec<u8>, Diagnostic> {
    register()?;
    let mut text = String::new();
    draw(SVGBackend::with_string(&mut text, SIZE).into_drawing_area(), plot).map_err(|error| failed(&error))?;
    Ok(text.into_bytes())
}

/// # Errors
/// As [`svg`].
pub fn png(plot: &Plot) -> Result<Vec<u8>, Diagnostic> {
    register()?;
    let (width, height) = SIZE;
    let mut pixels = vec![0; 3 * width as usize * height as usize];
    let area = BitMapBackend::with_buffer(&mut pixels, SIZE).into_drawing_area();
    draw(area, plot).map_err(|error| failed(&error))?;
    let mut bytes = Cursor::new(Vec::new());
    let picture = RgbImage::from_raw(width, height, pixels).unwrap_or_default();
    picture.write_to(&mut bytes, ImageFormat::Png).map_err(|error| failed(&error))?;
    Ok(bytes.into_inner())
}

/// The letters come along: a bare machine has none.
fn register() -> Result<(), Diagnostic> {
    register_font(FONT, FontStyle::Normal, dejavu::sans::regular())
        .map_err(|_| Diagnostic::error(code::INTERNAL, "the font of the plot cannot be read"))
}

fn failed(error: &impl std::fmt::Display) -> Diagnostic {
    Diagnostic::error(code::INTERNAL, format!("the plot cannot be drawn: {error}"))
}

fn draw<B: DrawingBackend>(area: DrawingArea<B, Shift>, plot: &Plot) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
    area.fill(&WHITE)?;
    let (x, y) = (plot.x, plot.y);
    let mut chart = ChartBuilder::on(&area)
        .caption(&plot.title, (FONT, 18))
        .margin(12)
        .x_label_area_size(42)
        .y_label_area_size(76)
        .build_cartesian_2d(x.0..x.1, y.0..y.1)?;
    // Bands lie below the grid, the curve above it.
    let inside = |value: f64| value.clamp(y.0, y.1);
    chart.draw_series(
        plot.bands.iter().filter(|band| band.enclosure.hi() >= y.0 && band.enclosure.lo() <= y.1).map(|band| {
            let corners = [(band.x.0, inside(band.enclosure.lo())), (band.x.1, inside(band.enclosure.hi()))];
            Rectangle::new(corners, BAND.filled())
        }),
    )?;
    chart
        .configure_mesh()
        .light_line_style(WHITE.mix(0.0))
        .bold_line_style(BLACK.mix(0.12))
        .x_desc(&plot.variable)
        .x_label_formatter(&|x| short(*x))
        .y_label_formatter(&|y| short(*y))
        .label_style((FONT, 14))
        .axis_desc_style((FONT, 16))
        .draw()?;
    let visible = |point: &&(f64, f64)| (y.0..=y.1).contains(&point.1);
    for band in &plot.bands {
        if band.continuous {
            for pair in band.points.windows(2) {
                if let Some(segment) = clipped(pair[0], pair[1], y) {
                    chart.draw_series([PathElement::new(segment, CURVE.stroke_width(2))])?;
                }
            }
        } else {
            let dots = band.points.iter().filter(visible).map(|&point| Circle::new(point, 1, CURVE.filled()));
            chart.draw_series(dots)?;
        }
    }
    area.present()
}

/// The part of a segment that lies between two heights.
fn clipped(from: (f64, f64), to: (f64, f64), heights: (f64, f64)) -> Option<[(f64, f64); 2]> {
    let (lo, hi) = heights;
    if from.1.max(to.1) < lo || from.1.min(to.1) > hi {
        return None;
    }
    let at = |height: f64| (from.0 + (to.0 - from.0) * ((height - from.1) / (to.1 - from.1)), height);
    let end = |point: (f64, f64)| match point.1 {
        y if y < lo => at(lo),
        y if y > hi => at(hi),
        _ => point,
    };
    Some([end(from), end(to)])
}
