//! The k-D tree over the screen: where the rays went and what they found.
//!
//! A leaf is one cell of the screen with the sample taken inside it. The first sample is the root's; each
//! further one splits a leaf: the old sample keeps its half, the new one goes into the other. Nodes stand
//! in the order of their making and nothing is ever changed, so that the tree as it stood after any number
//! of samples is a prefix.
//!
//! Sample `k` makes the nodes `2k - 1` and `2k`. So a node needs no more than the number of the sample that
//! split it, the axis, and which half that sample went into: 4 bytes. Cells and samples of nodes follow on the way
//! down from the root. With its place (8 bytes) and its values (at most 12) a sample takes 28 bytes.
//!
//! Two things hold after every public call, and the tests check them:
//!
//! 1. at every sample count the leaves tile the screen: their areas sum to 1 and none overlap;
//! 2. below its stop a channel is not stored, so it cannot be read.
//!
//! Not here: which leaf to split next (`refine`), the means of inner nodes (`estimate`), and how the leaves
//! become pixels (`reconstruct`).
//!
//! Sources: Painter & Sloan (1989) for the tree; Meyer & Liu (1992), sections 3.1 and 3.2.

use protocols::{Channel, PerChannel};

use crate::account::RayAccount;
use crate::cell::{Axis, Cell};
use crate::channel_samples::ChannelSamples;
use crate::grid_cell::GridCell;
use crate::sampler::{GridPoint, ScreenPoint};

/// A k-D tree over the screen, in the order of its making.
#[derive(Clone, Debug)]
pub struct ScreenTree {
    nodes: Vec<Node>,
    samples: PerChannel<ChannelSamples>,
    points: Vec<GridPoint>,
    /// The part of the screen whose mean was not known when the trace ended, if it was to end by that.
    pub(crate) unknown_area: Option<f64>,
}

/// What is stored of a node: 0 for a leaf; else the sample that split it, and above it one bit that says
/// whether that sample lies in the first half and one that says whether the halves lie along y.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Node(u32);

impl Node {
    const LEAF: Self = Self(0);
    const NEW_IS_FIRST: u32 = 1 << 31;
    const ALONG_Y: u32 = 1 << 30;

    const fn split_by(sample: u32, half: u8, axis: Axis) -> Self {
        let first = if half == 0 { Self::NEW_IS_FIRST } else { 0 };
        let along_y = match axis {
            Axis::X => 0,
            Axis::Y => Self::ALONG_Y,
        };
        Self(sample | first | along_y)
    }

    /// The sample that split the node, 0 for a leaf.
    const fn splitter(self) -> u32 {
        self.0 & !(Self::NEW_IS_FIRST | Self::ALONG_Y)
    }

    /// The axis along which the node was split.
    const fn axis(self) -> Axis {
        if self.0 & Self::ALONG_Y == 0 {
            Axis::X
        } else {
            Axis::Y
        }
    }

    /// The places of the two children.
    const fn children(self) -> [u32; 2] {
        let second = 2 * self.splitter();
        [second - 1, second]
    }

    /// The samples of the two children of a node that held `old`.
    const fn samples_of_children(self, old: u32) -> [u32; 2] {
        if self.0 & Self::NEW_IS_FIRST == 0 {
            [old, self.splitter()]
        } else {
            [self.splitter(), old]
        }
    }
}

/// A node with what follows from its place in the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PlacedNode {
    /// Its place in the order of making.
    pub(crate) index: u32,
    /// The sample that it had as a leaf.
    pub(crate) sample: u32,
    pub(crate) cell: Cell,
}

impl PlacedNode {
    /// The root of any tree.
    pub(crate) const ROOT: Self = Self {
        index: 0,
        sample: 0,
        cell: Cell::ROOT,
    };

    fn children(self, node: Node) -> [Self; 2] {
        let indices = node.children();
        let samples = node.samples_of_children(self.sample);
        let halves = self.cell.halves(node.axis());
        std::array::from_fn(|half| Self {
            index: indices[half],
            sample: samples[half],
            cell: halves[half],
        })
    }
}

/// A leaf as one channel sees it: a cell of the screen and the value found in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leaf {
    /// The cell.
    pub cell: Cell,
    /// The tristimulus value of the sample in it.
    pub value: f32,
}

/// How far one channel's image goes into the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reach {
    /// The tree as it stood after this many samples.
    pub rays: usize,
    /// Cells below this depth are not entered: the value found at this depth stands for all of them.
    pub depth: u32,
}

impl Reach {
    /// The whole depth of the tree as it stood after this many samples.
    pub const fn rays(rays: usize) -> Self {
        Self {
            rays,
            depth: Cell::DEEPEST,
        }
    }
}

/// A new sample: where, and the value of each channel that was shaded.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct NewSample {
    pub(crate) point: GridPoint,
    pub(crate) values: PerChannel<Option<f32>>,
}

/// A new sample, and the leaf that is split for it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct NewLeaf {
    /// The number of the sample.
    pub(crate) number: u32,
    pub(crate) split: Split,
    pub(crate) sample: NewSample,
}

/// How a leaf is to be split.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Split {
    /// The sample of the leaf.
    pub(crate) leaf: u32,
    pub(crate) node: u32,
    pub(crate) axis: Axis,
    /// Which half the sample does not lie in, so that it needs a new one: 0 or 1.
    pub(crate) half: u8,
    /// That half.
    pub(crate) free_half: GridCell,
}

