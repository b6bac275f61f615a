//! Rays: the exact lines o + t d of their stored origin and direction, one per pixel centre.
//!
//! Inside a tile all directions have a component of exactly +1 or -1 along the tile's dominant axis K, so that cells
//! of t are slabs across K that all rays of the tile share (K-marching: Knoll, Hijazi et al. 2007). Tiles depend on
//! the picture's size and the camera alone.

use glam::DVec3;

use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::interval::Interval;
use crate::program::scene::CameraSettings;
use crate::program::scene::Projection;
use crate::render::extent::Cell;

/// Pixels along the side of a full tile.
pub const TILE: u32 = 64;

/// Vertical field of view when none is given, in degrees.
const FIELD_OF_VIEW: f64 = 30.0;
/// Share of the picture that the domain may fill when the camera is placed automatically.
const FRAME: f64 = 0.96;
/// The default three-quarter view: degrees around z and above the horizon.
const AZIMUTH: f64 = 24.0;
const ELEVATION: f64 = 24.0;
/// The least component along K, relative to the direction's length, that a tile's rays may have.
const LEAST_SLANT: f64 = 0.3;

/// Where rays come from. `right` and `up` are one pixel long, measured where `forward` ends.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    pub projection: Projection,
    /// The eye, or the centre of the plane from which parallel rays start.
    pub position: DVec3,
    pub forward: DVec3,
    pub right: DVec3,
    pub up: DVec3,
    pub width: u32,
    pub height: u32,
}

impl Camera {
    /// The camera of a scene; what the settings leave open frames the cells that hold the shapes, from a three-quarter
    /// view, z up.
    ///
    /// # Errors
    /// If the field of view is no angle between 0 and 150 degrees, or the camera looks at its own position.
    pub fn new(settings: &CameraSettings, cells: &[Cell], (width, height): (u32, u32)) -> Result<Self, Diagnostic> {
        let low = cells.iter().map(|cell| cell.centre - cell.half).fold(DVec3::INFINITY, DVec3::min);
        let high = cells.iter().map(|cell| cell.centre + cell.half).fold(DVec3::NEG_INFINITY, DVec3::max);
        let fov = settings.fov.unwrap_or(FIELD_OF_VIEW);
        if !(fov > 0.0 && fov <= 150.0) {
            return Err(Diagnostic::error(
                code::BAD_CAMERA,
                format!("a field of view of {fov} degrees cannot be drawn"),
            )
            .help("write an angle between 0 and 150 degrees, for example `fov = 30`"));
        }
        let projection = settings.projection.unwrap_or(Projection::Perspective);
        let centre = 0.5 * (low + high);
        let target = settings.target.map_or(centre, DVec3::from);
        let (azimuth, elevation) = (AZIMUTH.to_radians(), ELEVATION.to_radians());
        let three_quarter =
            DVec3::new(elevation.cos() * azimuth.sin(), -elevation.cos() * azimuth.cos(), elevation.sin());
        let away = settings.position.map_or(three_quarter, |position| DVec3::from(position) - target);
        let Some(forward) = (-away).try_normalize() else {
            return Err(Diagnostic::error(code::BAD_CAMERA, "the camera's position and its target are the same point")
                .help("move one of them"));
        };
        let wanted = settings.up.map_or(DVec3::Z, DVec3::from);
        // A camera that looks along its own up direction has y up instead.
        let right = [wanted, DVec3::Y, DVec3::X]
            .into_iter()
            .filter_map(|up| up.try_normalize())
            .map(|up| forward.cross(up))
            .find(|right| right.length() > 1e-6)
            .expect("one of two perpendicular directions is not parallel to a third")
            .normalize();
        let up = right.cross(forward);

        let aspect = f64::from(width) / f64::from(height);
        let half = (0.5 * fov.to_radians()).tan();
        // Half the picture's height that holds a cell, and the depth of the cell's nearest corner beyond the target.
        let reach = |cell: &Cell, axis: DVec3| ((cell.centre - target).dot(axis), cell.half.dot(axis.abs()));
        let extents = cells.iter().map(|cell| {
            let [(x, dx), (y, dy), (z, dz)] = [right, up, forward].map(|axis| reach(cell, axis));
            (((y.abs() + dy).max((x.abs() + dx) / aspect)) / FRAME, z - dz)
        });
        let (position, half_height) = match (settings.position, projection) {
            (Some(position), Projection::Perspective) => (DVec3::from(position), half),
            (Some(position), Projection::Orthographic) => (DVec3::from(position), half * away.length()),
            (None, Projection::Perspective) => {
                let distance = extents.map(|(size, depth)| size / half - depth).fold(0.0, f64::max);
                (target - distance * forward, half)
            }
            (None, Projection::Orthographic) => {
                let (mut size, mut back) = (0.0f64, 0.0f64);
                for (extent, depth) in extents {
                    size = size.max(extent);
                    back = back.max(-depth);
                }
                (target - 1.5 * back * forward, size)
            }
        };
        let pixel = 2.0 * half_height / f64::from(height);
        Ok(Self { projection, position, forward, right: pixel * right, up: pixel * up, width, height })
    }

