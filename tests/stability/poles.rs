//! Poles change sign without a root.

use crate::case::Case;
use crate::plain::Number;
use crate::plain::Plain;
use crate::plain::Surface;
use crate::shot::Survey;
use crate::shot::options;

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
    let survey = Survey::new::<S>(&[String::new()], &options(32));
    let [single, double] = survey.marched::<S>();
    assert!(survey.tally.proved == 0 && survey.looks.iter().all(|look| look.depth.is_none()));
    assert!(single.invented > 100 && double.invented > 100, "{single}; {double}");
    survey.case(name, why, [single, double])
}

pub fn plane() -> Case {
    without_root::<Plane>(
        "1 / (x - 0.3) = 0",
        "The value jumps from -inf to inf; Imp sees that the numerator has no zero.",
    )
}

pub fn tangent() -> Case {
    without_root::<Tangent>("tan x = 0 on [1, 2]", "The same at pi/2; the numerator is sin x.")
}

pub fn shell() -> Case {
    without_root::<Shell>("1 / (x^2 + y^2 + z^2 - 1) = 0", "A sphere of poles looks like a sphere.")
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
    let survey = Survey::new::<Inverse>(&["domain [-2, 3] x [-1.8, 1.8] x [-2.5, 2.5]".to_owned()], &options(40));
    let [single, double] = survey.marched::<Inverse>();
    assert!(survey.tally.proved > 400 && survey.tally.unknown < 10, "{:?}", survey.tally);
    assert!(single.wrong > 100 && double.wrong > 100 && double.invented > 50, "{single}; {double}");
    survey.case(
        "1 / (x - y^2) = z",
        "A pole along x = y^2 in front of the sheets, or without one behind it.",
        [single, double],
    )
}
