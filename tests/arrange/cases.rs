//! Arrangements whose figures are known: from a book, by hand, or by elimination (an exact algorithm that is not Imp's;
//! `tests/peers/cgal` repeats it for every scene here that is polynomial).

/// A scene and what is true of it.
pub struct Case {
    pub name: &'static str,
    pub scene: &'static str,
    /// Where the curve or its figures come from.
    pub source: &'static str,
    pub truth: Truth,
}

/// What does not depend on where arcs are cut, within the domain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Truth {
    /// Cells of the domain without the curves.
    pub faces: usize,
    /// Connected parts of the union of the curves, isolated points among them.
    pub components: usize,
    pub isolated: usize,
    /// Points on the domain's boundary.
    pub boundary: usize,
    /// Points inside where other than two branches meet, isolated ones left out: (branches, how many), rising.
    pub degrees: &'static [(usize, usize)],
}

/// A case; the figures in the order faces, components, isolated points, boundary points.
pub const fn case(
    name: &'static str,
    scene: &'static str,
    source: &'static str,
    [faces, components, isolated, boundary]: [usize; 4],
    degrees: &'static [(usize, usize)],
) -> Case {
    Case { name, scene, source, truth: Truth { faces, components, isolated, boundary, degrees } }
}

pub const LAWRENCE: &str = "J. D. Lawrence, A Catalog of Special Plane Curves, Dover 1972";
pub const HAND: &str = "by hand";
pub const ELIMINATION: &str = "by elimination";

