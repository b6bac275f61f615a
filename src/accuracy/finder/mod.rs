//! The root finders of the literature, by name, as baselines: what each of them finds first along the ray of every pixel,
//! at what cost, and how much of it is proved.
//!
//! A finder of single rays is a state machine (`search`) that asks for enclosures of the field, of its slope along the ray
//! or of its value at a point, and consumes the answers; the marches of Knoll et al. move packets of rays in lockstep
//! (`packet`). A driver (`drive`) gathers the questions of many rays into the lanes of compiled kernels (`kernels`), so
//! that all finders enjoy the same code and differ in their algorithm alone. What a finder claims is what its source
//! says; what is proved of it is settled afterwards (`proof`) and neither timed nor counted.

mod drive;
mod kernels;
mod packet;
mod proof;
mod search;

use std::time::Instant;

use rayon::iter::IntoParallelIterator;
use rayon::iter::ParallelIterator;

use crate::accuracy::finder::drive::Driver;
use crate::accuracy::finder::kernels::Lanes;
use crate::accuracy::finder::kernels::Programs;
use crate::accuracy::finder::kernels::Reach;
use crate::accuracy::finder::packet::Packet;
use crate::accuracy::finder::packet::SIDE;
use crate::accuracy::finder::search::Rules;
use crate::accuracy::finder::search::Search;
use crate::derive::Arithmetic;
use crate::derive::Precision;
use crate::derive::Rounding;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::kernel::Backend;
use crate::program::scene::Scene;
use crate::program::scene::ShapeKind;
use crate::render::Format;
use crate::render::Ray;

pub use crate::accuracy::finder::drive::Evaluations;

/// Rows of pixels that one worker takes at a time; even, so that packets of 2x2 rays lie in one band.
const BAND: u32 = 16;

/// A root finder of the literature.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Finder {
    /// Interval bisection of each ray by itself.
    Bisection,
    /// Bisection until the slope excludes 0, then bisection by the signs of points.
    Mitchell,
    /// Mitchell's method with the interval Newton operator in place of signs.
    IntervalNewton,
    /// The same, with extended division where the slope does not exclude 0.
    AlefeldHansen,
    /// Bisection that looks at the signs of points at the ends of each half.
    Mrf,
    /// The same, without the enclosure of an interval whose ends differ in sign.
    MrfRo,
    /// The same, with the interval Newton operator.
    MrfNewton,
    /// Mitchell's method for 2x2 rays in lockstep.
    PacketMitchell,
    /// Bisection of t for 2x2 rays in lockstep.
    TMarch,
    /// Bisection of the dominant axis for 2x2 rays in lockstep.
    KMarch,
}

impl Finder {
    pub const ALL: [Finder; 10] = [
        Finder::Bisection,
        Finder::Mitchell,
        Finder::IntervalNewton,
        Finder::AlefeldHansen,
        Finder::Mrf,
        Finder::MrfRo,
        Finder::MrfNewton,
        Finder::PacketMitchell,
        Finder::TMarch,
        Finder::KMarch,
    ];

    /// A short name for tables.
    pub fn name(self) -> &'static str {
        match self {
            Finder::Bisection => "bisection",
            Finder::Mitchell => "Mitchell",
            Finder::IntervalNewton => "Newton",
            Finder::AlefeldHansen => "Newton+AH",
            Finder::Mrf => "MRF",
            Finder::MrfRo => "MRFro",
            Finder::MrfNewton => "MRFro+Newton",
            Finder::PacketMitchell => "Mitchell 2x2",
            Finder::TMarch => "t-march",
            Finder::KMarch => "K-march",
        }
    }

    /// Where the method was published, as far as it is followed here.
    pub fn source(self) -> &'static str {
        match self {
            Finder::Bisection => "Hijazi 2008, Alg. 5, without its packets; Flórez 2008, fig. 7.9",
            Finder::Mitchell => "Mitchell 1990; Flórez 2008, fig. 4.6",
            Finder::IntervalNewton => "Capriani et al. 2000; Flórez 2008, fig. 4.7",
            Finder::AlefeldHansen => "Capriani et al. 2000; Flórez 2008, fig. 4.8 and eq. 4.2",
            Finder::Mrf | Finder::MrfRo => "Sanjuan-Estrada et al. 2003; Flórez 2008, section 4.3.3",
            Finder::MrfNewton => "Flórez 2008, section 4.3.4",
            Finder::PacketMitchell | Finder::TMarch => "Knoll et al. 2007, section 6.5",
            Finder::KMarch => "Knoll et al. 2007, section 5.3 and Alg. 2",
        }
    }

    /// Whether rays are searched 2x2 at a time, in lockstep.
    fn is_packet(self) -> bool {
        matches!(self, Finder::PacketMitchell | Finder::TMarch | Finder::KMarch)
    }

    /// Whether the method finds where a ray enters a solid, too: the others look for changes of sign, of which the
    /// field of a solid need not have one where the ray enters the domain.
    pub fn handles_solids(self) -> bool {
        matches!(self, Finder::Bisection | Finder::TMarch | Finder::KMarch)
    }
}

