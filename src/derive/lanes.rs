//! Lane programs: straight-line code over the lanes of a packet, with no cross-lane operation, no branch and no call.
//!
//! A lane program is what the derivations produce and what the code generator translates, one operation at a time.
//! With outward rounding it runs with the hardware rounding **up**; a lower bound is therefore kept negated, so that
//! rounding up moves it outward too. No derivation may rely on rounding to nearest, and no two roundings may be
//! assumed symmetric: `sqrt` is not odd, and `x - y` rounded up is not `-(y - x)` rounded up.

use std::collections::HashMap;
use std::fmt;

use crate::derive::Precision;

/// A value of a lane program: the index of the operation that computes it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Lane(pub u32);

impl Lane {
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// What the bits of a lane mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Number,
    /// All ones or all zeros.
    Mask,
    /// An integer of the lane's width.
    Bits,
}

/// One lane operation. `Number` operations round in the mode in which the program runs, unless it says otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LaneOp {
    /// Input slot.
    Input(u32),
    /// Uniform slot, the same for all lanes.
    Uniform(u32),
    /// A number by its bits, which are those of an `f32` in a single-precision program.
    Const(u64),
    /// An integer.
    Bits(u64),
    Add(Lane, Lane),
    Sub(Lane, Lane),
    Mul(Lane, Lane),
    Div(Lane, Lane),
    Sqrt(Lane),
    /// a b + c, rounded once.
    Fma(Lane, Lane, Lane),
    /// Exact.
    Neg(Lane),
    Abs(Lane),
    /// `if a < b { a } else { b }`: the second operand where either is NaN.
    Min(Lane, Lane),
    /// `if b < a { a } else { b }`: the second operand where either is NaN.
    Max(Lane, Lane),
    /// Exact, in any mode.
    Floor(Lane),
    Ceil(Lane),
    Trunc(Lane),
    /// To the nearest integer, ties to even, in any mode.
    Nearest(Lane),
    /// Ordered comparisons: false where either operand is NaN.
    Less(Lane, Lane),
    LessEqual(Lane, Lane),
    Equal(Lane, Lane),
    MaskAnd(Lane, Lane),
    MaskOr(Lane, Lane),
    MaskNot(Lane),
    /// The second operand where the mask (first) is set, else the third.
    Select(Lane, Lane, Lane),
    /// Reinterpretations.
    ToBits(Lane),
    FromBits(Lane),
    /// A mask as the integer -1 or 0.
    MaskBits(Lane),
    BitAnd(Lane, Lane),
    BitOr(Lane, Lane),
    IntAdd(Lane, Lane),
    IntSub(Lane, Lane),
    ShiftLeft(Lane, u8),
    /// Logical.
    ShiftRight(Lane, u8),
}

impl LaneOp {
    pub fn kind(self) -> Kind {
        use LaneOp::*;
        match self {
            Input(_) | Uniform(_) | Const(_) | Add(..) | Sub(..) | Mul(..) | Div(..) | Sqrt(_) | Fma(..) | Neg(_)
            | Abs(_) | Min(..) | Max(..) | Floor(_) | Ceil(_) | Trunc(_) | Nearest(_) | Select(..) | FromBits(_) => {
                Kind::Number
            }
            Less(..) | LessEqual(..) | Equal(..) | MaskAnd(..) | MaskOr(..) | MaskNot(_) => Kind::Mask,
            Bits(_) | ToBits(_) | MaskBits(_) | BitAnd(..) | BitOr(..) | IntAdd(..) | IntSub(..) | ShiftLeft(..)
            | ShiftRight(..) => Kind::Bits,
        }
    }

    /// Its lane operands, in order.
    pub fn operands(self) -> impl Iterator<Item = Lane> {
        use LaneOp::*;
        let (a, b, c) = match self {
            Input(_) | Uniform(_) | Const(_) | Bits(_) => (None, None, None),
            Sqrt(a)
            | Neg(a)
            | Abs(a)
            | Floor(a)
            | Ceil(a)
            | Trunc(a)
            | Nearest(a)
            | MaskNot(a)
            | ToBits(a)
            | FromBits(a)
            | MaskBits(a)
            | ShiftLeft(a, _)
            | ShiftRight(a, _) => (Some(a), None, None),
            Add(a, b)
            | Sub(a, b)
            | Mul(a, b)
            | Div(a, b)
            | Min(a, b)
            | Max(a, b)
            | Less(a, b)
            | LessEqual(a, b)
            | Equal(a, b)
            | MaskAnd(a, b)
            | MaskOr(a, b)
            | BitAnd(a, b)
            | BitOr(a, b)
            | IntAdd(a, b)
            | IntSub(a, b) => (Some(a), Some(b), None),
            Fma(a, b, c) | Select(a, b, c) => (Some(a), Some(b), Some(c)),
        };
        [a, b, c].into_iter().flatten()
    }
}

