//! From hits to colours: normals by the gradient kernel, then Phong's model (1975) in linear light.

use glam::DVec3;

use crate::interval::Interval;
use crate::program::scene::Light;
use crate::program::scene::LightPlacement;
use crate::program::scene::Material;
use crate::program::scene::View;
use crate::render::batch::Batch;
use crate::render::batch::Program;
use crate::render::camera::Camera;
use crate::render::camera::Ray;
use crate::render::march::GROUPS;
use crate::render::outcome::Surface;

/// Colours of shapes in their order, sRGB, told apart by people with any colour vision (after Okabe and Ito 2008).
pub const PALETTE: [[f64; 3]; 6] = [
    [0.34, 0.60, 0.86],
    [0.90, 0.60, 0.16],
    [0.22, 0.66, 0.50],
    [0.80, 0.47, 0.66],
    [0.88, 0.82, 0.30],
    [0.82, 0.38, 0.20],
];

/// A shape's material where the scene gives none.
fn default_material(shape: usize) -> Material {
    let color = PALETTE[shape % PALETTE.len()];
    Material { color, ambient: 0.16, diffuse: 0.78, specular: 0.22, shininess: 42.0 }
}

/// The background where the scene gives none: sRGB at the top and at the bottom.
const SKY: [[f64; 3]; 2] = [[0.955, 0.965, 0.98], [0.80, 0.835, 0.88]];

/// Below this share of the field's usual gradient, the gradient at a point is too near a singularity for a normal.
const FLAT: f64 = 1e-9;

/// How far from there gradients are taken instead, relative to the domain.
const STENCIL: f64 = 1e-3;

/// A drawn point that wants a normal.
#[derive(Debug, Clone, Copy)]
pub struct Spot {
    pub ray: Ray,
    pub t: f64,
    pub shape: usize,
    pub surface: Surface,
    /// Solids keep the outward normal; both sides of a zero set are shown alike.
    pub solid: bool,
}

/// Gradients of one shape, for one worker.
pub struct Gradients {
    batch: Batch<f64>,
    /// The usual length of a gradient in the domain.
    usual: f64,
    stencil: f64,
}

impl Gradients {
    pub fn new(program: &Program<f64>, usual: f64, domain: &[Interval]) -> Self {
        let extent = domain.iter().map(|range| range.width()).fold(0.0, f64::max);
        Self { batch: Batch::new(program, GROUPS), usual, stencil: STENCIL * extent }
    }

    pub fn evaluations(&self) -> u64 {
        self.batch.evaluations
    }

    /// The median length of the gradient over a lattice in the domain.
    pub fn usual(program: &Program<f64>, domain: &[Interval]) -> f64 {
        let mut gradients = Self::new(program, 0.0, domain);
        let place = |axis: usize, step: usize| {
            let range = domain[axis];
            range.lo() + range.width() * (step as f64 + 0.5) / 4.0
        };
        let lattice: Vec<[f64; 3]> =
            (0..64).map(|i| [place(0, i % 4), place(1, i / 4 % 4), place(2, i / 16)]).collect();
        let mut lengths: Vec<f64> = gradients.run(&lattice).iter().map(|(_, gradient)| gradient.length()).collect();
        lengths.retain(|length| length.is_finite());
        lengths.sort_by(f64::total_cmp);
        lengths.get(lengths.len() / 2).copied().unwrap_or(0.0)
    }

    /// Field and gradient at points.
    fn run(&mut self, points: &[[f64; 3]]) -> Vec<(f64, DVec3)> {
        let mut results = Vec::with_capacity(points.len());
        for points in points.chunks(self.batch.capacity()) {
            for (lane, point) in points.iter().enumerate() {
                for (slot, &coordinate) in point.iter().enumerate() {
                    self.batch.set(lane, slot, coordinate);
                }
            }
            self.batch.run(points.len());
            results.extend((0..points.len()).map(|lane| {
                let slot = |slot| self.batch.get(lane, slot);
                (slot(0), DVec3::new(slot(1), slot(2), slot(3)))
            }));
        }
        results
    }

    /// Normals of spots of this shape. Where the gradient vanishes or is undefined, those around it take its place, and
    /// where they fail too the surface faces the viewer.
    pub fn normals(&mut self, spots: &[Spot]) -> Vec<DVec3> {
        let points: Vec<[f64; 3]> = spots.iter().map(|spot| spot.ray.at(spot.t)).collect();
        let gradients = self.run(&points);
        let mut normals = Vec::with_capacity(spots.len());
        for ((spot, point), (_, gradient)) in spots.iter().zip(&points).zip(gradients) {
            let view = -DVec3::from(spot.ray.direction);
            let normal = match spot.surface {
                Surface::Face(axis) => {
                    let mut normal = DVec3::ZERO;
                    normal[usize::from(axis)] = view[usize::from(axis)].signum();
                    Some(normal)
                }
                Surface::Eye | Surface::Cut => None,
                Surface::Field => {
                    let length = gradient.length();
                    let plain = (length.is_finite() && length > FLAT * self.usual).then(|| gradient / length);
                    plain.or_else(|| self.around(*point))
                }
            };
            let normal = normal.unwrap_or_else(|| view.normalize());
            let away = normal.dot(view) < 0.0;
            normals.push(if away && !spot.solid { -normal } else { normal });
        }
        normals
    }

