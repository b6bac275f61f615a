//! Formulas along a ray: the coordinates are replaced by o + t d, so that the ray is part of the kernel.

use std::collections::HashMap;

use crate::derive::gradient::derivative;
use crate::graph::Graph;
use crate::graph::Value;
use crate::program::scene::COORDINATES;

/// The inputs of a formula along a ray: origin, direction, ray parameter. No name of the language has a point in it, so that no
/// parameter can be one of them.
pub const ORIGIN: [&str; 3] = ["ray.ox", "ray.oy", "ray.oz"];
pub const DIRECTION: [&str; 3] = ["ray.dx", "ray.dy", "ray.dz"];
pub const PARAMETER: &str = "ray.t";

/// Formulas of the point turned into formulas of ray and ray parameter.
#[derive(Debug, Clone)]
pub struct RayGraph {
    pub graph: Graph,
    /// The given roots along the ray.
    pub roots: Vec<Value>,
    /// The coordinates as o + t d.
    pub coordinates: Vec<Value>,
    /// The ray parameter.
    pub t: Value,
}

/// Replaces the first `dimension` coordinates by o + t d; other inputs stay.
pub fn along_ray(source: &Graph, roots: &[Value], dimension: usize) -> RayGraph {
    along_line(source, roots, &COORDINATES[..dimension])
}

/// Replaces inputs by the coordinates of o + t d, in their order, at most three; other inputs stay.
pub fn along_line(source: &Graph, roots: &[Value], inputs: &[&str]) -> RayGraph {
    let mut graph = Graph::new();
    let origins: Vec<Value> = ORIGIN[..inputs.len()].iter().map(|name| graph.var(name)).collect();
    let directions: Vec<Value> = DIRECTION[..inputs.len()].iter().map(|name| graph.var(name)).collect();
    let t = graph.var(PARAMETER);
    let mut replace = HashMap::new();
    let mut coordinates = Vec::new();
    for (i, &input) in inputs.iter().enumerate() {
        let step = graph.mul(t, directions[i]);
        let coordinate = graph.add(origins[i], step);
        coordinates.push(coordinate);
        replace.insert(input.to_owned(), coordinate);
    }
    let roots = graph.import(source, roots, &replace);
    RayGraph { graph, roots, coordinates, t }
}

/// The centred form of `f` in the input `wrt`: f(m) + f'(X) (X - m), where m is a further input of the name `centre`
/// that must lie in X. It encloses f on X wherever f is continuous on X (mean-value form, Moore 1966); its natural
/// extension is quadratically convergent in the width of X.
pub fn centred(graph: &mut Graph, f: Value, wrt: Value, centre: &str) -> Value {
    let m = graph.var(centre);
    let slope = derivative(graph, f, wrt);
    let at_centre = graph.substitute(&[f], &HashMap::from([(wrt, m)]))[0];
    let step = graph.sub(wrt, m);
    let change = graph.mul(slope, step);
    graph.add(at_centre, change)
}
