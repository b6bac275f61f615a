//! What one operation does to enclosures, and with it what a graph does: the natural interval extension.

use super::Graph;
use super::Node;
use super::Op;
use super::Value;
use crate::interval::Decorated;
use crate::interval::Decoration;
use crate::interval::Interval;

/// The natural extension of one operation: encloses its values at all operands in the given enclosures at which it is
/// defined, and says whether it is defined and continuous at all of them. The operands are as many as the arity.
///
/// # Panics
/// For `Var`: what an input is, only the caller knows.
pub fn apply(graph: &Graph, node: &Node, operands: &[Decorated]) -> Decorated {
    let x = || operands[0];
    let y = || operands[1];
    match node.op {
        Op::Const(id) => Decorated::new(Interval::from_rational(&graph.constants[id as usize])),
        Op::Var(_) => panic!("inputs have no operands to evaluate"),
        Op::PowInt(n) => x().powi(n),
        Op::PowRatio(p, q) => x().pow_rational(p, q),
        Op::Pi => Decorated::new(Interval::PI),
        Op::Entire => Decorated::with(Interval::ENTIRE, Decoration::Def),
        Op::Neg => -x(),
        Op::Sqr => x().sqr(),
        Op::Sqrt => x().sqrt(),
        Op::Cbrt => x().cbrt(),
        Op::Abs => x().abs(),
        Op::Sign => x().sign(),
        Op::Floor => x().floor(),
        Op::Ceil => x().ceil(),
        Op::Round => x().round(),
        Op::Exp => x().exp(),
        Op::Exp2 => x().exp2(),
        Op::Exp10 => x().exp10(),
        Op::Expm1 => x().expm1(),
        Op::Ln => x().ln(),
        Op::Log1p => x().log1p(),
        Op::Log2 => x().log2(),
        Op::Log10 => x().log10(),
        Op::Sin => x().sin(),
        Op::Cos => x().cos(),
        Op::Tan => x().tan(),
        Op::Asin => x().asin(),
        Op::Acos => x().acos(),
        Op::Atan => x().atan(),
        Op::Sinh => x().sinh(),
        Op::Cosh => x().cosh(),
        Op::Tanh => x().tanh(),
        Op::Asinh => x().asinh(),
        Op::Acosh => x().acosh(),
        Op::Atanh => x().atanh(),
        Op::Add => x() + y(),
        Op::Sub => x() - y(),
        Op::Mul => x() * y(),
        Op::Div => x() / y(),
        Op::Min => x().min(y()),
        Op::Max => x().max(y()),
        Op::Mod => x().modulo(y()),
        Op::Hypot => x().hypot(y()),
        Op::Pow => x().pow(y()),
        Op::Atan2 => x().atan2(y()),
        Op::Less => compare(x(), y(), Decorated::less),
        Op::LessEqual => compare(x(), y(), Decorated::less_equal),
        Op::Equal => compare(x(), y(), Decorated::equal),
        Op::Select => select(operands, Interval::hull),
        Op::Kink => kink(operands),
        // Across the jump the difference quotient takes any value.
        Op::SelectJump => select(operands, |_, _| Interval::ENTIRE),
    }
}

/// The truth values of a comparison; none if a side has no value.
fn compare(x: Decorated, y: Decorated, answer: fn(Decorated, Decorated) -> Decorated) -> Decorated {
    let truth = answer(x, y);
    let none = x.interval().is_empty() || y.interval().is_empty();
    if none { Decorated::with(Interval::EMPTY, truth.decoration()) } else { truth }
}

/// One arm where the switch is proved of one sign, else the hull of both: at 0 itself a kink has both slopes.
fn kink(operands: &[Decorated]) -> Decorated {
    let &[switch, below, above] = operands else { unreachable!("a kink has three operands") };
    let side = switch.interval();
    let arm = match () {
        _ if side.is_empty() => Decorated::with(Interval::EMPTY, switch.decoration()),
        _ if side.hi() < 0.0 => below,
        _ if side.lo() > 0.0 => above,
        _ => {
            let hull = below.interval().hull(above.interval());
            Decorated::with(hull, below.decoration().min(above.decoration()).min(Decoration::Def))
        }
    };
    Decorated::with(arm.interval(), arm.decoration().min(switch.decoration()))
}

/// The arm that the condition decides for, with its value and decoration alone; undecided, `undecided` of both arms, and no
/// better than defined. A condition that is nowhere defined leaves nothing.
fn select(operands: &[Decorated], undecided: fn(Interval, Interval) -> Interval) -> Decorated {
    let &[condition, yes, no] = operands else { unreachable!("a selection has three operands") };
    let truth = condition.interval();
    if truth.is_empty() {
        return Decorated::with(Interval::EMPTY, condition.decoration());
    }
    let arm = if truth == Interval::ONE {
        yes
    } else if truth == Interval::ZERO {
        no
    } else {
        let least = condition.decoration().min(yes.decoration()).min(no.decoration()).min(Decoration::Def);
        return Decorated::with(undecided(yes.interval(), no.interval()), least);
    };
    // Where the condition is undefined, so is the selection. Where it is defined on the whole box it has one value there:
    // restricted to the box it is constant, hence continuous, whatever jumps its operands have.
    let condition = match condition.decoration() {
        Decoration::Def => Decoration::Dac,
        other => other,
    };
    Decorated::with(arm.interval(), arm.decoration().min(condition))
}