    /// The number of pixels.
    pub fn pixels(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// The direction through the point of the picture (x to the right, y down, pixel centres at whole numbers), not
    /// scaled.
    fn direction(&self, x: f64, y: f64) -> DVec3 {
        match self.projection {
            Projection::Perspective => {
                let (u, v) = self.offsets(x, y);
                self.forward + u * self.right + v * self.up
            }
            Projection::Orthographic => self.forward,
        }
    }

    /// Pixels to the right of and above the centre of the picture.
    fn offsets(&self, x: f64, y: f64) -> (f64, f64) {
        (x - 0.5 * (f64::from(self.width) - 1.0), 0.5 * (f64::from(self.height) - 1.0) - y)
    }

    /// The tiles of the picture, row by row. A tile in which no axis dominates everywhere is cut into smaller ones.
    pub fn tiles(&self) -> Vec<Tile> {
        let mut tiles = Vec::new();
        for y in (0..self.height).step_by(TILE as usize) {
            for x in (0..self.width).step_by(TILE as usize) {
                self.cut(x, y, TILE, &mut tiles);
            }
        }
        tiles
    }

    fn cut(&self, x: u32, y: u32, size: u32, tiles: &mut Vec<Tile>) {
        if x >= self.width || y >= self.height {
            return;
        }
        let last_x = (x + size).min(self.width) - 1;
        let last_y = (y + size).min(self.height) - 1;
        let centre = self.direction(0.5 * f64::from(x + last_x), 0.5 * f64::from(y + last_y));
        let axis = centre.abs().max_position();
        let sign = centre[axis].signum();
        let dominates = [(x, y), (last_x, y), (x, last_y), (last_x, last_y)].into_iter().all(|(x, y)| {
            let direction = self.direction(x.into(), y.into());
            sign * direction[axis] >= LEAST_SLANT * direction.length()
        });
        if dominates || size == 1 {
            tiles.push(Tile { x, y, size, last_x, last_y, axis, sign });
            return;
        }
        let half = size / 2;
        for (dx, dy) in [(0, 0), (half, 0), (0, half), (half, half)] {
            self.cut(x + dx, y + dy, half, tiles);
        }
    }
}

/// A square of pixels that is rendered as one task; the part beyond the picture's edge is left out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tile {
    pub x: u32,
    pub y: u32,
    /// A power of two up to [`TILE`].
    pub size: u32,
    pub last_x: u32,
    pub last_y: u32,
    /// The dominant axis K and the sign of the directions' component along it.
    pub axis: usize,
    pub sign: f64,
}

/// A pixel's exact line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    pub origin: [f64; 3],
    pub direction: [f64; 3],
}

impl Ray {
    /// The nearest point to o + t d.
    pub fn at(&self, t: f64) -> [f64; 3] {
        std::array::from_fn(|c| self.direction[c] * t + self.origin[c])
    }