/// Circles and lines.
pub const CIRCLES: &[Case] = &[
    case(
        "circles crossing",
        "curve a: x^2 + y^2 = 1; curve b: (x - 1)^2 + y^2 = 1; domain [-3, 3]^2",
        HAND,
        [4, 1, 0, 0],
        &[(4, 2)],
    ),
    case(
        "circles touching outside",
        "curve a: x^2 + y^2 = 1; curve b: (x - 2)^2 + y^2 = 1; domain [-2, 4] x [-3, 3]",
        HAND,
        [3, 1, 0, 0],
        &[(4, 1)],
    ),
    case(
        "circles touching inside",
        "curve a: x^2 + y^2 = 4; curve b: (x - 1)^2 + y^2 = 1; domain [-3, 3]^2",
        HAND,
        [3, 1, 0, 0],
        &[(4, 1)],
    ),
    // At (3/5, 4/5) from (0, 0) and (6/5, 8/5).
    case(
        "circles touching aslant",
        "curve a: x^2 + y^2 = 1; curve b: (x - 1.2)^2 + (y - 1.6)^2 = 1; domain [-2, 3]^2",
        HAND,
        [3, 1, 0, 0],
        &[(4, 1)],
    ),
    case(
        "circles apart",
        "curve a: x^2 + y^2 = 1; curve b: (x - 2.5)^2 + y^2 = 1; domain [-2, 4] x [-3, 3]",
        HAND,
        [3, 2, 0, 0],
        &[],
    ),
    case(
        "circles nested",
        "curve a: x^2 + y^2 = 4; curve b: (x - 0.5)^2 + y^2 = 1; domain [-3, 3]^2",
        HAND,
        [3, 2, 0, 0],
        &[],
    ),
    case(
        "five concentric circles",
        "curve a: x^2 + y^2 = 1; curve b: x^2 + y^2 = 2; curve c: x^2 + y^2 = 3; curve d: x^2 + y^2 = 4; curve e: x^2 + y^2 = 5; domain [-3, 3]^2",
        HAND,
        [6, 5, 0, 0],
        &[],
    ),
    case(
        "gap 1e-3",
        "curve a: x^2 + y^2 = 1; curve b: (x - 2.001)^2 + y^2 = 1; domain [-2, 4] x [-3, 3]",
        HAND,
        [3, 2, 0, 0],
        &[],
    ),
    case(
        "gap 1e-6",
        "curve a: x^2 + y^2 = 1; curve b: (x - 2.000001)^2 + y^2 = 1; domain [-2, 4] x [-3, 3]",
        HAND,
        [3, 2, 0, 0],
        &[],
    ),
    case(
        "gap 1e-9",
        "curve a: x^2 + y^2 = 1; curve b: (x - 2.000000001)^2 + y^2 = 1; domain [-2, 4] x [-3, 3]",
        HAND,
        [3, 2, 0, 0],
        &[],
    ),
    case(
        "gap 1e-12",
        "curve a: x^2 + y^2 = 1; curve b: (x - 2.000000000001)^2 + y^2 = 1; domain [-2, 4] x [-3, 3]",
        HAND,
        [3, 2, 0, 0],
        &[],
    ),
    case(
        "overlap 1e-3",
        "curve a: x^2 + y^2 = 1; curve b: (x - 1.999)^2 + y^2 = 1; domain [-2, 4] x [-3, 3]",
        HAND,
        [4, 1, 0, 0],
        &[(4, 2)],
    ),
    case(
        "overlap 1e-6",
        "curve a: x^2 + y^2 = 1; curve b: (x - 1.999999)^2 + y^2 = 1; domain [-2, 4] x [-3, 3]",
        HAND,
        [4, 1, 0, 0],
        &[(4, 2)],
    ),
    case(
        "overlap 1e-9",
        "curve a: x^2 + y^2 = 1; curve b: (x - 1.999999999)^2 + y^2 = 1; domain [-2, 4] x [-3, 3]",
        HAND,
        [4, 1, 0, 0],
        &[(4, 2)],
    ),
    case(
        "overlap 1e-12",
        "curve a: x^2 + y^2 = 1; curve b: (x - 1.999999999999)^2 + y^2 = 1; domain [-2, 4] x [-3, 3]",
        HAND,
        [4, 1, 0, 0],
        &[(4, 2)],
    ),
    case(
        "nested with gap 1e-6",
        "curve a: x^2 + y^2 = 4; curve b: (x - 0.999999)^2 + y^2 = 1; domain [-3, 3]^2",
        HAND,
        [3, 2, 0, 0],
        &[],
    ),
    case(
        "circle and tangent",
        "curve a: x^2 + y^2 = 1; curve b: y = 1; domain [-3, 3]^2",
        HAND,
        [3, 1, 0, 2],
        &[(4, 1)],
    ),
    case(
        "circle and tangent aslant",
        "curve a: x^2 + y^2 = 1; curve b: 3x + 4y = 5; domain [-3, 3]^2",
        HAND,
        [3, 1, 0, 2],
        &[(4, 1)],
    ),
    // They touch in (1, -1) and (-1, 1); the lines are the factors of the second curve.
    case(
        "circle and two tangents, irrational",
        "curve a: x^2 + y^2 = 2; curve b: (x - y)^2 = 4; domain [-3, 3.5] x [-3.2, 3]",
        HAND,
        [5, 1, 0, 4],
        &[(4, 2)],
    ),
    case(
        "circle and secant",
        "curve a: x^2 + y^2 = 1; curve b: y = 0.5; domain [-3, 3]^2",
        HAND,
        [4, 1, 0, 2],
        &[(4, 2)],
    ),
    case(
        "circle and passing line",
        "curve a: x^2 + y^2 = 1; curve b: y = 1.5; domain [-3, 3]^2",
        HAND,
        [3, 2, 0, 2],
        &[],
    ),
    case(
        "three circles through two points",
        "curve a: x^2 + y^2 = 1; curve b: (x - 1)^2 + y^2 = 2; curve c: (x + 1)^2 + y^2 = 2; domain [-3, 3]^2",
        HAND,
        [6, 1, 0, 0],
        &[(6, 2)],
    ),
    case(
        "three circles through one point",
        "curve a: x^2 + y^2 = 2x; curve b: x^2 + y^2 = 2y; curve c: x^2 + y^2 = -x - y; domain [-3, 3]^2",
        HAND,
        [7, 1, 0, 0],
        &[(4, 3), (6, 1)],
    ),
    case(
        "three lines through one point",
        "curve a: y = x / 2; curve b: y = -x / 3; curve c: x = y / 7; domain [-3, 3]^2",
        HAND,
        [6, 1, 0, 6],
        &[(6, 1)],
    ),
    // 1 + n + n (n - 1) / 2 faces, of which all crossings lie in the box.
    case(
        "six lines in general position",
        "curve a: y = 1; curve b: y = 2x + 1.5; curve c: y = -2x + 0.7; curve d: y = x / 2 - 0.3; curve e: y = -x / 3 + 0.1; curve f: x = -0.9; domain [-9, 9.5] x [-9, 9.2]",
        HAND,
        [22, 1, 0, 12],
        &[(4, 15)],
    ),
    case(
        "pencil of five lines",
        "curve a: 3y - 1 = 2 (3x - 1); curve b: 3y - 1 = -(3x - 1); curve c: 3y - 1 = 5 (3x - 1); curve d: 3y - 1 = 0; curve e: 3x - 1 = 0; domain [-3, 3.3] x [-3.1, 3]",
        HAND,
        [10, 1, 0, 10],
        &[(10, 1)],
    ),
    case(
        "grid of lines",
        "curve a: x = -1; curve b: x = 0; curve c: x = 1; curve d: y = -1.5; curve e: y = -0.5; curve f: y = 0.5; curve g: y = 1.5; domain [-3, 3]^2",
        HAND,
        [20, 1, 0, 14],
        &[(4, 12)],
    ),
    case(
        "grid of lines as two products",
        "curve a: x^3 = x; curve b: (y^2 - 2) (y^2 - 1/2) = 0; domain [-3, 3]^2",
        HAND,
        [20, 1, 0, 14],
        &[(4, 12)],
    ),
    case(
        "lines 1e-5 apart",
        "curve a: y = x; curve b: y = x + 0.00001; domain [-3, 3.5] x [-3.1, 3]",
        HAND,
        [3, 2, 0, 4],
        &[],
    ),
];

