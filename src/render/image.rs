//! Pictures to PNG files. A file appears under its name only when it is complete.

use std::io;
use std::io::BufWriter;
use std::io::Write;
use std::path::Path;

use image::ExtendedColorType;
use image::ImageEncoder;
use image::codecs::png::PngEncoder;

use crate::diagnostic::Diagnostic;
use crate::render::picture::Certainty;
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
            let pixel =
                |depth: &Option<_>| depth.as_ref().map_or(0, |d: &crate::render::picture::Depth| code(d.distance));
            // The encoder takes 16-bit samples in the machine's byte order.
            let bytes = picture.depth.iter().flat_map(|depth| pixel(depth).to_ne_bytes()).collect();
            (bytes, ExtendedColorType::L16)
        }
    }
}

/// Writes a layer as PNG. The layer must have been asked for in the options.
///
/// # Errors
/// If the file cannot be written (`E0610`); what was there before stays untouched then.
pub fn write_png(picture: &Picture, layer: Layer, path: &Path) -> Result<(), Diagnostic> {
    let (bytes, color) = encode(picture, layer);
    write_file(path, |file| {
        let encoder = PngEncoder::new(file);
        encoder.write_image(&bytes, picture.width, picture.height, color).map_err(io::Error::other)
    })
}

/// Writes a file beside its final place, then renames it, so that no half file is ever seen.
///
/// # Errors
/// If the file cannot be written (`E0610`).
pub fn write_file(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<&std::fs::File>) -> io::Result<()>,
) -> Result<(), Diagnostic> {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let attempt = || -> io::Result<()> {
        let file = tempfile::Builder::new().permissions(permissions()).tempfile_in(folder)?;
        let mut buffer = BufWriter::new(file.as_file());
        write(&mut buffer)?;
        buffer.flush()?;
        drop(buffer);
        file.persist(path).map_err(|error| error.error)?;
        Ok(())
    };
    attempt().map_err(|error| Diagnostic::error("E0610", format!("cannot write {}: {error}", path.display())))
}

/// What a new file may be used for: as other programs make them, not as private temporary files are.
#[cfg(unix)]
fn permissions() -> std::fs::Permissions {
    use std::os::unix::fs::PermissionsExt;
    // The process's mask still applies.
    std::fs::Permissions::from_mode(0o666)
}

#[cfg(not(unix))]
fn permissions() -> std::fs::Permissions {
    std::fs::metadata(".").map(|folder| folder.permissions()).expect("the working folder can be read")
}
