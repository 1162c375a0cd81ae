//! The trace: from a sampler and a ray count to the screen tree.
//!
//! Down to the minimum depth every cell is split, breadth first; then, in [rounds](crate::leaves), the leaves
//! of highest [priority](crate::priority). The samples of a round are taken in parallel and added in the order
//! of priority, so that the tree depends on no thread. Neither positions nor priorities nor ties depend on the
//! final count, and a last round that is cut short is the beginning of the whole one: a tree of N samples
//! is the beginning of every larger tree of the same sampler and plan.
//!
//! A channel is shaded only up to its stop. A alone drives the refinement unless the plan says otherwise;
//! then, and only then, the tree does not depend on the stops of C1 and C2.
//!
//! Source: Meyer & Liu (1992), sections 3.1 to 3.3.

use std::sync::{Mutex, MutexGuard, PoisonError};

use arrayvec::ArrayVec;
use protocols::{Channel, PerChannel, RefinementDriver};
use rayon::prelude::*;

use crate::cell::Cell;
use crate::checkpoint::TakenSample;
use crate::confidence::Confidence;
use crate::halving::LANES;
use crate::leaves::Leaves;
use crate::priority::PriorityRule;
use crate::sampler::{GridPoint, Sampler, ScreenPoint};
use crate::screen_tree::{NewLeaf, NewSample, Reach, ScreenTree};

/// Samples taken between two reports of progress: a round is taken in pieces of this many.
const BATCH: usize = 8192;
/// Samples that a thread takes side by side: enough to share what they have in common, few enough to stay in
/// the nearer caches.
const TOGETHER: usize = 512;

/// How a screen tree is made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TracePlan {
    /// The seed of the sample positions.
    pub seed: u64,
    /// The picture that the tree is for: a leaf smaller than a pixel needs a sample less.
    pub size_px: [u32; 2],
    /// Down to this depth every cell is split.
    pub min_depth: u32,
    /// Which channels say where more samples are needed.
    pub driver: RefinementDriver,
    /// How far each channel is shaded. The samples taken are the most that any channel asks for.
    pub stops: PerChannel<Reach>,
    /// How well every region is to be known; the trace ends where it is, or else with its rays.
    pub until: Option<Confidence>,
}

impl TracePlan {
    /// How many samples are taken, unless the depth of A ends the tree before.
    pub fn rays(&self) -> usize {
        let most = Channel::ALL.map(|channel| self.stops[channel].rays);
        most.into_iter().fold(1, usize::max)
    }

    /// Whether a channel says where more samples are needed.
    pub fn is_driver(&self, channel: Channel) -> bool {
        self.driver == RefinementDriver::All || channel == Channel::A
    }

    /// Room for the values of each channel.
    fn capacity(&self) -> PerChannel<usize> {
        PerChannel::from_fn(|channel| {
            let all = self.driver == RefinementDriver::A && channel == Channel::A;
            let Reach { rays, depth } = self.stops[channel];
            let leaves = 1_usize.checked_shl(depth).unwrap_or(usize::MAX);
            if all { self.rays() } else { rays.min(leaves) }
        })
    }

    /// What makes a leaf need another sample.
    pub(crate) fn priority_rule(&self) -> PriorityRule {
        let pixels = f64::from(self.size_px[0]) * f64::from(self.size_px[1]);
        PriorityRule::new(self.min_depth, self.deepest(), 1.0 / pixels)
    }

    /// The depth of the deepest cell: where every driver has stopped there is nothing left to go by.
    fn deepest(&self) -> u32 {
        let drivers = Channel::ALL.into_iter().filter(|&c| self.is_driver(c));
        let deepest = drivers.map(|channel| self.stops[channel].depth).max();
        deepest.map_or(Cell::DEEPEST, |depth| depth.min(Cell::DEEPEST))
    }

    /// Whether a channel is shaded for this sample, which lies in a new leaf of this depth.
    ///
    /// The channel that drives alone is shaded as long as samples are taken, even if its image needs fewer.
    fn is_shaded(&self, channel: Channel, sample: usize, depth: u32) -> bool {
        let Reach {
            rays,
            depth: deepest,
        } = self.stops[channel];
        let drives_alone = self.driver == RefinementDriver::A && channel == Channel::A;
        depth <= deepest && (sample < rays || drives_alone)
    }
}

/// Traces a screen tree; `progress` is told the samples taken and the samples to take.
///
/// Runs in the current rayon pool; the tree is the same in any.
pub fn trace<S: Sampler>(
    sampler: &S,
    plan: &TracePlan,
    progress: &(dyn Fn(u64, u64) + Sync),
) -> ScreenTree {
    trace_from(sampler, plan, &[], (progress, &|| false))
}

