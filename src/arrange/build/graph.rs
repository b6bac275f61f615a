//! Vertices, edges, and the order of the edges around each vertex.

use crate::arrange::build::frame;
use crate::arrange::build::frame::Step;
use crate::arrange::build::incidence::Arm;
use crate::arrange::build::incidence::Incidence;
use crate::arrange::build::incidence::surrounds;
use crate::arrange::check::Fault;
use crate::arrange::check::ensure;
use crate::arrange::complex::Axis;
use crate::arrange::complex::Complex;
use crate::arrange::complex::Vertex;
use crate::arrange::complex::VertexKind;
use crate::arrange::structure::ArrangedVertex;
use crate::arrange::structure::Arrangement;
use crate::arrange::structure::Edge;
use crate::arrange::structure::EdgeId;
use crate::arrange::structure::EdgeKind;
use crate::arrange::structure::FaceId;
use crate::arrange::structure::Halfedge;
use crate::arrange::structure::HalfedgeId;
use crate::arrange::structure::NO_COMPONENT;
use crate::arrange::structure::Site;
use crate::arrange::structure::VertexId;
use crate::interval::Interval;

/// The graph while it grows.
pub struct Graph<'a> {
    complex: &'a Complex,
    incidence: &'a Incidence<'a>,
    pub vertices: Vec<ArrangedVertex>,
    pub edges: Vec<Edge>,
    /// The edge through each node.
    pub node_edges: Vec<EdgeId>,
    /// The halfedges that start at each vertex, counter-clockwise.
    rotations: Vec<Vec<HalfedgeId>>,
    /// The start of each halfedge, and the face to its left.
    sides: Vec<(VertexId, FaceId)>,
    /// The vertex of each block with one, by cell and block.
    block_vertices: Vec<Vec<Option<VertexId>>>,
    /// The vertex at each node with one.
    node_vertices: Vec<Option<VertexId>>,
    /// The halfedge that starts at a block's vertex and leaves its cell through an arm, by node and side.
    leaving: Vec<[Option<HalfedgeId>; 2]>,
}

/// Where a chain of arcs ends.
enum End {
    /// At the vertex of a block, through this arm of it.
    Block(Arm, VertexId),
    /// At a vertex on the chain's last node.
    Node(VertexId),
}

impl<'a> Graph<'a> {
    /// The graph of a complex.
    ///
    /// # Errors
    /// If the complex breaks an invariant.
    pub fn new(complex: &'a Complex, incidence: &'a Incidence<'a>) -> Result<Self, Fault> {
        let nodes = complex.nodes.len();
        let mut graph = Self {
            complex,
            incidence,
            vertices: Vec::new(),
            edges: Vec::new(),
            node_edges: vec![EdgeId::MAX; nodes],
            rotations: Vec::new(),
            sides: Vec::new(),
            block_vertices: Vec::new(),
            node_vertices: vec![None; nodes],
            leaving: vec![[None; 2]; nodes],
        };
        let steps = frame::walk(complex, incidence)?;
        graph.block_vertices();
        graph.frame_vertices(&steps);
        graph.arms()?;
        graph.closed()?;
        graph.strips();
        graph.frame_edges(&steps);
        Ok(graph)
    }

    /// Next and previous by the rotations: whoever arrives at a vertex goes on along the neighbour of the arriving edge,
    /// clockwise, and so keeps the same face to the left.
    pub fn halfedges(&mut self) -> Result<Vec<Halfedge>, Fault> {
        let none = HalfedgeId::MAX;
        let halfedge = |&(origin, face): &_| Halfedge { origin, next: none, previous: none, face };
        let mut halfedges: Vec<Halfedge> = self.sides.iter().map(halfedge).collect();
        for (vertex, rotation) in self.vertices.iter_mut().zip(&self.rotations) {
            vertex.halfedge = rotation.first().copied();
            for (i, &out) in rotation.iter().enumerate() {
                let before = rotation[(i + rotation.len() - 1) % rotation.len()];
                halfedges[Arrangement::twin(out) as usize].next = before;
                halfedges[before as usize].previous = Arrangement::twin(out);
            }
        }
        let lost = halfedges.iter().position(|h| h.next == none || h.previous == none);
        ensure(lost.is_none(), || format!("halfedge {lost:?} is around no vertex"))?;
        Ok(halfedges)
    }

