//! Certificates of arrangements: the tiling on which everything was decided, and what was found, in a form that `verify`
//! decides again.
//!
//! A file is the magic bytes, then a zlib stream of the [`Certificate`] in postcard's encoding. Nothing in it is believed:
//! the fingerprint guards against mixing up files; the boxes must be leaves of the quadtree and tile the domain; on them
//! everything is decided again by the given backend alone, and must come to the same.

use std::collections::HashSet;
use std::fmt::Write as _;

use serde::Deserialize;
use serde::Serialize;

use crate::arrange::check;
use crate::arrange::check::Summary;
use crate::arrange::complex::VertexKind;
use crate::arrange::field::Fields;
use crate::arrange::options::Options;
use crate::arrange::solve::replay;
use crate::arrange::structure::Arrangement;
use crate::arrange::structure::EdgeKind;
use crate::arrange::structure::Sign;
use crate::arrange::subdivide::Work;
use crate::arrange::subdivide::key;
use crate::control::Control;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::envelope::open;
use crate::envelope::seal;
use crate::interval::Interval;
use crate::kernel::Backend;
use crate::program::scene::Scene;

const MAGIC: &[u8; 8] = b"imp-arr1";

/// How much wider than the vertex's own enclosure the claimed one is, relative to the domain: enclosures by other means may
/// be wider in the last places. What is claimed is the wider box.
const SLACK: f64 = 1.0 / (1u64 << 44) as f64;

/// A box by the ends of its sides.
pub type Ends = [[f64; 2]; 2];

/// The proof of an arrangement.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Certificate {
    /// Of the scene and its parameters.
    pub fingerprint: u64,
    pub epsilon: Option<f64>,
    pub region: u64,
    pub exact: bool,
    /// The leaves of the quadtree, those of clusters among them.
    pub leaves: Vec<Ends>,
    pub claim: Claim,
}

/// What is claimed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Claim {
    pub proved: bool,
    pub vertices: Vec<ClaimedVertex>,
    /// Origin, next one and face of each halfedge.
    pub halfedges: Vec<[u32; 3]>,
    pub edges: Vec<ClaimedEdge>,
    pub faces: Vec<ClaimedFace>,
}

/// That a vertex of this kind is in a box.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ClaimedVertex {
    pub kind: VertexKind,
    pub proved: bool,
    pub curves: Vec<u16>,
    pub area: Ends,
}

/// What an edge is and which way it takes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ClaimedEdge {
    pub kind: EdgeKind,
    pub proved: bool,
    pub curves: Vec<u16>,
    /// The cells that it passes, as positions among the cells of the replayed complex.
    pub cells: Vec<u32>,
}

/// The boundary of a face and the signs in it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ClaimedFace {
    pub outer: Option<u32>,
    pub holes: Vec<u32>,
    pub isolated: Vec<u32>,
    pub bounded: bool,
    pub signs: Vec<Sign>,
}

impl Claim {
    fn new(arrangement: &Arrangement) -> Self {
        let slack = SLACK * arrangement.domain.map(Interval::mag).into_iter().fold(0.0, f64::max);
        let widened = |side: Interval| {
            let more = side.width() + slack;
            [side.lo() - more, side.hi() + more]
        };
        let vertices = arrangement.vertices.iter().map(|arranged| ClaimedVertex {
            kind: arranged.vertex.kind,
            proved: arranged.vertex.proved,
            curves: arranged.vertex.curves.clone(),
            area: arranged.vertex.area.map(widened),
        });
        let edges = arrangement.edges.iter().map(|edge| ClaimedEdge {
            kind: edge.kind,
            proved: edge.proved,
            curves: edge.curves.clone(),
            cells: edge.cells.clone(),
        });
        let faces = arrangement.faces.iter().map(|face| ClaimedFace {
            outer: face.outer,
            holes: face.holes.clone(),
            isolated: face.isolated.clone(),
            bounded: face.bounded,
            signs: face.signs.clone(),
        });
        Self {
            proved: arrangement.proved,
            vertices: vertices.collect(),
            halfedges: arrangement.halfedges.iter().map(|h| [h.origin, h.next, h.face]).collect(),
            edges: edges.collect(),
            faces: faces.collect(),
        }
    }

