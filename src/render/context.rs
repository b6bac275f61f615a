//! What the stages of a tile share: the tile's rays, cells and domain, the words for verdicts, and what they hand on.

use serde::Deserialize;
use serde::Serialize;

use crate::interval::Interval;
use crate::kernel::verdict;
use crate::render::camera::Frame;
use crate::render::camera::TILE;
use crate::render::grid::Grid;

/// What the stages of a tile's rendering share.
#[derive(Clone, Copy)]
pub struct Context<'a> {
    pub frame: &'a Frame,
    pub grid: &'a Grid,
    pub domain: &'a [Interval],
    /// A solid or plane region rather than a zero set.
    pub region: bool,
    pub condition: bool,
    /// The depth to which beams march.
    pub leaf: u8,
    /// Blocks of at most 2^this pixels across are tried with their derivative.
    pub slope_level: u8,
    /// The distance of neighbouring rays: at t = 1 in perspective, anywhere otherwise.
    pub pitch: f64,
    pub perspective: bool,
}

impl Context<'_> {
    /// Verdict bits of the field that refute a cell.
    pub fn refuting(&self) -> u32 {
        if self.region { verdict::POSITIVE | verdict::EMPTY } else { verdict::REFUTED }
    }
}

/// Verdict bits that say a condition is false everywhere (an undefined one holds nowhere).
pub fn refutes_condition(bits: u32) -> bool {
    bits & (verdict::NEGATIVE | verdict::EMPTY) != 0
}

/// Verdict bits that say a condition is true everywhere: positive where defined, and defined.
pub fn proves_condition(bits: u32) -> bool {
    const TRUE: u32 = verdict::POSITIVE | verdict::CONTINUOUS;
    bits & TRUE == TRUE
}

/// The sign that verdict bits prove: `POSITIVE`, `NEGATIVE`, or 0 for neither (an empty value has no sign).
pub fn sign(bits: u32) -> u32 {
    if bits & verdict::EMPTY != 0 { 0 } else { bits & (verdict::POSITIVE | verdict::NEGATIVE) }
}

/// The other sign; 0 stays.
pub fn opposite(sign: u32) -> u32 {
    match sign {
        verdict::POSITIVE => verdict::NEGATIVE,
        verdict::NEGATIVE => verdict::POSITIVE,
        _ => 0,
    }
}

/// A pixel of a tile: row times [`TILE`] plus column.
pub type Pixel = u16;

pub fn pixel(x: u32, y: u32) -> Pixel {
    (y * TILE + x) as Pixel
}

pub fn place(pixel: Pixel) -> (u32, u32) {
    (u32::from(pixel) % TILE, u32::from(pixel) / TILE)
}

/// How a cell was refuted, in the words of a certificate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Test {
    /// The enclosure excludes 0, is empty, or the condition is false.
    Natural,
    /// The centred form excludes 0 where the field is continuous.
    Centred,
    /// The field's numerator excludes 0, near a pole.
    Numerator,
    /// The field is monotone, and its ends have one sign or the pixel's bracket follows.
    Monotone,
}

/// Which part of a cell was refuted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Part {
    /// All of it.
    Whole,
    /// The sliver in which a single ray enters the domain, of whatever cell.
    Entry,
    /// What lies between the slivers.
    Inner,
    /// The sliver in which a single ray leaves the domain.
    Exit,
}

/// One refuted cell of a block.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Refuted {
    pub x: u8,
    pub y: u8,
    pub level: u8,
    pub depth: u8,
    pub k: u64,
    pub part: Part,
    pub test: Test,
}

/// A pixel whose field is monotone, continuous and unconditioned on [a, b].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settled {
    pub pixel: Pixel,
    pub a: f64,
    pub b: f64,
    /// The sign of the slope.
    pub growth: u32,
    /// Whether the ends are known to have opposite signs.
    pub crossing: bool,
    /// The index of the block to go on with if the pixel misses; `None` from single rays.
    pub block: Option<usize>,
}

/// A single ray to be taken on from a cell that nothing cheap decided.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Single {
    pub pixel: Pixel,
    pub k: u64,
    pub depth: u8,
    /// The proved sign of the field at the cell's start, or 0.
    pub sign: u32,
}
