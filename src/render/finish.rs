//! Single rays in double precision, where beams and slopes decided nothing: silhouettes, creases, conditions, poles,
//! double sheets, faces of the domain.
//!
//! A walker takes its ray piece by piece from where everything before is refuted. Pieces that stay undecided at the
//! finest level are absorbed into a stretch; the stretch is a proved hit if the field is continuous on it and has
//! proved opposite signs before and after it, and undecided otherwise. Nothing is ever passed over.

mod evidence;

use crate::kernel::verdict;
use crate::render::batch::Batch;
use crate::render::batch::Program;
use crate::render::context::Context;
use crate::render::context::Part;
use crate::render::context::Pixel;
use crate::render::context::Refuted;
use crate::render::context::Settled;
use crate::render::context::Single;
use crate::render::context::Test;
use crate::render::context::opposite;
use crate::render::context::place;
use crate::render::finish::evidence::Evidence;
use crate::render::march::GROUPS;
use crate::render::options::Stop;
use crate::render::outcome::Outcome;
use crate::render::outcome::Surface;

/// Cells that one ray may try here before it is given up as undecided. Halving from a leaf to the finest level takes
/// about thirty; a ray that grazes a surface needs a few times that.
const BUDGET: u32 = 192;

/// How often a ray that was given up without anything to draw goes on behind, each time a longer way.
const RESTS: u8 = 4;

/// Levels below the reported depth to which undecided pieces are halved in the hope of refuting them.
const EXTRA_DEPTH: u8 = 10;

/// Where a single ray goes from here.
enum Step {
    /// On with the next piece.
    Next,
    /// The ray's outcome is recorded.
    Done,
    /// Nothing is open: back to the beams.
    Resume,
    /// A monotone crossing for the solver.
    Root(Settled),
}

/// Undecided pieces in a row.
#[derive(Debug, Clone, Copy)]
struct Stretch {
    start: f64,
    /// The proved sign before it, or 0.
    sign: u32,
    /// Whether what lies before it is proved to be outside because its condition is false.
    unconditioned: bool,
    continuous: bool,
    condition: bool,
    bounded: bool,
}

/// A ray under way.
#[derive(Debug, Clone, Copy)]
struct Walker {
    pixel: Pixel,
    ray: [f64; 3],
    entry: [f64; 2],
    exit: [f64; 2],
    /// The current piece is [p, q], inside cell k.
    p: f64,
    q: f64,
    k: u64,
    depth: u8,
    /// The depth of the cell with which the walk began.
    home: u8,
    /// The proved sign at p, or 0.
    sign: u32,
    /// Whether the piece before p was refuted by its condition.
    unconditioned: bool,
    /// Whether a solid may be met at the domain's face, in this piece.
    entering: bool,
    open: Option<Stretch>,
    /// A proved crossing that could not yet be narrowed down.
    fallback: Option<[f64; 2]>,
    spent: u32,
    rests: u8,
}

/// What the stages hand to each other.
#[derive(Default)]
pub struct Onward {
    pub settled: Vec<Settled>,
    pub resumed: Vec<Single>,
}

/// Walks single rays, a packet of them at a time.
pub struct Finisher<'a> {
    context: Context<'a>,
    stop: Stop,
    depth: u8,
    deepest: u8,
    poles: bool,
    piece: Batch<f64>,
    ends: Batch<f64>,
    face: Batch<f64>,
}

impl<'a> Finisher<'a> {
    pub fn new(
        context: Context<'a>,
        (stop, depth): (Stop, u8),
        poles: bool,
        [piece, ends, face]: [&Program<f64>; 3],
    ) -> Self {
        let deepest = (depth.max(context.leaf) + EXTRA_DEPTH).min(context.grid.deepest());
        let [piece, ends, face] = [piece, ends, face].map(|program| Batch::new(program, 2 * GROUPS));
        Self { context, stop, depth, deepest, poles, piece, ends, face }
    }

    /// Evaluations by the kernels of pieces, of signs, and of faces.
    pub fn evaluations(&self) -> [u64; 3] {
        [self.piece.evaluations, self.ends.evaluations, self.face.evaluations]
    }