    /// What of this an arrangement does not bear out.
    ///
    /// # Errors
    /// The first difference found.
    fn compare(&self, found: &Arrangement) -> Result<(), String> {
        let Self { proved, vertices, halfedges, edges, faces } = Self::new(found);
        for (what, claimed, found) in [
            ("vertices", self.vertices.len(), vertices.len()),
            ("halfedges", self.halfedges.len(), halfedges.len()),
            ("edges", self.edges.len(), edges.len()),
            ("faces", self.faces.len(), faces.len()),
        ] {
            if claimed != found {
                return Err(format!("it claims {claimed} {what}, but there are {found}"));
            }
        }
        for (index, (claimed, vertex)) in self.vertices.iter().zip(&vertices).enumerate() {
            let same = (claimed.kind, claimed.proved, &claimed.curves) == (vertex.kind, vertex.proved, &vertex.curves);
            if !same {
                return Err(format!("vertex {index} is not what it claims"));
            }
            let sides = claimed.area.iter().zip(found.vertices[index].vertex.area);
            // A comparison with a NaN does not hold.
            if !sides.into_iter().all(|([lo, hi], side)| *lo <= side.lo() && side.hi() <= *hi) {
                return Err(format!("vertex {index} is not proved to be where it claims"));
            }
        }
        if let Some(index) = (0..halfedges.len()).find(|&index| self.halfedges[index] != halfedges[index]) {
            return Err(format!("halfedge {index} hangs together differently"));
        }
        if let Some(index) = (0..edges.len()).find(|&index| self.edges[index] != edges[index]) {
            return Err(format!("edge {index} is not what it claims"));
        }
        if let Some(index) = (0..faces.len()).find(|&index| self.faces[index] != faces[index]) {
            return Err(format!("face {index} is not what it claims"));
        }
        if self.proved != proved {
            return Err("not as much is proved as it claims".to_owned());
        }
        Ok(())
    }
}

impl Certificate {
    /// The certificate of what was found for a scene with these options. Enclosures of compiled kernels and of the
    /// reference differ in their last places, so what is claimed is what the reference itself finds on the same boxes.
    ///
    /// # Errors
    /// If that is something else (`E0506`), or the reference fails.
    pub fn new(
        scene: &Scene,
        options: &Options,
        arrangement: &Arrangement,
        reference: &dyn Backend,
    ) -> Result<Self, Diagnostic> {
        let boxes: Vec<[Interval; 2]> =
            arrangement.complex.cells.iter().flat_map(|c| c.boxes.iter().copied()).collect();
        let found = replay(scene, options, &boxes, reference, &Control::default())?;
        if check::check(&found)? != check::check(arrangement)? {
            let title =
                "the reference interpreter finds another arrangement on these boxes, so there is no certificate";
            return Err(Diagnostic::error(code::NO_CERTIFICATE, title).help("try a smaller `--epsilon`"));
        }
        Ok(Self {
            fingerprint: fingerprint(scene),
            epsilon: options.epsilon,
            region: options.region as u64,
            exact: options.exact,
            leaves: boxes.iter().map(|area| area.map(|side| [side.lo(), side.hi()])).collect(),
            claim: Claim::new(&found),
        })
    }

    /// Whether bytes begin as a certificate of an arrangement does.
    pub fn is_one(bytes: &[u8]) -> bool {
        bytes.starts_with(MAGIC)
    }

    /// The bytes of a certificate file.
    pub fn to_bytes(&self) -> Vec<u8> {
        seal(MAGIC, self)
    }

    /// Reads a certificate file.
    ///
    /// # Errors
    /// If the bytes are not a whole certificate (`E0507`).
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Diagnostic> {
        open(MAGIC, bytes)
    }

