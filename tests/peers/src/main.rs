//! Imp's kernels beside fidget's compiled evaluators, on one core, in one run: times in ns an item and their ratio.
//!
//! Both sides evaluate the same boxes and points, all distinct. fidget's raw evaluators are called, without the matrix that
//! its renderer adds. Imp's intervals are rounded outward, fidget's are not. The two are timed in turn, round by round, and
//! the medians over the rounds are printed: on a noisy machine the ratio says more than either time.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use fidget::context::Context;
use fidget::context::Tree;
use fidget::eval::BulkEvaluator;
use fidget::eval::Function;
use fidget::eval::MathFunction;
use fidget::eval::TracingEvaluator;
use fidget::jit::JitFunction;
use fidget::types::Grad;
use fidget::types::Interval as PeerInterval;
use imp::codegen::Compiler;
use imp::derive::Arithmetic;
use imp::derive::Output;
use imp::derive::Rounding;
use imp::derive::Spec;
use imp::derive::gradient;
use imp::diagnostic::SourceMap;
use imp::graph::Graph;
use imp::graph::Value;
use imp::interval::Interval;
use imp::kernel::Backend;
use imp::kernel::Packet;
use imp::passes;
use imp::program;
use imp::syntax;

const GROUPS: usize = 64;
const LANES: usize = 16;
const ITEMS: usize = GROUPS * LANES;
const ROUNDS: usize = 301;
/// Boxes lie in [-2, 2]^3 and have this width.
const WIDTH: f32 = 0.01;

struct Formula {
    name: &'static str,
    source: &'static str,
    peer: fn(Tree, Tree, Tree) -> Tree,
}

const FORMULAS: &[Formula] = &[
    Formula {
        name: "sphere",
        source: "x^2 + y^2 + z^2 - 1",
        peer: |x, y, z| x.square() + y.square() + z.square() - 1.0,
    },
    Formula {
        name: "Barth sextic",
        source: BARTH,
        peer: barth_peer,
    },
    Formula {
        name: "tangle",
        source: "x^4 - 5x^2 + y^4 - 5y^2 + z^4 - 5z^2 + 11.8",
        peer: |x, y, z| {
            let part = |v: Tree| v.square().square() - v.square() * 5.0;
            part(x) + part(y) + part(z) + 11.8
        },
    },
    Formula {
        name: "Klein bottle",
        source: "(x^2+y^2+z^2+2y-1)((x^2+y^2+z^2-2y-1)^2-8z^2)+16x z (x^2+y^2+z^2-2y-1)",
        peer: |x, y, z| {
            let q = x.square() + y.square() + z.square();
            let minus = q.clone() - y.clone() * 2.0 - 1.0;
            (q + y * 2.0 - 1.0) * (minus.square() - z.square() * 8.0) + x * z * minus * 16.0
        },
    },
    Formula {
        name: "gyroid",
        source: "sin(4x) cos(4y) + sin(4y) cos(4z) + sin(4z) cos(4x)",
        peer: |x, y, z| {
            let (x, y, z) = (x * 4.0, y * 4.0, z * 4.0);
            x.sin() * y.cos() + y.sin() * z.cos() + z.sin() * x.cos()
        },
    },
];

const BARTH: &str = "4(((1+sqrt(5))/2)^2 x^2 - y^2)(((1+sqrt(5))/2)^2 y^2 - z^2)(((1+sqrt(5))/2)^2 z^2 - x^2) \
    - (2 + sqrt(5))(x^2 + y^2 + z^2 - 1)^2";

fn barth_peer(x: Tree, y: Tree, z: Tree) -> Tree {
    let phi = (1.0 + 5f32.sqrt()) / 2.0;
    let (x, y, z) = (x.square(), y.square(), z.square());
    let factor = |a: &Tree, b: &Tree| a.clone() * (phi * phi) - b.clone();
    let product = factor(&x, &y) * factor(&y, &z) * factor(&z, &x) * 4.0;
    product - (x + y + z - 1.0).square() * (1.0 + 2.0 * phi)
}

