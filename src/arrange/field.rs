//! What an arrangement is made of: the scene's curves as unions of components, zero sets that interval methods can settle.

use std::collections::HashMap;

use crate::arrange::exact::Algebra;
use crate::arrange::exact::Polynomial;
use crate::arrange::exact::coprime_base;
use crate::arrange::functions::Functions;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::graph::Graph;
use crate::graph::Value;
use crate::interval::Interval;
use crate::kernel::Backend;
use crate::passes::zero_set::zero_set;
use crate::program::scene::COORDINATES;
use crate::program::scene::Scene;

pub use crate::arrange::functions::Function;
pub use crate::arrange::functions::Sample;

/// A zero set that no other component shares: the scene's curves are unions of components.
#[derive(Debug, Clone, PartialEq)]
pub struct Component {
    pub function: Function,
    pub uses: Vec<Use>,
}

/// A curve that a component belongs to, where a condition holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Use {
    /// Index of the scene's shape.
    pub curve: u16,
    /// A truth value (0 or 1) that must be 1; `None` if there is no condition.
    pub condition: Option<Function>,
    /// Functions at whose zeros the condition may change.
    pub atoms: Vec<Function>,
}

/// All functions of an arrangement, compiled.
pub struct Fields {
    pub domain: [Interval; 2],
    pub curves: Vec<String>,
    /// The fields of the scene's shapes as written, by shape: their signs are those of faces.
    pub shapes: Vec<Function>,
    pub components: Vec<Component>,
    /// By component: the place of its polynomial in `algebra`, if it is one over the rationals.
    pub polynomials: Vec<Option<usize>>,
    /// By component: components of one pencil differ by a constant and have no point in common.
    pub pencils: Vec<Option<u32>>,
    pub algebra: Algebra,
    /// The formulas of the functions, and the graph that they live in.
    pub graph: Graph,
    pub formulas: Vec<Value>,
    functions: Functions,
}

impl Fields {
    /// Compiles what an arrangement of the scene needs.
    ///
    /// # Errors
    /// If the scene is not one of plane curves in a bounded domain, or the backend fails.
    pub fn new(scene: &Scene, backend: &dyn Backend) -> Result<Self, Diagnostic> {
        let domain = domain(scene)?;
        let mut graph = scene.graph.clone();
        let range = |name: &String| match COORDINATES.iter().position(|coordinate| coordinate == name) {
            Some(axis) => domain.get(axis).copied().unwrap_or(Interval::ENTIRE),
            None => {
                let parameter = scene.parameters.iter().find(|parameter| parameter.name == *name);
                parameter.map_or(Interval::ENTIRE, |parameter| parameter.value)
            }
        };
        let ranges: Vec<Interval> = graph.variables().iter().map(range).collect();
        let mut table = Table::default();
        let shapes = scene.shapes.iter().map(|shape| table.function(shape.field)).collect();
        let mut zeros: Vec<(Value, Vec<Use>)> = Vec::new();
        for (curve, shape) in scene.shapes.iter().enumerate() {
            for piece in zero_set(&mut graph, shape.field, shape.condition, &ranges) {
                let condition = piece.condition.map(|condition| table.function(condition));
                let atoms = piece.atoms.into_iter().map(|atom| table.function(atom)).collect();
                zeros.push((piece.field, vec![Use { curve: curve as u16, condition, atoms }]));
            }
        }
        let Split { zeros, polynomials, algebra, pencils } = split(&mut graph, zeros);
        let components =
            zeros.into_iter().map(|(field, uses)| Component { function: table.function(field), uses }).collect();
        let formulas = table.formulas;
        let functions = Functions::new(&graph, &formulas, domain, &scene.parameters, backend)?;
        let curves = scene.shapes.iter().map(|shape| shape.name.clone()).collect();
        Ok(Self { domain, curves, shapes, components, polynomials, pencils, algebra, graph, formulas, functions })
    }

    /// Whether two components are known to have no point in common, wherever.
    pub fn are_disjoint(&self, a: u32, b: u32) -> bool {
        let [a, b] = [a, b].map(|component| self.pencils[component as usize]);
        a.is_some() && a == b
    }