    /// The ends of the stretch t >= 0 inside the domain, each enclosed: ([earliest, latest] entry, [earliest, latest]
    /// exit). Between the latest entry and the earliest exit, o + t d rounded outward in `f64` lies in the domain.
    /// `None` if the ray misses the domain.
    pub fn clip(&self, domain: &[Interval]) -> Option<([f64; 2], [f64; 2])> {
        let (mut entry, mut exit) = ([0.0f64; 2], [f64::INFINITY; 2]);
        for (axis, range) in domain.iter().enumerate() {
            let (o, d) = (self.origin[axis], self.direction[axis]);
            let (near, far) = if d < 0.0 { (range.hi(), range.lo()) } else { (range.lo(), range.hi()) };
            if d == 0.0 {
                if !(range.lo() <= o && o <= range.hi()) {
                    return None;
                }
                continue;
            }
            for (face, ends, inward) in [(near, &mut entry, 1.0), (far, &mut exit, -1.0)] {
                // The difference, the quotient and the kernel's product and sum err by less than 4 ulp each of
                // terms that |o| + |face| bounds: 2^-52 * 16 covers them and the rounding of this very sum.
                let t = (face - o) / d;
                let margin = (2.0f64.powi(-48) * (o.abs() + face.abs()) + f64::MIN_POSITIVE) / d.abs();
                let (outer, inner) = (t - inward * margin, t + inward * margin);
                if inward > 0.0 {
                    *ends = [ends[0].max(outer), ends[1].max(inner)];
                } else {
                    *ends = [ends[0].min(inner), ends[1].min(outer)];
                }
            }
        }
        (entry[0] <= exit[1]).then_some((entry, exit))
    }
}

/// The rays of one tile. Either origins or directions vary from pixel to pixel; the other is shared.
#[derive(Debug, Clone)]
pub struct Frame {
    pub tile: Tile,
    pub projection: Projection,
    /// What all rays share: the origin in perspective, the direction of parallel rays.
    shared: [f64; 3],
    /// Column and row terms of what varies, by pixel of the tile: value = column + row, divided by |K| in perspective.
    columns: [Vec<f64>; 3],
    rows: [Vec<f64>; 3],
    /// Bound of the rounding of a direction; see [`Frame::hull`].
    error: [f64; 3],
}

impl Frame {
    pub fn new(camera: &Camera, tile: Tile) -> Self {
        let base = match camera.projection {
            Projection::Perspective => camera.forward,
            Projection::Orthographic => camera.position,
        };
        let mut columns = [const { Vec::new() }; 3];
        let mut rows = [const { Vec::new() }; 3];
        for c in 0..3 {
            columns[c] =
                (tile.x..=tile.last_x).map(|x| base[c] + camera.offsets(x.into(), 0.0).0 * camera.right[c]).collect();
            rows[c] = (tile.y..=tile.last_y).map(|y| camera.offsets(0.0, y.into()).1 * camera.up[c]).collect();
        }
        let mut frame = Self {
            tile,
            projection: camera.projection,
            shared: camera.position.into(),
            columns,
            rows,
            error: [0.0; 3],
        };
        match camera.projection {
            Projection::Orthographic => {
                let scale = camera.forward[tile.axis].abs();
                frame.shared = std::array::from_fn(|c| camera.forward[c] / scale);
                frame.shared[tile.axis] = tile.sign;
            }
            Projection::Perspective => {
                // A direction is the quotient N / D of numbers affine in the pixel's place. Each computed sum of three
                // terms errs by at most 4 u M, where M bounds the sum of their magnitudes and u = 2^-53, so that the
                // quotient, computed in two operations, errs by (4 u M_c + |N/D| 4 u M_K) / D + 3 u |N/D|, which
                // is below 11 u (M_c / D) (1 + M_K / D).
                let magnitude = |c: usize| {
                    let most = |terms: &[f64]| terms.iter().fold(0.0f64, |m, x| m.max(x.abs()));
                    camera.forward[c].abs() + most(&frame.columns[c]) + most(&frame.rows[c])
                };
                let (w, h) = (frame.columns[0].len() - 1, frame.rows[0].len() - 1);
                let corner = |x: usize, y: usize| (frame.columns[tile.axis][x] + frame.rows[tile.axis][y]).abs();
                let least = corner(0, 0).min(corner(w, 0)).min(corner(0, h)).min(corner(w, h));
                let axis = magnitude(tile.axis);
                frame.error = std::array::from_fn(|c| {
                    let ratio = magnitude(c) / least;
                    if c == tile.axis { 0.0 } else { 2.0f64.powi(-49) * ratio * (1.0 + axis / least) }
                });
            }
        }
        frame
    }

