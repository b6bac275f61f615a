//! The cells of the ray parameter: dyadic, the same for every ray of a picture.

/// Cells [k u, (k + 1) u] with u = 2^(e - depth). Cell ends are dyadic numbers, exact in both formats as long as k + 1
/// fits the mantissa, so that neighbouring cells and neighbouring depths share their ends and no gap can open.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// Length of a cell by depth.
    units: Vec<f64>,
    /// Deepest level whose cell ends are exact in `f32`, and in `f64`.
    single: u8,
    double: u8,
}

impl Grid {
    /// A grid whose cells at depth 0 are the smallest power of two not below `slab`, which is the longest stretch of
    /// ray parameter inside the domain (the domain's longest side, since directions have a component of 1), for
    /// parameters from 0 to `end`.
    pub fn new(slab: f64, end: f64) -> Self {
        let root = slab.log2().ceil().clamp(-900.0, 900.0);
        let unit = root.exp2();
        let cells = (end / unit).max(1.0).log2().ceil() as i32 + 1;
        // An f64 with 53 bits holds k up to 2^53; the k of marching items are u32.
        let double = (52 - cells).clamp(0, 48) as u8;
        let single = (23 - cells).clamp(0, 20) as u8;
        let units = (0..=double.max(single)).map(|depth| unit * (-f64::from(depth)).exp2()).collect();
        Self { units, single, double }
    }

    /// The length of a cell.
    pub fn unit(&self, depth: u8) -> f64 {
        self.units[usize::from(depth)]
    }

    /// The lower end of cell `k`; exact.
    pub fn cut(&self, k: u64, depth: u8) -> f64 {
        k as f64 * self.unit(depth)
    }

    /// The cell of a depth that holds t >= 0.
    pub fn cell(&self, t: f64, depth: u8) -> u64 {
        (t.max(0.0) / self.unit(depth)) as u64
    }

    /// The deepest level whose cells have exact ends in `f32`.
    pub fn deepest_single(&self) -> u8 {
        self.single
    }

    /// The deepest level whose cells have exact ends in `f64`.
    pub fn deepest(&self) -> u8 {
        self.double
    }

    /// The first depth whose cells are no longer than `length`.
    pub fn depth_of(&self, length: f64) -> u8 {
        let depth = self.units.iter().position(|&unit| unit <= length);
        depth.map_or(self.double, |depth| (depth as u8).min(self.double))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_exact_and_shared_between_depths() {
        let grid = Grid::new(4.0, 13.7);
        for depth in 0..grid.deepest() {
            let k = grid.cell(9.3, depth);
            assert_eq!(grid.cut(k, depth), grid.cut(2 * k, depth + 1));
            assert!(grid.cut(k, depth) <= 9.3 && 9.3 < grid.cut(k + 1, depth));
            if depth <= grid.deepest_single() {
                let end = grid.cut(grid.cell(13.7, depth) + 1, depth);
                assert_eq!(f64::from(end as f32), end);
            }
        }
    }

    #[test]
    fn odd_scales_do_not_panic() {
        for (slab, end) in [(1e-300, 1.0), (1e300, 1e300), (1.0, 1e30), (1.0, 0.0), (3.0, 1e9)] {
            let grid = Grid::new(slab, end);
            assert!(grid.unit(0) >= slab.min(1e270) && grid.deepest() <= 48);
        }
    }
}
