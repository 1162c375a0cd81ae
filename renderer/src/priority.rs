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
pub(crate) const NEVER: u16 = 0;

/// The class of leaves that are split whatever was found in them.
pub(crate) const DUE: u16 = class_of(f32::INFINITY);

/// How many classes of priority there are.
pub(crate) const CLASSES: usize = DUE as usize + 1;

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

    /// The class of the priority of a leaf of this depth, in rising order.
    pub(crate) fn class(&self, depth: u32, expected: f32) -> u16 {
        class_of(self.weights[depth as usize] * (expected + FLOOR))
    }
}

/// The class of a priority, which is never negative.
const fn class_of(priority: f32) -> u16 {
    (priority.to_bits() >> DROPPED_BITS) as u16
}

#[cfg(test)]
mod tests {
    use super::*;
    /// The class by arithmetic instead of bits: eighths of an octave from 2⁻¹²⁷.
    fn class_of_f64(priority: f64) -> u16 {
        let octave = priority.log2().floor();
        let eighths = (8.0 * (priority / octave.exp2() - 1.0)).floor();
        (0..DUE)
            .find(|&class| f64::from(class) == 8.0 * (octave + 127.0) + eighths)
            .unwrap()
    }

    #[test]
    fn the_priority_is_the_formula_above_and_below_the_filter() {
        let rule = PriorityRule::new(2, 40, 1.0 / 64.0);
        let there = 0.18;
        let variance = 0.18 + 1.0 / 65025.0;
        // Areas of 1/16 and 1/256; the filter's is 2.25/64.
        assert_eq!(rule.class(4, there), class_of_f64(variance / 16.0));
        let below = variance * 64.0 / 2.25 / 65536.0;
        assert_eq!(rule.class(8, there), class_of_f64(below));
    }

    #[test]
    fn leaves_above_the_minimum_depth_are_due_and_the_deepest_are_never_split() {
        let rule = PriorityRule::new(2, 9, 1.0 / 64.0);
        assert_eq!(rule.class(1, 0.0), DUE);
        assert!(rule.class(2, 1.0) < DUE);
        assert!(rule.class(8, 0.0) > NEVER);
        assert_eq!(rule.class(9, 1.0), NEVER);
        // The smallest weight of all is still a number.
        let deep = PriorityRule::new(0, 48, 1.0);
        assert!(deep.class(47, 0.0) > NEVER);
    }
}
