//! Beams: blocks of pixels marched front to back through cells of t, until each pixel is proved to miss, settled
//! inside a cell in which the field is monotone along the ray, or left to the single rays of `finish`.
//!
//! One lane holds one work item: a block and a cell. A lane evaluates the field over the hull of the block's rays and
//! the cell. If that refutes the cell, the item goes on to the next one in its lane; else the cell is halved or the
//! block split, and all parts resume at the same place, since everything before is refuted for all of their rays.
//! Items never look at each other, so the packing of lanes cannot show in the result.

use crate::kernel::Real;
use crate::kernel::verdict;
use crate::render::batch::Batch;
use crate::render::batch::Program;
use crate::render::camera::TILE;
use crate::render::context::Context;
use crate::render::context::Part;
use crate::render::context::Pixel;
use crate::render::context::Refuted;
use crate::render::context::Settled;
use crate::render::context::Single;
use crate::render::context::Test;
use crate::render::context::opposite;
use crate::render::context::pixel;
use crate::render::context::place;
use crate::render::context::proves_condition;
use crate::render::context::refutes_condition;
use crate::render::context::sign;

/// Packets of one kernel call: enough that its fixed cost is small against the cheapest kernels, few enough for the
/// first level of cache.
pub const GROUPS: usize = 8;

/// In blocks of at most 2^2 = 4 pixels across, monotone cells are settled pixel by pixel.
const SETTLE_LEVEL: u8 = 2;

/// Cells are halved down to this many widths of the block where they lie; then the block is split.
const SLAB: f64 = 2.0;

/// A block of pixels and the cell that it has reached.
#[derive(Debug, Clone, Copy)]
pub struct Item<T> {
    /// Box inputs of the varying part of the rays: negated lower and upper ends.
    hull: [T; 6],
    /// No ray of the block is inside the domain from here on.
    exit: f64,
    k: u32,
    depth: u8,
    /// The block is 2^level pixels across.
    level: u8,
    x: u8,
    y: u8,
    /// The sign of the field on the cell just refuted, or 0.
    sign: u8,
}

impl<T> Item<T> {
    /// Goes on to the next cell, one level up where it is the second half of a pair.
    fn advance(&mut self) {
        self.k += 1;
        if self.depth > 0 && self.k.is_multiple_of(2) {
            self.k /= 2;
            self.depth -= 1;
        }
    }
}

/// The marching state of one tile and one shape.
pub struct March<'a, T: Real> {
    context: Context<'a>,
    plain: Batch<T>,
    slope: Batch<T>,
    /// What lies in the lanes of `plain`.
    items: Vec<Item<T>>,
    /// What lies in the lanes of `slope`.
    survivors: Vec<Item<T>>,
    stack: Vec<Item<T>>,
    /// By row: pixels that no block has to care for any more.
    done: [u64; TILE as usize],
    /// Blocks that wait for their settled pixels.
    waiting: Vec<Item<T>>,
    /// Work for the other stages.
    pub settled: Vec<Settled>,
    pub singles: Vec<Single>,
    /// The refuted cells, if a certificate is wanted.
    pub cover: Option<Vec<Refuted>>,
}

impl<'a, T: Real> March<'a, T> {
    /// Starts with the whole tile. A tile that misses the domain has nothing to march.
    pub fn new(context: Context<'a>, plain: &Program<T>, slope: &Program<T>, certificate: bool) -> Self {
        let mut march = Self {
            context,
            plain: Batch::new(plain, GROUPS),
            slope: Batch::new(slope, GROUPS),
            items: Vec::with_capacity(GROUPS * T::LANES),
            survivors: Vec::with_capacity(GROUPS * T::LANES),
            stack: Vec::new(),
            done: [!0; TILE as usize],
            waiting: Vec::new(),
            settled: Vec::new(),
            singles: Vec::new(),
            cover: certificate.then(Vec::new),
        };
        let (width, height) = context.frame.size();
        for row in &mut march.done[..height as usize] {
            *row = !(!0u64 >> (64 - width));
        }
        let level = context.frame.tile.size.trailing_zeros() as u8;
        march.enter(level, 0, 0, 0, 0, 0, f64::INFINITY);
        march
    }

