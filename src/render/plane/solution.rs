//! Systems of two equations on a box: no solution, by a combination of the two that has no zero; or exactly one, by
//! Krawczyk's operator (R. Krawczyk, Computing 4, 1969).

use crate::interval::Interval;
use crate::render::plane::kernels::Estimate;

/// What is proved of two equations on a box on which both are continuous.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Solutions {
    None,
    /// At least one inside the box.
    Some,
    Unknown,
}

/// The centred form of an equation: value at the centre plus slope times step (Moore 1966).
pub fn centred(on_box: &Estimate, at_centre: &Estimate, step: [Interval; 2]) -> Interval {
    at_centre.value + on_box.slope[0] * step[0] + on_box.slope[1] * step[1]
}

/// Looks for common zeros of two functions; `step` is the box less its centre.
pub fn solve(on_box: [&Estimate; 2], at_centre: [&Estimate; 2], step: [Interval; 2]) -> Solutions {
    let slopes = on_box.map(|estimate| estimate.slope);
    let known = at_centre.iter().all(|estimate| !estimate.value.is_empty());
    if !known || slopes.as_flattened().iter().any(|slope| !slope.is_bounded()) {
        return Solutions::Unknown;
    }
    let middle = slopes.map(|row| row.map(Interval::mid));
    // l f + m g, whose slopes nearly cancel if those of f and g are parallel.
    let combined = |[l, m]: [f64; 2]| {
        let [l, m] = [l, m].map(Interval::point);
        let slope = [0, 1].map(|axis| l * slopes[0][axis] + m * slopes[1][axis]);
        (l * at_centre[0].value + m * at_centre[1].value, slope)
    };
    for axis in [0, 1] {
        let (value, slope) = combined([middle[1][axis], -middle[0][axis]]);
        let form = value + slope[0] * step[0] + slope[1] * step[1];
        if !form.contains(0.0) {
            return Solutions::None;
        }
    }
    let [[a, b], [c, d]] = middle;
    let determinant = a * d - b * c;
    let inverse = [[d, -b], [-c, a]].map(|row| row.map(|entry| entry / determinant));
    if inverse.as_flattened().iter().any(|entry| !entry.is_finite()) {
        return Solutions::Unknown;
    }
    // K(X) - c = -Y F(c) + (1 - Y J)(X - c)
    let image = [0, 1].map(|row| {
        let (value, slope) = combined(inverse[row]);
        let rest = [0, 1].map(|axis| if axis == row { Interval::ONE - slope[axis] } else { -slope[axis] });
        -value + rest[0] * step[0] + rest[1] * step[1]
    });
    if image.iter().zip(step).any(|(image, step)| image.disjoint(step)) {
        Solutions::None
    } else if image.iter().zip(step).all(|(image, step)| image.interior(step)) {
        Solutions::Some
    } else {
        Solutions::Unknown
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(value: f64, slope: [f64; 2]) -> Estimate {
        Estimate { value: Interval::point(value), slope: slope.map(Interval::point), bits: 0 }
    }

    #[test]
    fn lines_meet_once_or_not_at_all() {
        let step = [Interval::new(-1.0, 1.0).unwrap(); 2];
        let find = |f: [f64; 3], g: [f64; 3]| {
            let [f, g] = [f, g].map(|[value, x, y]| line(value, [x, y]));
            solve([&f, &g], [&f, &g], step)
        };
        assert_eq!(find([0.0, 1.0, -1.0], [0.0, 1.0, 1.0]), Solutions::Some);
        // They meet at (0.5, 0.5), and at (1.5, 1.5) outside.
        assert_eq!(find([0.0, 1.0, -1.0], [-1.0, 1.0, 1.0]), Solutions::Some);
        assert_eq!(find([0.0, 1.0, -1.0], [-3.0, 1.0, 1.0]), Solutions::None);
        // Parallel, apart by far less than the box is wide.
        assert_eq!(find([0.0, 1.0, -1.0], [1e-9, 1.0, -1.0]), Solutions::None);
        assert_eq!(find([0.0, 1.0, -1.0], [0.0, 2.0, -2.0]), Solutions::Unknown);
    }
}
