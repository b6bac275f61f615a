//! Branch and bound for the global minimum of a function over a box, on any interval arithmetic: the arithmetic is behind
//! [`Objective`], everything else is here (R. E. Moore, "Interval Analysis", 1966; E. Hansen and G. W. Walster, "Global
//! Optimization Using Interval Analysis", 2004).
//!
//! What is proved: the minimum lies in [`Minimum::value`], and every minimiser in one of [`Minimum::boxes`]. An
//! upper bound is always an enclosure at a point, never a rounded value; a box goes only if its enclosure lies above such a
//! bound, or if a partial derivative has one sign on it.
//!
//! The result does not depend on the number of threads: each round takes the most promising quarter of the list, in chunks
//! of fixed size, and no chunk sees what another one of the same round found.

use imp::kernel::Packet;
use imp::kernel::Real;
use imp::kernel::verdict;
use rayon::prelude::*;

/// Boxes are evaluated this many at a time: enough to pay for a call, few enough for the cache next to the processor.
const CHUNK: usize = 128;
const LANES: usize = <f64 as Real>::LANES;
/// Two children for each box of a chunk.
const GROUPS: usize = 2 * CHUNK / LANES;

/// Lower and upper end of each coordinate.
pub type Area<const N: usize> = [[f64; 2]; N];
/// The negated lower ends and the upper ends of one coordinate of eight boxes.
pub type Side = [Packet<f64>; 2];
/// The negated lower ends, the upper ends and the verdicts of eight enclosures.
pub type Bounds = [Packet<f64>; 3];

/// What is minimised, on packets as a [`imp::kernel::Kernel`] takes them: eight boxes in `N` neighbouring sides. There are
/// `count` boxes; what fills the last packet may be computed or not.
pub trait Objective<const N: usize>: Sync {
    /// Encloses the function: one item of `values` for each packet of boxes.
    fn values(&self, count: usize, boxes: &[Side], values: &mut [Bounds]);
    /// Encloses the function and then each of its partial derivatives: `N + 1` items. At a kink a derivative is the hull of
    /// what it is nearby.
    fn slopes(&self, count: usize, boxes: &[Side], slopes: &mut [Bounds]);
}

/// What was found, and what it took.
#[derive(Debug, Clone, PartialEq)]
pub struct Minimum<const N: usize> {
    /// The minimum lies between these.
    pub value: [f64; 2],
    /// Every minimiser lies in one of these.
    pub boxes: Vec<Area<N>>,
    /// Boxes on which the function and its derivatives were enclosed.
    pub differentiated: usize,
    /// Boxes and points at which the function alone was enclosed.
    pub evaluated: usize,
}

/// A box on the list, with a lower bound of the function on it.
struct Entry {
    bound: f64,
    place: u32,
}

/// The minimum of `f` over `domain`; boxes are split until no side is longer than `resolution`.
pub fn minimise<const N: usize>(f: &impl Objective<N>, domain: Area<N>, resolution: f64) -> Minimum<N> {
    let mut found = Minimum { value: [f64::INFINITY; 2], boxes: Vec::new(), differentiated: 0, evaluated: 0 };
    let mut finished: Vec<(f64, Area<N>)> = Vec::new();
    let mut boxes = vec![domain];
    let mut free: Vec<u32> = Vec::new();
    let mut list = vec![Entry { bound: f64::NEG_INFINITY, place: 0 }];
    let mut upper = f64::INFINITY;
    let mut own = Buffers::new();
    while !list.is_empty() {
        let taken = (list.len() / 4).max(CHUNK).min(list.len());
        if taken < list.len() {
            // Bounds first, places break ties: the order, and with it the result, is the same on every run.
            list.select_nth_unstable_by(taken, |a, b| a.bound.total_cmp(&b.bound).then(a.place.cmp(&b.place)));
        }
        let parts: Vec<Outcome<N>> = {
            let search = Search { f, domain: &domain, resolution, boxes: &boxes };
            if taken <= CHUNK {
                vec![search.examine(upper, &list[..taken], &mut own)]
            } else {
                let parts = list[..taken].par_chunks(CHUNK);
                parts.map_init(Buffers::new, |buffers, part| search.examine(upper, part, buffers)).collect()
            }
        };
        free.extend(list[..taken].iter().map(|entry| entry.place));
        upper = parts.iter().fold(upper, |upper, part| upper.min(part.upper));
        let rest = list.len() - taken;
        list.rotate_left(taken);
        list.truncate(rest);
        if parts.iter().any(|part| part.better) {
            list.retain(|entry| {
                let stays = entry.bound <= upper;
                if !stays {
                    free.push(entry.place);
                }
                stays
            });
        }
        for part in parts {
            found.differentiated += part.differentiated;
            found.evaluated += part.evaluated;
            finished.extend(part.finished);
            for (bound, area) in part.open.into_iter().filter(|(bound, _)| *bound <= upper) {
                let place = free.pop().unwrap_or(boxes.len() as u32);
                match boxes.get_mut(place as usize) {
                    Some(slot) => *slot = area,
                    None => boxes.push(area),
                }
                list.push(Entry { bound, place });
            }
        }
    }
    finished.retain(|(bound, _)| *bound <= upper);
    found.value = [finished.iter().fold(upper, |least, (bound, _)| least.min(*bound)), upper];
    found.boxes = finished.into_iter().map(|(_, area)| area).collect();
    found
}

