//! The source's `prove` (its figure 4.3): whether the one curve left in a box crosses it. The box is quartered until a part
//! is strictly positive and another strictly negative (crossed), no part can have a zero (empty), or it is given up.
//!
//! A change of sign proves a zero only of a function that is continuous between. So each part inherits the largest box
//! around it on which continuity is proved, its *ground*, and both signs must be found on the same ground.

use crate::arrange::field::Function;
use crate::arrange::published::Evaluate;
use crate::arrange::published::tree::BATCH;
use crate::arrange::published::tree::Mark;
use crate::arrange::published::tree::Square;
use crate::control::Control;
use crate::interval::Interval;
use crate::kernel::verdict;

/// How many times a box is quartered at most to prove that a curve crosses it. At the default epsilon of 1e-6, parts are
/// then above 1e-11, far from the resolution of the number format.
pub(super) const LEVELS: u32 = 16;

/// Undecided parts of one box beyond which the proof is given up. A curve that crosses is found with a handful; these
/// are what a double curve leaves after eight quarterings, and what is undefined throughout after four.
pub(super) const OPEN: usize = 256;

/// Boxes whose proofs are sought together.
const GROUP: usize = 1 << 11;

/// A box with one curve left.
#[derive(Debug, Clone, Copy)]
pub(super) struct Candidate {
    pub(super) square: Square,
    pub(super) curve: u16,
    /// Whether the function is proved continuous on it.
    pub(super) continuous: bool,
}

/// What proofs took.
#[derive(Default)]
pub(super) struct Proofs {
    pub(super) evaluations: u64,
    /// Boxes left undecided although both signs occur.
    pub(super) discontinuous: u64,
}

/// A part of a box that may have a zero.
#[derive(Clone, Copy)]
struct Part {
    /// Which candidate it belongs to.
    of: u32,
    square: Square,
    /// Index of its ground; `None` where continuity is not proved.
    ground: Option<u32>,
}

/// Signs found, as verdict bits.
type Signs = u32;

const BOTH: Signs = verdict::POSITIVE | verdict::NEGATIVE;

impl Proofs {
    /// A mark for each candidate, in their order.
    pub(super) fn search(
        &mut self,
        domain: [Interval; 2],
        shapes: &[Function],
        candidates: &[Candidate],
        control: &Control,
        evaluate: &Evaluate,
    ) -> Vec<Mark> {
        let groups = candidates.chunks(GROUP);
        groups.flat_map(|group| self.group(domain, shapes, group, control, evaluate)).collect()
    }

    fn group(
        &mut self,
        domain: [Interval; 2],
        shapes: &[Function],
        candidates: &[Candidate],
        control: &Control,
        evaluate: &Evaluate,
    ) -> Vec<Mark> {
        let mut marks: Vec<Option<Mark>> = vec![None; candidates.len()];
        let mut seen: Vec<Signs> = vec![0; candidates.len()];
        let mut grounds: Vec<Signs> = Vec::new();
        let mut open = Vec::new();
        for (of, candidate) in (0u32..).zip(candidates) {
            let ground = candidate.continuous.then(|| new_ground(&mut grounds));
            open.push(Part { of, square: candidate.square, ground });
        }
        for _ in 0..LEVELS {
            if open.is_empty() || control.is_cancelled() {
                break;
            }
            let quarter = |part: &Part| part.square.children().map(|square| Part { square, ..*part });
            let parts: Vec<Part> = open.iter().flat_map(quarter).collect();
            open.clear();
            let mut left: Vec<usize> = vec![0; candidates.len()];
            for parts in parts.chunks(BATCH) {
                let function = |part: &Part| shapes[usize::from(candidates[part.of as usize].curve)];
                let queries: Vec<_> = parts.iter().map(|part| (function(part), part.square.area(domain))).collect();
                self.evaluations += queries.len() as u64;
                for (part, sample) in parts.iter().zip(evaluate(&queries)) {
                    let of = part.of as usize;
                    let continuous = part.ground.is_some() || sample.is_continuous();
                    if sample.bits & verdict::EMPTY != 0 {
                        continue;
                    }
                    let sign = sample.bits & BOTH;
                    if sign == 0 {
                        left[of] += 1;
                        let fresh = || continuous.then(|| new_ground(&mut grounds));
                        open.push(Part { ground: part.ground.or_else(fresh), ..*part });
                        continue;
                    }
                    seen[of] |= sign;
                    if let Some(ground) = part.ground {
                        grounds[ground as usize] |= sign;
                        if grounds[ground as usize] == BOTH {
                            marks[of] = Some(Mark::Crossed);
                        }
                    }
                }
            }
            for (mark, &left) in marks.iter_mut().zip(&left) {
                if mark.is_none() && left == 0 {
                    *mark = Some(Mark::Empty);
                } else if mark.is_none() && left > OPEN {
                    *mark = Some(Mark::Undecided);
                }
            }
            open.retain(|part| marks[part.of as usize].is_none());
        }
        let mark = |(mark, signs): (Option<Mark>, Signs)| {
            let mark = mark.unwrap_or(Mark::Undecided);
            self.discontinuous += u64::from(mark == Mark::Undecided && signs == BOTH);
            mark
        };
        marks.into_iter().zip(seen).map(mark).collect()
    }
}

fn new_ground(grounds: &mut Vec<Signs>) -> u32 {
    grounds.push(0);
    grounds.len() as u32 - 1
}
