//! The picture, the graph and the counts of the published algorithm's labelled quadtree.

use std::fmt::Write;

use serde::Serialize;

use crate::arrange::export::canvas::Canvas;
use crate::arrange::export::canvas::Entry;
use crate::arrange::export::canvas::INK;
use crate::arrange::export::canvas::PALE;
use crate::arrange::export::canvas::Style;
use crate::arrange::export::canvas::Symbol;
use crate::arrange::export::canvas::UNKNOWN;
use crate::arrange::export::canvas::curve_color;
use crate::arrange::export::drawing::Color;
use crate::arrange::export::drawing::Drawing;
use crate::arrange::export::drawing::Layer;
use crate::arrange::export::drawing::Mark;
use crate::arrange::export::drawing::Shape;
use crate::arrange::published::Graph;
use crate::arrange::published::Region;
use crate::arrange::published::RegionKind;
use crate::interval::Interval;

/// What the algorithm found, for one line of JSON.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Counts {
    /// Regions by kind.
    pub vertices: usize,
    pub edges: usize,
    pub faces: usize,
    pub indeterminate: usize,
    /// Whether the source's claim of exactness applies as far as the graph shows.
    pub exact: bool,
    /// How far curves may have to be distorted for the graph to be theirs, by the source's claim.
    pub delta: f64,
    pub boxes: u64,
    pub ms: f64,
}

impl Counts {
    pub fn new(graph: &Graph, ms: f64) -> Self {
        Self {
            vertices: graph.count(RegionKind::Vertex),
            edges: graph.count(RegionKind::Edge),
            faces: graph.count(RegionKind::Face),
            indeterminate: graph.count(RegionKind::Indeterminate),
            exact: graph.exact(),
            delta: graph.delta(),
            boxes: graph.nodes,
            ms,
        }
    }
}

/// The picture, in the layers `edges`, `boxes`, `unresolved`, `vertices`, `frame` and `labels`.
pub fn draw(graph: &Graph, names: &[String], style: &Style) -> Drawing {
    let mut legend = Entry::curves(names);
    for (color, text) in [(INK, "several curves"), (UNKNOWN, "undecided")] {
        legend.push(Entry { symbol: Symbol::Area(color), text: text.to_owned() });
    }
    let canvas = Canvas::new(graph.domain, style, &legend);
    let mut rings: Vec<Vec<Vec<[f64; 2]>>> = vec![Vec::new(); graph.regions.len()];
    for (leaf, region) in &graph.leaves {
        rings[*region as usize].push(canvas.rectangle(leaf.square.area(graph.domain)));
    }
    let grid: Vec<Vec<[f64; 2]>> = match style.boxes {
        true => rings.iter().flatten().cloned().collect(),
        false => Vec::new(),
    };
    let [mut edges, mut vertices, mut unresolved] = [Vec::new(), Vec::new(), Vec::new()];
    for (region, rings) in graph.regions.iter().zip(rings) {
        let fill = |color: Color| Mark::filled(Shape::Area(rings.clone()), color).titled(title(region, names));
        match region.kind {
            RegionKind::Face => {}
            RegionKind::Edge => edges.push(fill(region.curves.first().map_or(INK, |&curve| curve_color(curve.into())))),
            RegionKind::Indeterminate => unresolved.push(fill(UNKNOWN)),
            RegionKind::Vertex => {
                vertices.push(fill(INK));
                let (centre, radius) = (canvas.pixel(region.area.map(Interval::mid)), 3.4 * canvas.unit);
                vertices.push(Mark::filled(Shape::Disc { centre, radius }, INK).titled(title(region, names)));
            }
        }
    }
    // The outlines of adjacent boxes are drawn twice, which does not show.
    let boxes = vec![Mark::stroked(Shape::Area(grid), PALE, 0.5 * canvas.unit)];
    let caption = format!(
        "as published: {} vertex regions, {} edge regions, {} undecided",
        graph.count(RegionKind::Vertex),
        graph.count(RegionKind::Edge),
        graph.count(RegionKind::Indeterminate),
    );
    let layers = vec![
        Layer { name: "edges", marks: edges },
        Layer { name: "boxes", marks: boxes },
        Layer { name: "unresolved", marks: unresolved },
        Layer { name: "vertices", marks: vertices },
        Layer { name: "frame", marks: canvas.frame() },
        Layer { name: "labels", marks: canvas.labels(&legend, caption) },
    ];
    Drawing { width: style.size.0, height: style.size.1, layers }
}

fn title(region: &Region, names: &[String]) -> String {
    let curves: Vec<&str> = region.curves.iter().map(|&curve| names[usize::from(curve)].as_str()).collect();
    format!("{} of {}", kind(region.kind), curves.join(", "))
}

fn kind(kind: RegionKind) -> &'static str {
    match kind {
        RegionKind::Face => "face",
        RegionKind::Edge => "edge",
        RegionKind::Indeterminate => "undecided",
        RegionKind::Vertex => "vertex",
    }
}

/// Regions and which of them share a side, in the language of Graphviz.
pub fn dot(graph: &Graph) -> String {
    let mut text = "graph regions {\n".to_owned();
    for (index, region) in graph.regions.iter().enumerate() {
        let curves: Vec<String> = region.curves.iter().map(u16::to_string).collect();
        writeln!(text, "  r{index} [kind={}, curves=\"{}\"];", kind(region.kind), curves.join(" "))
            .expect("a string takes all text");
    }
    for [a, b] in &graph.adjacent {
        writeln!(text, "  r{a} -- r{b};").expect("a string takes all text");
    }
    text + "}\n"
}
