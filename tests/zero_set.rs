//! Zero sets in pieces: which pieces a formula has, and that their union is the zero set, on points of grids and on random
//! formulas.

use fastrand::Rng;

use imp::derive::derivative_within;
use imp::diagnostic::SourceMap;
use imp::diagnostic::render;
use imp::graph::Graph;
use imp::graph::Op;
use imp::graph::Value;
use imp::graph::enclose;
use imp::interval::Decorated;
use imp::interval::Decoration;
use imp::interval::Interval;
use imp::limits::Budget;
use imp::limits::Limits;
use imp::passes::zero_set::Piece;
use imp::passes::zero_set::zero_set;
use imp::program;
use imp::program::Context;
use imp::program::Embedded;
use imp::program::Scene;
use imp::syntax;

fn scene(text: &str) -> Scene {
    let mut sources = SourceMap::default();
    let file = sources.add("scene", text);
    let budget = Budget::new(&Limits::default());
    let context = Context { importer: &Embedded, differentiate: &derivative_within, overrides: &[], budget: &budget };
    let (scene, diagnostics) = program::resolve(&mut sources, file, syntax::parse(file, text), &context);
    match scene {
        Some(scene) if diagnostics.is_empty() => scene,
        _ => panic!("{}", render(&sources, &diagnostics, false)),
    }
}

/// The bounds of the inputs of a plane scene.
fn inputs(graph: &Graph, domain: [Interval; 2]) -> Vec<Interval> {
    let place = |name: &String| ["x", "y"].iter().position(|n| n == name).expect("a formula in x and y");
    graph.variables().iter().map(|name| domain[place(name)]).collect()
}

/// A curve on [-10, 10]^2 with its field, condition and pieces.
struct Curve {
    graph: Graph,
    field: Value,
    condition: Option<Value>,
    pieces: Vec<Piece>,
}

impl Curve {
    fn new(equation: &str) -> Self {
        let scene = scene(&format!("domain [-10, 10]^2\ncurve c: {equation}"));
        Self::of(scene.graph, scene.shapes[0].field, scene.shapes[0].condition, 10.0)
    }

    /// A field and a condition on [-end, end]^2.
    fn of(mut graph: Graph, field: Value, condition: Option<Value>, end: f64) -> Self {
        let side = Interval::new(-end, end).unwrap();
        let inputs = inputs(&graph, [side, side]);
        let pieces = zero_set(&mut graph, field, condition, &inputs);
        Self { graph, field, condition, pieces }
    }

    /// One line a piece: the field, the condition after `if`, the atoms after `at`.
    fn lines(&self) -> Vec<String> {
        let show = |v: &Value| formula(&self.graph, *v);
        let line = |piece: &Piece| {
            let condition = piece.condition.map_or(String::new(), |condition| format!(" if {}", show(&condition)));
            let atoms: Vec<String> = piece.atoms.iter().map(show).collect();
            let at = if atoms.is_empty() { String::new() } else { format!(" at {}", atoms.join(", ")) };
            show(&piece.field) + &condition + &at
        };
        self.pieces.iter().map(line).collect()
    }
}

/// A value as a formula.
fn formula(graph: &Graph, value: Value) -> String {
    if let Some(number) = graph.as_constant(value) {
        return number.to_string();
    }
    let node = graph.node(value);
    let operands: Vec<String> = node.operands().iter().map(|v| formula(graph, *v)).collect();
    let infix = |sign: &str| format!("({} {sign} {})", operands[0], operands[1]);
    match node.op {
        Op::Var(id) => graph.variables()[id as usize].clone(),
        Op::Add => infix("+"),
        Op::Sub => infix("-"),
        Op::Mul => infix("*"),
        Op::Div => infix("/"),
        Op::Less => infix("<"),
        Op::LessEqual => infix("<="),
        Op::Equal => infix("="),
        Op::Sqr => format!("{}^2", operands[0]),
        Op::PowInt(n) => format!("{}^{n}", operands[0]),
        op if operands.is_empty() => op.name().to_owned(),
        Op::PowRatio(p, q) => format!("{}^({p}/{q})", operands[0]),
        op => format!("{}({})", op.name(), operands.join(", ")),
    }
}

/// Enclosures of values on a box of the plane.
fn enclose_on(graph: &Graph, roots: &[Value], square: [Interval; 2]) -> Vec<Decorated> {
    let inputs: Vec<Decorated> = inputs(graph, square).into_iter().map(Decorated::new).collect();
    enclose(graph, roots, &inputs)
}