/// What became of one chunk.
struct Outcome<const N: usize> {
    upper: f64,
    /// Whether that is less than what was known before.
    better: bool,
    open: Vec<(f64, Area<N>)>,
    finished: Vec<(f64, Area<N>)>,
    differentiated: usize,
    evaluated: usize,
}

struct Buffers<const N: usize> {
    boxes: Vec<Side>,
    middles: Vec<Side>,
    values: Vec<Bounds>,
    slopes: Vec<Bounds>,
    children: Vec<(f64, Area<N>)>,
}

impl<const N: usize> Buffers<N> {
    fn new() -> Self {
        let packet = Packet([0.0; LANES]);
        Buffers {
            boxes: vec![[packet; 2]; GROUPS * N],
            middles: vec![[packet; 2]; GROUPS / 2 * N],
            values: vec![[packet; 3]; GROUPS],
            slopes: vec![[packet; 3]; GROUPS / 2 * (N + 1)],
            children: Vec::with_capacity(2 * CHUNK),
        }
    }
}

struct Search<'a, const N: usize, F> {
    f: &'a F,
    domain: &'a Area<N>,
    resolution: f64,
    boxes: &'a [Area<N>],
}

impl<const N: usize, F: Objective<N>> Search<'_, N, F> {
    /// Tests and splits the boxes of one chunk.
    fn examine(&self, known: f64, part: &[Entry], buffers: &mut Buffers<N>) -> Outcome<N> {
        let groups = part.len().div_ceil(LANES);
        let Buffers { boxes, middles, values, slopes, children } = buffers;
        gather(&mut boxes[..groups * N], part.iter().map(|entry| &self.boxes[entry.place as usize]));
        let (sides, middles) = (&boxes[..groups * N], &mut middles[..groups * N]);
        for (middle, [lo, hi]) in middles.iter_mut().zip(sides) {
            let at: [f64; LANES] = std::array::from_fn(|k| 0.5 * hi.0[k] - 0.5 * lo.0[k]);
            *middle = [Packet(at.map(|m| -m)), Packet(at)];
        }
        let (at_middles, slopes) = (&mut values[..groups], &mut slopes[..groups * (N + 1)]);
        self.f.slopes(part.len(), sides, slopes);
        self.f.values(part.len(), middles, at_middles);
        // Only where the function is proved to have a value is its upper bound one of the minimum.
        let defined = |bits: f64| bits.verdict() & verdict::CONTINUOUS != 0;
        let known_at = |(hi, bits): (f64, f64)| if defined(bits) { hi } else { f64::INFINITY };
        let lanes = at_middles.iter().flat_map(|[_, hi, bits]| hi.0.into_iter().zip(bits.0)).map(known_at);
        let upper = lanes.take(part.len()).fold(known, f64::min);

        children.clear();
        for (g, entries) in part.chunks(LANES).enumerate() {
            let (sides, slopes) = (&sides[g * N..][..N], &slopes[g * (N + 1)..][..N + 1]);
            let continuous = slopes[0][2].0.map(|bits| bits.verdict() & verdict::CONTINUOUS != 0);
            let centred = centred_form::<N>(sides, &middles[g * N..][..N], &at_middles[g], &slopes[1..]);
            let Outlook { hopeless, faces, along } = outlook(sides, &slopes[1..], self.domain, self.resolution);
            for (k, entry) in entries.iter().enumerate() {
                // Comparisons with what is no number are false, and change nothing.
                let natural = -slopes[0][0].0[k];
                let bound = if natural > entry.bound { natural } else { entry.bound };
                let bound = if continuous[k] && centred[k] > bound { centred[k] } else { bound };
                if bound > upper || continuous[k] && hopeless[k] {
                    continue;
                }
                let mut area = self.boxes[entry.place as usize];
                let mut along = along[k];
                if continuous[k] && faces[k] {
                    for (side, slope) in area.iter_mut().zip(&slopes[1..]) {
                        narrow_by_sign(side, [-slope[0].0[k], slope[1].0[k]]);
                    }
                    along = NOWHERE;
                }
                split(&area, self.resolution, along, |half| children.push((bound, half)));
            }
        }
        let groups = children.len().div_ceil(LANES);
        gather(&mut boxes[..groups * N], children.iter().map(|(_, area)| area));
        self.f.values(children.len(), &boxes[..groups * N], &mut values[..groups]);
        let mut outcome = Outcome {
            upper,
            better: upper < known,
            open: Vec::with_capacity(children.len()),
            finished: Vec::new(),
            differentiated: part.len(),
            evaluated: part.len() + children.len(),
        };
        for (k, &(parent, area)) in children.iter().enumerate() {
            let own = -values[k / LANES][0].0[k % LANES];
            let bound = if own > parent { own } else { parent };
            if bound > upper {
                continue;
            }
            let small = area.iter().all(|[lo, hi]| hi - lo <= self.resolution);
            if small { &mut outcome.finished } else { &mut outcome.open }.push((bound, area));
        }
        outcome
    }
}

