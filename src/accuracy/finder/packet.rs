//! The packets of Knoll, Hijazi et al. 2007: 2x2 rays halve the same stretch in lockstep, and go on to the next part of it
//! when no ray of the packet has 0 in its enclosure.
//!
//! The t-march divides each ray's own stretch inside the domain and encloses the field along the ray. The K-march divides
//! the domain along the axis K that dominates the packet's first ray, so that all rays stay in the same slab, and encloses
//! the field over the boxes X x Y x Z that the rays cross there. Mitchell's method in packets divides like the t-march
//! until the slope excludes 0 for every ray that is still open, then bisects by the signs of points.
//!
//! Against the printed listing (Knoll et al., Alg. 2): a box over which the field is unbounded is divided like any other
//! and refused as a hit at the last level, ray by ray; rays that have hit are not asked any more; the finest slab is no
//! longer than the epsilon asked for; places are computed from the slab's number rather than by adding steps, which
//! would drift.

use crate::accuracy::finder::Finder;
use crate::accuracy::finder::Found;
use crate::accuracy::finder::drive::Pursuit;
use crate::accuracy::finder::drive::length;
use crate::accuracy::finder::search::Answer;
use crate::accuracy::finder::search::Kind;
use crate::accuracy::finder::search::Probe;
use crate::accuracy::finder::search::Question;
use crate::accuracy::finder::search::Refinement;
use crate::accuracy::finder::search::Rules;
use crate::accuracy::finder::search::Span;
use crate::program::scene::Scene;
use crate::render::Ray;

/// Rays of a packet: 2 across, 2 down.
pub const SIDE: usize = 2;
pub const RAYS: usize = SIDE * SIDE;
/// Deepest level: its slabs are exact fractions of the whole.
const DEEPEST: u32 = 50;

/// One ray of a packet.
#[derive(Debug, Clone, Copy)]
struct Member {
    /// `None` for a ray that only fills the packet.
    pixel: Option<usize>,
    ray: Ray,
    /// The stretch of the ray inside the domain.
    inside: Span,
    /// The stretch that is divided.
    whole: Span,
    /// Brackets that are not divided any more.
    width: f64,
    found: Found,
    /// Neither hit nor beyond its exit.
    active: bool,
    /// The current slab is not ruled out.
    open: bool,
    /// The sign of the slope in the current slab.
    growth: i8,
    refinement: Option<Refinement>,
    /// The point or the bracket that is asked for.
    asked: Span,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Phase {
    March,
    Slope,
    /// The field at the start or the end of the slab.
    End(usize),
    Refine,
    Confirm,
}

/// Rays in lockstep: slab `k` of 2^depth.
pub struct Packet {
    rules: Rules,
    members: [Member; RAYS],
    depth: u32,
    k: u64,
    deepest: u32,
    phase: Phase,
}

impl Packet {
    /// The packet of some rays, up to four, with its first question; `None` if none of them meets the domain.
    pub fn new(rules: Rules, rays: &[(usize, Ray)], scene: &Scene, epsilon: f64) -> Option<(Self, Question<RAYS>)> {
        let axis = rays.first().map(|(_, ray)| dominant(ray))?;
        let mut members = Vec::with_capacity(RAYS);
        for &(pixel, ray) in rays {
            let Some((entry, exit)) = ray.clip(&scene.domain) else { continue };
            let inside = [entry[0], exit[1]];
            let (o, d) = (ray.origin[axis], ray.direction[axis]);
            // A ray that runs across the packet's axis has no slabs of its own.
            let whole = if rules.finder == Finder::KMarch && d != 0.0 {
                let range = scene.domain[axis];
                let ends = [(range.lo() - o) / d, (range.hi() - o) / d];
                // The planes of the domain, unless rounding has carried them into it.
                [ends[0].min(ends[1]).min(inside[0]), ends[0].max(ends[1]).max(inside[1])]
            } else {
                inside
            };
            members.push(Member {
                pixel: Some(pixel),
                ray,
                inside,
                whole,
                width: epsilon / length(&ray),
                found: Found::MISS,
                active: true,
                open: false,
                growth: 0,
                refinement: None,
                asked: inside,
            });
        }
        let longest = members.iter().map(|member| (member.whole[1] - member.whole[0]) * length(&member.ray));
        let longest = longest.fold(0.0, f64::max);
        let deepest = (longest / epsilon).log2().ceil().clamp(0.0, f64::from(DEEPEST)) as u32;
        let filling = Member { pixel: None, active: false, ..*members.first()? };
        let members = std::array::from_fn(|i| members.get(i).copied().unwrap_or(filling));
        let mut packet = Self { rules, members, depth: 0, k: 0, deepest, phase: Phase::March };
        let question = packet.ask(Phase::March);
        Some((packet, question))
    }

    fn ask(&mut self, phase: Phase) -> Question<RAYS> {
        self.phase = phase;
        let kind = match phase {
            Phase::March if self.rules.finder == Finder::KMarch => Kind::Boxes,
            Phase::March | Phase::Confirm => Kind::Field,
            Phase::Slope => Kind::Slope,
            Phase::End(_) | Phase::Refine => Kind::Point,
        };
        let spans = std::array::from_fn(|i| {
            let span = self.span(&self.members[i]);
            match phase {
                Phase::March | Phase::Slope => span,
                Phase::End(end) => [span[end]; 2],
                Phase::Refine | Phase::Confirm => self.members[i].asked,
            }
        });
        Question { kind, spans }
    }

    /// The part of a ray in the current slab. Neighbouring slabs share their ends, since the same numbers make them.
    fn span(&self, member: &Member) -> Span {
        let [a, b] = member.whole;
        let unit = (-f64::from(self.depth)).exp2();
        let cut = |k: u64| {
            let share = k as f64 * unit;
            if share == 1.0 { b } else { a + share * (b - a) }
        };
        [cut(self.k), cut(self.k + 1)]
    }

