//! A shape as a union of systems: each a few equations that hold together where a condition holds.
//!
//! The zero set of a field comes apart into pieces ([`zero_set`]); an equation among the conditions of a piece makes it a
//! system of two, whose solutions are points.

use std::collections::HashMap;

use crate::derive;
use crate::derive::Output;
use crate::derive::Spec;
use crate::graph::Graph;
use crate::graph::Op;
use crate::graph::Totality;
use crate::graph::Value;
use crate::interval::Interval;
use crate::passes::zero_set::zero_set;
use crate::program::scene::COORDINATES;
use crate::program::scene::ShapeKind;
use crate::render::plane::jumps::Jumps;
use crate::render::programs::Orders;
use crate::render::programs::less_half;

/// Equations of a system that are looked at together; the truth of others is part of the condition.
pub const EQUATIONS: usize = 3;

/// Pieces beyond which a zero set is not taken apart.
const PIECES: usize = 12;

/// Equations and what must hold besides.
struct System {
    equations: Vec<Value>,
    /// Truth values, all of which must be 1.
    conditions: Vec<Value>,
}

/// The kernels to be compiled for one system.
pub struct SystemSpec {
    /// Box and steps in; enclosures of each equation and of its gradient, and the verdict of the condition, if there is
    /// one, out.
    pub spec: Spec,
    pub equations: usize,
    pub condition: bool,
    /// For each equation and coordinate, whether the derivative is defined everywhere, kinks and jumps included. The
    /// equation's increments are enclosed by derivative times step only where the derivative is defined.
    pub total: Vec<[bool; 2]>,
    /// The equations' left sides, outputs of a graph, and after them their derivatives by x and y.
    pub formulas: Graph,
}

/// All that is to be compiled to settle single pixels of a shape.
pub struct ShapeSpecs {
    /// Box in, enclosures of the step functions out, and whether each is defined everywhere; `None` if there are none.
    pub steps: Option<(Spec, Vec<bool>)>,
    pub systems: Vec<SystemSpec>,
}

/// Takes a shape apart.
pub fn specs(orders: &Orders) -> ShapeSpecs {
    let (scene, shape) = (orders.scene, orders.shape);
    let mut graph = Graph::new();
    for name in &COORDINATES[..2] {
        graph.var(name);
    }
    let roots: Vec<Value> = [shape.field].into_iter().chain(shape.condition).collect();
    let roots = graph.import(&scene.graph, &roots, &HashMap::new());
    let mut jumps = Jumps::default();
    let field = jumps.take_out(&mut graph, roots[0]);
    let condition = roots.get(1).copied();
    let mut systems = Vec::new();
    if shape.kind == ShapeKind::Equation {
        let range = |name: &String| match COORDINATES.iter().position(|coordinate| coordinate == name) {
            Some(axis) => scene.domain[axis],
            // Kernels are compiled for all values that a parameter can take.
            None => scene.parameters.iter().find(|p| p.name == *name).and_then(|p| p.range).unwrap_or(Interval::ENTIRE),
        };
        let inputs: Vec<Interval> = graph.variables().iter().map(range).collect();
        let pieces = zero_set(&mut graph, field, condition, &inputs);
        if pieces.len() <= PIECES {
            for piece in pieces {
                systems.extend(split(&mut graph, &mut jumps, piece.field, piece.condition));
            }
        }
        if systems.is_empty() || systems.len() > PIECES {
            systems = split(&mut graph, &mut jumps, field, condition);
        }
    } else {
        systems.push(System { equations: vec![field], conditions: condition.into_iter().collect() });
    }
    let names: Vec<String> = jumps.steps.iter().map(|(_, name)| name.clone()).collect();
    let steps = (!names.is_empty()).then(|| {
        // The graph has the inputs of the other kernels, which these do not need.
        let mut own = Graph::new();
        let roots: Vec<Value> = jumps.steps.iter().map(|&(step, _)| step).collect();
        let images = own.import(&graph, &roots, &HashMap::new());
        let total = images.iter().map(|&step| is_total(&own, step)).collect();
        (orders.boxes(own, &[], images.into_iter().map(Output::Enclosure).collect()), total)
    });
    let systems = systems.into_iter().map(|system| order(orders, &graph, system, &names)).collect();
    ShapeSpecs { steps, systems }
}