    /// The leaves as boxes, if they tile the domain: the quadtree is followed from its root until each leaf is met.
    ///
    /// # Errors
    /// What is wrong with them.
    fn tiling(&self, fields: &Fields) -> Result<Vec<[Interval; 2]>, String> {
        let boxes =
            self.leaves.iter().map(|&[[xl, xh], [yl, yh]]| Some([Interval::new(xl, xh)?, Interval::new(yl, yh)?]));
        let boxes: Vec<[Interval; 2]> = boxes.collect::<Option<_>>().ok_or("a box of its tiling is none")?;
        let keys: HashSet<[u64; 4]> = boxes.iter().map(key).collect();
        if keys.len() != boxes.len() {
            return Err("its tiling has a box twice".to_owned());
        }
        // A tree of quarters with n leaves has (n - 1) / 3 inner nodes; one that needs more does not end in these leaves.
        let mut left = boxes.len() / 3 + 1;
        let mut met = 0;
        let mut stack = vec![Work::root(fields)];
        while let Some(work) = stack.pop() {
            if keys.contains(&key(&work.area)) {
                met += 1;
                continue;
            }
            let quarters = work.quarters().filter(|_| left > 0).ok_or("its boxes do not tile the domain")?;
            left -= 1;
            stack.extend(quarters);
        }
        if met == boxes.len() { Ok(boxes) } else { Err("its boxes overlap or lie outside of the domain".to_owned()) }
    }
}

/// What was verified.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    pub summary: Summary,
    /// Boxes on which everything was decided again.
    pub leaves: u64,
    pub evaluations: u64,
}

/// Checks that a certificate proves what it claims of the arrangement of a scene: everything is decided again on its
/// tiling, by the given backend alone.
///
/// # Errors
/// If it belongs to another scene (`E0508`), or claims anything else than is found (`E0509`); if the scene cannot be
/// arranged or the backend fails.
pub fn verify(
    scene: &Scene,
    certificate: &Certificate,
    backend: &dyn Backend,
    control: &Control<'_>,
) -> Result<Report, Diagnostic> {
    if certificate.fingerprint != fingerprint(scene) || scene.dimension() != 2 {
        return Err(Diagnostic::error(code::OTHER_SCENE, "the certificate belongs to another scene")
            .help("verify it with the file and the parameters that it was made with"));
    }
    let fields = Fields::new(scene, backend)?;
    let leaves = certificate.tiling(&fields).map_err(rejected)?;
    let options = Options {
        epsilon: certificate.epsilon,
        region: usize::try_from(certificate.region).unwrap_or(usize::MAX),
        exact: certificate.exact,
        ..Options::default()
    };
    let found = replay(scene, &options, &leaves, backend, control)?;
    certificate.claim.compare(&found).map_err(rejected)?;
    let counts = check::check(&found)?;
    Ok(Report {
        summary: Summary::new(&found, &counts),
        leaves: leaves.len() as u64,
        evaluations: found.complex.effort.evaluations,
    })
}

fn rejected(reason: impl Into<String>) -> Diagnostic {
    Diagnostic::error(code::REJECTED, format!("the certificate is rejected: {}", reason.into()))
}

/// A number that tells scenes apart (FNV-1a over a description).
fn fingerprint(scene: &Scene) -> u64 {
    let mut text = scene.graph.to_string();
    let bits = |range: Interval| [range.lo().to_bits(), range.hi().to_bits()];
    for shape in &scene.shapes {
        write!(text, "{:?} {} {} {:?}", shape.kind, shape.name, shape.field, shape.condition)
            .expect("a string takes all text");
    }
    for parameter in &scene.parameters {
        write!(text, "{} {:?}", parameter.name, bits(parameter.value)).expect("a string takes all text");
    }
    for range in &scene.domain {
        write!(text, "{:?}", bits(*range)).expect("a string takes all text");
    }
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}
