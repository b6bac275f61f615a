//! Replays a certificate: every refuted cell is refuted again, the cells are checked to leave no gap on any ray, and
//! every bracket is checked to hold a crossing. What is shared with the renderer is the definition of the rays, of the
//! cells and of what is asked; the answers come from the given backend alone, in double precision.

use rayon::prelude::*;

use crate::derive::Rounding;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::kernel::Backend;
use crate::kernel::verdict;
use crate::program::scene::Scene;
use crate::render::Control;
use crate::render::batch::Batch;
use crate::render::batch::Program;
use crate::render::camera::Frame;
use crate::render::camera::TILE;
use crate::render::camera::Tile;
use crate::render::certificate::Certificate;
use crate::render::certificate::Claim;
use crate::render::certificate::Counts;
use crate::render::certificate::ShapeProof;
use crate::render::certificate::fingerprint;
use crate::render::context::Context;
use crate::render::context::Part;
use crate::render::context::Refuted;
use crate::render::context::Test;
use crate::render::context::opposite;
use crate::render::context::proves_condition;
use crate::render::context::refutes_condition;
use crate::render::context::sign;
use crate::render::geometry::Geometry;
use crate::render::geometry::check;
use crate::render::geometry::shared_inputs;
use crate::render::options::Options;
use crate::render::outcome::Surface;
use crate::render::plan::arithmetic;
use crate::render::programs::Compiled;
use crate::render::programs::Orders;
use crate::render::stopped;

/// How often a recorded cell may be split to be refuted: kernels may be tighter than the reference here and there.
const SPLITS: u32 = 8;

/// How often a bracket may be halved to be found continuous.
const HALVINGS: u32 = 4;

/// What was verified.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Report {
    pub counts: Counts,
    /// Refuted cells of beams and single rays.
    pub cells: u64,
    /// Evaluations by the reference.
    pub evaluations: u64,
}

/// Checks that a certificate proves what it claims of the picture of a scene.
///
/// # Errors
/// If it belongs to another scene (`E0508`), or proves less than it claims or anything else (`E0509`, with the tile and
/// pixel); if the scene cannot be drawn or the backend fails.
pub fn verify(
    scene: &Scene,
    certificate: &Certificate,
    backend: &dyn Backend,
    control: &Control<'_>,
) -> Result<Report, Diagnostic> {
    if certificate.fingerprint != fingerprint(scene, &scene.parameters) || scene.dimension() != 3 {
        return Err(Diagnostic::error(code::OTHER_SCENE, "the certificate belongs to another scene")
            .help("verify it with the file and the parameters that it was made with"));
    }
    let enclosures = certificate.enclosures;
    let camera = certificate.camera.camera().ok_or_else(|| rejected("its camera sees nothing".to_owned()))?;
    let options = Options { width: camera.width, height: camera.height, enclosures, ..Options::default() };
    check(scene, &options)?;
    let geometry = Geometry::of_camera(scene, &options, camera);
    if certificate.tiles.len() != geometry.tiles.len() {
        return Err(rejected(format!("it has {} tiles of {}", certificate.tiles.len(), geometry.tiles.len())));
    }
    let constants = shared_inputs(&geometry);
    let mut programs = Vec::new();
    for shape in &scene.shapes {
        let (beams, _) = arithmetic(scene, shape, enclosures);
        let reach = Some(geometry.reach);
        let orders = Orders { scene, shape, reach, rounding: Rounding::Outward, arithmetic: beams };
        let specs = [orders.beam(), orders.slope(), orders.verdicts(), orders.face()];
        let mut bound = Vec::new();
        for spec in specs {
            bound.push(Compiled::<f64>::new(backend, &spec)?.bind(&scene.parameters, &constants));
        }
        programs.push(bound);
    }
    let reports: Result<Vec<Report>, Diagnostic> = geometry
        .tiles
        .par_iter()
        .zip(&certificate.tiles)
        .map(|(&tile, proofs)| {
            if control.is_cancelled() {
                return Err(stopped());
            }
            let report = verify_tile(scene, &geometry, tile, proofs, &programs);
            control.advance(geometry.tiles.len());
            report.map_err(|reason| rejected(format!("tile at ({}, {}): {reason}", tile.x, tile.y)))
        })
        .collect();
    control.reset();
    let mut total = Report::default();
    for report in reports? {
        total.counts.proved += report.counts.proved;
        total.counts.misses += report.counts.misses;
        total.counts.unknown += report.counts.unknown;
        total.cells += report.cells;
        total.evaluations += report.evaluations;
    }
    if total.counts != certificate.counts {
        let (found, claimed) = (total.counts, certificate.counts);
        return Err(rejected(format!("its pixels are {found:?}, but it claims {claimed:?}")));
    }
    Ok(total)
}

