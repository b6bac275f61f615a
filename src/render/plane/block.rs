//! Blocks of pixels, quartered until the field decides them (Tupper 2001) or single pixels are left.

use crate::interval::Interval;
use crate::kernel::verdict;
use crate::render::batch::Batch;
use crate::render::batch::Program;
use crate::render::context::proves_condition;
use crate::render::context::refutes_condition;
use crate::render::context::sign;
use crate::render::march::GROUPS;
use crate::render::plane::Place;
use crate::render::plane::kernels::Bound;
use crate::render::plane::pixel::settle;
use crate::render::plane::raster::Raster;
use crate::render::plane::raster::corners;
use crate::render::plane::raster::quarters;

/// Pixels across the blocks that are tasks of their own.
pub const BLOCK: u32 = 64;

/// How often a pixel is quartered before it is looked at more closely.
const QUARTERINGS: usize = 2;

/// Undecided parts of one pixel at one level beyond which it is.
const PARTS: usize = 12;

/// A square of pixels to be decided.
#[derive(Debug, Clone, Copy)]
struct Square {
    x: u32,
    y: u32,
    size: u32,
}

impl Square {
    /// Column and row of each of its pixels.
    fn places(self) -> impl Iterator<Item = (u32, u32)> {
        (self.y..self.y + self.size).flat_map(move |y| (self.x..self.x + self.size).map(move |x| (x, y)))
    }
}

/// A part of a pixel to be decided.
#[derive(Debug, Clone, Copy)]
struct Patch {
    /// The pixel's index in its block.
    pixel: usize,
    area: [Interval; 2],
}

/// What is known of a pixel.
#[derive(Debug, Clone, Copy, Default)]
struct Known {
    /// The field is continuous and the condition holds on all of it.
    sound: bool,
    /// The signs that the field is proved to have at points of it, if so.
    signs: u32,
    inside: bool,
    outside: bool,
    crossed: bool,
    open: bool,
}

impl Known {
    /// A pixel with one part inside a region and one outside is crossed by the region's boundary.
    fn is_crossed(self) -> bool {
        self.crossed || self.inside && self.outside
    }
}

/// The places of a block's pixels, and how often its blocks and single pixels were evaluated.
pub type Decided = (Vec<Place>, (u64, u64));

/// Decides the pixels of one block.
pub struct Decider<'a> {
    raster: &'a Raster,
    batch: Batch<f64>,
    bound: &'a Bound<'a>,
    settling: u64,
    solid: bool,
    condition: bool,
}

/// What one evaluation says of an area.
#[derive(Debug, Clone, Copy)]
enum Finding {
    Outside,
    Inside,
    /// Undecided; whether the field is continuous and the condition holds on all of it.
    Open(bool),
}

impl<'a> Decider<'a> {
    pub fn new(raster: &'a Raster, program: &Program<f64>, bound: &'a Bound<'a>, solid: bool, condition: bool) -> Self {
        Self { raster, batch: Batch::new(program, GROUPS), bound, settling: 0, solid, condition }
    }

    /// Evaluations of blocks and whole pixels, and those that settled what they left open.
    pub fn evaluations(&self) -> (u64, u64) {
        (self.batch.evaluations, self.settling)
    }

    /// The places of the block's pixels, row by row, [`BLOCK`] a row.
    pub fn block(&mut self, x: u32, y: u32) -> Vec<Place> {
        let mut places = vec![Place::Outside; (BLOCK * BLOCK) as usize];
        let mut squares = vec![Square { x, y, size: BLOCK }];
        let mut patches = Vec::new();
        while !squares.is_empty() {
            let areas: Vec<Option<[Interval; 2]>> =
                squares.iter().map(|square| self.raster.clip(square.x, square.y, square.size)).collect();
            let inside: Vec<[Interval; 2]> = areas.iter().flatten().copied().collect();
            let mut findings = self.evaluate(&inside).into_iter();
            let mut next = Vec::new();
            for (square, area) in squares.into_iter().zip(areas) {
                let Some(area) = area else { continue };
                let finding = findings.next().expect("one finding for each area");
                match finding {
                    Finding::Outside => {}
                    Finding::Inside => {
                        let (width, height) = self.raster.size();
                        for (column, row) in square.places().filter(|&(column, row)| column < width && row < height) {
                            // The square may reach beyond the domain.
                            if self.raster.clip(column, row, 1).is_some() {
                                places[((row - y) * BLOCK + column - x) as usize] = Place::Inside;
                            }
                        }
                    }
                    Finding::Open(_) if square.size == 1 => {
                        patches.push(Patch { pixel: ((square.y - y) * BLOCK + square.x - x) as usize, area });
                    }
                    Finding::Open(_) => {
                        let (width, height) = self.raster.size();
                        let half = square.size / 2;
                        next.extend(
                            [(0, 0), (half, 0), (0, half), (half, half)]
                                .map(|(dx, dy)| Square { x: square.x + dx, y: square.y + dy, size: half })
                                .into_iter()
                                .filter(|square| square.x < width && square.y < height),
                        );
                    }
                }
            }
            squares = next;
        }
        let open = self.quarter(patches, &mut places);
        let (pixels, mut areas): (Vec<usize>, Vec<[Interval; 2]>) = open.into_iter().unzip();
        let mut left = pixels.clone();
        let mut unknown = vec![false; places.len()];
        for system in 0..self.bound.len() {
            let mut evaluator = self.bound.evaluator(system);
            let settled = settle(&mut evaluator, self.solid, &areas);
            self.settling += evaluator.evaluations();
            for (&pixel, &place) in left.iter().zip(&settled) {
                unknown[pixel] |= place == Place::Unknown;
                places[pixel] = place;
            }
            // What one system is proved to cross needs no other.
            (left, areas) = left
                .into_iter()
                .zip(areas)
                .filter(|&(pixel, _)| !matches!(places[pixel], Place::Crossed | Place::Inside))
                .unzip();
        }
        for &pixel in &left {
            if unknown[pixel] {
                places[pixel] = Place::Unknown;
            }
        }
        places
    }

