//! Rays that graze a surface, and surfaces far from the eye, from 1 or from the origin.

use imp::derive::Precision;
use imp::interval::Interval;
use imp::render::Certainty;
use imp::render::Options;
use imp::render::Ray;
use imp::render::Stop;

use crate::case::Case;
use crate::exact::sign;
use crate::formula::Formula;
use crate::plain::Plain;
use crate::plain::Surface;
use crate::plain::close;
use crate::plain::march;
use crate::plain::surface;
use crate::shot::STEPS;
use crate::shot::Shot;
use crate::shot::Survey;
use crate::shot::Tally;
use crate::shot::check;
use crate::shot::faults;
use crate::shot::options;
use crate::shot::shoot;
use crate::shot::window;
use crate::torus::Quartic;
use crate::torus::Torus;

/// One ray along the y axis from 0 to 10, where t is y + 6.
fn along_y(equation: &str) -> Shot {
    let view = "domain [-1, 1] x [0, 10] x [-1, 1]\ncamera(position = [0, -6, 0], target = [0, 5, 0])";
    shoot(&format!("{equation}\n{view}"), &options(1))
}

/// y^2 - 10 y + 25 + d, marched in steps of 1e-4, none of which is at 5.
fn tangent<T: Plain>(d: f64) -> Option<f64> {
    march(|y: T| y * y - T::int(10) * y + T::int(25) + T::of(d), [0.0, 10.0], 99_991)
}

pub fn near_tangent() -> Case {
    let (mut counts, mut squares, mut invented) = (Vec::new(), Vec::new(), [0; 2]);
    for exponent in 0..=12 {
        // The form without a square is the hard one: y occurs twice.
        for (text, counts) in [("y^2 - 10 y + 25", &mut counts), ("(y - 5)^2", &mut squares)] {
            let shot = along_y(&format!("{text} + 1e-{exponent} = 0"));
            assert_eq!(shot.picture.certainty, [Certainty::Miss], "{text}, d = 1e-{exponent}");
            assert_eq!(shot.picture.depth, [None]);
            counts.push(shot.evaluations());
        }
        let d = 10f64.powi(-exponent);
        invented[0] += usize::from(tangent::<f32>(d).is_some());
        invented[1] += usize::from(tangent::<f64>(d).is_some());
    }
    assert!(invented[0] >= 5 && invented[1] == 0, "{invented:?}");
    // Cells of a bisection that tests the natural extension alone grow as d^(-1/2); slopes and centred forms keep the cost
    // near the logarithm.
    assert!(counts.iter().all(|&count| count < 300) && squares.iter().all(|&count| count < 10));
    Case {
        name: "(t - 5)^2 + d for d = 1, 0.1, .. 1e-12",
        why: "The expanded form t^2 - 10 t + 25 + d cancels from 25 to d, which is less than the rounding of f32 from 1e-6 on.",
        single: format!("{} of 13 invented", invented[0]),
        double: format!("{} of 13 invented", invented[1]),
        imp: "13 missed, expanded or not".to_owned(),
        cost: format!("evaluations by d: {counts:?}, as a square {squares:?}"),
    }
}

surface!(Touching, "y^2 - 10 y + 25 = 0", |_x, y, _z| y.power(2) - N::int(10) * y + N::int(25));
surface!(Grazing, "y^2 - 10 y + 25 - 1e-12 = 0", |_x, y, _z| {
    y.power(2) - N::int(10) * y + N::int(25) - N::ratio(1, 1_000_000_000_000)
});

fn found(root: Option<f64>) -> String {
    root.map_or("lost".to_owned(), |y| format!("t = {y:.4}"))
}

pub fn touching() -> Case {
    let mut cost = Vec::new();
    for text in [Touching::TEXT, "(y - 5)^2 = 0"] {
        let shot = along_y(text);
        let looks = shot.looks();
        assert_eq!(check::<Touching>(&looks), Tally { unknown: 1, ..Tally::default() });
        let depth = looks[0].depth.expect("what is unknown is drawn");
        assert!((depth.t - 11.0).abs() < 1e-5, "{depth:?}");
        cost.push(shot.evaluations());
    }
    let (single, double) = (tangent::<f32>(0.0), tangent::<f64>(0.0));
    assert!(double.is_none());
    Case {
        name: "(t - 5)^2 = 0",
        why: "The ray touches without crossing: no sign changes, so no arithmetic with bounds can prove the root, and none may pass over it.",
        single: found(single),
        double: found(double),
        imp: "unknown, drawn at t = 5".to_owned(),
        cost: format!("{cost:?} evaluations, expanded and as a square"),
    }
}