    /// The direction that the gradients around a point have in common. Where the field is a power of one with a gradient,
    /// as (g)^3 is, they are multiples of it with either sign, so they are summed as the longest one points; differences
    /// of the field itself would be powers of that gradient's components.
    fn around(&mut self, point: [f64; 3]) -> Option<DVec3> {
        let mut points = [point; 6];
        for axis in 0..3 {
            points[2 * axis][axis] += self.stencil;
            points[2 * axis + 1][axis] -= self.stencil;
        }
        let gradients = self.run(&points).into_iter().map(|(_, gradient)| gradient);
        let gradients: Vec<DVec3> = gradients.filter(|gradient| gradient.is_finite()).collect();
        let longest = *gradients.iter().max_by(|a, b| a.length().total_cmp(&b.length()))?;
        let aligned = |gradient: &DVec3| if gradient.dot(longest) < 0.0 { -gradient } else { *gradient };
        gradients.iter().map(aligned).sum::<DVec3>().try_normalize()
    }
}

/// sRGB to linear light (IEC 61966-2-1).
fn linear(encoded: f64) -> f64 {
    let c = encoded.clamp(0.0, 1.0);
    if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

/// Linear light to sRGB.
fn encoded(linear: f64) -> f64 {
    let c = linear.clamp(0.0, 1.0);
    if c <= 0.0031308 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
}

fn to_linear(color: [f64; 3]) -> DVec3 {
    DVec3::from_array(color.map(linear))
}

/// Lights, materials and background of a picture.
#[derive(Debug, Clone)]
pub struct Shading {
    lights: Vec<Light>,
    materials: Vec<(Material, DVec3)>,
    /// Colours of the background by row.
    background: Vec<[u8; 3]>,
    /// The 8-bit sRGB code of linear light in steps of 1 / 4095: finer than 8-bit codes are apart, save for the darkest
    /// few.
    codes: Vec<u8>,
}

impl Shading {
    pub fn new(view: &View, camera: &Camera, shapes: usize) -> Self {
        let lights = view.lights.clone().unwrap_or_else(|| {
            let (right, up) = (camera.right.normalize(), camera.up.normalize());
            let key = -camera.forward - 0.55 * right + 0.75 * up;
            let fill = -0.5 * camera.forward + right + 0.1 * up;
            vec![
                Light { placement: LightPlacement::Direction(key.into()), color: [0.95, 0.94, 0.90] },
                Light { placement: LightPlacement::Direction(fill.into()), color: [0.16, 0.19, 0.24] },
            ]
        });
        let materials = (0..shapes).map(|shape| {
            let own = view.materials.iter().find(|(index, _)| *index == shape).map(|&(_, material)| material);
            let material = own.or(view.material).unwrap_or_else(|| default_material(shape));
            (material, to_linear(material.color))
        });
        let materials = materials.collect();
        let codes: Vec<u8> = (0..4096).map(|i| (255.0 * encoded(f64::from(i) / 4095.0)).round() as u8).collect();
        let [top, bottom] = view.background.map_or(SKY, |color| [color; 2]).map(to_linear);
        let last = f64::from(camera.height.max(2) - 1);
        let shade = |y: u32| encode(&codes, top.lerp(bottom, f64::from(y) / last));
        let background = (0..camera.height).map(shade).collect();
        Self { lights, materials, background, codes }
    }

    /// Whether any light shines, so that normals are needed.
    pub fn is_lit(&self) -> bool {
        !self.lights.is_empty()
    }

    pub fn background(&self, y: u32) -> [u8; 3] {
        self.background[y as usize]
    }

    /// A shape's own colour, where no light shines.
    pub fn flat(&self, shape: usize) -> [u8; 3] {
        encode(&self.codes, self.materials[shape].1)
    }

    /// The colour of a spot with its normal.
    pub fn color(&self, spot: &Spot, normal: DVec3) -> [u8; 3] {
        let (material, base) = &self.materials[spot.shape];
        let view = -DVec3::from(spot.ray.direction).normalize();
        let mut sum = material.ambient * *base;
        for light in &self.lights {
            let towards = match light.placement {
                LightPlacement::Direction(direction) => DVec3::from(direction),
                LightPlacement::Position(position) => DVec3::from(position) - DVec3::from(spot.ray.at(spot.t)),
            };
            let towards = towards.normalize_or_zero();
            let cosine = normal.dot(towards);
            if cosine <= 0.0 {
                continue;
            }
            let mirrored = 2.0 * cosine * normal - towards;
            let gloss = material.specular * power(mirrored.dot(view).max(0.0), material.shininess);
            sum += DVec3::from(light.color) * (material.diffuse * cosine * *base + DVec3::splat(gloss));
        }
        encode(&self.codes, sum)
    }
}

/// x^y, quickly for the whole y that materials usually have.
fn power(x: f64, y: f64) -> f64 {
    if y.fract() == 0.0 && y.abs() < 1000.0 { x.powi(y as i32) } else { x.powf(y) }
}

fn encode(codes: &[u8], color: DVec3) -> [u8; 3] {
    color.to_array().map(|c| codes[(c.clamp(0.0, 1.0) * 4095.0 + 0.5) as usize])
}
