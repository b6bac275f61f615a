//! Surfaces whose sheets taper, touch and cross: thin parts, double points, gradients that vanish.

use imp::render::Certainty;
use imp::render::Layers;
use imp::render::Options;
use imp::render::Stop;

use crate::case::Case;
use crate::exact::is_clear;
use crate::exact::sign;
use crate::plain::Plain;
use crate::plain::Surface;
use crate::plain::close;
use crate::plain::march;
use crate::plain::newton;
use crate::plain::surface;
use crate::plain::value;
use crate::shot::Look;
use crate::shot::STEPS;
use crate::shot::Survey;
use crate::shot::Tally;
use crate::shot::faults;
use crate::shot::options;
use crate::shot::shoot;
use crate::shot::window;

/// Options of a picture with cells of 2^-44 of the domain, which is 2^-43 of a unit where it matters here.
fn deep(size: u32) -> Options {
    Options { stop: Stop::Depth(44), ..options(size) }
}

surface!(Steiner, "x^2 y^2 + y^2 z^2 + x^2 z^2 + x y z = 0", |x, y, z| {
    let [a, b, c] = [&x, &y, &z].map(|v| v.power(2));
    a.clone() * b.clone() + b * c.clone() + a * c + x * y * z
});

const STEINER: &str = "[-0.56, 0.56]^3";

/// Windows of 20 pixels, each of 2^-18, 2^-24 and 2^-30, around a point of the x axis, from an eye at a height.
fn beside_the_axis(x: f64, z: f64) -> [String; 3] {
    let side = |exponent: i32| 20.0 * 2f64.powi(exponent);
    [-18, -24, -30].map(|exponent| window(STEINER, [x, -2.0, z], [x, 0.0, 0.0], side(exponent)))
}

pub fn steiner_axes() -> Case {
    let survey = Survey::new::<Steiner>(&beside_the_axis(0.3, -1.1), &deep(20));
    let [single, double] = survey.marched::<Steiner>();
    assert!(survey.tally.proved > 1100 && survey.tally.unknown < 10, "{:?}", survey.tally);
    assert!(single.lost > 1000 && double.lost > 1000, "{single}; {double}");
    survey.case(
        "Steiner's surface, 2^-18, 2^-24, 2^-30 beside its axes",
        "Two sheets cross in the axis; beside it they are closer to each other than two samples (cells of 2^-44 of the domain).",
        [single, double],
    )
}

pub fn steiner_below_axes() -> Case {
    let [above, below] = [1.1, -1.1].map(|z| beside_the_axis(0.53, z));
    let survey = Survey::new::<Steiner>(&[above, below].concat(), &deep(20));
    let single = faults(&survey.looks, 1e-3, |ray, inside| close::<f32, Steiner>(ray, inside, 1e-6));
    let double = faults(&survey.looks, 1e-3, |ray, inside| close::<f64, Steiner>(ray, inside, 1e-6));
    assert!(survey.tally.proved == 0 && survey.tally.missed > 2000, "{:?}", survey.tally);
    survey.case(
        "the same beyond the pinch points",
        "Only the axis itself belongs to the surface there; beside it f is positive and as small as the square of the distance, far below a tolerance of 1e-6.",
        [single, double],
    )
}

/// What plain marches find on rays that Imp leaves unknown: a hit on so many of so many.
fn found<T: Plain, S: Surface>(looks: &[Look]) -> String {
    let unknown: Vec<&Look> = looks.iter().filter(|look| look.certainty == Certainty::Unknown).collect();
    let find = |look: &&&Look| march(|t: T| value::<T, S>(&look.ray, t), look.inside, STEPS).is_some();
    let lost = unknown.len() - unknown.iter().filter(find).count();
    format!("{lost} of {} lost", unknown.len())
}

