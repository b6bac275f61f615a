//! What holds of every graph. [`verify`] checks all of it:
//!
//! 1. An operand has a smaller index than its user: nodes are in definition order, so no cycle exists.
//! 2. A node has exactly as many operands as its operation's arity; the unused places hold `Node::NONE`.
//! 3. The index of a constant or variable is one that the graph has.
//! 4. Variables have distinct names of visible text, outputs too.
//! 5. The exponent of `PowRatio` is reduced with a denominator of at least 2.
//! 6. No two nodes are equal (hash-consing), no two constants are equal, and the interning tables know each of them.
//! 7. An output names an existing value.
//! 8. The condition of `Select` and `SelectJump` is a truth value (see [`truths`]): 0 or 1 wherever it is defined.

use super::Graph;
use super::Node;
use super::Op;
use super::elementary_function;

/// Checks every invariant; the message names the first node that breaks one.
pub fn verify(graph: &Graph) -> Result<(), String> {
    for (value, node) in graph.iter() {
        let fail = |reason: &str| Err(format!("{value} = {}: {reason}", node.op.name()));
        let (used, unused) = node.operands.split_at(node.op.arity());
        if used.iter().any(|operand| *operand >= value) {
            return fail("an operand is not defined before its user");
        }
        if unused.iter().any(|operand| *operand != Node::NONE) {
            return fail("more operands than the arity");
        }
        match node.op {
            Op::Const(id) if !graph.has_constant(id) => return fail("no such constant"),
            Op::Var(id) if id as usize >= graph.variables.len() => return fail("no such variable"),
            Op::PowRatio(p, q) if q < 2 || num_integer::gcd(p.unsigned_abs(), q) != 1 => {
                return fail("the exponent is not reduced with a denominator of at least 2");
            }
            _ => {}
        }
        if graph.interned.get(node) != Some(&value) {
            return fail("equal to another node, or not interned");
        }
    }
    for (id, number) in graph.constants.iter().enumerate() {
        if graph.constant_ids.get(number) != Some(&(id as u32)) {
            return Err(format!("constant {number} is there twice, or not interned"));
        }
    }
    distinct("variable", graph.variables.iter().map(String::as_str))?;
    distinct("output", graph.outputs.iter().map(|(name, _)| name.as_str()))?;
    if let Some((name, value)) = graph.outputs.iter().find(|(_, value)| value.index() >= graph.len()) {
        return Err(format!("output {name} = {value}: no such value"));
    }
    let truth = truths(graph);
    for (value, node) in graph.iter() {
        if matches!(node.op, Op::Select | Op::SelectJump) && !truth[node.operands()[0].index()] {
            return Err(format!("{value} = {}: the condition is not a truth value", node.op.name()));
        }
    }
    Ok(())
}

fn distinct<'a>(what: &str, names: impl Iterator<Item = &'a str>) -> Result<(), String> {
    let mut seen = std::collections::HashSet::new();
    for name in names {
        if name.trim() != name || name.is_empty() || name.contains('\n') {
            return Err(format!("{what} {name:?}: not a name"));
        }
        if !seen.insert(name) {
            return Err(format!("{what} {name}: there twice"));
        }
    }
    Ok(())
}

/// For every node whether it is by its form a truth value, 0 or 1 wherever it is defined: a comparison; the numbers 0 and
/// 1; minimum, maximum and product of truth values; their powers, absolute value and sign; 1 minus a truth value; a
/// selection whose arms are truth values.
pub fn truths(graph: &Graph) -> Vec<bool> {
    let mut truth: Vec<bool> = Vec::with_capacity(graph.len());
    for (value, node) in graph.iter() {
        let operands = node.operands();
        let is = |i: usize| operands[i] < value && truth[operands[i].index()];
        truth.push(match node.op {
            Op::Less | Op::LessEqual | Op::Equal => true,
            Op::Const(_) => graph.is_zero(value) || graph.is_one(value),
            Op::Sqr | Op::Abs | Op::Sign => is(0),
            Op::PowInt(n) => n >= 0 && is(0),
            Op::Min | Op::Max | Op::Mul => is(0) && is(1),
            Op::Sub => graph.is_one(operands[0]) && is(1),
            Op::Select => is(1) && is(2),
            Op::Var(_)
            | Op::PowRatio(..)
            | Op::Pi
            | Op::Entire
            | Op::Neg
            | Op::Sqrt
            | elementary_function!()
            | Op::Floor
            | Op::Ceil
            | Op::Round
            | Op::Add
            | Op::Div
            | Op::Mod
            | Op::Hypot
            | Op::Pow
            | Op::Atan2
            | Op::Kink
            | Op::SelectJump => false,
        });
    }
    truth
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::Value;

    fn sample() -> Graph {
        let mut graph = Graph::new();
        let x = graph.var("x");
        let y = graph.sqr(x);
        graph.add_output("f", y);
        graph
    }

    /// Each invariant is broken once, and the message tells which.
    #[test]
    fn each_broken_invariant_is_found() {
        assert_eq!(verify(&sample()), Ok(()));
        type Break = fn(&mut Graph);
        let breaks: [(&str, Break); 10] = [
            ("defined before", |g| g.nodes[1].operands[0] = Value(1)),
            ("more operands", |g| g.nodes[1].operands[1] = Value(0)),
            ("no such constant", |g| g.nodes[0].op = Op::Const(0)),
            ("no such variable", |g| g.variables.clear()),
            ("variable x: there twice", |g| g.variables.push("x".into())),
            ("not a name", |g| g.outputs[0].0 = " ".into()),
            ("not reduced", |g| {
                g.push(Op::PowRatio(2, 4), &[Value(0)]);
            }),
            ("equal to another", |g| g.nodes.push(g.nodes[0])),
            ("no such value", |g| g.outputs[0].1 = Value(9)),
            ("not a truth value", |g| {
                g.push(Op::Select, &[Value(0), Value(0), Value(1)]);
            }),
        ];
        for (message, edit) in breaks {
            let mut graph = sample();
            edit(&mut graph);
            let error = verify(&graph).unwrap_err();
            assert!(error.contains(message), "{message}: {error}");
        }
    }

    #[test]
    fn truth_values_are_closed_under_logic() {
        let mut graph = sample();
        let (x, y) = (Value(0), Value(1));
        let less = graph.push(Op::Less, &[x, y]);
        let equal = graph.push(Op::Equal, &[x, y]);
        let one = graph.int(1);
        let not = graph.sub(one, less);
        let and = graph.push(Op::Min, &[not, equal]);
        let or = graph.push(Op::Max, &[and, less]);
        graph.push(Op::Select, &[or, x, y]);
        assert_eq!(verify(&graph), Ok(()));
        let twice = graph.add(less, equal);
        graph.push(Op::Select, &[twice, x, y]);
        assert!(verify(&graph).is_err());
    }
}
