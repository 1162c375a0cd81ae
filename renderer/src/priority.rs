//! How much a leaf of the screen tree needs another sample.
//!
//! The priority of a leaf is `w · (v + v0)`:
//!
//! - `w` is its area, or `area² / filter area` where the filter of the reconstruction averages it with its
//!   neighbours anyway: below [`filter::AREA_PX`] pixels;
//! - `v` is the variance that its ancestors lead to expect: the largest of its parent's spread, 0.6 of its
//!   grandparent's, 0.6² of its great-grandparent's, and so on to the root. The spread of a node is
//!   `(x1 - x2)² / 2`, the variance of the two samples that its halves had when it was split; the largest
//!   over the channels that drive the refinement;
//! - `v0 = (1/255)²`, so that no part of the screen is ever thought to be known.
//!
//! Plain variance × area (section 3.1) follows edges down to the smallest cells and misses what two samples
//! that happen to agree have between them. Where a picture is made of edges its variance falls with the
//! side of the cell, by `1/√2` in each halving; two samples that agree are some evidence, so a little
//! less is best: measured on the study's scene, 0.5 to 0.7 are equally good, 1/4 (and three generations) is worse
//! than uniform sampling, since half of the leaves across an edge look flat and are left at that.
//!
//! All of it is fixed when the leaf is made: the priority depends on no other leaf, no count, no thread.

use crate::cell::Cell;
use crate::filter;

/// The squared brightness step at which section 3.1 ends the subdivision.
const FLOOR: f64 = 1.0 / (255.0 * 255.0);

/// How much of a node's expected variance its halves inherit.
const INHERITED: f64 = 0.6;

/// The variance that the ancestors of a leaf lead to expect in it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ExpectedVariance(f32);

impl ExpectedVariance {
    /// What to expect in the halves of a leaf that was split with this spread.
    pub(crate) fn of_halves(self, spread: f64) -> Self {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "an estimate, of which a tree holds one for each leaf"
        )]
        let rounded = spread.max(INHERITED * f64::from(self.0)) as f32;
        Self(rounded)
    }
}

/// What a priority depends on beside the leaf.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PriorityRule {
    /// Leaves above this depth come first.
    pub(crate) min_depth: u32,
    /// The fraction of the screen that a pixel covers.
    pub(crate) pixel_area: f64,
}

impl PriorityRule {
    /// The priority of a leaf; infinite above the minimum depth.
    pub(crate) fn priority(self, cell: Cell, expected: ExpectedVariance) -> f64 {
        if cell.depth() < self.min_depth {
            return f64::INFINITY;
        }
        let area = cell.area();
        let filter_area = filter::AREA_PX * self.pixel_area;
        let weight = area * (area / filter_area).min(1.0);
        weight * (f64::from(expected.0) + FLOOR)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RULE: PriorityRule = PriorityRule {
        min_depth: 2,
        pixel_area: 1.0 / 64.0,
    };

    fn descend(levels: u32) -> Cell {
        (0..levels).fold(Cell::ROOT, |cell, _| cell.halves()[0])
    }

    #[test]
    fn the_priority_is_the_formula_above_and_below_the_filter() {
        let spreads = [0.8, 0.1, 0.01];
        let expected = spreads
            .iter()
            .fold(ExpectedVariance::default(), |expected, &spread| {
                expected.of_halves(spread)
            });
        // v = max(.01, .6 · .1, .36 · .8) = .288
        let variance = 0.288 + 1.0 / 65025.0;
        // Areas of 1/16 and 1/256; the filter's is 2.25/64.
        // The expected variance is held as f32.
        let above = RULE.priority(descend(4), expected);
        assert!((above / (variance / 16.0) - 1.0).abs() < 1e-6);
        let below = RULE.priority(descend(8), expected);
        assert!((below / (variance * 64.0 / 2.25 / 65536.0) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn above_the_minimum_depth_a_leaf_is_split_whatever_was_found_in_it() {
        let unknown = ExpectedVariance::default();
        assert_eq!(RULE.priority(descend(1), unknown), f64::INFINITY);
        assert!(RULE.priority(descend(2), unknown).is_finite());
    }
}
