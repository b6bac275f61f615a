//! Classes of numbers that are found to be the same (union by the smaller number, paths halved).

/// A partition of 0, 1, ..., n - 1. The name of a class is its smallest member, so it does not depend on the order of unions.
#[derive(Debug, Clone)]
pub struct Classes(Vec<u32>);

impl Classes {
    /// Every number in a class of its own.
    pub fn new(len: usize) -> Self {
        Self((0..len as u32).collect())
    }

    /// The smallest member of the class of `x`.
    pub fn find(&mut self, mut x: u32) -> u32 {
        while self.0[x as usize] != x {
            let above = self.0[self.0[x as usize] as usize];
            self.0[x as usize] = above;
            x = above;
        }
        x
    }

    /// Makes the classes of both one.
    pub fn unite(&mut self, x: u32, y: u32) {
        let (x, y) = (self.find(x), self.find(y));
        self.0[x.max(y) as usize] = x.min(y);
    }
}
