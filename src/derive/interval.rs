//! The natural interval extension, and with it the affine forms, as a lane program.
//!
//! Each graph value becomes a [`Form`]: the ends of its enclosure, two masks (contract 6) and, with affine arithmetic,
//! an AF1 form whose range is intersected with the natural extension. What the bounds over the domain prove once and
//! for all costs nothing per lane: signs choose cheaper products, excluded overflow drops the 0 inf guard, and a
//! value that is defined and continuous on the whole domain carries no mask.

use crate::derive::Arithmetic;
use crate::derive::Output;
use crate::derive::Precision;
use crate::derive::Spec;
use crate::derive::affine;
use crate::derive::affine::Af1;
use crate::derive::affine::Operand;
use crate::derive::elementary;
use crate::derive::ends::Applied;
use crate::derive::ends::Ends;
use crate::derive::ends::Sign;
use crate::derive::lanes::Builder;
use crate::derive::lanes::Lane;
use crate::derive::lanes::LaneOp;
use crate::derive::lanes::LaneProgram;
use crate::derive::lanes::Mask;
use crate::derive::magnitude;
use crate::graph::Node;
use crate::graph::Op;
use crate::graph::Value;
use crate::graph::elementary_function;
use crate::interval::Decorated;
use crate::interval::Decoration;
use crate::interval::Interval;
use crate::limits::Budget;
use crate::limits::Exceeded;

/// Verdict bits, as `kernel::verdict` documents them to consumers.
pub const POSITIVE: u64 = 1;
pub const NEGATIVE: u64 = 2;
pub const EMPTY: u64 = 4;
pub const CONTINUOUS: u64 = 8;

/// A graph value on lanes.
#[derive(Debug, Clone, Copy)]
struct Form {
    ends: Ends,
    /// Undefined on the whole box.
    empty: Mask,
    /// Proved defined and continuous on all of the box.
    continuous: Mask,
    /// The sign that the ends themselves are known to have.
    sign: Sign,
    affine: Option<Af1>,
}

/// Lowers a spec with interval or affine arithmetic.
pub fn lower(
    spec: &Spec,
    bounds: &[Decorated],
    precision: Precision,
    budget: &Budget,
) -> Result<LaneProgram, Exceeded> {
    let magnitudes = magnitude::bounds(spec, bounds, precision);
    let roots: Vec<Value> = spec.outputs.iter().map(|output| output.value()).collect();
    let mut wanted = roots.clone();
    wanted.extend(spec.domain.iter().map(|&(value, _)| value));
    let needed = spec.graph.reachable(&wanted);
    let mut lowering = Lowering {
        spec,
        partial_sums: partial_sums(spec, &needed, &wanted),
        bounds,
        magnitudes: &magnitudes,
        b: Builder::new(precision),
        forms: vec![None; spec.graph.len()],
        outside: Mask::False,
        inside: Mask::True,
    };
    for (value, node) in spec.graph.iter().filter(|(v, _)| needed[v.index()]) {
        budget.tick()?;
        budget.operations(lowering.b.count())?;
        let form = lowering.form(value, node);
        lowering.forms[value.index()] = Some(form);
    }
    let mut outputs = Vec::new();
    for output in &spec.outputs {
        lowering.output(*output, &mut outputs);
    }
    Ok(lowering.b.finish(2 * spec.inputs.len(), 2 * spec.uniforms.len(), outputs))
}

/// The sums that only sums use. Affine arithmetic leaves their ends those of the natural extension: the last sum's form
/// knows all that theirs do.
fn partial_sums(spec: &Spec, needed: &[bool], wanted: &[Value]) -> Vec<bool> {
    let is_sum = |node: &Node| matches!(node.op, Op::Neg | Op::Add | Op::Sub);
    let mut partial: Vec<bool> = spec.graph.iter().map(|(_, node)| is_sum(node)).collect();
    for (_, node) in spec.graph.iter().filter(|(v, node)| needed[v.index()] && !is_sum(node)) {
        node.operands().iter().for_each(|operand| partial[operand.index()] = false);
    }
    wanted.iter().for_each(|value| partial[value.index()] = false);
    partial
}

