//! The operations that are compared, as both libraries spell them.

use imp::interval::Interval;
use inari::Interval as Peer;

use crate::Ranges;
use crate::compare;

const ANY: (f64, f64) = (-5.0, 5.0);
const POSITIVE: (f64, f64) = (0.1, 5.0);
const ONES: (f64, f64) = (-0.95, 0.85);

/// A row for each `name [ranges], |x, y, z| ours, peer's`: what is applied to the boxes x, y, z, spelled once if both
/// libraries agree.
macro_rules! table {
    ($($name:literal $ranges:expr, |$x:ident, $y:ident, $z:ident| $ours:expr $(, $peer:expr)?;)*) => {
        $({
            let ours = |[$x, $y, $z]: &[Interval; 3]| { let _ = ($x, $y, $z); $ours };
            let peer = |[$x, $y, $z]: &[Peer; 3]| { let _ = ($x, $y, $z); table!(@last $ours $(, $peer)?) };
            compare($name, $ranges, ours, Some(peer));
        })*
    };
    (@last $ours:expr) => { $ours };
    (@last $ours:expr, $peer:expr) => { $peer };
}

/// Operations that inari does not have.
fn alone(name: &str, ranges: Ranges, ours: impl Fn(&[Interval; 3]) -> Interval) {
    compare(name, ranges, ours, None::<fn(&[Peer; 3]) -> Peer>);
}

/// 4 (phi^2 x^2 - y^2)(phi^2 y^2 - z^2)(phi^2 z^2 - x^2) - (1 + 2 phi)(x^2 + y^2 + z^2 - 1)^2, in the terms of one
/// library; the coefficients are the tightest enclosures of phi^2 = 2.618... and of 1 + 2 phi = 4.236...
macro_rules! barth {
    ($x:ident, $y:ident, $z:ident, $interval:path) => {{
        let number = |lo: f64, hi: f64| $interval(lo, hi).expect("a range");
        let square = number(2.618033988749895f64.next_down(), 2.618033988749895);
        let (x, y, z) = ($x.sqr(), $y.sqr(), $z.sqr());
        let product = (square * x - y) * (square * y - z) * (square * z - x) * number(4.0, 4.0);
        let sphere = (x + y + z - number(1.0, 1.0)).sqr();
        product - number(4.23606797749979f64.next_down(), 4.23606797749979) * sphere
    }};
}

/// sin 4x cos 4y + sin 4y cos 4z + sin 4z cos 4x, in the terms of one library.
macro_rules! gyroid {
    ($x:ident, $y:ident, $z:ident, $interval:path) => {{
        let four = $interval(4.0, 4.0).expect("a range");
        let (x, y, z) = (four * *$x, four * *$y, four * *$z);
        x.sin() * y.cos() + y.sin() * z.cos() + z.sin() * x.cos()
    }};
}

pub fn compare_all() {
    table! {
        "-x" [ANY; 3], |x, y, z| -*x;
        "x + y" [ANY; 3], |x, y, z| *x + *y;
        "x - y" [ANY; 3], |x, y, z| *x - *y;
        "x y" [ANY; 3], |x, y, z| *x * *y;
        "x / y" [ANY; 3], |x, y, z| *x / *y;
        "x y + z" [ANY; 3], |x, y, z| x.mul_add(*y, *z);
        "1 / x" [ANY; 3], |x, y, z| x.recip();
        "x^2" [ANY; 3], |x, y, z| x.sqr();
        "sqrt x" [POSITIVE; 3], |x, y, z| x.sqrt();
        "|x|" [ANY; 3], |x, y, z| x.abs();
        "min(x, y)" [ANY; 3], |x, y, z| x.min(*y);
        "max(x, y)" [ANY; 3], |x, y, z| x.max(*y);
        "floor x" [ANY; 3], |x, y, z| x.floor();
        "ceil x" [ANY; 3], |x, y, z| x.ceil();
        "round x" [ANY; 3], |x, y, z| x.round();
        "trunc x" [ANY; 3], |x, y, z| x.trunc();
        "sign x" [ANY; 3], |x, y, z| x.sign();
        "x^3" [ANY; 3], |x, y, z| x.powi(3);
        "x^8" [ANY; 3], |x, y, z| x.powi(8);
        "x^-3" [POSITIVE; 3], |x, y, z| x.powi(-3);
        "x^y" [POSITIVE; 3], |x, y, z| x.pow(*y);
        "exp x" [ANY; 3], |x, y, z| x.exp();
        "exp2 x" [ANY; 3], |x, y, z| x.exp2();
        "exp10 x" [ANY; 3], |x, y, z| x.exp10();
        "ln x" [POSITIVE; 3], |x, y, z| x.ln();
        "log2 x" [POSITIVE; 3], |x, y, z| x.log2();
        "log10 x" [POSITIVE; 3], |x, y, z| x.log10();
        "sin x" [ANY; 3], |x, y, z| x.sin();
        "cos x" [ANY; 3], |x, y, z| x.cos();
        "tan x" [ANY; 3], |x, y, z| x.tan();
        "asin x" [ONES; 3], |x, y, z| x.asin();
        "acos x" [ONES; 3], |x, y, z| x.acos();
        "atan x" [ANY; 3], |x, y, z| x.atan();
        "atan2(y, x)" [ANY; 3], |x, y, z| y.atan2(*x);
        "sinh x" [ANY; 3], |x, y, z| x.sinh();
        "cosh x" [ANY; 3], |x, y, z| x.cosh();
        "tanh x" [ANY; 3], |x, y, z| x.tanh();
        "asinh x" [ANY; 3], |x, y, z| x.asinh();
        "acosh x" [(1.1, 5.0); 3], |x, y, z| x.acosh();
        "atanh x" [ONES; 3], |x, y, z| x.atanh();
        "Barth sextic" [(-2.0, 2.0); 3], |x, y, z| barth!(x, y, z, Interval::new), barth!(x, y, z, peer);
        "gyroid" [(-2.0, 2.0); 3], |x, y, z| gyroid!(x, y, z, Interval::new), gyroid!(x, y, z, peer);
    }
    alone("expm1 x", [ANY; 3], |[x, _, _]| x.expm1());
    alone("log1p x", [POSITIVE; 3], |[x, _, _]| x.log1p());
    alone("cbrt x", [ANY; 3], |[x, _, _]| x.cbrt());
    alone("x^(2/3)", [ANY; 3], |[x, _, _]| x.pow_rational(2, 3));
    alone("hypot(x, y)", [ANY; 3], |[x, y, _]| x.hypot(*y));
    alone("x mod y", [ANY; 3], |[x, y, _]| x.modulo(*y));
}

fn peer(lo: f64, hi: f64) -> Option<Peer> {
    inari::interval!(lo, hi).ok()
}
