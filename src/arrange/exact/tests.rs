//! Known singularities, and near misses that must not pass for them.

use std::cmp::Ordering;

use crate::arrange::complex::Axis;
use crate::arrange::exact::Algebra;
use crate::arrange::exact::Contact;
use crate::arrange::exact::Finding;
use crate::arrange::exact::Polynomial;
use crate::arrange::exact::Star;
use crate::arrange::exact::coprime_base;
use crate::arrange::exact::settle;
use crate::interval::Interval;

fn poly(terms: &[(i64, usize, usize)]) -> Polynomial {
    Polynomial::from_terms(terms)
}

/// A square around a point.
fn around(x: f64, y: f64, radius: f64) -> [Interval; 2] {
    [x, y].map(|c| Interval::new(c - radius, c + radius).unwrap())
}

fn star(polys: &[&Polynomial], area: [Interval; 2]) -> Star {
    match settle(polys, area) {
        Finding::Star(star) => star,
        other => panic!("{polys:?}: {other:?}"),
    }
}

/// The star's arms by polynomial, with its point checked.
fn arms(polys: &[&Polynomial], x: f64, y: f64, radius: f64) -> Vec<u32> {
    let star = star(polys, around(x, y, radius));
    for (side, at) in star.point.iter().zip([x, y]) {
        let width = side.hi() - side.lo();
        assert!(side.lo() - 1e-15 <= at && at <= side.hi() + 1e-15 && width <= 4e-16, "{side:?} is not at {at}");
    }
    assert_eq!(star.around.len() as u32, star.branches.iter().map(|b| b.arms).sum::<u32>());
    star.branches.iter().map(|branch| branch.arms).collect()
}

fn circle(x: i64, y: i64, square: i64) -> Polynomial {
    poly(&[(1, 2, 0), (1, 0, 2), (-2 * x, 1, 0), (-2 * y, 0, 1), (x * x + y * y - square, 0, 0)])
}

#[test]
fn singular_points_of_one_curve() {
    let folium = poly(&[(1, 3, 0), (1, 0, 3), (-3, 1, 1)]);
    let cusp = poly(&[(1, 0, 2), (-1, 3, 0)]);
    let tacnode = poly(&[(1, 0, 2), (-1, 4, 0)]);
    let isolated = poly(&[(1, 2, 0), (1, 0, 2)]);
    let fourfold = poly(&[(1, 4, 0), (2, 2, 2), (1, 0, 4), (1, 3, 0), (-1, 2, 1)]);
    let three = poly(&[(1, 4, 0), (2, 2, 2), (1, 0, 4), (-3, 2, 1), (1, 0, 3)]);
    let two = poly(&[(1, 6, 0), (3, 4, 2), (3, 2, 4), (1, 0, 6), (-4, 2, 2)]);
    for (curve, expected) in [
        (folium, 4),
        (cusp.clone(), 2),
        (cusp.exchanged(), 2),
        (tacnode, 4),
        (isolated, 0),
        (fourfold, 4),
        (three, 6),
        (two, 8),
    ] {
        for radius in [1e-3, 1e-12] {
            let area = around(0.0, 0.0, radius);
            let star = star(&[&curve], area);
            assert_eq!(star.branches[0].arms, expected, "{curve}");
            assert!(star.branches[0].singular && !star.regular, "{curve}");
            assert!(
                star.point.iter().all(|side| side.lo() <= 0.0 && 0.0 <= side.hi() && side.hi() - side.lo() < 1e-20)
            );
        }
    }
}

#[test]
fn a_vertical_tangent_is_regular() {
    let star = star(&[&circle(0, 0, 2)], around(2f64.sqrt(), 0.0, 1e-9));
    assert!(star.regular);
    assert_eq!(star.branches[0].arms, 2);
}

#[test]
fn three_lines_through_a_rational_point() {
    let lines =
        [poly(&[(3, 1, 0), (-1, 0, 0)]), poly(&[(7, 0, 1), (-1, 0, 0)]), poly(&[(3, 1, 0), (7, 0, 1), (-2, 0, 0)])];
    let lines: Vec<&Polynomial> = lines.iter().collect();
    assert_eq!(arms(&lines, 1.0 / 3.0, 1.0 / 7.0, 1e-10), [2, 2, 2]);
    let star = star(&lines, around(1.0 / 3.0, 1.0 / 7.0, 1e-10));
    assert!(star.contacts.len() == 3 && star.contacts.iter().all(|c| c.2 == Contact::Transversal));
    let fourth = poly(&[(3, 1, 0), (-7, 0, 1)]);
    let all: Vec<&Polynomial> = lines.iter().copied().chain([&fourth]).collect();
    assert_eq!(arms(&all, 1.0 / 3.0, 1.0 / 7.0, 1e-10), [2, 2, 2, 2]);
}

