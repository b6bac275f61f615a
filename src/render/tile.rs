//! One tile of a space scene: for every shape the outcome of every pixel, by beams, the solver and single rays in turn.

use crate::kernel::Real;
use crate::render::batch::Program;
use crate::render::camera::TILE;
use crate::render::context::Context;
use crate::render::context::Refuted;
use crate::render::finish::Finisher;
use crate::render::finish::Onward;
use crate::render::march::March;
use crate::render::options::Stop;
use crate::render::outcome::Outcome;
use crate::render::outcome::Surface;
use crate::render::solve::Settlement;
use crate::render::solve::Solver;
use crate::render::stats::Evaluations;

/// Pixels that wait for the solver and the single rays before beams are interrupted for them: several packets each.
const ENOUGH: usize = 256;

/// A shape's kernels, bound to parameters. Beams march in `T`, everything else is in double precision.
pub struct Tracer<T: Real> {
    pub plain: Program<T>,
    pub slope: Program<T>,
    pub ends: Program<f64>,
    pub piece: Program<f64>,
    pub face: Program<f64>,
    pub root: Program<f64>,
}

/// How far to go.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    pub stop: Stop,
    /// The depth of reported cells.
    pub depth: u8,
    /// The depth to which beams march.
    pub leaf: u8,
    /// Blocks of at most 2^this pixels across are tried with their derivative.
    pub slope_level: u8,
    pub poles: bool,
    pub certificate: bool,
}

/// What a tile knows of one shape.
pub struct Traced {
    /// By [`pixel`](crate::render::context::pixel) of the tile; empty if every pixel is a proved miss.
    pub outcomes: Vec<Outcome>,
    /// The refuted cover, if a certificate is wanted.
    pub cover: Vec<Refuted>,
    pub evaluations: Evaluations,
}

/// Traces all pixels of a tile against one shape.
pub fn trace<T: Real>(context: Context<'_>, tracer: &Tracer<T>, effort: Effort) -> Traced {
    let mut march = March::new(context, &tracer.plain, &tracer.slope, effort.certificate);
    let mut solver = Solver::new(context, effort.stop, effort.depth, &tracer.root, &tracer.ends);
    let programs = [&tracer.piece, &tracer.ends, &tracer.face];
    let mut finisher = Finisher::new(context, (effort.stop, effort.depth), effort.poles, programs);
    let mut outcomes = Vec::new();
    loop {
        march.run(ENOUGH);
        if march.settled.is_empty() && march.singles.is_empty() {
            break;
        }
        outcomes.resize((TILE * TILE) as usize, Outcome::MISS);
        let settled = std::mem::take(&mut march.settled);
        solver.run(&settled, |job, settlement| match settlement {
            Settlement::Hit { bracket, t } => {
                outcomes[usize::from(job.pixel)].hit(bracket, t, Surface::Field);
                march.finish(job.pixel);
            }
            Settlement::Refuted => {}
            Settlement::Open => march.leave(job),
        });
        march.release();
        let singles = std::mem::take(&mut march.singles);
        let mut onward = Onward::default();
        finisher.run(&singles, &mut outcomes, &mut march.cover, &mut onward);
        solver.run(&onward.settled, |job, settlement| {
            let outcome = &mut outcomes[usize::from(job.pixel)];
            match settlement {
                Settlement::Hit { bracket, t } => outcome.hit(bracket, t, Surface::Field),
                Settlement::Refuted | Settlement::Open => outcome.undecided([job.a, job.b], true),
            }
        });
        for single in onward.resumed {
            march.resume(single);
        }
    }
    let [beam, slope] = march.evaluations();
    let [root, solver_ends] = solver.evaluations();
    let [piece, ends, face] = finisher.evaluations();
    let evaluations =
        Evaluations { beam, slope, root, ends: solver_ends + ends, piece, face, ..Evaluations::default() };
    Traced { outcomes, cover: march.cover.unwrap_or_default(), evaluations }
}
