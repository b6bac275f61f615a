//! What the kernels say of the pieces that walkers have reached.

use crate::kernel::verdict;
use crate::render::batch::Batch;
use crate::render::context::Test;
use crate::render::context::proves_condition;
use crate::render::context::refutes_condition;
use crate::render::context::sign;
use crate::render::finish::Finisher;
use crate::render::finish::Walker;

/// What the kernels say of a piece.
#[derive(Debug, Clone, Copy)]
pub(super) struct Evidence {
    /// The sign of the field on all of the piece, or 0.
    pub sign: u32,
    pub empty: bool,
    pub continuous: bool,
    pub bounded: bool,
    /// The width of the field's enclosure.
    pub width: f64,
    /// The sign of the slope, or 0.
    pub growth: u32,
    pub condition: bool,
    pub no_condition: bool,
    /// The numerator of a field with poles has no zero.
    pub no_zero: bool,
    pub test: Test,
}

impl Finisher<'_> {
    fn load(batch: &mut Batch<f64>, lane: usize, walker: &Walker, p: f64, q: f64) {
        for (slot, &component) in walker.ray.iter().enumerate() {
            batch.set_range(lane, slot, component, component);
        }
        batch.set_range(lane, 3, p, q);
    }

    pub(super) fn pieces(&mut self, walkers: &[Walker]) -> Vec<Evidence> {
        for (lane, walker) in walkers.iter().enumerate() {
            Self::load(&mut self.piece, lane, walker, walker.p, walker.q);
            let middle = (0.5 * (walker.p + walker.q)).clamp(walker.p, walker.q);
            self.piece.set_range(lane, 4, middle, middle);
        }
        self.piece.run(walkers.len());
        (0..walkers.len()).map(|lane| self.evidence(lane)).collect()
    }

    fn evidence(&self, lane: usize) -> Evidence {
        let bits = self.piece.bits(lane, 2);
        let width = self.piece.get(lane, 0) + self.piece.get(lane, 1);
        let continuous = bits & verdict::CONTINUOUS != 0;
        let natural = sign(bits);
        let (centred, growth) =
            if continuous { (sign(self.piece.bits(lane, 4)), sign(self.piece.bits(lane, 3))) } else { (0, 0) };
        let condition = if self.context.condition { self.piece.bits(lane, 5) } else { !verdict::REFUTED };
        let numerator = 5 + usize::from(self.context.condition);
        let no_zero = numerator < self.piece.output_slots() && sign(self.piece.bits(lane, numerator)) != 0;
        Evidence {
            sign: if natural != 0 { natural } else { centred },
            empty: bits & verdict::EMPTY != 0,
            continuous,
            bounded: width < f64::INFINITY,
            width,
            growth,
            condition: !self.context.condition || proves_condition(condition),
            no_condition: refutes_condition(condition),
            no_zero,
            test: match (natural, centred) {
                (0, 0) if no_zero => Test::Numerator,
                (0, 1..) => Test::Centred,
                _ => Test::Natural,
            },
        }
    }

    /// For each walker that enters the domain of a solid here: whether it is proved to enter inside the solid. The
    /// kernel knows no domain, since the piece straddles its face.
    pub(super) fn faces(&mut self, walkers: &[Walker]) -> Vec<bool> {
        let mut inside = vec![false; walkers.len()];
        let entering: Vec<usize> = (0..walkers.len()).filter(|&index| walkers[index].entering).collect();
        for (lane, &index) in entering.iter().enumerate() {
            let walker = &walkers[index];
            Self::load(&mut self.face, lane, walker, walker.p, walker.q);
        }
        self.face.run(entering.len());
        for (lane, &index) in entering.iter().enumerate() {
            const INSIDE: u32 = verdict::NEGATIVE | verdict::CONTINUOUS;
            let condition = !self.context.condition || proves_condition(self.face.bits(lane, 1));
            inside[index] = self.face.bits(lane, 0) & INSIDE == INSIDE && condition;
        }
        inside
    }

    /// The proved signs at both ends of each piece that is inside the domain and undecided.
    pub(super) fn signs(&mut self, walkers: &[Walker], pieces: &[Evidence]) -> Vec<[u32; 2]> {
        let mut lanes = Vec::with_capacity(2 * walkers.len());
        for (index, (walker, piece)) in walkers.iter().zip(pieces).enumerate() {
            if self.is_refuted(piece) || !Self::is_inner(walker) {
                continue;
            }
            for (end, t) in [walker.p, walker.q].into_iter().enumerate() {
                if end == 1 || walker.sign == 0 {
                    Self::load(&mut self.ends, lanes.len(), walker, t, t);
                    lanes.push((index, end));
                }
            }
        }
        self.ends.run(lanes.len());
        let mut signs: Vec<[u32; 2]> = walkers.iter().map(|walker| [walker.sign, 0]).collect();
        for (lane, (index, end)) in lanes.into_iter().enumerate() {
            signs[index][end] = sign(self.ends.bits(lane, 0));
        }
        signs
    }
}
