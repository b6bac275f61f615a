//! Pixels in monotone cells: Newton's method says where the zero should be, two signs prove it.
//!
//! On [a, b] the field is continuous and its slope has one sign, so there is at most one zero; if the ends of a
//! subcell have proved opposite signs, it is there, and everything from a to the subcell is refuted.

use crate::kernel::verdict;
use crate::render::batch::Batch;
use crate::render::batch::Program;
use crate::render::context::Context;
use crate::render::context::Settled;
use crate::render::context::opposite;
use crate::render::context::place;
use crate::render::context::sign;
use crate::render::march::GROUPS;
use crate::render::options::Stop;

/// Steps of Newton's method at most. Cells that are settled by their slope are short against the curvature, so that
/// two or three steps nearly always reach the last bits that matter; the others are for silhouettes.
const STEPS: usize = 10;

/// The step to come, as quadratic convergence foretells it, below which Newton's method ends: this share of the reported
/// cell.
const SETTLED: f64 = 1.0 / 1024.0;

/// How often a subcell is moved after a sign contradicted it: to a neighbour twice, then by bisection.
const MOVES: usize = 40;

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
    trials: Vec<Trial>,
    /// The trials in the lanes of the running batch.
    active: Vec<usize>,
}

/// A pixel on its way to its zero.
#[derive(Debug, Clone, Copy)]
struct Trial {
    ray: [f64; 3],
    /// What Newton's method believes the zero to be in.
    lo: f64,
    hi: f64,
    t: f64,
    slope: f64,
    /// Its last step, to foretell the next.
    step: f64,
    moving: bool,
    depth: u8,
    cell: u64,
    /// The ends of that cell, inside [a, b].
    start: f64,
    end: f64,
    /// The last end before the zero and the first one after it, proved.
    before: Option<f64>,
    after: Option<f64>,
    open: bool,
    settlement: Settlement,
}

impl<'a> Solver<'a> {
    pub fn new(context: Context<'a>, stop: Stop, depth: u8, root: &Program<f64>, ends: &Program<f64>) -> Self {
        let (root, ends) = (Batch::new(root, GROUPS), Batch::new(ends, 2 * GROUPS));
        Self { context, stop, depth, root, ends, trials: Vec::new(), active: Vec::new() }
    }

    /// Evaluations by the point kernel and by the kernel of signs.
    pub fn evaluations(&self) -> [u64; 2] {
        [self.root.evaluations, self.ends.evaluations]
    }

    /// Decides every job, in order.
    pub fn run(&mut self, jobs: &[Settled], mut decide: impl FnMut(&Settled, Settlement)) {
        for jobs in jobs.chunks(self.root.capacity()) {
            let mut trials = std::mem::take(&mut self.trials);
            trials.clear();
            trials.extend(jobs.iter().map(|job| self.begin(job)));
            self.newton(jobs, &mut trials);
            self.prove(jobs, &mut trials);
            for (job, trial) in jobs.iter().zip(&trials) {
                decide(job, trial.settlement);
            }
            self.trials = trials;
        }
    }

    fn begin(&self, job: &Settled) -> Trial {
        let (x, y) = place(job.pixel);
        Trial {
            ray: self.context.frame.varying(x, y),
            lo: job.a,
            hi: job.b,
            t: 0.5 * (job.a + job.b),
            slope: 0.0,
            step: job.b - job.a,
            moving: true,
            depth: self.depth,
            cell: 0,
            start: job.a,
            end: job.b,
            before: job.crossing.then_some(job.a),
            after: job.crossing.then_some(job.b),
            open: true,
            settlement: Settlement::Open,
        }
    }

    /// Newton's method, kept inside a bracket that each value's sign tightens. Nothing is proved here.
    fn newton(&mut self, jobs: &[Settled], trials: &mut [Trial]) {
        let settled = SETTLED * self.context.grid.unit(self.depth);
        for _ in 0..STEPS {
            self.active.clear();
            for (index, trial) in trials.iter().enumerate().filter(|(_, trial)| trial.moving) {
                let lane = self.active.len();
                for (slot, &component) in trial.ray.iter().enumerate() {
                    self.root.set(lane, slot, component);
                }
                self.root.set(lane, 3, trial.t);
                self.active.push(index);
            }
            if self.active.is_empty() {
                return;
            }
            self.root.run(self.active.len());
            for (lane, &index) in self.active.iter().enumerate() {
                let (trial, job) = (&mut trials[index], &jobs[index]);
                let (value, slope) = (self.root.get(lane, 0), self.root.get(lane, 1));
                if (value < 0.0) == (job.growth == verdict::POSITIVE) {
                    trial.lo = trial.t;
                } else {
                    trial.hi = trial.t;
                }
                let next = trial.t - value / slope;
                let next = if next.is_finite() { next } else { 0.5 * (trial.lo + trial.hi) };
                let next = next.clamp(trial.lo, trial.hi);
                let step = (next - trial.t).abs();
                // Far from the zero the first steps are no guide, so a step counts only if it is much shorter than the last.
                trial.moving = step > settled && (step > 0.25 * trial.step || step * step > settled * trial.step);
                (trial.t, trial.slope, trial.step) = (next, slope, step);
            }
        }
    }

