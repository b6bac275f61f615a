//! Single pixels: what stays open after blocks of pixels have been decided, with gradients, piece by piece.
//!
//! A pixel is quartered. A part is refuted by the field's enclosure, by its centred form, or by a combination of two
//! equations. A pixel is crossed if a continuous field has both signs at points that a continuous, unconditional part of
//! it connects, or if Krawczyk's operator finds a common zero of two equations.

use crate::interval::Interval;
use crate::kernel::verdict;
use crate::render::context::proves_condition;
use crate::render::context::refutes_condition;
use crate::render::plane::Place;
use crate::render::plane::kernels::Case;
use crate::render::plane::kernels::Evaluator;
use crate::render::plane::kernels::Sample;
use crate::render::plane::raster::corners;
use crate::render::plane::raster::quarters;
use crate::render::plane::search::search;
use crate::render::plane::search::search_exactly;
use crate::render::plane::solution::Solutions;
use crate::render::plane::solution::centred;
use crate::render::plane::solution::solve;

/// How often a pixel is quartered before it is given up as unknown.
const QUARTERINGS: usize = 22;

/// Open parts of a pixel beyond which it can no longer be refuted as a whole: a curve passes through a few, a double
/// curve through twice as many.
const PARTS: usize = 40;

/// Parts of such a pixel that are followed further, for a crossing in one of them.
const FOLLOWED: usize = 4;

const BOTH: u32 = verdict::POSITIVE | verdict::NEGATIVE;

/// A pixel with what is known of it.
#[derive(Debug, Clone, Copy)]
pub struct Pixel {
    pub area: [Interval; 2],
    /// The equation whose change of sign between any two points of the pixel is a crossing.
    pub equation: Option<usize>,
    /// The values of the step functions on the pixel, if there is such an equation.
    pub steps: Case,
    /// The signs that this equation is proved to have at points of the pixel.
    pub signs: u32,
    inside: bool,
    outside: bool,
    crossed: bool,
    /// Parts have been dropped without being decided.
    lost: bool,
    /// Nothing more is tried.
    given_up: bool,
}

/// A part of a pixel.
#[derive(Debug, Clone, Copy)]
struct Patch {
    pixel: usize,
    area: [Interval; 2],
}

/// What one case of a part comes to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Finding {
    Outside,
    Inside,
    /// The equations are proved to hold at a point of the part.
    Crossed,
    /// Undecided; a change of sign of the equation, if there is one, is a crossing.
    Open(Option<usize>),
}

/// Decides pixels by one system.
pub fn settle(evaluator: &mut Evaluator, solid: bool, areas: &[[Interval; 2]]) -> Vec<Place> {
    let blank = |&area: &[Interval; 2]| Pixel {
        area,
        equation: None,
        steps: Case::of(area),
        signs: 0,
        inside: false,
        outside: false,
        crossed: false,
        lost: false,
        given_up: false,
    };
    let mut pixels: Vec<Pixel> = areas.iter().map(blank).collect();
    let mut patches: Vec<Patch> = areas.iter().enumerate().map(|(pixel, &area)| Patch { pixel, area }).collect();
    for level in 0..=QUARTERINGS {
        let mut open = round(evaluator, solid, &mut pixels, &patches, level == 0);
        let count = |open: &[Patch]| {
            // Parts of a pixel are neighbours in the list, since their parents were.
            open.chunk_by(|a, b| a.pixel == b.pixel).map(|run| (run[0].pixel, run.len())).collect::<Vec<_>>()
        };
        let crowded: Vec<usize> =
            count(&open).into_iter().filter(|&(_, parts)| parts > PARTS).map(|(pixel, _)| pixel).collect();
        // Where not even points have a sign, the kernels know too little of the field.
        let blunt = count(&open).into_iter().map(|(pixel, _)| pixel).filter(|&pixel| pixels[pixel].signs == 0);
        let blunt = if level == 0 { blunt.collect() } else { Vec::new() };
        let searchable = |index: &usize| pixels[*index].equation.is_some() && !pixels[*index].lost;
        let [blunt, fine] = [&blunt, &crowded].map(|list| list.iter().copied().filter(searchable).collect::<Vec<_>>());
        let found = search_exactly(evaluator, &pixels, &blunt);
        let found = found.into_iter().chain(search(evaluator, &pixels, &fine)).collect::<Vec<_>>();
        for index in found {
            pixels[index].crossed = true;
        }
        for &pixel in &crowded {
            pixels[pixel].lost = true;
        }
        // A search all over the pixel has found nothing in these; following a few parts would not either.
        for pixel in fine {
            pixels[pixel].given_up = true;
        }
        open.retain(|patch| !pixels[patch.pixel].crossed && !pixels[patch.pixel].given_up);
        if level == QUARTERINGS {
            open.iter().for_each(|patch| pixels[patch.pixel].lost = true);
            break;
        }
        patches = open
            .chunk_by(|a, b| a.pixel == b.pixel)
            .flat_map(|run| {
                let kept = if pixels[run[0].pixel].lost { run.len().min(FOLLOWED) } else { run.len() };
                (0..kept).map(move |index| run[index * run.len() / kept])
            })
            .flat_map(|patch| quarters(patch.area).map(|area| Patch { area, ..patch }))
            .collect();
        if patches.is_empty() {
            break;
        }
    }
    pixels.iter().map(Pixel::place).collect()
}

