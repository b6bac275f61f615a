//! What a picture is measured against, and the measures: a reference of much higher accuracy, of which only what it
//! proves counts.

use serde::Serialize;

use crate::render::Certainty;
use crate::render::Depth;
use crate::render::Picture;

/// How many wanted cells a hit may lie from the reference before it counts as astray: on another sheet, most likely.
const ASTRAY: f64 = 16.0;

/// One level's answer, pixel by pixel.
#[derive(Debug, Clone, Default)]
pub struct Drawn {
    /// Where something is drawn.
    pub hits: Vec<Option<Depth>>,
    /// Whether the answer, hit or miss, is claimed as proved.
    pub proved: Vec<bool>,
    /// Whether the level itself says that it is undecided.
    pub unknown: Vec<bool>,
}

impl Drawn {
    /// A picture that was rendered with its depths.
    pub fn new(picture: &Picture) -> Self {
        let is = |kinds: &[Certainty]| picture.certainty.iter().map(|kind| kinds.contains(kind)).collect();
        Self {
            hits: picture.depth.clone(),
            proved: is(&[Certainty::Hit, Certainty::Miss]),
            unknown: is(&[Certainty::Unknown, Certainty::Unverified]),
        }
    }
}

/// What the reference proves of a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Known {
    Hit {
        bracket: [f64; 2],
        t: f64,
    },
    Miss,
    /// Undecided; such pixels are left out of every comparison.
    Nothing,
}

/// The reference.
#[derive(Debug, Clone)]
pub struct Truth {
    pub width: u32,
    pub pixels: Vec<Known>,
    /// Scene units in one unit of t, by pixel.
    pub speed: Vec<f64>,
    /// The domain's longest side.
    pub side: f64,
    /// Pixels with another answer in their neighbourhood of 3x3.
    silhouette: Vec<bool>,
    /// The thin parts, each as its pixels.
    parts: Vec<Vec<usize>>,
}

/// How far a level's picture is from the reference. All lengths are in the scene's units, along the ray.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Errors {
    /// The mean over the compared pixels of the distance to the reference's hit, in sides of the domain and at most 1; a
    /// pixel that is wrong counts as 1.
    pub error: f64,
    /// Pixels that the reference decides.
    pub compared: u64,
    /// Pixels where one has a hit and the other a miss: `missed` and `invented` together.
    pub wrong: u64,
    /// Hits of the reference that were not drawn.
    pub missed: u64,
    /// Pixels drawn where the reference proves a miss.
    pub invented: u64,
    /// Wrong pixels beside the reference's silhouette.
    pub wrong_at_silhouette: u64,
    /// Claims of proof that the reference's proof contradicts: 0, or one of the two is broken.
    pub contradicted: u64,
    /// Thin parts of the reference.
    pub thin_parts: u64,
    /// Thin parts of which no pixel was hit.
    pub thin_parts_missed: u64,
    /// Distance from the drawn hit to the reference's.
    pub depth_median: Option<f64>,
    pub depth_max: Option<f64>,
    /// The same in wanted cells.
    pub depth_median_cells: Option<f64>,
    pub depth_max_cells: Option<f64>,
    /// Hits more than 16 wanted cells away.
    pub astray: u64,
    /// Median length of the brackets that the level gives for its hits.
    pub bracket_median: Option<f64>,
}

impl Errors {
    /// For pictures without depth.
    pub fn leave_out_depths(&mut self) {
        (self.depth_median, self.depth_max) = (None, None);
        (self.depth_median_cells, self.depth_max_cells) = (None, None);
        self.bracket_median = None;
    }
}

impl Truth {
    /// What an answer proves; `speed` is the number of scene units in one of t, by pixel.
    pub fn new(reference: &Drawn, width: u32, speed: Vec<f64>, side: f64) -> Self {
        let known = |(hit, &proved): (&Option<Depth>, &bool)| match (hit, proved) {
            (Some(hit), true) => Known::Hit { bracket: hit.bracket, t: hit.t },
            (None, true) => Known::Miss,
            (_, false) => Known::Nothing,
        };
        let pixels = reference.hits.iter().zip(&reference.proved).map(known).collect();
        Self::of_pixels(width, pixels, speed, side)
    }