/// Rays of which all touch the surface where it has no crossing to prove.
fn touched<S: Surface>(name: &'static str, why: &'static str, views: &[String]) -> Case {
    let survey = Survey::new::<S>(views, &options(1));
    assert_eq!(survey.tally, Tally { unknown: views.len(), ..Tally::default() });
    assert!(survey.looks.iter().all(|look| look.depth.is_some_and(|depth| (depth.t - 2.0).abs() < 1e-5)));
    let (single, double) = (found::<f32, S>(&survey.looks), found::<f64, S>(&survey.looks));
    Case {
        name,
        why,
        single,
        double,
        imp: format!("{}, drawn where they touch", survey.tally),
        cost: format!("{} evaluations", survey.evaluations),
    }
}

pub fn steiner_on_axes() -> Case {
    let at = |x: f64| format!("domain {STEINER}\ncamera(position = [{x:?}, -2, 0], target = [{x:?}, 0, 0])");
    touched::<Steiner>(
        "Steiner's axes, met exactly",
        "In the plane z = 0 the equation is x^2 y^2 = 0: the ray meets the surface, and no sign changes.",
        &[at(0.3125), at(0.53125)],
    )
}

surface!(Teardrop, "0.5x^5 + 0.5x^4 - y^2 - z^2 = 0", |x, y, z| {
    N::ratio(1, 2) * x.power(5) + N::ratio(1, 2) * x.power(4) - y.power(2) - z.power(2)
});

const TEARDROP: &str = "[-1.05, 0.6] x [-0.36, 0.36] x [-0.36, 0.36]";

pub fn teardrop_neck() -> Case {
    // The neck has the radius x^2 / sqrt(2): 1.7e-4, 6.7e-7 and 2.6e-9.
    let views = [-6, -10, -14].map(|exponent| {
        let x = -(2f64.powi(exponent));
        window(TEARDROP, [x, -2.0, 0.5], [x, 0.0, 0.0], 4.0 * x * x)
    });
    let survey = Survey::new::<Teardrop>(&views, &deep(20));
    let [single, double] = survey.marched::<Teardrop>();
    assert!(survey.tally.proved > 400 && survey.tally.unknown < 5, "{:?}", survey.tally);
    assert!(single.lost > 400 && double.lost > 400, "{single}; {double}");
    survey.case(
        "the teardrop's neck at x = -2^-6, -2^-10, -2^-14",
        "The neck tapers like x^2, to 2.6e-9 here: thinner than any step (cells of 2^-44 of the domain).",
        [single, double],
    )
}

pub fn teardrop_point() -> Case {
    let view = format!("domain {TEARDROP}\ncamera(position = [0, -2, 0], target = [0, 0, 0])");
    touched::<Teardrop>(
        "the teardrop's point, met exactly",
        "In the plane x = 0 the equation is y^2 + z^2 = 0: one point and no change of sign.",
        &[view],
    )
}

surface!(Heart, "(2x^2 + y^2 + z^2 - 1)^3 = (0.1x^2 + y^2) z^3", |x, y, z| {
    let body = N::int(2) * x.power(2) + y.power(2) + z.power(2) - N::int(1);
    body.power(3) - (N::ratio(1, 10) * x.power(2) + y.power(2)) * z.power(3)
});

const HEART: &str = "[-0.8, 0.8] x [-1.25, 1.25] x [-1.1, 1.35]";

pub fn heart() -> Case {
    let views = [
        window(HEART, [0.0, -4.0, 0.0], [0.0, -1.0, 0.0], 0.5),
        window(HEART, [3.0, -3.0, 0.0], [0.0, 0.0, 0.0], 1e-3),
        window(HEART, [0.5, -2.0, 3.0], [0.0, 0.0, 1.0], 1e-2),
        window(HEART, [0.5, -2.0, -3.0], [0.0, 0.0, -1.0], 1e-2),
    ];
    let survey = Survey::new::<Heart>(&views, &options(21));
    assert!(survey.tally.proved > 1700 && survey.tally.unknown < 5, "{:?}", survey.tally);
    let single = faults(&survey.looks, 1e-3, newton::<f32, Heart>);
    let double = faults(&survey.looks, 1e-3, newton::<f64, Heart>);
    assert!(single.lost > 100 && double.lost > 100, "{single}; {double}");
    survey.case(
        "Heart where its gradient vanishes, Newton's method",
        "On the ellipse z = 0 the root is triple; there, at the dent and at the tip slopes die away with f, and tangents lead anywhere.",
        [single, double],
    )
}

