//! The stages in their order: from a scene to its arrangement.

use std::collections::HashSet;
use std::time::Instant;

use crate::arrange::assemble::Outcome;
use crate::arrange::assemble::assemble;
use crate::arrange::build::build;
use crate::arrange::check::Fault;
use crate::arrange::check::signs;
use crate::arrange::cluster::clusters;
use crate::arrange::complex::Complex;
use crate::arrange::field::Fields;
use crate::arrange::options::Options;
use crate::arrange::settle::Settled;
use crate::arrange::settle::settle;
use crate::arrange::settle::unresolved;
use crate::arrange::sides::Isolator;
use crate::arrange::structure::Arrangement;
use crate::arrange::subdivide::Stop;
use crate::arrange::subdivide::Subdivision;
use crate::arrange::subdivide::Work;
use crate::arrange::subdivide::key;
use crate::arrange::tiling::Tiling;
use crate::control::Control;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::interval::Interval;
use crate::kernel::Backend;
use crate::program::scene::Scene;

/// The side at which boxes stop being quartered, as a part of the domain's, unless it is given.
const EPSILON: f64 = 1.0 / (1u64 << 30) as f64;

/// The side, as a part of the domain's, at which exact arithmetic is asked first. Around a cusp the boxes that hold both
/// branches are the more the smaller they are.
const COARSE: f64 = 1.0 / (1u64 << 13) as f64;

/// How much smaller boxes get from one round of questions to the next.
const FINER: f64 = 1.0 / 64.0;

/// Rounds beyond the side that was asked for, where exact arithmetic finds several points in one cluster.
const ROUNDS: usize = 3;

/// The arrangement of a scene's curves. A control that is set to stop leaves clusters where nothing was decided yet.
///
/// # Errors
/// If the scene is not one of plane curves, the backend fails, or threads cannot be started.
pub fn arrange(
    scene: &Scene,
    options: &Options,
    backend: &dyn Backend,
    control: &Control<'_>,
) -> Result<Arrangement, Diagnostic> {
    run(scene, options, None, backend, control)
}

/// The same on a tiling made earlier: every leaf, side and vertex is decided again.
///
/// # Errors
/// As [`arrange`].
pub fn replay(
    scene: &Scene,
    options: &Options,
    leaves: &[[Interval; 2]],
    backend: &dyn Backend,
    control: &Control<'_>,
) -> Result<Arrangement, Diagnostic> {
    run(scene, options, Some(leaves), backend, control)
}

fn run(
    scene: &Scene,
    options: &Options,
    leaves: Option<&[[Interval; 2]]>,
    backend: &dyn Backend,
    control: &Control<'_>,
) -> Result<Arrangement, Diagnostic> {
    let work = || {
        let fields = Fields::new(scene, backend)?;
        let start = Instant::now();
        let complex = solve(&fields, options, leaves, control);
        let mut arrangement = build(complex).map_err(fault)?;
        signs(&mut arrangement, &fields);
        arrangement.milliseconds = 1e3 * start.elapsed().as_secs_f64();
        Ok(arrangement)
    };
    match options.threads {
        None => work(),
        Some(count) => {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build();
            let failed = |error| Diagnostic::error(code::NO_THREADS, format!("cannot start {count} threads: {error}"));
            pool.map_err(failed)?.install(work)
        }
    }
}

/// A complex that is none is our mistake.
fn fault(fault: Fault) -> Diagnostic {
    Diagnostic::error(code::INTERNAL, format!("the arrangement does not fit together: {fault}"))
        .help("please report it with the scene")
}

/// The cell complex of compiled fields. `leaves` is a tiling made earlier, to be followed instead of the tests.
pub fn solve(fields: &Fields, options: &Options, leaves: Option<&[[Interval; 2]]>, control: &Control<'_>) -> Complex {
    let given: HashSet<[u64; 4]> = leaves.into_iter().flatten().map(key).collect();
    let side = fields.domain[0].width().max(fields.domain[1].width());
    let last = options.epsilon.unwrap_or(EPSILON * side);
    let mut epsilon = if options.exact { last.max(COARSE * side) } else { last };
    let stop = match leaves {
        Some(_) => Stop::At(&given),
        None => Stop::Epsilon(epsilon),
    };
    let mut subdivision = Subdivision { fields, stop, region: options.region, boxes: 0, evaluations: 0 };
    let mut isolator = Isolator::new(fields);
    let first = subdivision.run(vec![Work::root(fields)], control);
    let mut tiling = Tiling::new(&mut subdivision, &mut isolator, first, control);
    let (mut exact, mut beyond) = (0, 0);
    loop {
        let clusters = clusters(&tiling.leaves, &tiling.sides);
        let mut outcomes: Vec<Outcome> = Vec::with_capacity(clusters.len());
        let (mut finer, mut absorbed) = (Vec::new(), Vec::new());
        let mut settled = 0;
        for cluster in &clusters {
            let own = || cluster.leaves.iter().map(|&leaf| leaf as usize);
            let found = match options.exact && !control.is_cancelled() {
                true => settle(fields, &tiling, cluster),
                false => Settled::Open,
            };
            exact += u64::from(!matches!(found, Settled::Open));
            let hopeless = own().any(|leaf| tiling.leaves[leaf].hopeless);
            match found {
                Settled::Done(outcome) => {
                    settled += 1;
                    outcomes.push(outcome);
                    continue;
                }
                // Boxes of other curves are quartered as far as was asked; where exact arithmetic has a say, a little further.
                Settled::Open | Settled::Refine if hopeless => {}
                Settled::Open if epsilon <= last => {}
                Settled::Open | Settled::Refine => finer.extend(own()),
                Settled::Absorb(leaves) => absorbed.extend(leaves),
            }
            outcomes.push(unresolved(fields, &tiling, cluster));
        }
        let again = !finer.is_empty() && beyond < ROUNDS || !absorbed.is_empty();
        if !again || control.is_cancelled() {
            let mut complex = assemble(fields, &tiling, &clusters, outcomes);
            complex.effort.boxes = subdivision.boxes;
            complex.effort.evaluations += subdivision.evaluations + isolator.evaluations;
            (complex.effort.exact, complex.effort.settled) = (exact, settled);
            return complex;
        }
        for leaf in absorbed {
            tiling.leaves[leaf].open = true;
        }
        finer.sort_unstable();
        if epsilon > last {
            epsilon = last.max(FINER * epsilon);
        } else {
            beyond += 1;
            epsilon *= FINER;
        }
        if let Stop::Epsilon(stop) = &mut subdivision.stop {
            *stop = epsilon;
        }
        tiling = tiling.refined(&mut subdivision, &mut isolator, &finer, control);
    }
}