    fn of_pixels(width: u32, pixels: Vec<Known>, speed: Vec<f64>, side: f64) -> Self {
        let hits: Vec<bool> = pixels.iter().map(|known| matches!(known, Known::Hit { .. })).collect();
        let raster = Raster { width: width as usize, pixels: hits.len() };
        let silhouette = (0..hits.len())
            .map(|index| {
                raster
                    .neighbourhood(index)
                    .any(|near| std::mem::discriminant(&pixels[near]) != std::mem::discriminant(&pixels[index]))
            })
            .collect();
        let parts = raster.groups(&raster.thin(&hits));
        Self { width, pixels, speed, side, silhouette, parts }
    }

    /// The distance along the ray between the reference's hit and a drawn one.
    pub fn distance(&self, index: usize, hit: &Depth) -> Option<f64> {
        match self.pixels[index] {
            Known::Hit { t, .. } => Some((hit.t - t).abs() * self.speed[index]),
            _ => None,
        }
    }

    /// The number of thin parts.
    pub fn thin_parts(&self) -> u64 {
        self.parts.len() as u64
    }

    /// Compares a picture of the same pixels; `cell` is the wanted length of its brackets in t.
    pub fn judge(&self, drawn: &Drawn, cell: f64) -> Errors {
        let mut errors = Errors { thin_parts: self.thin_parts(), ..Errors::default() };
        let (mut distances, mut cells, mut brackets) = (Vec::new(), Vec::new(), Vec::new());
        let mut sum = 0.0;
        for (index, known) in self.pixels.iter().enumerate() {
            let hit = drawn.hits[index].as_ref();
            brackets.extend(hit.map(|hit| (hit.bracket[1] - hit.bracket[0]) * self.speed[index]));
            let contradicted = match (known, hit) {
                (Known::Nothing, _) => continue,
                (Known::Miss, None) => false,
                (Known::Hit { bracket, .. }, Some(hit)) => hit.bracket[0] > bracket[1] || hit.bracket[1] < bracket[0],
                (Known::Hit { .. }, None) | (Known::Miss, Some(_)) => true,
            };
            errors.compared += 1;
            errors.contradicted += u64::from(contradicted && drawn.proved[index]);
            match hit.and_then(|hit| self.distance(index, hit)) {
                Some(distance) => {
                    let in_cells = distance / (cell * self.speed[index]);
                    errors.astray += u64::from(in_cells > ASTRAY);
                    // A hit at no finite place is as wrong as none.
                    sum += (distance / self.side).min(1.0);
                    distances.push(distance);
                    cells.push(in_cells);
                }
                None if hit.is_none() && *known == Known::Miss => {}
                None => {
                    errors.missed += u64::from(hit.is_none());
                    errors.invented += u64::from(hit.is_some());
                    errors.wrong += 1;
                    errors.wrong_at_silhouette += u64::from(self.silhouette[index]);
                    sum += 1.0;
                }
            }
        }
        let missed = |part: &&Vec<usize>| part.iter().all(|&index| drawn.hits[index].is_none());
        errors.thin_parts_missed = self.parts.iter().filter(missed).count() as u64;
        errors.error = sum / errors.compared.max(1) as f64;
        (errors.depth_median, errors.depth_max) = middle_and_most(distances);
        (errors.depth_median_cells, errors.depth_max_cells) = middle_and_most(cells);
        (errors.bracket_median, _) = middle_and_most(brackets);
        errors
    }
}

/// The upper median and the largest of some numbers.
fn middle_and_most(mut numbers: Vec<f64>) -> (Option<f64>, Option<f64>) {
    numbers.sort_by(f64::total_cmp);
    (numbers.get(numbers.len() / 2).copied(), numbers.last().copied())
}

/// Neighbourhoods in a picture.
struct Raster {
    width: usize,
    pixels: usize,
}

impl Raster {
    /// The pixels of the 3x3 square around one, itself among them, that lie in the picture.
    fn neighbourhood(&self, index: usize) -> impl Iterator<Item = usize> {
        let (x, y) = (index % self.width, index / self.width);
        let (width, height) = (self.width, self.pixels / self.width);
        (y.saturating_sub(1)..(y + 2).min(height))
            .flat_map(move |row| (x.saturating_sub(1)..(x + 2).min(width)).map(move |column| row * width + column))
    }

    /// The hits that no 3x3 square of hits covers: what the morphological opening by that square removes. They are
    /// where the picture is at most two pixels wide, and the tips of its outline.
    fn thin(&self, hits: &[bool]) -> Vec<bool> {
        let mut thin = hits.to_vec();
        for centre in 0..self.pixels {
            let square: Vec<usize> = self.neighbourhood(centre).collect();
            if square.len() == 9 && square.iter().all(|&index| hits[index]) {
                for index in square {
                    thin[index] = false;
                }
            }
        }
        thin
    }