    fn add_vertex(&mut self, vertex: Vertex, site: Site) -> VertexId {
        self.vertices.push(ArrangedVertex { vertex, site, halfedge: None, face: None });
        self.rotations.push(Vec::new());
        self.vertices.len() as u32 - 1
    }

    /// Adds an edge between two vertices with the faces to its left and right; its first side.
    fn add_edge(&mut self, edge: Edge, ends: [VertexId; 2], faces: [FaceId; 2]) -> HalfedgeId {
        let id = self.edges.len() as EdgeId;
        if edge.kind == EdgeKind::Curve {
            for &node in &edge.nodes {
                self.node_edges[node as usize] = id;
            }
        }
        self.edges.push(edge);
        self.sides.extend([(ends[0], faces[0]), (ends[1], faces[1])]);
        2 * id
    }

    fn block_vertices(&mut self) {
        for (c, cell) in self.complex.cells.iter().enumerate() {
            let mut of_cell = Vec::with_capacity(cell.blocks.len());
            for (b, block) in cell.blocks.iter().enumerate() {
                let site = Site::Block { cell: c as u32, block: b as u32 };
                of_cell.push(block.vertex.as_ref().map(|vertex| self.add_vertex(vertex.clone(), site)));
            }
            self.block_vertices.push(of_cell);
        }
    }

    /// A vertex on a node.
    fn node_vertex(&mut self, n: u32, kind: VertexKind) -> VertexId {
        let node = &self.complex.nodes[n as usize];
        let segment = &self.complex.segments[node.segment as usize];
        let at = Interval::point(segment.at);
        let area = match segment.axis {
            Axis::X => [node.place, at],
            Axis::Y => [at, node.place],
        };
        let vertex = Vertex { kind, area, proved: true, curves: node.curves.clone(), note: None };
        let id = self.add_vertex(vertex, Site::Node(n));
        self.node_vertices[n as usize] = Some(id);
        id
    }

    fn frame_vertices(&mut self, steps: &[Step]) {
        for &step in steps {
            match step {
                Step::Corner(corner) => {
                    let [x, y] = self.complex.domain;
                    let x = if matches!(corner, 1 | 2) { x.hi() } else { x.lo() };
                    let y = if corner >= 2 { y.hi() } else { y.lo() };
                    let (kind, area) = (VertexKind::Corner, [x, y].map(Interval::point));
                    let vertex = Vertex { kind, area, proved: true, curves: Vec::new(), note: None };
                    self.add_vertex(vertex, Site::Corner);
                }
                Step::Node(node) => {
                    self.node_vertex(node, VertexKind::Boundary);
                }
                Step::Segment(..) => {}
            }
        }
    }

    /// All edges that start at the vertex of a block or on the frame, and the rotations of these vertices' arms.
    fn arms(&mut self) -> Result<(), Fault> {
        for v in 0..self.vertices.len() as VertexId {
            match self.vertices[v as usize].site {
                Site::Block { cell, block } => {
                    let incidence = self.incidence;
                    for &arm in incidence.arms[cell as usize][block as usize].iter().flatten() {
                        if self.leaving[arm.0 as usize][arm.1].is_none() {
                            self.trace(v, arm, Some(cell))?;
                        }
                    }
                }
                Site::Node(node) if self.node_edges[node as usize] == EdgeId::MAX => {
                    // One enters the domain, so one leaves the side on which there is no cell.
                    let outer = usize::from(self.incidence.cell((node, 1)).is_none());
                    self.trace(v, (node, outer), None)?;
                }
                Site::Node(_) | Site::Corner => {}
            }
        }
        for (c, blocks) in self.block_vertices.iter().enumerate() {
            for (b, v) in blocks.iter().enumerate().filter_map(|(b, v)| v.map(|v| (b, v))) {
                let outer = &self.incidence.arms[c][b][0];
                self.rotations[v as usize] =
                    outer.iter().filter_map(|&(node, side)| self.leaving[node as usize][side]).collect();
            }
        }
        Ok(())
    }

