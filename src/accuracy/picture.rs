//! The pictures of one level: its colours, and a map of its errors.

use image::ExtendedColorType;
use image::ImageEncoder;
use image::codecs::png::PngEncoder;

use crate::accuracy::truth::Drawn;
use crate::accuracy::truth::Known;
use crate::accuracy::truth::Truth;

/// Two pictures as the bytes of PNG files.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Pictures {
    pub color: Vec<u8>,
    pub errors: Vec<u8>,
}

/// The colours of the map of errors, sRGB, told apart by people with any colour vision (after Okabe and Ito 2008), each
/// with its meaning.
pub const LEGEND: [([u8; 3], &str); 6] = [
    (MISS, "miss, as in the reference"),
    (CLOSE, "hit, as in the reference: the darker, the closer (black at 1e-12 of the domain, light grey at 1e-2)"),
    (MISSED, "wrong: the reference proves a hit, nothing is drawn"),
    (INVENTED, "wrong: drawn where the reference proves a miss"),
    (UNDECIDED, "right as drawn, but the level says itself that it is undecided"),
    (OPEN, "left out: the reference is undecided"),
];
const MISS: [u8; 3] = [250, 250, 250];
const CLOSE: [u8; 3] = [90, 90, 95];
const MISSED: [u8; 3] = [213, 94, 0];
const INVENTED: [u8; 3] = [0, 114, 178];
const UNDECIDED: [u8; 3] = [240, 228, 66];
const OPEN: [u8; 3] = [204, 121, 167];

/// Decimal exponents of the relative depth error between which hits turn from dark to light.
const DECADES: [f64; 2] = [-12.0, -2.0];

/// The map of errors of a picture. What is only unproved, as everything is with rounding to nearest, is not marked as
/// undecided if `marks` is false.
pub fn error_map(truth: &Truth, drawn: &Drawn, marks: bool) -> Vec<[u8; 3]> {
    let color = |(index, known): (usize, &Known)| {
        let hit = drawn.hits[index].as_ref();
        match (known, hit) {
            (Known::Nothing, _) => OPEN,
            (Known::Hit { .. }, None) => MISSED,
            (Known::Miss, Some(_)) => INVENTED,
            _ if marks && drawn.unknown[index] => UNDECIDED,
            (Known::Miss, None) => MISS,
            (Known::Hit { .. }, Some(hit)) => {
                let relative = truth.distance(index, hit).unwrap_or(0.0) / truth.side;
                let share = (relative.log10() - DECADES[0]) / (DECADES[1] - DECADES[0]);
                [(20.0 + 185.0 * share.clamp(0.0, 1.0)) as u8; 3]
            }
        }
    };
    truth.pixels.iter().enumerate().map(color).collect()
}

/// Pixels, row by row, as the bytes of a PNG file; nothing if they do not fill rows of this width.
pub fn png(width: u32, pixels: &[[u8; 3]]) -> Vec<u8> {
    let mut file = Vec::new();
    let height = pixels.len() as u32 / width.max(1);
    let written = PngEncoder::new(&mut file).write_image(&pixels.concat(), width, height, ExtendedColorType::Rgb8);
    if written.is_err() {
        file.clear();
    }
    file
}
