//! Surfaces whose sheets touch, taper and cross: thin parts, double points, gradients that vanish.

use imp::render::Certainty;
use imp::render::Options;

use crate::case::Case;
use crate::exact;
use crate::plain::Surface;
use crate::plain::newton;
use crate::plain::surface;
use crate::shot::Look;
use crate::shot::Tally;
use crate::shot::check;
use crate::shot::faults;
use crate::shot::marching;
use crate::shot::options;
use crate::shot::shoot;

surface!(Steiner, "x^2 y^2 + y^2 z^2 + x^2 z^2 + x y z = 0", |x, y, z| {
    let [a, b, c] = [&x, &y, &z].map(|v| v.power(2));
    a.clone() * b.clone() + b * c.clone() + a * c + x * y * z
});
surface!(Teardrop, "0.5x^5 + 0.5x^4 - y^2 - z^2 = 0", |x, y, z| {
    N::ratio(1, 2) * x.power(5) + N::ratio(1, 2) * x.power(4) - y.power(2) - z.power(2)
});
surface!(Heart, "(2x^2 + y^2 + z^2 - 1)^3 = (0.1x^2 + y^2) z^3", |x, y, z| {
    let body = N::int(2) * x.power(2) + y.power(2) + z.power(2) - N::int(1);
    body.power(3) - (N::ratio(1, 10) * x.power(2) + y.power(2)) * z.power(3)
});
surface!(Sextic, "let phi = (1 + sqrt(5)) / 2\nsurface barth: 4(phi^2 x^2 - y^2)(phi^2 y^2 - z^2)(phi^2 z^2 - x^2) = (1 + 2phi)(x^2 + y^2 + z^2 - 1)^2", |x, y, z| {
    let square = N::phi().power(2);
    let [a, b, c] = [x, y, z].map(|v| v.power(2));
    let factor = |p: &N, q: &N| square.clone() * p.clone() - q.clone();
    let shell = a.clone() + b.clone() + c.clone() - N::int(1);
    N::int(4) * factor(&a, &b) * factor(&b, &c) * factor(&c, &a) - (N::int(1) + N::int(2) * N::phi()) * shell.power(2)
});
surface!(Decic, "let phi = (1 + sqrt(5)) / 2\nsurface decic: 8(x^2 - phi^4 y^2)(y^2 - phi^4 z^2)(z^2 - phi^4 x^2)(x^4 + y^4 + z^4 - 2x^2 y^2 - 2x^2 z^2 - 2y^2 z^2) + (3 + 5phi)(x^2 + y^2 + z^2 - 1)^2 (x^2 + y^2 + z^2 - (2 - phi))^2 = 0", |x, y, z| {
    let fourth = N::phi().power(4);
    let [a, b, c] = [x, y, z].map(|v| v.power(2));
    let factor = |p: &N, q: &N| p.clone() - fourth.clone() * q.clone();
    let planes = N::int(8) * factor(&a, &b) * factor(&b, &c) * factor(&c, &a);
    let mixed = a.clone() * b.clone() + a.clone() * c.clone() + b.clone() * c.clone();
    let quartic = a.power(2) + b.power(2) + c.power(2) - N::int(2) * mixed;
    let square = a + b + c;
    let shells = (square.clone() - N::int(1)).power(2) * (square - (N::int(2) - N::phi())).power(2);
    planes * quartic + (N::int(3) + N::int(5) * N::phi()) * shells
});
surface!(Crosscap, "4x^2 (x^2 + y^2 + z^2 + z) + y^2 (y^2 + z^2 - 1) = 0", |x, y, z| {
    let [a, b, c] = [&x, &y, &z].map(|v| v.power(2));
    N::int(4) * a.clone() * (a + b.clone() + c.clone() + z) + b.clone() * (b + c - N::int(1))
});
surface!(Cube, "x^200 + y^200 + z^200 = 1", |x, y, z| x.power(200) + y.power(200) + z.power(200) - N::int(1));
surface!(Squared, "(x^2 + y^2 + z^2 - 1)^2 = 0", |x, y, z| {
    (x.power(2) + y.power(2) + z.power(2) - N::int(1)).power(2)
});

