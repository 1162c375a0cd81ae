//! The leaves of a growing tree: where they lie, what their neighbours lead to expect in them, and which are
//! to be split next.
//!
//! Every sample lies in one leaf, so a leaf has the number of its sample. When it is split, the old sample's
//! half keeps the number.
//!
//! A leaf too small for the map is expected to be as its parent and its sibling lead to expect.
//!
//! A leaf is halved along the axis on which that neighbour lies that leads to expect the most, unless it is
//! longer along the other.
//!
//! A round is the sixteenth of all leaves that has the highest [priority](crate::priority); while there are
//! leaves above the minimum depth, those and no others. Priorities are held in classes, eight to an octave;
//! within a class the older leaf comes first. A round depends on the leaves alone, and within it the order is
//! fixed, so that a tree that ends within a round is the beginning of the one that goes on.

use crate::cell::{Axis, Cell};
use crate::leaf_map::{LeafMap, Neighbour};
use crate::priority::{CLASSES, DUE, NEVER, PriorityRule, expected_variances};
use crate::sampler::ScreenPoint;
use crate::screen_tree::PlacedNode;

/// One leaf in this many is split in a round.
const SHARE: usize = 16;

/// How much of the variance that is expected in a leaf is expected in its halves, where the map is too coarse to
/// show them.
const INHERITED: f32 = 0.6;

/// What is known of the samples, by number.
pub(crate) trait Samples {
    /// Where it was taken.
    fn point(&self, sample: u32) -> ScreenPoint;

    /// The variance of two samples, `(x1 - x2)² / 2`.
    fn variance(&self, one: u32, other: u32) -> f32;
}

/// The variance that a neighbour leads to expect in a leaf, and the axis on which that neighbour lies.
///
/// One number: negative along y.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Expected(f32);

impl Expected {
    const fn variance(self) -> f32 {
        self.0.abs()
    }

    const fn axis(self) -> Axis {
        if self.0.is_sign_negative() {
            Axis::Y
        } else {
            Axis::X
        }
    }

    /// The larger variance with its axis; the earlier one if they are equal.
    fn raise(&mut self, variance: f32, axis: Axis) {
        if variance > self.variance() {
            self.0 = match axis {
                Axis::X => variance,
                Axis::Y => -variance,
            };
        }
    }
}

/// A leaf that is to be split along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Split {
    pub(crate) leaf: PlacedNode,
    pub(crate) axis: Axis,
}

impl Split {
    /// The half in which the leaf's sample does not lie, which needs a new one.
    pub(crate) fn free_half(&self, sample: ScreenPoint) -> Cell {
        let Self { leaf, axis } = *self;
        leaf.cell.halves(axis)[1 - leaf.cell.half_of(sample, axis)]
    }
}

/// The leaves of a tree.
#[derive(Debug)]
pub(crate) struct Leaves {
    rule: PriorityRule,
    size_px: [u32; 2],
    cells: Vec<Cell>,
    nodes: Vec<u32>,
    expected: Vec<Expected>,
    map: LeafMap,
}

impl Leaves {
    /// The one leaf of a tree of one sample.
    pub(crate) fn new(rule: PriorityRule, size_px: [u32; 2]) -> Self {
        Self {
            rule,
            size_px,
            cells: vec![PlacedNode::ROOT.cell],
            nodes: vec![PlacedNode::ROOT.index],
            expected: vec![Expected::default()],
            map: LeafMap::new(size_px),
        }
    }

    /// The leaves of the next round, in its order; none if no leaf may be split.
    pub(crate) fn next_round(&mut self) -> Vec<Split> {
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
        round.into_iter().map(|leaf| self.split_of(leaf)).collect()
    }

    /// The two halves of a leaf that was split take its place and look at what lies around them.
    pub(crate) fn split(&mut self, children: [PlacedNode; 2], samples: &impl Samples) {
        let [old, new] = if children[0].sample < children[1].sample {
            children
        } else {
            [children[1], children[0]]
        };
        let before = self.expected[old.sample as usize];
        self.cells[old.sample as usize] = old.cell;
        self.nodes[old.sample as usize] = old.index;
        self.cells.push(new.cell);
        self.nodes.push(new.index);
        self.expected.push(Expected::default());
        self.map.enter(new.sample, &new.cell.rectangle());
        for half in [old, new] {
            self.look_around(half, samples);
            if !self.map.shows(&half.cell.rectangle()) {
                let spread = samples.variance(old.sample, new.sample);
                let variance = spread.max(INHERITED * before.variance());
                self.expected[half.sample as usize].raise(variance, before.axis());
            }
        }
    }

    /// What the neighbours of a leaf lead to expect in it, and it in them.
    fn look_around(&mut self, leaf: PlacedNode, samples: &impl Samples) {
        let own = leaf.sample;
        let around = self.map.around(&leaf.cell.rectangle());
        let mut expected = Expected::default();
        for neighbour in around.into_iter().flatten() {
            let other = neighbour.leaf;
            let variance = samples.variance(own, other);
            if other == own || variance == 0.0 {
                continue;
            }
            let places = [own, other].map(|sample| samples.point(sample));
            let [here, there] = expected_variances(variance, share(neighbour, places));
            expected.raise(here, neighbour.axis);
            self.expected[other as usize].raise(there, neighbour.axis);
        }
        self.expected[own as usize] = expected;
    }

    fn classes(&self) -> impl Iterator<Item = usize> {
        let leaves = self.cells.iter().zip(&self.expected);
        leaves.map(|(cell, &expected)| self.rule.class(*cell, expected.variance()))
    }

    fn split_of(&self, leaf: u32) -> Split {
        let place = leaf as usize;
        let cell = self.cells[place];
        Split {
            leaf: PlacedNode {
                index: self.nodes[place],
                sample: leaf,
                cell,
            },
            axis: cell.cut(self.size_px, self.expected[place].axis()),
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
