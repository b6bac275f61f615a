//! Rewrites preserve enclosure: on random graphs and on every row of `tests/filetests/passes`, over random boxes and the
//! points in them.

use std::fs;
use std::path::Path;

use fastrand::Rng;
use imp::graph::Graph;
use imp::graph::Op;
use imp::graph::Value;
use imp::graph::enclose;
use imp::graph::parse;
use imp::graph::verify;
use imp::interval::Decorated;
use imp::interval::Decoration;
use imp::interval::Interval;
use imp::passes;
use num_rational::BigRational;

fn interval(lo: f64, hi: f64) -> Interval {
    Interval::new(lo, hi).unwrap()
}

/// A number of a bounded domain: often an end, an integer or another number at which something happens.
fn coordinate(rng: &mut Rng, domain: Interval) -> f64 {
    let (lo, hi) = (domain.lo().max(-1e3), domain.hi().min(1e3));
    let any = lo + (hi - lo) * rng.f64();
    let special = match rng.u8(0..10) {
        0 => lo,
        1 => hi,
        2 => any.round(),
        3 => 0.0,
        4 => (4.0 * any).round() / 4.0,
        5 => any * 1e-300,
        _ => any,
    };
    special.clamp(lo, hi)
}

/// A random box in a domain, and a point of it.
fn sample(rng: &mut Rng, domain: &[Interval]) -> (Vec<Decorated>, Vec<f64>) {
    domain
        .iter()
        .map(|&domain| {
            let (a, b, c) = (coordinate(rng, domain), coordinate(rng, domain), coordinate(rng, domain));
            let point = if rng.bool() { a } else { a.max(b.min(c)).min(b.max(c)) };
            let side =
                if rng.bool() { interval(a.min(b).min(point), a.max(b).max(point)) } else { interval(point, point) };
            (Decorated::new(side), point)
        })
        .unzip()
}

fn outputs(graph: &Graph, inputs: &[Decorated]) -> Vec<Decorated> {
    let roots: Vec<Value> = graph.outputs().iter().map(|&(_, value)| value).collect();
    enclose(graph, &roots, inputs)
}

/// The outputs at a point as exact numbers, where all on the way is defined and rational.
fn exact_outputs(graph: &Graph, point: &[f64]) -> Vec<Option<BigRational>> {
    let mut values: Vec<Option<BigRational>> = Vec::with_capacity(graph.len());
    for (value, node) in graph.iter() {
        values.push(match node.op {
            Op::Var(id) => BigRational::from_float(point[id as usize]),
            Op::Const(_) => graph.as_constant(value).cloned(),
            Op::Select => match values[node.operands()[0].index()].as_ref().map(|c| *c.numer() == 1.into()) {
                Some(true) => values[node.operands()[1].index()].clone(),
                Some(false) => values[node.operands()[2].index()].clone(),
                None => None,
            },
            op => {
                let operands: Option<Vec<_>> = node.operands().iter().map(|v| values[v.index()].as_ref()).collect();
                operands.and_then(|operands| passes::exact(op, &operands))
            }
        });
    }
    graph.outputs().iter().map(|(_, value)| values[value.index()].clone()).collect()
}

fn contains(enclosure: Interval, value: &BigRational) -> bool {
    let end = |x: f64| BigRational::from_float(x);
    !enclosure.is_empty()
        && end(enclosure.lo()).is_none_or(|lo| lo <= *value)
        && end(enclosure.hi()).is_none_or(|hi| *value <= hi)
}