    /// The groups of marked pixels that touch at sides or corners.
    fn groups(&self, marked: &[bool]) -> Vec<Vec<usize>> {
        let mut open = marked.to_vec();
        let mut groups = Vec::new();
        for start in 0..self.pixels {
            if !std::mem::take(&mut open[start]) {
                continue;
            }
            let mut group = vec![start];
            let mut next = 0;
            while let Some(&index) = group.get(next) {
                next += 1;
                for near in self.neighbourhood(index) {
                    if std::mem::take(&mut open[near]) {
                        group.push(near);
                    }
                }
            }
            groups.push(group);
        }
        groups
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::Surface;

    fn hit(t: f64) -> Option<Depth> {
        let bracket = [t - 0.01, t + 0.01];
        Some(Depth { shape: 0, surface: Surface::Field, bracket, t, distance: t })
    }

    /// A picture of `#` for hits at t = 5, `.` for misses and `?` for what is unknown.
    fn truth(rows: &[&str]) -> (Truth, Drawn) {
        let text: String = rows.concat();
        let known = |c: char| match c {
            '#' => Known::Hit { bracket: [4.99, 5.01], t: 5.0 },
            '.' => Known::Miss,
            _ => Known::Nothing,
        };
        let pixels: Vec<Known> = text.chars().map(known).collect();
        let drawn = Drawn {
            hits: text.chars().map(|c| (c == '#').then(|| hit(5.0)).flatten()).collect(),
            proved: text.chars().map(|c| c != '?').collect(),
            unknown: text.chars().map(|c| c == '?').collect(),
        };
        let count = pixels.len();
        (Truth::of_pixels(rows[0].len() as u32, pixels, vec![2.0; count], 10.0), drawn)
    }

    const BLOCK_AND_NEEDLE: &[&str] = &["......#", ".###..#", ".###..#", ".###..#", "......#", "?......"];

    #[test]
    fn the_reference_has_no_error_against_itself() {
        let (truth, drawn) = truth(BLOCK_AND_NEEDLE);
        let errors = truth.judge(&drawn, 0.1);
        assert_eq!((errors.error, errors.wrong, errors.contradicted, errors.thin_parts_missed), (0.0, 0, 0, 0));
        assert_eq!((errors.compared, errors.thin_parts), (41, 1));
        assert_eq!((errors.depth_max, errors.astray), (Some(0.0), 0));
    }

    #[test]
    fn wrong_pixels_and_lost_parts_are_seen() {
        let (truth, mut drawn) = truth(BLOCK_AND_NEEDLE);
        // The needle is lost, and one corner of the picture is drawn that is empty.
        for row in 0..5 {
            drawn.hits[7 * row + 6] = None;
        }
        drawn.hits[0] = hit(3.0);
        drawn.proved[0] = false;
        let errors = truth.judge(&drawn, 0.1);
        assert_eq!((errors.wrong, errors.missed, errors.invented), (6, 5, 1));
        assert_eq!((errors.thin_parts_missed, errors.contradicted), (1, 5));
        assert_eq!(errors.wrong_at_silhouette, 6);
        assert!((errors.error - 6.0 / 41.0).abs() < 1e-15);
    }

    #[test]
    fn depth_is_measured_along_the_ray_and_in_cells() {
        let (truth, mut drawn) = truth(&["###", "###", "###"]);
        drawn.hits[4] = hit(6.0);
        let errors = truth.judge(&drawn, 0.05);
        assert_eq!((errors.depth_median, errors.depth_max), (Some(0.0), Some(2.0)));
        assert!((errors.depth_max_cells.unwrap() - 20.0).abs() < 1e-12 && errors.astray == 1);
        // Its bracket does not meet the reference's, and it claims a proof.
        assert_eq!((errors.wrong, errors.contradicted), (0, 1));
        assert!((errors.error - 0.2 / 9.0).abs() < 1e-15);
    }

    #[test]
    fn what_the_reference_leaves_open_is_left_out() {
        let (truth, mut drawn) = truth(&["?#", ".."]);
        drawn.hits[0] = hit(1.0);
        let errors = truth.judge(&drawn, 0.1);
        assert_eq!((errors.compared, errors.wrong), (3, 0));
    }
}
