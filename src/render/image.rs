//! Pictures to PNG.

use image::ExtendedColorType;
use image::ImageEncoder;
use image::codecs::png::PngEncoder;

use crate::render::picture::Certainty;
use crate::render::picture::Depth;
use crate::render::picture::Picture;

/// What can be written of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Layer {
    Color,
    /// Grey, 16 bits: white at the nearest hit, dark at the farthest, black where nothing is drawn.
    Depth,
    /// x, y and z from -1..1 to 0..255; black where nothing is drawn.
    Normal,
    /// One colour for each [`Certainty`].
    Certainty,
}

/// The colours of the certainty layer, sRGB.
pub fn certainty_color(certainty: Certainty) -> [u8; 3] {
    match certainty {
        Certainty::Hit => [0, 158, 115],
        Certainty::Miss => [240, 240, 240],
        Certainty::Unknown => [213, 94, 0],
        Certainty::Unverified => [150, 150, 170],
    }
}

/// The pixels of a layer: bytes and their meaning.
fn encode(picture: &Picture, layer: Layer) -> (Vec<u8>, ExtendedColorType) {
    match layer {
        Layer::Color => (picture.color.concat(), ExtendedColorType::Rgb8),
        Layer::Certainty => {
            let pixels: Vec<[u8; 3]> = picture.certainty.iter().map(|&c| certainty_color(c)).collect();
            (pixels.concat(), ExtendedColorType::Rgb8)
        }
        Layer::Normal => {
            let code = |n: f32| ((0.5 * n + 0.5) * 255.0).round() as u8;
            let pixel = |normal: &[f32; 3]| if *normal == [0.0; 3] { [0; 3] } else { normal.map(code) };
            (picture.normal.iter().map(pixel).collect::<Vec<_>>().concat(), ExtendedColorType::Rgb8)
        }
        Layer::Depth => {
            let distances = || picture.depth.iter().flatten().map(|depth| depth.distance);
            let (near, far) = (distances().fold(f64::INFINITY, f64::min), distances().fold(0.0, f64::max));
            let scale = if far > near { 1.0 / (far - near) } else { 0.0 };
            // The lowest tenth of the scale is left to nothing at all.
            let code = |distance: f64| (65535.0 * (1.0 - 0.9 * (distance - near) * scale)).round() as u16;
            let pixel = |depth: &Option<Depth>| depth.map_or(0, |depth| code(depth.distance));
            // The encoder takes 16-bit samples in the machine's byte order.
            let bytes = picture.depth.iter().flat_map(|depth| pixel(depth).to_ne_bytes()).collect();
            (bytes, ExtendedColorType::L16)
        }
    }
}

/// A layer as the bytes of a PNG file. The layer must have been asked for in the options; else the result is a picture
/// of one black pixel.
///
/// # Panics
/// If the picture's planes do not have its size: our mistake.
pub fn png(picture: &Picture, layer: Layer) -> Vec<u8> {
    let (bytes, color) = encode(picture, layer);
    let mut file = Vec::new();
    let encoder = PngEncoder::new(&mut file);
    let written = match bytes.is_empty() {
        true => encoder.write_image(&[0; 3], 1, 1, ExtendedColorType::Rgb8),
        false => encoder.write_image(&bytes, picture.width, picture.height, color),
    };
    written.expect("memory takes all bytes, and a layer has as many as its picture has pixels");
    file
}