/// What must hold of a rewritten graph on one box with a point in it.
fn check(before: &Graph, after: &Graph, boxes: &[Decorated], point: &[f64], what: &str) {
    let at: Vec<Decorated> = point.iter().map(|&x| Decorated::new(interval(x, x))).collect();
    let exact = exact_outputs(before, point);
    let (wide_before, wide_after) = (outputs(before, boxes), outputs(after, boxes));
    let (thin_before, thin_after) = (outputs(before, &at), outputs(after, &at));
    for (i, (name, _)) in before.outputs().iter().enumerate() {
        let place = || format!("{what}: output {name} on {boxes:?} at {point:?}\nbefore:\n{before}after:\n{after}");
        let defined = |x: Decorated| x.decoration() >= Decoration::Def;
        // No point is lost.
        if defined(thin_before[i]) {
            for after in [thin_after[i], wide_after[i]] {
                assert!(!after.interval().disjoint(thin_before[i].interval()), "lost {}: {}", thin_before[i], place());
            }
        }
        if let Some(value) = &exact[i] {
            for after in [thin_after[i], wide_after[i]] {
                assert!(contains(after.interval(), value), "lost {value}: {after}: {}", place());
            }
        }
        // No domain is forgotten.
        if thin_before[i].interval().is_empty() {
            assert!(!defined(thin_after[i]) && !defined(wide_after[i]), "a domain is forgotten: {}", place());
        }
        // Nothing that was proved of definedness is unproved.
        assert!(defined(wide_after[i]) || !defined(wide_before[i]), "a proof is lost: {}", place());
    }
}

fn rational(rng: &mut Rng) -> BigRational {
    let denominator = *rng.choice([1i64, 1, 1, 2, 3, 10].iter()).unwrap();
    BigRational::new(rng.i64(-4..=4).into(), denominator.into())
}

/// A random graph in two inputs. Operands are mostly recent values and often equal, so that rows find something to do.
fn random_graph(rng: &mut Rng, operations: &[Op]) -> Graph {
    let mut graph = Graph::new();
    let mut values = vec![graph.var("x"), graph.var("y")];
    let zero = graph.int(0);
    let one = graph.int(1);
    let mut truths = vec![zero, one];
    let one = graph.int(1);
    for _ in 0..rng.usize(3..16) {
        let constant = graph.constant(rational(rng));
        let pick = |rng: &mut Rng, values: &[Value]| match rng.u8(0..8) {
            0 | 1 => constant,
            2 => values[rng.usize(..values.len())],
            _ => values[rng.usize(values.len().saturating_sub(4)..values.len())],
        };
        let op = operations[rng.usize(..operations.len())];
        let mut operands: Vec<Value> = (0..op.arity()).map(|_| pick(rng, &values)).collect();
        if op.arity() > 1 && rng.u8(0..4) == 0 {
            operands[1] = operands[0];
        }
        match op {
            Op::Select | Op::SelectJump => operands[0] = truths[rng.usize(..truths.len())],
            Op::Less | Op::LessEqual | Op::Equal => {
                let truth = graph.push(op, &operands);
                let other = truths[rng.usize(..truths.len())];
                truths.push(match rng.u8(0..4) {
                    0 => graph.sub(one, truth),
                    1 => graph.push(Op::Min, &[truth, other]),
                    2 => graph.push(Op::Max, &[truth, other]),
                    _ => truth,
                });
            }
            _ => {}
        }
        let value = graph.push(op, &operands);
        values.push(value);
    }
    graph.add_output("f", values[values.len() - 1]);
    graph.add_output("g", values[values.len() - 2]);
    verify(&graph).unwrap();
    graph
}

/// A bounded domain for each of two inputs.
fn random_domain(rng: &mut Rng) -> [Interval; 2] {
    std::array::from_fn(|_| match rng.u8(0..6) {
        0 => Interval::ENTIRE,
        1 => interval(0.0, 3.0),
        2 => interval(0.5, 2.0),
        3 => interval(-3.0, -0.25),
        4 => interval(-1.0, 1.0),
        _ => interval(-4.0, 4.0),
    })
}

