//! When a region of the screen is known well enough, section 3.1 of Meyer & Liu (1992): "Subdivision
//! terminates when there is sufficient confidence that the mean estimate at that node is within 1/255 of its
//! final value."
//!
//! A *region* is a leaf; where leaves are smaller than a pixel it is the largest cell with no side longer
//! than a pixel, with all leaves in it. It is *known* within a tolerance `t` if
//!
//! ```text
//! 1.96 sqrt(V) <= t,        V = sum of (area of leaf / area of region)² v
//! ```
//!
//! with `v` the variance that is to be expected in a leaf, so that `V` is the variance of the mean of the
//! region (each leaf has one sample), and 1.96 standard errors are 95% of a normal distribution. Larger cells
//! are then known too: the variance of a mean is no larger than the mean of the variances of its halves.
//!
//! Leaves of known regions are not split, unless a new neighbour raises the expected variance again. The run
//! ends when every region is known.

use std::fmt;

use protocols::Channel;

use crate::cell::{Cell, half_to_the};

/// Standard errors to either side of a mean that hold 95% of a normal distribution.
const STANDARD_ERRORS: f64 = 1.959_963_984_540_054;

/// How well the mean of every region is to be known, and in which channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Confidence {
    /// The tolerance, in steps of 1/255.
    pub steps: u8,
    /// The channel whose means are to be known.
    pub channel: Channel,
}

impl Confidence {
    /// The largest variance that the mean of a known region has, `(t / 1.96)²`.
    fn most_variance(self) -> f64 {
        let standard_error = f64::from(self.steps) / 255.0 / STANDARD_ERRORS;
        standard_error * standard_error
    }
}

impl fmt::Display for Confidence {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { steps, channel } = self;
        write!(formatter, "{steps}/255 in {channel}, at 95% confidence")
    }
}

/// How a run that was to end by confidence ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConfidenceReached {
    /// What was asked for.
    pub until: Confidence,
    /// How many rays were taken.
    pub rays: u64,
    /// The part of the screen that is not known; 0 if the run ended since all is.
    pub unknown_area: f64,
}

impl fmt::Display for ConfidenceReached {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            until,
            rays,
            unknown_area,
        } = self;
        if *unknown_area == 0.0 {
            write!(
                formatter,
                "the mean of every region is known within {until}, after {rays} rays"
            )
        } else {
            let percent = 100.0 * unknown_area;
            write!(
                formatter,
                "the rays or the depth ended the run after {rays} rays, before every region was known within \
                 {until}: {percent:.2}% of the screen is not"
            )
        }
    }
}

/// What is known of the regions of a growing tree.
#[derive(Clone, Debug)]
pub(crate) struct Regions {
    most_variance: f64,
    /// Along x and along y, of the cells with no side longer than a pixel.
    halvings: [u32; 2],
    /// `V` of each of these cells, the sum over the leaves in it.
    variances: Vec<f32>,
}

impl Regions {
    pub(crate) fn new(confidence: Confidence, size_px: [u32; 2]) -> Self {
        let halvings = Cell::halvings_to_side(size_px, 1.0);
        Self {
            most_variance: confidence.most_variance(),
            halvings,
            variances: vec![0.0; 1 << halvings.iter().sum::<u32>()],
        }
    }

    fn depth(&self) -> u32 {
        self.halvings.iter().sum()
    }

    /// Forgets what was known and takes in all leaves, each with the variance to be expected in it.
    pub(crate) fn learn(&mut self, leaves: impl Iterator<Item = (Cell, f32)>) {
        self.variances.fill(0.0);
        for (cell, variance) in leaves {
            if cell.depth() > self.depth() {
                let share = cell.area() / half_to_the(self.depth());
                #[expect(
                    clippy::cast_possible_truncation,
                    reason = "an estimate, of which there is one for each pixel"
                )]
                let part = (share * share * f64::from(variance)) as f32;
                self.variances[cell.place_among(self.halvings)] += part;
            }
        }
    }

    /// Whether the region of a leaf is known.
    pub(crate) fn is_known(&self, cell: Cell, variance: f32) -> bool {
        let variance = if cell.depth() > self.depth() {
            self.variances[cell.place_among(self.halvings)]
        } else {
            variance
        };
        f64::from(variance) <= self.most_variance
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cell::Axis;

    const WITHIN_2_STEPS: Confidence = Confidence {
        steps: 2,
        channel: Channel::A,
    };

    fn descend(path: &[usize]) -> Cell {
        let halve = |cell: Cell, &half: &usize| {
            let axis = cell.cut([4, 4], Axis::X);
            cell.halves(axis)[half]
        };
        path.iter().fold(Cell::ROOT, halve)
    }

    /// (2/255/1.95996)² = 1.6013e-5.
    #[test]
    fn a_leaf_is_known_if_its_sample_is_surely_near_the_mean() {
        let regions = Regions::new(WITHIN_2_STEPS, [4, 4]);
        let leaf = descend(&[0, 1, 0]);
        assert!(regions.is_known(leaf, 1.60e-5));
        assert!(!regions.is_known(leaf, 1.61e-5));
    }

    /// Sixteen pixels of depth 4. One has leaves of 1/2, 1/4 and 1/4 of it: V = v1/4 + v2/16 + v3/16.
    #[test]
    fn below_a_pixel_the_leaves_of_a_pixel_are_known_together() {
        let mut regions = Regions::new(WITHIN_2_STEPS, [4, 4]);
        let leaves = [
            descend(&[1, 0, 0, 1, 0]),
            descend(&[1, 0, 0, 1, 1, 0]),
            descend(&[1, 0, 0, 1, 1, 1]),
        ];
        let elsewhere = descend(&[1, 0, 1, 1, 0]);
        let v = |scale: f32| [4e-5 * scale, 0.0, 9.6e-5 * scale];
        // 1e-5 + 0.6e-5 = 1.6e-5.
        for (scale, is_known) in [(1.0, true), (1.01, false)] {
            let all = leaves.into_iter().zip(v(scale));
            regions.learn(all.chain([(elsewhere, 1.0)]));
            for leaf in leaves {
                assert_eq!(regions.is_known(leaf, 1.0), is_known);
            }
            assert!(!regions.is_known(elsewhere, 0.0));
        }
    }
}
