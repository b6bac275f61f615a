//! Small pictures, ray by ray against exact polynomials and beside plain root finding on the very same rays.

use std::fmt;

use imp::program::scene::Scene;
use imp::render::Certainty;
use imp::render::Control;
use imp::render::Depth;
use imp::render::Layers;
use imp::render::Options;
use imp::render::Picture;
use imp::render::Ray;
use imp::render::Renderer;
use imp::session;
use imp::session::Source;

use crate::case::Case;
use crate::exact::is_clear;
use crate::exact::is_defined;
use crate::exact::sign;
use crate::plain::Plain;
use crate::plain::Surface;
use crate::plain::march;
use crate::plain::value;

/// A picture with its rays.
pub struct Shot {
    pub scene: Scene,
    pub renderer: Renderer,
    pub picture: Picture,
}

/// One ray of a picture and what is known of it.
pub struct Look {
    pub ray: Ray,
    /// Where the ray is inside the domain, less a margin for the rounding of these very numbers.
    pub inside: [f64; 2],
    pub certainty: Certainty,
    pub depth: Option<Depth>,
}

/// Options of a picture of depths and certainties alone.
pub fn options(size: u32) -> Options {
    let layers = Layers { color: false, depth: true, normal: false, certainty: true };
    Options { width: size, height: size, layers, ..Options::default() }
}

/// Renders a source text.
pub fn shoot(text: &str, options: &Options) -> Shot {
    let artefact = session::compile(Source::Text { name: "case.imp", text }, &[]);
    let scene = artefact.scene.unwrap_or_else(|| panic!("{text}: {:?}", artefact.diagnostics));
    let renderer = Renderer::new(&scene, options, session::backend()).expect("the scene can be drawn");
    let picture = renderer.render(&scene.parameters, &Control::default()).expect("nobody cancels it");
    Shot { scene, renderer, picture }
}

impl Shot {
    /// Every ray that enters the domain for more than a margin.
    pub fn looks(&self) -> Vec<Look> {
        let (width, height) = (self.picture.width, self.picture.height);
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        pixels.filter_map(|(x, y)| self.look(x, y)).collect()
    }

    fn look(&self, x: u32, y: u32) -> Option<Look> {
        let ray = self.renderer.ray(x, y).expect("a pixel of a space scene");
        let (mut entry, mut exit, mut margin) = (0.0f64, f64::INFINITY, 0.0f64);
        for (axis, range) in self.scene.domain.iter().enumerate() {
            let (o, d) = (ray.origin[axis], ray.direction[axis]);
            if d == 0.0 {
                if !range.contains(o) {
                    return None;
                }
                continue;
            }
            let ends = [range.lo(), range.hi()].map(|face| (face - o) / d);
            entry = entry.max(ends[0].min(ends[1]));
            exit = exit.min(ends[0].max(ends[1]));
            margin = margin.max(2f64.powi(-48) * (o.abs() + range.mag()) / d.abs());
        }
        let inside = [entry + margin, exit - margin];
        let index = self.picture.index(x, y);
        let (certainty, depth) = (self.picture.certainty[index], self.picture.depth[index]);
        (inside[0] < inside[1]).then_some(Look { ray, inside, certainty, depth })
    }

    /// Cells, pieces and points that all kernels have tried.
    pub fn evaluations(&self) -> u64 {
        let e = self.picture.stats.evaluations;
        e.beam + e.slope + e.root + e.ends + e.piece + e.face
    }
}

/// Rays by what Imp says of them; whatever is proved has been checked exactly.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tally {
    pub proved: usize,
    pub missed: usize,
    pub unknown: usize,
}

/// As in the table.
impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} proved, {} missed, {} unknown", self.proved, self.missed, self.unknown)
    }
}

