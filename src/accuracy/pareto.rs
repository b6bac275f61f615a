//! What is worth its time: the levels that no other level beats in both error and time.

/// Which of the points (error, time) lie on the Pareto front: those that no other point equals or beats in both numbers
/// while it beats them in one. Of equal points all are on the front; a point with a NaN never is, and beats nothing.
pub fn front(points: &[(f64, f64)]) -> Vec<bool> {
    let known = |&(error, time): &(f64, f64)| !error.is_nan() && !time.is_nan();
    let beats = |a: &(f64, f64), b: &(f64, f64)| known(a) && a.0 <= b.0 && a.1 <= b.1 && a != b;
    points.iter().map(|point| known(point) && !points.iter().any(|other| beats(other, point))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_holds_what_nothing_beats() {
        let points = [(1.0, 5.0), (2.0, 2.0), (2.0, 3.0), (3.0, 2.0), (4.0, 1.0), (0.5, 9.0), (5.0, 1.0)];
        assert_eq!(front(&points), [true, true, false, false, true, true, false]);
    }

    #[test]
    fn equal_points_share_it_and_nan_has_no_part() {
        let points = [(1.0, 1.0), (1.0, 1.0), (f64::NAN, 0.0), (0.0, f64::NAN), (f64::INFINITY, 0.5)];
        assert_eq!(front(&points), [true, true, false, false, true]);
        assert!(front(&[]).is_empty());
    }
}
