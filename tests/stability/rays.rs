//! Rays that graze, and rays and surfaces far from the numbers that programs expect.

use imp::derive::Precision;
use imp::render::Certainty;
use imp::render::Options;
use imp::render::Stop;

use crate::case::Case;
use crate::exact;
use crate::formula::Formula;
use crate::formula::point;
use crate::plain::Surface;
use crate::plain::close;
use crate::plain::march;
use crate::plain::surface;
use crate::shot::Look;
use crate::shot::Shot;
use crate::shot::Tally;
use crate::shot::check;
use crate::shot::faults;
use crate::shot::marching;
use crate::shot::options;
use crate::shot::shoot;
use crate::torus::Torus;
use crate::torus::Quartic;

surface!(Grazing, "y^2 - 10 y + 25 - 1e-12 = 0", |_x, y, _z| {
    y.power(2) - N::int(10) * y + N::int(25) - N::ratio(1, 1_000_000_000_000)
});
surface!(Touching, "y^2 - 10 y + 25 = 0", |_x, y, _z| y.power(2) - N::int(10) * y + N::int(25));

/// One ray along the y axis.
fn along_y(equation: &str) -> Shot {
    let view = "domain [-1, 1] x [0, 10] x [-1, 1]\ncamera(position = [0, -6, 0], target = [0, 5, 0])";
    shoot(&format!("{equation}\n{view}"), &options(1))
}

/// Steps of the plain march: 1e-3 apart.
const STEPS: u32 = 10_001;

pub fn near_tangent() -> Case {
    let mut counts = Vec::new();
    let mut centred = Vec::new();
    for exponent in 0..=12 {
        // The form without a square is the hard one: its natural extension depends on y twice.
        let shot = along_y(&format!("y^2 - 10 y + 25 + 1e-{exponent} = 0"));
        assert_eq!(shot.picture.certainty, [Certainty::Miss], "d = 1e-{exponent}");
        counts.push(shot.evaluations());
        let shot = along_y(&format!("(y - 5)^2 + 1e-{exponent} = 0"));
        assert_eq!(shot.picture.certainty, [Certainty::Miss], "d = 1e-{exponent}");
        centred.push(shot.evaluations());
    }
    let looks = along_y(Touching::TEXT).looks();
    let (single, double) = (
        march::<f32, Touching>(&looks[0].ray, looks[0].inside, STEPS),
        march::<f64, Touching>(&looks[0].ray, looks[0].inside, STEPS),
    );
    println!("{single:?} {double:?}");
    Case {
        name: "(t - 5)^2 + d, d = 1 .. 1e-12",
        why: "",
        single: format!("{single:?}"),
        double: format!("{double:?}"),
        imp: "all thirteen missed".to_owned(),
        cost: format!("expanded {counts:?} evaluations, as a square {centred:?}"),
    }
}

pub fn touching() -> Case {
    let shot = along_y(Touching::TEXT);
    let looks = shot.looks();
    let tally = check::<Touching>(&looks);
    assert_eq!(tally, Tally { unknown: 1, ..Tally::default() });
    assert_eq!(along_y("(y - 5)^2 = 0").picture.certainty, [Certainty::Unknown]);
    Case {
        name: "(t - 5)^2 = 0",
        why: "",
        single: format!("{:?}", march::<f32, Touching>(&looks[0].ray, looks[0].inside, STEPS)),
        double: format!("{:?}", march::<f64, Touching>(&looks[0].ray, looks[0].inside, STEPS)),
        imp: format!("unknown, drawn at {:?}", looks[0].depth.map(|depth| depth.t - 6.0)),
        cost: format!("{} evaluations", shot.evaluations()),
    }
}

pub fn grazing() -> Case {
    let shot = along_y(Grazing::TEXT);
    let looks = shot.looks();
    let tally = check::<Grazing>(&looks);
    println!("{tally:?} {:?}", looks[0].depth);
    Case {
        name: "(t - 5)^2 - 1e-12",
        why: "",
        single: format!("{:?}", march::<f32, Grazing>(&looks[0].ray, looks[0].inside, STEPS)),
        double: format!("{:?}", march::<f64, Grazing>(&looks[0].ray, looks[0].inside, STEPS)),
        imp: format!("{tally:?} {:?}", looks[0].depth.map(|depth| depth.t - 6.0)),
        cost: format!("{} evaluations", shot.evaluations()),
    }
}

