//! Layout, verdicts, domain and formats of the reference kernel.

use super::*;
use crate::derive::Rounding;
use crate::graph::parse;

const CIRCLE: &str = "v0 = var x\nv1 = var y\nv2 = sqr v0\nv3 = sqr v1\nv4 = add v2, v3\nv5 = const 1\n\
                      v6 = sub v4, v5\nout f = v6";
const LN: &str = "v0 = var x\nv1 = ln v0\nout f = v1";
const STEP: &str = "v0 = var x\nv1 = floor v0\nout f = v1";

/// A spec for the enclosure of the output f, with all inputs as lanes.
fn spec(text: &str) -> Spec {
    let graph = Arc::new(parse(text).unwrap());
    Spec {
        inputs: graph.variables().to_vec(),
        uniforms: Vec::new(),
        outputs: vec![Output::Enclosure(graph.output("f").unwrap())],
        domain: Vec::new(),
        promises: Vec::new(),
        arithmetic: Arithmetic::Interval,
        symbols: Vec::new(),
        rounding: Rounding::Outward,
        graph,
    }
}

fn interval(lo: f64, hi: f64) -> Interval {
    Interval::new(lo, hi).unwrap()
}

/// Runs an f64 kernel on one box in every lane; returns lower end, upper end and verdict.
fn run(spec: &Spec, ends: &[(f64, f64)]) -> (f64, f64, u32) {
    let kernel = Interpreter.compile_f64(spec).unwrap();
    let inputs: Vec<Packet<f64>> = ends.iter().flat_map(|(lo, hi)| [Packet::splat(-lo), Packet::splat(*hi)]).collect();
    let mut outputs = vec![Packet::default(); 3];
    kernel.run(&[], &inputs, &mut outputs);
    for lane in 1..f64::LANES {
        assert!(outputs.iter().all(|slot| slot.lanes()[lane].to_bits() == slot.lanes()[0].to_bits()));
    }
    let [negated_lo, hi, bits] = [0, 1, 2].map(|slot: usize| outputs[slot].lanes()[0]);
    (-negated_lo, hi, bits.verdict())
}

#[test]
fn verdicts_tell_signs() {
    let circle = spec(CIRCLE);
    assert_eq!(run(&circle, &[(0.0, 0.5), (0.0, 0.5)]), (-1.0, -0.5, verdict::NEGATIVE | verdict::CONTINUOUS));
    assert_eq!(run(&circle, &[(2.0, 3.0), (-1.0, 1.0)]), (3.0, 9.0, verdict::POSITIVE | verdict::CONTINUOUS));
    assert_eq!(run(&circle, &[(0.0, 1.0), (0.0, 1.0)]), (-1.0, 1.0, verdict::CONTINUOUS));
    assert_eq!(run(&circle, &[(1.0, 1.0), (0.0, 0.0)]), (0.0, 0.0, verdict::CONTINUOUS));
}

#[test]
fn nan_ends_stand_for_infinite_ones() {
    let circle = spec(CIRCLE);
    let whole = run(&circle, &[(f64::NAN, f64::NAN), (0.0, 0.0)]);
    assert_eq!(whole, (-1.0, f64::INFINITY, verdict::CONTINUOUS));
    assert_eq!(run(&circle, &[(f64::NEG_INFINITY, 5.0), (0.0, 0.0)]), whole);
    // A box that overflowed holds some large number; crossed ends hold none.
    let (lo, hi, bits) = run(&spec("v0 = var x\nout f = v0"), &[(f64::INFINITY, f64::INFINITY)]);
    assert_eq!((lo, hi, bits), (f64::MAX, f64::INFINITY, verdict::POSITIVE | verdict::CONTINUOUS));
    assert_eq!(run(&circle, &[(2.0, 1.0), (0.0, 0.0)]).2, verdict::EMPTY);
}

#[test]
fn undefined_values_are_empty_and_nothing_else() {
    assert_eq!(run(&spec(LN), &[(-3.0, -1.0)]), (f64::INFINITY, f64::NEG_INFINITY, verdict::EMPTY));
    let (lo, hi, bits) = run(&spec(LN), &[(-3.0, 1.0)]);
    assert_eq!((lo, hi, bits), (f64::NEG_INFINITY, 0.0, 0));
}

