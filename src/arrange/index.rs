//! Which of many boxes contain a point: a tree of their hulls, halved at the median.

use crate::interval::Interval;

/// Boxes up to which a subtree is searched one by one.
const LEAF: usize = 8;

/// The tree. Its nodes lie in the order in which a search visits them.
#[derive(Debug, Clone)]
pub struct BoxIndex {
    boxes: Vec<[Interval; 2]>,
    /// The numbers of the boxes; each subtree has a stretch of them.
    order: Vec<u32>,
    nodes: Vec<Node>,
}

#[derive(Debug, Clone)]
struct Node {
    hull: [Interval; 2],
    /// The stretch of `order`.
    items: std::ops::Range<usize>,
    /// The first node after this subtree.
    skip: usize,
}

impl BoxIndex {
    /// An index of boxes; empty ones contain nothing.
    pub fn new(boxes: Vec<[Interval; 2]>) -> Self {
        let order: Vec<u32> = (0..boxes.len() as u32).collect();
        let mut index = Self { boxes, order, nodes: Vec::new() };
        index.grow(0..index.order.len());
        index
    }

    /// A box by its number.
    pub fn get(&self, number: u32) -> [Interval; 2] {
        self.boxes[number as usize]
    }

    fn grow(&mut self, items: std::ops::Range<usize>) {
        let empty = [Interval::EMPTY; 2];
        let own = &self.order[items.clone()];
        let hull = own.iter().map(|&i| self.boxes[i as usize]).fold(empty, |a, b| [a[0].hull(b[0]), a[1].hull(b[1])]);
        let node = self.nodes.len();
        self.nodes.push(Node { hull, items: items.clone(), skip: 0 });
        if items.len() > LEAF {
            let axis = usize::from(hull[1].hi() - hull[1].lo() > hull[0].hi() - hull[0].lo());
            let boxes = &self.boxes;
            let place = |&i: &u32| boxes[i as usize][axis].lo();
            let middle = items.len() / 2;
            // Equal places by number, so that the tree is always the same.
            self.order[items.clone()]
                .select_nth_unstable_by(middle, |a, b| place(a).total_cmp(&place(b)).then(a.cmp(b)));
            self.grow(items.start..items.start + middle);
            self.grow(items.start + middle..items.end);
        }
        self.nodes[node].skip = self.nodes.len();
    }

    /// The smallest number of a box that contains a point, ends included.
    pub fn find(&self, point: [f64; 2]) -> Option<u32> {
        let inside = |sides: &[Interval; 2]| (0..2).all(|i| sides[i].lo() <= point[i] && point[i] <= sides[i].hi());
        let (mut at, mut found) = (0, None::<u32>);
        while let Some(node) = self.nodes.get(at) {
            if !inside(&node.hull) {
                at = node.skip;
                continue;
            }
            if node.skip == at + 1 {
                let hit = self.order[node.items.clone()].iter().filter(|&&i| inside(&self.boxes[i as usize])).min();
                found = hit.copied().into_iter().chain(found).min();
            }
            at += 1;
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::BoxIndex;
    use crate::interval::Interval;

    #[test]
    fn finds_what_a_list_finds() {
        let mut random = fastrand::Rng::with_seed(1);
        let mut side = |size: f64| {
            let lo = random.f64() * 10.0;
            Interval::new(lo, lo + random.f64() * size).unwrap()
        };
        for count in [0, 1, 7, 200] {
            let boxes: Vec<_> = (0..count).map(|_| [side(2.0), side(2.0)]).collect();
            let index = BoxIndex::new(boxes.clone());
            for _ in 0..500 {
                let point = [side(0.0).lo(), side(0.0).lo()];
                let inside = |b: &[Interval; 2]| (0..2).all(|i| b[i].contains(point[i]));
                assert_eq!(index.find(point), boxes.iter().position(inside).map(|i| i as u32));
            }
            for (i, b) in boxes.iter().enumerate() {
                assert!(index.find([b[0].lo(), b[1].hi()]).unwrap() <= i as u32);
            }
        }
    }
}
