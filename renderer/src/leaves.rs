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
use crate::confidence::{Confidence, Regions};
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

    /// The same in the channel whose means are to be known.
    fn doubt(&self, one: u32, other: u32) -> f32;
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
    /// What is known of the screen, if the run is to end by it.
    regions: Option<Regions>,
    /// The variance to be expected in each leaf in the channel whose means are to be known.
    doubts: Vec<Expected>,
}

impl Leaves {
    /// The one leaf of a tree of one sample; if the run is to end by `confidence`, known regions rest.
    pub(crate) fn new(
        rule: PriorityRule,
        size_px: [u32; 2],
        confidence: Option<Confidence>,
    ) -> Self {
        let regions = confidence.map(|confidence| Regions::new(confidence, size_px));
        Self {
            doubts: regions.iter().map(|_| Expected::default()).collect(),
            regions,
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
        self.learn_regions();
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
        if self.regions.is_some() {
            self.doubts.push(Expected::default());
        }
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
        let (mut expected, mut in_doubt) = (Expected::default(), Expected::default());
        for neighbour in around.into_iter().flatten() {
            let other = neighbour.leaf;
            let variance = samples.variance(own, other);
            let doubt = match self.regions {
                Some(_) => samples.doubt(own, other),
                None => 0.0,
            };
            if other == own || (variance == 0.0 && doubt == 0.0) {
                continue;
            }
            let places = [own, other].map(|sample| samples.point(sample));
            let (share, axis) = (share(neighbour, places), neighbour.axis);
            let [here, there] = expected_variances(variance, share);
            expected.raise(here, axis);
            self.expected[other as usize].raise(there, axis);
            let [here, there] = expected_variances(doubt, share);
            in_doubt.raise(here, axis);
            if let Some(doubt) = self.doubts.get_mut(other as usize) {
                doubt.raise(there, axis);
            }
        }
        self.expected[own as usize] = expected;
        if let Some(doubt) = self.doubts.get_mut(own as usize) {
            *doubt = in_doubt;
        }
    }

    fn classes(&self) -> impl Iterator<Item = usize> {
        let leaves = self.cells.iter().zip(&self.expected).enumerate();
        leaves.map(|(leaf, (&cell, &expected))| {
            let class = self.rule.class(cell, expected.variance());
            let is_known = self.regions.as_ref().is_some_and(|regions| {
                class != DUE && regions.is_known(cell, self.doubts[leaf].variance())
            });
            if is_known { NEVER } else { class }
        })
    }

    fn learn_regions(&mut self) {
        if let Some(regions) = &mut self.regions {
            let doubts = self.doubts.iter().map(|doubt| doubt.variance());
            regions.learn(self.cells.iter().copied().zip(doubts));
        }
    }

    /// The part of the screen whose regions are not known yet; `None` if nobody asked for confidence.
    pub(crate) fn unknown_area(&mut self) -> Option<f64> {
        self.learn_regions();
        let regions = self.regions.as_ref()?;
        let leaves = self.cells.iter().zip(&self.doubts);
        let unknown = leaves.filter(|&(&cell, doubt)| !regions.is_known(cell, doubt.variance()));
        Some(unknown.map(|(cell, _)| cell.area()).sum())
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
