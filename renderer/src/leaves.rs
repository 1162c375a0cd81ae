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
//! The leaves of a round look around when all of them are split: what they find does not depend on their order,
//! and a round that the last ray cuts short need not look at all.
//!
//! A round is the sixteenth of all leaves that has the highest [priority](crate::priority); while there are
//! leaves above the minimum depth, those and no others. Priorities are held in classes, eight to an octave;
//! within a class the older leaf comes first. A round depends on the leaves alone, and within it the order is
//! fixed, so that a tree that ends within a round is the beginning of the one that goes on.

#![expect(
    clippy::inline_always,
    reason = "code for a processor's own instructions is compiled for them only where it is inlined"
)]

use arrayvec::ArrayVec;
use protocols::{Channel, PerChannel, RefinementDriver};
use pulp::{Arch, NullaryFnOnce};
use rayon::prelude::*;

use crate::cell::{Axis, Cell};
use crate::confidence::Regions;
use crate::expected::{Expected, expected_variances, halved_square, share};
use crate::grid_cell::GridCell;
use crate::halving::{Halving, LANES, Wholes};
use crate::leaf_map::LeafMap;
use crate::meetings::{AT_ONCE, Found, Meetings, SIDES};
use crate::priority::{CLASSES, DUE, NEVER, PriorityRule};
use crate::refine::TracePlan;
use crate::round::round;
use crate::sampler::GridPoint;
use crate::screen_tree::{NewLeaf, NewSample, Split};
use crate::spatial_order::spatial_order;

/// One leaf in this many is split in a round.
const SHARE: usize = 16;

/// So many leaves at most are held halved and looked round before what their halves found is entered.
const BATCH: usize = 2048;

/// How much of the variance that is expected in a leaf is expected in its halves, where the map is too coarse to
/// show them.
const INHERITED: f32 = 0.6;

/// What a neighbour asks of a leaf, in a quarter of a cache line.
#[derive(Clone, Copy, Debug)]
struct Known {
    /// Where its sample lies.
    point: GridPoint,
    /// What was found there of A, as far as it can be shown; NaN if it was not shaded.
    shown: f32,
    expected: Expected,
}

impl Known {
    const NOTHING: Self = Self {
        point: GridPoint([0; 2]),
        shown: f32::NAN,
        expected: Expected::NOTHING,
    };
}

/// A leaf that was split in this round: it kept its sample, and half of its cell.
#[derive(Clone, Copy, Debug)]
struct Halved {
    old: u32,
    /// The sample in the other half.
    new: u32,
    /// Of the whole.
    expected: Expected,
}

/// Halves that look around, in a place for all that they meet.
struct Look<'a>(&'a Leaves, &'a [Halved], &'a mut Meetings, &'a mut Found);

impl NullaryFnOnce for Look<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(leaves, halved, meetings, found) = self;
        leaves.gather_halves(halved, meetings);
        meetings.find_squares(leaves.map.grid());
        let count = 2 * halved.len();
        leaves.gather_others(count, meetings);
        meetings.compare();
        leaves.compare_colours(count, meetings);
        meetings.meet();
        meetings.report(count, found);
    }
}

/// The leaves of a tree.
#[derive(Debug)]
pub(crate) struct Leaves {
    rule: PriorityRule,
    halving: Halving,
    known: Vec<Known>,
    /// The class of the priority of each leaf.
    classes: Vec<u16>,
    /// Along x and along y; with the points they are the cells.
    halvings: Vec<[u8; 2]>,
    nodes: Vec<u32>,
    /// How many leaves there are of each class.
    counts: Vec<usize>,
    map: LeafMap,
    /// The leaves that were split since all looked around.
    halved: Vec<Halved>,
    /// Room for what they find.
    found: Vec<Found>,
    arch: Arch,
    colours: Option<Colours>,
    doubts: Option<Doubts>,
}

/// What was found of C1 and C2, if it matters; NaN where they were not shaded.
#[derive(Debug)]
struct Colours {
    are_drivers: bool,
    shown: Vec<[f32; 2]>,
}

/// What is not known well enough, if the run is to end by that.
#[derive(Debug)]
struct Doubts {
    channel: Channel,
    regions: Regions,
    /// The variance to be expected in each leaf in the channel.
    variances: Vec<f32>,
}

