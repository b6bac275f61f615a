//! Certificates: what a picture refuted and proved, beam by beam and pixel by pixel, in a form that `verify` replays.
//!
//! A file is the magic bytes, then a zlib stream of the [`Certificate`] in postcard's encoding. Nothing in it is
//! believed: the fingerprint guards against mixing up files, everything else is checked against the scene.

use std::fmt::Write as _;

use glam::DVec3;
use serde::Deserialize;
use serde::Serialize;

use crate::diagnostic::Diagnostic;
use crate::envelope::open;
use crate::envelope::seal;
use crate::program::scene::Parameter;
use crate::program::scene::Projection;
use crate::program::scene::Scene;
use crate::render::camera::Camera;
use crate::render::context::Refuted;
use crate::render::options::Enclosures;
use crate::render::options::Options;
use crate::render::outcome::Outcome;
use crate::render::outcome::Surface;
use crate::render::stats::Stats;

const MAGIC: &[u8; 8] = b"imp-ray1";

/// The proof of one picture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Certificate {
    /// Of the scene and its parameters.
    pub(super) fingerprint: u64,
    /// Where the rays come from: what the scene leaves open is chosen by what its shapes need.
    pub(super) camera: View,
    pub(super) enclosures: Enclosures,
    pub(super) counts: Counts,
    /// By tile, then by shape.
    pub(super) tiles: Vec<Vec<ShapeProof>>,
}

/// A camera in numbers: the eye, then the directions of view, of one pixel to the right and of one upwards.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) struct View {
    pub width: u32,
    pub height: u32,
    pub parallel: bool,
    pub frame: [[f64; 3]; 4],
}

impl View {
    fn new(camera: &Camera) -> Self {
        let Camera { projection, position, forward, right, up, width, height } = *camera;
        let frame = [position, forward, right, up].map(Into::into);
        Self { width, height, parallel: projection == Projection::Orthographic, frame }
    }

    /// The camera; `None` if the numbers make none.
    pub fn camera(self) -> Option<Camera> {
        let Self { width, height, parallel, frame } = self;
        let projection = if parallel { Projection::Orthographic } else { Projection::Perspective };
        let [position, forward, right, up] = frame.map(DVec3::from);
        let fits = |v: DVec3| v.is_finite() && v.length() < 1e100;
        let sees = (0.5..2.0).contains(&forward.length()) && right.length() > 1e-100 && up.length() > 1e-100;
        let camera = Camera { projection, position, forward, right, up, width, height };
        (sees && frame.map(DVec3::from).into_iter().all(fits)).then_some(camera)
    }
}

/// How many pixels are what.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts {
    pub proved: u64,
    pub misses: u64,
    pub unknown: u64,
}

/// What a tile proves of a shape.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct ShapeProof {
    pub cover: Vec<Refuted>,
    /// Pixels that do not miss: how many pixels lie between it and the one before, row by row, and what it is.
    pub claims: Vec<(u32, Claim)>,
}

/// What is claimed of a pixel's ray.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) enum Claim {
    /// A proved hit inside the bracket, with everything before it refuted.
    Hit(Surface, [f64; 2]),
    /// Everything before this is refuted.
    Unknown(f64),
}

impl Certificate {
    /// Collects what the tiles recorded: for each tile and shape the cover and the outcomes of its pixels.
    pub(super) fn new(
        (scene, parameters): (&Scene, &[Parameter]),
        (options, camera): (&Options, &Camera),
        stats: &Stats,
        tiles: Vec<Vec<(Vec<Refuted>, Vec<Outcome>)>>,
    ) -> Self {
        let proof = |(cover, outcomes): (Vec<Refuted>, Vec<Outcome>)| {
            let mut claims = Vec::new();
            let mut gap = 0;
            for outcome in outcomes {
                let claim = match (outcome.unknown, outcome.drawn) {
                    (true, _) => Claim::Unknown(outcome.clear),
                    (false, true) => Claim::Hit(outcome.surface, outcome.bracket),
                    (false, false) => {
                        gap += 1;
                        continue;
                    }
                };
                claims.push((gap, claim));
                gap = 0;
            }
            ShapeProof { cover, claims }
        };
        Self {
            fingerprint: fingerprint(scene, parameters),
            camera: View::new(camera),
            enclosures: options.enclosures,
            counts: Counts { proved: stats.proved, misses: stats.misses, unknown: stats.unknown },
            tiles: tiles.into_iter().map(|shapes| shapes.into_iter().map(proof).collect()).collect(),
        }
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
}

/// A number that tells scenes apart (FNV-1a over a description).
pub(super) fn fingerprint(scene: &Scene, parameters: &[Parameter]) -> u64 {
    let mut text = scene.graph.to_string();
    let bits = |range: crate::interval::Interval| [range.lo().to_bits(), range.hi().to_bits()];
    for shape in &scene.shapes {
        write!(text, "{:?} {} {:?}", shape.kind, shape.field, shape.condition).expect("a string takes all text");
    }
    for parameter in parameters {
        write!(text, "{} {:?}", parameter.name, bits(parameter.value)).expect("a string takes all text");
    }
    for range in &scene.domain {
        write!(text, "{:?}", bits(*range)).expect("a string takes all text");
    }
    write!(text, "{:?}", scene.view.camera).expect("a string takes all text");
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}