    /// Walks every ray until it is done, goes back to the beams, or has a root for the solver.
    pub fn run(
        &mut self,
        jobs: &[Single],
        outcomes: &mut [Outcome],
        cover: &mut Option<Vec<Refuted>>,
        onward: &mut Onward,
    ) {
        let mut jobs = jobs.iter();
        let mut walkers: Vec<Walker> = Vec::with_capacity(self.piece.capacity() / 2);
        loop {
            while walkers.len() < self.piece.capacity() / 2 {
                let Some(job) = jobs.next() else { break };
                walkers.extend(self.begin(job, &outcomes[usize::from(job.pixel)]));
            }
            if walkers.is_empty() {
                return;
            }
            let steps = self.step(&mut walkers, outcomes, cover);
            let mut steps = steps.into_iter();
            walkers.retain(|walker| match steps.next().expect("one step for each walker") {
                Step::Next => true,
                Step::Done => false,
                Step::Resume => {
                    let (k, depth) = (walker.k, walker.depth);
                    onward.resumed.push(Single { pixel: walker.pixel, k, depth, sign: walker.sign });
                    false
                }
                Step::Root(settled) => {
                    onward.settled.push(settled);
                    false
                }
            });
        }
    }

    /// `None` if the ray misses the domain or has left it.
    fn begin(&self, job: &Single, outcome: &Outcome) -> Option<Walker> {
        let (x, y) = place(job.pixel);
        let ray = self.context.frame.ray(x, y);
        let (entry, exit) = ray.clip(self.context.domain)?;
        let p = self.context.grid.cut(job.k, job.depth).max(entry[0]);
        let mut walker = Walker {
            pixel: job.pixel,
            ray: self.context.frame.varying(x, y),
            entry,
            exit,
            p,
            q: p,
            k: job.k,
            depth: job.depth,
            home: job.depth,
            sign: job.sign,
            unconditioned: false,
            entering: self.context.region && p <= entry[1],
            open: None,
            fallback: None,
            spent: outcome.spent,
            rests: outcome.rests,
        };
        if p > exit[1] {
            return None;
        }
        self.set_piece(&mut walker);
        Some(walker)
    }

    /// Finds the cell that p is in and the piece from p on: to the cell's end, or to where the ray may cross a face.
    fn set_piece(&self, walker: &mut Walker) {
        let grid = self.context.grid;
        while grid.cut(walker.k + 1, walker.depth) <= walker.p {
            walker.k += 1;
        }
        while walker.depth > walker.home && walker.k.is_multiple_of(2) && walker.p == grid.cut(walker.k, walker.depth) {
            (walker.k, walker.depth) = (walker.k / 2, walker.depth - 1);
        }
        self.cut_piece(walker);
    }

    /// Slivers in which the ray may enter or leave the domain are pieces of their own, whatever cells they touch.
    fn cut_piece(&self, walker: &mut Walker) {
        let end = self.context.grid.cut(walker.k + 1, walker.depth);
        walker.q = if walker.p < walker.entry[1] || walker.entering {
            walker.entry[1].max(walker.p)
        } else if walker.p < walker.exit[0] {
            end.min(walker.exit[0])
        } else {
            walker.exit[1].max(walker.p)
        };
    }

    fn step(
        &mut self,
        walkers: &mut [Walker],
        outcomes: &mut [Outcome],
        cover: &mut Option<Vec<Refuted>>,
    ) -> Vec<Step> {
        let pieces = self.pieces(walkers);
        let faces = self.faces(walkers);
        let signs = self.signs(walkers, &pieces);
        let mut steps = Vec::with_capacity(walkers.len());
        for (index, walker) in walkers.iter_mut().enumerate() {
            let outcome = &mut outcomes[usize::from(walker.pixel)];
            walker.spent += 1;
            let step = if faces[index] {
                let surface = match walker.p == 0.0 && walker.entry[1] == 0.0 {
                    true => Surface::Eye,
                    false => Surface::Face(self.entry_axis(walker)),
                };
                outcome.hit([walker.p, walker.q.max(walker.p)], walker.entry[1], surface);
                Step::Done
            } else {
                self.decide(walker, pieces[index], signs[index], outcome, cover)
            };
            (outcome.spent, outcome.rests) = (walker.spent, walker.rests);
            steps.push(step);
        }
        steps
    }

