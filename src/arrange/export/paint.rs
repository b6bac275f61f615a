//! Paints a drawing.

use tiny_skia::FillRule;
use tiny_skia::LineCap;
use tiny_skia::LineJoin;
use tiny_skia::Paint;
use tiny_skia::Path;
use tiny_skia::PathBuilder;
use tiny_skia::Pixmap;
use tiny_skia::StrokeDash;
use tiny_skia::Transform;

use crate::arrange::export::drawing::Color;
use crate::arrange::export::drawing::Drawing;
use crate::arrange::export::drawing::Mark;
use crate::arrange::export::drawing::Point;
use crate::arrange::export::drawing::Shape;
use crate::arrange::export::drawing::Stroke;
use crate::arrange::export::letters;

/// The pixels of a drawing, red, green and blue, row by row; `None` if it has none or too many.
pub fn paint(drawing: &Drawing) -> Option<Vec<u8>> {
    let mut pixmap = Pixmap::new(drawing.width, drawing.height)?;
    pixmap.fill(tiny_skia::Color::WHITE);
    for mark in drawing.layers.iter().flat_map(|layer| &layer.marks) {
        put(&mut pixmap, mark);
    }
    // On white paper every pixel is opaque.
    let pixels = pixmap.data().chunks_exact(4).flat_map(|pixel| pixel[..3].iter().copied());
    Some(pixels.collect())
}

/// A mark without extent paints nothing.
fn put(pixmap: &mut Pixmap, mark: &Mark) {
    let Some(path) = outline(&mark.shape) else { return };
    if let Some(color) = mark.fill {
        let rule = if matches!(mark.shape, Shape::Text { .. }) { FillRule::Winding } else { FillRule::EvenOdd };
        pixmap.fill_path(&path, &solid(color), rule, Transform::identity(), None);
    }
    if let Some(Stroke { color, width, dash }) = mark.stroke {
        let dash = dash.and_then(|lengths| StrokeDash::new(lengths.map(|length| length as f32).to_vec(), 0.0));
        let (width, cap, join) = (width as f32, LineCap::Round, LineJoin::Round);
        let stroke = tiny_skia::Stroke { width, line_cap: cap, line_join: join, dash, ..Default::default() };
        pixmap.stroke_path(&path, &solid(color), &stroke, Transform::identity(), None);
    }
}

fn solid([r, g, b]: Color) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color_rgba8(r, g, b, 255);
    paint
}

fn outline(shape: &Shape) -> Option<Path> {
    let mut builder = PathBuilder::new();
    match shape {
        Shape::Area(rings) => rings.iter().for_each(|ring| follow(&mut builder, ring, true)),
        Shape::Lines(lines) => lines.iter().for_each(|line| follow(&mut builder, line, false)),
        Shape::Disc { centre: [x, y], radius } => builder.push_circle(*x as f32, *y as f32, *radius as f32),
        Shape::Text { at, anchor, size, text } => letters::write(&mut builder, *at, *anchor, *size, text),
    }
    builder.finish()
}

fn follow(builder: &mut PathBuilder, line: &[Point], closed: bool) {
    for (index, &[x, y]) in line.iter().enumerate() {
        match index {
            0 => builder.move_to(x as f32, y as f32),
            _ => builder.line_to(x as f32, y as f32),
        }
    }
    if closed {
        builder.close();
    }
}
