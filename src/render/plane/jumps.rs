//! Jumps taken out of a formula: each step function becomes an input, a number that is constant between its jumps.
//!
//! On a box where floor(g) takes the values 2 and 3 alone, the zeros of a field with that floor in it are zeros of the
//! field with 2 or with 3 in its place, both of them continuous. So the enclosure across the jump, which fills the
//! gap between the branches, is never needed.

use std::collections::HashMap;

use num_rational::BigRational;
use num_traits::One;
use num_traits::Signed;
use num_traits::Zero;

use crate::graph::Graph;
use crate::graph::Op;
use crate::graph::Value;

/// Step functions beyond which a formula is left as it is.
const MOST: usize = 8;

/// The step functions of formulas, and the inputs that stand for them.
#[derive(Debug, Default)]
pub struct Jumps {
    /// The step function as it is, and the input's name.
    pub steps: Vec<(Value, String)>,
    inputs: HashMap<Value, Value>,
}

impl Jumps {
    /// `root` with its step functions replaced by inputs; as it is if there are too many of them.
    pub fn take_out(&mut self, graph: &mut Graph, root: Value) -> Value {
        let before = self.steps.len();
        let floors = floors(graph, root);
        let needed = graph.reachable(&[root]);
        let mut image: Vec<Value> = (0..=root.0).map(Value).collect();
        for index in 0..=root.index() {
            let value = Value(index as u32);
            let node = *graph.node(value);
            if !needed[index] || node.op.arity() == 0 {
                continue;
            }
            let operands: Vec<Value> = node.operands().iter().map(|v| image[v.index()]).collect();
            image[index] = match node.op {
                Op::Floor => self.floor(graph, value, &floors),
                Op::Ceil | Op::Round | Op::Sign => self.input(graph, value),
                Op::Mod => {
                    // x - y floor(x / y), the definition.
                    let ratio = graph.div(node.operands()[0], node.operands()[1]);
                    let whole = graph.unary(Op::Floor, ratio);
                    let count = self.floor(graph, whole, &floors);
                    let multiple = graph.mul(operands[1], count);
                    graph.sub(operands[0], multiple)
                }
                Op::Less | Op::LessEqual | Op::Equal => {
                    // By its form a truth value again, which selections need.
                    let truth = self.input(graph, value);
                    let half = graph.constant(BigRational::new(1.into(), 2.into()));
                    graph.push(Op::Less, &[half, truth])
                }
                op => graph.push(op, &operands),
            };
            if self.steps.len() > MOST {
                let dropped = self.steps.split_off(before);
                self.inputs.retain(|step, _| dropped.iter().all(|(other, _)| other != step));
                return root;
            }
        }
        image[root.index()]
    }

    /// The input for a floor, or what says it by a finer one: floor(g) = floor(floor(n g) / n). So floors that jump together
    /// are not taken for independent.
    fn floor(&mut self, graph: &mut Graph, value: Value, floors: &[Floor]) -> Value {
        let Some(own) = floors.iter().find(|floor| floor.value == value) else { return self.input(graph, value) };
        let ratios =
            floors.iter().filter(|floor| floor.base == own.base).map(|floor| (&floor.factor / &own.factor, floor));
        let finer = ratios.filter(|(ratio, _)| ratio.is_integer() && ratio.is_positive());
        let Some((ratio, finest)) = finer.max_by(|a, b| a.0.cmp(&b.0)) else { return self.input(graph, value) };
        let count = self.input(graph, finest.value);
        if ratio <= BigRational::from_integer(1.into()) {
            return count;
        }
        let ratio = graph.constant(ratio);
        let share = graph.div(count, ratio);
        graph.unary(Op::Floor, share)
    }

    fn input(&mut self, graph: &mut Graph, step: Value) -> Value {
        if let Some(&input) = self.inputs.get(&step) {
            return input;
        }
        let name = step_name(self.steps.len());
        let input = graph.var(&name);
        self.steps.push((step, name));
        self.inputs.insert(step, input);
        input
    }
}

/// floor(factor base)
struct Floor {
    value: Value,
    factor: BigRational,
    base: Value,
}

/// The floors that `root` needs, those in remainders included.
fn floors(graph: &mut Graph, root: Value) -> Vec<Floor> {
    let needed = graph.reachable(&[root]);
    let mut found = Vec::new();
    for index in (0..=root.index()).filter(|&index| needed[index]) {
        let value = Value(index as u32);
        let node = *graph.node(value);
        let value = match node.op {
            Op::Floor => value,
            Op::Mod => {
                let ratio = graph.div(node.operands()[0], node.operands()[1]);
                graph.unary(Op::Floor, ratio)
            }
            _ => continue,
        };
        let argument = graph.node(value).operands()[0];
        let node = *graph.node(argument);
        let number = |side: usize| graph.as_constant(node.operands()[side]).filter(|number| !number.is_zero()).cloned();
        let (factor, base) = match node.op {
            Op::Mul => match (number(0), number(1)) {
                (Some(factor), _) => (factor, node.operands()[1]),
                (None, Some(factor)) => (factor, node.operands()[0]),
                (None, None) => (BigRational::one(), argument),
            },
            Op::Div => match number(1) {
                Some(divisor) => (divisor.recip(), node.operands()[0]),
                None => (BigRational::one(), argument),
            },
            _ => (BigRational::one(), argument),
        };
        found.push(Floor { value, factor, base });
    }
    found
}

/// The name of the input for a step function; no parameter has a name with a blank in it.
pub fn step_name(step: usize) -> String {
    format!("step {step}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floors_that_jump_together_have_one_input() {
        let mut graph = Graph::new();
        let x = graph.var("x");
        let (two, three) = (graph.int(2), graph.int(3));
        let twice = graph.mul(two, x);
        let back = graph.neg(x);
        let parts = [x, twice, back].map(|argument| graph.unary(Op::Floor, argument));
        let rest = graph.push(Op::Mod, &[x, three]);
        let sum = [parts[1], parts[2], rest].into_iter().fold(parts[0], |sum, part| graph.add(sum, part));
        let mut jumps = Jumps::default();
        let taken = jumps.take_out(&mut graph, sum);
        // floor(2x), from which floor(x) and floor(x / 3) follow, and floor(-x).
        let steps: Vec<Value> = jumps.steps.iter().map(|&(step, _)| step).collect();
        assert_eq!(steps, [parts[1], parts[2]]);
        let needed = graph.reachable(&[taken]);
        let left = graph.iter().filter(|(v, node)| needed[v.index()] && node.op == Op::Mod).count();
        assert_eq!(left, 0);
    }
}