/// How to search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    pub finder: Finder,
    pub precision: Precision,
    /// With [`Rounding::Nearest`], as most of the sources have it, nothing is proved.
    pub rounding: Rounding,
    /// Of the enclosures of the field; those of its slope are natural extensions.
    pub arithmetic: Arithmetic,
    /// The length in the scene's units below which an interval of the ray is not divided any more.
    pub epsilon: f64,
}

/// What a finder found; one entry a pixel, row by row from the top left.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Sampled {
    /// The ray parameters between which the finder claims the first hit.
    pub depth: Vec<Option<[f64; 2]>>,
    /// Whether the claim is proved: everything before the bracket is refuted, the field is continuous on it with proved
    /// opposite signs at its ends, and conditions and domain hold on all of it.
    pub proved: Vec<bool>,
    /// Whether the pixel is neither a proved hit nor a proved miss.
    pub unknown: Vec<bool>,
    /// Lanes evaluated: intervals, points and slopes alike, idle lanes of a packet in lockstep included.
    pub evaluations: u64,
    /// The same by what was asked.
    pub by_kind: Evaluations,
    /// Wall clock of the search, without compilation and without the proofs.
    pub seconds: f64,
}

/// What is known of one ray.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Found {
    hit: Option<[f64; 2]>,
    /// Everything before the hit, or all of the ray, is refuted.
    clear: bool,
    proved: bool,
}

impl Found {
    const MISS: Self = Self { hit: None, clear: true, proved: false };

    /// What is known of a ray that meets two shapes.
    fn nearer(self, other: Self) -> Self {
        let (Some(a), Some(b)) = (self.hit, other.hit) else {
            let clear = self.clear && other.clear;
            let found = if self.hit.is_some() { self } else { other };
            return Self { clear, proved: found.proved && clear, ..found };
        };
        let (first, second, ends, begins) =
            if a[0] <= b[0] { (self, other, a[1], b[0]) } else { (other, self, b[1], a[0]) };
        // The other shape is refuted up to its own bracket only.
        let clear = first.clear && second.clear && ends <= begins;
        Self { hit: first.hit, clear, proved: first.proved && clear }
    }
}

/// Searches the first hit along the ray of every pixel. Work is spread over the threads of rayon's current pool; what is
/// found and counted does not depend on them.
///
/// # Errors
/// If the scene has no space or no bounds, if the finder cannot handle solids and the scene has one, if the settings make no
/// sense, or if the backend fails.
pub fn sample(
    scene: &Scene,
    ray: &(dyn Fn(u32, u32) -> Option<Ray> + Sync),
    size: (u32, u32),
    settings: &Settings,
    backend: &dyn Backend,
) -> Result<Sampled, Diagnostic> {
    check(scene, settings)?;
    let rays: Vec<Option<Ray>> = (0..size.1).flat_map(|y| (0..size.0).map(move |x| ray(x, y))).collect();
    match settings.precision {
        Precision::Single => run::<f32>(scene, &rays, size, settings, backend),
        Precision::Double => run::<f64>(scene, &rays, size, settings, backend),
    }
}