/// The picture's answers, all checked.
fn said(tally: Tally) -> String {
    format!("{} proved, {} missed, {} unknown", tally.proved, tally.missed, tally.unknown)
}

pub fn far_away() -> Case {
    let view = "domain [-1.1, 1.1]^3\ncamera(position = [7e5, -6e5, 4e5], target = [0, 0, 0], fov = 0.00012)";
    let shot = shoot(&format!("{}\n{view}", Torus::TEXT), &options(32));
    let looks = shot.looks();
    let tally = check::<Torus>(&looks);
    let single = faults(&looks, 1e-3, |ray, inside| Quartic::<f32>::new(ray).march(inside, 1000));
    let double = faults(&looks, 1e-3, |ray, inside| Quartic::<f64>::new(ray).march(inside, 1000));
    println!("{tally:?} {single} {double} {}", marching::<f32, Torus>(&looks, 1000));
    Case {
        name: "a torus from 1e6 away",
        why: "",
        single: single.to_string(),
        double: double.to_string(),
        imp: said(tally),
        cost: format!("{} evaluations", shot.evaluations()),
    }
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
    let [x, y, z] = [x, y, z].map(|v| v - N::int(1_000_000));
    Torus::value([x, y, z])
});
surface!(Expanded, "x^2 + y^2 + z^2 - 2e6 (x + y + z) + 3e12 - 1 = 0", |x, y, z| {
    let squares = x.power(2) + y.power(2) + z.power(2);
    squares - N::int(2_000_000) * (x + y + z) + N::int(2_999_999_999_999)
});

/// A picture with a tolerance of 1e-6 for plain roots.
fn with_one_tolerance<S: Surface>(name: &'static str, why: &'static str, domain: &str) -> Case {
    let shot = shoot(&format!("{}\ndomain {domain}", S::TEXT), &options(32));
    let looks = shot.looks();
    let tally = check::<S>(&looks);
    let single = faults(&looks, 1e-2, |ray, inside| close::<f32, S>(ray, inside, 1e-6));
    let double = faults(&looks, 1e-2, |ray, inside| close::<f64, S>(ray, inside, 1e-6));
    println!("{name} {tally:?} {single} {double}");
    Case {
        name,
        why,
        single: single.to_string(),
        double: double.to_string(),
        imp: said(tally),
        cost: format!("{} evaluations", shot.evaluations()),
    }
}

pub fn small() -> Case {
    with_one_tolerance::<Small>("a torus scaled by 1e-6", "", "[-1.1e-6, 1.1e-6]^3")
}

pub fn large() -> Case {
    with_one_tolerance::<Large>("a torus scaled by 1e6", "", "[-1.1e6, 1.1e6]^3")
}

fn marched<S: Surface>(name: &'static str, why: &'static str, view: &str, options: &Options) -> (Case, Vec<Look>) {
    let shot = shoot(&format!("{}\n{view}", S::TEXT), options);
    let looks = shot.looks();
    let tally = check::<S>(&looks);
    let (single, double) = (marching::<f32, S>(&looks, 1000), marching::<f64, S>(&looks, 1000));
    println!("{name} {tally:?} {single} {double}");
    let case = Case {
        name,
        why,
        single: single.to_string(),
        double: double.to_string(),
        imp: said(tally),
        cost: format!("{} evaluations", shot.evaluations()),
    };
    (case, looks)
}

pub fn shifted() -> Case {
    marched::<Shifted>("a torus shifted by 1e6", "", "domain [999998.9, 1000001.1]^3", &options(32)).0
}

pub fn expanded() -> Case {
    marched::<Expanded>("a sphere shifted by 1e6, expanded", "", "domain [999998.5, 1000001.5]^3", &options(32)).0
}

surface!(Zoomed, "x^2 + y^2 + z^2 - 200 x + 9999 = 0", |x, y, z| {
    x.power(2) + y.power(2) + z.power(2) - N::int(200) * x + N::int(9999)
});