    /// Evaluations by the plain and the slope kernel.
    pub fn evaluations(&self) -> [u64; 2] {
        [self.plain.evaluations, self.slope.evaluations]
    }

    /// Whether every pixel of the block is done.
    fn is_done(&self, x: u8, y: u8, level: u8) -> bool {
        let mask = (!0u64 >> (64 - (1u32 << level))) << x;
        let rows = usize::from(y)..usize::from(y) + (1usize << level);
        self.done[rows].iter().all(|row| row & mask == mask)
    }

    /// Takes a pixel out of all blocks.
    pub fn finish(&mut self, pixel: Pixel) {
        let (x, y) = place(pixel);
        self.done[y as usize] |= 1 << x;
    }

    /// Puts a block onto the stack at a cell, or at its entry into the domain if that is later.
    #[expect(clippy::too_many_arguments, reason = "these are the parts of an item")]
    fn enter(&mut self, level: u8, x: u8, y: u8, k: u32, depth: u8, sign: u8, exit: f64) {
        if self.is_done(x, y, level) {
            return;
        }
        let hull = self.context.frame.hull(x.into(), y.into(), 1 << level);
        let ends = std::array::from_fn(|i| {
            let (low, high) = (hull.0[i / 2], hull.1[i / 2]);
            T::up(if i % 2 == 0 { -low } else { high })
        });
        let mut item = Item { hull: ends, exit, k, depth, level, x, y, sign };
        // Small blocks inherit the exit: their parent's is close enough.
        if level > SETTLE_LEVEL || exit == f64::INFINITY {
            let Some((entry, exit)) = self.context.frame.clip(&hull, self.context.domain) else { return };
            item.exit = exit;
            let grid = self.context.grid;
            if grid.cut(u64::from(item.k) + 1, item.depth) <= entry {
                // Everything before the entry is outside the domain.
                (item.k, item.sign) = (grid.cell(entry, item.depth) as u32, 0);
            }
        }
        self.stack.push(item);
    }

    /// A single ray goes on from a cell.
    pub fn resume(&mut self, single: Single) {
        let (x, y) = place(single.pixel);
        self.done[y as usize] &= !(1 << x);
        self.enter(0, x as u8, y as u8, single.k as u32, single.depth, single.sign as u8, f64::INFINITY);
    }

    /// Blocks whose settled pixels are decided go on with the others.
    pub fn release(&mut self) {
        for mut item in std::mem::take(&mut self.waiting) {
            if !self.is_done(item.x, item.y, item.level) {
                item.advance();
                if self.context.grid.cut(item.k.into(), item.depth) < item.exit {
                    self.stack.push(item);
                }
            }
        }
    }

    /// Marches until no block is left, or enough is settled to fill the packets of the next stage.
    pub fn run(&mut self, enough: usize) {
        while self.settled.len() + self.singles.len() < enough {
            while self.items.len() < self.plain.capacity() {
                let Some(item) = self.stack.pop() else { break };
                self.place(item);
            }
            // Survivors of the plain test wait until they fill packets or nothing else is to do.
            if self.items.is_empty() || self.survivors.len() >= self.slope.capacity() / 2 {
                if self.survivors.is_empty() {
                    return;
                }
                self.slope_step();
            } else {
                self.plain_step();
            }
        }
    }

    /// Puts an item into the next lane of the plain batch.
    fn place(&mut self, item: Item<T>) {
        let lane = self.items.len();
        self.items.push(item);
        for (slot, &end) in item.hull.iter().enumerate() {
            self.plain.set(lane, slot, end);
        }
        self.set_cell(lane);
    }

    /// Writes the cell of the item in a lane. Its ends are exact in either format.
    #[inline]
    fn set_cell(&mut self, lane: usize) {
        let item = &self.items[lane];
        let unit = self.context.grid.unit(item.depth);
        let (start, end) = (f64::from(item.k) * unit, f64::from(item.k + 1) * unit);
        self.plain.set_box(lane, 3, T::nearest(-start), T::nearest(end));
    }

    /// Fills the hole that an item leaves with the last one.
    fn remove(&mut self, lane: usize) -> Item<T> {
        let last = self.items.len() - 1;
        if lane != last {
            self.plain.copy_lane(last, lane);
        }
        self.items.swap_remove(lane)
    }