/// Singular points of all simple kinds, in curves with names.
pub const SINGULAR: &[Case] = &[
    case("semicubical parabola", "curve a: y^2 = x^3; domain [-2, 3] x [-3, 3]", LAWRENCE, [2, 1, 0, 2], &[]),
    case("cusp of the second kind", "curve a: (y - x^2)^2 = x^5; domain [-1, 1.3] x [-1, 2]", HAND, [2, 1, 0, 2], &[]),
    case("cardioid", "curve a: (x^2 + y^2 - x)^2 = x^2 + y^2; domain [-1, 3] x [-2, 2]", LAWRENCE, [2, 1, 0, 0], &[]),
    case(
        "deltoid",
        "curve a: (x^2 + y^2)^2 + 18 (x^2 + y^2) - 27 = 8 (x^3 - 3x y^2); domain [-3, 4] x [-4, 4]",
        LAWRENCE,
        [2, 1, 0, 0],
        &[],
    ),
    case("astroid", "curve a: (x^2 + y^2 - 1)^3 + 27x^2 y^2 = 0; domain [-1.5, 1.6]^2", LAWRENCE, [2, 1, 0, 0], &[]),
    case("nephroid", "curve a: (x^2 + y^2 - 4)^3 = 108y^2; domain [-5, 5]^2", LAWRENCE, [2, 1, 0, 0], &[]),
    case(
        "cissoid of Diocles",
        "curve a: x (x^2 + y^2) = 2y^2; domain [-1, 2.5] x [-3, 3.2]",
        LAWRENCE,
        [2, 1, 0, 2],
        &[],
    ),
    case(
        "folium of Descartes",
        "curve a: x^3 + y^3 = 3x y; domain [-3, 3.2] x [-3.1, 3]",
        LAWRENCE,
        [3, 1, 0, 2],
        &[(4, 1)],
    ),
    case(
        "folium and a line through its double point",
        "curve a: x^3 + y^3 = 3x y; curve b: y = x / 2; domain [-3, 3.2] x [-3.1, 3]",
        HAND,
        [6, 1, 0, 4],
        &[(4, 1), (6, 1)],
    ),
    case(
        "folium and a tangent of its double point",
        "curve a: x^3 + y^3 = 3x y; curve b: y = 0; domain [-3, 3.2] x [-3.1, 3]",
        HAND,
        [5, 1, 0, 4],
        &[(6, 1)],
    ),
    case(
        "lemniscate of Bernoulli",
        "curve a: (x^2 + y^2)^2 = 2 (x^2 - y^2); domain [-2, 2]^2",
        LAWRENCE,
        [3, 1, 0, 0],
        &[(4, 1)],
    ),
    case(
        "large lemniscate",
        "curve a: (x^2 + y^2)^2 = 42 (x^2 - y^2); domain [-10, 10]^2",
        LAWRENCE,
        [3, 1, 0, 0],
        &[(4, 1)],
    ),
    case("lemniscate of Gerono", "curve a: x^4 = x^2 - y^2; domain [-2, 2]^2", LAWRENCE, [3, 1, 0, 0], &[(4, 1)]),
    case("nodal cubic", "curve a: y^2 = x^2 (x + 1); domain [-2, 2] x [-2.5, 2.5]", HAND, [3, 1, 0, 2], &[(4, 1)]),
    case("two lobes with a tacnode", "curve a: y^2 = x^4 - x^6; domain [-2, 2]^2", HAND, [3, 1, 0, 0], &[(4, 1)]),
    case(
        "kappa curve",
        "curve a: x^2 (x^2 + y^2) = y^2; domain [-1.5, 1.4] x [-2, 2.2]",
        LAWRENCE,
        [4, 1, 0, 4],
        &[(4, 1)],
    ),
    case("tacnode of two parabolas", "curve a: y^2 = x^4; domain [-2, 2] x [-3, 3]", HAND, [4, 1, 0, 4], &[(4, 1)]),
    case(
        "tacnode with x-axis between",
        "curve a: y = x^2; curve b: y = -x^2; curve c: y = 0; domain [-1.5, 1.6] x [-3, 3]",
        HAND,
        [6, 1, 0, 6],
        &[(6, 1)],
    ),
    case(
        "osculating parabolas",
        "curve a: y = x^2; curve b: y = x^2 + x^3; domain [-1.5, 1.2] x [-1.5, 2]",
        HAND,
        [4, 1, 0, 4],
        &[(4, 1)],
    ),
    case("acnodal cubic", "curve a: y^2 = x^3 - x^2; domain [-1, 3] x [-3, 3]", HAND, [2, 2, 1, 2], &[]),
    case("a point", "curve a: x^2 + y^2 = 0; domain [-1, 1.5]^2", HAND, [1, 1, 1, 0], &[]),
    case(
        "a point off the middle",
        "curve a: 9x^2 - 6x + 9y^2 - 12y + 5 = 0; domain [-1, 1.5]^2",
        HAND,
        [1, 1, 1, 0],
        &[],
    ),
    case("a flat point", "curve a: x^4 + y^4 = 0; domain [-1, 1.5]^2", HAND, [1, 1, 1, 0], &[]),
    case(
        "two irrational points",
        "curve a: (x^2 - 2)^2 + y^2 = 0; domain [-2, 2.5] x [-1, 1.5]",
        HAND,
        [1, 2, 2, 0],
        &[],
    ),
    case(
        "two points of contact",
        "curve a: (x^2 + y^2 - 2)^2 + (x y - 1)^2 = 0; domain [-2, 2.5]^2",
        HAND,
        [1, 2, 2, 0],
        &[],
    ),
    case("nine points", "curve a: (x^3 - x)^2 + (y^3 - y)^2 = 0; domain [-2, 2.5]^2", HAND, [1, 9, 9, 0], &[]),
    case(
        "a point on a line",
        "curve a: x^2 + y^2 = 0; curve b: y = x / 2; domain [-1, 1.5]^2",
        HAND,
        [2, 1, 0, 2],
        &[],
    ),
    case("nothing", "curve a: x^2 + y^2 + 1 = 0; domain [-1, 1.5]^2", HAND, [1, 0, 0, 0], &[]),
    case("nothing by 1e-12", "curve a: x^2 + y^2 = -0.000000000001; domain [-1, 1.5]^2", HAND, [1, 0, 0, 0], &[]),
    case("circle of radius 1e-6", "curve a: x^2 + y^2 = 0.000000000001; domain [-1, 1.5]^2", HAND, [2, 1, 0, 0], &[]),
    case("monkey saddle", "curve a: x^3 = 3x y^2; domain [-1, 1.5] x [-1.2, 1.4]", HAND, [6, 1, 0, 6], &[(6, 1)]),
];