/// Boxes of a width around points of the zoomed sphere near x = 100: in each the sphere really passes, as the exact signs at
/// two corners prove.
fn boxes_on_the_sphere(width: f64) -> Vec<[imp::interval::Interval; 3]> {
    let mut rng = fastrand::Rng::with_seed(11);
    let mut boxes = Vec::new();
    while boxes.len() < 2000 {
        let (y, z) = (rng.f64() * 0.2 - 0.1, rng.f64() * 0.2 - 0.1);
        // A point of the sphere (x - 100)^2 + y^2 + z^2 = 1 beside x = 100, where y and z are on the unit circle.
        let turn = (1.0 - y * y).sqrt() / y.hypot(1.0).max(1.0);
        let _ = (turn, z);
        let angle = rng.f64() * std::f64::consts::TAU;
        let tilt = rng.f64() * 0.01 - 0.005;
        let radius = f64::cos(tilt);
        let centre = [100.0 + f64::sin(tilt), radius * angle.cos(), radius * angle.sin()];
        let ends = centre.map(|c| {
            let lo = c - width * rng.f64();
            (lo, lo + width)
        });
        let corner = |outer: bool| {
            let place = |i: usize, towards: bool| if towards == outer { ends[i].1 } else { ends[i].0 };
            [place(0, centre[0] > 100.0), place(1, centre[1] > 0.0), place(2, centre[2] > 0.0)]
        };
        let sign = |p: [f64; 3]| {
            let ray = imp::render::Ray { origin: p, direction: [0.0; 3] };
            exact::sign::<Zoomed>(&ray, 0.0)
        };
        if sign(corner(true)) > 0 && sign(corner(false)) < 0 {
            boxes.push(ends.map(|(lo, hi)| imp::interval::Interval::new(lo, hi).expect("in order")));
        }
    }
    boxes
}

/// The same picture in the three ways that beams have.
fn every_way(size: u32) -> [Options; 3] {
    let options = options(size);
    [
        options.clone(),
        Options { precision: Precision::Double, ..options.clone() },
        Options { stop: Stop::Depth(40), ..options },
    ]
}

pub fn zoomed_boxes() -> Case {
    let text = Zoomed::TEXT.strip_suffix(" = 0").expect("an equation with 0");
    let formula = Formula::new(text);
    let (single, double) = (formula.single(), formula.double());
    let (nearest_single, nearest_double) = (formula.nearest_single(), formula.nearest_double());
    let mut lost = Vec::new();
    for width in [1e-6, 1e-7, 1e-14] {
        let boxes = boxes_on_the_sphere(width);
        let mut counts = [0; 2];
        for cell in &boxes {
            for kept in [formula.reference(cell).interval(), single.enclose(cell), double.enclose(cell)] {
                assert!(kept.contains(0.0), "a root is lost in {cell:?}: {kept}");
            }
            counts[0] += usize::from(!nearest_single.enclose_nearest(cell).contains(0.0));
            counts[1] += usize::from(!nearest_double.enclose_nearest(cell).contains(0.0));
        }
        println!("{width} {counts:?}");
        lost.push(counts);
    }
    let _ = point(0.0);
    Case {
        name: "roots in small boxes on x^2 + y^2 + z^2 - 200 x + 9999",
        why: "",
        single: format!("{lost:?}"),
        double: String::new(),
        imp: "none lost by reference, f32 and f64 kernels".to_owned(),
        cost: String::new(),
    }
}

pub fn zoomed_picture() -> Case {
    let view = "domain [98.9, 101.1] x [-1.1, 1.1] x [-1.1, 1.1]
camera(position = [100, -3, 0.001], target = [100, -1, 0.001], fov = 0.00001)";
    for options in every_way(24) {
        marched::<Zoomed>("the same sphere, zoomed", "", view, &options);
    }
    marched::<Zoomed>("the same sphere, zoomed", "", "domain [98.9, 101.1] x [-1.1, 1.1] x [-1.1, 1.1]\ncamera(position = [99, -3, 0], target = [99, 0, 0], fov = 0.00001)", &options(24)).0
}