#[test]
fn jumps_are_not_continuous() {
    assert_eq!(run(&spec(STEP), &[(0.5, 1.5)]), (0.0, 1.0, 0));
    assert_eq!(run(&spec(STEP), &[(1.25, 1.5)]), (1.0, 1.0, verdict::POSITIVE | verdict::CONTINUOUS));
}

#[test]
fn the_domain_cuts_the_box() {
    let mut circle = spec(CIRCLE);
    circle.domain = vec![(Value(0), interval(-1.0, 1.0)), (Value(1), interval(-1.0, 1.0))];
    assert_eq!(run(&circle, &[(0.5, 0.75), (0.0, 1.0)]).2, verdict::CONTINUOUS);
    // Half outside: enclosed on the inner part, continuous nowhere proved.
    assert_eq!(run(&circle, &[(0.5, 3.0), (0.0, 0.0)]), (-0.75, 0.0, 0));
    assert_eq!(run(&circle, &[(0.5, 0.75), (2.0, 3.0)]), (f64::INFINITY, f64::NEG_INFINITY, verdict::EMPTY));
    // A coordinate that is undefined somewhere is not inside.
    let mut root = spec("v0 = var x\nv1 = sqrt v0\nv2 = const 2\nv3 = add v0, v2\nout f = v3");
    root.domain = vec![(Value(1), interval(0.0, 9.0))];
    assert_eq!(run(&root, &[(-1.0, 1.0)]), (1.0, 3.0, verdict::POSITIVE));
    assert_eq!(run(&root, &[(-2.0, -1.0)]).2, verdict::EMPTY);
}

#[test]
fn single_precision_rounds_out() {
    let third = spec("v0 = var x\nv1 = const 1/3\nv2 = mul v0, v1\nout f = v2");
    let kernel = Interpreter.compile_f32(&third).unwrap();
    let inputs = [Packet::splat(-1.0f32), Packet::splat(1.0)];
    let mut outputs = [Packet::default(); 3];
    kernel.run(&[], &inputs, &mut outputs);
    let (lo, hi) = (-outputs[0].lanes()[15], outputs[1].lanes()[15]);
    assert!(f64::from(lo) < 1.0 / 3.0 && 1.0 / 3.0 < f64::from(hi) && lo.next_up() == hi);
    assert_eq!(outputs[2].lanes()[15].verdict(), verdict::POSITIVE | verdict::CONTINUOUS);
}

#[test]
fn groups_uniforms_and_outputs_keep_their_slots() {
    let mut line = spec("v0 = var a\nv1 = var x\nv2 = mul v0, v1\nv3 = neg v2\nout f = v2");
    (line.inputs, line.uniforms) = (vec!["x".into()], vec!["a".into()]);
    line.outputs = vec![Output::Verdict(Value(3)), Output::Enclosure(Value(2))];
    let kernel = Interpreter.compile_f64(&line).unwrap();
    assert_eq!((kernel.input_slots(), kernel.output_slots()), (2, 4));
    let inputs: Vec<Packet<f64>> = [-1.0, 2.0, 3.0, -2.0].map(Packet::splat).to_vec();
    let mut outputs = vec![Packet::default(); 8];
    kernel.run(&[-2.0, 3.0], &inputs, &mut outputs);
    let slots: Vec<f64> = outputs.iter().map(|slot| slot.lanes()[3]).collect();
    assert_eq!([slots[1], slots[2]], [-2.0, 6.0]);
    assert_eq!([slots[5], slots[6]], [9.0, -4.0]);
    assert_eq!(
        [slots[0], slots[4]].map(Real::verdict),
        [verdict::NEGATIVE | verdict::CONTINUOUS, verdict::POSITIVE | verdict::CONTINUOUS]
    );
}

#[test]
#[should_panic(expected = "the numbers of all uniforms")]
fn missing_uniforms_panic() {
    let kernel = Interpreter.compile_f64(&spec(CIRCLE)).unwrap();
    kernel.run(&[1.0], &[], &mut []);
}

#[test]
fn points_are_plain_numbers() {
    let mut circle = spec(CIRCLE);
    circle.arithmetic = Arithmetic::Point;
    assert!(Interpreter.compile_f64(&circle).is_err());
    circle.outputs = vec![Output::Value(Value(6))];
    let kernel = Interpreter.compile_f64(&circle).unwrap();
    let mut outputs = [Packet::default()];
    kernel.run(&[], &[Packet::splat(3.0), Packet::splat(0.5)], &mut outputs);
    assert_eq!(outputs[0].lanes()[0], 8.25);
}

