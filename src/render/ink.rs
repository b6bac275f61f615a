//! The colours of plane scenes: paper with a light grid, fills of regions, strokes of curves.

use rayon::prelude::*;

use crate::program::scene::Scene;
use crate::program::scene::ShapeKind;
use crate::render::batch::Batch;
use crate::render::batch::Program;
use crate::render::march::GROUPS;
use crate::render::plane::Place;
use crate::render::plane::raster::Raster;
use crate::render::shade::PALETTE;

const PAPER: [f64; 3] = [0.99, 0.99, 0.985];
/// Paper outside the domain.
const MARGIN: [f64; 3] = [0.93, 0.93, 0.925];
const GRID: [f64; 3] = [0.86, 0.87, 0.89];
const AXIS: [f64; 3] = [0.45, 0.47, 0.52];

/// Pixels of which nothing is proved.
const UNKNOWN: [f64; 3] = [0.91, 0.10, 0.12];

/// Half the width of a stroke in pixels, for a picture of 512 pixels; it grows with the picture.
const HALF_STROKE: f64 = 1.1;

/// How much of a region's colour its fill has.
const FILL: f64 = 0.38;

/// Everything that is drawn.
pub struct Canvas<'a> {
    pub scene: &'a Scene,
    pub raster: &'a Raster,
    pub places: &'a [Vec<Place>],
    pub gradients: &'a [Option<Program<f64>>],
}

impl Canvas<'_> {
    /// The pixels, row by row, and how often gradients were evaluated.
    pub fn draw(&self) -> (Vec<[u8; 3]>, u64) {
        let height = self.raster.y.len() - 1;
        let lines = [0, 1].map(|axis| self.lines(axis));
        let lines = [&lines[0][..], &lines[1][..]];
        let rows: Vec<(Vec<[u8; 3]>, u64)> = (0..height).into_par_iter().map(|y| self.row(y, lines)).collect();
        let evaluations = rows.iter().map(|(_, evaluations)| evaluations).sum();
        (rows.into_iter().flat_map(|(row, _)| row).collect(), evaluations)
    }

    fn row(&self, y: usize, [columns, rows]: [&[Line]; 2]) -> (Vec<[u8; 3]>, u64) {
        let (width, height) = (columns.len(), rows.len());
        let mut colors = vec![PAPER; width];
        for (x, color) in colors.iter_mut().enumerate() {
            *color = match (columns[x], rows[y]) {
                (Line::Outside, _) | (_, Line::Outside) => MARGIN,
                (Line::Axis, _) | (_, Line::Axis) => AXIS,
                (Line::Grid, _) | (_, Line::Grid) => GRID,
                (Line::None, Line::None) => PAPER,
            };
        }
        let half = HALF_STROKE * (width.min(height) as f64 / 512.0).max(0.8);
        let mut evaluations = 0;
        for ((places, shape), (index, gradient)) in
            self.places.iter().zip(&self.scene.shapes).zip(self.gradients.iter().enumerate())
        {
            let own = self.scene.view.material.map_or(PALETTE[index % PALETTE.len()], |material| material.color);
            if shape.kind == ShapeKind::Region {
                for (x, color) in colors.iter_mut().enumerate() {
                    if matches!(places[y * width + x], Place::Inside | Place::Unknown) {
                        *color = mix(*color, own, FILL);
                    }
                }
            }
            let Some(program) = gradient else { continue };
            let reach = (half + 1.0).ceil() as usize;
            let near = near(places, [width, height], y, reach);
            let mut batch = Batch::new(program, GROUPS);
            for chunk in near.chunks(batch.capacity()) {
                for (lane, &(x, _)) in chunk.iter().enumerate() {
                    for (slot, coordinate) in self.raster.centre(x, y).into_iter().enumerate() {
                        batch.set(lane, slot, coordinate);
                    }
                }
                batch.run(chunk.len());
                for (lane, &(x, apart)) in chunk.iter().enumerate() {
                    let (value, slope) = (batch.get(lane, 0), batch.get(lane, 1).hypot(batch.get(lane, 2)));
                    // The distance to the zero set in pixels, to first order; no farther than the next pixel that it
                    // crosses, and that distance alone where the gradient says nothing.
                    let distance = (value / slope).abs() / self.raster.pixel;
                    let distance = if distance.is_finite() { distance.clamp(apart - 1.0, apart + 0.5) } else { apart };
                    let cover = (half + 0.5 - distance).clamp(0.0, 1.0);
                    let own = if shape.kind == ShapeKind::Region { own.map(|c| 0.75 * c) } else { own };
                    colors[x] = mix(colors[x], own, cover);
                }
            }
            evaluations += batch.evaluations;
        }
        for (x, color) in colors.iter_mut().enumerate() {
            if self.places.iter().any(|places| places[y * width + x] == Place::Unknown) {
                *color = UNKNOWN;
            }
        }
        (
            colors.into_iter().map(|color| color.map(|c| (255.0 * c.clamp(0.0, 1.0)).round() as u8)).collect(),
            evaluations,
        )
    }

    /// What of the grid is drawn in each column, or row: lines at round numbers.
    fn lines(&self, axis: usize) -> Vec<Line> {
        let edges = if axis == 0 { &self.raster.x } else { &self.raster.y };
        let domain = self.raster.domain;
        let extent = domain[0].width().max(domain[1].width());
        let step = round_step(extent / 8.0);
        let line = |pair: &[f64]| {
            let (lo, hi) = (pair[0].min(pair[1]), pair[0].max(pair[1]));
            let line = (hi / step).floor() * step;
            match line > lo {
                _ if !domain[axis].contains(0.5 * (lo + hi)) => Line::Outside,
                false => Line::None,
                true if line == 0.0 => Line::Axis,
                true => Line::Grid,
            }
        };
        edges.windows(2).map(line).collect()
    }
}

/// What of the grid lies in a column or row of pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Line {
    None,
    Grid,
    Axis,
    /// Beyond the domain.
    Outside,
}

/// 1, 2 or 5 times a power of ten, near the given length.
fn round_step(length: f64) -> f64 {
    let power = 10f64.powf(length.log10().floor());
    let factor = [1.0, 2.0, 5.0, 10.0].into_iter().find(|factor| factor * power >= 0.7 * length);
    factor.unwrap_or(10.0) * power
}

fn mix(under: [f64; 3], over: [f64; 3], share: f64) -> [f64; 3] {
    std::array::from_fn(|c| under[c] + share * (over[c] - under[c]))
}

/// The pixels of a row that have a crossed or unknown pixel within reach, with the distance in pixels to the nearest one.
fn near(places: &[Place], [width, height]: [usize; 2], y: usize, reach: usize) -> Vec<(usize, f64)> {
    let mut squares = vec![usize::MAX; width];
    for row in y.saturating_sub(reach)..=(y + reach).min(height - 1) {
        let up = row.abs_diff(y);
        for (column, place) in places[row * width..(row + 1) * width].iter().enumerate() {
            if !matches!(place, Place::Crossed | Place::Unknown) {
                continue;
            }
            let first = column.saturating_sub(reach);
            for (x, square) in squares[first..(column + reach + 1).min(width)].iter_mut().enumerate() {
                let aside = (first + x).abs_diff(column);
                *square = (*square).min(up * up + aside * aside);
            }
        }
    }
    let reached = squares.into_iter().enumerate().filter(|&(_, square)| square != usize::MAX);
    reached.map(|(x, square)| (x, (square as f64).sqrt())).collect()
}
