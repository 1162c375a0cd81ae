//! The leaves of a growing tree: where they lie, what their neighbours lead to expect in them, and which are
//! to be split next.
//!
//! Every sample lies in one leaf, so a leaf has the number of its sample. When it is split, the old sample's
//! half keeps the number.
//!
//! A round is the sixteenth of all leaves that has the highest [priority](crate::priority); while there are
//! leaves above the minimum depth, those and no others. Priorities are held in classes, eight to an octave;
//! within a class the older leaf comes first. A round depends on the leaves alone, and within it the order is
//! fixed, so that a tree that ends within a round is the beginning of the one that goes on.

use crate::cell::Cell;
use crate::leaf_map::{Axis, LeafMap, Neighbour};
use crate::priority::{CLASSES, DUE, NEVER, PriorityRule, expected_variances};
use crate::sampler::ScreenPoint;
use crate::screen_tree::PlacedNode;

/// One leaf in this many is split in a round.
const SHARE: usize = 16;

/// What is known of the samples, by number.
pub(crate) trait Samples {
    /// Where it was taken.
    fn point(&self, sample: u32) -> ScreenPoint;

    /// The variance of two samples, `(x1 - x2)² / 2`.
    fn variance(&self, one: u32, other: u32) -> f32;
}

/// The leaves of a tree.
#[derive(Debug)]
pub(crate) struct Leaves {
    rule: PriorityRule,
    cells: Vec<Cell>,
    nodes: Vec<u32>,
    /// The variance to be expected in each.
    expected: Vec<f32>,
    map: LeafMap,
}

impl Leaves {
    /// The one leaf of a tree of one sample.
    pub(crate) fn new(root: PlacedNode, rule: PriorityRule, size_px: [u32; 2]) -> Self {
        Self {
            rule,
            cells: vec![root.cell],
            nodes: vec![root.index],
            expected: vec![0.0],
            map: LeafMap::new(size_px),
        }
    }

    /// The leaves of the next round, in its order; none if no leaf may be split.
    pub(crate) fn next_round(&mut self) -> Vec<PlacedNode> {
        self.refine_map();
        let mut counts = vec![0_usize; CLASSES];
        for class in self.classes() {
            counts[class] += 1;
        }
        counts[NEVER] = 0;
        let wanted = match counts[DUE] {
            0 => (self.cells.len() / SHARE).max(1),
            due => due,
        };
        // Where each class begins in the round, the highest first; the lowest may be cut short.
        let mut end = 0;
        let mut lowest = DUE;
        for class in (0..=DUE).rev() {
            let count = std::mem::replace(&mut counts[class], end);
            if end < wanted && count > 0 {
                lowest = class;
                end += count;
            }
        }
        let mut round = vec![0; end];
        for (leaf, class) in (0_u32..).zip(self.classes()) {
            if class >= lowest && class != NEVER {
                round[counts[class]] = leaf;
                counts[class] += 1;
            }
        }
        round.truncate(wanted);
        round.into_iter().map(|leaf| self.node(leaf)).collect()
    }

    /// The two halves of a leaf that was split take its place and look at what lies around them.
    pub(crate) fn split(&mut self, children: [PlacedNode; 2], samples: &impl Samples) {
        let [old, new] = if children[0].sample < children[1].sample {
            children
        } else {
            [children[1], children[0]]
        };
        self.cells[old.sample as usize] = old.cell;
        self.nodes[old.sample as usize] = old.index;
        self.cells.push(new.cell);
        self.nodes.push(new.index);
        self.expected.push(0.0);
        self.map.enter(new.sample, &new.cell.rectangle());
        for half in [old, new] {
            self.look_around(half, samples);
        }
    }

    /// What the neighbours of a leaf lead to expect in it, and it in them.
    fn look_around(&mut self, leaf: PlacedNode, samples: &impl Samples) {
        let own = leaf.sample;
        let around = self.map.around(&leaf.cell.rectangle());
        let mut most = 0.0;
        for neighbour in around.into_iter().flatten() {
            let other = neighbour.leaf;
            let variance = samples.variance(own, other);
            if other == own || variance == 0.0 {
                continue;
            }
            let places = [own, other].map(|sample| samples.point(sample));
            let [here, there] = expected_variances(variance, share(neighbour, places));
            most = here.max(most);
            let expected = &mut self.expected[other as usize];
            *expected = there.max(*expected);
        }
        self.expected[own as usize] = most;
    }

    fn classes(&self) -> impl Iterator<Item = usize> {
        let leaves = self.cells.iter().zip(&self.expected);
        leaves.map(|(cell, &expected)| self.rule.class(*cell, expected))
    }

    fn node(&self, leaf: u32) -> PlacedNode {
        PlacedNode {
            index: self.nodes[leaf as usize],
            sample: leaf,
            cell: self.cells[leaf as usize],
        }
    }

    fn refine_map(&mut self) {
        if self.map.resize(self.cells.len()) {
            for (leaf, cell) in (0..).zip(&self.cells) {
                self.map.enter(leaf, &cell.rectangle());
            }
        }
    }
}

/// The part of the way from one sample to its neighbour's that lies on its own side of the border.
fn share(neighbour: Neighbour, [own, other]: [ScreenPoint; 2]) -> f64 {
    let [own, other] = match neighbour.axis {
        Axis::X => [own.x, other.x],
        Axis::Y => [own.y, other.y],
    };
    let share = (neighbour.border - own) / (other - own);
    // Where several leaves share a square of the map it may name one that does not lie beyond the border.
    if (0.0..=1.0).contains(&share) {
        share
    } else {
        0.5
    }
}
