//! Compiled kernels against the reference interpreter: on every box the two enclosures of the same formula must agree
//! up to rounding, and every point's value must lie in both.

use std::sync::Arc;

use imp::codegen::Compiler;
use imp::codegen::CompilerFor;
use imp::codegen::Registers;
use imp::codegen::Width;
use imp::derive::Arithmetic;
use imp::derive::Output;
use imp::derive::Rounding;
use imp::derive::Spec;
use imp::derive::choose;
use imp::graph::Graph;
use imp::graph::Op;
use imp::graph::Value;
use imp::interpret::Interpreter;
use imp::interval::Interval;
use imp::kernel::Backend;
use imp::kernel::Kernel;
use imp::kernel::Packet;
use imp::kernel::Real;

/// A spec of one output over the inputs x, y, z of a graph.
fn spec(graph: Graph, root: Value, domain: Option<f64>, arithmetic: Arithmetic) -> Spec {
    let inputs: Vec<String> = graph.variables().to_vec();
    let mut graph = graph;
    let values: Vec<Value> = inputs.iter().map(|name| graph.var(name)).collect();
    let range = domain.map(|r| Interval::new(-r, r).expect("a range"));
    Spec {
        outputs: vec![Output::Enclosure(root)],
        domain: range.iter().flat_map(|r| values.iter().map(|&v| (v, *r)).collect::<Vec<_>>()).collect(),
        promises: Vec::new(),
        symbols: inputs.iter().take(3).cloned().collect(),
        uniforms: Vec::new(),
        inputs,
        arithmetic,
        rounding: Rounding::Outward,
        graph: Arc::new(graph),
    }
}

fn barth() -> (Graph, Value) {
    let mut g = Graph::new();
    let [x, y, z] = ["x", "y", "z"].map(|name| g.var(name));
    let [x2, y2, z2] = [x, y, z].map(|v| g.sqr(v));
    let (one, five, two, four) = (g.int(1), g.int(5), g.int(2), g.int(4));
    let root = g.unary(Op::Sqrt, five);
    let sum = g.add(one, root);
    let phi = g.div(sum, two);
    let phi2 = g.sqr(phi);
    let factor = |g: &mut Graph, a: Value, b: Value| {
        let scaled = g.mul(phi2, a);
        g.sub(scaled, b)
    };
    let [p, q, r] = [(x2, y2), (y2, z2), (z2, x2)].map(|(a, b)| factor(&mut g, a, b));
    let pq = g.mul(p, q);
    let pqr = g.mul(pq, r);
    let left = g.mul(four, pqr);
    let two_phi = g.mul(two, phi);
    let weight = g.add(one, two_phi);
    let xy = g.add(x2, y2);
    let xyz = g.add(xy, z2);
    let shell = g.sub(xyz, one);
    let shell2 = g.sqr(shell);
    let right = g.mul(weight, shell2);
    let f = g.sub(left, right);
    (g, f)
}

fn fill<T: Real>(rng: &mut fastrand::Rng, slots: usize, width: f64) -> Vec<Packet<T>> {
    let mut inputs = vec![Packet::<T>::default(); 2 * slots];
    for slot in 0..slots {
        for lane in 0..T::LANES {
            let lo = T::nearest(rng.f64() * 4.0 - 2.0).to_f64();
            let hi = T::up(lo + width * rng.f64());
            inputs[2 * slot].lanes_mut()[lane] = T::nearest(-lo);
            inputs[2 * slot + 1].lanes_mut()[lane] = hi;
        }
    }
    inputs
}

fn agree<T: Real>(kernel: &dyn Kernel<T>, reference: &dyn Kernel<T>, slots: usize, slack: f64, seed: u64) {
    let mut rng = fastrand::Rng::with_seed(seed);
    for round in 0..200 {
        let width = [0.0, 1e-6, 1e-2, 1.0][round % 4];
        let inputs = fill::<T>(&mut rng, slots, width);
        let mut got = vec![Packet::<T>::default(); 3];
        let mut expected = vec![Packet::<T>::default(); 3];
        kernel.run(&[], &inputs, &mut got);
        reference.run(&[], &inputs, &mut expected);
        for lane in 0..T::LANES {
            let [nlo, hi] = [0, 1].map(|i| got[i].lanes()[lane].to_f64());
            let [ref_nlo, ref_hi] = [0, 1].map(|i| expected[i].lanes()[lane].to_f64());
            assert!(
                nlo >= -ref_hi && hi >= -ref_nlo,
                "seed {seed} round {round}: [{}, {hi}] misses [{}, {ref_hi}]",
                -nlo,
                -ref_nlo
            );
            let scale = ref_nlo.abs().max(ref_hi.abs()).max(1.0);
            assert!(
                (nlo - ref_nlo).abs() <= slack * scale && (hi - ref_hi).abs() <= slack * scale,
                "seed {seed} round {round}: [{}, {hi}] is far from [{}, {ref_hi}]",
                -nlo,
                -ref_nlo
            );
            let (word, ref_word) = (got[2].lanes()[lane].verdict(), expected[2].lanes()[lane].verdict());
            assert_eq!(word & !ref_word, 0, "seed {seed} round {round}: the kernel claims more than the reference");
        }
    }
}

