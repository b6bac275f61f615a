//! Drawings as PNG: the marks of the SVG, painted.

use image::ExtendedColorType;
use image::ImageEncoder;
use image::codecs::png::PngEncoder;

use crate::arrange::export::drawing::Drawing;
use crate::arrange::export::paint;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;

/// The drawing as the bytes of a PNG file.
///
/// # Errors
/// If it has no pixels or more than memory takes (`E0503`).
pub fn png(drawing: &Drawing) -> Result<Vec<u8>, Diagnostic> {
    let failed = || {
        let Drawing { width, height, .. } = drawing;
        Diagnostic::error(code::PICTURE_SIZE, format!("a picture of {width}x{height} pixels cannot be painted"))
    };
    let pixels = paint::paint(drawing).ok_or_else(failed)?;
    let mut file = Vec::new();
    let encoder = PngEncoder::new(&mut file);
    encoder.write_image(&pixels, drawing.width, drawing.height, ExtendedColorType::Rgb8).map_err(|_| failed())?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arrange::export::canvas::CURVES;
    use crate::arrange::export::canvas::Style;
    use crate::arrange::export::canvas::UNKNOWN;
    use crate::arrange::export::picture;
    use crate::arrange::export::samples::sample;

    fn pixels(style: &Style) -> image::RgbImage {
        let file = png(&picture::draw(sample().traced(), style)).unwrap();
        image::load_from_memory(&file).unwrap().to_rgb8()
    }

    fn count(picture: &image::RgbImage, color: [u8; 3]) -> usize {
        picture.pixels().filter(|pixel| pixel.0 == color).count()
    }

    #[test]
    fn what_is_there_is_painted_and_the_unknown_is_loud() {
        let picture = pixels(&Style::default());
        assert_eq!(picture.dimensions(), (960, 800));
        assert!(count(&picture, UNKNOWN) > 100);
        for curve in &CURVES[..3] {
            assert!(count(&picture, *curve) > 100, "{curve:?}");
        }
        assert_eq!(count(&picture, CURVES[6]), 0, "there is no seventh curve");
        // The upper right corner of the domain belongs to the first face, the lower right one to the second.
        let [above, below] = [[800, 80], [800, 690]].map(|[x, y]| *picture.get_pixel(x, y));
        assert!(above != below && above.0 != [255; 3] && below.0 != [255; 3]);
    }

    #[test]
    fn small_pictures_have_no_letters_and_impossible_ones_are_refused() {
        let small = Style { size: (64, 48), boxes: true };
        let picture = pixels(&small);
        assert_eq!(picture.dimensions(), (64, 48));
        assert!(count(&picture, UNKNOWN) > 0);
        let drawing = picture::draw(sample().traced(), &small);
        assert!(drawing.layers.iter().all(|layer| layer.name != "labels" || layer.marks.is_empty()));
        let empty = Drawing { width: 0, ..drawing };
        assert_eq!(png(&empty).unwrap_err().code, code::PICTURE_SIZE);
    }
}
