//! The means of the tree's nodes and the variances of those means, section 3.1 of Meyer & Liu (1992).
//!
//! The two halves of a node cover equal areas and hold samples of their own, so that with `m` the mean and
//! `V` the variance of the mean
//!
//! ```text
//! m = (m1 + m2) / 2          V = (V1 + V2) / 4
//! ```
//!
//! One sample says nothing of its own variance. A leaf is given that of the two means beside each other,
//! `V = (m1 - m2)² / 2`; a node with two leaves then has `V = (m1 - m2)² / 4`, the textbook variance of the
//! mean of two samples.
//!
//! They follow from the samples, so they are computed for the sample count asked for, children before
//! parents, rather than held for one. Refinement itself goes by the spreads in [`priority`](crate::priority).

use protocols::Channel;

use crate::screen_tree::{PlacedNode, ScreenTree};

/// The mean of a channel over a node's cell, and how sure it is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// The mean.
    pub mean: f64,
    /// The variance of the mean; `None` for a tree of one sample.
    pub variance: Option<f64>,
}

impl ScreenTree {
    /// The estimate of every node of the tree as it stood after `rays` samples, in the order of their
    /// making, so the root first; `None` if the channel was not shaded for all of them.
    pub fn estimates(&self, channel: Channel, rays: usize) -> Option<Vec<Estimate>> {
        let rays = rays.clamp(1, self.len());
        let mut estimates = vec![Estimate::default(); 2 * rays - 1];
        self.estimate(channel, rays, PlacedNode::ROOT, &mut estimates)?;
        Some(estimates)
    }

    /// Estimates a node after all nodes below it.
    fn estimate(
        &self,
        channel: Channel,
        rays: usize,
        node: PlacedNode,
        estimates: &mut [Estimate],
    ) -> Option<Estimate> {
        let estimate = if let Some(children) = self.children(node, rays) {
            let [first, _] = children.map(|child| child.index as usize);
            let mut below = [Estimate::default(); 2];
            for (child, estimate) in children.into_iter().zip(&mut below) {
                *estimate = self.estimate(channel, rays, child, estimates)?;
            }
            let [one, other] = below;
            let beside = 0.5 * (one.mean - other.mean).powi(2);
            for child in &mut estimates[first..first + 2] {
                child.variance.get_or_insert(beside);
            }
            let [v1, v2] = [one, other].map(|child| child.variance.unwrap_or(beside));
            Estimate {
                mean: 0.5 * (one.mean + other.mean),
                variance: Some(0.25 * (v1 + v2)),
            }
        } else {
            Estimate {
                mean: f64::from(self.value(channel, node.sample)?),
                variance: None,
            }
        };
        estimates[node.index as usize] = estimate;
        Some(estimate)
    }
}
