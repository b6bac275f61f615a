//! The first root of a torus: two published methods lose it on one ray in twenty-five, Imp proves it on the same rays.

use imp::render::Ray;

use crate::case::Case;
use crate::plain::Plain;
use crate::shot::Faults;
use crate::shot::Survey;
use crate::shot::faults;
use crate::shot::options;
use crate::torus::Quartic;
use crate::torus::Torus;

/// Eyes around the torus.
const EYES: [&str; 6] = [
    "[2.1, -1.3, 0.4]",
    "[-1.2, 1.9, 1.1]",
    "[0.3, -2.2, 0.9]",
    "[1.5, 1.4, -0.6]",
    "[-2.0, -0.7, 0.2]",
    "[0.2, 0.4, 2.4]",
];

/// The ray's parameters where it enters and leaves the sphere of radius 1 around the torus.
fn enclosing_sphere(ray: &Ray) -> Option<[f64; 2]> {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (o, d) = (ray.origin, ray.direction);
    let (a, b, c) = (dot(d, d), dot(o, d), dot(o, o) - 1.0);
    let root = (b * b - a * c).sqrt();
    (root > 0.0).then(|| [((-b - root) / a).max(0.0), (-b + root) / a])
}

fn bisection<T: Plain>(ray: &Ray, _: [f64; 2]) -> Option<f64> {
    let [near, far] = enclosing_sphere(ray)?;
    let quartic = Quartic::<T>::from(ray, near);
    let t = quartic.double_derivative_bisection(T::of(far - near) * quartic.speed())?;
    Some(near + (t / quartic.speed()).to_f64())
}

fn newton<T: Plain>(ray: &Ray, _: [f64; 2]) -> Option<f64> {
    stepped::<T>(ray, false)
}

fn stepped<T: Plain>(ray: &Ray, forward: bool) -> Option<f64> {
    let [near, _] = enclosing_sphere(ray)?;
    let quartic = Quartic::<T>::from(ray, near);
    let t = near + (quartic.clamped_newton(forward) / quartic.speed()).to_f64();
    // Accepted within a thousandth of the small radius around the tube.
    let [x, y, z] = ray.at(t);
    let off = (x.hypot(y) - 0.7).hypot(z) - 0.3;
    (off.abs() <= 0.001 * 0.3).then_some(t)
}

/// The torus from all eyes.
fn survey() -> Survey {
    let view = |eye: &str| format!("domain [-1.1, 1.1]^3\ncamera(position = {eye}, target = [0, 0, 0], fov = 55)");
    let survey = Survey::new::<Torus>(&EYES.map(view), &options(32));
    assert!(survey.tally.proved > 2000 && survey.tally.unknown < 10, "{:?}", survey.tally);
    survey
}

/// A plain root finder: from the ray and the bounds of its parameter to the root that it takes for the first.
type Find = fn(&Ray, [f64; 2]) -> Option<f64>;

/// What a method of both formats makes of its rays: more than one in 33 is at fault.
fn found(survey: &Survey, find: [Find; 2]) -> [Faults; 2] {
    let found = find.map(|find| faults(&survey.looks, 1e-2, find));
    let least = survey.tally.proved / 33;
    assert!(found.iter().all(|faults| faults.lost + faults.wrong > least), "{found:?}");
    found
}

pub fn derivative_bisection() -> Case {
    let survey = survey();
    survey.case(
        "torus, double derivative bisection",
        "Where a local maximum outside the torus lies before the split at the third derivative's root, the first part is taken for empty, and a later root is found.",
        found(&survey, [bisection::<f32>, bisection::<f64>]),
    )
}

pub fn clamped_newton() -> Case {
    let survey = survey();
    let forward = faults(&survey.looks, 1e-2, |ray, _| stepped::<f64>(ray, true));
    assert_eq!(forward.lost, 0, "{forward}");
    survey.case(
        "torus, Newton with steps of at most 0.15",
        "Behind a local maximum outside the torus the tangent leads back, into a minimum that is no root; with every step outside forced forward, none is lost.",
        found(&survey, [newton::<f32>, newton::<f64>]),
    )
}