    /// Whether a ray takes part in the current slab.
    fn takes_part(&self, member: &Member) -> bool {
        let [start, end] = self.span(member);
        member.active && end >= member.inside[0] && start <= member.inside[1]
    }

    fn anyone_takes_part(&self) -> bool {
        self.members.iter().any(|member| self.takes_part(member))
    }

    /// Goes on to the next slab in which a ray takes part; `None` if there is none.
    fn pass(&mut self) -> Option<Question<RAYS>> {
        for i in 0..RAYS {
            let [_, end] = self.span(&self.members[i]);
            self.members[i].active &= end <= self.members[i].inside[1];
        }
        loop {
            self.k += 1;
            while self.depth > 0 && self.k.is_multiple_of(2) {
                self.k /= 2;
                self.depth -= 1;
            }
            if self.k >> self.depth != 0 || self.members.iter().all(|member| !member.active) {
                return None;
            }
            if self.anyone_takes_part() {
                return Some(self.ask(Phase::March));
            }
        }
    }

    /// Halves the slab.
    fn descend(&mut self) -> Option<Question<RAYS>> {
        self.depth += 1;
        self.k *= 2;
        // The nearer half may lie before the entry of every ray.
        if self.anyone_takes_part() { Some(self.ask(Phase::March)) } else { self.pass() }
    }

    fn march(&mut self, answers: &[Answer; RAYS]) -> Option<Question<RAYS>> {
        for (i, answer) in answers.iter().enumerate() {
            self.members[i].open = self.takes_part(&self.members[i]) && !self.rules.excludes(answer);
        }
        if self.members.iter().all(|member| !member.open) {
            return self.pass();
        }
        if self.depth < self.deepest {
            return match self.rules.finder {
                Finder::PacketMitchell => Some(self.ask(Phase::Slope)),
                _ => self.descend(),
            };
        }
        for (i, answer) in answers.iter().enumerate() {
            let member = &self.members[i];
            if member.open {
                let ([start, end], inside) = (self.span(member), member.inside);
                self.register(i, [start.max(inside[0]), end.min(inside[1])], answer);
            }
        }
        self.pass()
    }

    /// A hit, unless the field is unbounded there.
    fn register(&mut self, i: usize, bracket: Span, answer: &Answer) {
        let member = &mut self.members[i];
        if self.rules.accepts(answer) {
            member.found.hit = Some(bracket);
            member.active = false;
        } else {
            member.found.clear = false;
        }
    }

    fn slope(&mut self, answers: &[Answer; RAYS]) -> Option<Question<RAYS>> {
        for (member, answer) in self.members.iter_mut().zip(answers) {
            member.growth = if answer.continuous { answer.sign() } else { 0 };
        }
        if self.members.iter().any(|member| member.open && member.growth == 0) {
            return self.descend();
        }
        Some(self.ask(Phase::End(0)))
    }

    fn end(&mut self, end: usize, answers: &[Answer; RAYS]) -> Option<Question<RAYS>> {
        for (member, answer) in self.members.iter_mut().zip(answers) {
            // Moving away from 0 at the start, or not yet there at the end, a monotone field has no zero between.
            let sign = answer.sign();
            member.open &= sign == 0 || (end == 0) != (sign == member.growth);
        }
        if self.members.iter().all(|member| !member.open) {
            return self.pass();
        }
        if end == 0 {
            return Some(self.ask(Phase::End(1)));
        }
        for i in 0..RAYS {
            let span = self.span(&self.members[i]);
            let member = &mut self.members[i];
            member.refinement = member.open.then(|| Refinement::new(member.growth, span));
        }
        Some(self.probe())
    }

    /// The next points of all brackets, or the brackets themselves when each is narrow enough.
    fn probe(&mut self) -> Question<RAYS> {
        for member in &mut self.members {
            let Some(refinement) = &member.refinement else { continue };
            match refinement.probe(member.width) {
                Probe::At(t) => member.asked = [t, t],
                Probe::Done(bracket) => {
                    member.asked = bracket;
                    member.refinement = None;
                }
            }
        }
        let done = self.members.iter().all(|member| member.refinement.is_none());
        self.ask(if done { Phase::Confirm } else { Phase::Refine })
    }
}

impl Pursuit<RAYS> for Packet {
    fn rays(&self) -> [Ray; RAYS] {
        self.members.map(|member| member.ray)
    }

    fn answer(&mut self, answers: &[Answer; RAYS]) -> Option<Question<RAYS>> {
        match self.phase {
            Phase::March => self.march(answers),
            Phase::Slope => self.slope(answers),
            Phase::End(end) => self.end(end, answers),
            Phase::Refine => {
                for (member, answer) in self.members.iter_mut().zip(answers) {
                    if let Some(refinement) = &mut member.refinement {
                        refinement.take(member.asked[0], answer.sign());
                    }
                }
                Some(self.probe())
            }
            Phase::Confirm => {
                for (i, answer) in answers.iter().enumerate() {
                    if self.members[i].open && !self.rules.excludes(answer) {
                        self.register(i, self.members[i].asked, answer);
                    }
                }
                self.pass()
            }
        }
    }

    fn report(&self, found: &mut [Found]) {
        for member in &self.members {
            if let Some(pixel) = member.pixel {
                found[pixel] = member.found;
            }
        }
    }
}

/// The axis along which a ray moves fastest.
fn dominant(ray: &Ray) -> usize {
    let speed = ray.direction.map(f64::abs);
    (0..3).fold(0, |best, axis| if speed[axis] > speed[best] { axis } else { best })
}
