//! The levels of accuracy that are compared: which engine, on which arithmetic, how far.

use std::fmt;

use crate::accuracy::finder::Finder;
use crate::derive::Arithmetic;
use crate::derive::Precision;
use crate::derive::Rounding;
use crate::render::Enclosures;

/// What decides the pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Engine {
    /// Imp's own: beams, then single rays; boxes in a plane scene.
    Imp(Enclosures),
    /// A root finder of the literature, ray by ray.
    Finder(Finder, Arithmetic),
}

/// The name of Imp's own engine.
pub const OWN_ENGINE: &str = "imp";

impl Engine {
    /// The engine's own name.
    pub fn name(self) -> &'static str {
        match self {
            Engine::Imp(_) => OWN_ENGINE,
            Engine::Finder(finder, _) => finder.name(),
        }
    }

    /// What its enclosures are made of.
    pub fn arithmetic(self) -> &'static str {
        match self {
            Engine::Imp(Enclosures::Interval) => "interval",
            Engine::Imp(Enclosures::Affine) => "affine",
            Engine::Imp(Enclosures::Centred) => "centred",
            Engine::Imp(Enclosures::Auto) => "auto",
            Engine::Finder(_, Arithmetic::Affine) => "affine",
            Engine::Finder(..) => "interval",
        }
    }
}

/// How far a level goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Goal {
    /// Brackets of 2^-N of the domain's longest side.
    Depth(u32),
    /// Pixels across and down, in a plane scene.
    Size(u32, u32),
}

/// One level of accuracy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Level {
    pub engine: Engine,
    pub precision: Precision,
    pub rounding: Rounding,
    pub goal: Goal,
}

/// How many levels are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Selection {
    /// A dozen, for a first look.
    Few,
    /// Every engine, arithmetic, format and rounding, each combination at a few depths.
    #[default]
    Usual,
    /// All combinations at all depths.
    All,
}

const ENCLOSURES: [Enclosures; 4] = [Enclosures::Interval, Enclosures::Affine, Enclosures::Centred, Enclosures::Auto];
const PRECISIONS: [Precision; 2] = [Precision::Single, Precision::Double];
const ROUNDINGS: [Rounding; 2] = [Rounding::Outward, Rounding::Nearest];

/// What ratios of time refer to: the defaults of `imp render`.
pub const BASELINE: Level = Level {
    engine: Engine::Imp(Enclosures::Auto),
    precision: Precision::Single,
    rounding: Rounding::Outward,
    goal: Goal::Depth(16),
};

impl Level {
    /// The levels of a space scene, the baseline first; levels that differ in nothing but the depth follow each other from
    /// coarse to fine.
    pub fn of_space(selection: Selection) -> Vec<Level> {
        let (depths, sweep): (&[u32], &[u32]) = match selection {
            Selection::Few => (&[12], &[8, 16, 24]),
            Selection::Usual => (&[8, 16, 24], &[4, 6, 8, 10, 12, 16, 20, 24, 28, 32]),
            Selection::All => (&[4, 6, 8, 10, 12, 16, 20, 24, 28, 32], &[]),
        };
        // Of the finders: f64 outward, f32 nearest as most of their sources have it, and affine forms.
        let finders: [&[u32]; 3] = match selection {
            Selection::Few => [&[12], &[], &[]],
            Selection::Usual => [&[8, 12, 16, 20], &[8, 16], &[16]],
            Selection::All => [depths; 3],
        };
        let at = |depths: &[u32], level: Level| -> Vec<Level> {
            depths.iter().map(|&depth| Level { goal: Goal::Depth(depth), ..level }).collect()
        };
        let mut levels = vec![BASELINE];
        levels.extend(at(sweep, BASELINE));
        for (enclosures, precision, rounding) in combinations() {
            let level = Level { engine: Engine::Imp(enclosures), precision, rounding, ..BASELINE };
            levels.extend(at(depths, level));
        }
        for finder in Finder::ALL {
            let outward = Level {
                engine: Engine::Finder(finder, Arithmetic::Interval),
                precision: Precision::Double,
                ..BASELINE
            };
            let nearest = Level { precision: Precision::Single, rounding: Rounding::Nearest, ..outward };
            let affine = Level { engine: Engine::Finder(finder, Arithmetic::Affine), ..outward };
            for (level, depths) in [outward, nearest, affine].into_iter().zip(finders) {
                levels.extend(at(depths, level));
            }
        }
        distinct(levels)
    }

