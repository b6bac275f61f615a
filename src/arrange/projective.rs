//! The whole plane in a box: curves with their points at infinity.
//!
//! The map (u, v) -> (u, v) / (1 - u^2 - v^2) takes the open unit disc to the plane, and its circle to the directions in
//! which points go to infinity. A polynomial f of degree d becomes the polynomial (1 - u^2 - v^2)^d f(x, y), which has on the
//! circle the zeros of f's terms of degree d: the asymptotic directions. Outside the circle the plane appears a second time,
//! turned over.

use num_rational::BigRational;

use crate::arrange::exact::Polynomial;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::graph::Graph;
use crate::graph::Op;
use crate::graph::Value;
use crate::interval::Interval;
use crate::program::scene::COORDINATES;
use crate::program::scene::Scene;
use crate::program::scene::Shape;
use crate::program::scene::ShapeKind;

/// Half the side of the box around the disc.
const REACH: f64 = 1.125;

/// The curves of a scene in the coordinates of the disc, and the circle at infinity as one more curve, `infinity`. The domain
/// of the scene does not count.
///
/// # Errors
/// If a curve is not polynomial with rational coefficients, or has a condition.
pub fn projective(scene: &Scene) -> Result<Scene, Diagnostic> {
    let mut graph = Graph::new();
    let [u, v] = [0, 1].map(|axis| graph.var(COORDINATES[axis]));
    let (one, uu, vv) = (graph.int(1), graph.sqr(u), graph.sqr(v));
    let square = graph.add(uu, vv);
    let w = graph.sub(one, square);
    let mut shapes = Vec::new();
    for shape in &scene.shapes {
        let polynomial = Polynomial::from_graph(&scene.graph, shape.field).filter(|_| shape.condition.is_none());
        let Some(polynomial) = polynomial else {
            let title = format!("`{}` has no points at infinity that are known", shape.name);
            let help = "a projective frame takes polynomial curves with rational coefficients and no conditions";
            return Err(Diagnostic::error(code::BAD_OPTION, title).at(shape.span, "this curve").help(help));
        };
        let field = homogeneous(&mut graph, &polynomial, [u, v, w]);
        shapes.push(Shape { field, ..shape.clone() });
    }
    if let Some(first) = scene.shapes.first() {
        let name = "infinity".to_owned();
        shapes.push(Shape { name, kind: ShapeKind::Equation, field: w, condition: None, span: first.span });
    }
    let side = Interval::new(-REACH, REACH).unwrap_or(Interval::ENTIRE);
    Ok(Scene { graph, shapes, parameters: Vec::new(), domain: vec![side; 2], ..scene.clone() })
}

/// The sum of c u^i v^j w^(d - i - j) over the terms of a polynomial of degree d.
fn homogeneous(graph: &mut Graph, polynomial: &Polynomial, [u, v, w]: [Value; 3]) -> Value {
    let degree = polynomial.degree();
    let power = |graph: &mut Graph, base: Value, exponent: usize| match exponent {
        0 => graph.int(1),
        1 => base,
        2 => graph.sqr(base),
        _ => graph.unary(Op::PowInt(exponent as i32), base),
    };
    let mut sum = graph.int(0);
    for (j, row) in polynomial.rows().iter().enumerate() {
        for (i, coefficient) in row.coefficients().iter().enumerate() {
            let mut term = graph.constant(BigRational::from_integer(coefficient.clone()));
            if graph.is_zero(term) {
                continue;
            }
            for (base, exponent) in [(u, i), (v, j), (w, degree - i - j)] {
                let factor = power(graph, base, exponent);
                term = graph.mul(term, factor);
            }
            sum = graph.add(sum, term);
        }
    }
    sum
}
