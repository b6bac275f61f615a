//! Letters as outlines, from a font that comes with Imp: a bare machine has none.

use std::sync::LazyLock;

use ab_glyph::Font;
use ab_glyph::FontRef;
use ab_glyph::GlyphId;
use ab_glyph::OutlineCurve;
use tiny_skia::PathBuilder;

use crate::arrange::export::drawing::Anchor;
use crate::arrange::export::drawing::Point;

/// `None` would be a broken font; then nothing is written.
static FONT: LazyLock<Option<FontRef<'static>>> =
    LazyLock::new(|| FontRef::try_from_slice(dejavu::sans::regular()).ok());

/// Pixels from the start of a text to its end.
pub fn width(size: f64, text: &str) -> f64 {
    let Some(font) = &*FONT else { return 0.0 };
    size * text.chars().map(|letter| advance(font, font.glyph_id(letter))).sum::<f64>()
}

/// Adds the outlines of a text whose base line starts, ends or has its middle at a place.
pub fn write(builder: &mut PathBuilder, [x, y]: Point, anchor: Anchor, size: f64, text: &str) {
    let Some(font) = &*FONT else { return };
    let share = match anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => 0.5,
        Anchor::End => 1.0,
    };
    let mut pen = x - share * width(size, text);
    for letter in text.chars() {
        let glyph = font.glyph_id(letter);
        let scale = size / units(font);
        let at = |point: ab_glyph::Point| {
            ((pen + scale * f64::from(point.x)) as f32, (y - scale * f64::from(point.y)) as f32)
        };
        let mut last = None;
        for curve in font.outline(glyph).map_or(Vec::new(), |outline| outline.curves) {
            let start = match curve {
                OutlineCurve::Line(start, ..) | OutlineCurve::Quad(start, ..) | OutlineCurve::Cubic(start, ..) => {
                    at(start)
                }
            };
            // A curve that does not continue the one before starts a new outline.
            if last != Some(start) {
                builder.move_to(start.0, start.1);
            }
            last = Some(match curve {
                OutlineCurve::Line(_, end) => {
                    let end = at(end);
                    builder.line_to(end.0, end.1);
                    end
                }
                OutlineCurve::Quad(_, control, end) => {
                    let (control, end) = (at(control), at(end));
                    builder.quad_to(control.0, control.1, end.0, end.1);
                    end
                }
                OutlineCurve::Cubic(_, first, second, end) => {
                    let (first, second, end) = (at(first), at(second), at(end));
                    builder.cubic_to(first.0, first.1, second.0, second.1, end.0, end.1);
                    end
                }
            });
        }
        pen += size * advance(font, glyph);
    }
}

/// In units of the letters' size.
fn advance(font: &FontRef<'_>, glyph: GlyphId) -> f64 {
    f64::from(font.h_advance_unscaled(glyph)) / units(font)
}

fn units(font: &FontRef<'_>) -> f64 {
    f64::from(font.units_per_em().unwrap_or(2048.0))
}