pub fn grazing() -> Case {
    let shot = along_y(Grazing::TEXT);
    assert_eq!(check::<Grazing>(&shot.looks()), Tally { proved: 1, ..Tally::default() });
    let (single, double) = (tangent::<f32>(-1e-12), tangent::<f64>(-1e-12));
    assert!(double.is_none());
    Case {
        name: "(t - 5)^2 - 1e-12 = 0",
        why: "Two roots 2e-6 apart lie between two samples; what f32 finds at 5 is its own noise.",
        single: found(single),
        double: found(double),
        imp: "proved".to_owned(),
        cost: format!("{} evaluations", shot.evaluations()),
    }
}

pub fn far_away() -> Case {
    let view =
        "domain [-1.1, 1.1]^3\ncamera(position = [7e5, -6e5, 4e5], target = [0, 0, 0], fov = 0.00012)".to_owned();
    let survey = Survey::new::<Torus>(&[view], &options(32));
    assert!(survey.tally.proved > 300 && survey.tally.unknown < 10, "{:?}", survey.tally);
    let single = faults(&survey.looks, 1e-3, |ray, inside| Quartic::<f32>::new(ray).march(inside, STEPS));
    let double = faults(&survey.looks, 1e-3, |ray, inside| Quartic::<f64>::new(ray).march(inside, STEPS));
    assert!(single.lost + single.wrong > 200 && double.lost + double.wrong > 200, "{single}; {double}");
    survey.case(
        "a torus of radii 0.7, 0.3 from 1e6 away",
        "The quartic along the ray has the coefficients 1 and 1e24, whose terms cancel at the torus.",
        [single, double],
    )
}

surface!(Small, "(x^2 + y^2 + z^2 - 0.58e-12)^2 = 1.96e-12 (0.09e-12 - z^2)", |x, y, z| {
    let unit = N::ratio(1, 1_000_000).power(2);
    let square = x.power(2) + y.power(2) + z.power(2) - N::ratio(29, 50) * unit.clone();
    square.power(2) - N::ratio(49, 25) * unit.clone() * (N::ratio(9, 100) * unit - z.power(2))
});
surface!(Large, "(x^2 + y^2 + z^2 - 0.58e12)^2 = 1.96e12 (0.09e12 - z^2)", |x, y, z| {
    let unit = N::int(1_000_000).power(2);
    let square = x.power(2) + y.power(2) + z.power(2) - N::ratio(29, 50) * unit.clone();
    square.power(2) - N::ratio(49, 25) * unit.clone() * (N::ratio(9, 100) * unit - z.power(2))
});
surface!(Shifted, "((x - 1e6)^2 + (y - 1e6)^2 + (z - 1e6)^2 - 0.58)^2 = 1.96 (0.09 - (z - 1e6)^2)", |x, y, z| {
    Torus::value([x, y, z].map(|v| v - N::int(1_000_000)))
});
surface!(Expanded, "x^2 + y^2 + z^2 - 2e6 (x + y + z) + 3e12 - 1 = 0", |x, y, z| {
    let squares = x.power(2) + y.power(2) + z.power(2);
    squares - N::int(2_000_000) * (x + y + z) + N::int(2_999_999_999_999)
});

/// A survey of the whole surface that leaves nothing open.
fn whole<S: Surface>(domain: &str) -> Survey {
    let survey = Survey::new::<S>(&[format!("domain {domain}")], &options(32));
    assert!(survey.tally.proved > 100 && survey.tally.unknown < 5, "{}: {:?}", S::TEXT, survey.tally);
    survey
}

pub fn small() -> Case {
    let survey = whole::<Small>("[-1.1e-6, 1.1e-6]^3");
    let single = faults(&survey.looks, 1e-2, |ray, inside| close::<f32, Small>(ray, inside, 1e-6));
    let double = faults(&survey.looks, 1e-2, |ray, inside| close::<f64, Small>(ray, inside, 1e-6));
    assert!(single == double && double.wrong == survey.tally.proved && double.invented == survey.tally.missed);
    survey.case(
        "the torus scaled by 1e-6",
        "With one tolerance for all, |f| < 1e-6, everything is a root: the largest value in the domain is 1e-23.",
        [single, double],
    )
}

pub fn large() -> Case {
    let survey = whole::<Large>("[-1.1e6, 1.1e6]^3");
    let single = faults(&survey.looks, 1e-2, |ray, inside| close::<f32, Large>(ray, inside, 1e-6));
    let double = faults(&survey.looks, 1e-2, |ray, inside| close::<f64, Large>(ray, inside, 1e-6));
    assert!(single == double && double.lost == survey.tally.proved);
    survey.case("the torus scaled by 1e6", "With the same tolerance nothing is a root.", [single, double])
}

pub fn shifted() -> Case {
    let survey = whole::<Shifted>("[999998.9, 1000001.1]^3");
    let [single, double] = survey.marched::<Shifted>();
    assert!(single.lost + single.wrong > 200, "{single}; {double}");
    survey.case("the torus shifted by 1e6", "In f32 coordinates there are 1/16 apart.", [single, double])
}

