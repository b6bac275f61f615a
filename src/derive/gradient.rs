//! Derivatives, graph to graph. They hold as enclosures in the sense of contract 7: at a kink the hull of the branches
//! (a generalised gradient), across a possible jump the whole line. Where the function is continuous on a box, its
//! increments are therefore enclosed by derivative times step (mean-value form).

use num_integer::Integer;
use num_rational::BigRational;

use crate::graph::Graph;
use crate::graph::Op;
use crate::graph::Value;
use crate::limits::Budget;
use crate::limits::Exceeded;
use crate::limits::Limits;

/// The derivative of `f` by the value `wrt` (an input), all other inputs held fixed. Forward mode: one pass.
pub fn derivative(graph: &mut Graph, f: Value, wrt: Value) -> Value {
    let budget = Budget::new(&Limits::unlimited());
    derivative_within(graph, f, wrt, &budget).unwrap_or_else(|_| unreachable!("there is no limit"))
}

/// The same within limits of time and of nodes.
///
/// # Errors
/// Which limit was exceeded; the graph is then good for nothing.
pub fn derivative_within(graph: &mut Graph, f: Value, wrt: Value, budget: &Budget) -> Result<Value, Exceeded> {
    let needed = graph.reachable(&[f]);
    let zero = graph.int(0);
    let one = graph.int(1);
    let mut slope = vec![zero; needed.len()];
    for index in 0..needed.len().min(f.index() + 1) {
        if !needed[index] {
            continue;
        }
        budget.tick()?;
        budget.nodes(graph.len())?;
        let value = Value(index as u32);
        let operands = graph.node(value).operands().to_vec();
        slope[index] = if value == wrt {
            one
        } else if operands.iter().all(|v| slope[v.index()] == zero) {
            zero
        } else {
            let slopes: Vec<Value> = operands.iter().map(|v| slope[v.index()]).collect();
            Rule { graph, zero }.slope(value, &operands, &slopes)
        };
    }
    Ok(slope[f.index()])
}

/// The partial derivatives of `f` by each of `wrt`.
pub fn gradient(graph: &mut Graph, f: Value, wrt: &[Value]) -> Vec<Value> {
    wrt.iter().map(|&input| derivative(graph, f, input)).collect()
}

/// The same within limits of time and of nodes.
///
/// # Errors
/// As [`derivative_within`].
pub fn gradient_within(graph: &mut Graph, f: Value, wrt: &[Value], budget: &Budget) -> Result<Vec<Value>, Exceeded> {
    wrt.iter().map(|&input| derivative_within(graph, f, input, budget)).collect()
}

/// Chain rule with the zeros left out, so that a formula's gradient has no dead terms.
struct Rule<'g> {
    graph: &'g mut Graph,
    zero: Value,
}

