//! What can a robot's arm reach, whatever the tolerances of its parts? A planar arm of three links among round posts. For
//! each cell of a map one of three answers:
//!
//! - **reached**: for every target in the cell, and for all lengths of the links within tolerance, there is a position of the
//!   joints that puts the hand on the target with no link near a post. Proved by Krawczyk's test: an operator that
//!   maps a box of joint angles into itself has a fixed point, a zero of hand - target (R. Krawczyk, 1969; A. Neumaier,
//!   "Interval Methods for Systems of Equations", 1990, theorem 5.1.8), and the clearance is proved positive on that box;
//! - **out of reach**: for no target in the cell, and for no such lengths, is there such a position. Proved by a cover of all joint
//!   angles with boxes, each of which collides, or holds the hand elsewhere;
//! - unknown.
//!
//! The tolerance is a parameter: another one compiles nothing. Each map is checked against random positions of the arm.
//!
//!     cargo run --release --example reach -- MAP.png 96      writes the maps, 96 by 96 cells each

use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;

use fastrand::Rng;
use imp::Enclosure;
use imp::Interval;
use imp::IntervalKernel;
use imp::Options;
use imp::Program;
use imp::interval::NoInterval;
use rayon::prelude::*;

const ARM: &str = "
param l1 = 1 in [0.5, 1.5]
param l2 = 0.8 in [0.4, 1.2]
param l3 = 0.5 in [0.2, 0.8]
# Half the thickness of a link.
param thick = 0.04 in [0, 0.2]

# Where the hand is. Each joint turns against the link before it.
fn hand(a, b, c) = [
    l1 cos(a) + l2 cos(a + b) + l3 cos(a + b + c),
    l1 sin(a) + l2 sin(a + b) + l3 sin(a + b + c)
]
fn turned(angle, u, v) = [u cos(angle) + v sin(angle), v cos(angle) - u sin(angle)]
# Distance of the point p, as the link at angle `angle` sees it, from that link.
fn apart(p, l) = hypot(max(component(p, 1) - l, -component(p, 1), 0), component(p, 2))
# Clearance between the arm and a post of radius r at (u, v); negative if they overlap.
fn post(a, b, c, u, v, r) = min(
    apart(turned(a, u, v), l1),
    apart(turned(a + b, u - l1 cos(a), v - l1 sin(a)), l2),
    apart(turned(a + b + c, u - l1 cos(a) - l2 cos(a + b), v - l1 sin(a) - l2 sin(a + b)), l3)
) - r - thick
";

/// Place and radius of each post.
const POSTS: [[f64; 3]; 3] = [[1.1, 0.9, 0.25], [-0.9, 1.0, 0.3], [0.4, -1.3, 0.35]];
const LENGTHS: [f64; 3] = [1.0, 0.8, 0.5];
const THICK: f64 = 0.04;
/// How far the joints turn to each side; the first turns all around.
const LIMITS: [f64; 3] = [3.2, 2.6, 2.6];
/// The map's half side.
const SIDE: f64 = 2.4;
/// A box of joint angles is not split below this.
const FINEST: f64 = 0.02;

/// How often a cell is cut in four if it cannot be reached by one test.
const QUARTERS: usize = 2;

type Joints = [Interval; 3];

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Cell {
    Reached,
    OutOfReach,
    Unknown,
}

/// The arm's kernels, with lengths within a tolerance.
struct Arm {
    hand: IntervalKernel,
    clear: IntervalKernel,
    slopes: IntervalKernel,
}

impl Arm {
    fn new() -> Result<Self, imp::Error> {
        let program = Program::named("arm.imp", ARM)?;
        let posts: Vec<String> = POSTS.iter().map(|[u, v, r]| format!("post(a, b, c, {u}, {v}, {r})")).collect();
        let clear = program.expression(&format!("min({})", posts.join(", ")), &["a", "b", "c"])?;
        let hand = program.function("hand")?;
        Ok(Arm {
            hand: hand.intervals(&Options::default())?,
            clear: clear.intervals(&Options::default())?,
            slopes: hand.intervals(&Options::with_gradient())?,
        })
    }

    /// The same arm with lengths that are off by this much of each; nothing is compiled.
    fn within(&self, tolerance: f64) -> Result<Self, Box<dyn Error>> {
        let mut arm = Arm { hand: self.hand.clone(), clear: self.clear.clone(), slopes: self.slopes.clone() };
        for (name, length) in ["l1", "l2", "l3"].into_iter().zip(LENGTHS) {
            let length = interval(length * (1.0 - tolerance), length * (1.0 + tolerance))?;
            for kernel in [&mut arm.hand, &mut arm.clear, &mut arm.slopes] {
                kernel.set(name, length)?;
            }
        }
        Ok(arm)
    }