    fn plain_step(&mut self) {
        let count = self.items.len();
        self.plain.run(count);
        let refuting = self.context.refuting();
        // Downwards, so that a hole is filled by an item that is dealt with already.
        for lane in (0..count).rev() {
            let bits = self.plain.bits(lane, 0);
            let condition = if self.context.condition { self.plain.bits(lane, 1) } else { verdict::POSITIVE };
            let item = &mut self.items[lane];
            if bits & refuting != 0 || refutes_condition(condition) {
                if let Some(cover) = &mut self.cover {
                    cover.push(refuted(item, Test::Natural));
                }
                item.sign = sign(bits) as u8;
                item.advance();
                if self.context.grid.cut(item.k.into(), item.depth) < item.exit {
                    self.set_cell(lane);
                } else {
                    self.remove(lane);
                }
            } else if bits & verdict::NEGATIVE != 0 && condition & verdict::POSITIVE != 0 {
                // Inside a solid: each ray has entered it through the domain's face, or will say what it passed over.
                let item = self.remove(lane);
                self.hand_over(&item);
            } else if item.level <= self.context.slope_level {
                let item = self.remove(lane);
                self.survivors.push(item);
                if self.survivors.len() == self.slope.capacity() {
                    self.slope_step();
                }
            } else if self.halves(lane) {
                let item = &mut self.items[lane];
                (item.k, item.depth) = (2 * item.k, item.depth + 1);
                self.set_cell(lane);
            } else {
                let item = self.remove(lane);
                self.split(&item);
            }
        }
    }

    fn halves(&self, lane: usize) -> bool {
        self.is_long(&self.items[lane])
    }

    /// Whether an undecided cell is to be halved rather than its block split.
    fn is_long<U>(&self, item: &Item<U>) -> bool {
        if item.depth >= self.context.leaf {
            return false;
        }
        let unit = self.context.grid.unit(item.depth);
        let t = if self.context.perspective { unit * f64::from(item.k) } else { 1.0 };
        item.level == 0 || unit > SLAB * self.context.pitch * t * f64::from(1u32 << item.level)
    }

    /// Cuts an undecided item: its cell, else its block, else it becomes a single ray.
    fn subdivide(&mut self, mut item: Item<T>) {
        if self.is_long(&item) {
            (item.k, item.depth) = (2 * item.k, item.depth + 1);
            self.stack.push(item);
        } else {
            self.split(&item);
        }
    }

    fn split(&mut self, item: &Item<T>) {
        if item.level == 0 {
            self.hand_over(item);
            return;
        }
        let half = 1u8 << (item.level - 1);
        for (dx, dy) in [(0, 0), (half, 0), (0, half), (half, half)] {
            self.enter(item.level - 1, item.x + dx, item.y + dy, item.k, item.depth, item.sign, item.exit);
        }
    }

    /// The pixels of a block that are not done.
    fn remaining(&self, item: &Item<T>) -> impl Iterator<Item = Pixel> + use<T> {
        let size = 1u32 << item.level;
        let (left, top) = (u32::from(item.x), u32::from(item.y));
        let done = self.done;
        (top..top + size)
            .flat_map(move |y| (left..left + size).map(move |x| (x, y)))
            .filter(move |&(x, y)| done[y as usize] >> x & 1 == 0)
            .map(|(x, y)| pixel(x, y))
    }

    /// A settled pixel whose signs stayed undecided becomes a single ray.
    pub fn leave(&mut self, settled: &Settled) {
        if let Some(block) = settled.block {
            let Item { k, depth, sign, .. } = self.waiting[block];
            self.singles.push(Single { pixel: settled.pixel, k: k.into(), depth, sign: sign.into() });
            self.finish(settled.pixel);
        }
    }

    /// Leaves all pixels of a block to single rays.
    fn hand_over(&mut self, item: &Item<T>) {
        for pixel in self.remaining(item) {
            let single = Single { pixel, k: item.k.into(), depth: item.depth, sign: item.sign.into() };
            self.singles.push(single);
            self.finish(pixel);
        }
    }

