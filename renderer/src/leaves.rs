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

use arrayvec::ArrayVec;
use protocols::{Channel, PerChannel, RefinementDriver};
use rayon::prelude::*;

use crate::cell::{Axis, Cell};
use crate::confidence::Regions;
use crate::expected::{Expected, expected_variances, share};
use crate::grid_cell::GridCell;
use crate::leaf_map::LeafMap;
use crate::priority::{CLASSES, DUE, NEVER, PriorityRule};
use crate::refine::TracePlan;
use crate::round::round;
use crate::sampler::GridPoint;
use crate::screen_tree::{NewLeaf, NewSample, Split};

/// One leaf in this many is split in a round.
const SHARE: usize = 16;

/// This many halves look around at once.
const AT_ONCE: usize = 64;

/// So many leaves at most are held halved and looked round before what their halves found is entered.
const BATCH: usize = 16_384;

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

/// What else is kept of a leaf.
#[derive(Clone, Copy, Debug)]
struct Place {
    /// Of its priority.
    class: u16,
    /// Along x and along y; with the point they are the cell.
    halvings: [u8; 2],
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

/// A leaf that looks around.
#[derive(Clone, Copy, Debug)]
struct Half {
    own: u32,
    cell: GridCell,
    /// The leaves beyond its sides; itself where there is none.
    around: [u32; 4],
}

/// The axes on which the neighbours lie.
const SIDES: [Axis; 4] = [Axis::X, Axis::X, Axis::Y, Axis::Y];

/// What a leaf and its neighbours lead to expect in each other.
#[derive(Clone, Copy, Debug)]
struct Meetings {
    here: Expected,
    there: [Expected; 4],
}

/// Some halves with what they found.
type Looks = ArrayVec<(Half, Meetings), AT_ONCE>;

/// The leaves of a tree.
#[derive(Debug)]
pub(crate) struct Leaves {
    rule: PriorityRule,
    size_px: [u32; 2],
    known: Vec<Known>,
    places: Vec<Place>,
    nodes: Vec<u32>,
    /// How many leaves there are of each class.
    counts: Vec<usize>,
    map: LeafMap,
    /// The leaves that were split since all looked around.
    halved: Vec<Halved>,
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
            size_px: plan.size_px,
            known: Vec::with_capacity(plan.rays()),
            places: Vec::with_capacity(plan.rays()),
            nodes: Vec::with_capacity(plan.rays()),
            counts: vec![0; CLASSES],
            map: LeafMap::new(plan.size_px),
            halved: Vec::new(),
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
        leaves.push(first, [0, 0], 0);
        leaves.classify(0);
        leaves
    }

    fn push(&mut self, new: &NewSample, halvings: [u8; 2], node: u32) {
        let shown = PerChannel::from_fn(|channel| shown(new.values[channel]));
        self.known.push(Known {
            point: new.point,
            shown: shown.a,
            expected: Expected::NOTHING,
        });
        self.places.push(Place {
            class: NEVER,
            halvings,
        });
        self.counts[usize::from(NEVER)] += 1;
        self.nodes.push(node);
        if let Some(colours) = &mut self.colours {
            colours.shown.push([shown.c1, shown.c2]);
        }
        if let Some(doubts) = &mut self.doubts {
            doubts.variances.push(0.0);
        }
    }

    fn cell(&self, leaf: u32) -> GridCell {
        let leaf = leaf as usize;
        GridCell::holding(self.known[leaf].point, self.places[leaf].halvings)
    }