/// The normal from central differences with a step of 1e-3, as programs without derivatives have it.
fn difference_normal<T: Plain, S: Surface>(p: [f64; 3]) -> [f64; 3] {
    let at =
        |axis: usize, step: f64| S::plain([0, 1, 2].map(|c| T::of(p[c] + if c == axis { step } else { 0.0 }))).to_f64();
    [0, 1, 2].map(|axis| at(axis, 1e-3) - at(axis, -1e-3))
}

/// The angle between two directions in degrees, whichever way they point.
fn angle(a: [f64; 3], b: [f64; 3]) -> f64 {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    (dot(a, b).abs() / (dot(a, a) * dot(b, b)).sqrt()).min(1.0).acos().to_degrees()
}

pub fn heart_normals() -> Case {
    // In the plane z = 0, which the middle row sees, the equation is g^3 = 0 with g = 2x^2 + y^2 - 1.
    let text = format!("{}\n{}", Heart::TEXT, window(HEART, [0.0, -4.0, 0.0], [0.0, 0.0, 0.0], 1.2));
    let layers = Layers { color: false, depth: true, normal: true, certainty: true };
    let shot = shoot(&text, &Options { layers, ..options(21) });
    let mut worst = [0.0f64; 3];
    for x in 0..21 {
        let index = shot.picture.index(x, 10);
        let Some(depth) = shot.picture.depth[index] else { continue };
        let p = shot.renderer.ray(x, 10).expect("a pixel of a space scene").at(depth.t);
        assert!(p[2] == 0.0);
        let truth = [4.0 * p[0], 2.0 * p[1], 0.0];
        let said = shot.picture.normal[index].map(f64::from);
        let off =
            [difference_normal::<f32, Heart>(p), difference_normal::<f64, Heart>(p), said].map(|n| angle(n, truth));
        for (worst, off) in worst.iter_mut().zip(off) {
            *worst = worst.max(off);
        }
    }
    assert!(worst[0] > 15.0 && worst[1] > 15.0 && worst[2] < 0.1, "{worst:?}");
    Case {
        name: "Heart's normals on that ellipse",
        why: "There f is g^3, so that central differences give the cubes of the components of g's gradient.",
        single: format!("{:.1} degrees off", worst[0]),
        double: format!("{:.1} degrees off", worst[1]),
        imp: format!("{:.1} degrees off", worst[2]),
        cost: String::new(),
    }
}

surface!(
    Sextic,
    "let phi = (1 + sqrt(5)) / 2
    surface s: 4(phi^2 x^2 - y^2)(phi^2 y^2 - z^2)(phi^2 z^2 - x^2) = (1 + 2phi)(x^2 + y^2 + z^2 - 1)^2",
    |x, y, z| {
        let square = N::phi().power(2);
        let [a, b, c] = [x, y, z].map(|v| v.power(2));
        let factor = |p: &N, q: &N| square.clone() * p.clone() - q.clone();
        let shell = a.clone() + b.clone() + c.clone() - N::int(1);
        let weight = N::int(1) + N::int(2) * N::phi();
        N::int(4) * factor(&a, &b) * factor(&b, &c) * factor(&c, &a) - weight * shell.power(2)
    }
);
surface!(
    Decic,
    "let phi = (1 + sqrt(5)) / 2
    let planes = 8(x^2 - phi^4 y^2)(y^2 - phi^4 z^2)(z^2 - phi^4 x^2)
    let cone = x^4 + y^4 + z^4 - 2x^2 y^2 - 2x^2 z^2 - 2y^2 z^2
    surface d: planes cone + (3 + 5phi)(x^2 + y^2 + z^2 - 1)^2 (x^2 + y^2 + z^2 - (2 - phi))^2 = 0",
    |x, y, z| {
        let fourth = N::phi().power(4);
        let [a, b, c] = [x, y, z].map(|v| v.power(2));
        let factor = |p: &N, q: &N| p.clone() - fourth.clone() * q.clone();
        let planes = N::int(8) * factor(&a, &b) * factor(&b, &c) * factor(&c, &a);
        let mixed = a.clone() * b.clone() + a.clone() * c.clone() + b.clone() * c.clone();
        let cone = a.power(2) + b.power(2) + c.power(2) - N::int(2) * mixed;
        let square = a + b + c;
        let shells = (square.clone() - N::int(1)).power(2) * (square - (N::int(2) - N::phi())).power(2);
        planes * cone + (N::int(3) + N::int(5) * N::phi()) * shells
    }
);