    /// Pixels across and down that lie inside the picture.
    pub fn size(&self) -> (u32, u32) {
        (self.columns[0].len() as u32, self.rows[0].len() as u32)
    }

    /// What varies from ray to ray, for a pixel counted from the tile's corner.
    pub fn varying(&self, x: u32, y: u32) -> [f64; 3] {
        let sum = std::array::from_fn(|c| self.columns[c][x as usize] + self.rows[c][y as usize]);
        match self.projection {
            Projection::Orthographic => sum,
            Projection::Perspective => {
                let scale = 1.0 / sum[self.tile.axis].abs();
                let mut direction: [f64; 3] = sum.map(|n| n * scale);
                direction[self.tile.axis] = self.tile.sign;
                direction
            }
        }
    }

    /// The ray of a pixel counted from the tile's corner.
    pub fn ray(&self, x: u32, y: u32) -> Ray {
        self.ray_of(self.varying(x, y))
    }

    /// The ray with the given varying part.
    pub fn ray_of(&self, varying: [f64; 3]) -> Ray {
        match self.projection {
            Projection::Perspective => Ray { origin: self.shared, direction: varying },
            Projection::Orthographic => Ray { origin: varying, direction: self.shared },
        }
    }

    /// Encloses the varying part of all rays of the block of `size` pixels at (x, y): lower and upper ends.
    ///
    /// Sums are monotone in x and in y, rounding included, so their extremes are at the corners. The exact quotient
    /// of two affine functions has its extremes over a rectangle at the corners too (it is monotone along any line,
    /// Boyd and Vandenberghe 2004, section 3.4.1); the computed one differs from it by at most `error`, here and there.
    pub fn hull(&self, x: u32, y: u32, size: u32) -> ([f64; 3], [f64; 3]) {
        let (width, height) = self.size();
        let (right, bottom) = ((x + size).min(width) - 1, (y + size).min(height) - 1);
        let first = self.varying(x, y);
        if size == 1 {
            return (first, first);
        }
        let (mut low, mut high) = (first, first);
        for (x, y) in [(right, y), (x, bottom), (right, bottom)] {
            let corner = self.varying(x, y);
            for c in 0..3 {
                low[c] = low[c].min(corner[c]);
                high[c] = high[c].max(corner[c]);
            }
        }
        for c in 0..3 {
            low[c] -= 2.0 * self.error[c];
            high[c] += 2.0 * self.error[c];
        }
        (low, high)
    }

    /// Encloses the stretch t >= 0 in which rays of a hull are inside the domain; `None` if there is none.
    pub fn clip(&self, hull: &([f64; 3], [f64; 3]), domain: &[Interval]) -> Option<(f64, f64)> {
        // A quotient of one rounded difference errs by less than 2^-51 of itself.
        let widen = |t: f64| t.abs() * 2.0f64.powi(-50) + f64::MIN_POSITIVE;
        let (mut entry, mut exit) = (0.0f64, f64::INFINITY);
        for (axis, range) in domain.iter().enumerate() {
            let (origin, direction) = match self.projection {
                Projection::Perspective => ([self.shared[axis]; 2], [hull.0[axis], hull.1[axis]]),
                Projection::Orthographic => ([hull.0[axis], hull.1[axis]], [self.shared[axis]; 2]),
            };
            // Some ray can be inside only where o_lo + t d_lo <= hi and o_hi + t d_hi >= lo; both read room >= -t d.
            for (room, slope) in [(range.hi() - origin[0], -direction[0]), (origin[1] - range.lo(), direction[1])] {
                if slope == 0.0 {
                    if room < 0.0 {
                        return None;
                    }
                    continue;
                }
                let t = -room / slope;
                if slope > 0.0 {
                    entry = entry.max(t - widen(t));
                } else {
                    exit = exit.min(t + widen(t));
                }
            }
        }
        (entry <= exit).then_some((entry, exit))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cameras() -> Vec<Camera> {
        let cells = [Cell { centre: DVec3::ZERO, half: DVec3::splat(2.0) }];
        let mut cameras = Vec::new();
        for projection in [Projection::Perspective, Projection::Orthographic] {
            for (position, fov, size) in [
                (None, None, (130, 70)),
                (Some([0.3, -7.0, 0.1]), Some(20.0), (65, 64)),
                (Some([0.1, 0.2, 0.3]), Some(140.0), (200, 33)),
                (Some([4.0, 4.0, 4.0]), Some(50.0), (1, 1)),
                (Some([-900.0, 30.0, 5000.0]), Some(0.05), (96, 96)),
            ] {
                let settings = CameraSettings { position, fov, projection: Some(projection), ..Default::default() };
                cameras.push(Camera::new(&settings, &cells, size).unwrap());
            }
        }
        cameras
    }

    #[test]
    fn tiles_cover_every_pixel_once_and_have_a_dominant_axis() {
        for camera in cameras() {
            let mut seen = vec![0u8; camera.pixels()];
            for tile in camera.tiles() {
                let frame = Frame::new(&camera, tile);
                let (width, height) = frame.size();
                for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
                    seen[((tile.y + y) * camera.width + tile.x + x) as usize] += 1;
                    let direction = frame.ray(x, y).direction;
                    assert_eq!(direction[tile.axis], tile.sign);
                    assert!(direction.iter().all(|d| d.abs() < 4.0), "{direction:?}");
                }
            }
            assert!(seen.iter().all(|&count| count == 1));
        }
    }