/// Lane operations in definition order, and which of them are stored to which output slot.
#[derive(Debug, Clone)]
pub struct LaneProgram {
    pub precision: Precision,
    pub input_slots: usize,
    pub uniform_slots: usize,
    pub ops: Vec<LaneOp>,
    /// Output slot `i` is the lane `outputs[i]`, a number or bits.
    pub outputs: Vec<Lane>,
}

impl LaneProgram {
    /// How many operations compute: everything but inputs, constants and reinterpretations.
    pub fn cost(&self) -> usize {
        use LaneOp::*;
        let free = |op: &LaneOp| {
            matches!(op, Input(_) | Uniform(_) | Const(_) | Bits(_) | ToBits(_) | FromBits(_) | MaskBits(_))
        };
        self.ops.iter().filter(|op| !free(op)).count()
    }

    /// Drops the operations that no output needs.
    pub fn without_dead_code(&self) -> LaneProgram {
        let mut needed = vec![false; self.ops.len()];
        for output in &self.outputs {
            needed[output.index()] = true;
        }
        for i in (0..self.ops.len()).rev() {
            if needed[i] {
                self.ops[i].operands().for_each(|operand| needed[operand.index()] = true);
            }
        }
        let mut image = vec![Lane(0); self.ops.len()];
        let mut ops = Vec::new();
        for (i, op) in self.ops.iter().enumerate().filter(|&(i, _)| needed[i]) {
            image[i] = Lane(ops.len() as u32);
            ops.push(rename(*op, |lane| image[lane.index()]));
        }
        let outputs = self.outputs.iter().map(|lane| image[lane.index()]).collect();
        LaneProgram { ops, outputs, ..*self }
    }
}

fn rename(op: LaneOp, f: impl Fn(Lane) -> Lane) -> LaneOp {
    use LaneOp::*;
    match op {
        Input(_) | Uniform(_) | Const(_) | Bits(_) => op,
        Add(a, b) => Add(f(a), f(b)),
        Sub(a, b) => Sub(f(a), f(b)),
        Mul(a, b) => Mul(f(a), f(b)),
        Div(a, b) => Div(f(a), f(b)),
        Sqrt(a) => Sqrt(f(a)),
        Fma(a, b, c) => Fma(f(a), f(b), f(c)),
        Neg(a) => Neg(f(a)),
        Abs(a) => Abs(f(a)),
        Min(a, b) => Min(f(a), f(b)),
        Max(a, b) => Max(f(a), f(b)),
        Floor(a) => Floor(f(a)),
        Ceil(a) => Ceil(f(a)),
        Trunc(a) => Trunc(f(a)),
        Nearest(a) => Nearest(f(a)),
        Less(a, b) => Less(f(a), f(b)),
        LessEqual(a, b) => LessEqual(f(a), f(b)),
        Equal(a, b) => Equal(f(a), f(b)),
        MaskAnd(a, b) => MaskAnd(f(a), f(b)),
        MaskOr(a, b) => MaskOr(f(a), f(b)),
        MaskNot(a) => MaskNot(f(a)),
        Select(a, b, c) => Select(f(a), f(b), f(c)),
        ToBits(a) => ToBits(f(a)),
        FromBits(a) => FromBits(f(a)),
        MaskBits(a) => MaskBits(f(a)),
        BitAnd(a, b) => BitAnd(f(a), f(b)),
        BitOr(a, b) => BitOr(f(a), f(b)),
        IntAdd(a, b) => IntAdd(f(a), f(b)),
        IntSub(a, b) => IntSub(f(a), f(b)),
        ShiftLeft(a, n) => ShiftLeft(f(a), n),
        ShiftRight(a, n) => ShiftRight(f(a), n),
    }
}

/// A truth known when the program is derived, or a mask lane. Programs of total, continuous formulas carry none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mask {
    False,
    True,
    Lane(Lane),
}

/// Builds a lane program; equal operations are one.
#[derive(Debug)]
pub struct Builder {
    precision: Precision,
    ops: Vec<LaneOp>,
    interned: HashMap<LaneOp, Lane>,
}

impl Builder {
    pub fn new(precision: Precision) -> Self {
        Self { precision, ops: Vec::new(), interned: HashMap::new() }
    }

    pub fn precision(&self) -> Precision {
        self.precision
    }

    /// Operations so far.
    pub fn count(&self) -> usize {
        self.ops.len()
    }