fn rejected(reason: String) -> Diagnostic {
    Diagnostic::error(code::REJECTED, format!("the certificate is rejected: {reason}"))
}

/// What is verified of a ray and a shape: the prefix that is refuted, and the end of the proved bracket after it.
#[derive(Debug, Clone, Copy)]
struct Seen {
    clear: f64,
    hit: Option<f64>,
}

fn verify_tile(
    scene: &Scene,
    geometry: &Geometry,
    tile: Tile,
    proofs: &[ShapeProof],
    programs: &[Vec<Program<f64>>],
) -> Result<Report, String> {
    if proofs.len() != scene.shapes.len() {
        return Err("the number of shapes is wrong".to_owned());
    }
    let frame = Frame::new(&geometry.camera, tile);
    let (width, height) = frame.size();
    let mut report = Report::default();
    let mut seen: Vec<Vec<Seen>> = Vec::new();
    for ((proof, shape), programs) in proofs.iter().zip(&scene.shapes).zip(programs) {
        let mut checker = Checker {
            context: geometry.context(&frame, scene, shape),
            beam: Batch::new(&programs[0], GROUPS),
            slope: Batch::new(&programs[1], GROUPS),
            ends: Batch::new(&programs[2], GROUPS),
            face: Batch::new(&programs[3], 1),
        };
        seen.push(checker.check(proof)?);
        report.cells += proof.cover.len() as u64;
        report.evaluations +=
            checker.beam.evaluations + checker.slope.evaluations + checker.ends.evaluations + checker.face.evaluations;
    }
    for pixel in 0..(width * height) as usize {
        let shapes: Vec<Seen> = seen.iter().map(|shape| shape[pixel]).collect();
        let nearest = |(index, end): (usize, f64)| {
            shapes.iter().enumerate().all(|(other, seen)| other == index || seen.clear >= end)
        };
        if shapes.iter().all(|seen| seen.clear == f64::INFINITY) {
            report.counts.misses += 1;
        } else if shapes.iter().enumerate().filter_map(|(i, seen)| Some((i, seen.hit?))).any(nearest) {
            report.counts.proved += 1;
        } else {
            report.counts.unknown += 1;
        }
    }
    Ok(report)
}

const GROUPS: usize = 8;

/// Replays one shape's proof in one tile.
struct Checker<'a> {
    context: Context<'a>,
    /// Refutation of the field by the arithmetic of beams.
    beam: Batch<f64>,
    /// Verdicts of field, centred form, slope, value at the end, and condition over a box.
    slope: Batch<f64>,
    /// Verdicts of field and condition.
    ends: Batch<f64>,
    /// The same, blind to the domain.
    face: Batch<f64>,
}

/// The rays of a block: lower and upper ends of what varies.
type Hull = ([f64; 3], [f64; 3]);

/// A block of 2^level by 2^level pixels: left, top, level.
type Block = (u32, u32, u8);

/// The answers over a box.
#[derive(Debug, Clone, Copy)]
struct Answers {
    beam: u32,
    field: u32,
    centred: u32,
    growth: u32,
    end: u32,
    condition: bool,
    no_condition: bool,
    no_zero: bool,
}