/// A field with its condition: 0 and 1 where the point belongs to the set.
#[derive(Clone, Copy)]
struct Part {
    field: Value,
    condition: Option<Value>,
}

impl Curve {
    fn whole(&self) -> Part {
        Part { field: self.field, condition: self.condition }
    }

    fn parts(&self) -> impl Iterator<Item = Part> {
        self.pieces.iter().map(|piece| Part { field: piece.field, condition: piece.condition })
    }

    /// Enclosures of the field and of the condition, which is 1 if there is none.
    fn values(&self, part: Part, square: [Interval; 2]) -> (Decorated, Decorated) {
        let mut roots = vec![part.field];
        roots.extend(part.condition);
        let values = enclose_on(&self.graph, &roots, square);
        (values[0], values.get(1).copied().unwrap_or(Decorated::new(Interval::ONE)))
    }

    /// Whether the part may have a point in the box.
    fn may_meet(&self, part: Part, square: [Interval; 2]) -> bool {
        let (field, condition) = self.values(part, square);
        field.interval().contains(0.0) && condition.interval().contains(1.0)
    }

    /// Whether the part has a point in the box: its only point, or one between two ends of different sign.
    fn does_meet(&self, part: Part, square: [Interval; 2]) -> bool {
        let (field, condition) = self.values(part, square);
        if condition.interval() != Interval::ONE || condition.decoration() < Decoration::Def {
            return false;
        }
        if field.interval() == Interval::ZERO && field.decoration() >= Decoration::Def {
            return true;
        }
        let end = |x: f64, y: f64| self.values(part, [Interval::point(x), Interval::point(y)]).0.interval();
        let [x, y] = square;
        let (a, b) = (end(x.lo(), y.lo()), end(x.hi(), y.hi()));
        field.decoration() >= Decoration::Dac && (a.hi() < 0.0 && b.lo() > 0.0 || a.lo() > 0.0 && b.hi() < 0.0)
    }

    /// Compares the set with the union of its pieces on a box.
    fn check(&self, square: [Interval; 2]) -> [bool; 2] {
        let context = || {
            let formulas = [Some(self.field), self.condition].map(|v| v.map(|v| formula(&self.graph, v)));
            format!("at {} x {} of {formulas:?}:\n{}", square[0], square[1], self.lines().join("\n"))
        };
        let lost = self.does_meet(self.whole(), square);
        if lost {
            assert!(self.parts().any(|part| self.may_meet(part, square)), "a zero is lost {}", context());
        }
        let mut added = false;
        for (index, part) in self.parts().enumerate() {
            if self.does_meet(part, square) {
                added = true;
                assert!(self.may_meet(self.whole(), square), "piece {index} adds a zero {}", context());
            }
        }
        [lost, added]
    }

    /// The box that bisection leaves of a segment on which the sign of a part's field changes, wherever it does.
    fn change(&self, part: Part, mut from: [f64; 2], mut to: [f64; 2]) -> Option<[Interval; 2]> {
        let sign = |[x, y]: [f64; 2]| {
            let value = self.values(part, [Interval::point(x), Interval::point(y)]).0.interval();
            if value.lo() > 0.0 { Some(true) } else { (value.hi() < 0.0).then_some(false) }
        };
        let (a, b) = (sign(from)?, sign(to)?);
        if a == b {
            return None;
        }
        for _ in 0..30 {
            let middle = [0, 1].map(|i| from[i] + (to[i] - from[i]) / 2.0);
            match sign(middle) {
                Some(sign) if sign == a => from = middle,
                Some(_) => to = middle,
                None => return Some([0, 1].map(|i| Interval::point(middle[i]))),
            }
        }
        // A diagonal of the box runs along the segment only if it rises; the ends are compared there.
        let rising = (to[0] >= from[0]) == (to[1] >= from[1]);
        rising.then(|| [0, 1].map(|i| Interval::new(from[i].min(to[i]), from[i].max(to[i])).unwrap()))
    }