    /// Proves the sign at both ends of the subcell of each trial, moving it where a sign says so.
    fn prove(&mut self, jobs: &[Settled], trials: &mut [Trial]) {
        for trial in trials.iter_mut() {
            if let Stop::Tolerance(tolerance) = self.stop {
                // The field varies by about |slope| times the length; what is reported is proved in any case.
                trial.depth = self.context.grid.depth_of(tolerance / trial.slope.abs());
            }
            trial.cell = self.context.grid.cell(trial.t, trial.depth);
        }
        for step in 0..MOVES {
            self.active.clear();
            let grid = self.context.grid;
            for (index, (trial, job)) in trials.iter_mut().zip(jobs).enumerate().filter(|(_, (trial, _))| trial.open) {
                let pair = self.active.len();
                self.active.push(index);
                trial.start = grid.cut(trial.cell, trial.depth).clamp(job.a, job.b);
                trial.end = grid.cut(trial.cell + 1, trial.depth).clamp(job.a, job.b);
                for (lane, t) in [(2 * pair, trial.start), (2 * pair + 1, trial.end)] {
                    for (slot, &component) in trial.ray.iter().enumerate() {
                        self.ends.set_range(lane, slot, component, component);
                    }
                    self.ends.set_range(lane, 3, t, t);
                }
            }
            if self.active.is_empty() {
                return;
            }
            self.ends.run(2 * self.active.len());
            for (pair, &index) in self.active.iter().enumerate() {
                let signs = [sign(self.ends.bits(2 * pair, 0)), sign(self.ends.bits(2 * pair + 1, 0))];
                let trial = &mut trials[index];
                trial.settlement = self.judge(&jobs[index], trial, signs, step);
            }
        }
        for trial in trials.iter_mut() {
            if let (true, Some(start), Some(end)) = (trial.open, trial.before, trial.after) {
                trial.settlement = Settlement::Hit { bracket: [start, end], t: trial.t.clamp(start, end) };
            }
        }
    }

    /// What the signs at the ends of a trial's subcell prove; if nothing yet, the trial stays open and has moved.
    fn judge(&self, job: &Settled, trial: &mut Trial, [first, last]: [u32; 2], step: usize) -> Settlement {
        let (before, after) = (opposite(job.growth), job.growth);
        trial.open = false;
        if first == before && last == after {
            let (start, end) = (trial.start, trial.end);
            return Settlement::Hit { bracket: [start, end], t: trial.t.clamp(start, end) };
        }
        for (sign, t) in [(first, trial.start), (last, trial.end)] {
            if sign == before {
                trial.before = Some(trial.before.map_or(t, |known| known.max(t)));
            } else if sign == after {
                trial.after = Some(trial.after.map_or(t, |known| known.min(t)));
            }
        }
        if trial.after == Some(job.a) {
            // Past the zero from the start: a solid is entered before this cell, if at all.
            return if self.context.region { Settlement::Open } else { Settlement::Refuted };
        }
        if trial.before == Some(job.b) {
            return Settlement::Refuted;
        }
        let grid = self.context.grid;
        let next = match (first == after, last == before) {
            (true, _) if step < 2 => trial.cell.saturating_sub(1),
            (_, true) if step < 2 => trial.cell + 1,
            _ => {
                let (lo, hi) = (trial.before.unwrap_or(job.a), trial.after.unwrap_or(job.b));
                grid.cell(0.5 * (lo + hi), trial.depth)
            }
        };
        if next != trial.cell {
            trial.cell = next;
            trial.open = true;
            return Settlement::Open;
        }
        // A sign too close to 0 to prove: what is proved farther out has to do.
        match (trial.before, trial.after) {
            (Some(start), Some(end)) => Settlement::Hit { bracket: [start, end], t: trial.t.clamp(start, end) },
            _ => Settlement::Open,
        }
    }
}