    /// The leaves of the next round, in its order; none if no leaf may be split.
    pub(crate) fn next_round(&mut self) -> Vec<u32> {
        if self.map.resize(self.known.len()) {
            for leaf in 0..as_number(self.known.len()) {
                self.map.enter(leaf, self.cell(leaf));
            }
        }
        let wanted = match self.counts[usize::from(DUE)] {
            0 => (self.known.len() / SHARE).max(1),
            due => due,
        };
        let leaves = as_number(self.places.len());
        if self.doubts.is_none() {
            let places = &self.places;
            return round(
                leaves,
                |leaf| places[leaf as usize].class,
                &self.counts,
                wanted,
            );
        }
        let unknown = self.learn();
        let classes = self.places.iter().zip(unknown);
        let classes: Vec<u16> = classes
            .map(|(place, is_unknown)| {
                let rests = !is_unknown && place.class != DUE;
                if rests { NEVER } else { place.class }
            })
            .collect();
        let mut counts = vec![0; CLASSES];
        for &class in &classes {
            counts[usize::from(class)] += 1;
        }
        round(leaves, |leaf| classes[leaf as usize], &counts, wanted)
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

    /// How a leaf is to be split.
    pub(crate) fn split_of(&self, leaf: u32) -> Split {
        let Known {
            point, expected, ..
        } = self.known[leaf as usize];
        let cell = self.cell(leaf);
        let axis = cell.cell().cut(self.size_px, expected.axis());
        let half = 1 - cell.half_of(point, axis);
        Split {
            leaf,
            node: self.nodes[leaf as usize],
            axis,
            half,
            free_half: cell.half(half, axis),
        }
    }

    /// Splits leaves: the sample of each keeps its half, a new one is in the other. Both have no class before they
    /// [look around](Self::look_around).
    pub(crate) fn split_all(&mut self, new: &[NewLeaf]) {
        for new in new {
            self.split(new);
        }
    }

    fn split(&mut self, NewLeaf { split, sample }: &NewLeaf) {
        let old = split.leaf as usize;
        let number = as_number(self.known.len());
        let [old_node, new_node] = split.nodes(number);
        let halvings = split.free_half.halvings;
        self.halved.push(Halved {
            old: split.leaf,
            new: number,
            expected: self.known[old].expected,
        });
        self.known[old].expected = Expected::NOTHING;
        self.places[old].halvings = halvings;
        self.nodes[old] = old_node;
        if let Some(doubts) = &mut self.doubts {
            doubts.variances[old] = 0.0;
        }
        self.map.enter(number, split.free_half);
        self.push(sample, halvings, new_node);
    }

    /// Puts a leaf into the class that it has now.
    #[inline]
    fn classify(&mut self, leaf: u32) {
        let leaf = leaf as usize;
        let place = &mut self.places[leaf];
        let variance = self.known[leaf].expected.variance();
        let class = self.rule.class(depth(place.halvings), variance);
        self.counts[usize::from(place.class)] -= 1;
        self.counts[usize::from(class)] += 1;
        place.class = class;
    }

    /// All halves that were made since the last call look at what lies around them.
    ///
    /// What they find depends on nothing that they enter, so they look on all threads, and enter it in turn.
    pub(crate) fn look_around(&mut self) {
        let mut halved = std::mem::take(&mut self.halved);
        for batch in halved.chunks(BATCH) {
            let looks: Vec<Looks> = batch
                .par_chunks(AT_ONCE / 2)
                .map(|halved| self.look(halved))
                .collect();
            for (half, meetings) in looks.iter().flatten() {
                self.take_in(half, meetings);
            }
            for &halved in batch {
                self.inherit(halved);
            }
        }
        halved.clear();
        self.halved = halved;
    }

    /// What some halves find around them; in two steps, so that the memory is asked for many things at a time.
    fn look(&self, halved: &[Halved]) -> Looks {
        let mut halves = ArrayVec::<Half, AT_ONCE>::new();
        for own in halved
            .iter()
            .flat_map(|&Halved { old, new, .. }| [old, new])
        {
            let cell = self.cell(own);
            let around = self.map.around(own, cell);
            halves.push(Half { own, cell, around });
        }
        let looks = halves.iter().map(|half| (*half, self.meetings(half)));
        looks.collect()
    }

    /// What a leaf and its neighbours lead to expect in each other.
    #[inline]
    fn meetings(&self, half: &Half) -> Meetings {
        let Half { own, cell, around } = *half;
        let own_known = self.known[own as usize];
        let borders = cell.sides();
        let mut meetings = Meetings {
            here: Expected::NOTHING,
            there: [Expected::NOTHING; 4],
        };
        for (side, axis) in SIDES.into_iter().enumerate() {
            let known = self.known[around[side] as usize];
            let variance = match &self.colours {
                Some(Colours { are_drivers, .. }) if *are_drivers => {
                    self.variance(own, around[side])
                }
                _ => halved_square(own_known.shown - known.shown),
            };
            let places = [own_known, known].map(|known| known.point.0[axis as usize]);
            let [here, there] = expected_variances(variance, share(borders[side], places));
            meetings.here = meetings.here.max(Expected::new(here, axis));
            meetings.there[side] = Expected::new(there, axis);
        }
        meetings
    }

    /// Enters what a leaf and its neighbours met.
    #[inline]
    fn take_in(&mut self, half: &Half, meetings: &Meetings) {
        // A leaf beyond which the screen ends meets itself, without a difference.
        for (&other, &there) in half.around.iter().zip(&meetings.there) {
            self.raise(other, there);
        }
        let expected = &mut self.known[half.own as usize].expected;
        *expected = meetings.here.max(*expected);
        self.classify(half.own);
        if self.doubts.is_some() {
            self.doubt(half);
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
        if self.map.shows(self.cell(new)) {
            return;
        }
        let variance = self.variance(old, new).max(INHERITED * expected.variance());
        let inherited = Expected::new(variance, expected.axis());
        for half in [old, new] {
            self.raise(half, inherited);
        }
    }

    /// The same as [`Self::meetings`] in the channel that is to be known.
    fn doubt(&mut self, half: &Half) {
        let Some(doubts) = &mut self.doubts else {
            return;
        };
        for (side, axis) in SIDES.into_iter().enumerate() {
            let leaves = [half.own, half.around[side]];
            let places = leaves.map(|leaf| self.known[leaf as usize].point.0[axis as usize]);
            let differences = differences(&self.known, self.colours.as_ref(), leaves);
            let doubt = halved_square(differences[doubts.channel]);
            let expected = expected_variances(doubt, share(half.cell.sides()[side], places));
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

fn halved_square(difference: f32) -> f32 {
    0.5 * difference * difference
}

fn depth(halvings: [u8; 2]) -> u32 {
    halvings.map(u32::from).iter().sum()
}

/// A value as far as a display can show it: white has A = 1, and no colour of sRGB has a chroma beyond ±1. A
/// highlight a hundred times as bright as white would draw all samples to itself.
fn shown(value: Option<f32>) -> f32 {
    value.map_or(f32::NAN, |value| value.clamp(-1.0, 1.0))
}

fn as_number(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}