    /// Compares at points of a grid and at changes of sign along random segments; how often there was a zero.
    fn sample(&self, rng: &mut Rng, half: i32, segments: usize) -> [usize; 2] {
        let mut counts = [0; 2];
        let mut count = |found: [bool; 2]| {
            for (count, found) in counts.iter_mut().zip(found) {
                *count += usize::from(found);
            }
        };
        for i in -2 * half..=2 * half {
            for j in -2 * half..=2 * half {
                count(self.check([i, j].map(|k| Interval::point(f64::from(k) / 2.0))));
            }
        }
        let parts: Vec<Part> = [self.whole()].into_iter().chain(self.parts()).collect();
        for _ in 0..segments {
            let [a, b] = [0, 1].map(|_| {
                let width = f64::from(2 * half);
                let x = (rng.f64() - 0.5) * width;
                let y = if rng.u8(0..4) == 0 { 0.0 } else { (rng.f64() - 0.5) * width };
                if rng.bool() { [x, y] } else { [y, x] }
            });
            for &part in &parts {
                if let Some(square) = self.change(part, a, b) {
                    count(self.check(square));
                }
            }
        }
        counts
    }
}

/// Equations with the fields, conditions and atoms of their pieces.
const PIECES: &[(&str, &[&str])] = &[
    // Products, powers, quotients.
    ("x * y = 0", &["x", "y"]),
    ("(x - y)^2 = 0", &["(x - y)"]),
    ("(x^2 + y^2 - 1)^3 = 0", &["(-1 + (x^2 + y^2))"]),
    ("x y (x - y)^2 (x^2 + y^2 - 1) = 0", &["x", "y", "(x - y)", "(-1 + (x^2 + y^2))"]),
    ("sqrt(x) * y = 0", &["y if (0 <= x) at x", "x"]),
    ("ln(x) * ln(y) = 0", &["(-1 + x) if (0 < y) at y", "(-1 + y) if (0 < x) at x"]),
    ("(x - 1) / (y - 1) = 0", &["(-1 + x) if (1 - (0 = (-1 + y))) at (-1 + y)"]),
    ("x / 3 - y / 7 = 1/2", &["(-21 + ((14 * x) - (6 * y)))"]),
    ("2 x - 2 y = 0", &["(x - y)"]),
    ("x * sin(y) + x * y = 0", &["x", "(y + sin(y))"]),
    ("exp(x y) = 0", &[]),
    ("x^2 + 1 = 0", &[]),
    // Numerators: a condition on the denominator where both may vanish.
    ("x - 1 / y = 0", &["(-1 + (x * y))"]),
    ("x - 1 / y - 1 / y^2 = 0", &["(-1 + (y * (-1 + (x * y))))"]),
    ("(x^2 - 1) / (x - 1) = 0", &["(1 + x)"]),
    ("tan(x) = y", &["(sin(x) - (y * cos(x))) if (1 - (0 = cos(x))) at cos(x)"]),
    // Squares and absolute values against each other and against numbers.
    ("x^2 = 4 y^2", &["(x - (2 * y))", "(x + (2 * y))"]),
    ("x^4 = y^4", &["(x - y)", "(x + y)", "(x^2 + y^2)"]),
    ("x^2 = 9/4", &["(-3 + (2 * x))", "(3 + (2 * x))"]),
    ("||x| - |y|| = 1", &["(-1 + (abs(x) - abs(y)))", "(1 + (abs(x) - abs(y)))"]),
    ("hypot(x, y) = 2", &["(-4 + (x^2 + y^2))"]),
    // Functions that take no value twice.
    ("exp(x) = exp(y)", &["(x - y)"]),
    ("exp(x) = 2 exp(y)", &["((x - y) - ln(2))"]),
    ("ln(x) = ln(y)", &["(x - y) if (0 < y) at y"]),
    ("atan(x) = -atan(y)", &["(x + y)"]),
    ("tan(x) = tan(y)", &["sin((x - y)) if min((1 - (0 = cos(x))), (1 - (0 = cos(y)))) at cos(x), cos(y)"]),
    // Sums of sines as products.
    ("sin(x) = sin(y)", &["cos((1/2 * (x + y)))", "sin((1/2 * (x - y)))"]),
    ("cos(x) = -cos(y)", &["cos((1/2 * (x + y)))", "cos((1/2 * (x - y)))"]),
    (
        "sin(x^2 + y^2) = cos(x y)",
        &[
            "sin(((-1/4 * pi) + (1/2 * ((x^2 + y^2) + (x * y)))))",
            "cos(((1/4 * pi) + (1/2 * ((x^2 + y^2) - (x * y)))))",
        ],
    ),
    ("sin(x y) = 1", &["sin(((-1/4 * pi) + (1/2 * (x * y))))"]),
    ("cos(x y) = -1", &["cos((1/2 * (x * y)))"]),
    // Square roots.
    ("sqrt(9 - x^2) = y", &["(-9 + (x^2 + y^2)) if (0 <= y) at y"]),
    ("sqrt(x) = y^2", &["(x - y^4)"]),
    ("sqrt(x^2) = y", &["(y - abs(x))"]),
    // Jumps.
    ("sign(x) = y", &["(1 + y) if (0 < neg(x)) at x", "y if (0 = x) at x", "(-1 + y) if (0 < x) at x"]),
    ("step(0, x) = y", &["y if (0 < neg(x)) at x", "(-1 + y) if (0 <= x) at x"]),
    ("(if x < 0 then -x else x^2) = y", &["(x + y) if (0 < neg(x)) at x", "(y - x^2) if (0 <= x) at x"]),
    ("mod(x - y, 20) = 0", &["(20 + (x - y))", "(x - y)", "(-20 + (x - y))"]),
    ("x = y where floor(x) = 2", &["(x - y) if (2 = floor(x)) at sin((x * pi))"]),
    // Extrema: corners become crossings.
    (
        "min(x^2 + y^2 - 4, x - y) = 0",
        &[
            "(-4 + (x^2 + y^2)) if (0 <= (x - y)) at (x - y)",
            "(x - y) if (0 <= (-4 + (x^2 + y^2))) at (-4 + (x^2 + y^2))",
        ],
    ),
    // Conditions.
    (
        "x = sin(y) where x > 0 and y < 1/2",
        &["(x - sin(y)) if min((0 < x), (0 < (1 + (-2 * y)))) at x, (-1 + (2 * y))"],
    ),
    ("x = sin(y) where not (x > 0 or y < x)", &["(x - sin(y)) if min((0 <= neg(x)), (0 <= (y - x))) at x, (x - y)"]),
    ("x = y where x < 20", &["(x - y)"]),
    ("x = y where x > 20", &[]),
    ("x = y where x > y", &[]),
];

