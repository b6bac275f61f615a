//! Routines that cover all operations, and what the JIT makes of boxes and points: the fixture of `driver.c`.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::sync::Arc;

use imp::codegen::Compiler;
use imp::codegen::object::Kind;
use imp::codegen::object::Routine;
use imp::codegen::object::Target;
use imp::codegen::object::Unit;
use imp::derive::Arithmetic;
use imp::derive::Output;
use imp::derive::Precision;
use imp::derive::Rounding;
use imp::derive::Spec;
use imp::derive::gradient;
use imp::graph::Graph;
use imp::graph::Op;
use imp::graph::Value;
use imp::interval::Interval;
use imp::kernel::Backend;
use imp::kernel::Kernel;
use imp::kernel::Packet;
use imp::kernel::Real;

/// A routine with its spec and its rows.
pub struct Case {
    pub routine: Routine,
    spec: Spec,
    rows: usize,
}

fn case(name: &str, mut spec: Spec, precision: Precision, rows: usize) -> Case {
    let kind = if spec.arithmetic == Arithmetic::Point { Kind::Points } else { Kind::Boxes };
    if kind == Kind::Points {
        spec.outputs = spec.outputs.iter().map(|output| Output::Value(output.value())).collect();
        // Points are rounded to the nearest.
        spec.rounding = Rounding::Nearest;
    }
    let arithmetic = match spec.arithmetic {
        Arithmetic::Point => "point",
        Arithmetic::Interval => "interval",
        Arithmetic::Affine => "affine",
    };
    let format = if precision == Precision::Single { "f32" } else { "f64" };
    let defaults: Vec<f64> = (0..spec.uniforms.len())
        .flat_map(|i| {
            let value = 0.1 + i as f64;
            if kind == Kind::Boxes { vec![value, value + 0.3] } else { vec![value] }
        })
        .collect();
    let routine = Routine {
        symbol: format!("unit_{name}_{arithmetic}_{format}"),
        program: spec.lower(precision),
        rounding: spec.rounding,
        variables: spec.inputs.len(),
        outputs: spec.outputs.len(),
        kind,
        defaults,
    };
    Case { routine, spec, rows }
}

fn spec(graph: Graph, roots: &[Value], arithmetic: Arithmetic) -> Spec {
    let (uniforms, inputs): (Vec<String>, Vec<String>) =
        graph.variables().iter().cloned().partition(|name| name.starts_with('p'));
    Spec {
        outputs: roots.iter().map(|&root| Output::Enclosure(root)).collect(),
        domain: Vec::new(),
        promises: Vec::new(),
        symbols: inputs.iter().take(3).cloned().collect(),
        uniforms,
        inputs,
        arithmetic,
        rounding: Rounding::Outward,
        graph: Arc::new(graph),
    }
}

const PRECISIONS: [Precision; 2] = [Precision::Single, Precision::Double];

/// Every operation alone, and formulas for what else can differ.
pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    let powers = [Op::PowInt(7), Op::PowInt(-3), Op::PowRatio(2, 3), Op::PowRatio(-1, 2)];
    for op in Op::PLAIN.iter().copied().filter(|op| op.arity() > 0).chain(powers) {
        let mut graph = Graph::new();
        let operands = ["x", "y", "z"].map(|name| graph.var(name));
        let root = graph.push(op, &operands[..op.arity()]);
        let name = format!("{}{}", op.name(), cases.len());
        for precision in PRECISIONS {
            for arithmetic in [Arithmetic::Point, Arithmetic::Interval] {
                cases.push(case(&name, spec(graph.clone(), &[root], arithmetic), precision, 40));
            }
        }
        // The affine forms of the two precisions have the same operations.
        cases.push(case(&name, spec(graph, &[root], Arithmetic::Affine), Precision::Double, 40));
    }
    for precision in PRECISIONS {
        for arithmetic in [Arithmetic::Point, Arithmetic::Interval, Arithmetic::Affine] {
            cases.extend(formulas(arithmetic).map(|(name, spec)| case(name, spec, precision, 211)));
        }
    }
    cases
}

