//! What the user may choose about a picture.

use serde::Deserialize;
use serde::Serialize;

use crate::derive::Precision;
use crate::derive::Rounding;

/// Which enclosures the beams use.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Enclosures {
    /// The natural interval extension.
    Interval,
    /// AF1 forms intersected with it, one noise symbol along the ray and two across.
    Affine,
    /// The natural extension, and where it decides nothing centred forms along the rays, for beams of every size. (With
    /// the others, beams of 16 pixels or less get them.)
    Centred,
    /// Intervals or affine forms, by counting operations (`plan`).
    #[default]
    Auto,
}

/// How far a proved bracket is refined (Knoll, Hijazi et al. 2007, eq. 6.1 and 6.2; Hijazi 2008, section 6.3.5).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stop {
    /// Cells of 2^-N of the domain's longest side along the dominant axis.
    Depth(u32),
    /// Cells no longer than this in the scene's units.
    Epsilon(f64),
    /// Cells over which the field varies by no more than this.
    Tolerance(f64),
}

impl Default for Stop {
    fn default() -> Self {
        Stop::Depth(16)
    }
}

/// What is wanted of a picture; nothing is computed that no layer needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layers {
    pub color: bool,
    pub depth: bool,
    pub normal: bool,
    pub certainty: bool,
}

impl Default for Layers {
    fn default() -> Self {
        Self { color: true, depth: false, normal: false, certainty: false }
    }
}

/// Everything that can be chosen about a picture besides the scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Pixels across and down.
    pub width: u32,
    pub height: u32,
    pub enclosures: Enclosures,
    /// The format in which beams march; what single precision leaves open is always tried in double.
    pub precision: Precision,
    pub rounding: Rounding,
    pub stop: Stop,
    /// Worker threads; `None` takes one per processor. The picture does not depend on it.
    pub threads: Option<usize>,
    /// Draw where the field changes sign through a pole. Such pixels stay unknown.
    pub poles: bool,
    pub layers: Layers,
    /// Collect what `imp verify` needs.
    pub certificate: bool,
    /// How often the picture is computed; the median time is reported.
    pub repeat: u32,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            width: 512,
            height: 512,
            enclosures: Enclosures::Auto,
            precision: Precision::Single,
            rounding: Rounding::Outward,
            stop: Stop::default(),
            threads: None,
            poles: false,
            layers: Layers::default(),
            certificate: false,
            repeat: 1,
        }
    }
}