#[test]
fn formulas_have_these_pieces() {
    let mut faults = String::new();
    for (equation, expected) in PIECES {
        let lines = Curve::new(equation).lines();
        if lines != *expected {
            faults += &format!("{equation}\n    {}\n", lines.join("\n    "));
        }
    }
    assert!(faults.is_empty(), "other pieces:\n{faults}");
}

/// More equations for comparison at points.
const EQUATIONS: &[&str] = &[
    "x/cos(x) + y/cos(y) = x y/cos(x y)",
    "sin(sin(x) + cos(y)) = cos(sin(x y) + cos(x))",
    "exp(sin(x) + cos(y)) = sin(exp(x + y))",
    "y - x = sin(exp(x + y))",
    "y = x sqrt(9 - x^2)",
    "sqrt(x) + sqrt(y) = 2",
    "y = floor(x)",
    "y = round(x / 2)",
    "y = ceil(-x)",
    "floor(x) = floor(y)",
    "mod(x, 3) = y",
    "mod(x, -3) = y",
    "mod(3, x) = y",
    "mod(x + y, 1) = 0",
    "max(min(x, y), x - 1, y - 2) = 0",
    "max(|x|, |y|) = 2",
    "hypot(x, y) = |x - 1|",
    "sin(1/x) = y",
    "x^y = y^x",
    "x^(2/3) + y^(2/3) = 1",
    "x^(-3/2) = y",
    "atan2(y, x) = 0",
    "atan2(y, x) = 1",
    "asin(x) = acos(y)",
    "asin(x) y = 0",
    "x - x = 0",
    "y = (if x < 0 then sqrt(-x) else ln(x))",
    "y = (if x < 0 then (if y < 0 then x else 1 / x) else sqrt(y))",
    "y = (if x < 0 then x else sign(sqrt(x)))",
    "x / y = y / x",
    "1 / (x - 1) + 1 / (y - 1) = 1",
    "x = y where 1 / x < 2",
    "x = -y where ln(x) < y",
    "x y = 1 where sqrt(x) < 2 or y > -1",
    "sin(x)^2 = cos(y)^2",
    "|sin(x)| = |sin(y)|",
    "sin(pi x) sin(pi y) = 0",
    "x = y where mod(x, 2) < 1",
];

#[test]
fn pieces_have_the_zeros_of_the_formula_and_no_others() {
    let mut rng = Rng::with_seed(1);
    let table = PIECES.iter().map(|(equation, _)| equation);
    for equation in table.chain(EQUATIONS) {
        let curve = Curve::new(equation);
        curve.sample(&mut rng, 8, 60);
    }
}

