//! Random lane programs of all operations: code for wider registers computes the bits of the narrow code.

use iced_x86::Register;

use crate::codegen::emit;
use crate::codegen::jit::Format;
use crate::codegen::jit::JitKernel;
use crate::codegen::jit::Width;
use crate::codegen::widen::Registers;
use crate::codegen::widen::decode;
use crate::codegen::widen::widen;
use crate::derive::LaneProgram;
use crate::derive::Precision;
use crate::derive::Rounding;
use crate::derive::lanes::Kind;
use crate::derive::lanes::Lane;
use crate::derive::lanes::LaneOp;
use crate::kernel::Kernel;
use crate::kernel::Packet;

const INPUTS: usize = 4;
const UNIFORMS: usize = 2;

/// The values of each kind that later operations may take, the newest last.
#[derive(Default)]
struct Made {
    numbers: Vec<Lane>,
    masks: Vec<Lane>,
    words: Vec<Lane>,
}

struct Generator {
    rng: fastrand::Rng,
    precision: Precision,
    /// Operands are among so many of the newest values of their kind.
    window: usize,
    made: Made,
    ops: Vec<LaneOp>,
}

impl Generator {
    fn pick(&mut self, kind: Kind) -> Lane {
        let list = match kind {
            Kind::Number => &self.made.numbers,
            Kind::Mask => &self.made.masks,
            Kind::Bits => &self.made.words,
        };
        let window = self.window.min(list.len());
        list[list.len() - 1 - self.rng.usize(..window)]
    }

    fn push(&mut self, op: LaneOp) {
        let lane = Lane(self.ops.len() as u32);
        self.ops.push(op);
        match op.kind() {
            Kind::Number => self.made.numbers.push(lane),
            Kind::Mask => self.made.masks.push(lane),
            Kind::Bits => self.made.words.push(lane),
        }
    }

    /// The bits of a number, often of an unusual one.
    fn number(&mut self) -> u64 {
        let value = match self.rng.u32(..12) {
            0 => 0.0,
            1 => -0.0,
            2 => f64::INFINITY,
            3 => f64::NEG_INFINITY,
            4 => f64::NAN,
            5 => f64::from(self.rng.i32(-4..5)) / 2.0,
            6 => f64::from(f32::MIN_POSITIVE) * self.rng.f64(),
            7 => f64::MIN_POSITIVE * self.rng.f64(),
            8 => 1e30 * (self.rng.f64() - 0.5),
            _ => 8.0 * (self.rng.f64() - 0.5),
        };
        match self.precision {
            Precision::Single => (value as f32).to_bits().into(),
            Precision::Double => value.to_bits(),
        }
    }

    fn random_op(&mut self) -> LaneOp {
        use Kind::Bits as W;
        use Kind::Mask as M;
        use Kind::Number as N;
        let shift = self.rng.u8(..if self.precision == Precision::Single { 32 } else { 64 });
        match self.rng.u32(..38) {
            0 => LaneOp::Input(self.rng.u32(..INPUTS as u32)),
            1 => LaneOp::Uniform(self.rng.u32(..UNIFORMS as u32)),
            2 => LaneOp::Const(self.number()),
            3 => LaneOp::Bits([0, 1, 7, u64::MAX, self.rng.u64(..)][self.rng.usize(..5)]),
            4 => LaneOp::Add(self.pick(N), self.pick(N)),
            5 => LaneOp::Sub(self.pick(N), self.pick(N)),
            6 => LaneOp::Mul(self.pick(N), self.pick(N)),
            7 => LaneOp::Div(self.pick(N), self.pick(N)),
            8 => LaneOp::Sqrt(self.pick(N)),
            9 | 10 => LaneOp::Fma(self.pick(N), self.pick(N), self.pick(N)),
            11 => LaneOp::Neg(self.pick(N)),
            12 => LaneOp::Abs(self.pick(N)),
            13 | 14 => LaneOp::Min(self.pick(N), self.pick(N)),
            15 | 16 => LaneOp::Max(self.pick(N), self.pick(N)),
            17 => LaneOp::Floor(self.pick(N)),
            18 => LaneOp::Ceil(self.pick(N)),
            19 => LaneOp::Trunc(self.pick(N)),
            20 => LaneOp::Nearest(self.pick(N)),
            21 => LaneOp::Less(self.pick(N), self.pick(N)),
            22 => LaneOp::LessEqual(self.pick(N), self.pick(N)),
            23 => LaneOp::Equal(self.pick(N), self.pick(N)),
            24 => LaneOp::MaskAnd(self.pick(M), self.pick(M)),
            25 => LaneOp::MaskOr(self.pick(M), self.pick(M)),
            26 => LaneOp::MaskNot(self.pick(M)),
            27..=29 => LaneOp::Select(self.pick(M), self.pick(N), self.pick(N)),
            30 => LaneOp::ToBits(self.pick(N)),
            31 => LaneOp::FromBits(self.pick(W)),
            32 => LaneOp::MaskBits(self.pick(M)),
            33 => LaneOp::BitAnd(self.pick(W), self.pick(W)),
            34 => LaneOp::BitOr(self.pick(W), self.pick(W)),
            35 => LaneOp::IntAdd(self.pick(W), self.pick(W)),
            36 => LaneOp::IntSub(self.pick(W), self.pick(W)),
            _ if self.rng.bool() => LaneOp::ShiftLeft(self.pick(W), shift),
            _ => LaneOp::ShiftRight(self.pick(W), shift),
        }
    }
}