struct Lowering<'s> {
    spec: &'s Spec,
    /// See [`partial_sums`].
    partial_sums: Vec<bool>,
    bounds: &'s [Decorated],
    /// For every value an upper bound of the computed ends' magnitude; infinite where overflow is not excluded.
    magnitudes: &'s [f64],
    b: Builder,
    forms: Vec<Option<Form>>,
    /// Where the box is proved to lie outside the domain, and inside it.
    outside: Mask,
    inside: Mask,
}

impl Lowering<'_> {
    fn at(&self, value: Value) -> Form {
        self.forms[value.index()].expect("operands are lowered before their users")
    }

    fn form(&mut self, value: Value, node: &Node) -> Form {
        let mut form = match node.op {
            Op::Var(id) => self.input(&self.spec.graph.variables()[id as usize].clone()),
            _ if self.is_constant(node) => self.constant(self.bounds[value.index()]),
            _ => self.operation(value, node),
        };
        for (_, range) in self.spec.domain.iter().filter(|(v, _)| *v == value) {
            form = self.clip(form, *range);
        }
        if self.bounds[value.index()].decoration() >= Decoration::Dac {
            // Over the whole domain, so on every box in it. Outside, the domain's own mask speaks.
            form.continuous = Mask::True;
            form.empty = Mask::False;
        }
        form
    }

    /// Whether the node computes a constant: its operands were lowered to constant ends.
    fn is_constant(&self, node: &Node) -> bool {
        let constant = |v: &Value| {
            let ends = self.at(*v).ends;
            self.b.as_number(ends.nlo).is_some() && self.b.as_number(ends.hi).is_some()
        };
        node.op != Op::Entire && node.operands().iter().all(constant)
    }

    fn constant(&mut self, bound: Decorated) -> Form {
        let interval = bound.interval();
        let (lo, hi) = if interval.is_empty() { (0.0, 0.0) } else { (interval.lo(), interval.hi()) };
        let ends = self.b.constant_ends(lo, hi);
        let sign = match () {
            _ if lo >= 0.0 => Sign::NonNegative,
            _ if hi <= 0.0 => Sign::NonPositive,
            _ => Sign::Unknown,
        };
        Form {
            ends,
            empty: Mask::known(interval.is_empty()),
            continuous: Mask::known(bound.decoration() >= Decoration::Dac),
            sign,
            affine: self.affine(ends),
        }
    }

    /// With affine arithmetic, the form with an error term alone.
    fn affine(&mut self, ends: Ends) -> Option<Af1> {
        (self.spec.arithmetic == Arithmetic::Affine).then(|| affine::from_ends(&mut self.b, ends, None))
    }

    fn input(&mut self, name: &str) -> Form {
        let slot = |list: &[String]| list.iter().position(|n| n == name).map(|i| 2 * i as u32);
        let ends = match (slot(&self.spec.inputs), slot(&self.spec.uniforms)) {
            (Some(i), _) => Ends { nlo: self.b.push(LaneOp::Input(i)), hi: self.b.push(LaneOp::Input(i + 1)) },
            (None, Some(i)) => Ends { nlo: self.b.push(LaneOp::Uniform(i)), hi: self.b.push(LaneOp::Uniform(i + 1)) },
            // Nobody feeds it: anything is possible.
            (None, None) => self.b.entire(),
        };
        // A NaN end stands for the infinite one: Min gives its second operand.
        let infinity = self.b.infinity();
        let promised = self.spec.promises.iter().any(|(n, _)| n == name);
        let ends = match promised {
            true => ends,
            false => Ends { nlo: self.b.min(ends.nlo, infinity), hi: self.b.min(ends.hi, infinity) },
        };
        let symbol = self.spec.symbols.iter().position(|n| n == name);
        let affine = (self.spec.arithmetic == Arithmetic::Affine).then(|| affine::from_ends(&mut self.b, ends, symbol));
        Form { ends, empty: Mask::False, continuous: Mask::True, sign: Sign::Unknown, affine }
    }

    /// Intersects with a range of the domain. Where the two do not meet, the ends are those of a point of the range
    /// and the lane is marked as outside.
    fn clip(&mut self, form: Form, range: Interval) -> Form {
        if range.is_empty() {
            (self.outside, self.inside) = (Mask::True, Mask::False);
            return form;
        }
        let b = &mut self.b;
        let (lo, hi) = (range.lo(), range.hi());
        let upper = b.up(hi);
        let negated_lower = b.up(-lo);
        // Inside must hold for the range itself, so its ends are rounded inward there.
        let inner_upper = {
            let down = b.up(-hi);
            b.neg(down)
        };
        let inner_negated_lower = {
            let down = b.up(lo);
            b.neg(down)
        };
        let lower_side = b.less_equal(form.ends.nlo, inner_negated_lower);
        let upper_side = b.less_equal(form.ends.hi, inner_upper);
        let inside = b.and(lower_side, upper_side);
        self.inside = b.and(self.inside, inside);
        let outer_lower = b.neg(negated_lower);
        let outer_negated_upper = b.neg(upper);
        let below = b.less(form.ends.hi, outer_lower);
        let above = b.less(form.ends.nlo, outer_negated_upper);
        let outside = b.or(below, above);
        self.outside = b.or(self.outside, outside);
        let nlo = b.min(form.ends.nlo, negated_lower);
        let hi = b.min(form.ends.hi, upper);
        let ends = Ends { nlo: b.max(nlo, outer_negated_upper), hi: b.max(hi, outer_lower) };
        let sign = match () {
            _ if range.lo() >= 0.0 => Sign::NonNegative,
            _ if range.hi() <= 0.0 => Sign::NonPositive,
            _ => form.sign,
        };
        Form { ends, sign, ..form }
    }

    /// The ends with the sign that the bounds prove of the value, clamped to it if the ends do not have it already.
    fn signed(&mut self, value: Value) -> (Ends, Sign) {
        let form = self.at(value);
        if form.sign != Sign::Unknown {
            return (form.ends, form.sign);
        }
        let bound = self.bounds[value.index()].interval();
        let zero = self.b.zero();
        match () {
            _ if bound.is_empty() => (form.ends, Sign::Unknown),
            _ if bound.lo() >= 0.0 => {
                (Ends { nlo: self.b.min(form.ends.nlo, zero), hi: self.b.max(form.ends.hi, zero) }, Sign::NonNegative)
            }
            _ if bound.hi() <= 0.0 => {
                (Ends { nlo: self.b.max(form.ends.nlo, zero), hi: self.b.min(form.ends.hi, zero) }, Sign::NonPositive)
            }
            _ => (form.ends, Sign::Unknown),
        }
    }

    fn operation(&mut self, value: Value, node: &Node) -> Form {
        match node.op {
            Op::Select | Op::SelectJump | Op::Kink => return self.choice(node),
            Op::Entire => {
                let ends = self.b.entire();
                let affine = self.affine(ends);
                return Form { ends, empty: Mask::False, continuous: Mask::False, sign: Sign::Unknown, affine };
            }
            _ => {}
        }
        let operands: Vec<Form> = node.operands().iter().map(|&v| self.at(v)).collect();
        let (applied, sign) = self.apply(node, &operands);
        let (mut empty, mut continuous) = (applied.empty, applied.continuous);
        for operand in &operands {
            empty = self.b.or(empty, operand.empty);
            continuous = self.b.and(continuous, operand.continuous);
        }
        let mut form = Form { ends: applied.ends, empty, continuous, sign, affine: None };
        if self.spec.arithmetic == Arithmetic::Affine {
            let operands: Vec<Operand> = operands
                .iter()
                .filter_map(|operand| Some(Operand { form: operand.affine?, ends: operand.ends }))
                .collect();
            match affine::apply(&mut self.b, node.op, &operands, form.ends) {
                Some(af1) => {
                    if !self.partial_sums[value.index()] {
                        // The intersection may lose the sign of a zero end, never the sign.
                        let range = affine::to_ends(&mut self.b, &af1);
                        form.ends = self.b.meet(range, form.ends);
                    }
                    form.affine = Some(af1);
                }
                None => form.affine = self.affine(form.ends),
            }
        }
        form
    }

    /// One operation on ends, and the sign that its ends have by construction.
    fn apply(&mut self, node: &Node, operands: &[Form]) -> (Applied, Sign) {
        let b = &mut self.b;
        let x = operands.first().map(|form| form.ends);
        let sign_x = operands.first().map_or(Sign::Unknown, |form| form.sign);
        let y = operands.get(1).map(|form| form.ends);
        let (x, y) = match (x, y) {
            (Some(x), Some(y)) => (x, y),
            (Some(x), None) => (x, x),
            _ => unreachable!("{} has no operand and is no constant", node.op.name()),
        };
        let applied: Applied = match node.op {
            Op::Neg => b.neg_ends(x).into(),
            Op::Add => {
                let both = (sign_x, operands[1].sign);
                let sign = if both.0 == both.1 { both.0 } else { Sign::Unknown };
                return (b.add_ends(x, y).into(), sign);
            }
            Op::Sub => b.sub_ends(x, y).into(),
            Op::Mul => return self.product(node),
            Op::Sqr => return (b.sqr_ends(x).into(), Sign::NonNegative),
            Op::Abs => return (b.abs_ends(x).into(), Sign::NonNegative),
            Op::Sqrt => return (b.sqrt_applied(x), Sign::NonNegative),
            Op::PowInt(n) => return self.power(node.operands()[0], n),
            Op::Div => return self.quotient(node),
            Op::Min => Ends { nlo: b.max(x.nlo, y.nlo), hi: b.min(x.hi, y.hi) }.into(),
            Op::Max => Ends { nlo: b.min(x.nlo, y.nlo), hi: b.max(x.hi, y.hi) }.into(),
            Op::Hypot => {
                let (x2, y2) = (b.sqr_ends(x), b.sqr_ends(y));
                let sum = b.add_ends(x2, y2);
                return (b.sqrt_applied(sum).ends.into(), Sign::NonNegative);
            }
            Op::Floor => {
                let ends = Ends { nlo: b.push(LaneOp::Ceil(x.nlo)), hi: b.push(LaneOp::Floor(x.hi)) };
                step(b, ends)
            }
            Op::Ceil => {
                let ends = Ends { nlo: b.push(LaneOp::Floor(x.nlo)), hi: b.push(LaneOp::Ceil(x.hi)) };
                step(b, ends)
            }
            Op::Round => {
                let ends = Ends { nlo: b.round(x.nlo), hi: b.round(x.hi) };
                step(b, ends)
            }
            Op::Sign => {
                let ends = Ends { nlo: b.sign(x.nlo), hi: b.sign(x.hi) };
                step(b, ends)
            }
            Op::Mod => modulo(b, x, y),
            Op::Less | Op::LessEqual | Op::Equal => {
                let (proved, refuted) = compare(b, node.op, x, y);
                let decided = b.or(proved, refuted);
                let ends = b.truth_ends(proved, refuted);
                return (Applied { ends, empty: Mask::False, continuous: decided }, Sign::NonNegative);
            }
            Op::PowRatio(..) | elementary_function!() | Op::Pow | Op::Atan2 => {
                let all: Vec<Ends> = operands.iter().map(|form| form.ends).collect();
                elementary::apply(b, node.op, &all)
            }
            Op::Const(_) | Op::Var(_) | Op::Pi | Op::Entire | Op::Select | Op::SelectJump | Op::Kink => {
                unreachable!("{} is lowered elsewhere", node.op.name())
            }
        };
        (applied, Sign::Unknown)
    }

    fn product(&mut self, node: &Node) -> (Applied, Sign) {
        let [x, y] = [node.operands()[0], node.operands()[1]];
        let (a, b) = (self.signed(x), self.signed(y));
        let guarded = !(self.magnitudes[x.index()].is_finite() && self.magnitudes[y.index()].is_finite());
        let sign = match (a.1, b.1) {
            (Sign::Unknown, _) | (_, Sign::Unknown) => Sign::Unknown,
            (a, b) if a == b => Sign::NonNegative,
            _ => Sign::NonPositive,
        };
        (self.b.mul_ends(a, b, guarded).into(), sign)
    }

    fn quotient(&mut self, node: &Node) -> (Applied, Sign) {
        let numerator = self.at(node.operands()[0]).ends;
        let (divisor, sign) = self.signed(node.operands()[1]);
        (self.b.div_applied(numerator, divisor, sign), Sign::Unknown)
    }

    fn power(&mut self, base: Value, n: i32) -> (Applied, Sign) {
        let one = self.b.number(1.0);
        if n == 0 {
            let minus_one = self.b.number(-1.0);
            return (Ends { nlo: minus_one, hi: one }.into(), Sign::NonNegative);
        }
        let (ends, sign) = self.signed(base);
        let power = self.b.power_ends(ends, sign, n.unsigned_abs());
        let sign = if n % 2 == 0 { Sign::NonNegative } else { sign };
        if n > 0 {
            return (power.into(), sign);
        }
        // The power may underflow to a zero end where the base excludes 0: the quotient is then unbounded, still an
        // enclosure, and what is said of domain and continuity is said of the base.
        let minus_one = self.b.number(-1.0);
        let quotient = self.b.div_applied(Ends { nlo: minus_one, hi: one }, power, sign);
        let base = self.at(base).ends;
        let zero = self.b.zero();
        let (low, high) = (self.b.less_equal(base.nlo, zero), self.b.less_equal(base.hi, zero));
        let touches = self.b.contains_zero(base);
        let continuous = self.b.not(touches);
        (Applied { ends: quotient.ends, empty: self.b.and(low, high), continuous }, Sign::Unknown)
    }

    /// `select`, `select_jump`, `kink`: which arm holds, or what an undecided choice gives (contract 7).
    fn choice(&mut self, node: &Node) -> Form {
        let [condition, a, b] = [0, 1, 2].map(|i| self.at(node.operands()[i]));
        let builder = &mut self.b;
        let zero = builder.zero();
        let (first, second) = match node.op {
            Op::Kink => (builder.less(condition.ends.hi, zero), builder.less(condition.ends.nlo, zero)),
            _ => (builder.less(condition.ends.nlo, zero), builder.less_equal(condition.ends.hi, zero)),
        };
        let decided = builder.or(first, second);
        // An arm that is undefined everywhere adds nothing to the hull.
        let both = builder.hull(a.ends, b.ends);
        let both = builder.select_ends(a.empty, b.ends, both);
        let both = builder.select_ends(b.empty, a.ends, both);
        let undecided = if node.op == Op::SelectJump { builder.entire() } else { both };
        let arm = builder.select_ends(first, a.ends, b.ends);
        let ends = builder.select_ends(decided, arm, undecided);
        let arm_empty = builder.choose(first, a.empty, b.empty);
        let both_empty = builder.and(a.empty, b.empty);
        let empty = builder.choose(decided, arm_empty, both_empty);
        let empty = builder.or(empty, condition.empty);
        let arm_continuous = builder.choose(first, a.continuous, b.continuous);
        let continuous = builder.and(decided, arm_continuous);
        let continuous = builder.and(continuous, condition.continuous);
        let affine = self.affine(ends);
        Form { ends, empty, continuous, sign: Sign::Unknown, affine }
    }

    fn output(&mut self, output: Output, slots: &mut Vec<Lane>) {
        let form = self.at(output.value());
        let b = &mut self.b;
        let refutation = matches!(output, Output::Refutation(_));
        let empty = if refutation { form.empty } else { b.or(form.empty, self.outside) };
        if let Output::Enclosure(_) = output {
            // The empty set as both ends at minus infinity: lo = +inf, hi = -inf.
            let nothing = b.number(f64::NEG_INFINITY);
            slots.push(b.select(empty, nothing, form.ends.nlo));
            slots.push(b.select(empty, nothing, form.ends.hi));
        }
        let zero = b.zero();
        let filled = b.not(empty);
        let positive = b.less(form.ends.nlo, zero);
        let negative = b.less(form.ends.hi, zero);
        let inside = if refutation { Mask::False } else { b.and(form.continuous, self.inside) };
        let mut word = b.bits_where(empty, EMPTY);
        for (mask, bit) in [(positive, POSITIVE), (negative, NEGATIVE), (inside, CONTINUOUS)] {
            let mask = b.and(mask, filled);
            let bits = b.bits_where(mask, bit);
            word = b.push(LaneOp::BitOr(word, bits));
        }
        slots.push(word);
    }
}

