//! Poles change sign without a root.

use imp::render::Certainty;

use crate::case::Case;
use crate::plain::Number;
use crate::plain::Plain;
use crate::plain::Surface;
use crate::plain::march;
use crate::shot::check;
use crate::shot::marching;
use crate::shot::options;
use crate::shot::shoot;

/// A surface without a zero in its domain: the numerator is 1 or has one sign there.
macro_rules! pole {
    ($name:ident, $text:literal, |$x:ident, $y:ident, $z:ident| $plain:expr) => {
        struct $name;

        impl Surface for $name {
            const TEXT: &'static str = $text;

            fn value<N: Number>(_point: [N; 3]) -> N {
                N::int(1)
            }

            fn plain<T: Plain>([$x, $y, $z]: [T; 3]) -> T {
                $plain
            }
        }
    };
}

pole!(Plane, "1 / (x - 0.3) = 0\ndomain [-1, 1]^3", |x, _y, _z| T::int(1) / (x - T::ratio(3, 10)));
pole!(Tangent, "tan(x) = 0\ndomain [1, 2] x [-1, 1] x [-1, 1]", |x, _y, _z| x.tan());
pole!(Shell, "1 / (x^2 + y^2 + z^2 - 1) = 0\ndomain [-1.2, 1.2]^3", |x, y, z| {
    T::int(1) / (x.power(2) + y.power(2) + z.power(2) - T::int(1))
});

fn without_root<S: Surface>(name: &'static str, why: &'static str) -> Case {
    let shot = shoot(S::TEXT, &options(32));
    let looks = shot.looks();
    let tally = check::<S>(&looks);
    assert_eq!(tally.proved, 0);
    let single = looks.iter().filter(|look| march::<f32, S>(&look.ray, look.inside, 1000).is_some()).count();
    let double = looks.iter().filter(|look| march::<f64, S>(&look.ray, look.inside, 1000).is_some()).count();
    let drawn = looks.iter().filter(|look| look.depth.is_some()).count();
    println!("{name} {tally:?} {drawn}");
    assert!(single > 50 && double > 50, "{single}, {double}");
    Case {
        name,
        why,
        single: format!("{single} roots"),
        double: format!("{double} roots"),
        imp: format!("0 proved, {} missed, {} unknown, {drawn} drawn", tally.missed, tally.unknown),
        cost: format!("{} evaluations", shot.evaluations()),
    }
}

pub fn plane() -> Case {
    without_root::<Plane>("1 / (x - 0.3) = 0", "")
}

pub fn tangent() -> Case {
    without_root::<Tangent>("tan x = 0 on [1, 2]", "")
}

pub fn shell() -> Case {
    without_root::<Shell>("1 / (x^2 + y^2 + z^2 - 1) = 0", "")
}

struct Inverse;

impl Surface for Inverse {
    const TEXT: &'static str = "1 / (x - y^2) - z = 0";

    fn value<N: Number>([x, y, z]: [N; 3]) -> N {
        N::int(1) - z * (x - y.power(2))
    }

    fn pole<N: Number>([x, y, _]: [N; 3]) -> Option<N> {
        Some(x - y.power(2))
    }

    fn plain<T: Plain>([x, y, z]: [T; 3]) -> T {
        T::int(1) / (x - y.power(2)) - z
    }
}

pub fn inverse() -> Case {
    let shot = shoot(&format!("{}\ndomain [-2, 3] x [-1.8, 1.8] x [-2.5, 2.5]", Inverse::TEXT), &options(40));
    let looks = shot.looks();
    let tally = check::<Inverse>(&looks);
    let (single, double) = (marching::<f32, Inverse>(&looks, 1000), marching::<f64, Inverse>(&looks, 1000));
    let drawn = looks.iter().filter(|look| look.certainty == Certainty::Unknown && look.depth.is_some()).count();
    println!("{tally:?} {single} {double} {drawn}");
    Case {
        name: "1 / (x - y^2) = z",
        why: "",
        single: single.to_string(),
        double: double.to_string(),
        imp: format!("{} proved, {} missed, {} unknown", tally.proved, tally.missed, tally.unknown),
        cost: format!("{} evaluations", shot.evaluations()),
    }
}
