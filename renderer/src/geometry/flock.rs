//! How many rays go down a tree of boxes together: node by node, each with all the rays that meet its box.
//!
//! No ray waits for another, so that this is quicker than one after another; but no box is left out because
//! something nearer was hit, so that it pays only for trees that are not deep.
#![expect(
    clippy::inline_always,
    reason = "code for a processor's own instructions is compiled for them only where it is inlined"
)]

use std::ops::Range;

use super::SingleRay;
use super::box_node::{BoxNode, BoxTest, WIDTH};
use super::descent::{Task, Walk};

/// The rays on their way, and memory that is used again.
#[derive(Clone, Debug, Default)]
pub(crate) struct Flock {
    /// The rays in single precision, each with its place among all.
    pub(super) singles: Vec<(SingleRay, u32)>,
    /// For each node that waits the rays that visit it, by their places in `singles`; those of the last last.
    waiting: Vec<u32>,
    /// Those of one node that go on to each of its boxes.
    parted: [Vec<u32>; WIDTH],
    /// Those of a leaf, by their places among all.
    named: Vec<u32>,
}

/// Rays on their way down a tree.
pub(super) struct Flight<'a, L> {
    pub(super) nodes: &'a [BoxNode],
    pub(super) flock: &'a mut Flock,
    /// Is given the places of a leaf and the rays that meet its box.
    pub(super) leaf: L,
}

impl<L: FnMut(Range<usize>, &[u32])> Task for Flight<'_, L> {
    #[inline(always)]
    fn run(self, test: impl BoxTest) -> Walk {
        let Self {
            nodes,
            flock,
            mut leaf,
        } = self;
        let Flock {
            singles,
            waiting,
            parted,
            named,
        } = flock;
        for part in &mut *parted {
            // One more place, since each ray is written down before it is known whether it counts.
            part.resize(singles.len() + 1, 0);
        }
        waiting.clear();
        waiting.extend((0..singles.len()).filter_map(|place| u32::try_from(place).ok()));
        let mut visits = vec![(0, 0)];
        while let Some((node, first)) = visits.pop() {
            let node: &BoxNode = &nodes[node];
            let mut counts = [0; WIDTH];
            for &place in &waiting[first..] {
                let (single, _) = &singles[place as usize];
                let met = test.entries(node, &test.prepare(single), f32::INFINITY).met;
                for (slot, (part, count)) in parted.iter_mut().zip(&mut counts).enumerate() {
                    part[*count] = place;
                    *count += (met >> slot & 1) as usize;
                }
            }
            waiting.truncate(first);
            for (slot, (part, count)) in parted.iter().zip(counts).enumerate() {
                let child = node.child(slot);
                let part = &part[..count];
                if part.is_empty() {
                    continue;
                }
                if child.count() > 0 {
                    let places = child.first()..child.first() + child.count();
                    named.clear();
                    named.extend(part.iter().map(|&place| singles[place as usize].1));
                    leaf(places, named);
                } else {
                    visits.push((child.first(), waiting.len()));
                    waiting.extend_from_slice(part);
                }
            }
        }
        Walk::On
    }
}
