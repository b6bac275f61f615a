//! Scenes built by hand, so that these tests depend on nothing but graph and renderer.

use imp::codegen::Compiler;
use imp::diagnostic::FileId;
use imp::diagnostic::Span;
use imp::graph::Graph;
use imp::graph::Value;
use imp::interpret::Interpreter;
use imp::interval::Interval;
use imp::kernel::Backend;
use imp::program::scene::Scene;
use imp::program::scene::Shape;
use imp::program::scene::ShapeKind;
use imp::program::scene::View;
use imp::render::Control;
use imp::render::Layers;
use imp::render::Options;
use imp::render::Picture;
use imp::render::render;
use num_rational::BigRational;

pub const SPAN: Span = Span { file: FileId(0), start: 0, end: 0 };

/// A scene of one shape in [-2, 2]^3.
pub fn scene(kind: ShapeKind, build: impl FnOnce(&mut Graph, [Value; 3]) -> Value) -> Scene {
    let mut graph = Graph::new();
    let coordinates = ["x", "y", "z"].map(|name| graph.var(name));
    let field = build(&mut graph, coordinates);
    let shape = Shape { name: "surface1".to_owned(), kind, field, condition: None, span: SPAN };
    Scene {
        graph,
        shapes: vec![shape],
        parameters: Vec::new(),
        domain: vec![Interval::new(-2.0, 2.0).unwrap(); 3],
        domain_given: false,
        view: View::default(),
    }
}

pub fn number(graph: &mut Graph, numerator: i64, denominator: i64) -> Value {
    graph.constant(BigRational::new(numerator.into(), denominator.into()))
}

/// x^2 + y^2 + z^2
pub fn square_length(graph: &mut Graph, [x, y, z]: [Value; 3]) -> Value {
    let squares = [x, y, z].map(|c| graph.sqr(c));
    let sum = graph.add(squares[0], squares[1]);
    graph.add(sum, squares[2])
}

pub fn sphere(graph: &mut Graph, p: [Value; 3]) -> Value {
    let square = square_length(graph, p);
    let one = graph.int(1);
    graph.sub(square, one)
}

pub fn options(size: u32) -> Options {
    let layers = Layers { color: true, depth: true, normal: true, certainty: true };
    Options { width: size, height: size, layers, ..Options::default() }
}

pub fn backend() -> Box<dyn Backend> {
    if Compiler::available() { Box::new(Compiler) } else { Box::new(Interpreter) }
}

pub fn draw(scene: &Scene, options: &Options) -> Picture {
    let picture = render(scene, options, backend().as_ref(), &Control::default()).unwrap();
    let stats = &picture.stats;
    assert_eq!(stats.proved + stats.unknown + stats.misses, stats.pixels);
    picture
}