/// Windows of 1e-2, 1e-5 and 1e-8 around a double point.
fn around(domain: &str, node: [f64; 3]) -> [String; 3] {
    [1e-2, 1e-5, 1e-8].map(|side| window(domain, [1.5, -2.0, 3.3], node, side))
}

/// Two windows in which everything is decided, and one in which values are smaller than their rounding.
fn node<S: Surface>(name: &'static str, why: &'static str, [far, near, nearest]: [String; 3], size: u32) -> Case {
    let survey = Survey::new::<S>(&[far, near], &options(size));
    assert!(survey.tally.proved > 150 && survey.tally.unknown < 5, "{:?}", survey.tally);
    let closest = Survey::new::<S>(&[nearest], &deep(size));
    let [single, double] = survey.marched::<S>();
    assert!(single.wrong + single.invented > 100 && double.lost > 20, "{single}; {double}");
    let case = survey.case(name, why, [single, double]);
    Case { imp: format!("{}; through 1e-8 {}", case.imp, closest.tally), ..case }
}

pub fn sextic_nodes() -> Case {
    node::<Sextic>(
        "the Barth sextic's double point (1, 1, 1)",
        "Sheets meet like a cone's: rays beside the point cross two of them close together, and f is the square of the distance, which f64 cannot tell from 0 through a window of 1e-8 (the others are 1e-2 and 1e-5).",
        around("[0.9, 1.1]^3", [1.0; 3]),
        20,
    )
}

pub fn decic_nodes() -> Case {
    let h = std::f64::consts::FRAC_1_SQRT_2;
    node::<Decic>(
        "the Barth decic's double point (1, 1, 0) / sqrt(2)",
        "The same with degree ten: larger coefficients, smaller values.",
        around("[0.69, 0.72] x [0.69, 0.72] x [-0.02, 0.02]", [h, h, 0.0]),
        16,
    )
}

surface!(Crosscap, "4x^2 (x^2 + y^2 + z^2 + z) + y^2 (y^2 + z^2 - 1) = 0", |x, y, z| {
    let [a, b, c] = [&x, &y, &z].map(|v| v.power(2));
    N::int(4) * a.clone() * (a + b.clone() + c.clone() + z) + b.clone() * (b + c - N::int(1))
});

pub fn crosscap() -> Case {
    let domain = "[-0.6, 0.6] x [-1.1, 1.1] x [-1.1, 1.1]";
    let close = |z: f64, side: f64| window(domain, [2.0, -2.5, 1.5], [0.0, 0.0, z], side);
    let views = [format!("domain {domain}"), close(0.5, 0.01), close(1.0, 0.01), close(-0.5, 1e-4)];
    let survey = Survey::new::<Crosscap>(&views, &options(32));
    let [single, double] = survey.marched::<Crosscap>();
    assert!(survey.tally.proved > 2500 && survey.tally.unknown < 10, "{:?}", survey.tally);
    assert!(single.lost > 300 && double.lost > 300, "{single}; {double}");
    survey.case(
        "Crosscap along its double line",
        "Around the segment of self-intersection the sheets are closer to each other than two samples.",
        [single, double],
    )
}

