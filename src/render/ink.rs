//! The colours of plane scenes: paper with a light grid, fills of regions, strokes of curves.

use rayon::prelude::*;

use crate::program::scene::Scene;
use crate::program::scene::ShapeKind;
use crate::render::batch::Batch;
use crate::render::batch::Program;
use crate::render::march::GROUPS;
use crate::render::plane::Place;
use crate::render::plane::Raster;
use crate::render::shade::PALETTE;

const PAPER: [f64; 3] = [0.99, 0.99, 0.985];
/// Paper outside the domain.
const MARGIN: [f64; 3] = [0.93, 0.93, 0.925];
const GRID: [f64; 3] = [0.86, 0.87, 0.89];
const AXIS: [f64; 3] = [0.45, 0.47, 0.52];

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
        let (width, height) = (self.raster.x.len() - 1, self.raster.y.len() - 1);
        let rows: Vec<(Vec<[u8; 3]>, u64)> = (0..height).into_par_iter().map(|y| self.row(y, width, height)).collect();
        let evaluations = rows.iter().map(|(_, evaluations)| evaluations).sum();
        (rows.into_iter().flat_map(|(row, _)| row).collect(), evaluations)
    }

    fn row(&self, y: usize, width: usize, height: usize) -> (Vec<[u8; 3]>, u64) {
        let mut colors: Vec<[f64; 3]> = (0..width).map(|x| self.paper(x, y)).collect();
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
            let near: Vec<(usize, f64)> =
                (0..width).filter_map(|x| Some((x, nearest(places, width, height, (x, y), reach)?))).collect();
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
        (
            colors.into_iter().map(|color| color.map(|c| (255.0 * c.clamp(0.0, 1.0)).round() as u8)).collect(),
            evaluations,
        )
    }

    /// The colour under everything: grid lines at round numbers, the axes darker.
    fn paper(&self, x: usize, y: usize) -> [f64; 3] {
        let [px, py] = self.raster.centre(x, y);
        if !self.raster.domain[0].contains(px) || !self.raster.domain[1].contains(py) {
            return MARGIN;
        }
        let extent = self.raster.domain[0].width().max(self.raster.domain[1].width());
        let step = round_step(extent / 8.0);
        let on = |edges: [f64; 2]| {
            let (lo, hi) = (edges[0].min(edges[1]), edges[0].max(edges[1]));
            let line = (hi / step).floor() * step;
            (line > lo).then_some(line == 0.0)
        };
        let lines = [on([self.raster.x[x], self.raster.x[x + 1]]), on([self.raster.y[y], self.raster.y[y + 1]])];
        match lines {
            [None, None] => PAPER,
            [Some(true), _] | [_, Some(true)] => AXIS,
            _ => GRID,
        }
    }
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

/// The distance in pixels to the nearest pixel within reach that is crossed or unknown.
fn nearest(places: &[Place], width: usize, height: usize, (x, y): (usize, usize), reach: usize) -> Option<f64> {
    let mut nearest: Option<f64> = None;
    for row in y.saturating_sub(reach)..=(y + reach).min(height - 1) {
        for column in x.saturating_sub(reach)..=(x + reach).min(width - 1) {
            if matches!(places[row * width + column], Place::Crossed | Place::Unknown) {
                let apart = (row.abs_diff(y) as f64).hypot(column.abs_diff(x) as f64);
                nearest = Some(nearest.map_or(apart, |d| d.min(apart)));
            }
        }
    }
    nearest
}
