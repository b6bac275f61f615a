//! The searches, asked by text.

use imp::codegen::Compiler;
use imp::control::Control;
use imp::graph::Graph;
use imp::graph::Value;
use imp::interpret::Interpreter;
use imp::interval::Decorated;
use imp::interval::Interval;
use imp::kernel::Backend;
use imp::roots::Options;
use imp::roots::Roots;
use imp::roots::Search;
use imp::roots::Solver;
use imp::session::expression::Expression;
use imp::session::expression::Reading;
use imp::session::expression::Snippet;
use imp::session::expression::Workspace;

/// Who searches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Finder {
    Reference,
    Compiled,
    Interpreted,
}

impl Finder {
    pub const ALL: [Finder; 3] = [Finder::Reference, Finder::Compiled, Finder::Interpreted];

    /// The zeros of a formula in x.
    pub fn roots(self, text: &str, lo: f64, hi: f64) -> Roots {
        let expression = expression(text);
        self.zeros(&expression.graph, expression.root, interval(lo, hi))
    }

    /// The zeros of a function of x alone.
    pub fn zeros(self, graph: &Graph, f: Value, range: Interval) -> Roots {
        let options = Options::default();
        let backend: &dyn Backend = match self {
            Finder::Reference => {
                let mut graph = graph.clone();
                graph.var("x");
                let boxes = vec![Decorated::ENTIRE; graph.variables().len()];
                let variable = graph.variables().iter().position(|name| name == "x").unwrap();
                return Search::new(&graph, f, &boxes, variable).run(range, &options, &Control::default());
            }
            Finder::Compiled => &Compiler,
            Finder::Interpreted => &Interpreter,
        };
        let solver = Solver::new(graph, f, "x", &[], backend).unwrap();
        solver.roots(&[], range, &options, &Control::default())
    }
}

pub fn expression(text: &str) -> Expression {
    let said = Workspace::default().expression(&Snippet::whole("", text), &["x"], Reading::Zero);
    said.unwrap_or_else(|messages| panic!("{text}: {}", messages.render(false)))
}

pub fn interval(lo: f64, hi: f64) -> Interval {
    Interval::new(lo, hi).unwrap()
}
