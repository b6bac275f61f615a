//! Pixels in monotone cells: Newton's method says where the zero should be, two signs prove it.
//!
//! On [a, b] the field is continuous and its slope has one sign, so there is at most one zero; if the ends of a
//! subcell have proved opposite signs, it is there, and everything from a to the subcell is refuted.

use crate::kernel::verdict;
use crate::render::batch::Batch;
use crate::render::batch::Program;
use crate::render::march::Context;
use crate::render::march::GROUPS;
use crate::render::march::Settled;
use crate::render::march::opposite;
use crate::render::march::place;
use crate::render::march::sign;
use crate::render::options::Stop;

/// Steps of Newton's method from the middle of a cell. Cells that are settled by their slope are short against the
/// curvature, so that two steps nearly always reach the last bits that matter; a third is for the others.
const STEPS: usize = 3;

/// How often a subcell is moved to a neighbour after a sign contradicted it.
const MOVES: usize = 3;

/// What became of a settled pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Settlement {
    /// Proved opposite signs at the ends, and the likely zero between them.
    Hit { bracket: [f64; 2], t: f64 },
    /// No zero in the cell.
    Refuted,
    /// Signs stayed undecided.
    Open,
}

/// Newton's method over packets of rays.
pub struct Solver<'a> {
    context: Context<'a>,
    stop: Stop,
    /// Depth of the reported cell where the stopping rule is not a tolerance.
    depth: u8,
    root: Batch<f64>,
    ends: Batch<f64>,
}

/// A pixel on its way to its zero.
#[derive(Debug, Clone, Copy)]
struct Trial {
    ray: [f64; 3],
    lo: f64,
    hi: f64,
    t: f64,
    slope: f64,
    depth: u8,
    cell: u64,
    /// The ends of that cell, inside [a, b].
    start: f64,
    end: f64,
    open: bool,
}

impl<'a> Solver<'a> {
    pub fn new(context: Context<'a>, stop: Stop, depth: u8, root: &Program<f64>, ends: &Program<f64>) -> Self {
        let (root, ends) = (Batch::new(root, GROUPS), Batch::new(ends, 2 * GROUPS));
        Self { context, stop, depth, root, ends }
    }

    /// Evaluations by the point kernel and by the kernel of signs.
    pub fn evaluations(&self) -> [u64; 2] {
        [self.root.evaluations, self.ends.evaluations]
    }

    /// Decides every job, in order.
    pub fn run(&mut self, jobs: &[Settled], mut decide: impl FnMut(&Settled, Settlement)) {
        for jobs in jobs.chunks(self.root.capacity()) {
            let mut trials: Vec<Trial> = jobs.iter().map(|job| self.begin(job)).collect();
            self.newton(jobs, &mut trials);
            let settlements = self.prove(jobs, &mut trials);
            for (job, settlement) in jobs.iter().zip(settlements) {
                decide(job, settlement);
            }
        }
    }

    fn begin(&self, job: &Settled) -> Trial {
        let (x, y) = place(job.pixel);
        let ray = self.context.frame.varying(x, y);
        let t = 0.5 * (job.a + job.b);
        Trial {
            ray,
            lo: job.a,
            hi: job.b,
            t,
            slope: 0.0,
            depth: self.depth,
            cell: 0,
            start: job.a,
            end: job.b,
            open: true,
        }
    }

    /// Newton's method, kept inside a bracket that each value's sign tightens. Nothing is proved here.
    fn newton(&mut self, jobs: &[Settled], trials: &mut [Trial]) {
        for (lane, trial) in trials.iter().enumerate() {
            for (slot, &component) in trial.ray.iter().enumerate() {
                self.root.set(lane, slot, component);
            }
        }
        for _ in 0..STEPS {
            for (lane, trial) in trials.iter().enumerate() {
                self.root.set(lane, 3, trial.t);
            }
            self.root.run(trials.len());
            for (lane, (trial, job)) in trials.iter_mut().zip(jobs).enumerate() {
                let (value, slope) = (self.root.get(lane, 0), self.root.get(lane, 1));
                if (value < 0.0) == (job.growth == verdict::POSITIVE) {
                    trial.lo = trial.t;
                } else {
                    trial.hi = trial.t;
                }
                let next = trial.t - value / slope;
                let next = if next.is_finite() { next } else { 0.5 * (trial.lo + trial.hi) };
                trial.t = next.clamp(trial.lo, trial.hi);
                trial.slope = slope;
            }
        }
    }

    /// Proves the sign at both ends of the subcell of each trial, moving it to a neighbour where a sign says so.
    fn prove(&mut self, jobs: &[Settled], trials: &mut [Trial]) -> Vec<Settlement> {
        let mut settlements = vec![Settlement::Open; jobs.len()];
        for trial in trials.iter_mut() {
            if let Stop::Tolerance(tolerance) = self.stop {
                // The field varies by about |slope| times the length; what is reported is proved in any case.
                trial.depth = self.context.grid.depth_of(tolerance / trial.slope.abs());
            }
            trial.cell = self.context.grid.cell(trial.t, trial.depth);
        }
        for _ in 0..MOVES {
            let mut lanes = Vec::with_capacity(2 * trials.len());
            for (index, (trial, job)) in trials.iter_mut().zip(jobs).enumerate() {
                if !trial.open {
                    continue;
                }
                let grid = self.context.grid;
                trial.start = grid.cut(trial.cell, trial.depth).max(job.a);
                trial.end = grid.cut(trial.cell + 1, trial.depth).min(job.b);
                for t in [trial.start, trial.end] {
                    let lane = lanes.len();
                    for (slot, &component) in trial.ray.iter().enumerate() {
                        self.ends.set_range(lane, slot, component, component);
                    }
                    self.ends.set_range(lane, 3, t, t);
                    lanes.push(index);
                }
            }
            if lanes.is_empty() {
                break;
            }
            self.ends.run(lanes.len());
            for (pair, indices) in lanes.chunks_exact(2).enumerate() {
                let index = indices[0];
                let (trial, job) = (&mut trials[index], &jobs[index]);
                let (start, end) = (trial.start, trial.end);
                let signs = [sign(self.ends.bits(2 * pair, 0)), sign(self.ends.bits(2 * pair + 1, 0))];
                trial.open = false;
                if signs[0] == opposite(job.growth) && signs[1] == job.growth {
                    settlements[index] = Settlement::Hit { bracket: [start, end], t: trial.t.clamp(start, end) };
                } else if signs[0] == job.growth {
                    if start > job.a {
                        trial.cell -= 1;
                        trial.open = true;
                    } else if !self.context.region {
                        settlements[index] = Settlement::Refuted;
                    }
                } else if signs[1] == opposite(job.growth) {
                    if end < job.b {
                        trial.cell += 1;
                        trial.open = true;
                    } else {
                        settlements[index] = Settlement::Refuted;
                    }
                } else {
                    // A sign too close to 0 to prove: the whole cell may still have proved ends.
                    settlements[index] = Settlement::Open;
                }
            }
        }
        for (settlement, (trial, job)) in settlements.iter_mut().zip(trials.iter().zip(jobs)) {
            if *settlement == Settlement::Open && job.crossing {
                *settlement = Settlement::Hit { bracket: [job.a, job.b], t: trial.t };
            }
        }
        settlements
    }
}