impl Leaves {
    /// The one leaf of a tree of one sample.
    pub(crate) fn new(plan: &TracePlan, first: &NewSample) -> Self {
        let are_drivers = plan.driver == RefinementDriver::All;
        let is_asked = plan.until.is_some_and(|until| until.channel != Channel::A);
        let mut leaves = Self {
            rule: plan.priority_rule(),
            halving: Halving::new(plan.size_px, plan.seed),
            known: Vec::with_capacity(plan.rays()),
            classes: Vec::with_capacity(plan.rays()),
            halvings: Vec::with_capacity(plan.rays()),
            nodes: Vec::with_capacity(plan.rays()),
            counts: vec![0; CLASSES],
            map: LeafMap::new(plan.size_px),
            halved: Vec::new(),
            found: Vec::new(),
            arch: Arch::new(),
            colours: (are_drivers || is_asked).then(|| Colours {
                are_drivers,
                shown: Vec::new(),
            }),
            doubts: plan.until.map(|until| Doubts {
                channel: until.channel,
                regions: Regions::new(until, plan.size_px),
                variances: Vec::new(),
            }),
        };
        leaves.grow(1);
        leaves.learn_of(0, first);
        leaves.classify(0);
        leaves
    }

    fn cell(&self, leaf: u32) -> GridCell {
        let leaf = leaf as usize;
        GridCell::holding(self.known[leaf].point, self.halvings[leaf])
    }

    /// The leaves of the next round, in its order; none if no leaf may be split.
    pub(crate) fn next_round(&mut self) -> Vec<u32> {
        if let Some(kept) = self.map.resize(self.known.len()) {
            for leaf in 0..as_number(self.known.len()) {
                if !kept.shows(self.halvings[leaf as usize]) {
                    self.map.enter(leaf, self.cell(leaf));
                }
            }
        }
        let wanted = match self.counts[usize::from(DUE)] {
            0 => (self.known.len() / SHARE).max(1),
            due => due,
        };
        if self.doubts.is_none() {
            return round(&self.classes, &self.counts, wanted);
        }
        let unknown = self.learn();
        let classes = self.classes.iter().zip(unknown);
        let classes: Vec<u16> = classes
            .map(|(&class, is_unknown)| {
                let rests = !is_unknown && class != DUE;
                if rests { NEVER } else { class }
            })
            .collect();
        let mut counts = vec![0; CLASSES];
        for &class in &classes {
            counts[usize::from(class)] += 1;
        }
        round(&classes, &counts, wanted)
    }

    /// Whether each leaf lies in a region that is not known, if that is asked.
    fn learn(&mut self) -> Vec<bool> {
        let cells = (0..as_number(self.known.len())).map(|leaf| self.cell(leaf).cell());
        let cells: Vec<Cell> = cells.collect();
        let Some(doubts) = &mut self.doubts else {
            return Vec::new();
        };
        let leaves = || cells.iter().copied().zip(doubts.variances.iter().copied());
        doubts.regions.learn(leaves());
        leaves()
            .map(|(cell, variance)| !doubts.regions.is_known(cell, variance))
            .collect()
    }

    /// The part of the screen whose regions are not known yet; `None` if nobody asked for confidence.
    pub(crate) fn unknown_area(&mut self) -> Option<f64> {
        self.doubts.as_ref()?;
        let unknown = (0..)
            .zip(self.learn())
            .filter(|&(_, is_unknown)| is_unknown);
        Some(unknown.map(|(leaf, _)| self.cell(leaf).cell().area()).sum())
    }

    /// Where the sample of the whole screen is taken.
    pub(crate) fn first_point(plan: &TracePlan) -> GridPoint {
        Halving::new(plan.size_px, plan.seed).first_point()
    }

    /// The places of some leaves in the list, in an order in which those that are near on the screen are near.
    pub(crate) fn spatial_order(&self, leaves: &[u32]) -> Vec<u32> {
        spatial_order(leaves.iter().map(|&leaf| self.known[leaf as usize].point))
    }

    #[inline(always)]
    fn gather_halves(&self, halved: &[Halved], meetings: &mut Meetings) {
        let halves = halved.iter().flat_map(|halved| [halved.old, halved.new]);
        for (lane, own) in halves.enumerate().take(AT_ONCE) {
            let Known { point, shown, .. } = self.known[own as usize];
            let halvings = self.halvings[own as usize];
            meetings.own[lane] = own;
            meetings.shown[lane] = shown;
            for along in [0, 1] {
                meetings.points[along][lane] = point.0[along];
                meetings.halvings[along][lane] = u32::from(halvings[along]);
            }
        }
    }