    /// Whether all of the piece is proved to be in the domain, but for what the kernels have to say.
    fn is_inner(walker: &Walker) -> bool {
        walker.p >= walker.entry[1] && walker.q <= walker.exit[0] && walker.p < walker.q
    }

    fn is_refuted(&self, piece: &Evidence) -> bool {
        piece.empty || piece.no_condition || piece.no_zero || piece.sign & self.context.refuting() != 0
    }

    fn decide(
        &self,
        walker: &mut Walker,
        mut piece: Evidence,
        [before, after]: [u32; 2],
        outcome: &mut Outcome,
        cover: &mut Option<Vec<Refuted>>,
    ) -> Step {
        let inner = Self::is_inner(walker);
        if inner && piece.continuous && piece.growth != 0 && piece.sign == 0 {
            // Monotone, and moving away from 0 at the start or not there yet at the end.
            let constant = if before == piece.growth {
                before
            } else if after == opposite(piece.growth) {
                after
            } else {
                0
            };
            if constant != 0 {
                (piece.sign, piece.test) = (constant, Test::Monotone);
            }
        }
        if self.is_refuted(&piece) {
            return self.refuted(walker, piece, outcome, cover);
        }
        if self.context.region && piece.sign == verdict::NEGATIVE && piece.continuous && piece.condition {
            return self.inside(walker, outcome);
        }
        let base = walker.open.unwrap_or(Stretch {
            start: walker.p,
            sign: before,
            unconditioned: walker.unconditioned,
            continuous: true,
            condition: true,
            bounded: true,
        });
        let stretch = Stretch {
            continuous: base.continuous && piece.continuous && inner,
            condition: base.condition && piece.condition,
            bounded: base.bounded && piece.bounded,
            ..base
        };
        if stretch.continuous && stretch.condition && self.is_crossing(stretch.sign, after) {
            let bracket = [stretch.start, walker.q];
            if walker.open.is_none() && piece.growth != 0 {
                let (pixel, [a, b], growth) = (walker.pixel, bracket, piece.growth);
                if let Some(cover) = cover {
                    cover.push(record(walker, Test::Monotone));
                }
                return Step::Root(Settled { pixel, a, b, growth, crossing: true, block: None });
            }
            let fine = match self.stop {
                Stop::Tolerance(tolerance) => piece.width <= tolerance,
                Stop::Depth(_) | Stop::Epsilon(_) => walker.depth >= self.depth,
            };
            if fine {
                // What was absorbed is where the field is closest to 0.
                let t = match walker.open {
                    Some(_) => 0.5 * (stretch.start + walker.p),
                    None => 0.5 * (walker.p + walker.q),
                };
                outcome.hit(bracket, t, Surface::Field);
                return Step::Done;
            }
            walker.fallback = Some(bracket);
        }
        if walker.spent >= BUDGET {
            let Some(bracket) = walker.fallback else { return self.give_up(walker, stretch, outcome) };
            outcome.hit(bracket, walker.p, Surface::Field);
            return Step::Done;
        }
        if inner && walker.depth < self.deepest {
            (walker.k, walker.depth) = (2 * walker.k, walker.depth + 1);
            walker.sign = before;
            let grid = self.context.grid;
            if grid.cut(walker.k + 1, walker.depth) <= walker.p {
                walker.k += 1;
            }
            self.cut_piece(walker);
            return Step::Next;
        }
        walker.open = Some(stretch);
        (walker.sign, walker.unconditioned) = (after, false);
        self.advance(walker, outcome)
    }

    /// The ray has cost too much. Where there is nothing to draw, it goes on farther behind to find something.
    fn give_up(&self, walker: &mut Walker, stretch: Stretch, outcome: &mut Outcome) -> Step {
        let drawn = stretch.bounded || self.poles;
        outcome.undecided([stretch.start, walker.q], drawn);
        if drawn || walker.rests == RESTS {
            return Step::Done;
        }
        walker.rests += 1;
        let depth = walker.home.saturating_sub(2 * walker.rests);
        walker.k = (walker.k >> (walker.depth - depth)) + 1;
        (walker.depth, walker.home, walker.sign, walker.spent) = (depth, depth, 0, 0);
        walker.p = self.context.grid.cut(walker.k, depth);
        if walker.p < walker.exit[1] { Step::Resume } else { Step::Done }
    }