fn said(tally: Tally) -> String {
    format!("{} proved, {} missed, {} unknown", tally.proved, tally.missed, tally.unknown)
}

/// A checked picture.
fn looks<S: Surface>(view: &str, options: &Options) -> (Vec<Look>, Tally, u64) {
    let shot = shoot(&format!("{}\n{view}", S::TEXT), options);
    let looks = shot.looks();
    let tally = check::<S>(&looks);
    (looks, tally, shot.evaluations())
}

fn views<S: Surface>(name: &'static str, why: &'static str, views: &[String], size: u32) -> Case {
    let (mut all, mut sum, mut cost) = (Vec::new(), Tally::default(), 0);
    for view in views {
        let (looks, tally, evaluations) = looks::<S>(view, &options(size));
        println!("  {name} {view:?} {tally:?}");
        all.extend(looks);
        sum = Tally { proved: sum.proved + tally.proved, missed: sum.missed + tally.missed, unknown: sum.unknown + tally.unknown };
        cost += evaluations;
    }
    let (single, double) = (marching::<f32, S>(&all, 1000), marching::<f64, S>(&all, 1000));
    Case {
        name,
        why,
        single: single.to_string(),
        double: double.to_string(),
        imp: said(sum),
        cost: format!("{cost} evaluations, {} rays", all.len()),
    }
}

/// A camera at `eye` that looks at `target` through a square window of a side there.
fn window(domain: &str, eye: [f64; 3], target: [f64; 3], side: f64) -> String {
    let distance = (0..3).map(|i| (eye[i] - target[i]).powi(2)).sum::<f64>().sqrt();
    let fov = 2.0 * (side / 2.0 / distance).atan().to_degrees();
    format!("domain {domain}\ncamera(position = {eye:?}, target = {target:?}, fov = {fov:?})")
}

pub fn steiner_axes() -> Case {
    let domain = "[-0.56, 0.56]^3";
    let mut list = Vec::new();
    for exponent in [-18, -24, -30] {
        let side = 21.0 * 2f64.powi(exponent);
        for x in [0.3, 0.53] {
            list.push(window(domain, [x, -2.0, 1.1], [x, 0.0, 0.0], side));
        }
    }
    views::<Steiner>("Steiner's axes, 2^-18 to 2^-30 beside", "", &list, 21)
}

pub fn steiner_on_axis() -> Case {
    let domain = "[-0.56, 0.56]^3";
    let mut tallies = Vec::new();
    for x in [0.3125, 0.53125] {
        for dz in [0.0, 2f64.powi(-18), 2f64.powi(-24), 2f64.powi(-30)] {
            let view = format!("domain {domain}\ncamera(position = [{x:?}, -2, {dz:?}], target = [{x:?}, 0, {dz:?}], fov = 1)");
            let (looks, tally, cost) = looks::<Steiner>(&view, &options(1));
            println!("   {x} {dz} {tally:?} {cost} {:?}", looks[0].depth);
            tallies.push(tally);
        }
    }
    Case {
        name: "Steiner's axes, met exactly",
        why: "",
        single: String::new(),
        double: String::new(),
        imp: format!("{tallies:?}"),
        cost: String::new(),
    }
}

pub fn teardrop_neck() -> Case {
    let domain = "[-1.05, 0.6] x [-0.36, 0.36] x [-0.36, 0.36]";
    let list: Vec<String> = [-6, -10, -14]
        .into_iter()
        .map(|exponent| {
            let x = -(2f64.powi(exponent));
            window(domain, [x, -2.0, 0.5], [x, 0.0, 0.0], 4.0 * x * x)
        })
        .collect();
    let (_, tally, _) = looks::<Teardrop>(&format!("domain {domain}\ncamera(position = [0, -2, 0], target = [0, 0, 0], fov = 1)"), &options(1));
    println!("  through the point {tally:?}");
    views::<Teardrop>("the teardrop's neck", "", &list, 21)
}