    #[inline(always)]
    fn gather_others(&self, count: usize, meetings: &mut Meetings) {
        for (side, axis) in SIDES.into_iter().enumerate() {
            for lane in 0..count.min(AT_ONCE) {
                let found = self.map.at(meetings.squares[side][lane]);
                let is_end = meetings.borders[side][lane] == 0;
                let other = if is_end { meetings.own[lane] } else { found };
                let Known {
                    point,
                    shown,
                    expected,
                } = self.known[other as usize];
                meetings.others[side][lane] = other;
                meetings.their_points[side][lane] = point.0[axis as usize];
                meetings.their_shown[side][lane] = shown;
                meetings.their_expected[side][lane] = expected;
            }
        }
    }

    /// The variances by all drivers, if there are others than A.
    fn compare_colours(&self, count: usize, meetings: &mut Meetings) {
        if !self
            .colours
            .as_ref()
            .is_some_and(|colours| colours.are_drivers)
        {
            return;
        }
        for side in 0..4 {
            for lane in 0..count {
                let variance = self.variance(meetings.own[lane], meetings.others[side][lane]);
                meetings.variances[side][lane] = variance;
            }
        }
    }

    /// How leaves are to be split, at most [`LANES`], and where their new samples lie.
    pub(crate) fn splits(&self, leaves: &[u32]) -> ArrayVec<(Split, GridPoint), LANES> {
        let mut wholes = Wholes::default();
        for (lane, &leaf) in leaves.iter().enumerate() {
            let leaf = leaf as usize;
            let Known {
                point, expected, ..
            } = self.known[leaf];
            for along in [0, 1] {
                wholes.points[along][lane] = point.0[along];
                wholes.halvings[along][lane] = u32::from(self.halvings[leaf][along]);
            }
            wholes.prefers_x[lane] = u32::from(expected.axis() == Axis::X);
        }
        let free = self.halving.halve(&wholes);
        let split = |(lane, &leaf): (usize, &u32)| Split {
            leaf,
            node: self.nodes[leaf as usize],
            axis: free.axis(lane),
            half: u8::from(free.half[lane] == 1),
            free_half: free.cell(lane),
        };
        let splits = leaves.iter().enumerate().map(split);
        splits.zip((0..).map(|lane| free.point(lane))).collect()
    }

    /// Splits leaves: the sample of each keeps its half, a new one is in the other. Both have no class before they
    /// [look around](Self::look_around).
    ///
    /// The new samples have the next numbers, in any order.
    pub(crate) fn split_all(&mut self, new: &[NewLeaf]) {
        self.grow(new.len());
        for new in new {
            self.split(new);
        }
    }

    /// Adds leaves of which nothing is known yet.
    fn grow(&mut self, by: usize) {
        let count = self.known.len() + by;
        self.known.resize(count, Known::NOTHING);
        self.classes.resize(count, NEVER);
        self.halvings.resize(count, [0; 2]);
        self.nodes.resize(count, 0);
        self.counts[usize::from(NEVER)] += by;
        if let Some(colours) = &mut self.colours {
            colours.shown.resize(count, [f32::NAN; 2]);
        }
        if let Some(doubts) = &mut self.doubts {
            doubts.variances.resize(count, 0.0);
        }
    }

    fn split(&mut self, new: &NewLeaf) {
        let NewLeaf { number, split, .. } = new;
        let old = split.leaf as usize;
        let [old_node, new_node] = split.nodes(*number);
        let halvings = split.free_half.halvings;
        self.halved.push(Halved {
            old: split.leaf,
            new: *number,
            expected: self.known[old].expected,
        });
        self.known[old].expected = Expected::NOTHING;
        self.halvings[old] = halvings;
        self.nodes[old] = old_node;
        if let Some(doubts) = &mut self.doubts {
            doubts.variances[old] = 0.0;
        }
        self.map.enter(*number, split.free_half);
        let number = *number as usize;
        self.halvings[number] = halvings;
        self.nodes[number] = new_node;
        self.learn_of(number, &new.sample);
    }

    /// Notes where a sample lies and what was found there.
    fn learn_of(&mut self, number: usize, sample: &NewSample) {
        let shown = PerChannel::from_fn(|channel| shown(sample.values[channel]));
        self.known[number].point = sample.point;
        self.known[number].shown = shown.a;
        if let Some(colours) = &mut self.colours {
            colours.shown[number] = [shown.c1, shown.c2];
        }
    }

    /// Puts a leaf into the class that it has now.
    #[inline]
    fn classify(&mut self, leaf: u32) {
        let leaf = leaf as usize;
        let variance = self.known[leaf].expected.variance();
        let class = self.rule.class(depth(self.halvings[leaf]), variance);
        let before = std::mem::replace(&mut self.classes[leaf], class);
        self.counts[usize::from(before)] -= 1;
        self.counts[usize::from(class)] += 1;
    }