fn main() {
    println!("fidget 0.5.1 (JIT, intervals not rounded outward) and Imp, one core, {ITEMS} distinct items, median of {ROUNDS} rounds");
    println!("ns an item; ratio = fidget / Imp, or outward / nearest in the last column");
    println!("{:13} {:>24} {:>24} {:>24} {:>26} {:>16}", "", "interval f32", "point f32", "value+gradient f32", "compile us (3 kernels)", "outward/nearest");
    for formula in FORMULAS {
        compare(formula);
    }
}

/// Parses and simplifies a formula of Imp.
fn graph(formula: &Formula) -> (Graph, Value) {
    let mut sources = SourceMap::default();
    let file = sources.add(formula.name, formula.source);
    let expression = syntax::parse_expression(file, formula.source).expect("the formula parses");
    let budget = imp::limits::Budget::new(&imp::limits::Limits::default());
    let context = program::Context { importer: &program::Embedded, differentiate: &imp::derive::derivative_within, overrides: &[], budget: &budget };
    let resolved = program::resolve_expression(&mut sources, &expression, &["x", "y", "z"], Default::default(), &context)
        .unwrap_or_else(|_| panic!("{} does not resolve", formula.name));
    let mut graph = resolved.graph;
    graph.add_output("f", resolved.value);
    let bounds = vec![domain(); graph.variables().len()];
    let (graph, _) = passes::run(&graph, &bounds);
    let root = graph.output("f").expect("passes keep outputs");
    (graph, root)
}

fn domain() -> Interval {
    Interval::new(-2.0, 2.0).expect("a range")
}

fn spec(graph: Graph, outputs: Vec<Output>, arithmetic: Arithmetic, rounding: Rounding) -> Spec {
    let mut graph = graph;
    let inputs = ["x", "y", "z"].map(str::to_owned).to_vec();
    let known = inputs.iter().map(|name| (graph.var(name), domain())).collect();
    Spec {
        graph: Arc::new(graph),
        inputs,
        uniforms: Vec::new(),
        outputs,
        domain: if arithmetic == Arithmetic::Point { Vec::new() } else { known },
        promises: Vec::new(),
        arithmetic,
        symbols: Vec::new(),
        rounding,
    }
}