    pub fn finish(self, input_slots: usize, uniform_slots: usize, outputs: Vec<Lane>) -> LaneProgram {
        LaneProgram { precision: self.precision, input_slots, uniform_slots, ops: self.ops, outputs }
            .without_dead_code()
    }

    pub fn push(&mut self, op: LaneOp) -> Lane {
        if let Some(&lane) = self.interned.get(&op) {
            return lane;
        }
        let lane = Lane(self.ops.len() as u32);
        self.ops.push(op);
        self.interned.insert(op, lane);
        lane
    }

    /// The number behind a constant lane.
    pub fn as_number(&self, lane: Lane) -> Option<f64> {
        match (self.ops[lane.index()], self.precision) {
            (LaneOp::Const(bits), Precision::Single) => Some(f32::from_bits(bits as u32).into()),
            (LaneOp::Const(bits), Precision::Double) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    /// A constant that the precision represents.
    ///
    /// # Panics
    /// If it does not: whoever rounds a constant says in which direction (see [`Builder::up`]).
    pub fn number(&mut self, value: f64) -> Lane {
        match self.precision {
            Precision::Single => {
                assert!(f64::from(value as f32) == value || value.is_nan(), "{value} is no single-precision number");
                self.push(LaneOp::Const((value as f32).to_bits().into()))
            }
            Precision::Double => self.push(LaneOp::Const(value.to_bits())),
        }
    }

    /// The smallest number of the precision that is at least `value`.
    pub fn up(&mut self, value: f64) -> Lane {
        let rounded = match self.precision {
            Precision::Single => crate::interval::round::f32_up(value).into(),
            Precision::Double => value,
        };
        self.number(rounded)
    }

    /// A number nearest to `value`.
    pub fn near(&mut self, value: f64) -> Lane {
        let rounded = match self.precision {
            Precision::Single => f64::from(value as f32),
            Precision::Double => value,
        };
        self.number(rounded)
    }

    pub fn bits(&mut self, value: u64) -> Lane {
        self.push(LaneOp::Bits(value))
    }

    pub fn add(&mut self, a: Lane, b: Lane) -> Lane {
        match (self.as_number(a), self.as_number(b)) {
            (Some(0.0), _) => b,
            (_, Some(0.0)) => a,
            _ => self.push(LaneOp::Add(a, b)),
        }
    }

    pub fn sub(&mut self, a: Lane, b: Lane) -> Lane {
        match (self.as_number(a), self.as_number(b)) {
            (Some(0.0), _) => self.neg(b),
            (_, Some(0.0)) => a,
            _ => self.push(LaneOp::Sub(a, b)),
        }
    }

    pub fn mul(&mut self, a: Lane, b: Lane) -> Lane {
        match (self.as_number(a), self.as_number(b)) {
            (Some(1.0), _) => b,
            (_, Some(1.0)) => a,
            (Some(-1.0), _) => self.neg(b),
            (_, Some(-1.0)) => self.neg(a),
            _ => self.push(LaneOp::Mul(a, b)),
        }
    }

    pub fn div(&mut self, a: Lane, b: Lane) -> Lane {
        self.push(LaneOp::Div(a, b))
    }

    pub fn sqrt(&mut self, a: Lane) -> Lane {
        self.push(LaneOp::Sqrt(a))
    }

    pub fn fma(&mut self, a: Lane, b: Lane, c: Lane) -> Lane {
        self.push(LaneOp::Fma(a, b, c))
    }

    pub fn neg(&mut self, a: Lane) -> Lane {
        match self.ops[a.index()] {
            LaneOp::Neg(b) => b,
            LaneOp::Const(_) => {
                let value = self.as_number(a).expect("a constant has a number");
                self.number(-value)
            }
            _ => self.push(LaneOp::Neg(a)),
        }
    }

    pub fn abs(&mut self, a: Lane) -> Lane {
        self.push(LaneOp::Abs(a))
    }

    pub fn min(&mut self, a: Lane, b: Lane) -> Lane {
        if a == b { a } else { self.push(LaneOp::Min(a, b)) }
    }

    pub fn max(&mut self, a: Lane, b: Lane) -> Lane {
        if a == b { a } else { self.push(LaneOp::Max(a, b)) }
    }

    pub fn floor(&mut self, a: Lane) -> Lane {
        self.push(LaneOp::Floor(a))
    }

    pub fn nearest(&mut self, a: Lane) -> Lane {
        self.push(LaneOp::Nearest(a))
    }

    pub fn select(&mut self, mask: Mask, a: Lane, b: Lane) -> Lane {
        match mask {
            Mask::True => a,
            Mask::False => b,
            Mask::Lane(_) if a == b => a,
            Mask::Lane(m) => self.push(LaneOp::Select(m, a, b)),
        }
    }

    pub fn less(&mut self, a: Lane, b: Lane) -> Mask {
        match (self.as_number(a), self.as_number(b)) {
            (Some(a), Some(b)) => Mask::known(a < b),
            _ => Mask::Lane(self.push(LaneOp::Less(a, b))),
        }
    }

    pub fn less_equal(&mut self, a: Lane, b: Lane) -> Mask {
        match (self.as_number(a), self.as_number(b)) {
            (Some(a), Some(b)) => Mask::known(a <= b),
            _ => Mask::Lane(self.push(LaneOp::LessEqual(a, b))),
        }
    }

    pub fn equal(&mut self, a: Lane, b: Lane) -> Mask {
        match (self.as_number(a), self.as_number(b)) {
            (Some(a), Some(b)) => Mask::known(a == b),
            _ => Mask::Lane(self.push(LaneOp::Equal(a, b))),
        }
    }

    pub fn and(&mut self, a: Mask, b: Mask) -> Mask {
        match (a, b) {
            (Mask::False, _) | (_, Mask::False) => Mask::False,
            (Mask::True, other) | (other, Mask::True) => other,
            (Mask::Lane(a), Mask::Lane(b)) if a == b => Mask::Lane(a),
            (Mask::Lane(a), Mask::Lane(b)) => Mask::Lane(self.push(LaneOp::MaskAnd(a, b))),
        }
    }

    pub fn or(&mut self, a: Mask, b: Mask) -> Mask {
        match (a, b) {
            (Mask::True, _) | (_, Mask::True) => Mask::True,
            (Mask::False, other) | (other, Mask::False) => other,
            (Mask::Lane(a), Mask::Lane(b)) if a == b => Mask::Lane(a),
            (Mask::Lane(a), Mask::Lane(b)) => Mask::Lane(self.push(LaneOp::MaskOr(a, b))),
        }
    }

    pub fn not(&mut self, a: Mask) -> Mask {
        match a {
            Mask::True => Mask::False,
            Mask::False => Mask::True,
            Mask::Lane(a) => Mask::Lane(self.push(LaneOp::MaskNot(a))),
        }
    }

    /// `word` where the mask is set, else 0.
    pub fn bits_where(&mut self, mask: Mask, word: u64) -> Lane {
        match mask {
            Mask::True => self.bits(word),
            Mask::False => self.bits(0),
            Mask::Lane(m) => {
                let mask = self.push(LaneOp::MaskBits(m));
                let word = self.bits(word);
                self.push(LaneOp::BitAnd(mask, word))
            }
        }
    }

    /// The next number above a finite number > 0, below it with `mask` as -1: adds the integer to the bits.
    pub fn add_to_bits(&mut self, number: Lane, integer: Lane) -> Lane {
        let bits = self.push(LaneOp::ToBits(number));
        let sum = self.push(LaneOp::IntAdd(bits, integer));
        self.push(LaneOp::FromBits(sum))
    }
}

impl Mask {
    pub fn known(truth: bool) -> Mask {
        if truth { Mask::True } else { Mask::False }
    }
}

impl fmt::Display for Lane {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "l{}", self.0)
    }
}