    /// Whether signs before and after a stretch make it a crossing that is drawn: any for a zero set, from outside to
    /// inside for a solid.
    fn is_crossing(&self, before: u32, after: u32) -> bool {
        after != 0 && before == opposite(after) && (!self.context.region || after == verdict::NEGATIVE)
    }

    /// The piece is refuted: a stretch before it ends here.
    fn refuted(
        &self,
        walker: &mut Walker,
        piece: Evidence,
        outcome: &mut Outcome,
        cover: &mut Option<Vec<Refuted>>,
    ) -> Step {
        if let Some(stretch) = walker.open.take() {
            let provable = stretch.continuous && stretch.condition;
            if provable && self.is_crossing(stretch.sign, piece.sign) {
                outcome.hit([stretch.start, walker.p], 0.5 * (stretch.start + walker.p), Surface::Field);
                return Step::Done;
            }
            if self.undecided(walker, stretch, outcome) {
                return Step::Done;
            }
        }
        if let Some(cover) = cover {
            cover.push(record(walker, piece.test));
        }
        walker.sign = if piece.empty { 0 } else { piece.sign };
        walker.unconditioned = piece.no_condition;
        self.advance(walker, outcome)
    }

    /// The piece is proved to be inside a solid, so the ray has entered it at p or before.
    fn inside(&self, walker: &mut Walker, outcome: &mut Outcome) -> Step {
        match walker.open {
            Some(stretch) if stretch.continuous && stretch.condition && stretch.sign == verdict::POSITIVE => {
                outcome.hit([stretch.start, walker.p], 0.5 * (stretch.start + walker.p), Surface::Field);
            }
            // Outside because the condition is false, then inside: what lies between holds the solid's boundary.
            Some(stretch) if stretch.continuous && stretch.unconditioned => {
                outcome.hit([stretch.start, walker.p], 0.5 * (stretch.start + walker.p), Surface::Cut);
            }
            Some(stretch) => outcome.undecided([stretch.start, walker.p], true),
            None => outcome.undecided([walker.p, walker.q], true),
        }
        Step::Done
    }

    /// Records an undecided stretch; whether the ray ends there.
    fn undecided(&self, walker: &Walker, stretch: Stretch, outcome: &mut Outcome) -> bool {
        let drawn = stretch.bounded || self.poles;
        outcome.undecided([stretch.start, walker.p], drawn);
        drawn
    }

    /// On to the next piece, to the beams, or out of the domain.
    fn advance(&self, walker: &mut Walker, outcome: &mut Outcome) -> Step {
        walker.p = walker.q;
        walker.entering = false;
        if walker.p >= walker.exit[1] {
            if let Some(stretch) = walker.open.take() {
                self.undecided(walker, stretch, outcome);
            }
            return Step::Done;
        }
        self.set_piece(walker);
        let at_start = walker.p == self.context.grid.cut(walker.k, walker.depth);
        if walker.open.is_none() && walker.depth == walker.home && at_start && walker.p >= walker.entry[1] {
            return Step::Resume;
        }
        Step::Next
    }

    /// The axis of the face through which a ray enters the domain.
    fn entry_axis(&self, walker: &Walker) -> u8 {
        let ray = self.context.frame.ray_of(walker.ray);
        let entry = |axis: usize| {
            let (range, o, d) = (self.context.domain[axis], ray.origin[axis], ray.direction[axis]);
            let face = if d < 0.0 { range.hi() } else { range.lo() };
            if d == 0.0 { f64::NEG_INFINITY } else { (face - o) / d }
        };
        (0..3).max_by(|&a, &b| entry(a).total_cmp(&entry(b))).map_or(0, |axis| axis as u8)
    }
}

fn record(walker: &Walker, test: Test) -> Refuted {
    let (x, y) = place(walker.pixel);
    let part = if walker.q <= walker.entry[1] {
        Part::Entry
    } else if walker.p >= walker.exit[0] {
        Part::Exit
    } else {
        Part::Inner
    };
    Refuted { x: x as u8, y: y as u8, level: 0, depth: walker.depth, k: walker.k, part, test }
}