/// The systems of a piece: an equation among its conditions joins the field's.
fn split(graph: &mut Graph, jumps: &mut Jumps, field: Value, condition: Option<Value>) -> Vec<System> {
    let cases = condition.map_or(vec![Vec::new()], |condition| alternatives(graph, condition));
    let system = |conjuncts: Vec<Value>| {
        let mut system = System { equations: vec![field], conditions: Vec::new() };
        for conjunct in conjuncts {
            let node = *graph.node(conjunct);
            if node.op == Op::Equal && system.equations.len() < EQUATIONS {
                let difference = graph.sub(node.operands()[0], node.operands()[1]);
                system.equations.push(jumps.take_out(graph, difference));
            } else {
                system.conditions.push(conjunct);
            }
        }
        system.equations.dedup();
        system
    };
    cases.into_iter().map(system).collect()
}

/// A condition as alternatives of conditions that hold together, as far as equations are among them.
fn alternatives(graph: &Graph, condition: Value) -> Vec<Vec<Value>> {
    let node = graph.node(condition);
    let needed = graph.reachable(&[condition]);
    let equation = graph.iter().any(|(v, node)| needed[v.index()] && node.op == Op::Equal);
    match node.op {
        Op::Min if equation => {
            let [left, right] = [0, 1].map(|side| alternatives(graph, node.operands()[side]));
            if left.len() * right.len() > PIECES {
                return vec![vec![condition]];
            }
            let both = |a: &Vec<Value>| right.iter().map(|b| a.iter().chain(b).copied().collect()).collect::<Vec<_>>();
            left.iter().flat_map(both).collect()
        }
        Op::Max if equation => {
            let cases: Vec<Vec<Value>> =
                node.operands().iter().flat_map(|&operand| alternatives(graph, operand)).collect();
            if cases.len() > PIECES { vec![vec![condition]] } else { cases }
        }
        _ => vec![vec![condition]],
    }
}

fn order(orders: &Orders, source: &Graph, system: System, steps: &[String]) -> SystemSpec {
    let mut graph = Graph::new();
    let coordinates = [0, 1].map(|axis| graph.var(COORDINATES[axis]));
    for name in steps {
        graph.var(name);
    }
    let equations = graph.import(source, &system.equations, &HashMap::new());
    let conditions = graph.import(source, &system.conditions, &HashMap::new());
    let mut outputs = Vec::new();
    let mut total = Vec::new();
    for &equation in &equations {
        let slopes = derive::gradient(&mut graph, equation, &coordinates);
        total.push([is_total(&graph, slopes[0]), is_total(&graph, slopes[1])]);
        outputs.extend([equation, slopes[0], slopes[1]].map(Output::Enclosure));
    }
    let condition = conditions.into_iter().reduce(|a, b| graph.push(Op::Min, &[a, b]));
    outputs.extend(condition.map(|condition| Output::Verdict(less_half(&mut graph, condition))));
    let spec = orders.boxes(graph, steps, outputs);
    let mut formulas = Graph::new();
    let coordinates = [0, 1].map(|axis| formulas.var(COORDINATES[axis]));
    let mut values = formulas.import(source, &system.equations, &HashMap::new());
    for equation in values.clone() {
        values.extend(derive::gradient(&mut formulas, equation, &coordinates));
    }
    for (index, value) in values.into_iter().enumerate() {
        formulas.add_output(index.to_string(), value);
    }
    SystemSpec { formulas, spec, equations: equations.len(), condition: condition.is_some(), total }
}

/// Whether no operation of the value can be undefined.
fn is_total(graph: &Graph, value: Value) -> bool {
    let needed = graph.reachable(&[value]);
    graph.iter().filter(|(v, _)| needed[v.index()]).all(|(_, node)| match (node.op, node.op.totality()) {
        (Op::Div, _) => graph.as_constant(node.operands()[1]).is_some() && !graph.is_zero(node.operands()[1]),
        (_, Totality::Continuous | Totality::Jumps) => true,
        (_, Totality::Partial | Totality::PartialJumps) => false,
    })
}
