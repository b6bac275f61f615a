//! `:show` and `:time`: what an expression is compiled to, and what a box costs.

use std::sync::Arc;
use std::time::Duration;
use std::time::Instant;

use crate::codegen;
use crate::codegen::Compiler;
use crate::derive::Arithmetic;
use crate::derive::Extension;
use crate::derive::Precision;
use crate::derive::Rounding;
use crate::derive::Spec;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::diagnostic::did_you_mean;
use crate::graph;
use crate::interpret::Interpreter;
use crate::interval::Decorated;
use crate::kernel::Backend;
use crate::kernel::Kernel;
use crate::kernel::Packet;
use crate::kernel::Real;
use crate::repl::state::Prepared;
use crate::repl::state::State;
use crate::repl::state::trim;
use crate::repl::table::table;
use crate::session::expression::Messages;
use crate::session::expression::Reading;
use crate::session::expression::Snippet;

/// Packets in one call of a kernel that is timed.
const PACKETS: usize = 16;
/// How long one kernel is timed.
const PATIENCE: Duration = Duration::from_millis(40);
/// More lines of a listing are counted only.
const MAX_LINES: usize = 400;

const STAGES: [&str; 3] = ["graph", "clif", "asm"];

pub fn show(state: &mut State, arguments: &Snippet) -> Result<String, Messages> {
    let text = arguments.as_str();
    let end = text.find(char::is_whitespace).unwrap_or(text.len());
    let stage = &text[..end];
    if !STAGES.contains(&stage) {
        let fault = arguments.within(0..end).fault(code::BAD_COMMAND, format!("there is no stage `{stage}`"), "");
        return Err(match did_you_mean(stage, STAGES) {
            Some(near) => fault.help(format!("did you mean `{near}`?")),
            None => fault.help("write `graph`, `clif` or `asm`, then the expression"),
        });
    }
    let expression = state.open(&trim(&arguments.within(end..text.len())), Reading::Value)?;
    let listing = match stage {
        "graph" => expression.graph.to_string(),
        _ => {
            let spec = expression.spec(Arithmetic::Interval, Rounding::Outward);
            let emitted = codegen::listing(&spec, Precision::Double)?;
            if stage == "clif" { emitted.clif } else { emitted.assembly }
        }
    };
    let lines: Vec<&str> = listing.trim_end().lines().collect();
    let mut text = lines[..lines.len().min(MAX_LINES)].join("\n");
    if lines.len() > MAX_LINES {
        text += &format!("\n... and {} more lines", lines.len() - MAX_LINES);
    }
    Ok(text)
}

pub fn time(state: &mut State, expression: &Snippet) -> Result<String, Messages> {
    let prepared = state.prepare(expression)?;
    let boxes = prepared.expression.boxes(&state.bindings);
    let mut rows = Vec::new();
    let mut arithmetics = vec![Arithmetic::Interval];
    // The compiled forms carry up to three noise symbols.
    if (1..=3).contains(&boxes.len()) {
        arithmetics.push(Arithmetic::Affine);
    }
    for arithmetic in arithmetics {
        let spec = prepared.expression.spec(arithmetic, Rounding::Outward);
        let name = if arithmetic == Arithmetic::Interval { "interval" } else { "affine" };
        let mut row = |how: &str, format: &str, timing: Timing| {
            rows.push([name.to_owned(), how.to_owned(), format.to_owned(), timing.compile(), timing.per_box()]);
        };
        if Compiler::available() {
            row("compiled", "f32", timed(&spec, &boxes, |spec| Compiler.compile_f32(spec))?);
            row("compiled", "f64", timed(&spec, &boxes, |spec| Compiler.compile_f64(spec))?);
        }
        row("interpreted", "f64", timed(&spec, &boxes, |spec| Interpreter.compile_f64(spec))?);
    }
    let Prepared { expression, formula, boxes: inputs } = &prepared;
    let natural = repeated(1, || {
        std::hint::black_box(graph::enclose(&expression.graph, &[expression.root], &boxes));
    });
    let reference = |name: &str, time: f64| {
        [name.to_owned(), "reference".to_owned(), "f64".to_owned(), String::new(), nanoseconds(time)]
    };
    rows.push(reference("interval", natural));
    for &extension in Extension::ALL.iter().filter(|extension| **extension != Extension::Natural) {
        let time = repeated(1, || {
            std::hint::black_box(formula.enclose(extension, inputs));
        });
        rows.push(reference(extension.name(), time));
    }
    Ok(table(["arithmetic", "kernel", "format", "to compile", "one box"], &rows))
}

struct Timing {
    compile: Duration,
    /// Seconds.
    per_box: f64,
}

impl Timing {
    fn compile(&self) -> String {
        format!("{:.3} ms", 1e3 * self.compile.as_secs_f64())
    }

    fn per_box(&self) -> String {
        nanoseconds(self.per_box)
    }
}

fn nanoseconds(seconds: f64) -> String {
    format!("{:.1} ns", 1e9 * seconds)
}

/// Times the making of a kernel, and the kernel on the same boxes in all lanes.
fn timed<T: Real>(
    spec: &Spec,
    boxes: &[Decorated],
    make: impl Fn(&Spec) -> Result<Arc<dyn Kernel<T>>, Diagnostic>,
) -> Result<Timing, Diagnostic> {
    // The first time pays for what is set up once in a process.
    let mut kernel = make(spec)?;
    let mut compile = Duration::MAX;
    for _ in 0..3 {
        let start = Instant::now();
        kernel = make(spec)?;
        compile = compile.min(start.elapsed());
    }
    let ends = boxes.iter().flat_map(|input| {
        let interval = input.interval();
        [T::up(-interval.lo()), T::up(interval.hi())]
    });
    let group: Vec<Packet<T>> = ends.map(Packet::splat).collect();
    let inputs = group.repeat(PACKETS);
    let mut outputs = vec![Packet::default(); PACKETS * kernel.output_slots()];
    let per_box = repeated(PACKETS * T::LANES, || kernel.run(&[], std::hint::black_box(&inputs), &mut outputs));
    Ok(Timing { compile, per_box })
}

/// Seconds that one of `share` parts of a run takes: the least of several rounds, since everything else that a machine
/// does adds to it.
fn repeated(share: usize, mut run: impl FnMut()) -> f64 {
    run();
    let begin = Instant::now();
    let mut least = f64::INFINITY;
    let mut runs = 1u32;
    while begin.elapsed() < PATIENCE {
        let start = Instant::now();
        for _ in 0..runs {
            run();
        }
        let spent = start.elapsed();
        least = least.min(spent.as_secs_f64() / f64::from(runs) / share as f64);
        // Rounds long enough for the clock, and several of them.
        if spent < PATIENCE / 20 {
            runs = runs.saturating_mul(2);
        }
    }
    least
}
