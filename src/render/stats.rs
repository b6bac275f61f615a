//! What a picture cost and what of it is proved.

use std::ops::AddAssign;

use serde::Serialize;

/// Evaluations by kernel: lanes asked for, without padding.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Evaluations {
    /// Beams and boxes of a plane scene: the verdict of the field.
    pub beam: u64,
    /// Beams with their derivative along the ray.
    pub slope: u64,
    /// Newton steps.
    pub root: u64,
    /// Signs at single points.
    pub ends: u64,
    /// Pieces of single rays, or of single pixels of a plane scene.
    pub piece: u64,
    /// Entries of rays into solids at the domain's face.
    pub face: u64,
    /// Gradients for normals and strokes.
    pub gradient: u64,
}

impl Evaluations {
    /// Evaluations of all kernels together.
    pub fn total(&self) -> u64 {
        let Self { beam, slope, root, ends, piece, face, gradient } = *self;
        beam + slope + root + ends + piece + face + gradient
    }
}

impl AddAssign for Evaluations {
    fn add_assign(&mut self, other: Self) {
        self.beam += other.beam;
        self.slope += other.slope;
        self.root += other.root;
        self.ends += other.ends;
        self.piece += other.piece;
        self.face += other.face;
        self.gradient += other.gradient;
    }
}

/// One picture in numbers. Every pixel is exactly one of a proved hit, a proved miss and unknown.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Stats {
    /// Time to compile all kernels, in milliseconds.
    pub compile_ms: f64,
    /// Time to compute the picture, in milliseconds: the median of the repeats.
    pub render_ms: f64,
    pub threads: usize,
    pub pixels: u64,
    /// Pixels in which a shape is drawn, proved or not.
    pub hits: u64,
    /// Pixels whose hit is proved: the ray is refuted up to a bracket that holds a proved crossing.
    pub proved: u64,
    /// Pixels in which something on the ray, or before its hit, stayed undecided. With unrounded arithmetic, all.
    pub unknown: u64,
    /// Pixels whose ray is refuted from end to end.
    pub misses: u64,
    pub evaluations: Evaluations,
}

/// The median of the times of repeated work.
pub fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    let count = times.len();
    match count {
        0 => 0.0,
        _ if count.is_multiple_of(2) => 0.5 * (times[count / 2 - 1] + times[count / 2]),
        _ => times[count / 2],
    }
}
