//! Pictures as PNG: the marks of the SVG, painted.

use image::ExtendedColorType;
use image::ImageEncoder;
use image::codecs::png::PngEncoder;

use crate::arrange::export::Traced;
use crate::arrange::export::paint;
use crate::arrange::export::picture;
use crate::arrange::export::picture::Style;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;

/// The picture as the bytes of a PNG file.
///
/// # Errors
/// If it has no pixels or more than memory takes (`E0503`).
pub fn png(traced: Traced<'_>, style: &Style) -> Result<Vec<u8>, Diagnostic> {
    let failed = || {
        let (width, height) = style.size;
        Diagnostic::error(code::PICTURE_SIZE, format!("a picture of {width}x{height} pixels cannot be painted"))
    };
    let drawing = picture::draw(traced, style);
    let pixels = paint::paint(&drawing).ok_or_else(failed)?;
    let mut file = Vec::new();
    let encoder = PngEncoder::new(&mut file);
    encoder.write_image(&pixels, drawing.width, drawing.height, ExtendedColorType::Rgb8).map_err(|_| failed())?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arrange::export::samples::sample;

    #[test]
    fn tmp_write() {
        let sample = sample();
        for (name, style) in [("a", Style::default()), ("b", Style{size:(200,150), boxes:true}), ("c", Style{size:(500,900), boxes:false})] {
            std::fs::write(format!("/tmp/rs/{name}.png"), png(sample.traced(), &style).unwrap()).unwrap();
            std::fs::write(format!("/tmp/rs/{name}.svg"), crate::arrange::export::svg::svg(sample.traced(), &style)).unwrap();
        }
        std::fs::write("/tmp/rs/a.json", crate::arrange::export::json::json(sample.traced()).unwrap()).unwrap();
        std::fs::write("/tmp/rs/a.geojson", crate::arrange::export::geojson::geojson(sample.traced())).unwrap();
        std::fs::write("/tmp/rs/a.dot", crate::arrange::export::dot::graph(sample.traced())).unwrap();
        std::fs::write("/tmp/rs/d.dot", crate::arrange::export::dot::dual(sample.traced())).unwrap();
    }
}