    /// All halves that were made since the last call look at what lies around them.
    ///
    /// What they find depends on nothing that they enter, so they look on all threads, and enter it in turn.
    pub(crate) fn look_around(&mut self) {
        let halved = std::mem::take(&mut self.halved);
        let mut found = std::mem::take(&mut self.found);
        for batch in halved.chunks(BATCH) {
            let looks = batch.chunks(AT_ONCE / 2).len();
            found.resize_with(looks.max(found.len()), Found::default);
            batch
                .par_chunks(AT_ONCE / 2)
                .zip(&mut found)
                .with_min_len(4)
                .for_each_init(Meetings::default, |meetings, (halved, found)| {
                    self.arch.dispatch(Look(self, halved, meetings, found));
                });
            for found in &found[..looks] {
                self.take_in(found);
            }
            for &halved in batch {
                self.inherit(halved);
            }
            if self.doubts.is_some() {
                batch
                    .iter()
                    .flat_map(|h| [h.old, h.new])
                    .for_each(|own| self.doubt(own));
            }
        }
        self.found = found;
        self.halved = halved;
        self.halved.clear();
    }

    /// Enters what some halves found.
    fn take_in(&mut self, found: &Found) {
        for &(other, expected) in &found.there {
            self.raise(other, expected);
        }
        for &(own, here) in &found.here {
            let expected = &mut self.known[own as usize].expected;
            *expected = here.max(*expected);
            self.classify(own);
        }
    }

    fn raise(&mut self, leaf: u32, expected: Expected) {
        let known = &mut self.known[leaf as usize];
        if expected > known.expected {
            known.expected = expected;
            self.classify(leaf);
        }
    }

    /// Where the map is too coarse to show the halves, they are expected to be as the whole was, or as they differ.
    fn inherit(&mut self, halved: Halved) {
        let Halved { old, new, expected } = halved;
        if self.map.grid().shows(self.halvings[new as usize]) {
            return;
        }
        let variance = self.variance(old, new).max(INHERITED * expected.variance());
        let inherited = Expected::new(variance, expected.axis());
        for half in [old, new] {
            self.raise(half, inherited);
        }
    }

    /// What a half and its neighbours lead to expect in each other in the channel that is to be known.
    fn doubt(&mut self, own: u32) {
        let cell = self.cell(own);
        let around = self.map.around(own, cell);
        let Some(doubts) = &mut self.doubts else {
            return;
        };
        for (side, axis) in SIDES.into_iter().enumerate() {
            let leaves = [own, around[side]];
            let places = leaves.map(|leaf| self.known[leaf as usize].point.0[axis as usize]);
            let differences = differences(&self.known, self.colours.as_ref(), leaves);
            let doubt = halved_square(differences[doubts.channel]);
            let expected = expected_variances(doubt, share(cell.sides()[side], places));
            for (leaf, expected) in leaves.into_iter().zip(expected) {
                let variance = &mut doubts.variances[leaf as usize];
                *variance = variance.max(expected);
            }
        }
    }

    /// The variance of two samples, `(x1 - x2)² / 2`: the largest over the drivers that have both, 0 if there
    /// is none.
    fn variance(&self, one: u32, other: u32) -> f32 {
        let drivers = self.colours.as_ref().filter(|colours| colours.are_drivers);
        let PerChannel { a, c1, c2 } = differences(&self.known, drivers, [one, other]);
        [a, c1, c2]
            .map(halved_square)
            .into_iter()
            .fold(0.0, f32::max)
    }
}

/// The differences of two samples in what can be shown; NaN where one was not shaded or does not matter.
fn differences(known: &[Known], colours: Option<&Colours>, leaves: [u32; 2]) -> PerChannel<f32> {
    let [one, other] = leaves.map(|leaf| known[leaf as usize].shown);
    let [c1, c2] = match colours {
        Some(Colours { shown, .. }) => {
            let [one, other] = leaves.map(|leaf| shown[leaf as usize]);
            [one[0] - other[0], one[1] - other[1]]
        }
        None => [f32::NAN; 2],
    };
    PerChannel {
        a: one - other,
        c1,
        c2,
    }
}

fn depth(halvings: [u8; 2]) -> u32 {
    u32::from(halvings[0]) + u32::from(halvings[1])
}

/// A value as far as a display can show it: white has A = 1, and no colour of sRGB has a chroma beyond ±1. A
/// highlight a hundred times as bright as white would draw all samples to itself.
fn shown(value: Option<f32>) -> f32 {
    value.map_or(f32::NAN, |value| value.clamp(-1.0, 1.0))
}

fn as_number(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}