/// A step function's ends: continuous on the box where both ends lie on one step.
fn step(b: &mut Builder, ends: Ends) -> Applied {
    let low = b.low(ends);
    Applied { ends, empty: Mask::False, continuous: b.equal(low, ends.hi) }
}

/// Where a relation is proved, and where refuted.
fn compare(b: &mut Builder, op: Op, x: Ends, y: Ends) -> (Mask, Mask) {
    let (x_lo, y_lo) = (b.low(x), b.low(y));
    match op {
        Op::Less => (b.less(x.hi, y_lo), b.less_equal(y.hi, x_lo)),
        Op::LessEqual => (b.less_equal(x.hi, y_lo), b.less(y.hi, x_lo)),
        _ => {
            let (left, right) = (b.less_equal(x.hi, y_lo), b.less_equal(y.hi, x_lo));
            let (below, above) = (b.less(x.hi, y_lo), b.less(y.hi, x_lo));
            (b.and(left, right), b.or(below, above))
        }
    }
}

/// x - y floor(x / y), which lies between 0 and y.
fn modulo(b: &mut Builder, x: Ends, y: Ends) -> Applied {
    let zero = b.zero();
    let quotient = b.div_applied(x, y, Sign::Unknown);
    let whole = Ends { nlo: b.push(LaneOp::Ceil(quotient.ends.nlo)), hi: b.push(LaneOp::Floor(quotient.ends.hi)) };
    let whole = step(b, whole);
    let multiple = b.mul_ends((y, Sign::Unknown), (whole.ends, Sign::Unknown), true);
    let difference = b.sub_ends(x, multiple);
    let range = Ends { nlo: b.max(y.nlo, zero), hi: b.max(y.hi, zero) };
    // Infinite x and quotient give NaN here; the range holds (Min gives its second operand).
    let ends = Ends { nlo: b.min(difference.nlo, range.nlo), hi: b.min(difference.hi, range.hi) };
    Applied { ends, empty: quotient.empty, continuous: b.and(quotient.continuous, whole.continuous) }
}

impl Builder {
    /// `a` where the mask is set, else `b`.
    pub fn choose(&mut self, mask: Mask, a: Mask, b: Mask) -> Mask {
        let not = self.not(mask);
        let (left, right) = (self.and(mask, a), self.and(not, b));
        self.or(left, right)
    }

    /// Nearest integer, halves away from zero: x - trunc(x) is exact.
    pub fn round(&mut self, x: Lane) -> Lane {
        let (half, one, minus_one, zero) = (self.number(0.5), self.number(1.0), self.number(-1.0), self.zero());
        let whole = self.push(LaneOp::Trunc(x));
        let rest = self.sub(x, whole);
        let rest = self.abs(rest);
        let up = self.less_equal(half, rest);
        let negative = self.less(x, zero);
        let step = self.select(negative, minus_one, one);
        let step = self.select(up, step, zero);
        self.add(whole, step)
    }

    /// -1, 0 or 1.
    pub fn sign(&mut self, x: Lane) -> Lane {
        let (one, minus_one, zero) = (self.number(1.0), self.number(-1.0), self.zero());
        let (positive, negative) = (self.less(zero, x), self.less(x, zero));
        let below = self.select(negative, minus_one, zero);
        self.select(positive, one, below)
    }
}