/// Boxes into packets; what is left of the last group repeats its first box.
fn gather<'a, const N: usize>(packets: &mut [Side], mut boxes: impl ExactSizeIterator<Item = &'a Area<N>>) {
    for group in packets.chunks_exact_mut(N) {
        let Some(first) = boxes.next() else { return };
        let mut area = first;
        for k in 0..LANES {
            for i in 0..N {
                group[i][0].0[k] = -area[i][0];
                group[i][1].0[k] = area[i][1];
            }
            area = if k + 1 < LANES { boxes.next().unwrap_or(first) } else { first };
        }
    }
}

/// What the slopes say of eight boxes.
struct Outlook {
    /// A derivative has one sign, and the end to which the function falls is no end of the domain: no minimiser is here.
    hopeless: [bool; LANES],
    /// A derivative has one sign, and the end to which the function falls is one of the domain: minimisers are there.
    faces: [bool; LANES],
    /// The coordinate along which the function may vary most; [`NOWHERE`] if no side is long enough, or that is not known.
    along: [usize; LANES],
}

const NOWHERE: usize = usize::MAX;

fn outlook<const N: usize>(sides: &[Side], slopes: &[Bounds], domain: &Area<N>, resolution: f64) -> Outlook {
    let (mut hopeless, mut faces, mut known) = ([false; LANES], [false; LANES], [true; LANES]);
    let (mut along, mut most) = ([NOWHERE; LANES], [-1.0; LANES]);
    for i in 0..N {
        let ([lo, hi], [below, above, _], [start, end]) = (&sides[i], &slopes[i], domain[i]);
        for k in 0..LANES {
            let (rises, falls) = (below.0[k] < 0.0, above.0[k] < 0.0);
            let inside = (rises & (-lo.0[k] > start)) | (falls & (hi.0[k] < end));
            hopeless[k] |= inside;
            faces[k] |= rises | falls;
            let (length, steepness) =
                (hi.0[k] + lo.0[k], if above.0[k] > below.0[k] { above.0[k] } else { below.0[k] });
            known[k] &= steepness < f64::INFINITY;
            let score = length * steepness;
            let better = (length > resolution) & (score > most[k]);
            most[k] = if better { score } else { most[k] };
            along[k] = if better { i } else { along[k] };
        }
    }
    for k in 0..LANES {
        along[k] = if known[k] { along[k] } else { NOWHERE };
    }
    Outlook { hopeless, faces, along }
}