    /// Whether all targets are proved to be reached, at once or in quarters.
    fn reaches(&self, targets: [Interval; 2], quarters: usize) -> Result<bool, Box<dyn Error>> {
        if self.reaches_at_once(targets)? {
            return Ok(true);
        }
        if quarters == 0 {
            return Ok(false);
        }
        let [across, up] = [halves(targets[0])?, halves(targets[1])?];
        for quarter in across.into_iter().flat_map(|u| up.map(|v| [u, v])) {
            if !self.reaches(quarter, quarters - 1)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Tries a few turns of the last joint, and both bends of the arm for each.
    fn reaches_at_once(&self, targets: [Interval; 2]) -> Result<bool, Box<dyn Error>> {
        let [u, v] = targets.map(Interval::mid);
        for c in [0.0, 0.6, -0.6, 1.2, -1.2, 1.8, -1.8, 2.4, -2.4] {
            // Links two and three are one link from here on.
            let (x, y) = (LENGTHS[1] + LENGTHS[2] * f64::cos(c), LENGTHS[2] * f64::sin(c));
            let (second, bent, far) = (x.hypot(y), y.atan2(x), u.hypot(v));
            let cosine = (far * far - LENGTHS[0] * LENGTHS[0] - second * second) / (2.0 * LENGTHS[0] * second);
            if cosine.abs() >= 1.0 {
                continue;
            }
            for elbow in [cosine.acos(), -cosine.acos()] {
                let a = v.atan2(u) - (second * elbow.sin()).atan2(LENGTHS[0] + second * elbow.cos());
                let turn = |angle: f64| angle - std::f64::consts::TAU * (angle / std::f64::consts::TAU).round();
                if self.reaches_near([turn(a), turn(elbow - bent), c], targets)? {
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }

    /// Krawczyk's test around a position that is about right: K = m - Y (hand(m) - target) + (1 - Y hand') (J - m) lies in J,
    /// for all targets and lengths at once, so each of them has a zero in J.
    fn reaches_near(&self, at: [f64; 3], targets: [Interval; 2]) -> Result<bool, Box<dyn Error>> {
        let point = at.map(Interval::point);
        let mut outputs = [Enclosure::UNKNOWN; 8];
        self.slopes.enclose_into(&point, &mut outputs)?;
        let off = [outputs[0].interval - targets[0], outputs[4].interval - targets[1]];
        let [p, q, r, s] = [1, 2, 5, 6].map(|i| outputs[i].interval.mid());
        let determinant = p * s - q * r;
        if determinant.abs() < 0.05 {
            return Ok(false);
        }
        let inverse = [[s, -q], [-r, p]].map(|row| row.map(|entry| Interval::point(entry / determinant)));
        let newton: [Interval; 2] = std::array::from_fn(|i| -(inverse[i][0] * off[0] + inverse[i][1] * off[1]));
        // The derivatives' variation is quadratic in the room: if any room is enough, twice the step is.
        let room: [f64; 2] = newton.map(|step| 2.0 * step.mag() + 1e-6);
        let mut joints = point;
        for i in 0..2 {
            joints[i] = interval(at[i] - room[i], at[i] + room[i])?;
            if joints[i].mag() > LIMITS[i] {
                return Ok(false);
            }
        }
        self.slopes.enclose_into(&joints, &mut outputs)?;
        let slopes = [[1, 2], [5, 6]].map(|row| row.map(|i| outputs[i].interval));
        for i in 0..2 {
            let mut image = point[i] + newton[i];
            for j in 0..2 {
                let product = inverse[i][0] * slopes[0][j] + inverse[i][1] * slopes[1][j];
                let unit = if i == j { Interval::ONE } else { Interval::ZERO };
                image = image + (unit - product) * (joints[j] - point[j]);
            }
            if !joints[i].contains_interval(image) {
                return Ok(false);
            }
        }
        Ok(self.clear.enclose(&joints)?.is_positive())
    }
}

/// The answers for the cells of a map, row by row from below, and the number of boxes of joint angles that it took.
fn map(arm: &Arm, cells: usize) -> Result<(Vec<Cell>, usize), Box<dyn Error>> {
    let end = |i: usize| -SIDE + 2.0 * SIDE * i as f64 / cells as f64;
    let reached = |k: usize| {
        let (i, j) = (k % cells, k / cells);
        let of = |i: usize| interval(end(i), end(i + 1)).map_err(|said| said.to_string());
        arm.reaches([of(i)?, of(j)?], QUARTERS).map_err(|said| said.to_string())
    };
    let reached: Vec<bool> = (0..cells * cells).into_par_iter().map(reached).collect::<Result<_, String>>()?;
    let mut map: Vec<Cell> =
        reached.into_iter().map(|reached| if reached { Cell::Reached } else { Cell::OutOfReach }).collect();

    // What no box of joint angles comes near stays out of reach. The rounding of an index is far less than the slack.
    let index = |x: f64| ((x + SIDE) / (2.0 * SIDE) * cells as f64).clamp(-1.0, cells as f64 + 1.0);
    let covered = |range: Interval| {
        let (first, last) = ((index(range.lo()) - 1e-9).floor().max(0.0), (index(range.hi()) + 1e-9).floor());
        first as usize..((last + 1.0).max(0.0) as usize).min(cells)
    };
    let mut stack = vec![LIMITS.map(|limit| interval(-limit, limit).unwrap_or(Interval::ENTIRE))];
    let mut examined = 0;
    let (mut clear, mut hands) = (Vec::new(), Vec::new());
    while !stack.is_empty() {
        let boxes: Vec<Joints> = stack.split_off(stack.len().saturating_sub(8192));
        examined += boxes.len();
        clear.resize(boxes.len(), Enclosure::UNKNOWN);
        hands.resize(2 * boxes.len(), Enclosure::UNKNOWN);
        arm.hand.par_enclose_into(boxes.as_flattened(), &mut hands)?;
        arm.clear.par_enclose_into(boxes.as_flattened(), &mut clear)?;
        for ((joints, clear), hand) in boxes.iter().zip(&clear).zip(hands.chunks_exact(2)) {
            if clear.is_negative() {
                continue;
            }
            let (across, up) = (covered(hand[0].interval), covered(hand[1].interval));
            let open = |j: usize| across.clone().any(|i| map[j * cells + i] == Cell::OutOfReach);
            if !up.clone().any(open) {
                continue;
            }
            let widest = (0..3).max_by(|&i, &j| joints[i].width().total_cmp(&joints[j].width())).unwrap_or(0);
            if joints[widest].width() <= FINEST {
                for cell in up.flat_map(|j| across.clone().map(move |i| j * cells + i)) {
                    if map[cell] == Cell::OutOfReach {
                        map[cell] = Cell::Unknown;
                    }
                }
                continue;
            }
            for half in halves(joints[widest])? {
                let mut part = *joints;
                part[widest] = half;
                stack.push(part);
            }
        }
    }
    Ok((map, examined))
}

fn interval(lo: f64, hi: f64) -> Result<Interval, NoInterval> {
    Interval::try_from(lo..=hi)
}

fn halves(side: Interval) -> Result<[Interval; 2], NoInterval> {
    Ok([interval(side.lo(), side.mid())?, interval(side.mid(), side.hi())?])
}

/// Where the joints are, and the clearance, computed with plain numbers.
fn pose(lengths: [f64; 3], joints: [f64; 3]) -> ([f64; 2], f64) {
    let (mut at, mut angle, mut clear) = ([0.0, 0.0], 0.0, f64::INFINITY);
    for (length, joint) in lengths.into_iter().zip(joints) {
        angle += joint;
        let (sin, cos) = f64::sin_cos(angle);
        for [u, v, r] in POSTS {
            let along = ((u - at[0]) * cos + (v - at[1]) * sin).clamp(0.0, length);
            clear = clear.min((u - at[0] - along * cos).hypot(v - at[1] - along * sin) - r - THICK);
        }
        at = [at[0] + length * cos, at[1] + length * sin];
    }
    (at, clear)
}

/// No random position contradicts a map; how many tried to.
fn check(map: &[Cell], cells: usize, tolerance: f64, rng: &mut Rng) -> usize {
    let mut tried = 0;
    for _ in 0..200_000 {
        let lengths = LENGTHS.map(|length| length * (1.0 + tolerance * (2.0 * rng.f64() - 1.0)));
        let (at, clear) = pose(lengths, LIMITS.map(|limit| limit * (2.0 * rng.f64() - 1.0)));
        let [i, j] = at.map(|x| ((x + SIDE) / (2.0 * SIDE) * cells as f64) as usize);
        if clear > 1e-9 && i < cells && j < cells {
            tried += 1;
            assert!(map[j * cells + i] != Cell::OutOfReach, "({}, {}) was reached", at[0], at[1]);
        }
    }
    tried
}

/// Where the arm collides, for all turns of the first two joints in cells and the third held: an image of `cells` by `cells`.
fn collisions(arm: &Arm, cells: usize, third: f64) -> Result<Vec<[u8; 3]>, Box<dyn Error>> {
    let part = |i: usize, limit: f64| {
        let end = |i: usize| -limit + 2.0 * limit * i as f64 / cells as f64;
        interval(end(i), end(i + 1))
    };
    let mut boxes: Vec<Joints> = Vec::new();
    for j in (0..cells).rev() {
        for i in 0..cells {
            boxes.push([part(i, LIMITS[0])?, part(j, LIMITS[1])?, Interval::point(third)]);
        }
    }
    let mut clear = vec![Enclosure::UNKNOWN; boxes.len()];
    arm.clear.par_enclose_into(boxes.as_flattened(), &mut clear)?;
    let mut counts = [0; 3];
    for (joints, clear) in boxes.iter().zip(&clear) {
        let (_, at) = pose(LENGTHS, joints.map(Interval::mid));
        assert!(!(clear.is_positive() && at < -1e-9 || clear.is_negative() && at > 1e-9));
        counts[if clear.is_positive() { 0 } else { 1 + usize::from(!clear.is_negative()) }] += 1;
    }
    println!("joint boxes at c = {third}: {} clear, {} collide, {} unknown", counts[0], counts[1], counts[2]);
    assert!(counts[2] < boxes.len() / 3, "most are decided");
    let colour = |clear: &Enclosure| match () {
        () if clear.is_positive() => REACHED,
        () if clear.is_negative() => [60, 60, 70],
        () => UNKNOWN,
    };
    Ok(clear.iter().map(colour).collect())
}

const REACHED: [u8; 3] = [0, 158, 115];
const OUT: [u8; 3] = [225, 225, 228];
const UNKNOWN: [u8; 3] = [240, 180, 40];

/// The colours of a map, rows from above; the outlines of the posts are black.
fn picture(map: &[Cell], cells: usize, zoom: usize) -> Vec<[u8; 3]> {
    let size = cells * zoom;
    let pixel = |k: usize| {
        let (i, j) = (k % size, size - 1 - k / size);
        let [u, v] = [i, j].map(|i| -SIDE + 2.0 * SIDE * (i as f64 + 0.5) / size as f64);
        let outline = |[x, y, r]: [f64; 3]| ((u - x).hypot(v - y) - r).abs() < 1.2 * SIDE / size as f64;
        match map[j / zoom * cells + i / zoom] {
            _ if POSTS.into_iter().any(outline) || u.hypot(v) < 0.05 => [0, 0, 0],
            Cell::Reached => REACHED,
            Cell::OutOfReach => OUT,
            Cell::Unknown => UNKNOWN,
        }
    };
    (0..size * size).map(pixel).collect()
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().map_or_else(|| std::env::temp_dir().join("imp_reach.png"), PathBuf::from);
    let cells: usize = arguments.next().map_or(Ok(64), |cells| cells.parse())?;

    let start = Instant::now();
    let arm = Arm::new()?;
    println!("compiled in {:.1?}", start.elapsed());
    let zoom = 480usize.div_ceil(cells);
    let mut panels = Vec::new();
    let mut proved = Vec::new();
    for (seed, tolerance) in [0.0005, 0.004].into_iter().enumerate() {
        let start = Instant::now();
        let (map, boxes) = map(&arm.within(tolerance)?, cells)?;
        let [reached, out, unknown] =
            [Cell::Reached, Cell::OutOfReach, Cell::Unknown].map(|answer| map.iter().filter(|&&c| c == answer).count());
        println!(
            "tolerance {:>5}%: {reached} cells reached, {out} out of reach, {unknown} unknown; {boxes} boxes, {:.1?}",
            tolerance * 100.0,
            start.elapsed()
        );
        assert!(unknown * 2 < map.len(), "most cells are decided");
        let tried = check(&map, cells, tolerance, &mut Rng::with_seed(seed as u64));
        println!("  no contradiction in {tried} random positions without collision");
        panels.push(picture(&map, cells, zoom));
        proved.push((reached, out));
    }
    // What holds for all lengths within a wide tolerance holds within a narrow one.
    assert!(proved[0].0 >= proved[1].0 && proved[0].1 >= proved[1].1, "{proved:?}");
    panels.push(collisions(&arm, cells * zoom, 0.5)?);

    let (size, gap) = (cells * zoom, 8);
    let mut image = image::RgbImage::from_pixel((3 * size + 2 * gap) as u32, size as u32, image::Rgb([255; 3]));
    for (p, panel) in panels.iter().enumerate() {
        for (k, pixel) in panel.iter().enumerate() {
            image.put_pixel((p * (size + gap) + k % size) as u32, (k / size) as u32, image::Rgb(*pixel));
        }
    }
    image.save(&path)?;
    println!("wrote {}", path.display());
    Ok(())
}
