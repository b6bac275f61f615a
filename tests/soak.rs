//! Thousands of programs compiled, called and dropped by eight threads at once: every result is compared with the reference
//! interpreter, memory and mappings stay flat, no page is ever writable and executable, and code is unmapped when the last
//! kernel goes.
//!
//! `IMP_SOAK=10000 cargo test --release --test soak -- --nocapture` is the long one. With the address sanitizer
//! (`RUSTFLAGS=-Zsanitizer=address`) `ASAN_OPTIONS=quarantine_size_mb=1` keeps freed memory from being mistaken for growth.
//! Valgrind rounds to nearest only, so that results are compared with some slack there; it does not know AVX-512, which
//! the C part of `core-math` uses on machines that have it.
#![cfg(all(target_os = "linux", target_arch = "x86_64"))]

use std::env;
use std::fmt::Write;
use std::fs;
use std::panic;
use std::panic::AssertUnwindSafe;
use std::process;
use std::sync::Arc;
use std::sync::Barrier;
use std::sync::Mutex;
use std::sync::OnceLock;
use std::sync::atomic::AtomicBool;
use std::sync::atomic::AtomicUsize;
use std::sync::atomic::Ordering;
use std::thread;
use std::time::Duration;
use std::time::Instant;

use imp::Enclosure;
use imp::Interval;
use imp::IntervalKernel;
use imp::Options;
use imp::PointKernel;
use imp::Program;
use imp::derive::Precision;
use imp::interpret::Interpreter;
use imp::kernel::Backend;
use imp::kernel::Kernel;
use imp::kernel::Packet;

const THREADS: usize = 8;
const VARIABLES: usize = 3;
/// Boxes of one packet of the reference.
const ROWS: usize = 8;

/// One program, compiled.
struct Job {
    seed: u64,
    double: IntervalKernel<f64>,
    single: IntervalKernel<f32>,
    points: PointKernel<f64>,
    reference: Arc<dyn Kernel<f64>>,
}

/// A formula of three variables and a parameter; every seed has another one.
fn formula(seed: u64) -> String {
    fn term(rng: &mut fastrand::Rng, depth: usize) -> String {
        let constant = |rng: &mut fastrand::Rng| format!("{:.3}", 0.1 + 4.0 * rng.f64());
        if depth == 0 {
            let leaf = rng.usize(..6);
            return match leaf {
                0..4 => ["x", "y", "z", "a"][leaf].to_owned(),
                _ => constant(rng),
            };
        }
        let mut inner = || term(rng, depth - 1);
        let (u, v) = (inner(), inner());
        match rng.usize(..12) {
            0 | 1 => format!("({u} + {v})"),
            2 => format!("({u} - {v})"),
            3 | 4 => format!("({u} * {v})"),
            5 => format!("({u} / ({v}^2 + {}))", constant(rng)),
            6 => format!("({u})^{}", 2 + rng.usize(..4)),
            7 => format!("sqrt(|{u}|)"),
            8 => format!("sin({u})"),
            9 => format!("exp(-({u})^2)"),
            10 => format!("max({u}, {v})"),
            _ => format!("atan({u})"),
        }
    }
    let mut rng = fastrand::Rng::with_seed(seed);
    let depth = 2 + rng.usize(..3);
    let body = term(&mut rng, depth);
    format!("param a = 1 in [0, 2]\nfn f(x, y, z) = {body} + {seed} x / 1000")
}

fn compile(seed: u64) -> Job {
    let text = formula(seed);
    let program = Program::parse(&text).unwrap_or_else(|error| panic!("{text}\n{error}"));
    let function = program.function("f").unwrap();
    let options = if seed.is_multiple_of(3) { Options::with_gradient() } else { Options::default() };
    let spec = function.box_spec(&options, Precision::Double).unwrap();
    Job {
        seed,
        double: function.interval_kernel(&options).unwrap(),
        single: function.interval_kernel(&options).unwrap(),
        points: function.points(&Options::default()).unwrap(),
        reference: Interpreter.compile_f64(&spec).unwrap(),
    }
}

/// Compares all kernels of a program over boxes that only this thread has. A kernel encloses what the reference does, but for
/// elementary functions, of which either may be an ulp or two tighter.
fn check(job: &Job, thread: usize) {
    let text = formula(job.seed);
    let algebraic = ["sin", "exp", "atan"].iter().all(|function| !text.contains(function));
    let slack = if algebraic && !emulated() { 0.0 } else { 1e-9 };
    let mut rng = fastrand::Rng::with_seed(job.seed ^ (thread as u64) << 32);
    let mut inputs = vec![Packet::<f64>::default(); 2 * VARIABLES];
    let mut boxes = Vec::new();
    for row in 0..ROWS {
        for variable in 0..VARIABLES {
            let lo = 4.0 * rng.f64() - 2.0;
            let hi = lo + [0.0, 1e-6, 0.1, 1.0][row % 4] * rng.f64();
            inputs[2 * variable].lanes_mut()[row] = -lo;
            inputs[2 * variable + 1].lanes_mut()[row] = hi;
            boxes.push(Interval::new(lo, hi).unwrap());
        }
    }
    let outputs = job.double.outputs().len();
    let mut expected = vec![Packet::<f64>::default(); 3 * outputs];
    job.reference.run(job.double.uniforms(), &inputs, &mut expected);
    let [mut double, mut single] = [0; 2].map(|_| vec![Enclosure::UNKNOWN; ROWS * outputs]);
    job.double.clone().enclose_into(&boxes, &mut double).unwrap();
    job.single.clone().enclose_into(&boxes, &mut single).unwrap();
    for row in 0..ROWS {
        for output in 0..outputs {
            let [lo, hi] = [-expected[3 * output].lanes()[row], expected[3 * output + 1].lanes()[row]];
            for (name, found) in
                [("double", double[row * outputs + output]), ("single", single[row * outputs + output])]
            {
                let margin = slack * lo.abs().max(hi.abs()).max(1.0);
                let holds = found.lo() <= lo + margin && found.hi() >= hi - margin;
                // The empty set, and what has no bound, are not worth the arithmetic.
                let exempt = lo > hi || lo.is_nan() || margin.is_nan() || slack > 0.0 && !margin.is_finite();
                assert!(holds || exempt, "{text}\n{name}: {found:?} misses [{lo}, {hi}]");
            }
        }
        let corner: Vec<f64> = boxes[row * VARIABLES..(row + 1) * VARIABLES].iter().map(|side| side.lo()).collect();
        let value = job.points.value(&corner).unwrap();
        let found = double[row * outputs];
        let margin = 1e-6 * found.lo().abs().max(found.hi().abs()).max(1.0);
        let holds = value >= found.lo() - margin && value <= found.hi() + margin;
        assert!(holds || value.is_nan(), "{text}\n{value} at {corner:?} is not in {found:?}");
    }
}