fn check(scene: &Scene, settings: &Settings) -> Result<(), Diagnostic> {
    if scene.dimension() != 3 {
        return Err(Diagnostic::error(code::DIMENSION, "rays are cast in space, and this is a plane scene"));
    }
    if scene.domain.iter().any(|range| !range.is_bounded() || range.is_singleton()) {
        return Err(Diagnostic::error(code::NO_EXTENT, "the domain has no extent or no bounds")
            .help("give every coordinate a range such as `[-2, 2]`"));
    }
    let name = settings.finder.name();
    if settings.arithmetic == Arithmetic::Point {
        return Err(Diagnostic::error(code::BAD_OPTION, format!("{name} needs enclosures, which points are not"))
            .help("take interval or affine arithmetic"));
    }
    if !(settings.epsilon > 0.0 && settings.epsilon.is_finite()) {
        return Err(Diagnostic::error(code::BAD_OPTION, "the length at which a search stops must be positive"));
    }
    let solid = scene.shapes.iter().find(|shape| shape.kind == ShapeKind::Region);
    if let (Some(shape), false) = (solid, settings.finder.handles_solids()) {
        let title = format!("{name} looks for zeros of equations, and `{}` is a solid", shape.name);
        let able: Vec<&str> = Finder::ALL.into_iter().filter(|f| f.handles_solids()).map(Finder::name).collect();
        return Err(Diagnostic::error(code::BAD_OPTION, title).help(format!("take one of {}", able.join(", "))));
    }
    Ok(())
}

fn run<T: Format>(
    scene: &Scene,
    rays: &[Option<Ray>],
    size: (u32, u32),
    settings: &Settings,
    backend: &dyn Backend,
) -> Result<Sampled, Diagnostic> {
    let mut found = vec![Found::MISS; rays.len()];
    let mut sampled = Sampled::default();
    let Some(reach) = Reach::new(rays, scene, settings) else {
        return Ok(finish(found, settings, sampled));
    };
    for shape in &scene.shapes {
        let programs = Programs::<T>::new(scene, shape, &reach, settings, backend)?;
        let rules = Rules {
            finder: settings.finder,
            region: shape.kind == ShapeKind::Region,
            condition: shape.condition.is_some(),
        };
        let start = Instant::now();
        let bands: Vec<(Vec<Found>, Evaluations)> = rays
            .chunks((BAND * size.0) as usize)
            .collect::<Vec<_>>()
            .into_par_iter()
            .map(|band| search(scene, &programs, &reach, rules, (band, size.0), settings.epsilon))
            .collect();
        sampled.seconds += start.elapsed().as_secs_f64();
        for &(_, counts) in &bands {
            sampled.by_kind += counts;
        }
        let mut place = 0;
        for (mut band, _) in bands {
            let rays = &rays[place..place + band.len()];
            if settings.rounding == Rounding::Outward {
                proof::prove(&programs, &reach, rules, rays, &scene.domain, &mut band);
            }
            for new in band {
                found[place] = found[place].nearer(new);
                place += 1;
            }
        }
    }
    Ok(finish(found, settings, sampled))
}

/// What is found along each of a band of rays, given with the length of its rows, and the number of evaluations.
fn search<T: Format>(
    scene: &Scene,
    programs: &Programs<T>,
    reach: &Reach,
    rules: Rules,
    (rays, width): (&[Option<Ray>], u32),
    epsilon: f64,
) -> (Vec<Found>, Evaluations) {
    let mut found = vec![Found::MISS; rays.len()];
    let driver = Driver::new(programs, Lanes { reach, condition: rules.condition });
    let evaluations = if rules.finder.is_packet() {
        let (width, height) = (width as usize, rays.len() / width as usize);
        let corners = (0..height).step_by(SIDE).flat_map(|y| (0..width).step_by(SIDE).map(move |x| (x, y)));
        let packets = corners.filter_map(|(x, y)| {
            let places = (y..height.min(y + SIDE)).flat_map(|y| (x..width.min(x + SIDE)).map(move |x| y * width + x));
            let members: Vec<(usize, Ray)> = places.filter_map(|pixel| Some((pixel, rays[pixel]?))).collect();
            Packet::new(rules, &members, scene, epsilon)
        });
        driver.run(packets, &mut found)
    } else {
        let searches = rays.iter().enumerate();
        let searches = searches.filter_map(|(pixel, ray)| Search::new(rules, pixel, (*ray)?, &scene.domain, epsilon));
        driver.run(searches, &mut found)
    };
    (found, evaluations)
}

fn finish(found: Vec<Found>, settings: &Settings, mut sampled: Sampled) -> Sampled {
    let outward = settings.rounding == Rounding::Outward;
    sampled.evaluations = sampled.by_kind.fields + sampled.by_kind.slopes + sampled.by_kind.points;
    sampled.depth = found.iter().map(|f| f.hit).collect();
    sampled.proved = found.iter().map(|f| outward && f.proved).collect();
    sampled.unknown = found.iter().map(|f| !outward || !(f.proved || f.hit.is_none() && f.clear)).collect();
    sampled
}