/// The textual form that `imp emit interval` prints: one operation a line.
impl fmt::Display for LaneProgram {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = match self.precision {
            Precision::Single => "f32",
            Precision::Double => "f64",
        };
        writeln!(f, "lanes {name}, {} inputs, {} uniforms", self.input_slots, self.uniform_slots)?;
        for (i, &op) in self.ops.iter().enumerate() {
            let debug = format!("{op:?}");
            let mnemonic: String = debug.chars().take_while(|c| c.is_alphanumeric()).collect();
            write!(f, "{} = {}", Lane(i as u32), mnemonic.to_lowercase())?;
            match op {
                LaneOp::Input(slot) | LaneOp::Uniform(slot) => write!(f, " {slot}")?,
                LaneOp::Const(bits) if self.precision == Precision::Single => {
                    write!(f, " {:?}", f32::from_bits(bits as u32))?;
                }
                LaneOp::Const(bits) => write!(f, " {:?}", f64::from_bits(bits))?,
                LaneOp::Bits(bits) => write!(f, " {bits:#x}")?,
                _ => {
                    let operands: Vec<String> = op.operands().map(|lane| lane.to_string()).collect();
                    write!(f, " {}", operands.join(", "))?;
                }
            }
            if let LaneOp::ShiftLeft(_, n) | LaneOp::ShiftRight(_, n) = op {
                write!(f, ", {n}")?;
            }
            writeln!(f)?;
        }
        for (slot, lane) in self.outputs.iter().enumerate() {
            writeln!(f, "out {slot} = {lane}")?;
        }
        Ok(())
    }
}
