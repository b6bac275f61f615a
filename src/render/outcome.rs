//! What is known of a pixel.

use serde::Deserialize;
use serde::Serialize;

/// What a ray meets first, and what of it is proved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outcome {
    /// Everything on the ray before this is refuted; infinite if all of it is.
    pub clear: f64,
    /// Something is drawn, at `t` inside `bracket`.
    pub drawn: bool,
    /// Something on the ray before the bracket's end, or anywhere if nothing is drawn, stayed undecided.
    pub unknown: bool,
    pub bracket: [f64; 2],
    pub t: f64,
    pub surface: Surface,
    /// Cells that single rays have tried so far.
    pub spent: u32,
    /// How often it was given up and taken up again behind.
    pub rests: u8,
}

/// What is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Surface {
    /// The zero set.
    Field,
    /// The face of the domain that cuts a solid, by its axis.
    Face(u8),
    /// A solid seen from inside it.
    Eye,
    /// The place where a condition begins to hold inside a solid.
    Cut,
}

impl Outcome {
    /// A ray on which nothing was found yet; a proved miss if nothing ever is.
    pub const MISS: Self = Self {
        clear: f64::INFINITY,
        drawn: false,
        unknown: false,
        bracket: [f64::INFINITY; 2],
        t: f64::INFINITY,
        surface: Surface::Field,
        spent: 0,
        rests: 0,
    };

    /// Records a bracket that holds a proved crossing. What was undecided before it stays so.
    pub fn hit(&mut self, bracket: [f64; 2], t: f64, surface: Surface) {
        if !self.unknown {
            self.clear = bracket[0];
        }
        self.drawn = true;
        self.bracket = bracket;
        self.t = t;
        self.surface = surface;
    }

    /// Records that the ray is undecided from t on; `drawn` says whether to draw something there.
    pub fn undecided(&mut self, bracket: [f64; 2], drawn: bool) {
        if !self.unknown {
            self.unknown = true;
            self.clear = bracket[0];
        }
        if drawn {
            self.drawn = true;
            self.bracket = bracket;
            self.t = bracket[0];
        }
    }
}
