//! The marches of Knoll, Hijazi et al. 2007: 2x2 rays halve the same stretch in lockstep, and go on to the next part of it
//! when no ray of the packet has 0 in its enclosure.
//!
//! The t-march divides each ray's own stretch inside the domain and encloses the field along the ray. The K-march divides
//! the domain along the axis K that dominates the packet's first ray, so that all rays stay in the same slab, and encloses
//! the field over the boxes X x Y x Z that the rays cross there. Against the printed listing (Knoll et al., Alg. 2): a box
//! over which the field is unbounded is divided like any other and refused as a hit at the last level, lane by lane; rays
//! that have hit are not asked any more; the finest slab is no longer than the epsilon asked for; boxes are computed from
//! the slab's place rather than by adding steps, which would drift.

use crate::accuracy::finder::Finder;
use crate::accuracy::finder::Found;
use crate::accuracy::finder::drive::length;
use crate::accuracy::finder::kernels::Lanes;
use crate::accuracy::finder::kernels::Programs;
use crate::accuracy::finder::kernels::Reach;
use crate::accuracy::finder::search::Answer;
use crate::accuracy::finder::search::Rules;
use crate::accuracy::finder::search::Span;
use crate::derive::Rounding;
use crate::kernel::Real;
use crate::program::scene::Scene;
use crate::render::Batch;
use crate::render::Ray;

/// Rays of a packet: 2 across, 2 down.
const SIDE: usize = 2;
const RAYS: usize = SIDE * SIDE;
/// Packets of a batch.
const GROUPS: usize = 16;
/// Deepest level: its slabs are exact fractions of the whole.
const DEEPEST: u32 = 50;

/// One ray of a packet.
#[derive(Debug, Clone, Copy)]
struct Member {
    pixel: usize,
    ray: Ray,
    /// The stretch of the ray inside the domain.
    inside: Span,
    /// The stretch that is divided.
    whole: Span,
    found: Found,
    /// Neither hit nor beyond its exit.
    active: bool,
}

/// Rays in lockstep: slab `k` of 2^depth.
struct Packet {
    members: Vec<Member>,
    depth: u32,
    k: u64,
    deepest: u32,
}