fn formulas(arithmetic: Arithmetic) -> [(&'static str, Spec); 6] {
    // A product of differences with a parameter in each, its gradient, and a domain that most boxes leave.
    let mut g = Graph::new();
    let [x, y, p, q] = ["x", "y", "p", "pq"].map(|name| g.var(name));
    let (x2, xy) = (g.sqr(x), g.mul(x, y));
    let (left, right) = (g.sub(x2, p), g.sub(xy, q));
    let product = g.mul(left, right);
    let wave = g.unary(Op::Sin, product);
    let f = g.div(wave, y);
    let mut roots = vec![f];
    roots.extend(gradient(&mut g, f, &[x, y]));
    let slopes = spec(g.clone(), &roots, arithmetic);
    let mut inside = slopes.clone();
    inside.domain = vec![(x, Interval::new(-1.0, 1.0).unwrap())];
    let mut unrounded = slopes.clone();
    unrounded.rounding = Rounding::Nearest;

    // More coordinates than one chunk of packets holds.
    let mut g = Graph::new();
    let names: Vec<String> = (0..40).map(|i| format!("x{i}")).collect();
    let mut sum = g.int(0);
    for pair in names.chunks(2) {
        let [a, b] = [&pair[0], &pair[1]].map(|name| g.var(name));
        let product = g.mul(a, b);
        sum = g.add(sum, product);
    }
    let wide = spec(g, &[sum], arithmetic);

    // So many values live at once that kernels take more stack than a page.
    let mut g = Graph::new();
    let [x, y] = ["x", "y"].map(|name| g.var(name));
    let powers: Vec<Value> = (1..200)
        .map(|i| {
            let factor = g.int(i);
            let scaled = g.mul(x, factor);
            g.add(scaled, y)
        })
        .collect();
    let (mut sum, mut product) = (powers[0], powers[0]);
    for &power in powers.iter().rev() {
        sum = g.add(sum, power);
    }
    for &power in &powers[..20] {
        product = g.mul(product, power);
    }
    let deep_root = g.mul(sum, product);
    let deep = spec(g, &[deep_root], arithmetic);

    // No variable at all.
    let mut g = Graph::new();
    let seven = g.int(7);
    let root = g.unary(Op::Sqrt, seven);
    let constant = spec(g, &[root], arithmetic);
    [
        ("slopes", slopes),
        ("inside", inside),
        ("unrounded", unrounded),
        ("wide", wide),
        ("deep", deep),
        ("constant", constant),
    ]
}

/// The unit of these cases.
pub fn unit(cases: &[Case], target: Target) -> Unit {
    let routines = cases.iter().map(|case| case.routine.clone()).collect();
    Unit { module: "unit".to_owned(), target, abi: "unit_abi".to_owned(), routines }
}

/// Writes `table.h`, `table.c` and `fixture.bin`.
pub fn write(cases: &[Case], folder: &Path) {
    let mut header = String::from("#include <stddef.h>\n#include <stdint.h>\n");
    header += "typedef void (*function)(void);\n";
    header += "typedef void (*boxes_function)(const void *, const void *, void *, uint32_t *, size_t);\n";
    header += "typedef void (*points_function)(const void *, const void *, void *, size_t);\n";
    header += "typedef points_function packets_function;\n";
    header += "struct routine { const char *name; function rows, columns, packets; int points, silent; \
               size_t size, variables, outputs, parameters, count; };\n";
    header += "extern const struct routine table[];\nextern const size_t routines;\n";
    header += "uint32_t unit_level(void);\nextern const uint32_t unit_abi;\n";
    let mut table = String::from("#include \"table.h\"\n");
    let mut entries = String::new();
    let mut bytes = Vec::new();
    for case in cases {
        let Routine { symbol, variables, outputs, kind, rounding, program, .. } = &case.routine;
        writeln!(table, "void {symbol}(void), {symbol}_columns(void), {symbol}_packets(void);").unwrap();
        let size = if program.precision == Precision::Single { 4 } else { 8 };
        let (points, silent) = (*kind == Kind::Points, *rounding == Rounding::Nearest);
        writeln!(
            entries,
            "    {{\"{symbol}\", {symbol}, {symbol}_columns, {symbol}_packets, {}, {}, {size}, {variables}, {outputs}, {}, {}}},",
            u8::from(points),
            u8::from(silent),
            case.spec.uniforms.len(),
            case.rows,
        )
        .unwrap();
        // A kernel in memory counts its groups by their inputs.
        let mut spec = case.spec.clone();
        if spec.inputs.is_empty() {
            spec.inputs.push("unused".to_owned());
        }
        match program.precision {
            Precision::Single => {
                data(case, &*Compiler.compile_f32(&spec).unwrap(), &mut bytes, |x, out| {
                    out.extend(x.to_le_bytes());
                });
            }
            Precision::Double => {
                data(case, &*Compiler.compile_f64(&spec).unwrap(), &mut bytes, |x, out| {
                    out.extend(x.to_le_bytes());
                });
            }
        }
    }
    writeln!(table, "const struct routine table[] = {{\n{entries}}};").unwrap();
    writeln!(table, "const size_t routines = {};", cases.len()).unwrap();
    fs::write(folder.join("table.h"), header).unwrap();
    fs::write(folder.join("table.c"), table).unwrap();
    fs::write(folder.join("fixture.bin"), bytes).unwrap();
}

/// One end of a box, or a coordinate: all magnitudes, and what is none.
fn end(rng: &mut fastrand::Rng) -> f64 {
    let special = [0.0, -0.0, 1.0, -1.0, 0.5, f64::INFINITY, f64::NEG_INFINITY, 1e-310, -1e-42, 1e300, 1e30, 709.0];
    match rng.u32(0..8) {
        0 => special[rng.usize(0..special.len())],
        1 => (rng.f64() - 0.5) * 1e6,
        2 => rng.i32(-20..20).into(),
        _ => rng.f64() * 8.0 - 4.0,
    }
}

/// One interval: mostly proper, now and then NaN or reversed.
///
/// Of many coordinates few are special, or no row would have a result to compare.
fn interval(rng: &mut fastrand::Rng, coordinates: usize) -> [f64; 2] {
    if rng.usize(0..10 * coordinates) >= 10 {
        let lo = rng.f64() * 8.0 - 4.0;
        return [lo, lo + rng.f64() * 1e-3];
    }
    match rng.u32(0..20) {
        0 => [f64::NAN, end(rng)],
        1 => [end(rng), f64::NAN],
        2 => [2.0, -3.0],
        3 => [f64::NEG_INFINITY, f64::INFINITY],
        4..8 => {
            let [a, b] = [end(rng), end(rng)];
            [a.min(b), a.max(b)]
        }
        _ => {
            let lo = end(rng);
            [lo, lo + rng.f64() * [0.0, 1e-9, 1e-3, 1.0][rng.usize(0..4)]]
        }
    }
}

/// What a kernel is given for an interval.
fn ends<T: Real>([lo, hi]: [T; 2]) -> [T; 2] {
    match lo <= hi {
        true => [T::nearest(-lo.to_f64()), hi],
        false => [T::nearest(f64::INFINITY); 2],
    }
}

/// Inputs, parameters, and for these and the default parameters the results.
fn data<T: Real>(case: &Case, kernel: &dyn Kernel<T>, bytes: &mut Vec<u8>, put: fn(T, &mut Vec<u8>)) {
    let mut rng = fastrand::Rng::with_seed(case.rows as u64);
    let points = case.routine.kind == Kind::Points;
    let coordinates = case.routine.variables.max(1);
    let mut numbers = |count: usize| -> Vec<T> {
        let draw = |_| if points { vec![end(&mut rng)] } else { interval(&mut rng, coordinates).to_vec() };
        (0..count).flat_map(draw).map(T::nearest).collect()
    };
    let inputs = numbers(case.rows * case.routine.variables);
    let parameters = numbers(case.spec.uniforms.len());
    inputs.iter().chain(&parameters).for_each(|&x| put(x, bytes));
    let native = |numbers: &[T]| -> Vec<T> {
        match points {
            true => numbers.to_vec(),
            false => numbers.as_chunks::<2>().0.iter().flat_map(|&pair| ends(pair)).collect(),
        }
    };
    let defaults: Vec<T> = match points {
        true => case.routine.defaults.iter().map(|&value| T::nearest(value)).collect(),
        false => {
            case.routine.defaults.as_chunks::<2>().0.iter().flat_map(|&[lo, hi]| [T::up(-lo), T::up(hi)]).collect()
        }
    };

    let (in_slots, out_slots) = (kernel.input_slots(), kernel.output_slots());
    let groups = case.rows.div_ceil(T::LANES);
    let mut packets = vec![Packet::<T>::default(); groups * in_slots];
    for (row, numbers) in inputs.chunks(in_slots).enumerate() {
        for (slot, &x) in native(numbers).iter().enumerate() {
            packets[row / T::LANES * in_slots + slot].lanes_mut()[row % T::LANES] = x;
        }
    }
    for uniforms in [native(&parameters), defaults] {
        let mut results = vec![Packet::<T>::default(); groups * out_slots];
        kernel.run(&uniforms, &packets, &mut results);
        let at = |row: usize, slot: usize| results[row / T::LANES * out_slots + slot].lanes()[row % T::LANES];
        let mut verdicts = Vec::new();
        for row in 0..case.rows {
            for output in 0..case.routine.outputs {
                if points {
                    put(at(row, output), bytes);
                    continue;
                }
                put(T::nearest(-at(row, 3 * output).to_f64()), bytes);
                put(at(row, 3 * output + 1), bytes);
                let verdict = at(row, 3 * output + 2).verdict();
                verdicts.push(if case.routine.rounding == Rounding::Nearest { 0 } else { verdict });
            }
        }
        bytes.extend(verdicts.iter().flat_map(|word| word.to_le_bytes()));
    }
}
