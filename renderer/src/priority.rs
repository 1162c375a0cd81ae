//! How much a leaf of the screen tree needs another sample.
//!
//! The priority of a leaf is `w · (v + v0)`:
//!
//! - `w` is its area, or `area² / filter area` where the filter of the reconstruction averages it with its
//!   neighbours anyway: below [`filter::AREA_PX`] pixels;
//! - `v` is the variance that its neighbours lead to expect in it: the largest of `f² (x1 - x2)² / 2` over the
//!   neighbours that it met. Between two samples that differ there is an edge; `f` is the part of the way from
//!   one to the other that lies in this leaf. The largest over the channels that drive the refinement;
//! - `v0 = (1/255)²`, so that no part of the screen is ever thought to be known.
//!
//! `w v` is what a leaf adds to the squared error of the picture, summed over the pixels. A split halves `w`
//! or quarters it, so that the leaf that adds most is also the one whose split gains most.
//!
//! Plain variance × area (section 3.1) knows of an edge only in the cells in which two samples happened to lie
//! on different sides of it, and as often as not goes on in the half where the edge is not. Neighbours tell.

use crate::cell::{Cell, half_to_the};
use crate::filter;

/// The squared brightness step at which section 3.1 ends the subdivision.
const FLOOR: f32 = 1.0 / (255.0 * 255.0);

/// Sign, exponent and three bits of the fraction of a 32-bit float make its class.
const DROPPED_BITS: u32 = 23 - 3;

/// The class of leaves that are not to be split.
pub(crate) const NEVER: usize = 0;

/// The class of leaves that are split whatever was found in them.
pub(crate) const DUE: usize = (f32::INFINITY.to_bits() >> DROPPED_BITS) as usize;

/// How many classes of priority there are.
pub(crate) const CLASSES: usize = DUE + 1;

/// What two neighbours whose samples have this variance lead to expect in each other.
///
/// `share` is the part of the way between the samples that lies in the first.
pub(crate) fn expected_variances(variance: f32, share: f64) -> [f32; 2] {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "an estimate, of which a tree holds one for each leaf"
    )]
    let share = share as f32;
    [share, 1.0 - share].map(|share| variance * share * share)
}

/// What a priority depends on beside the leaf.
#[derive(Clone, Debug)]
pub(crate) struct PriorityRule {
    /// `w` at each depth.
    weights: Vec<f32>,
}

impl PriorityRule {
    /// Leaves above the minimum depth come first; at the deepest depth no leaf is split.
    ///
    /// `pixel_area` is the fraction of the screen that a pixel covers.
    pub(crate) fn new(min_depth: u32, deepest: u32, pixel_area: f64) -> Self {
        let filter_area = filter::AREA_PX * pixel_area;
        let weight = |depth: u32| {
            let area = half_to_the(depth);
            #[expect(
                clippy::cast_possible_truncation,
                reason = "a priority needs no more than the bits of its class"
            )]
            let weight = (area * (area / filter_area).min(1.0)) as f32;
            match depth {
                _ if depth >= deepest => 0.0,
                _ if depth < min_depth => f32::INFINITY,
                _ => weight,
            }
        };
        Self {
            weights: (0..=Cell::DEEPEST).map(weight).collect(),
        }
    }

    /// The class of the priority of a leaf, in rising order.
    pub(crate) fn class(&self, cell: Cell, expected: f32) -> usize {
        let priority = self.weights[cell.depth() as usize] * (expected + FLOOR);
        (priority.to_bits() >> DROPPED_BITS) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cell::Axis;

    fn descend(levels: u32) -> Cell {
        (0..levels).fold(Cell::ROOT, |cell, level| {
            let axis = if level % 2 == 0 { Axis::X } else { Axis::Y };
            cell.halves(axis)[0]
        })
    }

    /// The class by arithmetic instead of bits: eighths of an octave from 2⁻¹²⁷.
    fn class_of(priority: f64) -> usize {
        let octave = priority.log2().floor();
        let eighths = (8.0 * (priority / octave.exp2() - 1.0)).floor();
        (0..DUE)
            .find(|&class| class as f64 == 8.0 * (octave + 127.0) + eighths)
            .unwrap()
    }

    #[test]
    fn the_priority_is_the_formula_above_and_below_the_filter() {
        let rule = PriorityRule::new(2, 40, 1.0 / 64.0);
        // A border a quarter of the way from one sample to the other: 1/16 and 9/16 of the variance.
        let [here, there] = expected_variances(0.32, 0.25);
        assert!((here - 0.02).abs() < 1e-7 && (there - 0.18).abs() < 1e-7);
        let variance = 0.18 + 1.0 / 65025.0;
        // Areas of 1/16 and 1/256; the filter's is 2.25/64.
        assert_eq!(rule.class(descend(4), there), class_of(variance / 16.0));
        let below = variance * 64.0 / 2.25 / 65536.0;
        assert_eq!(rule.class(descend(8), there), class_of(below));
    }

    #[test]
    fn leaves_above_the_minimum_depth_are_due_and_the_deepest_are_never_split() {
        let rule = PriorityRule::new(2, 9, 1.0 / 64.0);
        assert_eq!(rule.class(descend(1), 0.0), DUE);
        assert!(rule.class(descend(2), 1.0) < DUE);
        assert!(rule.class(descend(8), 0.0) > NEVER);
        assert_eq!(rule.class(descend(9), 1.0), NEVER);
        // The smallest weight of all is still a number.
        let deep = PriorityRule::new(0, 48, 1.0);
        assert!(deep.class(descend(47), 0.0) > NEVER);
    }
}