pub fn heart_dent() -> Case {
    let domain = "[-0.8, 0.8] x [-1.25, 1.25] x [-1.1, 1.35]";
    let list = vec![
        window(domain, [0.0, -4.0, 0.0], [0.0, -1.0, 0.0], 0.5),
        window(domain, [3.0, -3.0, 0.0], [0.0, 0.0, 0.0], 1e-3),
        window(domain, [0.5, -2.0, 3.0], [0.0, 0.0, 1.0], 1e-2),
        window(domain, [0.5, -2.0, -3.0], [0.0, 0.0, -1.0], 1e-2),
    ];
    let case = views::<Heart>("Heart where its gradient vanishes", "", &list, 21);
    let (looks, ..) = looks::<Heart>(&list[0], &options(21));
    println!("  newton {} {}", faults(&looks, 1e-3, newton::<f32, Heart>), faults(&looks, 1e-3, newton::<f64, Heart>));
    case
}

pub fn sextic_nodes() -> Case {
    let list: Vec<String> = [1e-2, 1e-5, 1e-8]
        .map(|side| window("[0.9, 1.1]^3", [1.5, -2.0, 3.3], [1.0, 1.0, 1.0], side))
        .into();
    views::<Sextic>("a double point of the Barth sextic", "", &list, 21)
}

pub fn decic_nodes() -> Case {
    let h = std::f64::consts::FRAC_1_SQRT_2;
    let list: Vec<String> = [1e-2, 1e-5, 1e-8]
        .map(|side| window("[0.69, 0.72] x [0.69, 0.72] x [-0.02, 0.02]", [1.5, -2.0, 3.3], [h, h, 0.0], side))
        .into();
    views::<Decic>("a double point of the Barth decic", "", &list, 15)
}

pub fn crosscap() -> Case {
    let domain = "[-0.6, 0.6] x [-1.1, 1.1] x [-1.1, 1.1]";
    let list = vec![
        format!("domain {domain}"),
        window(domain, [2.0, -2.5, 1.5], [0.0, 0.0, 0.5], 0.01),
        window(domain, [2.0, -2.5, 1.5], [0.0, 0.0, 1.0], 0.01),
        window(domain, [2.0, -2.5, 1.5], [0.0, 0.0, -0.5], 1e-4),
    ];
    views::<Crosscap>("Crosscap along its double line", "", &list, 32)
}

/// x^200 + y^200 + z^200 - 1 is convex along a ray: f(a) > 0 > f(b) with a < b leaves no zero before a, and two tangents bound
/// it from below.
pub fn power_200() -> Case {
    let shot = shoot(&format!("{}\ndomain [-2, 2]^3", Cube::TEXT), &options(32));
    let looks = shot.looks();
    let mut tally = Tally::default();
    for Look { ray, inside, certainty, depth } in &looks {
        match (certainty, depth) {
            (Certainty::Hit, Some(depth)) => {
                let [a, b] = depth.bracket;
                assert!(exact::sign::<Cube>(ray, a) > 0 && exact::sign::<Cube>(ray, b) < 0 && a < b);
                tally.proved += 1;
            }
            (Certainty::Miss, None) => {
                let _ = inside;
                tally.missed += 1;
            }
            _ => tally.unknown += 1,
        }
    }
    let (single, double) = (faults(&looks, 1e-3, newton::<f32, Cube>), faults(&looks, 1e-3, newton::<f64, Cube>));
    println!("  march {} {}", marching::<f32, Cube>(&looks, 1000), marching::<f64, Cube>(&looks, 1000));
    Case {
        name: "x^200 + y^200 + z^200 = 1",
        why: "",
        single: single.to_string(),
        double: double.to_string(),
        imp: said(tally),
        cost: format!("{} evaluations", shot.evaluations()),
    }
}

pub fn squared() -> Case {
    let (looks, tally, cost) = looks::<Squared>("domain [-1.2, 1.2]^3", &options(32));
    let drawn = looks.iter().filter(|look| look.certainty == Certainty::Unknown && look.depth.is_some()).count();
    println!("{tally:?} drawn {drawn}");
    Case {
        name: "a squared sphere",
        why: "",
        single: String::new(),
        double: String::new(),
        imp: said(tally),
        cost: format!("{cost} evaluations"),
    }
}