fn compare(formula: &Formula) {
    let (graph, root) = graph(formula);
    let mut with_gradient = graph.clone();
    let axes = ["x", "y", "z"].map(|name| with_gradient.var(name));
    let slopes = gradient(&mut with_gradient, root, &axes);
    let outward = spec(graph.clone(), vec![Output::Enclosure(root)], Arithmetic::Interval, Rounding::Outward);
    let nearest = spec(graph.clone(), vec![Output::Enclosure(root)], Arithmetic::Interval, Rounding::Nearest);
    let point = spec(graph, vec![Output::Value(root)], Arithmetic::Point, Rounding::Nearest);
    let all = [root].into_iter().chain(slopes).map(Output::Value).collect();
    let slope = spec(with_gradient, all, Arithmetic::Point, Rounding::Nearest);

    let (x, y, z) = Tree::axes();
    let mut context = Context::new();
    let tree = context.import(&(formula.peer)(x, y, z));
    let peer = JitFunction::new(&context, &[tree]).expect("the peer compiles");

    let mut rng = fastrand::Rng::with_seed(1);
    let lows: Vec<[f32; 3]> = (0..ITEMS).map(|_| [0; 3].map(|_| rng.f32() * 3.9 - 1.95)).collect();
    let order = |axis: usize| {
        use fidget::var::Var;
        peer.vars()[&[Var::X, Var::Y, Var::Z][axis]]
    };
    let places = [order(0), order(1), order(2)];

    // Intervals.
    let kernels = [&outward, &nearest].map(|spec| Compiler.compile_f32(spec).expect("Imp compiles"));
    let mut boxes = vec![Packet::<f32>::default(); 6 * GROUPS];
    let mut peer_boxes = Vec::new();
    for (i, low) in lows.iter().enumerate() {
        let mut item = [PeerInterval::new(0.0, 0.0); 3];
        for axis in 0..3 {
            boxes[i / LANES * 6 + 2 * axis].lanes_mut()[i % LANES] = -low[axis];
            boxes[i / LANES * 6 + 2 * axis + 1].lanes_mut()[i % LANES] = low[axis] + WIDTH;
            item[places[axis]] = PeerInterval::new(low[axis], low[axis] + WIDTH);
        }
        peer_boxes.push(item);
    }
    let tape = peer.interval_tape(Default::default());
    let mut evaluator = JitFunction::new_interval_eval();
    let mut out = vec![Packet::<f32>::default(); 3 * GROUPS];
    let intervals = in_turn([
        &mut || {
            for item in &peer_boxes {
                black_box(evaluator.eval(&tape, item).expect("the peer runs").0[0]);
            }
        },
        &mut || kernels[0].run(&[], &boxes, &mut out),
    ]);
    let mut other = vec![Packet::<f32>::default(); 3 * GROUPS];
    let rounding = in_turn([
        &mut || kernels[0].run(&[], &boxes, &mut out),
        &mut || kernels[1].run(&[], &boxes, &mut other),
    ]);

    // Points.
    let kernel = Compiler.compile_f32(&point).expect("Imp compiles");
    let mut points = vec![Packet::<f32>::default(); 3 * GROUPS];
    let mut peer_points = vec![vec![0f32; ITEMS]; 3];
    for (i, low) in lows.iter().enumerate() {
        for axis in 0..3 {
            points[i / LANES * 3 + axis].lanes_mut()[i % LANES] = low[axis];
            peer_points[places[axis]][i] = low[axis];
        }
    }
    let tape = peer.float_slice_tape(Default::default());
    let mut evaluator = JitFunction::new_float_slice_eval();
    let mut out = vec![Packet::<f32>::default(); GROUPS];
    let values = in_turn([
        &mut || { black_box(evaluator.eval(&tape, &peer_points).expect("the peer runs")[0][0]); },
        &mut || kernel.run(&[], &points, &mut out),
    ]);

    // Values with gradients.
    let kernel = Compiler.compile_f32(&slope).expect("Imp compiles");
    let mut peer_grads = vec![vec![Grad::from(0.0); ITEMS]; 3];
    for (i, low) in lows.iter().enumerate() {
        for axis in 0..3 {
            let unit = [0, 1, 2].map(|k| if k == axis { 1.0 } else { 0.0 });
            peer_grads[places[axis]][i] = Grad::new(low[axis], unit[0], unit[1], unit[2]);
        }
    }
    let tape = peer.grad_slice_tape(Default::default());
    let mut evaluator = JitFunction::new_grad_slice_eval();
    let mut out = vec![Packet::<f32>::default(); 4 * GROUPS];
    let gradients = in_turn([
        &mut || { black_box(evaluator.eval(&tape, &peer_grads).expect("the peer runs")[0][0]); },
        &mut || kernel.run(&[], &points, &mut out),
    ]);

    // From expression to three evaluators.
    let (x, y, z) = Tree::axes();
    let compile = in_turn([
        &mut || {
            let mut context = Context::new();
            let tree = context.import(&(formula.peer)(x.clone(), y.clone(), z.clone()));
            let function = JitFunction::new(&context, &[tree]).expect("the peer compiles");
            black_box(function.interval_tape(Default::default()));
            black_box(function.float_slice_tape(Default::default()));
            black_box(function.grad_slice_tape(Default::default()));
        },
        &mut || {
            for spec in [&outward, &point, &slope] {
                black_box(Compiler.compile_f32(spec).expect("Imp compiles"));
            }
        },
    ]);

    let pair = |[peer, imp]: [f64; 2], unit: f64| format!("{:8.2} {:7.2} {:6.2}x", peer / unit, imp / unit, peer / imp);
    println!(
        "{:13} {:>24} {:>24} {:>24} {:>26} {:>15.3}x",
        formula.name,
        pair(intervals, ITEMS as f64),
        pair(values, ITEMS as f64),
        pair(gradients, ITEMS as f64),
        pair(compile, 1e3),
        rounding[0] / rounding[1]
    );
}

/// Median times in ns of two pieces of work, done in turn.
fn in_turn(mut work: [&mut dyn FnMut(); 2]) -> [f64; 2] {
    let mut times = [Vec::new(), Vec::new()];
    for _ in 0..ROUNDS {
        for (work, times) in work.iter_mut().zip(&mut times) {
            let start = Instant::now();
            work();
            times.push(start.elapsed().as_secs_f64() * 1e9);
        }
    }
    times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    })
}
