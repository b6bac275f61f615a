//! A finished picture: numbers by pixel, row by row from the top left.

use image::RgbImage;

use crate::render::certificate::Certificate;
use crate::render::outcome::Surface;
use crate::render::stats::Stats;

/// What is known of a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Certainty {
    /// The ray is refuted up to a bracket with a proved crossing; in a plane scene, the curve is proved to pass through
    /// the pixel or the pixel to lie inside the region.
    Hit,
    /// All of the ray, or of the pixel, is refuted.
    Miss,
    /// Something stayed undecided.
    Unknown,
    /// Computed without outward rounding: nothing is proved.
    Unverified,
}

/// Where the hit of a pixel is. In a plane scene, whose pixels are boxes, all numbers but the shape's are 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Depth {
    /// The index of the shape that is drawn.
    pub shape: u16,
    /// What is drawn of it.
    pub surface: Surface,
    /// The cell of the ray parameter that holds the hit, [k 2^-d, (k + 1) 2^-d] in units of the picture's grid, or the
    /// bracket where no such cell was proved.
    pub bracket: [f64; 2],
    /// The likely place of the hit inside the bracket.
    pub t: f64,
    /// The distance from the ray's origin to there.
    pub distance: f64,
}

/// A rendered scene. Planes hold `width * height` entries; those whose layer nobody asked for are empty.
#[derive(Debug, Clone, Default)]
pub struct Picture {
    pub width: u32,
    pub height: u32,
    /// Always there.
    pub certainty: Vec<Certainty>,
    /// sRGB.
    pub color: Vec<[u8; 3]>,
    /// `None` where nothing is drawn.
    pub depth: Vec<Option<Depth>>,
    /// Unit normals, towards the viewer for zero sets and outward for solids; zero where nothing is drawn.
    pub normal: Vec<[f32; 3]>,
    pub stats: Stats,
    /// What `imp verify` needs, if asked for.
    pub certificate: Option<Certificate>,
}

impl Picture {
    /// The index of a pixel in a plane.
    pub fn index(&self, x: u32, y: u32) -> usize {
        y as usize * self.width as usize + x as usize
    }

    /// The colours as an image of the `image` crate; black if the options asked for none.
    pub fn image(&self) -> RgbImage {
        let pixels = self.color.concat();
        RgbImage::from_raw(self.width, self.height, pixels).unwrap_or_else(|| RgbImage::new(self.width, self.height))
    }
}
