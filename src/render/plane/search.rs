//! A search for points of both signs in pixels that a field crosses many times: peaks that a grid of points misses.
//!
//! Points are drawn all over the pixel, then around those whose values come nearest to 0, and one farther along the
//! gradient than the tangent's zero. Only the sign that the enclosure at a point proves counts.

use crate::interval::Interval;
use crate::kernel::verdict;
use crate::render::plane::kernels::Case;
use crate::render::plane::kernels::Evaluator;
use crate::render::plane::pixel::Pixel;
use crate::render::plane::pixel::sign;

/// Points of one round.
const POINTS: usize = 32;

/// Points around which the next round searches.
const BEST: usize = 4;

const ROUNDS: usize = 8;

/// By how much the neighbourhood shrinks from round to round.
const SHRINK: f64 = 0.4;

/// The pixels among `chosen` that are proved to be crossed.
pub fn search(evaluator: &mut Evaluator, pixels: &[Pixel], chosen: &[usize]) -> Vec<usize> {
    let mut crossed = Vec::new();
    let mut hunts: Vec<Hunt> = chosen.iter().filter_map(|&index| Hunt::new(&pixels[index], index)).collect();
    for round in 0..ROUNDS {
        let points: Vec<(usize, [f64; 2])> = hunts
            .iter_mut()
            .enumerate()
            .flat_map(|(hunt, state)| state.points(round).into_iter().map(move |point| (hunt, point)))
            .collect();
        let case = |hunt: usize, point: [f64; 2]| Case { area: point.map(Interval::point), ..hunts[hunt].steps };
        let cases: Vec<Case> = points.iter().map(|&(hunt, point)| case(hunt, point)).collect();
        let samples = evaluator.samples(cases.into_iter());
        for (&(hunt, point), sample) in points.iter().zip(&samples) {
            let hunt = &mut hunts[hunt];
            let estimate = &sample.estimates()[hunt.equation];
            hunt.signs |= sign(estimate.value);
            let value = estimate.value.mid();
            hunt.found.push((value.abs(), point, value, estimate.slope.map(Interval::mid)));
        }
        hunts.retain_mut(|hunt| {
            let both = hunt.signs == verdict::POSITIVE | verdict::NEGATIVE;
            if both {
                crossed.push(hunt.index);
            }
            hunt.found.sort_by(|a, b| a.0.total_cmp(&b.0));
            hunt.found.truncate(BEST);
            !both
        });
    }
    crossed
}

/// The same by the interval library, point by point.
pub fn search_exactly(evaluator: &mut Evaluator, pixels: &[Pixel], chosen: &[usize]) -> Vec<usize> {
    let mut found = |index: usize| {
        let mut hunt = Hunt::new(&pixels[index], index)?;
        for round in 0..ROUNDS {
            for point in hunt.points(round) {
                let case = Case { area: point.map(Interval::point), ..hunt.steps };
                // Most pixels need only a few points of the first round.
                let (value, slope) = evaluator.enclose(hunt.equation, &case, round > 0);
                hunt.signs |= sign(value);
                if hunt.signs == verdict::POSITIVE | verdict::NEGATIVE {
                    return Some(index);
                }
                hunt.found.push((value.mag(), point, value.mid(), slope));
            }
            hunt.found.sort_by(|a, b| a.0.total_cmp(&b.0));
            hunt.found.truncate(BEST);
        }
        None
    };
    chosen.iter().filter_map(|&index| found(index)).collect()
}

/// The search in one pixel.
struct Hunt {
    index: usize,
    area: [Interval; 2],
    equation: usize,
    steps: Case,
    signs: u32,
    random: u64,
    /// Size, place, value and gradient.
    found: Vec<(f64, [f64; 2], f64, [f64; 2])>,
}

impl Hunt {
    fn new(pixel: &Pixel, index: usize) -> Option<Self> {
        let random = pixel.area[0].lo().to_bits() ^ pixel.area[1].lo().to_bits().rotate_left(32);
        let Pixel { area, equation, steps, signs, .. } = *pixel;
        Some(Self { index, area, equation: equation?, steps, signs, random, found: Vec::new() })
    }

    /// A number in [0, 1): Steele, Lea and Flood, "Fast splittable pseudorandom number generators" (2014).
    fn random(&mut self) -> f64 {
        self.random = self.random.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.random;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 * (-53f64).exp2()
    }

    /// Where the next round looks.
    fn points(&mut self, round: usize) -> Vec<[f64; 2]> {
        let area = self.area;
        let clamp = |point: [f64; 2]| -> [f64; 2] {
            std::array::from_fn(|axis| point[axis].clamp(area[axis].lo(), area[axis].hi()))
        };
        if self.found.is_empty() {
            let place = |side: Interval, share: f64| side.lo() + share * side.width();
            return (0..POINTS)
                .map(|_| clamp([place(area[0], self.random()), place(area[1], self.random())]))
                .collect();
        }
        let reach = SHRINK.powi(round as i32);
        let mut points = Vec::with_capacity(POINTS);
        for (_, point, value, [a, b]) in self.found.clone() {
            let square = a * a + b * b;
            let newton = [a, b].map(|slope| 1.5 * value * slope / square);
            if newton.iter().all(|step| step.is_finite()) {
                points.push(clamp([point[0] - newton[0], point[1] - newton[1]]));
            }
            for _ in 0..POINTS / BEST - 1 {
                let near: [f64; 2] =
                    std::array::from_fn(|axis| point[axis] + reach * area[axis].width() * (self.random() - 0.5));
                points.push(clamp(near));
            }
        }
        points
    }
}