surface!(Cube, "x^200 + y^200 + z^200 = 1", |x, y, z| x.power(200) + y.power(200) + z.power(200) - N::int(1));

/// Whether a ray is proved to stay out of the cube-like solid: in each part of the stretch the largest power, where it is
/// least, exceeds 1 by more than the rounding of all of this.
fn stays_out(look: &Look, [start, end]: [f64; 2], halvings: u32) -> bool {
    let ends = [start, end].map(|t| look.ray.at(t));
    let least = |axis: usize| match ends[0][axis] * ends[1][axis] > 0.0 {
        true => ends[0][axis].abs().min(ends[1][axis].abs()),
        false => 0.0,
    };
    if (0..3).map(|axis| least(axis).powi(200)).sum::<f64>() > 1.0 + 1e-9 {
        return true;
    }
    let middle = 0.5 * (start + end);
    halvings > 0 && stays_out(look, [start, middle], halvings - 1) && stays_out(look, [middle, end], halvings - 1)
}

pub fn power_200() -> Case {
    let text = format!("{}\ndomain [-2, 2]^3", Cube::TEXT);
    let shot = shoot(&text, &options(32));
    let mut survey = Survey { looks: shot.looks(), tally: Tally::default(), evaluations: shot.evaluations() };
    for look in &survey.looks {
        match (look.certainty, look.depth) {
            (Certainty::Hit, Some(depth)) => {
                // The left side is convex along a ray, so that after f(a) > 0 > f(b) no zero is before a.
                let [a, b] = depth.bracket;
                assert!(a < b && sign::<Cube>(&look.ray, a) > 0 && sign::<Cube>(&look.ray, b) < 0, "{depth:?}");
                survey.tally.proved += 1;
            }
            (Certainty::Miss, None) => {
                assert!(stays_out(look, look.inside, 30), "{:?}", look.ray);
                survey.tally.missed += 1;
            }
            _ => survey.tally.unknown += 1,
        }
    }
    let single = faults(&survey.looks, 1e-3, newton::<f32, Cube>);
    let double = faults(&survey.looks, 1e-3, newton::<f64, Cube>);
    assert!(survey.tally.proved > 500 && survey.tally.unknown < 5, "{:?}", survey.tally);
    assert!(single.lost == survey.tally.proved, "{single}; {double}");
    survey.case(
        "x^200 + y^200 + z^200 = 1, Newton's method",
        "1.6^200 overflows f32, and Newton's first step is inf / inf.",
        [single, double],
    )
}

surface!(Sphere, "x^2 + y^2 + z^2 - 1 = 0", |x, y, z| x.power(2) + y.power(2) + z.power(2) - N::int(1));
surface!(Squared, "(x^2 + y^2 + z^2 - 1)^2 = 0", |x, y, z| Sphere::value([x, y, z]).power(2));

pub fn squared() -> Case {
    let survey = Survey::new::<Squared>(&["domain [-1.2, 1.2]^3".to_owned()], &options(32));
    let Tally { proved, unknown, .. } = survey.tally;
    let met = survey.looks.iter().filter(|look| !is_clear::<Sphere>(&look.ray, look.inside[0], look.inside[1])).count();
    let drawn = survey.looks.iter().filter(|look| look.certainty == Certainty::Unknown && look.depth.is_some()).count();
    assert!(proved == 0 && drawn == unknown && met <= unknown && unknown <= met + 5, "{:?}, {met} meet", survey.tally);
    let (single, double) = (found::<f32, Squared>(&survey.looks), found::<f64, Squared>(&survey.looks));
    Case {
        name: "a sphere squared, g^2 = 0",
        why: "A square never changes sign: what looks for a change sees nothing, and what has bounds can prove nothing but must not pass over it.",
        single,
        double,
        imp: format!("{}; {met} rays meet it, all unknown are drawn", survey.tally),
        cost: format!("{} evaluations", survey.evaluations),
    }
}
