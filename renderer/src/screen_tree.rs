//! The k-D tree over the screen: where the rays went and what they found.
//!
//! A leaf is one cell of the screen with the sample taken inside it. The first sample is the root's; each
//! further one splits a leaf: the old sample keeps its half, the new one goes into the other. Nodes stand
//! in the order of their making and nothing is ever changed, so that the tree as it stood after any number
//! of samples is a prefix: a node is split there if its children are among the first `2N - 1` nodes.
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
use crate::cell::Cell;
use crate::channel_samples::ChannelSamples;
use crate::sampler::ScreenPoint;

/// A k-D tree over the screen, in the order of its making.
#[derive(Clone, Debug)]
pub struct ScreenTree {
    nodes: Vec<Node>,
    samples: PerChannel<ChannelSamples>,
    points: Vec<ScreenPoint>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) cell: Cell,
    /// The sample that the node had as a leaf.
    pub(crate) sample: u32,
    /// The first of its two children, which stand side by side; 0 for a leaf.
    pub(crate) first_child: u32,
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
#[derive(Clone, Copy, Debug)]
pub(crate) struct NewSample {
    pub(crate) point: ScreenPoint,
    pub(crate) values: PerChannel<Option<f32>>,
}

impl ScreenTree {
    /// The tree of one cell, the screen, with its sample.
    pub(crate) fn new(first: &NewSample) -> Self {
        let mut tree = Self {
            nodes: vec![Node {
                cell: Cell::ROOT,
                sample: 0,
                first_child: 0,
            }],
            samples: PerChannel::default(),
            points: Vec::new(),
        };
        tree.store(first);
        tree
    }

    /// Splits a leaf: its sample keeps the half that it lies in, `new` goes into the other.
    ///
    /// Gives the first of the two children.
    pub(crate) fn split(&mut self, leaf: u32, new: &NewSample) -> u32 {
        let first_child = as_index(self.nodes.len());
        let new_sample = as_index(self.points.len());
        let node = &mut self.nodes[leaf as usize];
        node.first_child = first_child;
        let Node { cell, sample, .. } = *node;
        let mut samples = [new_sample; 2];
        samples[cell.half_of(self.points[sample as usize])] = sample;
        for (half, sample) in cell.halves().into_iter().zip(samples) {
            self.nodes.push(Node {
                cell: half,
                sample,
                first_child: 0,
            });
        }
        self.store(new);
        first_child
    }

    fn store(&mut self, new: &NewSample) {
        let sample = as_index(self.points.len());
        self.points.push(new.point);
        for channel in Channel::ALL {
            if let Some(value) = new.values[channel] {
                self.samples[channel].push(sample, value);
            }
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
    pub fn points(&self) -> &[ScreenPoint] {
        &self.points
    }

    pub(crate) fn node(&self, index: u32) -> &Node {
        &self.nodes[index as usize]
    }

    /// The nodes of the tree as it stood after `rays` samples.
    pub(crate) fn nodes(&self, rays: usize) -> &[Node] {
        let count = 2 * rays.clamp(1, self.len()) - 1;
        &self.nodes[..count]
    }

    /// The value of one channel for a sample, or `None` if the channel had stopped before it.
    pub(crate) fn value(&self, channel: Channel, sample: u32) -> Option<f32> {
        self.samples[channel].get(sample)
    }

    /// The leaves of one channel, in the order of their making; `None` if the channel stopped earlier.
    ///
    /// A ray count beyond the end of the tree means the whole tree.
    pub fn leaves(&self, channel: Channel, reach: Reach) -> Option<Vec<Leaf>> {
        let nodes = self.nodes(reach.rays);
        let is_leaf = |node: &&Node| {
            let depth = node.cell.depth();
            let is_split = node.first_child != 0 && (node.first_child as usize) < nodes.len();
            depth == reach.depth || (depth < reach.depth && !is_split)
        };
        let leaf = |node: &Node| {
            let value = self.value(channel, node.sample)?;
            Some(Leaf {
                cell: node.cell,
                value,
            })
        };
        nodes.iter().filter(is_leaf).map(leaf).collect()
    }
}

fn as_index(length: usize) -> u32 {
    u32::try_from(length).unwrap_or(u32::MAX)
}