    fn slope_step(&mut self) {
        let mut survivors = std::mem::take(&mut self.survivors);
        for (lane, item) in survivors.iter().enumerate() {
            for (slot, &end) in item.hull.iter().enumerate() {
                self.slope.set(lane, slot, end);
            }
            let unit = self.context.grid.unit(item.depth);
            let (start, end) = (f64::from(item.k) * unit, f64::from(item.k + 1) * unit);
            // The middle may need one bit more than the ends: then it is an interval of neighbours around it, which
            // serves as well.
            let middle = (f64::from(item.k) + 0.5) * unit;
            self.slope.set_box(lane, 3, T::nearest(-start), T::nearest(end));
            self.slope.set_range(lane, 4, middle, middle);
            self.slope.set_range(lane, 5, end, end);
        }
        self.slope.run(survivors.len());
        for (lane, &item) in survivors.iter().enumerate() {
            let condition = if self.context.condition { self.slope.bits(lane, 4) } else { !0 };
            let bits = [0, 1, 2, 3].map(|slot| self.slope.bits(lane, slot));
            let numerator = 4 + usize::from(self.context.condition);
            if numerator < self.slope.output_slots() && sign(self.slope.bits(lane, numerator)) != 0 {
                self.refute(item, 0, Test::Numerator);
            } else {
                self.settle(item, bits, condition);
            }
        }
        survivors.clear();
        self.survivors = survivors;
    }

    /// Acts on the verdicts of the field, its centred form, its slope and its end value over an item's cell.
    fn settle(&mut self, mut item: Item<T>, [field, centred, slope, end]: [u32; 4], condition: u32) {
        let continuous = field & verdict::CONTINUOUS != 0;
        // Where the derivative is undefined on all of the box, it says nothing, although the field may be continuous.
        let (centred, growth) = if continuous { (sign(centred), sign(slope)) } else { (0, 0) };
        if field & self.context.refuting() != 0 || self.context.condition && refutes_condition(condition) {
            // Unlike the plain kernel, this one knows of cells outside the domain that they are.
            self.refute(item, sign(field), Test::Natural);
            return;
        }
        if centred & self.context.refuting() != 0 {
            self.refute(item, centred, Test::Centred);
            return;
        }
        if growth == 0 || self.context.condition && !proves_condition(condition) {
            self.subdivide(item);
            return;
        }
        let (start, end) = (u32::from(item.sign), sign(end));
        // Moving away from 0 at the start, or not yet there at the end, a monotone field has no zero between.
        let constant = if start == growth {
            start
        } else if end == opposite(growth) {
            end
        } else {
            0
        };
        if constant & self.context.refuting() != 0 {
            self.refute(item, constant, Test::Monotone);
            return;
        }
        let crossing = start == opposite(growth) && end == growth;
        if constant != 0 || self.context.region && growth == verdict::POSITIVE {
            // Inside a solid.
            self.hand_over(&item);
        } else if crossing || item.level <= SETTLE_LEVEL {
            let grid = self.context.grid;
            let (a, b) = (grid.cut(item.k.into(), item.depth), grid.cut(u64::from(item.k) + 1, item.depth));
            let block = Some(self.waiting.len());
            let pixels = self.remaining(&item);
            self.settled.extend(pixels.map(|pixel| Settled { pixel, a, b, growth, crossing, block }));
            if let Some(cover) = &mut self.cover {
                cover.push(refuted(&item, Test::Monotone));
            }
            // Pixels that miss here keep the sign that they came with.
            item.sign = start as u8;
            self.waiting.push(item);
        } else {
            self.split(&item);
        }
    }

    fn refute(&mut self, mut item: Item<T>, sign: u32, test: Test) {
        if let Some(cover) = &mut self.cover {
            cover.push(refuted(&item, test));
        }
        item.sign = sign as u8;
        item.advance();
        if self.context.grid.cut(item.k.into(), item.depth) < item.exit {
            self.stack.push(item);
        }
    }
}

fn refuted<T>(item: &Item<T>, test: Test) -> Refuted {
    Refuted { x: item.x, y: item.y, level: item.level, depth: item.depth, k: item.k.into(), part: Part::Whole, test }
}