/// A program of about `length` operations.
fn program(seed: u64, precision: Precision, length: usize, window: usize) -> LaneProgram {
    let rng = fastrand::Rng::with_seed(seed);
    let mut g = Generator { rng, precision, window, made: Made::default(), ops: Vec::new() };
    for slot in 0..INPUTS as u32 {
        g.push(LaneOp::Input(slot));
    }
    g.push(LaneOp::Uniform(0));
    g.push(LaneOp::Less(Lane(0), Lane(1)));
    g.push(LaneOp::Bits(1));
    while g.ops.len() < length {
        let op = g.random_op();
        g.push(op);
    }
    let last_mask = g.pick(Kind::Mask);
    g.push(LaneOp::MaskBits(last_mask));
    // Every value of the end is wanted, and with a wide window some of all.
    let outputs: Vec<Lane> =
        (0..8 + window / 8).map(|i| g.pick(if i % 3 == 0 { Kind::Bits } else { Kind::Number })).collect();
    LaneProgram { precision, input_slots: INPUTS, uniform_slots: UNIFORMS, ops: g.ops, outputs }.without_dead_code()
}

/// How many vectors of the frame the narrow code reads or writes.
fn spills(code: &[u8]) -> usize {
    let old = decode(code).expect("code of the kind that kernels have");
    old.iter().filter(|old| old.vector && old.instruction.memory_base() == Register::RSP).count()
}

/// Compares all widths; how many vectors the narrow code spills and reloads.
fn check<T: Format>(program: &LaneProgram, seed: u64, (from, to): Bits<T>) -> usize {
    let mut g = Generator {
        rng: fastrand::Rng::with_seed(seed),
        precision: T::PRECISION,
        window: 1,
        made: Made::default(),
        ops: Vec::new(),
    };
    let groups = 3;
    let mut random = || from(g.number());
    let mut inputs = vec![Packet::<T>::default(); groups * INPUTS];
    inputs.iter_mut().for_each(|packet| packet.lanes_mut().iter_mut().for_each(|lane| *lane = random()));
    let uniforms: Vec<T> = (0..UNIFORMS).map(|_| random()).collect();
    let isa = emit::isa(program).unwrap();
    let run = |width, rounding| {
        let kernel = JitKernel::<T>::new(program, rounding, width).unwrap();
        let mut outputs = vec![Packet::<T>::default(); groups * program.outputs.len()];
        kernel.run(&uniforms, &inputs, &mut outputs);
        outputs.iter().flat_map(|packet| packet.lanes().iter().map(|&lane| to(lane)).collect::<Vec<_>>()).collect()
    };
    for rounding in [Rounding::Outward, Rounding::Nearest] {
        let narrow: Vec<u64> = run(Width::Narrow, rounding);
        for registers in [Registers::Ymm, Registers::Zmm] {
            let code = emit::machine_code(program, &isa, registers.bytes()).unwrap();
            assert!(widen(&code, registers).is_some(), "seed {seed}: {registers:?} is declined");
            let wide: Vec<u64> = run(Width::Wide(registers), rounding);
            let differs = narrow.iter().zip(&wide).position(|(a, b)| a != b);
            assert_eq!(differs, None, "seed {seed}, {registers:?}, {rounding:?}\n{program}");
        }
    }
    spills(&emit::machine_code(program, &isa, emit::VECTOR).unwrap())
}