impl Split {
    /// The nodes of the old sample's half and of the new one's, the sample of this number.
    pub(crate) const fn nodes(&self, new: u32) -> [u32; 2] {
        let second = 2 * new;
        if self.half == 0 {
            [second, second - 1]
        } else {
            [second - 1, second]
        }
    }
}

impl ScreenTree {
    /// The most samples that a tree can hold.
    pub const MOST_SAMPLES: u32 = Node::ALONG_Y;

    /// The tree of one cell, the screen, with its sample; with room for `capacity` samples in all.
    ///
    /// Room that is not used is not touched, so it takes no memory.
    pub(crate) fn new(first: &NewSample, capacity: PerChannel<usize>, rays: usize) -> Self {
        let mut nodes = Vec::with_capacity(2 * rays);
        nodes.push(Node::LEAF);
        let mut tree = Self {
            nodes,
            samples: PerChannel::from_fn(|channel| {
                ChannelSamples::with_capacity(capacity[channel])
            }),
            points: Vec::with_capacity(rays),
            unknown_area: None,
        };
        tree.store(&[NewLeaf {
            sample: *first,
            ..NewLeaf::default()
        }]);
        tree
    }

    /// Splits leaves: the sample of each keeps the half that it lies in, the new one goes into the other.
    ///
    /// The new samples have the next numbers, in any order.
    pub(crate) fn split(&mut self, new: &[NewLeaf]) {
        for NewLeaf { number, split, .. } in new {
            self.nodes[split.node as usize] = Node::split_by(*number, split.half, split.axis);
        }
        self.nodes
            .resize(self.nodes.len() + 2 * new.len(), Node::LEAF);
        self.store(new);
    }

    fn store(&mut self, new: &[NewLeaf]) {
        let first = self.points.len();
        self.points.resize(first + new.len(), GridPoint::default());
        for NewLeaf { number, sample, .. } in new {
            self.points[*number as usize] = sample.point;
        }
        for channel in Channel::ALL {
            let values = new
                .iter()
                .map(|new| (new.number, new.sample.values[channel]));
            self.samples[channel].extend(as_index(first), values);
        }
    }

    /// How many samples were taken.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Never: a tree has at least the sample of its root.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// What the tree cost.
    pub fn account(&self) -> RayAccount {
        RayAccount {
            intersections: self.len() as u64,
            shadings: PerChannel::from_fn(|channel| self.stored_samples(channel) as u64),
        }
    }

    /// How many samples of one channel are held in memory: those that were shaded, and no more.
    pub fn stored_samples(&self, channel: Channel) -> usize {
        self.samples[channel].len()
    }

    /// Where the samples lie, in the order in which they were taken.
    pub fn points(&self) -> Vec<ScreenPoint> {
        self.points.iter().map(|&point| point.into()).collect()
    }

    /// Where a sample lies.
    pub(crate) fn point(&self, sample: u32) -> ScreenPoint {
        self.points[sample as usize].into()
    }

    /// The value of one channel for a sample, or `None` if the channel had stopped before it.
    pub(crate) fn value(&self, channel: Channel, sample: u32) -> Option<f32> {
        self.samples[channel].get(sample)
    }

    /// The children that a node had after `rays` samples, if it was split by then.
    pub(crate) fn children(&self, node: PlacedNode, rays: usize) -> Option<[PlacedNode; 2]> {
        let stored = self.nodes[node.index as usize];
        let is_split = stored != Node::LEAF && (stored.splitter() as usize) < rays;
        is_split.then(|| node.children(stored))
    }

    /// The leaves within a reach, from the upper left: each cell's first half before its second.
    ///
    /// A ray count beyond the end of the tree means the whole tree.
    pub(crate) fn leaf_nodes(&self, reach: Reach) -> impl Iterator<Item = PlacedNode> {
        let mut waiting = vec![PlacedNode::ROOT];
        std::iter::from_fn(move || {
            let mut node = waiting.pop()?;
            while node.cell.depth() < reach.depth
                && let Some([first, second]) = self.children(node, reach.rays)
            {
                waiting.push(second);
                node = first;
            }
            Some(node)
        })
    }

    /// How many leaves lie within a reach.
    ///
    /// A ray count beyond the end of the tree means the whole tree.
    pub fn leaf_count(&self, reach: Reach) -> usize {
        if reach.depth >= Cell::DEEPEST {
            reach.rays.min(self.len())
        } else {
            self.leaf_nodes(reach).count()
        }
    }

    /// Calls `visit` with the leaves of one channel, each cell's first half before its second.
    ///
    /// `None`, after some calls, if the channel stopped earlier. A ray count beyond the end of the tree
    /// means the whole tree.
    pub fn visit_leaves(
        &self,
        channel: Channel,
        reach: Reach,
        mut visit: impl FnMut(Leaf),
    ) -> Option<()> {
        for PlacedNode { cell, sample, .. } in self.leaf_nodes(reach) {
            let value = self.value(channel, sample)?;
            visit(Leaf { cell, value });
        }
        Some(())
    }

    /// The leaves of one channel, each cell's first half before its second; `None` if the channel stopped
    /// earlier.
    ///
    /// A ray count beyond the end of the tree means the whole tree.
    pub fn leaves(&self, channel: Channel, reach: Reach) -> Option<Vec<Leaf>> {
        let mut leaves = Vec::with_capacity(reach.rays.min(self.len()));
        self.visit_leaves(channel, reach, |leaf| leaves.push(leaf))?;
        Some(leaves)
    }
}

fn as_index(length: usize) -> u32 {
    u32::try_from(length).unwrap_or(u32::MAX)
}