/// Holds every proved ray against the exact polynomial.
///
/// A proved hit needs opposite signs at the ends of its bracket, no zero before and no pole inside; a proved miss needs a
/// ray without a zero.
pub fn check<S: Surface>(looks: &[Look]) -> Tally {
    let mut tally = Tally::default();
    for look in looks {
        let Look { ray, inside: [entry, exit], certainty, depth } = look;
        match (certainty, depth) {
            (Certainty::Hit, Some(depth)) => {
                let [a, b] = depth.bracket;
                assert!(a < b, "{}: {depth:?}", S::TEXT);
                let signs = [sign::<S>(ray, a), sign::<S>(ray, b)];
                assert!(signs[0] * signs[1] == -1, "{}: no crossing in {depth:?} of {ray:?}, {signs:?}", S::TEXT);
                assert!(is_defined::<S>(ray, a, b), "{}: a pole in {depth:?} of {ray:?}", S::TEXT);
                assert!(*entry >= a || is_clear::<S>(ray, *entry, a), "{}: a zero before {depth:?}, {ray:?}", S::TEXT);
                tally.proved += 1;
            }
            (Certainty::Miss, None) => {
                assert!(is_clear::<S>(ray, *entry, *exit), "{}: a zero on the missing {ray:?}", S::TEXT);
                tally.missed += 1;
            }
            (Certainty::Unknown, _) => tally.unknown += 1,
            other => panic!("{}: {other:?}", S::TEXT),
        }
    }
    tally
}

/// What a plain root finder makes of the rays that Imp decides.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Faults {
    /// Nothing found where there is a root.
    pub lost: usize,
    /// Another place than the first root.
    pub wrong: usize,
    /// A root found where there is none.
    pub invented: usize,
}

/// As a reader wants it: `12 lost, 3 wrong`.
impl fmt::Display for Faults {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let parts = [(self.lost, "lost"), (self.wrong, "wrong"), (self.invented, "invented")];
        let parts: Vec<String> =
            parts.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")).collect();
        f.write_str(&if parts.is_empty() { "no fault".to_owned() } else { parts.join(", ") })
    }
}

/// Judges a root finder on checked rays. A root farther from the proved bracket than `tolerance` of the ray's way inside
/// the domain is a wrong one.
pub fn faults(looks: &[Look], tolerance: f64, find: impl Fn(&Ray, [f64; 2]) -> Option<f64>) -> Faults {
    let mut faults = Faults::default();
    for look in looks {
        let far = tolerance * (look.inside[1] - look.inside[0]);
        match (look.certainty, look.depth, find(&look.ray, look.inside)) {
            (Certainty::Hit, Some(_), None) => faults.lost += 1,
            (Certainty::Hit, Some(depth), Some(t)) => {
                let [a, b] = depth.bracket;
                faults.wrong += usize::from(t < a - far || t > b + far);
            }
            (Certainty::Miss, _, Some(_)) => faults.invented += 1,
            _ => {}
        }
    }
    faults
}

/// Steps of the plain march. Not a round number, which would put a sample into the middle of a symmetric domain.
pub const STEPS: u32 = 997;

/// The faults of marching in equal steps.
pub fn marching<T: Plain, S: Surface>(looks: &[Look]) -> Faults {
    faults(looks, 1e-3, |ray, inside| march(|t: T| value::<T, S>(ray, t), inside, STEPS))
}

/// What a surface looks like from several cameras, checked.
pub struct Survey {
    pub looks: Vec<Look>,
    pub tally: Tally,
    pub evaluations: u64,
}

impl Survey {
    /// Renders the surface once for each view: the statements of domain and camera.
    pub fn new<S: Surface>(views: &[String], options: &Options) -> Self {
        let (mut looks, mut evaluations) = (Vec::new(), 0);
        for view in views {
            let shot = shoot(&format!("{}\n{view}", S::TEXT), options);
            looks.extend(shot.looks());
            evaluations += shot.evaluations();
        }
        let tally = check::<S>(&looks);
        Self { looks, tally, evaluations }
    }

    /// The case of this survey against plain root finders of both formats.
    pub fn case(&self, name: &'static str, why: &'static str, [single, double]: [Faults; 2]) -> Case {
        Case {
            name,
            why,
            single: single.to_string(),
            double: double.to_string(),
            imp: self.tally.to_string(),
            cost: format!("{} evaluations for {} rays", self.evaluations, self.looks.len()),
        }
    }

    /// The faults of marching in both formats.
    pub fn marched<S: Surface>(&self) -> [Faults; 2] {
        [marching::<f32, S>(&self.looks), marching::<f64, S>(&self.looks)]
    }
}

/// A camera at `eye` that sees a square window of a side around `target`.
pub fn window(domain: &str, eye: [f64; 3], target: [f64; 3], side: f64) -> String {
    let distance = (0..3).map(|i| (eye[i] - target[i]).powi(2)).sum::<f64>().sqrt();
    let fov = 2.0 * (side / 2.0 / distance).atan().to_degrees();
    format!("domain {domain}\ncamera(position = {eye:?}, target = {target:?}, fov = {fov:?})")
}
