//! Jumps taken out of a formula: each step function becomes an input, a number that is constant between its jumps.
//!
//! On a box where floor(g) takes the values 2 and 3 alone, the zeros of a field with that floor in it are zeros of the
//! field with 2 or with 3 in its place, both of them continuous. So the enclosure across the jump, which fills the
//! gap between the branches, is never needed.

use std::collections::HashMap;

use num_rational::BigRational;

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
                Op::Floor | Op::Ceil | Op::Round | Op::Sign => self.input(graph, value),
                Op::Mod => {
                    // x - y floor(x / y), the definition.
                    let ratio = graph.div(node.operands()[0], node.operands()[1]);
                    let whole = graph.unary(Op::Floor, ratio);
                    let count = self.input(graph, whole);
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

/// The name of the input for a step function; no parameter has a name with a blank in it.
pub fn step_name(step: usize) -> String {
    format!("step {step}")
}