    /// Decides pixels that are undecided as a whole; the indices and areas of those that stay open.
    fn quarter(&mut self, first: Vec<Patch>, places: &mut [Place]) -> Vec<(usize, [Interval; 2])> {
        let whole: Vec<(usize, [Interval; 2])> = first.iter().map(|patch| (patch.pixel, patch.area)).collect();
        let mut known = vec![Known::default(); places.len()];
        let mut patches = first;
        for level in 0..=QUARTERINGS {
            let areas: Vec<[Interval; 2]> = patches.iter().map(|patch| patch.area).collect();
            let findings = self.evaluate(&areas);
            let mut open = Vec::new();
            for (patch, finding) in patches.iter().zip(findings) {
                let known = &mut known[patch.pixel];
                match finding {
                    Finding::Outside => known.outside = true,
                    Finding::Inside => known.inside = true,
                    Finding::Open(sound) => {
                        known.sound |= sound && level == 0;
                        open.push((*patch, sound));
                    }
                }
            }
            let sound = open.iter().filter(|(_, sound)| *sound);
            for ((patch, _), corners) in sound.zip(self.corners(&open)) {
                let signs = corners.iter().fold(0, |signs, sign| signs | sign);
                let known = &mut known[patch.pixel];
                // Any two points of a pixel on which the field is continuous are as good as those of one part.
                if known.sound {
                    known.signs |= signs;
                }
                known.crossed |= [signs, known.signs].contains(&(verdict::POSITIVE | verdict::NEGATIVE));
            }
            open.retain(|(patch, _)| !known[patch.pixel].is_crossed());
            // Patches of a pixel are neighbours in the list, since their parents were.
            patches = Vec::new();
            for run in open.chunk_by(|a, b| a.0.pixel == b.0.pixel) {
                let known = &mut known[run[0].0.pixel];
                // Where not even points have a sign, quartering is no use.
                let blunt = known.sound && known.signs == 0;
                if run.len() > PARTS || level == QUARTERINGS || blunt {
                    known.open = true;
                } else {
                    let parts =
                        run.iter().flat_map(|(patch, _)| quarters(patch.area).map(|area| Patch { area, ..*patch }));
                    patches.extend(parts);
                }
            }
            if patches.is_empty() {
                break;
            }
        }
        let mut open = Vec::new();
        for (pixel, area) in whole {
            let known = known[pixel];
            places[pixel] = match known {
                _ if known.is_crossed() => Place::Crossed,
                Known { open: true, .. } => Place::Unknown,
                Known { inside: true, .. } => Place::Inside,
                _ => Place::Outside,
            };
            if places[pixel] == Place::Unknown {
                open.push((pixel, area));
            }
        }
        open
    }

    fn evaluate(&mut self, areas: &[[Interval; 2]]) -> Vec<Finding> {
        let mut findings = Vec::with_capacity(areas.len());
        for areas in areas.chunks(self.batch.capacity()) {
            for (lane, area) in areas.iter().enumerate() {
                for (axis, side) in area.iter().enumerate() {
                    self.batch.set_range(lane, axis, side.lo(), side.hi());
                }
            }
            self.batch.run(areas.len());
            findings.extend((0..areas.len()).map(|lane| self.finding(lane)));
        }
        findings
    }

    fn finding(&self, lane: usize) -> Finding {
        let bits = self.batch.bits(lane, 0);
        let condition = if self.condition { self.batch.bits(lane, 1) } else { !verdict::REFUTED | verdict::POSITIVE };
        let sound = bits & verdict::CONTINUOUS != 0 && proves_condition(condition);
        let numerator = 1 + usize::from(self.condition);
        let no_zero = numerator < self.batch.output_slots() && sign(self.batch.bits(lane, numerator)) != 0;
        if bits & verdict::EMPTY != 0 || no_zero || refutes_condition(condition) {
            return Finding::Outside;
        }
        match (sign(bits), self.solid) {
            (0, _) => Finding::Open(sound),
            (verdict::NEGATIVE, true) if sound => Finding::Inside,
            (verdict::NEGATIVE, true) => Finding::Open(sound),
            _ => Finding::Outside,
        }
    }

    /// The proved signs at the corners of those areas on which a change of sign is a crossing.
    fn corners(&mut self, open: &[(Patch, bool)]) -> Vec<[u32; 4]> {
        let sound = open.iter().filter(|(_, sound)| *sound);
        let points: Vec<[f64; 2]> = sound.flat_map(|(patch, _)| corners(patch.area)).collect();
        let mut signs = Vec::with_capacity(points.len());
        for points in points.chunks(self.batch.capacity()) {
            for (lane, point) in points.iter().enumerate() {
                for (axis, &coordinate) in point.iter().enumerate() {
                    self.batch.set_range(lane, axis, coordinate, coordinate);
                }
            }
            self.batch.run(points.len());
            signs.extend((0..points.len()).map(|lane| sign(self.batch.bits(lane, 0))));
        }
        signs.chunks_exact(4).map(|s| [s[0], s[1], s[2], s[3]]).collect()
    }
}
