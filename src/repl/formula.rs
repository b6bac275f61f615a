//! Graphs as formulas in the notation of the language.

use num_traits::One;
use num_traits::Signed;

use crate::graph::Graph;
use crate::graph::Op;
use crate::graph::Value;

/// Longer formulas are not shown: nobody reads them.
const MAX_LENGTH: usize = 2000;

/// How tightly the outermost operation of a text binds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Relation,
    Sum,
    Product,
    Sign,
    Power,
    Atom,
}

/// The value as a formula, or `None` if it is too long. The derivatives of kinks and jumps, which the language cannot
/// write, appear as calls of `kink(switch, below, above)` and as `entire`.
pub fn formula(graph: &Graph, root: Value) -> Option<String> {
    let needed = graph.reachable(&[root]);
    let mut texts: Vec<(String, Level)> = vec![(String::new(), Level::Atom); graph.len()];
    for (value, node) in graph.iter().filter(|(value, _)| needed[value.index()]) {
        let at = |place: usize, least: Level| {
            let (text, level) = &texts[node.operands()[place].index()];
            if *level < least { format!("({text})") } else { text.clone() }
        };
        let any = |place: usize| at(place, Level::Relation);
        let call = |name: &str, places: usize| {
            let operands: Vec<String> = (0..places).map(any).collect();
            (format!("{name}({})", operands.join(", ")), Level::Atom)
        };
        let text = match node.op {
            Op::Const(_) => constant(graph, value),
            Op::Var(id) => (graph.variables()[id as usize].clone(), Level::Atom),
            Op::Pi | Op::Entire => (node.op.name().to_owned(), Level::Atom),
            Op::Neg => (format!("-{}", at(0, Level::Product)), Level::Sign),
            Op::Sqr => (format!("{}^2", at(0, Level::Atom)), Level::Power),
            Op::PowInt(n) if n < 0 => (format!("{}^({n})", at(0, Level::Atom)), Level::Power),
            Op::PowInt(n) => (format!("{}^{n}", at(0, Level::Atom)), Level::Power),
            Op::PowRatio(p, q) => (format!("{}^({p}/{q})", at(0, Level::Atom)), Level::Power),
            Op::Pow => (format!("{}^{}", at(0, Level::Atom), at(1, Level::Atom)), Level::Power),
            Op::Add => match at(1, Level::Sum) {
                right if right.starts_with('-') => (format!("{} - {}", at(0, Level::Sum), &right[1..]), Level::Sum),
                right => (format!("{} + {right}", at(0, Level::Sum)), Level::Sum),
            },
            Op::Sub => (format!("{} - {}", at(0, Level::Sum), at(1, Level::Product)), Level::Sum),
            // Numbers stand in front.
            Op::Mul if graph.as_constant(node.operands()[1]).is_some() => {
                (format!("{}*{}", at(1, Level::Product), at(0, Level::Power)), Level::Product)
            }
            Op::Mul => (format!("{}*{}", at(0, Level::Product), at(1, Level::Power)), Level::Product),
            Op::Div => (format!("{}/{}", at(0, Level::Product), at(1, Level::Power)), Level::Product),
            Op::Less => (format!("{} < {}", at(0, Level::Sum), at(1, Level::Sum)), Level::Relation),
            Op::LessEqual => (format!("{} <= {}", at(0, Level::Sum), at(1, Level::Sum)), Level::Relation),
            Op::Equal => (format!("{} = {}", at(0, Level::Sum), at(1, Level::Sum)), Level::Relation),
            Op::Select | Op::SelectJump => (format!("(if {} then {} else {})", any(0), any(1), any(2)), Level::Atom),
            op => call(op.name(), op.arity()),
        };
        if text.0.len() > MAX_LENGTH {
            return None;
        }
        texts[value.index()] = text;
    }
    texts.into_iter().nth(root.index()).map(|(text, _)| text)
}

fn constant(graph: &Graph, value: Value) -> (String, Level) {
    let Some(number) = graph.as_constant(value) else { return (String::new(), Level::Atom) };
    let level = match (number.is_negative(), number.denom().is_one()) {
        (true, _) => Level::Sign,
        (false, true) => Level::Atom,
        (false, false) => Level::Product,
    };
    (number.to_string(), level)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interval::Decorated;
    use crate::interval::Interval;
    use crate::session::expression::Bindings;
    use crate::session::expression::Reading;
    use crate::session::expression::Snippet;
    use crate::session::expression::Workspace;

    #[test]
    fn formulas_mean_what_they_came_from() {
        let workspace = Workspace::default();
        let graph = |text: &str| workspace.expression(&Snippet::whole("", text), &["x", "y"], Reading::Value).unwrap();
        for text in [
            "x - (y - 1)",
            "x - (y + 1)",
            "(x + y)*(x - y)",
            "x/(y/x)",
            "x/y*x",
            "-(x + y)",
            "-x*y",
            "(-x)^2",
            "-x^2",
            "(x^2)^3",
            "x^(2/3)",
            "x^-2",
            "2^-x",
            "(1/2)*x",
            "x + -1/3",
            "sin(x + y)^2",
            "if x < y then x else -y",
            "max(x, y + 1)",
            "x*(y*x)",
            "x + (y - 1)",
            "x^(y + 1)",
            "atan2(x, y)",
            "hypot(x, y)",
            "x - -y",
            "pi*x",
        ] {
            let expression = graph(text);
            let again = formula(&expression.graph, expression.root).unwrap();
            let read = graph(&again);
            assert_eq!(again, formula(&read.graph, read.root).unwrap(), "{text}");
            for (x, y) in [(0.7, 1.9), (2.5, 0.3), (1.25, 1.25)] {
                let point = |x| Decorated::new(Interval::point(x));
                let given = Bindings::from([("x".to_owned(), point(x)), ("y".to_owned(), point(y))]);
                let values = [&expression, &read].map(|e| e.enclose(&e.boxes(&given)).interval());
                assert!(!values[0].disjoint(values[1]) && values[0].width() < 1e-12, "{text}: {again}, {values:?}");
            }
        }
    }

    #[test]
    fn long_formulas_are_given_up() {
        let workspace = Workspace::default();
        let text = vec!["sin(x)"; 2000].join(" * x + ");
        let expression = workspace.expression(&Snippet::whole("", &text), &["x"], Reading::Value).unwrap();
        assert_eq!(formula(&expression.graph, expression.root), None);
    }
}
