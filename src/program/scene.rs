//! What a source file means: formulas in one graph, and everything else that a picture needs.

use crate::diagnostic::Span;
use crate::graph::Graph;
use crate::graph::Value;
use crate::interval::Interval;

/// The coordinates in the order of a domain's ranges; a plane scene uses the first two. They are inputs of the graph
/// under these names.
pub const COORDINATES: [&str; 3] = ["x", "y", "z"];

/// A resolved file. All formulas live in `graph`, whose inputs are the coordinates, the parameters and the time `t`.
#[derive(Debug, Clone)]
pub struct Scene {
    pub graph: Graph,
    pub shapes: Vec<Shape>,
    /// Declared parameters in source order, with `t` last if a formula uses it.
    pub parameters: Vec<Parameter>,
    /// One range per coordinate, 2 or 3 of them; outward hull of what was written, or a box around the shapes, or [-4, 4]^n
    /// if they are not known to be bounded.
    pub domain: Vec<Interval>,
    /// Whether the file gave a domain.
    pub domain_given: bool,
    pub view: View,
}

impl Scene {
    /// 2 for a scene of plane curves, 3 for surfaces.
    pub fn dimension(&self) -> usize {
        self.domain.len()
    }
}

#[derive(Debug, Clone)]
pub struct Shape {
    /// The given name, or `surface1`, `curve2`, ... by position.
    pub name: String,
    pub kind: ShapeKind,
    /// An equation's shape is where this is 0; a region is where it is <= 0 (its inside), whichever way it was written.
    pub field: Value,
    /// A truth value (0 or 1) that must be 1 for a point to belong to the shape.
    pub condition: Option<Value>,
    pub span: Span,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ShapeKind {
    /// The zero set of the field.
    Equation,
    /// The solid or plane region where the field is at most 0 (or below 0: the boundary is the same picture).
    Region,
}

/// A kernel argument: changing it recompiles nothing.
#[derive(Debug, Clone)]
pub struct Parameter {
    pub name: String,
    /// Encloses the written value.
    pub value: Interval,
    /// The range it may be set in; kernels are compiled for the whole of it. `None` is all reals.
    pub range: Option<Interval>,
}

/// Everything optional about the picture; `None` leaves the choice to the renderer.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct View {
    pub camera: CameraSettings,
    /// Directions towards the lights with their colour; `None` gives the default light, an empty list no light at all.
    pub lights: Option<Vec<Light>>,
    pub material: Option<Material>,
    /// Materials of single shapes, by index into [`Scene::shapes`]; they replace the general one.
    pub materials: Vec<(usize, Material)>,
    /// RGB in 0..1.
    pub background: Option<[f64; 3]>,
}

#[derive(Debug, Clone, Default, PartialEq)]
pub struct CameraSettings {
    pub position: Option<[f64; 3]>,
    pub target: Option<[f64; 3]>,
    pub up: Option<[f64; 3]>,
    /// Vertical field of view in degrees.
    pub fov: Option<f64>,
    pub projection: Option<Projection>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Projection {
    Perspective,
    Orthographic,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Light {
    pub placement: LightPlacement,
    /// RGB, 1 is full strength.
    pub color: [f64; 3],
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LightPlacement {
    /// From infinity; the vector points towards the light.
    Direction([f64; 3]),
    /// A point in the scene.
    Position([f64; 3]),
}

/// Phong coefficients; colours are RGB in 0..1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    pub color: [f64; 3],
    pub ambient: f64,
    pub diffuse: f64,
    pub specular: f64,
    pub shininess: f64,
}

/// A light grey with a soft highlight.
impl Default for Material {
    fn default() -> Self {
        Self { color: [0.75; 3], ambient: 0.15, diffuse: 0.8, specular: 0.25, shininess: 32.0 }
    }
}