impl Packet {
    fn new(finder: Finder, rays: &[(usize, Ray)], scene: &Scene, epsilon: f64) -> Option<Self> {
        let axis = rays.first().map(|(_, ray)| dominant(ray))?;
        let mut members = Vec::with_capacity(RAYS);
        let mut longest = 0.0f64;
        for &(pixel, ray) in rays {
            let Some((entry, exit)) = ray.clip(&scene.domain) else { continue };
            let inside = [entry[0], exit[1]];
            let (o, d) = (ray.origin[axis], ray.direction[axis]);
            // A ray that runs across the packet's axis has no slabs of its own.
            let whole = if finder == Finder::KMarch && d != 0.0 {
                let range = scene.domain[axis];
                let ends = [(range.lo() - o) / d, (range.hi() - o) / d];
                // The planes of the domain, unless rounding has carried them into it.
                [ends[0].min(ends[1]).min(inside[0]), ends[0].max(ends[1]).max(inside[1])]
            } else {
                inside
            };
            longest = longest.max((whole[1] - whole[0]) * length(&ray));
            members.push(Member { pixel, ray, inside, whole, found: Found::MISS, active: true });
        }
        if members.is_empty() {
            return None;
        }
        let deepest = (longest / epsilon).log2().ceil().clamp(0.0, f64::from(DEEPEST)) as u32;
        Some(Self { members, depth: 0, k: 0, deepest })
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

    /// Goes on to the next slab in which a ray takes part; `false` if there is none.
    fn advance(&mut self) -> bool {
        loop {
            self.k += 1;
            while self.depth > 0 && self.k.is_multiple_of(2) {
                self.k /= 2;
                self.depth -= 1;
            }
            if self.k >> self.depth != 0 || self.members.iter().all(|member| !member.active) {
                return false;
            }
            if self.members.iter().any(|member| self.takes_part(member)) {
                return true;
            }
        }
    }

    /// Takes one answer a ray; whether the packet goes on.
    fn answer(&mut self, rules: Rules, answers: &[Answer]) -> bool {
        let open = |packet: &Self, i: usize| packet.takes_part(&packet.members[i]) && !rules.excludes(&answers[i]);
        let any = (0..self.members.len()).any(|i| open(self, i));
        if any && self.depth < self.deepest {
            self.depth += 1;
            self.k *= 2;
            // The nearer half may lie before the entry of every ray.
            return self.members.iter().any(|member| self.takes_part(member)) || self.advance();
        }
        for i in 0..self.members.len() {
            let span = self.span(&self.members[i]);
            if any && open(self, i) {
                let member = &mut self.members[i];
                if rules.accepts(&answers[i]) {
                    let [start, end] = member.inside;
                    member.found.hit = Some([span[0].max(start), span[1].min(end)]);
                    member.active = false;
                } else {
                    member.found.clear = false;
                }
            }
            let member = &mut self.members[i];
            member.active &= span[1] <= member.inside[1];
        }
        self.advance()
    }
}

/// The axis along which a ray moves fastest.
fn dominant(ray: &Ray) -> usize {
    let speed = ray.direction.map(f64::abs);
    (0..3).fold(0, |best, axis| if speed[axis] > speed[best] { axis } else { best })
}

/// What is found along each of a band of rays, `width` of them a row, and the number of evaluations.
pub fn march<T: Real>(
    programs: &Programs<T>,
    reach: &Reach,
    rules: Rules,
    rays: &[Option<Ray>],
    width: u32,
    scene: &Scene,
    epsilon: f64,
) -> (Vec<Found>, u64) {
    let mut found = vec![Found::MISS; rays.len()];
    let lanes = Lanes { reach, condition: rules.condition };
    let boxes = programs.boxes.as_ref();
    let mut batch = Batch::new(boxes.unwrap_or(&programs.field), GROUPS);
    let slots = batch.capacity() / RAYS;
    let (width, height) = (width as usize, rays.len() / width as usize);
    let corners = (0..height).step_by(SIDE).flat_map(|y| (0..width).step_by(SIDE).map(move |x| (x, y)));
    let mut starting = corners.filter_map(|(x, y)| {
        let places = (y..height.min(y + SIDE)).flat_map(|y| (x..width.min(x + SIDE)).map(move |x| y * width + x));
        let members: Vec<(usize, Ray)> = places.filter_map(|pixel| Some((pixel, rays[pixel]?))).collect();
        Packet::new(rules.finder, &members, scene, epsilon)
    });
    let mut packets: Vec<Packet> = Vec::with_capacity(slots);
    let mut evaluations = 0;
    let mut answers = Vec::with_capacity(RAYS);
    loop {
        while packets.len() < slots {
            let Some(packet) = starting.next() else { break };
            if boxes.is_none() {
                set_rays(&mut batch, &lanes, packets.len(), &packet);
            }
            packets.push(packet);
        }
        if packets.is_empty() {
            break;
        }
        for (place, packet) in packets.iter().enumerate() {
            evaluations += packet.members.len() as u64;
            for (i, member) in packet.members.iter().enumerate() {
                let (lane, span) = (RAYS * place + i, packet.span(member));
                if boxes.is_none() {
                    lanes.set_span(&mut batch, lane, span);
                } else {
                    for axis in 0..3 {
                        lanes.set_range(&mut batch, lane, axis, extent(&member.ray, axis, span, reach.rounding()));
                    }
                }
            }
        }
        batch.run(RAYS * packets.len());
        for place in (0..packets.len()).rev() {
            let packet = &mut packets[place];
            answers.clear();
            answers.extend((0..packet.members.len()).map(|i| lanes.field(&batch, RAYS * place + i)));
            if !packet.answer(rules, &answers) {
                let done = packets.swap_remove(place);
                for member in done.members {
                    found[member.pixel] = member.found;
                }
                if boxes.is_none() && place < packets.len() {
                    set_rays(&mut batch, &lanes, place, &packets[place]);
                }
            }
        }
    }
    (found, evaluations)
}

fn set_rays<T: Real>(batch: &mut Batch<T>, lanes: &Lanes<'_>, place: usize, packet: &Packet) {
    for (i, member) in packet.members.iter().enumerate() {
        lanes.set_ray(batch, RAYS * place + i, &member.ray);
    }
}

/// Where a coordinate of a ray is during a span.
fn extent(ray: &Ray, axis: usize, [start, end]: Span, rounding: Rounding) -> Span {
    let (o, d) = (ray.origin[axis], ray.direction[axis]);
    let (a, b) = (o + start * d, o + end * d);
    // Each is rounded twice, by half a unit in the last place of the product and of the sum.
    let margin = match rounding {
        Rounding::Outward => {
            f64::EPSILON * (a.abs().max(b.abs()) + (d * start).abs().max((d * end).abs())) + f64::MIN_POSITIVE
        }
        Rounding::Nearest => 0.0,
    };
    [a.min(b) - margin, a.max(b) + margin]
}