    /// One edge of each closed curve without vertices, from and to a vertex on its node with the smallest number.
    fn closed(&mut self) -> Result<(), Fault> {
        for node in 0..self.complex.nodes.len() as u32 {
            if self.node_edges[node as usize] == EdgeId::MAX {
                let v = self.node_vertex(node, VertexKind::Loop);
                let first = self.trace(v, (node, 1), None)?;
                self.rotations[v as usize] = vec![first, Arrangement::twin(first)];
            }
        }
        Ok(())
    }

    /// Follows the arcs from a vertex to the next one, leaving a cell through an arm, and adds the edge. `cell` is that
    /// cell if the vertex is in it, and `None` if the vertex is on the node.
    fn trace(&mut self, from: VertexId, arm: Arm, cell: Option<u32>) -> Result<HalfedgeId, Fault> {
        let first = &self.complex.nodes[arm.0 as usize];
        let (mut nodes, mut cells) = (vec![arm.0], Vec::from_iter(cell));
        let end = self.follow(arm, cell.is_none(), &mut nodes, &mut cells)?;
        let to = match end {
            End::Block(_, v) | End::Node(v) => v,
        };
        let proved = |v: VertexId| self.vertices[v as usize].vertex.proved;
        let edge = Edge {
            kind: EdgeKind::Curve,
            component: first.component,
            curves: first.curves.clone(),
            proved: proved(from) && proved(to),
            nodes,
            cells,
        };
        let half = self.add_edge(edge, [from, to], [self.incidence.left(arm), self.incidence.right(arm)]);
        if cell.is_some() {
            self.leaving[arm.0 as usize][arm.1] = Some(half);
        } else {
            self.rotations[from as usize].push(half);
        }
        match end {
            End::Block((node, side), _) => self.leaving[node as usize][side] = Some(Arrangement::twin(half)),
            End::Node(v) => self.rotations[v as usize].push(Arrangement::twin(half)),
        }
        Ok(half)
    }

    /// Goes from node to node until a vertex. `started` says that the first node has a vertex, where one starts.
    fn follow(&self, mut arm: Arm, started: bool, nodes: &mut Vec<u32>, cells: &mut Vec<u32>) -> Result<End, Fault> {
        let lost = |node: u32| Fault(format!("the chain through node {node} leads nowhere"));
        for step in 0..=self.complex.nodes.len() {
            let (node, side) = arm;
            let here = self.node_vertices[node as usize];
            if let Some(v) = here.filter(|_| step > 0 || !started) {
                return Ok(End::Node(v));
            }
            let entry = (node, 1 - side);
            let cell = self.incidence.cell(entry).ok_or_else(|| lost(node))?;
            let block = self.incidence.block(entry).ok_or_else(|| lost(node))?;
            cells.push(cell);
            if let Some(v) = self.block_vertices[cell as usize][block as usize] {
                return Ok(End::Block(entry, v));
            }
            arm = self.incidence.across(entry, cell, block).ok_or_else(|| lost(node))?;
            nodes.push(arm.0);
        }
        Err(lost(arm.0))
    }