/// A line of `/proc/self/status` in KiB.
fn status(key: &str) -> usize {
    let text = fs::read_to_string("/proc/self/status").unwrap();
    let line = text.lines().find(|line| line.starts_with(key)).unwrap();
    line.split_whitespace().nth(1).unwrap().parse().unwrap()
}

/// All mappings, and those of anonymous memory that are executable. None may be writable and executable.
fn mappings() -> (usize, usize) {
    let text = fs::read_to_string("/proc/self/maps").unwrap();
    let code = text.lines().filter(|line| line.contains("r-xp") && line.split_whitespace().count() == 5).count();
    // Valgrind keeps its own translations in such pages.
    if !emulated() {
        let both = text.lines().find(|line| line.contains("wx"));
        assert_eq!(both, None, "a page is writable and executable");
    }
    (text.lines().count(), code)
}

/// Whether this is a machine that ignores the rounding mode, which only an emulator does.
fn emulated() -> bool {
    static ANSWER: OnceLock<bool> = OnceLock::new();
    *ANSWER.get_or_init(|| {
        let program = Program::parse("fn f(x, y) = x + y").unwrap();
        let kernel = program.function("f").unwrap().intervals(&Options::default()).unwrap();
        let sum = kernel.enclose(&[Interval::point(1.0), Interval::point(1e-20)]).unwrap();
        sum.lo() == sum.hi()
    })
}

#[test]
fn programs_come_and_go() {
    let programs: usize = env::var("IMP_SOAK").map_or(160, |text| text.parse().unwrap());
    let rounds = programs.div_ceil(THREADS);
    let (_, code_before) = mappings();
    let (barrier, slots) = (Barrier::new(THREADS), [const { Mutex::new(None::<Arc<Job>>) }; THREADS]);
    let (done, samples) = (AtomicBool::new(false), AtomicUsize::new(0));
    let log = Mutex::new(Vec::new());
    let start = Instant::now();
    let work = |thread: usize| {
        for round in 0..rounds {
            *slots[thread].lock().unwrap() = Some(Arc::new(compile((round * THREADS + thread) as u64)));
            barrier.wait();
            for offset in 0..THREADS {
                let job = slots[(thread + offset) % THREADS].lock().unwrap().clone().unwrap();
                check(&job, thread);
            }
            barrier.wait();
            // Compiled there, dropped here.
            drop(slots[(thread + 1) % THREADS].lock().unwrap().take());
            barrier.wait();
            if thread == 0 && (round % (rounds / 10).max(1) == 0 || round + 1 == rounds) {
                let (all, code) = mappings();
                log.lock().unwrap().push([round + 1, status("VmHWM:"), status("VmRSS:"), all, code]);
            }
            barrier.wait();
        }
    };
    // The others would wait for a thread that has failed.
    let worker = |thread| {
        panic::catch_unwind(AssertUnwindSafe(|| work(thread))).unwrap_or_else(|_| process::exit(101));
    };
    thread::scope(|scope| {
        scope.spawn(|| {
            while !done.load(Ordering::Relaxed) {
                mappings();
                samples.fetch_add(1, Ordering::Relaxed);
                thread::sleep(Duration::from_micros(500));
            }
        });
        let worker = &worker;
        let workers: Vec<_> = (0..THREADS).map(|thread| scope.spawn(move || worker(thread))).collect();
        workers.into_iter().for_each(|worker| worker.join().unwrap());
        done.store(true, Ordering::Relaxed);
    });
    let log = log.into_inner().unwrap();
    let mut table = format!("{:>9} {:>9} {:>9} {:>9} {:>6}\n", "programs", "peak KiB", "now KiB", "mappings", "code");
    for [round, peak, now, all, code] in &log {
        let _ = writeln!(table, "{:>9} {peak:>9} {now:>9} {all:>9} {code:>6}", round * THREADS);
    }
    let [samples, seconds] = [samples.into_inner() as f64, start.elapsed().as_secs_f64()];
    println!("{table}{samples} samples of all mappings, {seconds:.1} s");
    if emulated() {
        return;
    }
    let (first, last) = (log[1], log[log.len() - 1]);
    assert!(last[1] <= first[1] + first[1] / 4 + 8192, "peak memory grows\n{table}");
    assert!(last[3] <= first[3] + 64, "mappings grow\n{table}");
    assert!(log.iter().all(|line| line[4] == code_before), "code stays mapped\n{table}");
}