#[test]
fn tangencies_at_irrational_points() {
    // The unit circle and x + y = sqrt 2, as a pair of parallel lines: (x + y)^2 = 2.
    let unit = circle(0, 0, 1);
    let lines = poly(&[(1, 2, 0), (2, 1, 1), (1, 0, 2), (-2, 0, 0)]);
    let half = 0.5f64.sqrt();
    let touch = star(&[&unit, &lines], around(half, half, 1e-9));
    assert_eq!(touch.contacts, [(0, 1, Contact::Touching)]);
    assert_eq!(arms(&[&unit, &lines], half, half, 1e-9), [2, 2]);
    // The circles of radius 1 around (1, sqrt 3) and (1, -sqrt 3), as one curve, touch the unit circle from outside, the
    // first one at (1/2, sqrt(3)/2).
    // ((x - 1)^2 + y^2 + 2)^2 = 12 y^2.
    let square = poly(&[(1, 2, 0), (-2, 1, 0), (1, 0, 2), (3, 0, 0)]);
    let pair = square.mul(&square).sub(&poly(&[(12, 0, 2)]));
    let touch = star(&[&unit, &pair], around(0.5, 0.75f64.sqrt(), 1e-9));
    assert_eq!(touch.contacts, [(0, 1, Contact::Touching)]);
    assert_eq!(arms(&[&pair, &unit], 0.5, 0.75f64.sqrt(), 1e-9), [2, 2]);
    // y = x^3 crosses its tangent.
    let cubic = poly(&[(1, 0, 1), (-1, 3, 0)]);
    let cross = star(&[&cubic, &poly(&[(1, 0, 1)])], around(0.0, 0.0, 1e-6));
    assert_eq!(cross.contacts, [(0, 1, Contact::Crossing)]);
    // x = y^3 and the y axis, vertical tangents.
    let cross = star(&[&cubic.exchanged(), &poly(&[(1, 1, 0)])], around(0.0, 0.0, 1e-6));
    assert_eq!(cross.contacts, [(0, 1, Contact::Crossing)]);
    let touch =
        star(&[&poly(&[(1, 1, 0), (-1, 0, 2)]), &poly(&[(1, 1, 0), (-1, 0, 4), (1, 0, 2)])], around(0.0, 0.0, 1e-6));
    assert_eq!(touch.contacts, [(0, 1, Contact::Touching)]);
}

#[test]
fn triple_points_with_a_vertical_line_at_an_irrational_place() {
    // x^2 = 2, y^2 = 3 and x y = sqrt 6 as (x y)^2 = 6 meet at (sqrt 2, sqrt 3).
    let vertical = poly(&[(1, 2, 0), (-2, 0, 0)]);
    let horizontal = poly(&[(1, 0, 2), (-3, 0, 0)]);
    let hyperbolas = poly(&[(1, 2, 2), (-6, 0, 0)]);
    let all = [&vertical, &horizontal, &hyperbolas];
    assert_eq!(arms(&all, 2f64.sqrt(), 3f64.sqrt(), 1e-8), [2, 2, 2]);
    let star = star(&all, around(2f64.sqrt(), 3f64.sqrt(), 1e-8));
    assert!(star.contacts.len() == 3 && star.contacts.iter().all(|c| c.2 == Contact::Transversal));
}

#[test]
fn near_misses_are_no_stars() {
    let ten = |n: u32| num_bigint::BigInt::from(10).pow(n);
    let constant = Polynomial::constant;
    // x y = 10^-30
    let hyperbola = poly(&[(1, 1, 1)]).scale(&ten(30)).sub(&constant(ten(0)));
    assert!(!matches!(settle(&[&hyperbola], around(0.0, 0.0, 1e-9)), Finding::Star(_) | Finding::Nothing(_)));
    // Two unit circles a gap apart, and an overlap.
    let unit = circle(0, 0, 1);
    for digits in [12, 40] {
        for sign in [1, -1] {
            // (x - 2 - gap)^2 + y^2 = 1, times 10^(2 digits)
            let line = poly(&[(1, 1, 0), (-2, 0, 0)]).scale(&ten(digits)).sub(&constant(sign * ten(0)));
            let second = line.mul(&line).add(&poly(&[(1, 0, 2), (-1, 0, 0)]).scale(&ten(2 * digits)));
            let finding = settle(&[&unit, &second], around(1.0, 0.0, 1e-6));
            assert!(!matches!(finding, Finding::Star(_) | Finding::Nothing(_)), "{finding:?}");
            if sign == 1 {
                let Finding::Arcs(arcs) = finding else { panic!("{finding:?}") };
                assert_eq!(arcs.counts, [1, 1]);
            }
        }
    }
    // x^2 + y^2 = 10^-40: an oval inside a large box, nothing in a box beside it.
    let oval = poly(&[(1, 2, 0), (1, 0, 2)]).scale(&ten(40)).sub(&constant(ten(0)));
    assert!(!matches!(settle(&[&oval], around(0.0, 0.0, 1e-9)), Finding::Star(_) | Finding::Nothing(_)));
    assert!(matches!(settle(&[&oval], around(1e-18, 0.0, 1e-19)), Finding::Nothing(_)));
    let empty = poly(&[(1, 2, 0), (1, 0, 2)]).scale(&ten(40)).add(&constant(ten(0)));
    assert!(matches!(settle(&[&empty], around(0.0, 0.0, 1e-9)), Finding::Nothing(_)));
}

