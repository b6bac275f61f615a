//! Where in the domain a scene's shapes can be: what the automatic camera frames.
//!
//! The domain is halved along all axes, level by level, and cells that the reference arithmetic refutes are dropped. The
//! answer depends on the scene alone, not on a backend, so that a certificate is checked against the same rays; and not on
//! the values of parameters or the time, so that the camera stands still while they change.

use glam::DVec3;

use crate::graph::Value;
use crate::graph::enclose;
use crate::interval::Decorated;
use crate::interval::Interval;
use crate::program::scene::COORDINATES;
use crate::program::scene::Scene;
use crate::program::scene::ShapeKind;

/// Operations spent at most: a few milliseconds.
const BUDGET: usize = 120_000;
/// Cells of 1/32 of the domain: what is left over at the picture's edge is about as thin.
const DEPTH: u32 = 5;

/// A box by its centre and half its size along each axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell {
    pub centre: DVec3,
    pub half: DVec3,
}

/// Cells that cover all shapes of a space scene; the whole domain if nothing is left, or nothing was refuted.
pub fn extent(scene: &Scene) -> Vec<Cell> {
    let low = DVec3::from_array([0, 1, 2].map(|axis| scene.domain[axis].lo()));
    let high = DVec3::from_array([0, 1, 2].map(|axis| scene.domain[axis].hi()));
    let whole = Cell { centre: 0.5 * (low + high), half: 0.5 * (high - low) };
    let roots: Vec<Value> =
        scene.shapes.iter().flat_map(|shape| [Some(shape.field), shape.condition]).flatten().collect();
    let cost = scene.graph.reachable(&roots).iter().filter(|&&needed| needed).count().max(1);
    let mut cells = vec![whole];
    let mut spent = 0;
    for _ in 0..DEPTH {
        spent += 8 * cells.len() * cost;
        if spent > BUDGET {
            break;
        }
        let parts: Vec<Cell> =
            cells.iter().flat_map(|cell| cell.octants()).filter(|cell| may_hold(scene, cell)).collect();
        if parts.is_empty() {
            return vec![whole];
        }
        cells = parts;
    }
    cells
}

impl Cell {
    fn octants(&self) -> [Cell; 8] {
        let half = 0.5 * self.half;
        std::array::from_fn(|i| {
            let side = DVec3::from_array([0, 1, 2].map(|axis| if i >> axis & 1 == 0 { -1.0 } else { 1.0 }));
            Cell { centre: self.centre + side * half, half }
        })
    }
}

/// Whether some shape is not proved to miss the cell.
fn may_hold(scene: &Scene, cell: &Cell) -> bool {
    let range = |axis: usize| {
        let (centre, half) = (cell.centre[axis], cell.half[axis]);
        Interval::new((centre - half).next_down(), (centre + half).next_up()).unwrap_or(Interval::ENTIRE)
    };
    let input = |name: &String| {
        let coordinate = COORDINATES.iter().position(|c| c == name).map(range);
        let parameter = || scene.parameters.iter().find(|parameter| &parameter.name == name)?.range;
        Decorated::new(coordinate.or_else(parameter).unwrap_or(Interval::ENTIRE))
    };
    let inputs: Vec<Decorated> = scene.graph.variables().iter().map(input).collect();
    scene.shapes.iter().any(|shape| {
        let mut roots = vec![shape.field];
        roots.extend(shape.condition);
        let values = enclose(&scene.graph, &roots, &inputs);
        let field = values[0].interval();
        let reached = match shape.kind {
            ShapeKind::Equation => field.contains(0.0),
            ShapeKind::Region => field.lo() <= 0.0,
        };
        reached && values.get(1).is_none_or(|condition| condition.interval().hi() > 0.0)
    })
}