impl Pixel {
    fn place(&self) -> Place {
        match self {
            Self { crossed: true, .. } | Self { inside: true, outside: true, .. } => Place::Crossed,
            Self { lost: true, .. } => Place::Unknown,
            Self { inside: true, .. } => Place::Inside,
            _ => Place::Outside,
        }
    }
}

/// Tries every part once; what stays open.
fn round(evaluator: &mut Evaluator, solid: bool, pixels: &mut [Pixel], patches: &[Patch], first: bool) -> Vec<Patch> {
    let areas: Vec<[Interval; 2]> = patches.iter().map(|patch| patch.area).collect();
    let possible = evaluator.cases(&areas);
    let cases: Vec<(usize, Case)> = possible
        .iter()
        .enumerate()
        .flat_map(|(patch, cases)| cases.iter().flatten().map(move |&case| (patch, case)))
        .collect();
    let samples = evaluator.samples(cases.iter().map(|&(_, case)| case));
    let mut findings: Vec<Finding> =
        cases.iter().zip(&samples).map(|((_, case), sample)| natural(case, sample, solid)).collect();
    // The centres of what is open.
    let left: Vec<usize> = (0..cases.len()).filter(|&index| matches!(findings[index], Finding::Open(_))).collect();
    let at = |index: usize, point: [f64; 2]| Case { area: point.map(Interval::point), ..cases[index].1 };
    let middle = |index: usize| cases[index].1.area.map(Interval::mid);
    let centres = evaluator.samples(left.iter().map(|&index| at(index, middle(index))));
    for (&index, centre) in left.iter().zip(&centres) {
        let case = &cases[index].1;
        findings[index] = centred_finding(case, &samples[index], centre, solid);
        if let Finding::Open(Some(equation)) = findings[index]
            && pixels[patches[cases[index].0].pixel].equation == Some(equation)
        {
            pixels[patches[cases[index].0].pixel].signs |= sign(centre.estimates()[equation].value);
        }
    }
    // The corners of what is open still.
    let left: Vec<(usize, usize, u32)> = left
        .iter()
        .zip(&centres)
        .filter_map(|(&index, centre)| match findings[index] {
            Finding::Open(Some(equation)) => Some((index, equation, sign(centre.estimates()[equation].value))),
            _ => None,
        })
        .collect();
    let points: Vec<Case> =
        left.iter().flat_map(|&(index, ..)| corners(cases[index].1.area).map(|corner| at(index, corner))).collect();
    let found = evaluator.samples(points.into_iter());
    for (&(index, equation, at_centre), corners) in left.iter().zip(found.chunks_exact(4)) {
        let signs = corners.iter().fold(at_centre, |signs, sample| signs | sign(sample.estimates()[equation].value));
        let (patch, case) = &cases[index];
        let pixel = &mut pixels[patches[*patch].pixel];
        if first {
            (pixel.equation, pixel.steps) = (Some(equation), *case);
        }
        if pixel.equation == Some(equation) {
            pixel.signs |= signs;
        }
        let zero = corners.iter().any(|sample| {
            let at_corner = &sample.estimates()[equation];
            at_corner.value == Interval::ZERO && at_corner.bits & verdict::CONTINUOUS != 0
        });
        if signs == BOTH || pixel.signs == BOTH || zero {
            findings[index] = Finding::Crossed;
        }
    }
    // A part is what all of its cases are.
    let mut open = Vec::new();
    let mut next = 0;
    for (patch, possible) in patches.iter().zip(&possible) {
        let Some(possible) = possible else {
            open.push(*patch);
            continue;
        };
        let found = &findings[next..next + possible.len()];
        next += possible.len();
        let pixel = &mut pixels[patch.pixel];
        if found.contains(&Finding::Crossed) {
            pixel.crossed = true;
        } else if found.iter().all(|&finding| finding == Finding::Outside) {
            pixel.outside = true;
        } else if found.iter().all(|&finding| finding == Finding::Inside) {
            pixel.inside = true;
        } else {
            open.push(*patch);
        }
    }
    for pixel in pixels.iter_mut() {
        pixel.crossed |= pixel.inside && pixel.outside;
    }
    open.retain(|patch| !pixels[patch.pixel].crossed);
    open
}