/// Lower bounds f(c) + sum of f_i(X) (X_i - c_i) of eight boxes at once.
///
/// Everything is rounded to nearest and the errors are paid for at the end. With d1 <= 0 <= d2 a product's lower end is
/// min(a d2, b d1). Each term has the errors of a difference and a product, the sum one of each addition: relative to the
/// sum of magnitudes less than (N + 3) 2^-53 in all, and what underflows loses less than 2^-1073 a term. The factor below is
/// larger by far. Infinite slopes give NaN or -inf, which bound nothing.
fn centred_form<const N: usize>(
    boxes: &[Side],
    middles: &[Side],
    at_middles: &Bounds,
    slopes: &[Bounds],
) -> [f64; LANES] {
    let mut sum = at_middles[0].0.map(|negated| -negated);
    let mut magnitude = sum.map(f64::abs);
    for i in 0..N {
        let (side, middle, slope) = (&boxes[i], &middles[i], &slopes[i]);
        for k in 0..LANES {
            let (left, right) = (-side[0].0[k] - middle[1].0[k], side[1].0[k] - middle[1].0[k]);
            let (falling, rising) = (slope[1].0[k] * left, -slope[0].0[k] * right);
            // If either is no number the sum must not become one.
            let term = if falling < rising || falling.is_nan() { falling } else { rising };
            sum[k] += term;
            magnitude[k] += term.abs();
        }
    }
    let slack = (N + 8) as f64 * f64::EPSILON;
    std::array::from_fn(|k| sum[k] - (slack * magnitude[k] + f64::MIN_POSITIVE))
}

/// The end to which the function falls, if its derivative along this side has one sign.
fn narrow_by_sign(side: &mut [f64; 2], slope: [f64; 2]) {
    if slope[0] > 0.0 {
        side[1] = side[0];
    } else if slope[1] < 0.0 {
        side[0] = side[1];
    }
}

/// Halves a side: the given one, or the longest. A box without long sides stays whole.
fn split<const N: usize>(area: &Area<N>, resolution: f64, along: usize, mut child: impl FnMut(Area<N>)) {
    let length = |i: usize| area[i][1] - area[i][0];
    let longest = || (0..N).max_by(|&i, &j| length(i).total_cmp(&length(j))).unwrap_or(0);
    let i = if along == NOWHERE { longest() } else { along };
    if length(i) <= resolution {
        child(*area);
        return;
    }
    let middle = 0.5 * area[i][0] + 0.5 * area[i][1];
    let (mut left, mut right) = (*area, *area);
    left[i][1] = middle;
    right[i][0] = middle;
    child(left);
    child(right);
}

/// Touching boxes together: the hull of each heap of them, in the order of their first coordinates.
pub fn heaps<const N: usize>(boxes: &[Area<N>]) -> Vec<Area<N>> {
    let touch = |a: &Area<N>, b: &Area<N>| a.iter().zip(b).all(|(a, b)| a[0] <= b[1] && b[0] <= a[1]);
    let mut heaps: Vec<Vec<Area<N>>> = Vec::new();
    for area in boxes {
        let (touched, mut apart): (Vec<_>, Vec<_>) =
            heaps.into_iter().partition(|heap: &Vec<Area<N>>| heap.iter().any(|other| touch(area, other)));
        apart.push(touched.into_iter().flatten().chain([*area]).collect());
        heaps = apart;
    }
    let hull = |heap: Vec<Area<N>>| -> Area<N> {
        std::array::from_fn(|i| {
            let ends = |lo: f64, hi: f64, area: &Area<N>| [lo.min(area[i][0]), hi.max(area[i][1])];
            heap.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], area| ends(lo, hi, area))
        })
    };
    let mut hulls: Vec<Area<N>> = heaps.into_iter().map(hull).collect();
    hulls.sort_by(|a, b| a.iter().flatten().partial_cmp(b.iter().flatten()).unwrap_or(std::cmp::Ordering::Equal));
    hulls
}
