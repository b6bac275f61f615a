//! Where two functions vanish together: the interval Newton method in the plane, on many boxes at once.

use crate::arrange::field::Fields;
use crate::arrange::field::Function;
use crate::arrange::subdivide::middle;
use crate::interval::Interval;

/// Steps after which a box is taken as it is.
const STEPS: usize = 60;

/// A pair of functions on a box on which both are continuous and no matrix in the enclosure of their Jacobian is singular.
#[derive(Debug, Clone)]
pub struct Pair {
    pub functions: [Function; 2],
    /// Narrowed around the common zeros.
    pub area: [Interval; 2],
}

/// Narrows each box by c - J^-1 (f(c), g(c)), by Cramer's rule, which contains all common zeros in the box. Returns the
/// number of evaluations.
pub fn refine(fields: &Fields, pairs: &mut [Pair]) -> u64 {
    let mut evaluations = 0;
    let mut going: Vec<usize> = (0..pairs.len()).collect();
    for _ in 0..STEPS {
        if going.is_empty() {
            break;
        }
        let mut queries = Vec::with_capacity(4 * going.len());
        for &index in &going {
            let Pair { functions, area, .. } = pairs[index];
            for function in functions {
                queries.push((function, area));
                queries.push((function, middle(area)));
            }
        }
        evaluations += queries.len() as u64;
        let samples = fields.evaluate(&queries);
        let mut still = Vec::new();
        for (&index, samples) in going.iter().zip(samples.chunks(4)) {
            let pair = &mut pairs[index];
            let ([fx, fy], [gx, gy]) = (samples[0].slope, samples[2].slope);
            let (f, g) = (samples[1].value, samples[3].value);
            let determinant = fx * gy - fy * gx;
            let centre = middle(pair.area);
            let next = [centre[0] - (f * gy - fy * g) / determinant, centre[1] - (fx * g - f * gx) / determinant];
            let next = [next[0].intersect(pair.area[0]), next[1].intersect(pair.area[1])];
            // Numbers too large to be divided leave nothing behind, which proves nothing.
            if next.iter().any(|side| side.is_empty()) {
                continue;
            }
            let narrower = next.iter().zip(&pair.area).any(|(new, old)| new.width() < 0.9 * old.width());
            pair.area = next;
            if narrower {
                still.push(index);
            }
        }
        going = still;
    }
    evaluations
}
