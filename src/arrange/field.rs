//! What an arrangement is made of: the scene's curves as unions of components, zero sets that interval methods can settle.

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
        let mut formulas: Vec<Value> = scene.shapes.iter().map(|shape| shape.field).collect();
        let shapes = (0..formulas.len() as Function).collect();
        let mut function = |value: Value| {
            let known = formulas.iter().position(|&formula| formula == value);
            known.unwrap_or_else(|| {
                formulas.push(value);
                formulas.len() - 1
            }) as Function
        };
        let mut components: Vec<Component> = Vec::new();
        for (curve, shape) in scene.shapes.iter().enumerate() {
            for piece in zero_set(&mut graph, shape.field, shape.condition, &ranges) {
                let used = Use {
                    curve: curve as u16,
                    condition: piece.condition.map(&mut function),
                    atoms: piece.atoms.into_iter().map(&mut function).collect(),
                };
                let field = function(piece.field);
                match components.iter_mut().find(|component| component.function == field) {
                    Some(component) => component.uses.push(used),
                    None => components.push(Component { function: field, uses: vec![used] }),
                }
            }
        }
        let functions = Functions::new(&graph, &formulas, domain, &scene.parameters, backend)?;
        let curves = scene.shapes.iter().map(|shape| shape.name.clone()).collect();
        Ok(Self { domain, curves, shapes, components, graph, formulas, functions })
    }

    /// Samples of functions on boxes, in the order asked. A point is a box of width 0.
    pub fn evaluate(&self, queries: &[(Function, [Interval; 2])]) -> Vec<Sample> {
        self.functions.evaluate(queries)
    }
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