    /// The levels of a plane scene: fractions of the size instead of depths. Its boxes are decided in double precision.
    pub fn of_plane(selection: Selection, (width, height): (u32, u32)) -> Vec<Level> {
        let fractions: &[u32] = match selection {
            Selection::Few => &[1, 4],
            Selection::Usual => &[1, 2, 4, 8],
            Selection::All => &[1, 2, 4, 8, 16],
        };
        let mut levels = vec![Level { precision: Precision::Double, goal: Goal::Size(width, height), ..BASELINE }];
        // Centred forms are taken along rays, of which a plane scene has none.
        let in_planes = |&(enclosures, precision, _): &(Enclosures, Precision, Rounding)| {
            enclosures != Enclosures::Centred && precision == Precision::Double
        };
        for (enclosures, precision, rounding) in combinations().filter(in_planes) {
            levels.extend(fractions.iter().rev().map(|&fraction| Level {
                engine: Engine::Imp(enclosures),
                precision,
                rounding,
                goal: Goal::Size((width / fraction).max(1), (height / fraction).max(1)),
            }));
        }
        distinct(levels)
    }

    /// Whether two levels differ at most in how far they go.
    pub fn same_but_goal(&self, other: &Level) -> bool {
        Level { goal: other.goal, ..*self } == *other
    }
}

fn combinations() -> impl Iterator<Item = (Enclosures, Precision, Rounding)> {
    ENCLOSURES.into_iter().flat_map(|enclosures| {
        PRECISIONS
            .into_iter()
            .flat_map(move |precision| ROUNDINGS.into_iter().map(move |rounding| (enclosures, precision, rounding)))
    })
}

/// The levels without repetitions, in their order.
fn distinct(levels: Vec<Level>) -> Vec<Level> {
    let mut seen: Vec<Level> = Vec::new();
    for level in levels {
        if !seen.contains(&level) {
            seen.push(level);
        }
    }
    seen
}

/// `f32` or `f64`.
pub fn precision_name(precision: Precision) -> &'static str {
    match precision {
        Precision::Single => "f32",
        Precision::Double => "f64",
    }
}

/// `outward` or `nearest`.
pub fn rounding_name(rounding: Rounding) -> &'static str {
    match rounding {
        Rounding::Outward => "outward",
        Rounding::Nearest => "nearest",
    }
}

impl fmt::Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (precision, rounding) = (precision_name(self.precision), rounding_name(self.rounding));
        write!(f, "{} {} {precision} {rounding} ", self.engine.name(), self.engine.arithmetic())?;
        match self.goal {
            Goal::Depth(depth) => write!(f, "2^-{depth}"),
            Goal::Size(width, height) => write!(f, "{width}x{height}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_start_with_the_baseline_and_repeat_nothing() {
        for selection in [Selection::Few, Selection::Usual, Selection::All] {
            for levels in [Level::of_space(selection), Level::of_plane(selection, (64, 48))] {
                assert_eq!(levels[0].engine, BASELINE.engine);
                let names: Vec<String> = levels.iter().map(Level::to_string).collect();
                assert!(names.iter().enumerate().all(|(i, name)| !names[..i].contains(name)), "{names:?}");
                for wanted in ["interval", "affine", "auto", "outward", "nearest"] {
                    assert!(names.iter().any(|name| name.contains(wanted)), "{wanted}");
                }
            }
        }
    }
}