pub fn expanded() -> Case {
    let survey = whole::<Expanded>("[999998.5, 1000001.5]^3");
    let [single, double] = survey.marched::<Expanded>();
    assert!(single.lost + single.wrong + single.invented > 400, "{single}; {double}");
    survey.case(
        "a unit sphere shifted by 1e6, expanded",
        "Squares of 1e12 cancel to 1; f32 rounds them to multiples of 65536, f64 to a few ten-thousandths.",
        [single, double],
    )
}

surface!(Zoomed, "x^2 + y^2 + z^2 - 200 x + 9999 = 0", |x, y, z| {
    x.power(2) + y.power(2) + z.power(2) - N::int(200) * x + N::int(9999)
});

/// Boxes of a width on the sphere near x = 100, through which it passes, as exact signs at two corners prove.
fn boxes_on_the_sphere(width: f64) -> Vec<[Interval; 3]> {
    let mut rng = fastrand::Rng::with_seed(11);
    let mut boxes = Vec::new();
    while boxes.len() < 1000 {
        let (turn, tilt) = (rng.f64() * std::f64::consts::TAU, rng.f64() * 0.01 - 0.005);
        let centre = [100.0 + tilt.sin(), tilt.cos() * turn.cos(), tilt.cos() * turn.sin()];
        let ends = centre.map(|c| {
            let lo = c - width * rng.f64();
            [lo, lo + width]
        });
        // The corners nearest to and farthest from the centre of the sphere.
        let corner = |far: bool| {
            let outward = [centre[0] > 100.0, centre[1] > 0.0, centre[2] > 0.0];
            let origin = [0, 1, 2].map(|i| ends[i][usize::from(outward[i] == far)]);
            sign::<Zoomed>(&Ray { origin, direction: [0.0; 3] }, 0.0)
        };
        if corner(false) < 0 && corner(true) > 0 {
            boxes.push(ends.map(|[lo, hi]| Interval::new(lo, hi).expect("the ends are in order")));
        }
    }
    boxes
}

pub fn zoomed_boxes() -> Case {
    let formula = Formula::new("x^2 + y^2 + z^2 - 200 x + 9999");
    let answers = formula.answers();
    let (nearest_single, nearest_double) = (formula.nearest_single(), formula.nearest_double());
    let mut shares = Vec::new();
    for width in [1e-6, 1e-7, 1e-15] {
        let boxes = boxes_on_the_sphere(width);
        let mut lost = [0; 2];
        for cell in &boxes {
            answers.all(cell, |said| said.contains(0.0));
            lost[0] += usize::from(!nearest_single.enclose_nearest(cell).contains(0.0));
            lost[1] += usize::from(!nearest_double.enclose_nearest(cell).contains(0.0));
        }
        shares.push(lost.map(|lost| format!("{:.0} %", 100.0 * lost as f64 / boxes.len() as f64)));
        assert!(lost[usize::from(width < 1e-10)] > 300, "{width}: {lost:?}");
    }
    Case {
        name: "x^2 + y^2 + z^2 - 200 x + 9999, small boxes",
        why: "Intervals whose ends are rounded to nearest exclude zeros: boxes of width 1e-6, 1e-7 and 1e-15 near x = 100, each with a piece of the sphere in it.",
        single: format!("{}, {}, {} lost", shares[0][0], shares[1][0], shares[2][0]),
        double: format!("{}, {}, {} lost", shares[0][1], shares[1][1], shares[2][1]),
        imp: "none lost by any extension or by kernels of f32 and f64".to_owned(),
        cost: String::new(),
    }
}

pub fn zoomed_picture() -> Case {
    let domain = "[98.9, 101.1] x [-1.1, 1.1] x [-1.1, 1.1]";
    // The silhouette and a flat part, through a window of 5e-7.
    let views = [
        window(domain, [99.0, -3.0, 0.0], [99.0, 0.0, 0.0], 5e-7),
        window(domain, [100.0, -3.0, 0.001], [100.0, -1.0, 0.001], 5e-7),
    ];
    let survey = Survey::new::<Zoomed>(&views, &options(24));
    for other in
        [Options { precision: Precision::Double, ..options(24) }, Options { stop: Stop::Depth(40), ..options(24) }]
    {
        let other = Survey::new::<Zoomed>(&views, &other);
        assert!(other.tally.unknown <= 2 && other.tally.proved >= survey.tally.proved, "{:?}", other.tally);
    }
    assert!(survey.tally.proved > 800 && survey.tally.unknown <= 2, "{:?}", survey.tally);
    let [single, double] = survey.marched::<Zoomed>();
    assert!(single.wrong + single.lost + single.invented > 300, "{single}; {double}");
    survey.case(
        "the same sphere through a window of 5e-7",
        "Values of 1e4 cancel: f32 knows f to 1e-3, where the window is 5e-7 wide; two roots behind one another lie between two samples.",
        [single, double],
    )
}