#[test]
fn boxes_beside_the_event() {
    let folium = poly(&[(1, 3, 0), (1, 0, 3), (-3, 1, 1)]);
    // The vertex (3/2, 3/2) is regular, and there is nothing at (1, 1).
    let Finding::Arcs(arcs) = settle(&[&folium], around(1.5, 1.5, 1e-6)) else { panic!() };
    assert_eq!(arcs.counts, [1]);
    assert!(matches!(settle(&[&folium], around(1.0, 1.0, 1e-6)), Finding::Nothing(_)));
    // Two events in one box.
    let pair = circle(0, 0, 1).mul(&poly(&[(1, 0, 1)]));
    assert!(matches!(settle(&[&pair], around(0.0, 0.0, 2.0)), Finding::Several(_) | Finding::Unknown(_)));
}

#[test]
fn answers_are_remembered_between_questions() {
    let algebra = Algebra::new([circle(0, 0, 25), circle(6, 8, 25), poly(&[(4, 1, 0), (-3, 0, 1)])]);
    // The circles touch at (3, 4), where the line 4 x = 3 y crosses both.
    for _ in 0..2 {
        let Finding::Star(star) = algebra.settle(&[0, 1, 2], around(3.0, 4.0, 1e-9)) else { panic!() };
        let kinds: Vec<Contact> = star.contacts.iter().map(|c| c.2).collect();
        assert_eq!(kinds, [Contact::Touching, Contact::Transversal, Contact::Transversal]);
        assert!(star.point[0].lo() <= 3.0 && 3.0 <= star.point[0].hi());
    }
}

#[test]
fn curves_that_nearly_meet_in_a_point() {
    // Three lines, the third 10^-20 beside the crossing of the two others; y^2 = x^4 + 10^-40; a node pulled apart.
    let large = num_bigint::BigInt::from(10).pow(20);
    let (first, second) = (poly(&[(1, 0, 1), (-1, 1, 0)]), poly(&[(1, 0, 1), (1, 1, 0)]));
    let third = poly(&[(1, 0, 1), (-2, 1, 0)]).scale(&large).sub(&Polynomial::constant(1.into()));
    let finding = settle(&[&first, &second, &third], around(0.0, 0.0, 1e-12));
    assert!(matches!(finding, Finding::Several(_)), "{finding:?}");
    assert_eq!(arms(&[&first, &third], 0.0, 0.0, 1e-12), [2, 2]);
    let square = &large * &large;
    let apart = poly(&[(1, 0, 2), (-1, 4, 0)]).scale(&square).sub(&Polynomial::constant(1.into()));
    let Finding::Arcs(arcs) = settle(&[&apart], around(0.0, 0.0, 1e-6)) else { panic!() };
    assert_eq!(arcs.counts, [2]);
    let folium = poly(&[(1, 3, 0), (1, 0, 3), (-3, 1, 1)]).scale(&square);
    for shift in [1, -1] {
        let apart = folium.sub(&Polynomial::constant(shift.into()));
        let finding = settle(&[&apart], around(0.0, 0.0, 1e-9));
        assert!(!matches!(finding, Finding::Star(_) | Finding::Nothing(_)), "{finding:?}");
    }
}