fn random_graphs(operations: &[Op], graphs: u64) {
    let mut rewritten = 0;
    for seed in 0..graphs {
        let mut rng = Rng::with_seed(seed);
        let before = random_graph(&mut rng, operations);
        let domain = random_domain(&mut rng);
        let (after, reports) = passes::run(&before, &domain);
        verify(&after).unwrap();
        rewritten += u64::from(reports.iter().any(|report| report.pass != "cse" && report.changed.is_some()));
        for _ in 0..20 {
            let (boxes, point) = sample(&mut rng, &domain);
            check(&before, &after, &boxes, &point, &format!("seed {seed}"));
        }
        let (again, reports) = passes::run(&after, &domain);
        assert!(reports.iter().all(|report| report.changed.is_none()), "seed {seed}:\n{after}then\n{again}");
    }
    assert!(rewritten > graphs / 2, "only {rewritten} of {graphs} graphs were rewritten at all");
}

#[test]
fn rational_operations_against_exact_values() {
    random_graphs(
        &[
            Op::Add,
            Op::Sub,
            Op::Mul,
            Op::Div,
            Op::Neg,
            Op::Sqr,
            Op::Abs,
            Op::Min,
            Op::Max,
            Op::PowInt(3),
            Op::PowInt(-2),
            Op::PowInt(0),
            Op::Sign,
            Op::Floor,
            Op::Mod,
            Op::Less,
            Op::LessEqual,
            Op::Equal,
            Op::Select,
        ],
        4000,
    );
}

#[test]
fn every_operation() {
    let mut operations = Op::PLAIN.to_vec();
    operations.extend([Op::PowInt(3), Op::PowInt(2), Op::PowInt(-1), Op::PowRatio(2, 3), Op::PowRatio(-1, 2)]);
    random_graphs(&operations, 4000);
}

/// Inverse functions, even and odd ones, powers: where rows other than those of sums apply.
#[test]
fn powers_and_inverses() {
    let operations = [
        Op::Sqrt,
        Op::Sqr,
        Op::PowInt(3),
        Op::PowInt(2),
        Op::PowInt(-1),
        Op::PowInt(-2),
        Op::PowInt(4),
        Op::Cbrt,
        Op::PowRatio(2, 3),
        Op::PowRatio(-1, 2),
        Op::Pow,
        Op::Exp,
        Op::Ln,
        Op::Exp2,
        Op::Log2,
        Op::Expm1,
        Op::Log1p,
        Op::Neg,
        Op::Abs,
        Op::Sin,
        Op::Cos,
        Op::Mul,
        Op::Div,
        Op::Hypot,
        Op::Max,
    ];
    random_graphs(&operations, 4000);
}

/// Every row that has a file, on boxes within the bounds that the file gives; and a row may widen by no more than a few
/// roundings.
#[test]
fn rows_with_files() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/filetests/passes");
    for file in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        let text = fs::read_to_string(&file).unwrap();
        let input = text.split("\n----\n").next().unwrap();
        let before = parse(input).unwrap();
        let domain: Vec<Interval> = before.variables().iter().map(|name| bound(input, name)).collect();
        let (after, _) = passes::run(&before, &domain);
        let mut rng = Rng::with_seed(7);
        for _ in 0..500 {
            let (boxes, point) = sample(&mut rng, &domain);
            check(&before, &after, &boxes, &point, &file.display().to_string());
            for (was, is) in outputs(&before, &boxes).into_iter().zip(outputs(&after, &boxes)) {
                let (was, is) = (was.interval(), is.interval());
                let slack = 8.0 * f64::EPSILON * was.mag() + 1e-300;
                let kept = is.is_empty() || is.lo() >= was.lo() - slack && is.hi() <= was.hi() + slack;
                assert!(kept, "{}: {was} grew to {is} on {boxes:?}", file.display());
            }
        }
    }
}

/// The bounds that a file gives an input in a line `# NAME in [LO, HI]`.
fn bound(input: &str, name: &str) -> Interval {
    let range = input.lines().find_map(|line| line.strip_prefix(&format!("# {name} in [")));
    let Some((lo, hi)) = range.and_then(|range| range.strip_suffix(']')?.split_once(", ")) else {
        return Interval::ENTIRE;
    };
    let end = |text: &str| Interval::from_rational(&text.parse().unwrap());
    end(lo).hull(end(hi))
}
