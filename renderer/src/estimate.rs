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

use crate::screen_tree::ScreenTree;

/// The mean of a channel over a node's cell, and how sure it is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// The mean.
    pub mean: f64,
    /// The variance of the mean; `None` for a tree of one sample.
    pub variance: Option<f64>,
}

impl ScreenTree {
    /// The estimate of every node of the tree as it stood after `rays` samples, the root first; `None` if
    /// the channel was not shaded for all of them.
    pub fn estimates(&self, channel: Channel, rays: usize) -> Option<Vec<Estimate>> {
        let nodes = self.nodes(rays);
        let leaf = |sample| {
            let mean = f64::from(self.value(channel, sample)?);
            Some(Estimate {
                mean,
                variance: None,
            })
        };
        let leaves: Option<Vec<Estimate>> = nodes.iter().map(|node| leaf(node.sample)).collect();
        let mut estimates = leaves?;
        for (index, node) in nodes.iter().enumerate().rev() {
            let first_child = node.first_child as usize;
            if first_child == 0 || first_child >= nodes.len() {
                continue;
            }
            let [one, other] = [estimates[first_child], estimates[first_child + 1]];
            let beside = 0.5 * (one.mean - other.mean).powi(2);
            for child in &mut estimates[first_child..first_child + 2] {
                child.variance.get_or_insert(beside);
            }
            let [v1, v2] = [one, other].map(|child| child.variance.unwrap_or(beside));
            estimates[index] = Estimate {
                mean: 0.5 * (one.mean + other.mean),
                variance: Some(0.25 * (v1 + v2)),
            };
        }
        Some(estimates)
    }
}