#[test]
fn a_crossing_of_irreducible_factors_that_are_not_known() {
    // An ellipse times a hyperbola, in one polynomial, where they cross: x^2 + 2 y^2 = 3, 2 x y = 1. With t = x^2:
    // 2 t^2 - 6 t + 1 = 0.
    let product = poly(&[(1, 2, 0), (2, 0, 2), (-3, 0, 0)]).mul(&poly(&[(2, 1, 1), (-1, 0, 0)]));
    let x = ((3.0 + 7f64.sqrt()) / 2.0).sqrt();
    let star = star(&[&product], around(x, 0.5 / x, 1e-9));
    assert_eq!((star.branches[0].arms, star.branches[0].singular), (4, true));
    assert!((star.point[0].mid() - x).abs() < 1e-15 && star.point[0].hi() - star.point[0].lo() < 1e-15);
}

/// Zeros on the boundary of a box, all simple; `None` if one is not, or in a corner.
fn boundary(polys: &[Polynomial], [x, y]: [Interval; 2]) -> Option<Vec<u32>> {
    let sides = [(Axis::X, y.lo(), x), (Axis::X, y.hi(), x), (Axis::Y, x.lo(), y), (Axis::Y, x.hi(), y)];
    let count = |poly: &Polynomial| {
        let roots = sides.map(|(axis, at, side)| poly.roots_on(axis, at, side.lo(), side.hi()));
        let roots: Option<Vec<_>> = roots.into_iter().collect();
        let roots = roots?.concat();
        roots.iter().all(|root| root.multiplicity == 1).then_some(roots.len() as u32)
    };
    polys.iter().map(count).collect()
}

/// Signs at the points of a grid, with zeros left out.
fn signs(poly: &Polynomial, [x, y]: [Interval; 2]) -> Vec<Ordering> {
    let at = |side: Interval, i: u32| side.lo() + (side.hi() - side.lo()) * f64::from(i) / 12.0;
    let points = (0..=12).flat_map(|i| (0..=12).map(move |j| [at(x, i), at(y, j)]));
    points.filter_map(|point| poly.sign_at(point).filter(|sign| sign.is_ne())).collect()
}

#[test]
fn random_lines_and_conics_agree_with_roots_on_the_boundary() {
    let mut random = fastrand::Rng::with_seed(7);
    let (mut stars, mut arcs, mut nothing) = (0, 0, 0);
    for round in 0..60 {
        let mut curves = Vec::new();
        for _ in 0..random.usize(2..4) {
            let mut c = || random.i64(-5..6);
            let (a, b) = (c(), c());
            let (d, e, f) = if round % 3 == 0 { (0, 0, 0) } else { (c(), c(), c()) };
            // Every second time through (1, -1).
            let constant = if round % 2 == 0 { b - a - d + e - f } else { c() };
            curves.push(poly(&[(a, 1, 0), (b, 0, 1), (d, 2, 0), (e, 1, 1), (f, 0, 2), (constant, 0, 0)]));
        }
        let (base, complete) = coprime_base(&curves);
        assert!(complete);
        let polys: Vec<Polynomial> = base.into_iter().map(|(poly, _)| poly).collect();
        let algebra = Algebra::new(polys.clone());
        let all: Vec<usize> = (0..polys.len()).collect();
        let product = polys.iter().fold(poly(&[(1, 0, 0)]), |product, poly| product.mul(poly));
        let boxes = (0..6).map(|_| around(random.f64() * 4.0 - 2.0, random.f64() * 4.0 - 2.0, 0.1));
        for area in boxes.chain([around(1.0, -1.0, 1e-6)]) {
            match algebra.settle(&all, area) {
                Finding::Star(star) => {
                    stars += 1;
                    let arms: Vec<u32> = star.branches.iter().map(|branch| branch.arms).collect();
                    if let Some(count) = boundary(&polys, star.within) {
                        assert_eq!(count, arms, "{polys:?} in {area:?}");
                    }
                    if area == around(1.0, -1.0, 1e-6) {
                        assert!(star.point[0].lo() <= 1.0 && 1.0 <= star.point[0].hi());
                        assert!(star.point[1].lo() <= -1.0 && -1.0 <= star.point[1].hi());
                    }
                }
                Finding::Arcs(found) => {
                    arcs += 1;
                    if let Some(count) = boundary(&polys, found.within) {
                        assert_eq!(
                            count,
                            found.counts.iter().map(|n| 2 * n).collect::<Vec<_>>(),
                            "{polys:?} in {area:?}"
                        );
                    }
                }
                Finding::Nothing(within) => {
                    nothing += 1;
                    let signs = signs(&product, within);
                    assert!(signs.windows(2).all(|pair| pair[0] == pair[1]), "{polys:?} in {area:?}");
                }
                Finding::Several(_) | Finding::Unknown(_) => {}
            }
        }
    }
    assert!(stars > 30 && arcs > 30 && nothing > 30, "{stars} stars, {arcs} arcs, {nothing} empty boxes");
}