#[test]
fn barth_sextic_agrees_with_the_interpreter() {
    for domain in [None, Some(4.0)] {
        let (graph, f) = barth();
        let spec = spec(graph, f, domain, Arithmetic::Interval);
        agree::<f32>(&*Compiler.compile_f32(&spec).unwrap(), &*Interpreter.compile_f32(&spec).unwrap(), 3, 1e-3, 1);
        agree::<f64>(&*Compiler.compile_f64(&spec).unwrap(), &*Interpreter.compile_f64(&spec).unwrap(), 3, 1e-11, 2);
    }
}

/// A sum of one expression for each of x, y, z, and a constant.
fn separable(constant: i64, mut term: impl FnMut(&mut Graph, Value) -> Value) -> (Graph, Value) {
    let mut g = Graph::new();
    let mut sum = g.int(constant);
    for name in ["x", "y", "z"] {
        let input = g.var(name);
        let own = term(&mut g, input);
        sum = g.add(sum, own);
    }
    (g, sum)
}

/// Hijazi's table 7.1: affine forms are worth their price for the tangle, not for a superquadric of degree 200, whose terms
/// have nothing to share.
#[test]
fn auto_chooses_by_counting() {
    let tangle = separable(12, |g, x| {
        let (square, five) = (g.sqr(x), g.int(5));
        let (fourth, multiple) = (g.sqr(square), g.mul(five, square));
        g.sub(fourth, multiple)
    });
    let superquadric = separable(-1, |g, x| g.unary(Op::PowInt(200), x));
    for ((graph, root), radius, arithmetic) in
        [(tangle, 2.5, Arithmetic::Affine), (superquadric, 1.25, Arithmetic::Interval)]
    {
        let range = Interval::new(-radius, radius).expect("a range");
        let choice =
            choose(&graph, root, &["x", "y", "z"].map(|name| (name, range)), &[]).expect("small enough to try");
        assert_eq!(choice.arithmetic, arithmetic, "{choice}");
        let again = choose(&graph, root, &["x", "y", "z"].map(|name| (name, range)), &[]);
        assert_eq!(again, Some(choice), "the same input, the same choice");
        assert!(choice.affine.operations > choice.interval.operations && choice.affine.left <= choice.interval.left);
    }
}

/// The widening pass changes registers, not results: every lane of every output, bit for bit, for every operation.
#[test]
fn widened_kernels_equal_narrow_ones() {
    let (barth_graph, barth_root) = barth();
    let mut formulas = vec![(barth_graph, barth_root)];
    for &op in Op::PLAIN.iter().filter(|op| op.arity() > 0) {
        let mut graph = Graph::new();
        let [x, y, z] = ["x", "y", "z"].map(|name| graph.var(name));
        let operands = [x, y, z];
        let root = graph.push(op, &operands[..op.arity()]);
        formulas.push((graph, root));
    }
    for (graph, root) in formulas {
        for (domain, arithmetic) in [(None, Arithmetic::Interval), (Some(3.0), Arithmetic::Affine)] {
            let spec = spec(graph.clone(), root, domain, arithmetic);
            let narrow = CompilerFor(Width::Narrow);
            for width in [Width::Best, Width::Wide(Registers::Ymm), Width::Wide(Registers::Zmm)] {
                let wide = CompilerFor(width);
                let single = |x: f32| x.to_bits().into();
                same_bits(&*wide.compile_f32(&spec).unwrap(), &*narrow.compile_f32(&spec).unwrap(), single);
                same_bits(&*wide.compile_f64(&spec).unwrap(), &*narrow.compile_f64(&spec).unwrap(), f64::to_bits);
            }
        }
    }
}

fn same_bits<T: Real>(wide: &dyn Kernel<T>, narrow: &dyn Kernel<T>, bits: fn(T) -> u64) {
    let mut rng = fastrand::Rng::with_seed(3);
    for round in 0..50 {
        let inputs: Vec<Packet<T>> = (0..2).flat_map(|_| fill::<T>(&mut rng, 3, [0.0, 1e-3, 1.0][round % 3])).collect();
        let [mut a, mut b] = [vec![Packet::<T>::default(); 6], vec![Packet::<T>::default(); 6]];
        wide.run(&[], &inputs, &mut a);
        narrow.run(&[], &inputs, &mut b);
        for (a, b) in a.iter().zip(&b) {
            assert!(
                a.lanes().iter().zip(b.lanes()).all(|(&a, &b)| bits(a) == bits(b)),
                "round {round}: {a:?} is not {b:?}"
            );
        }
    }
}