/// What a formula may repeat or hide.
pub const REPEATED: &[Case] = &[
    case(
        "the same circle twice",
        "curve a: x^2 + y^2 = 1; curve b: 2x^2 = 2 - 2y^2; domain [-3, 3]^2",
        HAND,
        [2, 1, 0, 0],
        &[],
    ),
    case(
        "a circle and a product with it",
        "curve a: x^2 + y^2 = 1; curve b: (x^2 + y^2 - 1) (2x - y) = 0; domain [-3, 3.1] x [-3, 3.2]",
        HAND,
        [4, 1, 0, 2],
        &[(4, 2)],
    ),
    case("a circle squared", "curve a: (x^2 + y^2 - 1)^2 = 0; domain [-3, 3]^2", HAND, [2, 1, 0, 0], &[]),
    case(
        "an expanded square",
        "curve a: x^4 + 2x^2 y^2 + y^4 - 2x^2 - 2y^2 + 1 = 0; domain [-3, 3]^2",
        HAND,
        [2, 1, 0, 0],
        &[],
    ),
    case(
        "a squared factor",
        "curve a: (x^2 + y^2 - 1)^2 (3x - 1) = 0; domain [-3, 3]^2",
        HAND,
        [4, 1, 0, 2],
        &[(4, 2)],
    ),
    case(
        "circles and a line as a product",
        "curve a: (x^2 + y^2 - 1) (x^2 + y^2 - 4) (3y - x) = 0; domain [-3, 3]^2",
        HAND,
        [6, 1, 0, 2],
        &[(4, 4)],
    ),
    case(
        "an expanded product",
        "curve a: x^3 - x^2 y + x y^2 - y^3 - x + y = 0; domain [-3, 3.1] x [-3, 3.2]",
        HAND,
        [4, 1, 0, 2],
        &[(4, 2)],
    ),
    case(
        "four lines and their circle as one curve",
        "curve a: (x^2 - 1) (y^2 - 1) (x^2 + y^2 - 1) = 0; domain [-3, 3]^2",
        HAND,
        [13, 1, 0, 8],
        &[(4, 8)],
    ),
    case("hyperbola as a quotient", "curve a: y = 1 / x; domain [-3, 3.5] x [-3.1, 3]", HAND, [3, 2, 0, 4], &[]),
    case("a pole without a zero", "curve a: 1 / (3x - 1) = 0; domain [-3, 3]^2", HAND, [1, 0, 0, 0], &[]),
];

/// The frame of the domain as a part of the difficulty.
pub const FRAMED: &[Case] = &[
    case("circle that touches the frame", "curve a: x^2 + y^2 = 1; domain [-1, 2] x [-2, 2]", HAND, [2, 1, 0, 1], &[]),
    case("line through the frame's corners", "curve a: y = x; domain [-10, 10]^2", HAND, [2, 1, 0, 2], &[]),
    case(
        "diagonals through the frame's corners",
        "curve a: y = x; curve b: y = -x; domain [-10, 10]^2",
        HAND,
        [4, 1, 0, 4],
        &[(4, 1)],
    ),
    case(
        "crossing on the frame",
        "curve a: y = x - 1; curve b: y = 1 - x; domain [-1, 1] x [-3, 3]",
        HAND,
        [3, 1, 0, 3],
        &[],
    ),
    case(
        "circle around the frame's corner",
        "curve a: (x - 1)^2 + (y - 1)^2 = 1; domain [-2, 1] x [-2, 1]",
        HAND,
        [2, 1, 0, 2],
        &[],
    ),
    case("circle around the domain", "curve a: x^2 + y^2 = 25; domain [-3, 3]^2", HAND, [1, 0, 0, 0], &[]),
];
