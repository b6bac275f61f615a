//! Where the pixels of a plane scene are.

use crate::interval::Interval;

/// By how much of a pixel the raster is moved against the domain, so that curves along round numbers, which axes and
/// symmetries are, do not run exactly along the edges of pixels, where no sign can be proved.
const OFFSET: [f64; 2] = [0.0137, 0.0219];

/// The raster of a plane scene: pixel (i, j) is [x_i, x_(i+1)] x [y_(j+1), y_j].
#[derive(Debug, Clone)]
pub struct Raster {
    /// Edges of columns, rising, and of rows, falling: shared by neighbours, so that no gap can open.
    pub x: Vec<f64>,
    pub y: Vec<f64>,
    /// The side of a pixel.
    pub pixel: f64,
    pub domain: [Interval; 2],
}

impl Raster {
    pub fn new(domain: &[Interval], width: u32, height: u32) -> Self {
        let domain = [domain[0], domain[1]];
        let pixel = (domain[0].width() / f64::from(width)).max(domain[1].width() / f64::from(height));
        let edges = |axis: usize, count: u32, direction: f64| {
            let centre = domain[axis].mid() + OFFSET[axis] * pixel;
            let place = |i: u32| centre + direction * pixel * (f64::from(i) - 0.5 * f64::from(count));
            (0..=count).map(place).collect()
        };
        Self { x: edges(0, width, 1.0), y: edges(1, height, -1.0), pixel, domain }
    }

    /// Columns and rows.
    pub fn size(&self) -> (u32, u32) {
        (self.x.len() as u32 - 1, self.y.len() as u32 - 1)
    }

    /// The part of a block of pixels that lies in the domain; `None` if there is none.
    pub fn clip(&self, x: u32, y: u32, size: u32) -> Option<[Interval; 2]> {
        let (width, height) = self.size();
        let (right, bottom) = ((x + size).min(width), (y + size).min(height));
        let columns = Interval::new(self.x[x as usize], self.x[right as usize])?;
        let rows = Interval::new(self.y[bottom as usize], self.y[y as usize])?;
        let area = [columns.intersect(self.domain[0]), rows.intersect(self.domain[1])];
        area.iter().all(|side| !side.is_empty()).then_some(area)
    }

    /// The middle of a pixel.
    pub fn centre(&self, x: usize, y: usize) -> [f64; 2] {
        [0.5 * (self.x[x] + self.x[x + 1]), 0.5 * (self.y[y] + self.y[y + 1])]
    }
}

/// The four parts of an area, which share their ends.
pub fn quarters([x, y]: [Interval; 2]) -> [[Interval; 2]; 4] {
    let halves = |side: Interval| {
        let middle = side.mid();
        [(side.lo(), middle), (middle, side.hi())].map(|(lo, hi)| Interval::new(lo, hi).unwrap_or(side))
    };
    let ([left, right], [low, high]) = (halves(x), halves(y));
    [[left, low], [right, low], [left, high], [right, high]]
}

/// The corners of an area.
pub fn corners([x, y]: [Interval; 2]) -> [[f64; 2]; 4] {
    [[x.lo(), y.lo()], [x.hi(), y.lo()], [x.lo(), y.hi()], [x.hi(), y.hi()]]
}