/// Every operation at points lies in its enclosure there, up to the error of the standard library; NaN where empty.
#[test]
fn point_operations_agree_with_enclosures() {
    let numbers = [-2.5, -1.0, -0.5, 0.0, 0.25, 0.5, 1.0, 2.0, 3.0];
    let operations =
        Op::PLAIN.iter().copied().chain([Op::PowInt(-3), Op::PowInt(4), Op::PowRatio(-2, 3), Op::PowRatio(3, 4)]);
    for op in operations.filter(|op| (1..3).contains(&op.arity())) {
        let mut graph = Graph::new();
        let inputs = [graph.var("x"), graph.var("y")];
        let value = graph.push(op, &inputs[..op.arity()]);
        for x in numbers {
            for y in numbers {
                let at = [x, y].map(|x| Decorated::new(Interval::point(x)));
                let enclosure = apply(&graph, graph.node(value), &at[..op.arity()]).interval();
                let found = point::apply(op, &[x, y]);
                if enclosure.is_empty() {
                    assert!(!found.is_finite(), "{op:?}({x}, {y}) = {found} is not defined");
                } else {
                    let slack = 8.0 * f64::EPSILON * enclosure.mag();
                    let near = enclosure.lo() - slack <= found && found <= enclosure.hi() + slack;
                    assert!(near, "{op:?}({x}, {y}) = {found}, not in {enclosure}");
                }
            }
        }
    }
}

#[test]
fn affine_forms_cancel_what_operands_share() {
    // (x + y) + (x - y) - 2 x = 0, which an interval does not see.
    let text = "v0 = var x\nv1 = var y\nv2 = add v0, v1\nv3 = sub v0, v1\nv4 = add v2, v3\nv5 = const 2\n\
                v6 = mul v5, v0\nv7 = sub v4, v6\nout f = v7";
    let mut zero = spec(text);
    let ends = [(0.1, 1.3), (-2.0, 0.7)];
    let (lo, hi, _) = run(&zero, &ends);
    assert!(hi - lo > 1.0);
    zero.arithmetic = Arithmetic::Affine;
    zero.symbols = vec!["x".into(), "y".into()];
    let (lo, hi, bits) = run(&zero, &ends);
    assert!(lo <= 0.0 && 0.0 <= hi && hi - lo < 1e-14 && bits == verdict::CONTINUOUS, "[{lo}, {hi}]");
}

/// Affine programs enclose exact values at the points of a box and are never wider than the natural extension.
#[test]
fn affine_programs_contain_and_do_not_widen() {
    let text = "v0 = var x\nv1 = var y\nv2 = const 1/3\nv3 = mul v2, v0\nv4 = powi v0, 5\nv5 = mul v3, v1\n\
                v6 = sub v4, v5\nv7 = sqr v6\nv8 = sin v7\nv9 = add v8, v3\nv10 = div v9, v0\nout f = v10";
    let mut rng = fastrand::Rng::with_seed(1);
    for _ in 0..500 {
        let mut program = spec(text);
        program.domain = vec![(Value(0), interval(-1.5, 1.5))];
        let ends = [(); 2].map(|()| {
            let (a, b) = (4.0 * rng.f64() - 2.0, 4.0 * rng.f64() - 2.0);
            (a.min(b), a.max(b))
        });
        let natural = run(&program, &ends);
        program.arithmetic = Arithmetic::Affine;
        program.symbols = vec!["x".into(), "y".into()];
        let affine = run(&program, &ends);
        assert!(affine.0 >= natural.0 && affine.1 <= natural.1 && affine.2 & natural.2 == natural.2);
        let at = ends.map(|(lo, hi)| {
            let x = lo + (hi - lo) * rng.f64();
            (x, x)
        });
        let point = run(&program, &at);
        let inside = point.2 == verdict::EMPTY || affine.0 <= point.1 && point.0 <= affine.1;
        assert!(inside, "{point:?} at {at:?} escapes {affine:?} on {ends:?}");
    }
}

#[test]
fn contradictory_specs_are_refused() {
    let mut unbound = spec(CIRCLE);
    unbound.inputs.pop();
    assert_eq!(Interpreter.compile_f64(&unbound).err().unwrap().code, code::INTERNAL);
}