/// Traces a screen tree of which the first samples are known: they are not taken again.
///
/// The tree ends early, after a whole batch, once `is_cancelled`.
pub(crate) fn trace_from<S: Sampler>(
    sampler: &S,
    plan: &TracePlan,
    taken: &[TakenSample],
    (progress, is_cancelled): (&(dyn Fn(u64, u64) + Sync), &dyn Fn() -> bool),
) -> ScreenTree {
    let rays = plan.rays();
    let sampling = Sampling {
        sampler,
        plan,
        taken,
        spare: Mutex::default(),
    };
    let mut first = NewSample::default();
    let probe = Probe::new(plan, 0, Leaves::first_point(plan), 0);
    sampling.take(&[(0, probe)], std::iter::once(&mut first));
    let mut tree = ScreenTree::new(&first, plan.capacity(), rays);
    let mut leaves = Leaves::new(plan, &first);
    let mut new = Vec::new();
    while tree.len() < rays {
        let mut round = leaves.next_round();
        round.truncate(rays - tree.len());
        if round.is_empty() {
            break;
        }
        for batch in round.chunks(BATCH) {
            if is_cancelled() {
                return tree;
            }
            let todo = (&leaves, tree.len(), batch);
            sampling.sample_batch(todo, &mut new);
            rayon::join(|| tree.split(&new), || leaves.split_all(&new));
            progress(tree.len() as u64, rays as u64);
        }
        if tree.len() < rays || plan.until.is_some() {
            leaves.look_around();
        }
    }
    tree.unknown_area = leaves.unknown_area();
    tree
}

/// A sample to be taken.
struct Probe {
    point: GridPoint,
    is_shaded: PerChannel<bool>,
}

impl Probe {
    fn new(plan: &TracePlan, sample: usize, point: GridPoint, depth: u32) -> Self {
        Self {
            point,
            is_shaded: PerChannel::from_fn(|c| plan.is_shaded(c, sample, depth)),
        }
    }

    /// The sample of what its ray found.
    fn shade<S: Sampler>(&self, sampler: &S, ray_tree: &S::RayTree) -> NewSample {
        let values = if Channel::ALL.into_iter().all(|c| self.is_shaded[c]) {
            let values = sampler.shade_all(ray_tree);
            PerChannel::from_fn(|channel| Some(values[channel]))
        } else {
            PerChannel::from_fn(|c| self.is_shaded[c].then(|| sampler.shade(ray_tree, c)))
        };
        NewSample {
            point: self.point,
            values,
        }
    }

    /// The sample as it was taken before.
    fn recall(&self, taken: TakenSample) -> NewSample {
        NewSample {
            point: self.point,
            values: PerChannel::from_fn(|c| self.is_shaded[c].then_some(taken[c])),
        }
    }
}

/// What samples are taken with.
struct Sampling<'a, S: Sampler> {
    sampler: &'a S,
    plan: &'a TracePlan,
    /// The first samples, which are known.
    taken: &'a [TakenSample],
    /// Ray trees that no thread uses now.
    spare: Mutex<Vec<Vec<S::RayTree>>>,
}

impl<S: Sampler> Sampling<'_, S> {
    /// Finds the new samples of a batch of leaves, taken on all threads or recalled: each has the number that
    /// its leaf's place in the batch gives it, but they stand in an order in which what is near on the screen
    /// is near.
    ///
    /// `first` is the number of the first of them.
    fn sample_batch(
        &self,
        (leaves, first, batch): (&Leaves, usize, &[u32]),
        new: &mut Vec<NewLeaf>,
    ) {
        new.resize(batch.len(), NewLeaf::default());
        leaves
            .spatial_order(batch)
            .par_chunks(TOGETHER)
            .zip(new.par_chunks_mut(TOGETHER))
            .for_each(|(places, new)| {
                let mut probes = Vec::with_capacity(places.len());
                for (places, new) in places.chunks(LANES).zip(new.chunks_mut(LANES)) {
                    let some = places.iter().map(|&place| batch[place as usize]);
                    let splits = leaves.splits(&some.collect::<ArrayVec<u32, LANES>>());
                    for ((new, &place), (split, point)) in new.iter_mut().zip(places).zip(splits) {
                        let number = first + place as usize;
                        let depth = split.free_half.depth();
                        probes.push((number, Probe::new(self.plan, number, point, depth)));
                        new.number = as_number(number);
                        new.split = split;
                    }
                }
                self.take(&probes, new.iter_mut().map(|new| &mut new.sample));
            });
    }

    /// Takes or recalls the samples of some probes, each with its number.
    fn take<'n>(
        &self,
        probes: &[(usize, Probe)],
        samples: impl Iterator<Item = &'n mut NewSample>,
    ) {
        let unknown = |(number, probe): &(usize, Probe)| {
            let point = probe.point.into();
            (*number >= self.taken.len()).then_some(point)
        };
        let points: Vec<ScreenPoint> = probes.iter().filter_map(unknown).collect();
        let mut trees = self.spare().pop().unwrap_or_default();
        trees.resize_with(trees.len().max(points.len()), S::RayTree::default);
        self.sampler
            .intersect_all(&points, &mut trees[..points.len()]);
        let mut found = trees.iter();
        for (sample, (number, probe)) in samples.zip(probes) {
            let taken = self.taken.get(*number).map(|taken| probe.recall(*taken));
            let new = taken.or_else(|| Some(probe.shade(self.sampler, found.next()?)));
            *sample = new.unwrap_or_default();
        }
        self.spare().push(trees);
    }

    fn spare(&self) -> MutexGuard<'_, Vec<Vec<S::RayTree>>> {
        self.spare.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn as_number(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}
