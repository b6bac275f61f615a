//! Where the rays of a picture are and how far they go.

use crate::derive::Precision;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::program::scene::Projection;
use crate::program::scene::Scene;
use crate::program::scene::Shape;
use crate::program::scene::ShapeKind;
use crate::render::camera::Camera;
use crate::render::camera::Frame;
use crate::render::camera::TILE;
use crate::render::camera::Tile;
use crate::render::context::Context;
use crate::render::extent::extent;
use crate::render::grid::Grid;
use crate::render::options::Enclosures;
use crate::render::options::Options;
use crate::render::options::Stop;
use crate::render::programs::Reach;
use crate::render::tile::Effort;

/// The deepest cells of beams. Finer ones are left to single rays, whose double precision they would need.
const LEAF: u8 = 12;

/// Blocks of at most 2^4 = 16 pixels across are tried with their derivative, unless centred forms were asked for.
const SLOPE_LEVEL: u8 = 4;

/// Pixels along a side of the largest picture.
const MAX_SIDE: u32 = 1 << 16;

/// Where the rays of a picture are and how far they go; what rendering and verification have in common.
pub struct Geometry {
    pub camera: Camera,
    pub tiles: Vec<Tile>,
    pub grid: Grid,
    pub reach: Reach,
    pub effort: Effort,
}

impl Geometry {
    /// # Errors
    /// If the domain is unbounded (`E0502`), the camera is impossible (`E0501`) or the picture has no pixels or
    /// too many (`E0503`).
    pub fn new(scene: &Scene, options: &Options) -> Result<Self, Diagnostic> {
        check(scene, options)?;
        let (width, height) = (options.width, options.height);
        let camera = Camera::new(&scene.view.camera, &extent(scene), (width, height))?;
        Ok(Self::of_camera(scene, options, camera))
    }

    /// The geometry of a given camera, in a scene and for options that [`check`] lets pass.
    pub fn of_camera(scene: &Scene, options: &Options, camera: Camera) -> Self {
        let (width, height) = (camera.width, camera.height);
        let tiles = camera.tiles();
        let slab = scene.domain.iter().map(|range| range.width()).fold(0.0, f64::max);
        let corner = |sign: f64, unit: glam::DVec3, pixels: u32| sign * 0.5 * f64::from(pixels) * unit;
        let spread = match camera.projection {
            Projection::Perspective => glam::DVec3::ZERO,
            Projection::Orthographic => corner(1.0, camera.right, width).abs() + corner(1.0, camera.up, height).abs(),
        };
        let origin = (camera.position.abs() + spread).max_element();
        let far = scene.domain.iter().map(|range| range.mag()).fold(0.0, f64::max);
        let end = origin + far;
        let power = |x: f64| x.log2().ceil().exp2();
        let axis = camera.forward.abs().max_position();
        let grid = Grid::new(slab, end);
        let reach = Reach {
            projection: camera.projection,
            origin: power(origin.max(f64::MIN_POSITIVE)),
            end: power(end + 4.0 * grid.unit(0)),
            axis,
        };
        let depth = match options.stop {
            Stop::Depth(depth) => depth.min(grid.deepest().into()) as u8,
            // Eq. 6.1: the depth at which a cell of the longest ray is no longer than epsilon.
            Stop::Epsilon(length) => grid.depth_of(length / longest(&camera, &tiles)),
            Stop::Tolerance(_) => grid.deepest(),
        };
        let single = match options.precision {
            Precision::Single => grid.deepest_single(),
            Precision::Double => grid.deepest(),
        };
        let effort = Effort {
            stop: options.stop,
            depth,
            leaf: LEAF.min(single),
            slope_level: if options.enclosures == Enclosures::Centred { TILE.ilog2() as u8 } else { SLOPE_LEVEL },
            poles: options.poles,
            certificate: options.certificate,
        };
        Self { camera, tiles, grid, reach, effort }
    }

    /// What the stages of a tile share.
    pub fn context<'a>(&'a self, frame: &'a Frame, scene: &'a Scene, shape: &Shape) -> Context<'a> {
        let axis = frame.tile.axis;
        let perspective = self.camera.projection == Projection::Perspective;
        let pitch = self.camera.right.length().max(self.camera.up.length());
        Context {
            frame,
            grid: &self.grid,
            domain: &scene.domain,
            region: shape.kind == ShapeKind::Region,
            condition: shape.condition.is_some(),
            leaf: self.effort.leaf,
            slope_level: self.effort.slope_level,
            pitch: if perspective { pitch / self.camera.forward[axis].abs().max(0.25) } else { pitch },
            perspective,
        }
    }
}

/// The inputs that all rays of a picture share: the eye, or the direction of parallel rays, which have one dominant
/// axis.
pub fn shared_inputs(geometry: &Geometry) -> [(&'static str, f64); 3] {
    let ray = Frame::new(&geometry.camera, geometry.tiles[0]).ray(0, 0);
    let values = match geometry.camera.projection {
        Projection::Perspective => ray.origin,
        Projection::Orthographic => ray.direction,
    };
    let names = geometry.reach.shared();
    std::array::from_fn(|c| (names[c], values[c]))
}

/// Refuses what cannot be drawn, in space or plane.
///
/// # Errors
/// If the domain is unbounded (`E0502`), or the picture has no pixels or too many (`E0503`).
pub fn check(scene: &Scene, options: &Options) -> Result<(), Diagnostic> {
    if scene.domain.iter().any(|range| !range.is_bounded() || range.is_singleton()) {
        return Err(Diagnostic::error(code::NO_EXTENT, "the domain has no extent or no bounds")
            .help("give every coordinate a range such as `[-2, 2]`"));
    }
    let (width, height) = (options.width, options.height);
    if width == 0 || height == 0 || width > MAX_SIDE || height > MAX_SIDE {
        return Err(Diagnostic::error(
            code::PICTURE_SIZE,
            format!("a picture of {width}x{height} pixels cannot be drawn"),
        )
        .help(format!("write a size such as `512x512`; neither side may exceed {MAX_SIDE} pixels")));
    }
    Ok(())
}

/// The longest direction of all rays.
fn longest(camera: &Camera, tiles: &[Tile]) -> f64 {
    let mut longest = 1.0f64;
    for &tile in tiles {
        let frame = Frame::new(camera, tile);
        let (width, height) = frame.size();
        for (x, y) in [(0, 0), (width - 1, 0), (0, height - 1), (width - 1, height - 1)] {
            longest = longest.max(glam::DVec3::from(frame.ray(x, y).direction).length());
        }
    }
    longest
}