/// Encloses the roots on a box: `inputs` gives each input's part of it, in the order of [`Graph::variables`].
///
/// # Panics
/// If the number of inputs is not the number of variables.
pub fn enclose(graph: &Graph, roots: &[Value], inputs: &[Decorated]) -> Vec<Decorated> {
    assert_eq!(graph.variables().len(), inputs.len(), "one enclosure for each input");
    let needed = graph.reachable(roots);
    let mut enclosures = vec![Decorated::ILL; graph.len()];
    let mut operands = Vec::with_capacity(3);
    for (value, node) in graph.iter().filter(|(value, _)| needed[value.index()]) {
        operands.clear();
        operands.extend(node.operands().iter().map(|v| enclosures[v.index()]));
        enclosures[value.index()] = match node.op {
            Op::Var(id) => inputs[id as usize],
            _ => apply(graph, node, &operands),
        };
    }
    roots.iter().map(|root| enclosures[root.index()]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::parse;

    fn interval(lo: f64, hi: f64) -> Interval {
        Interval::new(lo, hi).unwrap()
    }

    /// Encloses the output f of a graph in the one input x.
    fn f(text: &str, x: Interval) -> (Interval, Decoration) {
        let graph = parse(text).unwrap();
        let result = enclose(&graph, &[graph.output("f").unwrap()], &[Decorated::new(x)])[0];
        (result.interval(), result.decoration())
    }

    #[test]
    fn natural_extension_of_a_quintic() {
        let text = "v0 = var x\nv1 = const 1/2\nv2 = powi v0, 5\nv3 = mul v1, v2\nout f = v3";
        assert_eq!(f(text, interval(-2.0, 1.0)), (interval(-16.0, 0.5), Decoration::Com));
        assert_eq!(f(text, Interval::EMPTY), (Interval::EMPTY, Decoration::Trv));
        assert_eq!(f(text, Interval::ENTIRE), (Interval::ENTIRE, Decoration::Dac));
    }

    #[test]
    fn constants_are_tight() {
        let (third, decoration) = f("v0 = var x\nv1 = const 1/3\nout f = v1", Interval::ENTIRE);
        assert_eq!((third.lo().next_up(), decoration), (third.hi(), Decoration::Com));
    }

    const SELECT: &str = "v0 = var x\nv1 = const 1\nv2 = less v0, v1\nv3 = ln v0\nv4 = select v2, v1, v3\nout f = v4";

    #[test]
    fn a_decided_selection_is_its_arm() {
        // ln is undefined on this box, and not selected.
        assert_eq!(f(SELECT, interval(-3.0, 0.5)), (Interval::ONE, Decoration::Com));
        let (hi, decoration) = f(SELECT, interval(2.0, 4.0));
        assert!(hi.contains(1.0) && decoration == Decoration::Com);
    }

    #[test]
    fn an_undecided_selection_is_the_hull_and_defined_at_best() {
        let (both, decoration) = f(SELECT, interval(0.5, 2.0));
        assert!(both.contains(1.0) && both.contains(-0.69) && decoration == Decoration::Def);
        let (both, decoration) = f(SELECT, interval(-1.0, 2.0));
        assert!(both.contains(1.0) && decoration == Decoration::Trv);
    }

    #[test]
    fn across_a_jump_the_derivative_is_the_whole_line() {
        let text = SELECT.replace("select", "select_jump");
        assert_eq!(f(&text, interval(0.5, 2.0)), (Interval::ENTIRE, Decoration::Def));
        assert_eq!(f(&text, interval(-3.0, 0.5)), (Interval::ONE, Decoration::Com));
    }

    #[test]
    fn an_undefined_condition_leaves_nothing_or_nothing_known() {
        let text = "v0 = var x\nv1 = const 1\nv2 = sqrt v0\nv3 = less v2, v1\nv4 = select v3, v1, v0\nout f = v4";
        assert_eq!(f(text, interval(-3.0, -2.0)), (Interval::EMPTY, Decoration::Trv));
        assert_eq!(f(text, interval(-3.0, 0.5)), (Interval::ONE, Decoration::Trv));
    }

    #[test]
    fn a_constant_condition_is_continuous_even_over_a_step() {
        let text = "v0 = var x\nv1 = const 9\nv2 = floor v0\nv3 = less v2, v1\nv4 = select v3, v0, v1\nout f = v4";
        assert_eq!(f(text, interval(0.5, 2.5)), (interval(0.5, 2.5), Decoration::Dac));
    }

    #[test]
    fn a_kink_has_both_slopes_where_the_switch_may_be_zero() {
        let text = "v0 = var x\nv1 = const -1\nv2 = const 1\nv3 = kink v0, v1, v2\nout f = v3";
        assert_eq!(f(text, interval(-3.0, -1.0)), (interval(-1.0, -1.0), Decoration::Com));
        assert_eq!(f(text, interval(1.0, 3.0)), (Interval::ONE, Decoration::Com));
        assert_eq!(f(text, interval(0.0, 3.0)), (interval(-1.0, 1.0), Decoration::Def));
        assert_eq!(f(text, Interval::EMPTY), (Interval::EMPTY, Decoration::Trv));
    }
}
