//! The textual form, one line a node, and the parser that reads it back:
//!
//! ```text
//! v0 = var x
//! v1 = const 1/3
//! v2 = powi v0, 5
//! v3 = mul v1, v2
//! out f = v3
//! ```
//!
//! Every node prints, also one that no output needs. Values are numbered in order, and the parser insists on it, so that
//! the text names exactly the nodes that the graph holds. Empty lines and lines that start with `#` are skipped.

use std::fmt;

use num_rational::BigRational;

use super::Graph;
use super::Node;
use super::Op;
use super::Value;
use super::verify;

/// Why a text is no graph, and the line where that shows, counted from 1.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ParseError {
    pub line: usize,
    pub message: String,
}

impl fmt::Display for ParseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: {}", self.line, self.message)
    }
}

impl std::error::Error for ParseError {}

impl Graph {
    /// One node as its line reads to the right of `=`, e.g. `powi v0, 5`.
    pub fn node_text(&self, node: &Node) -> String {
        let operands = || node.operands().iter().map(Value::to_string).collect::<Vec<_>>().join(", ");
        let name = node.op.name();
        match node.op {
            Op::Const(id) => format!("{name} {}", self.constants[id as usize]),
            Op::Var(id) => format!("{name} {}", self.variables[id as usize]),
            Op::PowInt(n) => format!("{name} {}, {n}", operands()),
            Op::PowRatio(p, q) => format!("{name} {}, {p}/{q}", operands()),
            _ if node.op.arity() == 0 => name.to_owned(),
            _ => format!("{name} {}", operands()),
        }
    }
}

impl fmt::Display for Graph {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (value, node) in self.iter() {
            writeln!(f, "{value} = {}", self.node_text(node))?;
        }
        for (name, value) in &self.outputs {
            writeln!(f, "out {name} = {value}")?;
        }
        Ok(())
    }
}

/// Reads the textual form and verifies the graph.
///
/// # Errors
/// The first line that is not of the form, defines a value out of turn, repeats an earlier node, or the broken invariant
/// of the whole (reported at the last line).
pub fn parse(text: &str) -> Result<Graph, ParseError> {
    let mut graph = Graph::new();
    let mut last = 1;
    for (number, line) in text.lines().enumerate() {
        last = number + 1;
        let line = line.trim();
        if !line.is_empty() && !line.starts_with('#') {
            parse_line(&mut graph, line).map_err(|message| ParseError { line: last, message })?;
        }
    }
    verify(&graph).map_err(|message| ParseError { line: last, message })?;
    Ok(graph)
}

fn parse_line(graph: &mut Graph, line: &str) -> Result<(), String> {
    let (target, definition) =
        line.rsplit_once(" = ").ok_or_else(|| format!("expected `value = operation` or `out name = value`: {line}"))?;
    if let Some(name) = target.strip_prefix("out ") {
        let value = parse_value(graph, definition)?;
        graph.add_output(name.trim(), value);
        return Ok(());
    }
    let expected = Value(graph.len() as u32);
    if target.trim() != expected.to_string() {
        return Err(format!("expected the definition of {expected}, found {}", target.trim()));
    }
    let value = parse_node(graph, definition.trim())?;
    if value != expected { Err(format!("{expected} repeats {value}")) } else { Ok(()) }
}

fn parse_node(graph: &mut Graph, definition: &str) -> Result<Value, String> {
    let (name, rest) = definition.split_once(' ').unwrap_or((definition, ""));
    let mut arguments: Vec<&str> = rest.split(',').map(str::trim).filter(|a| !a.is_empty()).collect();
    let op = match name {
        "var" => {
            let [variable] = arguments[..] else { return Err("var takes one name".to_owned()) };
            return Ok(graph.var(variable));
        }
        "const" => {
            let [number] = arguments[..] else { return Err("const takes one number".to_owned()) };
            let number: BigRational = number.parse().map_err(|_| format!("not a rational number: {number}"))?;
            return Ok(graph.constant(number));
        }
        "powi" => {
            let exponent = arguments.pop().unwrap_or_default();
            Op::PowInt(exponent.parse().map_err(|_| format!("not an exponent: {exponent}"))?)
        }
        "powr" => {
            let exponent = arguments.pop().unwrap_or_default();
            let bad = || format!("not an exponent: {exponent}");
            let (p, q) = exponent.split_once('/').ok_or_else(bad)?;
            Op::PowRatio(p.parse().map_err(|_| bad())?, q.parse().map_err(|_| bad())?)
        }
        _ => Op::from_name(name).ok_or_else(|| format!("no such operation: {name}"))?,
    };
    if arguments.len() != op.arity() {
        return Err(format!("{name} takes {} operands, found {}", op.arity(), arguments.len()));
    }
    let operands = arguments.into_iter().map(|a| parse_value(graph, a)).collect::<Result<Vec<_>, _>>()?;
    Ok(graph.push(op, &operands))
}

fn parse_value(graph: &Graph, text: &str) -> Result<Value, String> {
    let index = text.trim().strip_prefix('v').and_then(|digits| digits.parse::<u32>().ok());
    match index {
        Some(index) if (index as usize) < graph.len() => Ok(Value(index)),
        Some(_) => Err(format!("{} is not defined yet", text.trim())),
        None => Err(format!("not a value: {}", text.trim())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One of every operation, a truth value for the conditions, and an unreachable node.
    fn everything() -> Graph {
        let mut graph = Graph::new();
        let x = graph.var("x");
        let y = graph.var("y'");
        let third = graph.constant(BigRational::new((-1).into(), 3.into()));
        let truth = graph.push(Op::Less, &[x, y]);
        let mut last = graph.push(Op::PowInt(-5), &[x]);
        for op in Op::PLAIN.iter().copied().chain([Op::PowRatio(-2, 3)]) {
            let operands = [[truth, last, third], [last, x, third]][usize::from(op.arity() < 3)];
            last = graph.push(op, &operands[..op.arity()]);
        }
        graph.add_output("f", last);
        graph.add_output("df/dx", third);
        graph
    }

    #[test]
    fn every_operation_reads_back() {
        let graph = everything();
        let text = graph.to_string();
        let read = parse(&text).unwrap();
        assert_eq!(read.to_string(), text);
        assert_eq!(read.nodes, graph.nodes);
        assert_eq!(read.outputs, graph.outputs);
        assert_eq!(read.variables, graph.variables);
    }

    #[test]
    fn errors_name_line_and_problem() {
        for (text, line, part) in [
            ("v0 = var x\nv2 = var y", 2, "expected the definition of v1"),
            ("v0 = var x\n\nv1 = var x", 3, "repeats v0"),
            ("v0 = add v0, v0", 1, "not defined yet"),
            ("v0 = var x\nv1 = add v0", 2, "takes 2 operands, found 1"),
            ("v0 = spin", 1, "no such operation"),
            ("v0 = const 1/0", 1, "not a rational number"),
            ("v0 = var x\nv1 = powr v0, 2", 2, "not an exponent"),
            ("v0 = var x\nv1 = powr v0, 2/4", 2, "not reduced"),
            ("hello", 1, "expected `value = operation`"),
            ("out f = v0", 1, "not defined yet"),
        ] {
            let error = parse(text).unwrap_err();
            assert_eq!(error.line, line, "{text}");
            assert!(error.message.contains(part), "{text}: {error}");
        }
    }
}