    /// Samples of functions on boxes, in the order asked. A point is a box of width 0.
    pub fn evaluate(&self, queries: &[(Function, [Interval; 2])]) -> Vec<Sample> {
        self.functions.evaluate(queries)
    }
}

/// Functions by their formula.
#[derive(Default)]
struct Table {
    formulas: Vec<Value>,
    known: HashMap<Value, Function>,
}

impl Table {
    fn function(&mut self, value: Value) -> Function {
        *self.known.entry(value).or_insert_with(|| {
            self.formulas.push(value);
            self.formulas.len() as Function - 1
        })
    }
}

/// Zero sets without common parts.
struct Split {
    zeros: Vec<(Value, Vec<Use>)>,
    polynomials: Vec<Option<usize>>,
    algebra: Algebra,
    pencils: Vec<Option<u32>>,
}

/// Replaces polynomials by square-free factors that are pairwise coprime, where they are not that already, and unites equal
/// fields: curves that share a part share a component, and no component touches itself all along.
fn split(graph: &mut Graph, zeros: Vec<(Value, Vec<Use>)>) -> Split {
    let read: Vec<Option<Polynomial>> = zeros.iter().map(|(field, _)| Polynomial::from_graph(graph, *field)).collect();
    let mut merged: Vec<(Value, Vec<Use>)> = Vec::new();
    let mut places: HashMap<Value, usize> = HashMap::new();
    let mut add = |merged: &mut Vec<(Value, Vec<Use>)>, field: Value, uses: &[Use]| {
        let place = *places.entry(field).or_insert_with(|| {
            merged.push((field, Vec::new()));
            merged.len() - 1
        });
        for used in uses {
            if !merged[place].1.contains(used) {
                merged[place].1.push(used.clone());
            }
        }
        place
    };
    // Zero polynomials vanish everywhere and have no factors.
    let of_factors: Vec<usize> =
        (0..zeros.len()).filter(|&index| read[index].as_ref().is_some_and(|poly| !poly.is_zero())).collect();
    let polys: Vec<Polynomial> = of_factors.iter().filter_map(|&index| read[index].clone()).collect();
    for (index, (field, uses)) in zeros.iter().enumerate() {
        if read[index].as_ref().is_none_or(Polynomial::is_zero) {
            add(&mut merged, *field, uses);
        }
    }
    let mut polynomials: Vec<Option<usize>> = vec![None; merged.len()];
    let mut kept = Vec::new();
    for (factor, divides) in coprime_base(&polys).0 {
        // The formula as it was written is the better one to evaluate.
        let whole = divides.iter().find(|&&(poly, times)| times == 1 && polys[poly].degree() == factor.degree());
        let field = match whole {
            Some(&(poly, _)) => zeros[of_factors[poly]].0,
            None => factor.to_graph(graph),
        };
        for (poly, _) in divides {
            add(&mut merged, field, &zeros[of_factors[poly]].1);
        }
        polynomials.resize(merged.len(), Some(kept.len()));
        kept.push(factor);
    }
    let mut shapes: HashMap<Polynomial, u32> = HashMap::new();
    let pencil = |place: &Option<usize>| {
        let fresh = shapes.len() as u32;
        place.map(|place| *shapes.entry(kept[place].without_constant()).or_insert(fresh))
    };
    let pencils = polynomials.iter().map(pencil).collect();
    Split { zeros: merged, polynomials, algebra: Algebra::new(kept), pencils }
}

/// The domain of a plane scene.
fn domain(scene: &Scene) -> Result<[Interval; 2], Diagnostic> {
    let &[x, y] = &scene.domain[..] else {
        return Err(Diagnostic::error(
            code::DIMENSION,
            "an arrangement is made of plane curves, and this scene has surfaces",
        )
        .help(
            "draw it with `imp render`, or give it a plane domain such as `domain [-2, 2]^2` and curves in x and y",
        ));
    };
    if [x, y].iter().any(|side| !side.is_bounded() || side.width() <= 0.0) {
        return Err(Diagnostic::error(code::NO_EXTENT, "the domain has no extent or no bounds")
            .help("give one such as `domain [-2, 2]^2`"));
    }
    Ok([x, y])
}