/// From the bits of a number, and to them.
type Bits<T> = (fn(u64) -> T, fn(T) -> u64);

const SINGLE: Bits<f32> = (|bits| f32::from_bits(bits as u32), |x| x.to_bits().into());
const DOUBLE: Bits<f64> = (f64::from_bits, f64::to_bits);

fn check_both(seed: u64, length: usize, window: usize) -> usize {
    check(&program(seed, Precision::Single, length, window), seed, SINGLE)
        + check(&program(seed, Precision::Double, length, window), seed, DOUBLE)
}

fn say_what_runs() {
    for registers in [Registers::Ymm, Registers::Zmm] {
        if !registers.available() {
            eprintln!("{registers:?}: code is made, but not run, since this machine has no such registers");
        }
    }
}

#[test]
fn random_programs_compute_the_same_bits_in_all_widths() {
    say_what_runs();
    let mut spilled = 0;
    for seed in 0..120 {
        let (length, window) = [(24, 4), (60, 8), (120, 30), (300, 120)][seed as usize % 4];
        spilled += usize::from(check_both(seed, length, window) > 0);
    }
    assert!(spilled >= 40, "only {spilled} programs spill");
}

/// Enough live values for the allocator that is linear in the program's length.
#[test]
fn large_programs_compute_the_same_bits_in_all_widths() {
    say_what_runs();
    for seed in 0..3 {
        assert!(check_both(1000 + seed, 4000, 3000) > 1000);
    }
}

/// `push rbp; mov rbp, rsp; sub rsp, size; add rsp, size; pop rbp; ret`
fn with_frame(size: u32) -> Vec<u8> {
    let size = size.to_le_bytes();
    let parts: [&[u8]; 6] = [&[0x55], &[0x48, 0x89, 0xe5], &[0x48, 0x81, 0xec], &size, &[0x48, 0x81, 0xc4], &size];
    let mut code = parts.concat();
    code.extend([0x5d, 0xc3]);
    code
}

/// What fits in narrow registers may not in wide ones: then narrower code runs, on every machine.
#[test]
fn frames_stay_within_the_limit() {
    let fits = |size, registers| widen(&with_frame(size), registers).is_some();
    assert!(fits(0x1000, Registers::Ymm) && fits(0x1000, Registers::Zmm));
    assert!(fits(0x60000, Registers::Ymm) && !fits(0x60000, Registers::Zmm));
    assert!(!fits(emit::MAX_FRAME, Registers::Ymm) && !fits(emit::MAX_FRAME, Registers::Zmm));
}

#[test]
fn what_is_not_known_to_be_lane_wise_is_declined() {
    let declined: [(&str, &[u8]); 6] = [
        ("vbroadcastss xmm0, xmm1, of a vector", &[0xc4, 0xe2, 0x79, 0x18, 0xc1]),
        ("vpshufd xmm0, xmm1, 0x44, of a vector", &[0xc5, 0xf9, 0x70, 0xc1, 0x44]),
        ("vhaddps xmm0, xmm0, xmm1", &[0xc5, 0xfb, 0x7c, 0xc1]),
        ("vpslld xmm0, xmm0, xmm1", &[0xc5, 0xf9, 0xf2, 0xc1]),
        ("vmovmskps eax, xmm0", &[0xc5, 0xf8, 0x50, 0xc0]),
        ("cpuid", &[0x0f, 0xa2]),
    ];
    for (what, code) in declined {
        for registers in [Registers::Ymm, Registers::Zmm] {
            assert!(widen(&[code, &[0xc3]].concat(), registers).is_none(), "{what}, {registers:?}");
        }
    }
    // After `vmovss xmm1, [rdx]` the broadcast is that of a uniform.
    let uniform = [0xc5, 0xfa, 0x10, 0x0a, 0xc4, 0xe2, 0x79, 0x18, 0xc1, 0xc3];
    assert!(widen(&uniform, Registers::Ymm).is_some() && widen(&uniform, Registers::Zmm).is_some());
}