impl Rule<'_> {
    fn slope(&mut self, value: Value, operands: &[Value], slopes: &[Value]) -> Value {
        let op = self.graph.node(value).op;
        match op.arity() {
            0 => match op {
                Op::Entire => value,
                _ => self.zero,
            },
            1 => self.unary(op, value, operands[0], slopes[0]),
            2 => self.binary(op, value, [operands[0], operands[1]], [slopes[0], slopes[1]]),
            _ => self.ternary(op, operands, slopes),
        }
    }

    fn unary(&mut self, op: Op, value: Value, u: Value, du: Value) -> Value {
        let factor = match op {
            Op::Neg => return self.graph.neg(du),
            Op::Sqr => self.scaled(2, u),
            Op::PowInt(n) => {
                let power = self.graph.push(Op::PowInt(n - 1), &[u]);
                self.scaled(n.into(), power)
            }
            Op::PowRatio(p, q) => {
                // x^(p/q - 1) keeps the denominator: gcd(p - q, q) = gcd(p, q) = 1.
                let power = self.graph.push(Op::PowRatio(p - q as i32, q), &[u]);
                let ratio = self.graph.constant(BigRational::new(p.into(), q.into()));
                self.graph.mul(ratio, power)
            }
            Op::Sqrt => {
                let twice = self.scaled(2, value);
                self.reciprocal(twice)
            }
            Op::Cbrt => {
                let square = self.graph.sqr(value);
                let thrice = self.scaled(3, square);
                self.reciprocal(thrice)
            }
            Op::Abs => {
                let minus = self.graph.neg(du);
                return self.graph.push(Op::Kink, &[u, minus, du]);
            }
            Op::Sign => {
                let distance = self.graph.unary(Op::Abs, u);
                return self.flat_where_positive(distance);
            }
            Op::Floor => {
                let above = self.graph.sub(u, value);
                return self.flat_where_positive(above);
            }
            Op::Ceil => {
                let below = self.graph.sub(value, u);
                return self.flat_where_positive(below);
            }
            Op::Round => {
                let off = self.graph.sub(u, value);
                let off = self.graph.unary(Op::Abs, off);
                let half = self.graph.constant(BigRational::new(1.into(), 2.into()));
                let room = self.graph.sub(half, off);
                return self.flat_where_positive(room);
            }
            Op::Exp => value,
            Op::Exp2 => self.times_ln(2, value),
            Op::Exp10 => self.times_ln(10, value),
            Op::Expm1 => self.graph.unary(Op::Exp, u),
            Op::Ln => self.reciprocal(u),
            Op::Log1p => {
                let shifted = self.one_plus(u);
                self.reciprocal(shifted)
            }
            Op::Log2 => {
                let scaled = self.times_ln(2, u);
                self.reciprocal(scaled)
            }
            Op::Log10 => {
                let scaled = self.times_ln(10, u);
                self.reciprocal(scaled)
            }
            Op::Sin => self.graph.unary(Op::Cos, u),
            Op::Cos => {
                let sine = self.graph.unary(Op::Sin, u);
                self.graph.neg(sine)
            }
            Op::Tan => {
                let square = self.graph.sqr(value);
                self.one_plus(square)
            }
            Op::Asin => {
                let root = self.root_of_one_minus_square(u);
                self.reciprocal(root)
            }
            Op::Acos => {
                let root = self.root_of_one_minus_square(u);
                let factor = self.reciprocal(root);
                self.graph.neg(factor)
            }
            Op::Atan => {
                let square = self.graph.sqr(u);
                let sum = self.one_plus(square);
                self.reciprocal(sum)
            }
            Op::Sinh => self.graph.unary(Op::Cosh, u),
            Op::Cosh => self.graph.unary(Op::Sinh, u),
            Op::Tanh => {
                let square = self.graph.sqr(value);
                self.one_minus(square)
            }
            Op::Asinh => {
                let square = self.graph.sqr(u);
                let sum = self.one_plus(square);
                let root = self.graph.unary(Op::Sqrt, sum);
                self.reciprocal(root)
            }
            Op::Acosh => {
                let one = self.graph.int(1);
                let below = self.graph.sub(u, one);
                let above = self.graph.add(u, one);
                let product = self.graph.mul(below, above);
                let root = self.graph.unary(Op::Sqrt, product);
                self.reciprocal(root)
            }
            Op::Atanh => {
                let square = self.graph.sqr(u);
                let difference = self.one_minus(square);
                self.reciprocal(difference)
            }
            Op::Const(_)
            | Op::Var(_)
            | Op::Pi
            | Op::Entire
            | Op::Add
            | Op::Sub
            | Op::Mul
            | Op::Div
            | Op::Min
            | Op::Max
            | Op::Mod
            | Op::Hypot
            | Op::Pow
            | Op::Atan2
            | Op::Less
            | Op::LessEqual
            | Op::Equal
            | Op::Select
            | Op::Kink
            | Op::SelectJump => unreachable!("{} is not unary", op.name()),
        };
        self.product(factor, du)
    }

    fn binary(&mut self, op: Op, value: Value, [u, v]: [Value; 2], [du, dv]: [Value; 2]) -> Value {
        match op {
            Op::Add => self.sum(du, dv),
            Op::Sub => self.difference(du, dv),
            Op::Mul => {
                let left = self.product(du, v);
                let right = self.product(u, dv);
                self.sum(left, right)
            }
            Op::Div => {
                // (u' - (u/v) v') / v
                let correction = self.product(value, dv);
                let numerator = self.difference(du, correction);
                self.graph.div(numerator, v)
            }
            Op::Min | Op::Max => {
                let gap = self.graph.sub(u, v);
                let (below, above) = if op == Op::Min { (du, dv) } else { (dv, du) };
                self.graph.push(Op::Kink, &[gap, below, above])
            }
            Op::Mod => {
                // u - v floor(u/v): smooth where the fraction of u/v is strictly inside (0, 1).
                let quotient = self.graph.div(u, v);
                let whole = self.graph.unary(Op::Floor, quotient);
                let correction = self.product(whole, dv);
                let inside = self.difference(du, correction);
                let fraction = self.graph.sub(quotient, whole);
                let smooth = self.graph.push(Op::Less, &[self.zero, fraction]);
                self.jump_unless(smooth, inside)
            }
            Op::Hypot => {
                let left = self.product(u, du);
                let right = self.product(v, dv);
                let sum = self.sum(left, right);
                self.graph.div(sum, value)
            }
            Op::Pow => {
                // u^v (v' ln u) + v u^(v-1) u'
                let one = self.graph.int(1);
                let lower = self.graph.sub(v, one);
                let power = self.graph.push(Op::Pow, &[u, lower]);
                let factor = self.product(v, power);
                let base_part = self.product(factor, du);
                let exponent_part = if dv == self.zero {
                    self.zero
                } else {
                    let logarithm = self.graph.unary(Op::Ln, u);
                    let factor = self.graph.mul(value, logarithm);
                    self.product(factor, dv)
                };
                self.sum(base_part, exponent_part)
            }
            Op::Atan2 => {
                // atan2(u, v): (u' v - u v') / (u^2 + v^2)
                let left = self.product(du, v);
                let right = self.product(u, dv);
                let numerator = self.difference(left, right);
                let u2 = self.graph.sqr(u);
                let v2 = self.graph.sqr(v);
                let norm = self.graph.add(u2, v2);
                self.graph.div(numerator, norm)
            }
            Op::Less | Op::LessEqual | Op::Equal => {
                let gap = self.graph.sub(u, v);
                let distance = self.graph.unary(Op::Abs, gap);
                self.flat_where_positive(distance)
            }
            _ => unreachable!("{} is not binary", op.name()),
        }
    }

    fn ternary(&mut self, op: Op, operands: &[Value], slopes: &[Value]) -> Value {
        match op {
            Op::Select | Op::SelectJump => self.graph.push(Op::SelectJump, &[operands[0], slopes[1], slopes[2]]),
            Op::Kink => {
                let below = self.graph.push(Op::Less, &[operands[0], self.zero]);
                let above = self.graph.push(Op::Less, &[self.zero, operands[0]]);
                let inner = self.jump_unless(above, slopes[2]);
                self.graph.push(Op::SelectJump, &[below, slopes[1], inner])
            }
            _ => unreachable!("{} is not ternary", op.name()),
        }
    }

    /// `inside` where the truth value `smooth` holds, the whole line where it may not.
    fn jump_unless(&mut self, smooth: Value, inside: Value) -> Value {
        let line = self.graph.push(Op::Entire, &[]);
        self.graph.push(Op::SelectJump, &[smooth, inside, line])
    }

    fn flat_where_positive(&mut self, distance: Value) -> Value {
        let smooth = self.graph.push(Op::Less, &[self.zero, distance]);
        self.jump_unless(smooth, self.zero)
    }

    fn times_ln(&mut self, base: i64, value: Value) -> Value {
        let base = self.graph.int(base);
        let logarithm = self.graph.unary(Op::Ln, base);
        self.graph.mul(logarithm, value)
    }

    fn root_of_one_minus_square(&mut self, u: Value) -> Value {
        let one = self.graph.int(1);
        let below = self.graph.sub(one, u);
        let above = self.graph.add(one, u);
        let product = self.graph.mul(below, above);
        self.graph.unary(Op::Sqrt, product)
    }

    fn one_plus(&mut self, u: Value) -> Value {
        let one = self.graph.int(1);
        self.graph.add(one, u)
    }

    fn one_minus(&mut self, u: Value) -> Value {
        let one = self.graph.int(1);
        self.graph.sub(one, u)
    }

    fn reciprocal(&mut self, u: Value) -> Value {
        let one = self.graph.int(1);
        self.graph.div(one, u)
    }

    fn scaled(&mut self, factor: i64, u: Value) -> Value {
        let factor = self.graph.int(factor);
        self.product(factor, u)
    }

    fn sum(&mut self, a: Value, b: Value) -> Value {
        match (a == self.zero, b == self.zero) {
            (true, _) => b,
            (_, true) => a,
            _ => self.graph.add(a, b),
        }
    }

    fn difference(&mut self, a: Value, b: Value) -> Value {
        match (a == self.zero, b == self.zero) {
            (_, true) => a,
            (true, _) => self.graph.neg(b),
            _ => self.graph.sub(a, b),
        }
    }

    fn product(&mut self, a: Value, b: Value) -> Value {
        match () {
            _ if a == self.zero || b == self.zero => self.zero,
            _ if self.graph.is_one(a) => b,
            _ if self.graph.is_one(b) => a,
            _ => self.graph.mul(a, b),
        }
    }
}

/// `x^(p/q)` reduced to lowest terms is what [`Op::PowRatio`] demands; a helper for whoever builds one.
pub fn power_ratio(graph: &mut Graph, base: Value, p: i32, q: u32) -> Value {
    let divisor = p.unsigned_abs().gcd(&q).max(1);
    let (p, q) = (p / divisor as i32, q / divisor);
    match (p, q) {
        (1, 1) => base,
        (2, 1) => graph.sqr(base),
        (p, 1) => graph.push(Op::PowInt(p), &[base]),
        (1, 2) => graph.unary(Op::Sqrt, base),
        (1, 3) => graph.unary(Op::Cbrt, base),
        (p, q) => graph.push(Op::PowRatio(p, q), &[base]),
    }
}