    /// Around each hole of an unresolved region goes an edge from its vertex to itself, so that the vertex together with
    /// its edges fills the region as far as topology goes. Around the vertex, counter-clockwise, the start of that edge, the
    /// arms to the hole in the order of the walk along the hole, and the end of that edge follow one another.
    fn strips(&mut self) {
        for (c, blocks) in self.block_vertices.clone().into_iter().enumerate() {
            let cell = &self.complex.cells[c];
            if surrounds(cell) {
                continue;
            }
            for (k, hole) in cell.boundary.iter().enumerate().skip(1) {
                for (b, v) in blocks.iter().enumerate().filter_map(|(b, v)| v.map(|v| (b, v))) {
                    let curves = self.vertices[v as usize].vertex.curves.clone();
                    let (kind, component, cells) = (EdgeKind::Strip, NO_COMPONENT, vec![c as u32]);
                    let edge = Edge { kind, component, curves, proved: false, nodes: Vec::new(), cells };
                    let faces = [hole, &cell.boundary[0]].map(|cycle| self.incidence.start(cycle[0].0, cycle[0].1));
                    // The outer cycle's first gap may lie anywhere; the one past its last arm follows in the rotation.
                    let arms = &self.incidence.arms[c][b];
                    let beside = |k: usize, or| arms[k].last().map_or(or, |&arm| self.incidence.left(arm));
                    let half = self.add_edge(edge, [v, v], [beside(k, faces[0]), beside(0, faces[1])]);
                    let inner = arms[k].iter().filter_map(|&(node, side)| self.leaving[node as usize][side]);
                    let rotation = std::iter::once(half).chain(inner).chain([Arrangement::twin(half)]);
                    self.rotations[v as usize].extend(rotation);
                }
            }
        }
    }

    /// The edges of the frame, counter-clockwise.
    fn frame_edges(&mut self, steps: &[Step]) {
        let first = self.vertices.iter().position(|v| v.site == Site::Corner).unwrap_or(0) as VertexId;
        let count = steps.iter().filter(|step| !matches!(step, Step::Segment(..))).count() as VertexId;
        let base = self.sides.len() as HalfedgeId;
        let mut at = first;
        for (i, &step) in steps.iter().enumerate() {
            if matches!(step, Step::Segment(..)) {
                continue;
            }
            let rest = &steps[i + 1..];
            let length = rest.iter().take_while(|step| matches!(step, Step::Segment(..))).count();
            let end = rest.get(length).copied();
            let node = |step| if let Step::Node(node) = step { Some(node) } else { None };
            let along = rest[..length].iter().filter_map(|step| match *step {
                Step::Segment(s, forward) => Some((s, forward)),
                _ => None,
            });
            let inner = |s: u32, forward: bool| self.incidence.cells[s as usize][usize::from(!forward)];
            // Past a node the rest of its segment belongs to the edge.
            let own = node(step).and_then(|node| {
                let incidence = self.incidence;
                incidence.cell((node, 0)).or(incidence.cell((node, 1)))
            });
            let mut cells: Vec<u32> = own.into_iter().chain(along.clone().filter_map(|(s, f)| inner(s, f))).collect();
            cells.dedup();
            let face = match node(step) {
                Some(node) => {
                    // The arm inwards has its right where the frame goes on.
                    let outer = usize::from(self.incidence.cell((node, 1)).is_none());
                    self.incidence.right((node, outer))
                }
                None => along.clone().next().map_or(0, |(s, forward)| self.incidence.start(s, forward)),
            };
            let next = first + (at - first + 1) % count;
            let nodes = node(step).into_iter().chain(end.and_then(node)).collect();
            let (kind, component, curves) = (EdgeKind::Frame, NO_COMPONENT, Vec::new());
            self.add_edge(Edge { kind, component, curves, proved: true, nodes, cells }, [at, next], [face, 0]);
            at = next;
        }
        // Around each vertex: the edge onwards, the arm if there is one, the edge back.
        for i in 0..count {
            let (onwards, back) = (base + 2 * i, base + 2 * ((i + count - 1) % count) + 1);
            let rotation = &mut self.rotations[(first + i) as usize];
            rotation.insert(0, onwards);
            rotation.push(back);
        }
    }
}