impl Checker<'_> {
    fn check(&mut self, proof: &ShapeProof) -> Result<Vec<Seen>, String> {
        let claims = self.claims(proof)?;
        let (width, height) = self.context.frame.size();
        let clips: Vec<Option<([f64; 2], [f64; 2])>> = (0..width * height)
            .map(|pixel| self.context.frame.ray(pixel % width, pixel / width).clip(self.context.domain))
            .collect();
        // How far each ray is refuted.
        let mut reached: Vec<f64> =
            clips.iter().map(|clip| clip.map_or(f64::INFINITY, |(entry, _)| entry[0])).collect();

        let mut cells = Vec::with_capacity(proof.cover.len());
        for &cell in &proof.cover {
            cells.push((self.span(cell, &clips)?, cell));
        }
        cells.sort_by(|(a, _), (b, _)| a[0].total_cmp(&b[0]));
        for cells in cells.chunks(self.slope.capacity()) {
            for (lane, &([start, end], cell)) in cells.iter().enumerate() {
                let hull = self.context.frame.hull(cell.x.into(), cell.y.into(), 1 << cell.level);
                self.load(lane, &hull, start, end);
            }
            self.beam.run(cells.len());
            self.slope.run(cells.len());
            let answers: Vec<Answers> = (0..cells.len()).map(|lane| self.answers(lane)).collect();
            for (&(span, cell), answers) in cells.iter().zip(answers) {
                self.replay(cell, span, answers, &claims, &mut reached)?;
            }
        }

        let mut seen = Vec::with_capacity(claims.len());
        for (pixel, claim) in claims.iter().enumerate() {
            let name = || format!("pixel ({}, {})", pixel as u32 % width, pixel as u32 / width);
            let exit = clips[pixel].map_or(f64::NEG_INFINITY, |(_, exit)| exit[1]);
            let (needed, found) = match claim {
                None => (exit, Seen { clear: f64::INFINITY, hit: None }),
                Some(Claim::Unknown(clear)) => (*clear, Seen { clear: *clear, hit: None }),
                Some(Claim::Hit(_, [a, b])) => (*a, Seen { clear: *a, hit: Some(*b) }),
            };
            if needed.is_nan() || reached[pixel] < needed {
                return Err(format!("{} is not refuted up to {needed}, only to {}", name(), reached[pixel]));
            }
            if let Some(Claim::Hit(surface, bracket)) = claim {
                let ray = self.context.frame.varying(pixel as u32 % width, pixel as u32 / width);
                if !clips[pixel].is_some_and(|clip| self.is_hit(*surface, &(ray, ray), *bracket, clip)) {
                    return Err(format!("{} has no proved crossing in {bracket:?}", name()));
                }
            }
            seen.push(found);
        }
        Ok(seen)
    }

    /// The claim of every pixel; `None` is a miss.
    fn claims(&self, proof: &ShapeProof) -> Result<Vec<Option<Claim>>, String> {
        let (width, height) = self.context.frame.size();
        let mut claims = vec![None; (width * height) as usize];
        let mut next = 0usize;
        for &(gap, claim) in &proof.claims {
            next += gap as usize;
            *claims.get_mut(next).ok_or("it claims something beyond the last pixel")? = Some(claim);
            next += 1;
        }
        Ok(claims)
    }

    /// The stretch of t that a recorded cell covers.
    fn span(&self, cell: Refuted, clips: &[Option<([f64; 2], [f64; 2])>]) -> Result<[f64; 2], String> {
        let (width, height) = self.context.frame.size();
        let (x, y, grid) = (u32::from(cell.x), u32::from(cell.y), self.context.grid);
        let fits = x < width && y < height && u32::from(cell.level) <= TILE.ilog2() && cell.depth <= grid.deepest();
        if !fits || cell.k >= 1 << 52 || (cell.part != Part::Whole && cell.level != 0) {
            return Err(format!("there is no such cell as {cell:?}"));
        }
        let [start, end] = [cell.k, cell.k + 1].map(|k| grid.cut(k, cell.depth));
        if cell.part == Part::Whole {
            return Ok([start, end]);
        }
        let Some((entry, exit)) = clips[(y * width + x) as usize] else {
            return Err(format!("the ray of {cell:?} misses the domain"));
        };
        let span = match cell.part {
            Part::Entry => entry,
            Part::Exit => [exit[0].max(entry[1]), exit[1]],
            _ => [start.max(entry[1]), end.min(exit[0])],
        };
        if span[0] <= span[1] { Ok(span) } else { Err(format!("{cell:?} covers nothing")) }
    }

    fn load(&mut self, lane: usize, hull: &Hull, start: f64, end: f64) {
        load_plain(&mut self.beam, lane, hull, [start, end]);
        load_plain(&mut self.slope, lane, hull, [start, end]);
        let middle = (0.5 * (start + end)).clamp(start, end);
        self.slope.set_range(lane, 4, middle, middle);
        self.slope.set_range(lane, 5, end, end);
    }

    fn answers(&self, lane: usize) -> Answers {
        let [field, centred, growth, end] = [0, 1, 2, 3].map(|slot| self.slope.bits(lane, slot));
        let condition = if self.context.condition { self.slope.bits(lane, 4) } else { !verdict::REFUTED };
        let numerator = 4 + usize::from(self.context.condition);
        let no_zero = numerator < self.slope.output_slots() && sign(self.slope.bits(lane, numerator)) != 0;
        Answers {
            no_zero,
            beam: self.beam.bits(lane, 0),
            field,
            centred: sign(centred),
            growth: sign(growth),
            end: sign(end),
            condition: !self.context.condition || proves_condition(condition),
            no_condition: refutes_condition(condition),
        }
    }

    /// Whether the cell is refuted outright.
    fn is_refuted(&self, answers: Answers) -> bool {
        let centred = if answers.field & verdict::CONTINUOUS != 0 { answers.centred } else { 0 };
        answers.no_condition
            || answers.no_zero
            || (answers.beam | answers.field | centred) & self.context.refuting() != 0
    }

    /// Refutes a cell of a block again, in parts if need be: the reference's enclosures may be the wider ones where it
    /// carries other error terms than a compiled kernel. What holds for all parts holds for the whole.
    fn refutes(&mut self, block: Block, span: [f64; 2], splits: u32) -> bool {
        let answers = self.over(block, span);
        self.is_refuted(answers)
            || (splits > 0
                && self
                    .parts(block, span)
                    .is_some_and(|parts| parts.into_iter().all(|(block, span)| self.refutes(block, span, splits - 1))))
    }

    /// The sign of the slope along the rays of a block over a cell, in parts if need be; 0 if it has none everywhere.
    fn growth(&mut self, block: Block, span: [f64; 2], splits: u32) -> u32 {
        let whole = growth(self.over(block, span));
        let parts = if whole == 0 && splits > 0 { self.parts(block, span) } else { None };
        let Some(parts) = parts else { return whole };
        let mut signs = parts.into_iter().map(|(block, span)| self.growth(block, span, splits - 1));
        let first = signs.next().unwrap_or(0);
        if signs.all(|sign| sign == first) { first } else { 0 }
    }

    fn over(&mut self, (x, y, level): Block, [start, end]: [f64; 2]) -> Answers {
        let hull = self.context.frame.hull(x, y, 1 << level);
        self.load(0, &hull, start, end);
        self.beam.run(1);
        self.slope.run(1);
        self.answers(0)
    }

    /// The parts of a cell of a block: its quarters that hold pixels, or for a single ray the halves of the cell; `None` if
    /// it has no smaller parts.
    fn parts(&self, (x, y, level): Block, [start, end]: [f64; 2]) -> Option<Vec<(Block, [f64; 2])>> {
        let (width, height) = self.context.frame.size();
        if level > 0 {
            let half = 1 << (level - 1);
            let quarters = [(x, y), (x + half, y), (x, y + half), (x + half, y + half)].into_iter();
            let inside = quarters.filter(|&(x, y)| x < width && y < height);
            return Some(inside.map(|(x, y)| ((x, y, level - 1), [start, end])).collect());
        }
        let middle = 0.5 * (start + end);
        (start < middle && middle < end).then(|| vec![((x, y, level), [start, middle]), ((x, y, level), [middle, end])])
    }

    fn replay(
        &mut self,
        cell: Refuted,
        [start, end]: [f64; 2],
        answers: Answers,
        claims: &[Option<Claim>],
        reached: &mut [f64],
    ) -> Result<(), String> {
        let (width, height) = self.context.frame.size();
        let (x, y, size) = (u32::from(cell.x), u32::from(cell.y), 1u32 << cell.level);
        let rows = y..(y + size).min(height);
        let pixels = rows.flat_map(|row| (x..(x + size).min(width)).map(move |column| (row * width + column) as usize));
        let helped: Vec<usize> = pixels.filter(|&p| start <= reached[p] && reached[p] < end).collect();
        if helped.is_empty() {
            return Ok(());
        }
        if cell.test != Test::Monotone {
            if self.is_refuted(answers) || self.refutes((x, y, cell.level), [start, end], SPLITS) {
                for pixel in helped {
                    reached[pixel] = end;
                }
                return Ok(());
            }
            return Err(format!("{cell:?} is not refuted by the reference"));
        }
        let growth = match growth(answers) {
            0 => self.growth((x, y, cell.level), [start, end], SPLITS),
            sign => sign,
        };
        if growth == 0 {
            return Err(format!("{cell:?} is not monotone by the reference"));
        }
        for pixel in helped {
            if let Some(Claim::Hit(Surface::Field, [a, b])) = claims[pixel]
                && start <= a
                && b <= end
            {
                // The bracket's signs are checked at the end; a monotone field has the sign at a on all before it.
                reached[pixel] = a;
                continue;
            }
            let ray = self.context.frame.varying(pixel as u32 % width, pixel as u32 / width);
            let constant = match answers.end == opposite(growth) {
                true => answers.end,
                false => self.constant_sign(&(ray, ray), [start, end], growth),
            };
            if constant & self.context.refuting() != 0 {
                reached[pixel] = end;
            }
        }
        Ok(())
    }

    /// The sign that a monotone field has on all of a ray's stretch, or 0.
    fn constant_sign(&mut self, ray: &Hull, [start, end]: [f64; 2], growth: u32) -> u32 {
        let [first, last] = self.signs(ray, [start, end]);
        if first == growth {
            first
        } else if last == opposite(growth) {
            last
        } else {
            0
        }
    }

    fn signs(&mut self, ray: &Hull, ends: [f64; 2]) -> [u32; 2] {
        for (lane, &t) in ends.iter().enumerate() {
            load_plain(&mut self.ends, lane, ray, [t, t]);
        }
        self.ends.run(2);
        [0, 1].map(|lane| sign(self.ends.bits(lane, 0)))
    }

    /// Whether a bracket holds what is claimed.
    fn is_hit(&mut self, surface: Surface, ray: &Hull, [a, b]: [f64; 2], (entry, _): ([f64; 2], [f64; 2])) -> bool {
        match surface {
            Surface::Field => {
                let [first, last] = self.signs(ray, [a, b]);
                let crossing = if self.context.region { first == verdict::POSITIVE } else { first != 0 };
                crossing && last == opposite(first) && a < b && self.is_sound(ray, [a, b], true, HALVINGS)
            }
            Surface::Face(_) | Surface::Eye => {
                load_plain(&mut self.face, 0, ray, [a, b]);
                self.face.run(1);
                const INSIDE: u32 = verdict::NEGATIVE | verdict::CONTINUOUS;
                let condition = !self.context.condition || proves_condition(self.face.bits(0, 1));
                self.context.region && b == entry[1] && condition && self.face.bits(0, 0) & INSIDE == INSIDE
            }
            Surface::Cut => {
                let [_, last] = self.signs(ray, [a, b]);
                let outside = self.context.condition && refutes_condition(self.ends.bits(0, 1));
                let inside = last == verdict::NEGATIVE && proves_condition(self.ends.bits(1, 1));
                self.context.region && outside && inside && self.is_sound(ray, [a, b], false, HALVINGS)
            }
        }
    }

    /// Whether the field is continuous on a stretch, and the condition true if that is asked.
    fn is_sound(&mut self, ray: &Hull, [start, end]: [f64; 2], condition: bool, halvings: u32) -> bool {
        load_plain(&mut self.ends, 0, ray, [start, end]);
        self.ends.run(1);
        let holds = !condition || !self.context.condition || proves_condition(self.ends.bits(0, 1));
        if holds && self.ends.bits(0, 0) & verdict::CONTINUOUS != 0 {
            return true;
        }
        let middle = 0.5 * (start + end);
        halvings > 0
            && start < middle
            && middle < end
            && self.is_sound(ray, [start, middle], condition, halvings - 1)
            && self.is_sound(ray, [middle, end], condition, halvings - 1)
    }
}

/// The sign of the slope where the field is monotone, continuous and unconditioned, else 0.
fn growth(answers: Answers) -> u32 {
    let smooth = answers.field & verdict::CONTINUOUS != 0 && answers.condition;
    if smooth { answers.growth } else { 0 }
}

fn load_plain(batch: &mut Batch<f64>, lane: usize, hull: &Hull, [start, end]: [f64; 2]) {
    for slot in 0..3 {
        batch.set_range(lane, slot, hull.0[slot], hull.1[slot]);
    }
    batch.set_range(lane, 3, start, end);
}