/// The sign that an enclosure proves: verdict bits, 0 for none.
pub fn sign(value: Interval) -> u32 {
    if value.is_empty() {
        0
    } else if value.lo() > 0.0 {
        verdict::POSITIVE
    } else if value.hi() < 0.0 {
        verdict::NEGATIVE
    } else {
        0
    }
}

/// What the enclosures say alone.
fn natural(case: &Case, sample: &Sample, solid: bool) -> Finding {
    if refutes_condition(sample.condition) {
        return Finding::Outside;
    }
    let holds = proves_condition(sample.condition);
    let continuous = |bits: u32| bits & verdict::CONTINUOUS != 0;
    if solid {
        let field = &sample.estimates()[0];
        return match field.bits & verdict::REFUTED {
            0 => Finding::Open((case.exact && continuous(field.bits) && holds).then_some(0)),
            verdict::NEGATIVE if case.defined && continuous(field.bits) && holds => Finding::Inside,
            verdict::NEGATIVE => Finding::Open(None),
            _ => Finding::Outside,
        };
    }
    if sample.estimates().iter().any(|estimate| estimate.bits & verdict::REFUTED != 0) {
        return Finding::Outside;
    }
    let sound = case.exact && holds && sample.estimates().iter().all(|estimate| continuous(estimate.bits));
    let mut left = effective(sample);
    match (sound, left.next(), left.next()) {
        (true, None, _) => Finding::Crossed,
        (true, Some(equation), None) => Finding::Open(Some(equation)),
        _ => Finding::Open(None),
    }
}

/// The equations that do not hold everywhere on the box.
fn effective(sample: &Sample) -> impl Iterator<Item = usize> {
    let zero = |value: Interval| value == Interval::ZERO;
    sample.estimates().iter().enumerate().filter(move |(_, estimate)| !zero(estimate.value)).map(|(index, _)| index)
}

/// What centred forms say of an open case.
fn centred_finding(case: &Case, sample: &Sample, centre: &Sample, solid: bool) -> Finding {
    let open = natural(case, sample, solid);
    let step = case.area.map(|side| side - Interval::point(side.mid()));
    let continuous = |index: usize| sample.estimates()[index].bits & verdict::CONTINUOUS != 0;
    let form = |index: usize| centred(&sample.estimates()[index], &centre.estimates()[index], step);
    let defined: Vec<usize> = effective(sample).filter(|&index| continuous(index)).collect();
    for &index in &defined {
        match sign(form(index)) {
            verdict::POSITIVE => return Finding::Outside,
            verdict::NEGATIVE if !solid => return Finding::Outside,
            verdict::NEGATIVE if case.defined && proves_condition(sample.condition) => return Finding::Inside,
            _ => {}
        }
    }
    for (place, &first) in defined.iter().enumerate() {
        for &second in &defined[place + 1..] {
            let pair = |sample: &'_ Sample| [first, second].map(|index| sample.estimates()[index]);
            let (on_box, at_centre) = (pair(sample), pair(centre));
            match solve(on_box.each_ref(), at_centre.each_ref(), step) {
                Solutions::None => return Finding::Outside,
                Solutions::Some
                    if effective(sample).count() == 2
                        && case.exact
                        && proves_condition(sample.condition)
                        && (0..sample.estimates().len()).all(continuous) =>
                {
                    return Finding::Crossed;
                }
                Solutions::Some | Solutions::Unknown => {}
            }
        }
    }
    open
}
