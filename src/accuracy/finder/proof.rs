//! What of a claimed hit is proved: a change of sign over a bracket on which the field is continuous, condition and domain
//! hold, with everything before it refuted.

use crate::accuracy::finder::Found;
use crate::accuracy::finder::kernels::Lanes;
use crate::accuracy::finder::kernels::Programs;
use crate::accuracy::finder::kernels::Reach;
use crate::accuracy::finder::search::Rules;
use crate::interval::Interval;
use crate::kernel::Real;
use crate::kernel::verdict;
use crate::render::Batch;
use crate::render::Ray;

/// Packets of the batch.
const GROUPS: usize = 12;
/// The bracket, its start and its end.
const PARTS: usize = 3;

/// Settles which of the hits are proved. Only for kernels that round outward.
pub fn prove<T: Real>(
    programs: &Programs<T>,
    reach: &Reach,
    rules: Rules,
    rays: &[Option<Ray>],
    domain: &[Interval],
    found: &mut [Found],
) {
    let lanes = Lanes { reach, condition: rules.condition };
    let mut batch = Batch::new(&programs.field, GROUPS);
    let mut trials: Vec<usize> = Vec::new();
    for pixel in 0..found.len() {
        if let (Some([a, b]), true, Some(ray)) = (found[pixel].hit, found[pixel].clear, &rays[pixel])
            && let Some((entry, exit)) = ray.clip(domain)
            && entry[1] <= a
            && b <= exit[0]
        {
            for (part, span) in [[a, b], [a, a], [b, b]].into_iter().enumerate() {
                let lane = PARTS * trials.len() + part;
                lanes.set_ray(&mut batch, lane, ray);
                lanes.set_span(&mut batch, lane, span);
            }
            trials.push(pixel);
        }
        if !trials.is_empty() && (pixel + 1 == found.len() || PARTS * (trials.len() + 1) > batch.capacity()) {
            batch.run(PARTS * trials.len());
            for (place, pixel) in trials.drain(..).enumerate() {
                let [whole, start, end] = [0, 1, 2].map(|part| lanes.field(&batch, PARTS * place + part));
                const HOLDS: u32 = verdict::POSITIVE | verdict::CONTINUOUS;
                let crosses = if rules.region { start.sign() > 0 } else { start.sign() != 0 };
                found[pixel].proved =
                    whole.continuous && whole.condition & HOLDS == HOLDS && crosses && end.sign() == -start.sign();
            }
        }
    }
}