    #[test]
    fn hulls_hold_every_ray_and_clips_hold_every_clip() {
        let domain = [(-2.0, 2.0), (-1.0, 0.7), (0.1, 2.0)].map(|(lo, hi)| Interval::new(lo, hi).unwrap());
        let mut inside = 0;
        for camera in cameras() {
            for tile in camera.tiles() {
                let frame = Frame::new(&camera, tile);
                let (width, height) = frame.size();
                for size in [1, 2, 8, 32, 64].into_iter().filter(|&size| size <= tile.size) {
                    for (x, y) in [(0, 0), (width - 1, height - 1)].map(|(x, y)| (x / size * size, y / size * size)) {
                        let hull = frame.hull(x, y, size);
                        let clip = frame.clip(&hull, &domain);
                        let rows = y..(y + size).min(height);
                        for (x, y) in rows.flat_map(|y| (x..(x + size).min(width)).map(move |x| (x, y))) {
                            let varying = frame.varying(x, y);
                            assert!((0..3).all(|c| hull.0[c] <= varying[c] && varying[c] <= hull.1[c]));
                            if let Some((entry, exit)) = frame.ray(x, y).clip(&domain) {
                                let (first, last) = clip.expect("a ray of the block meets the domain");
                                assert!(first <= entry[1] && exit[0] <= last, "{entry:?} {exit:?} {clip:?}");
                                inside += 1;
                            }
                        }
                    }
                }
            }
        }
        assert!(inside > 1000, "the test tests nothing: {inside}");
    }

    #[test]
    fn between_entry_and_exit_a_ray_is_inside_the_domain() {
        let domain = [(-2.0, 2.0), (-1.0, 0.7), (0.1, 2.0)].map(|(lo, hi)| Interval::new(lo, hi).unwrap());
        let mut rng = fastrand::Rng::with_seed(3);
        let mut number = |scale: f64| (rng.f64() * 2.0 - 1.0) * scale;
        let mut hits = 0;
        for _ in 0..20_000 {
            let direction = [1.0, number(1.5), number(1.5)];
            let ray = Ray { origin: [number(9.0), number(3.0), number(3.0)], direction };
            let Some((entry, exit)) = ray.clip(&domain) else { continue };
            let at = |t: f64, c: usize| {
                Interval::point(ray.origin[c]) + Interval::point(t) * Interval::point(ray.direction[c])
            };
            for t in [entry[1], exit[0]] {
                if entry[1] <= t && t <= exit[0] {
                    hits += 1;
                    assert!((0..3).all(|c| domain[c].contains_interval(at(t, c))), "{ray:?} leaves the domain at {t}");
                }
            }
            // Before the earliest entry and after the latest exit, some coordinate is outside.
            for t in [entry[0].next_down(), exit[1].next_up()] {
                let outside = t < 0.0 || (0..3).any(|c| !domain[c].contains(ray.at(t)[c]));
                assert!(outside || (0..3).any(|c| !domain[c].contains_interval(at(t, c))), "{ray:?} is inside at {t}");
            }
        }
        assert!(hits > 1000);
    }
}
