//! The stages in their order: from a scene to its arrangement.

use std::collections::HashSet;
use std::time::Instant;

use crate::arrange::assemble::Outcome;
use crate::arrange::assemble::assemble;
use crate::arrange::cluster::Cluster;
use crate::arrange::cluster::clusters;
use crate::arrange::complex::Complex;
use crate::arrange::complex::VertexKind;
use crate::arrange::field::Fields;
use crate::arrange::options::Options;
use crate::arrange::sides::Isolator;
use crate::arrange::subdivide::Stop;
use crate::arrange::subdivide::Subdivision;
use crate::arrange::subdivide::Work;
use crate::arrange::subdivide::key;
use crate::arrange::tiling::Tiling;
use crate::control::Control;
use crate::interval::Interval;

/// The side at which boxes stop being quartered, as a part of the domain's, unless it is given.
const EPSILON: f64 = 1.0 / (1u64 << 30) as f64;

/// The cell complex of compiled fields. `leaves` is a tiling made earlier, to be followed instead of the tests.
pub fn solve(fields: &Fields, options: &Options, leaves: Option<&[[Interval; 2]]>, control: &Control<'_>) -> Complex {
    let start = Instant::now();
    let given: HashSet<[u64; 4]> = leaves.into_iter().flatten().map(key).collect();
    let side = fields.domain[0].width().max(fields.domain[1].width());
    let stop = match leaves {
        Some(_) => Stop::At(&given),
        None => Stop::Epsilon(options.epsilon.unwrap_or(EPSILON * side)),
    };
    let mut subdivision = Subdivision { fields, stop, region: options.region, boxes: 0, evaluations: 0 };
    let mut isolator = Isolator::new(fields);
    let first = subdivision.run(vec![Work::root(fields)], control);
    let tiling = Tiling::new(&mut subdivision, &mut isolator, first, control);
    let clusters = clusters(&tiling.leaves, &tiling.sides);
    let outcomes = clusters.iter().map(unresolved).collect();
    let mut complex = assemble(fields, &tiling, &clusters, outcomes);
    complex.effort.boxes = subdivision.boxes;
    complex.effort.evaluations += subdivision.evaluations + isolator.evaluations;
    let _ = start;
    complex
}

/// A cluster of which nothing more is known.
fn unresolved(cluster: &Cluster) -> Outcome {
    Outcome::Vertex { kind: VertexKind::Cluster, area: cluster.area, proved: false, note: None }
}
