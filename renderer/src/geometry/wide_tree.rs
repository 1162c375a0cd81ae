//! From a tree of two children to a node to one of eight.
//!
//! Of all ways to join the nodes of the binary tree, the one is taken for which a ray is expected to visit the
//! least: a box is met in proportion to its area, and what is in it, a node or a leaf, then costs one
//! visit.
//!
//! Source: Ylitie, Karras & Laine (2017), section 3.1.

use std::ops::Range;

use arrayvec::ArrayVec;

use super::box_node::{BoxNode, Child, WIDTH};
use super::split_tree::{SingleBox, SplitNode, SplitTree};

/// The nodes of a tree of eight children to a node, the root first.
#[derive(Clone, Debug, Default)]
pub(crate) struct WideTree {
    pub(crate) nodes: Vec<BoxNode>,
    /// The numbers of the things, leaf by leaf.
    pub(crate) order: Vec<u32>,
}

/// A binary tree, and what its parts cost a ray at best.
struct Costs<'a> {
    binary: &'a [SplitNode],
    most_in_leaf: usize,
    /// For each node what it costs if it is split among at most 1, 2 ... 7 boxes of a wider node.
    least: Vec<[f32; WIDTH - 1]>,
    /// How many things are below each node.
    things: Vec<usize>,
}

impl WideTree {
    /// The tree from a binary one.
    pub(crate) fn of(split: &SplitTree) -> Self {
        let costs = Costs::of(split);
        let mut tree = Self::default();
        tree.add(&costs, &split.order, 0);
        tree
    }

    /// Adds the node that a node of the binary tree becomes, and all below it.
    fn add(&mut self, costs: &Costs<'_>, things: &[u32], at: usize) -> u32 {
        let mut members = ArrayVec::new();
        costs.gather(at, WIDTH, &mut members);
        let corners = |&member: &usize| {
            let SingleBox { low, high } = costs.binary[member].bounds;
            [low, high]
        };
        let place = self.nodes.len();
        self.nodes.push(BoxNode::of(members.iter().map(corners)));
        for (slot, &member) in members.iter().enumerate() {
            let child = if costs.is_leaf(member) {
                let places = self.add_leaf(costs.binary, things, member);
                Child::leaf(count(places.start), count(places.len()))
            } else {
                Child::node(self.add(costs, things, member))
            };
            self.nodes[place].children_mut()[slot] = child;
        }
        count(place)
    }

    fn add_leaf(&mut self, binary: &[SplitNode], things: &[u32], at: usize) -> Range<usize> {
        let first = self.order.len();
        let mut waiting = vec![at];
        while let Some(at) = waiting.pop() {
            let below = binary[at].first;
            if binary[at].count > 0 {
                let things = &things[below..below + binary[at].count];
                self.order.extend(things);
            } else {
                waiting.extend([below + 1, below]);
            }
        }
        first..self.order.len()
    }
}

impl<'a> Costs<'a> {
    fn of(split: &'a SplitTree) -> Self {
        let binary = &split.nodes;
        let mut costs = Self {
            binary,
            most_in_leaf: split.most_in_leaf,
            least: vec![[0.0; WIDTH - 1]; binary.len()],
            things: vec![0; binary.len()],
        };
        // Parents before children; the other way round the costs of children are known.
        let mut from_root = vec![0];
        let mut next = 0;
        while let Some(&at) = from_root.get(next) {
            if costs.binary[at].count == 0 {
                let below = costs.binary[at].first;
                from_root.extend([below, below + 1]);
            }
            next += 1;
        }
        for &at in from_root.iter().rev() {
            costs.weigh(at);
        }
        costs
    }

    fn weigh(&mut self, at: usize) {
        let node = &self.binary[at];
        let area = node.bounds.half_area();
        let below = node.first;
        if node.count > 0 {
            self.things[at] = node.count;
            self.least[at] = [area; WIDTH - 1];
            return;
        }
        self.things[at] = self.things[below] + self.things[below + 1];
        let as_leaf = if self.things[at] <= self.most_in_leaf {
            area
        } else {
            f32::INFINITY
        };
        let mut least = as_leaf.min(self.split(below, WIDTH).0 + area);
        self.least[at][0] = least;
        for boxes in 2..WIDTH {
            least = least.min(self.split(below, boxes).0);
            self.least[at][boxes - 1] = least;
        }
    }

    /// How the two nodes from `below` on best share a number of boxes: the cost, and the first one's boxes.
    fn split(&self, below: usize, boxes: usize) -> (f32, usize) {
        let cost =
            |first: usize| self.least[below][first - 1] + self.least[below + 1][boxes - first - 1];
        let mut best = (f32::INFINITY, 1);
        for first in 1..boxes {
            let cost = cost(first);
            if cost < best.0 {
                best = (cost, first);
            }
        }
        best
    }

    fn is_leaf(&self, at: usize) -> bool {
        let node = &self.binary[at];
        node.count > 0
            || self.things[at] <= self.most_in_leaf && node.bounds.half_area() <= self.least[at][0]
    }

    /// The nodes that stand in the boxes of a wide node made of this one.
    fn gather(&self, at: usize, boxes: usize, members: &mut ArrayVec<usize, WIDTH>) {
        if self.binary[at].count > 0 {
            members.push(at);
            return;
        }
        let below = self.binary[at].first;
        let (_, first) = self.split(below, boxes);
        for (child, mut boxes) in [(below, first), (below + 1, boxes - first)] {
            let least = &self.least[child];
            while boxes > 1 && least[boxes - 2] <= least[boxes - 1] {
                boxes -= 1;
            }
            if boxes == 1 {
                members.push(child);
            } else {
                self.gather(child, boxes, members);
            }
        }
    }
}

fn count(number: usize) -> u32 {
    u32::try_from(number).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Lists what is below a node.
    fn below(tree: &mut WideTree, at: usize) -> Vec<u32> {
        let mut all = Vec::new();
        for child in *tree.nodes[at].children_mut() {
            if child.count() > 0 {
                assert!(child.count() <= 4);
                all.extend(&tree.order[child.first()..child.first() + child.count()]);
            } else if child.first() > 0 {
                all.extend(below(tree, child.first()));
            }
        }
        all
    }

    proptest! {
        #[test]
        fn every_thing_is_in_one_leaf(
            corners in prop::collection::vec([-9_i8..9, -9..9, -9..9], 1..300),
        ) {
            let boxes = corners.iter().map(|corner| {
                let low = corner.map(f32::from);
                SingleBox { low, high: low.map(|x| x + 1.0) }
            });
            let boxes: Vec<SingleBox> = boxes.collect();
            let mut tree = WideTree::of(&SplitTree::over(&boxes, 4));
            let mut things = below(&mut tree, 0);
            things.sort_unstable();
            prop_assert!(things.into_iter().eq(0..u32::try_from(boxes.len()).unwrap()));
        }
    }
}