/// A random formula in x and y, with much of what the rules look at.
fn random(rng: &mut Rng, graph: &mut Graph, depth: u32) -> Value {
    if depth == 0 || rng.u8(0..8) == 0 {
        return match rng.u8(0..7) {
            0..3 => graph.var("x"),
            3..6 => graph.var("y"),
            _ => graph.int(rng.i64(-2..3)),
        };
    }
    const UNARY: &[Op] = &[
        Op::Neg,
        Op::Sqr,
        Op::Sqrt,
        Op::Cbrt,
        Op::Abs,
        Op::Sign,
        Op::Floor,
        Op::Ceil,
        Op::Round,
        Op::Exp,
        Op::Ln,
        Op::Log1p,
        Op::Sin,
        Op::Cos,
        Op::Tan,
        Op::Asin,
        Op::Acos,
        Op::Atan,
        Op::Tanh,
        Op::Acosh,
        Op::PowInt(3),
        Op::PowInt(4),
        Op::PowInt(-1),
        Op::PowInt(-2),
        Op::PowRatio(2, 3),
        Op::PowRatio(-1, 3),
        Op::PowRatio(3, 2),
    ];
    const BINARY: &[Op] = &[
        Op::Add,
        Op::Sub,
        Op::Mul,
        Op::Div,
        Op::Min,
        Op::Max,
        Op::Mod,
        Op::Hypot,
        Op::Atan2,
        Op::Pow,
        Op::Add,
        Op::Sub,
        Op::Mul,
    ];
    match rng.u8(0..12) {
        0..4 => {
            let a = random(rng, graph, depth - 1);
            graph.unary(UNARY[rng.usize(0..UNARY.len())], a)
        }
        // The same function twice, which is what sums look for.
        4..6 => {
            let op = UNARY[rng.usize(0..UNARY.len())];
            let [a, b] = [0, 1].map(|_| random(rng, graph, depth - 1));
            let [a, b] = [graph.unary(op, a), graph.unary(op, b)];
            if rng.bool() { graph.add(a, b) } else { graph.sub(a, b) }
        }
        6 => {
            let truth = random_truth(rng, graph, depth - 1);
            let [a, b] = [0, 1].map(|_| random(rng, graph, depth - 1));
            graph.push(Op::Select, &[truth, a, b])
        }
        _ => {
            let [a, b] = [0, 1].map(|_| random(rng, graph, depth - 1));
            graph.push(BINARY[rng.usize(0..BINARY.len())], &[a, b])
        }
    }
}

/// A random condition.
fn random_truth(rng: &mut Rng, graph: &mut Graph, depth: u32) -> Value {
    match rng.u8(0..6) {
        0 if depth > 0 => {
            let [a, b] = [0, 1].map(|_| random_truth(rng, graph, depth - 1));
            graph.push(if rng.bool() { Op::Min } else { Op::Max }, &[a, b])
        }
        1 if depth > 0 => {
            let (one, truth) = (graph.int(1), random_truth(rng, graph, depth - 1));
            graph.sub(one, truth)
        }
        _ => {
            let [a, b] = [0, 1].map(|_| random(rng, graph, depth));
            graph.push([Op::Less, Op::LessEqual, Op::Equal][rng.usize(0..3)], &[a, b])
        }
    }
}

/// `IMP_TEST_CASES` sets the number of formulas (400 unless told).
#[test]
fn random_formulas_keep_their_zeros() {
    let cases = std::env::var("IMP_TEST_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(400);
    let mut rng = Rng::with_seed(2);
    let (mut split, mut met) = (0, [0; 2]);
    for _ in 0..cases {
        let mut graph = Graph::new();
        let [_, _] = ["x", "y"].map(|name| graph.var(name));
        let depth = rng.u32(1..5);
        let field = random(&mut rng, &mut graph, depth);
        let condition = (rng.u8(0..3) == 0).then(|| random_truth(&mut rng, &mut graph, 1));
        let curve = Curve::of(graph, field, condition, 4.0);
        split += usize::from(curve.pieces.len() != 1 || curve.pieces[0].field != field);
        let found = curve.sample(&mut rng, 3, 20);
        met = [met[0] + found[0], met[1] + found[1]];
    }
    // Nothing was compared if nothing was found.
    assert!(split > cases / 4 && met.iter().all(|&met| met > cases), "{split} split, {met:?} zeros");
}
