//! Arrangements of curves that are no polynomials, or only under a condition, with the derivation of each figure.

use super::cases::Case;
use super::cases::case;

/// Formulas and conditions.
pub const FORMULAS: &[Case] = &[
    // Zeros k pi with |k| <= 3.
    case(
        "sine and axis",
        "curve a: y = sin(x); curve b: y = 0; domain [-10, 10] x [-2, 3]",
        "by hand: sin x = 0",
        [10, 1, 0, 4],
        &[(4, 7)],
    ),
    // pi/4 + k pi: -2.36, 0.79, 3.93.
    case(
        "sine and cosine",
        "curve a: y = sin(x); curve b: y = cos(x); domain [-5, 5] x [-2, 2]",
        "by hand: tan x = 1",
        [6, 1, 0, 4],
        &[(4, 3)],
    ),
    // Touch in (0, 1), since exp is convex: no interval can tell.
    case(
        "exponential and its tangent",
        "curve a: y = exp(x); curve b: y = x + 1; domain [-3, 2] x [-3, 5]",
        "by hand: convexity",
        [4, 1, 0, 4],
        &[(4, 1)],
    ),
    case(
        "exponential and secant",
        "curve a: y = exp(x); curve b: y = x + 1.1; domain [-3, 2] x [-3, 5]",
        "by hand: convexity",
        [5, 1, 0, 4],
        &[(4, 2)],
    ),
    case(
        "exponential and passing line",
        "curve a: y = exp(x); curve b: y = x + 0.9; domain [-3, 2] x [-3, 5]",
        "by hand: convexity",
        [3, 2, 0, 4],
        &[],
    ),
    // Three branches within |y| <= 3; beyond 3 pi/2 = 4.71 only values below tan 5 = -3.38.
    case("tangent function", "curve a: y = tan(x); domain [-5, 5] x [-3, 3]", "by hand: poles", [4, 3, 0, 6], &[]),
    case(
        "circle and half circle",
        "curve a: x^2 + y^2 = 1; curve b: y = sqrt(9 - x^2); domain [-4, 4] x [-2, 5]",
        "a complaint about plotters: gaps at the ends",
        [2, 2, 0, 0],
        &[(1, 2)],
    ),
    // Steps -3 .. 2 of the floor function, jumps at -2 .. 2.
    case(
        "floor",
        "curve a: y = floor(x); domain [-2.3, 2.6] x [-4, 4]",
        "by hand: five jumps",
        [1, 6, 0, 2],
        &[(1, 10)],
    ),
    case("unit diamond", "curve a: |x| + |y| = 1; domain [-2, 2.5]^2", "by hand", [2, 1, 0, 0], &[]),
    case(
        "two diagonals of absolute values",
        "curve a: |x| = |y|; domain [-2, 3] x [-2.5, 2.7]",
        "by hand",
        [4, 1, 0, 4],
        &[(4, 1)],
    ),
    // x and y in {-pi, 0, pi}.
    case(
        "grid of sines",
        "curve a: sin(x) sin(y) = 0; domain [-4, 5] x [-4, 3.5]",
        "by hand",
        [16, 1, 0, 12],
        &[(4, 9)],
    ),
    // sin A = cos B: x^2 + y^2 -+ x y = pi/2; those with 5 pi/2 are beyond sqrt(5 pi / 6) = 1.62 on the diagonals.
    case(
        "sine of squares, cosine of product",
        "curve a: sin(x^2 + y^2) = cos(x y); domain [-1.55, 1.5]^2",
        "by hand: two ellipses",
        [6, 1, 0, 0],
        &[(4, 4)],
    ),
    // In u = x + y the graph v = sin(exp u) of v = y - x; where |u -+ v| = 2 it leaves, see `leaving` in tests/peers/cgal.
    case(
        "sine of an exponential",
        "curve a: y - x = sin(exp(x + y)); domain [-1, 1]^2",
        "by hand: a graph over x + y",
        [3, 2, 0, 4],
        &[],
    ),
    // The lines x + y and x - y = pi or -pi; 3 pi is beyond the corners.
    case(
        "sum of cosines",
        "curve a: cos(x) + cos(y) = 0; domain [-4, 4.2] x [-3.9, 4.1]",
        "by hand: four lines",
        [9, 1, 0, 8],
        &[(4, 4)],
    ),
    case(
        "oval of cosines",
        "curve a: cos(x) + cos(y) = 1/2; domain [-4, 4]^2",
        "by hand: convex around 0",
        [2, 1, 0, 0],
        &[],
    ),
    // The line y = x and a branch that crosses it in (e, e): a double point whose coordinates are no algebraic numbers.
    case(
        "x^y = y^x",
        "curve a: y ln(x) = x ln(y); domain [0.5, 5] x [0.6, 6]",
        "L. Euler, Introductio in analysin infinitorum, 1748",
        [4, 1, 0, 4],
        &[(4, 1)],
    ),
    case(
        "arc tangent and line",
        "curve a: y = atan(x); curve b: y = x / 2; domain [-4, 4.5] x [-3, 3]",
        "by hand: tan y = 2y",
        [6, 1, 0, 4],
        &[(4, 3)],
    ),
    // ln x = x / 3 in 1.86 and 4.54.
    case(
        "logarithm and line",
        "curve a: y = ln(x); curve b: y = x / 3; domain [-1, 9] x [-3, 3.5]",
        "by hand: concavity",
        [5, 1, 0, 4],
        &[(4, 2)],
    ),
    // x = sin y and y = sin x meet in (0, 0) only, with contact of order 3.
    case(
        "sine and its inverse relation",
        "curve a: y = sin(x); curve b: x = sin(y); domain [-3, 3.1] x [-2.9, 3]",
        "by hand: |sin t| < |t|",
        [4, 1, 0, 4],
        &[(4, 1)],
    ),
    case(
        "half circle by a condition",
        "curve a: x^2 + y^2 = 1 where y > x / 3; domain [-2, 2]^2",
        "by hand",
        [1, 1, 0, 0],
        &[(1, 2)],
    ),
    // The ends (0, 0) inside and (2, 0) outside the circle, one crossing in (1/2, sqrt(3)/2).
    case(
        "circle and half circle by a condition",
        "curve a: x^2 + y^2 = 1; curve b: (x - 1)^2 + y^2 = 1 where y > 0; domain [-2, 3]^2",
        "by hand",
        [2, 1, 0, 0],
        &[(1, 2), (4, 1)],
    ),
    case(
        "arcs of a hyperbola and a circle",
        "curve a: x y = 1 where x^2 + y^2 < 4; curve b: x^2 + y^2 = 9 where |y| < 1; domain [-4, 4.5]^2",
        "by hand: 2 + 2 arcs",
        [1, 4, 0, 0],
        &[(1, 8)],
    ),
    // Closed: ends of the half circle and of its chord are the same two points.
    case(
        "half disc",
        "curve a: x^2 + y^2 = 1 where y > 0; curve b: y = 0 where x^2 < 1; domain [-2, 2]^2",
        "by hand",
        [2, 1, 0, 0],
        &[],
    ),
    case(
        "circle without a quarter",
        "curve a: x^2 + y^2 = 1 where x < 0 or y < 0; domain [-2, 2.5]^2",
        "by hand",
        [1, 1, 0, 0],
        &[(1, 2)],
    ),
    case("corner of a maximum", "curve a: max(x, y) = 1/2; domain [-2, 2.5]^2", "by hand", [2, 1, 0, 2], &[]),
    case("square of a maximum", "curve a: max(|x|, |y|) = 1; domain [-2, 2.5]^2", "by hand", [2, 1, 0, 0], &[]),
    case(
        "cube root and line",
        "curve a: y = cbrt(x); curve b: y = x / 4; domain [-9, 10] x [-3, 3.5]",
        "by hand: 0, 8, -8",
        [6, 1, 0, 4],
        &[(4, 3)],
    ),
    // Gaussian of height 1: y = 1/2 in +-sqrt(ln 2).
    case(
        "bell curve and line",
        "curve a: y = exp(-x^2); curve b: y = 1/2; domain [-3, 3.5] x [-1, 2]",
        "by hand",
        [5, 1, 0, 4],
        &[(4, 2)],
    ),
];
