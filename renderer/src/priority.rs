//! How much a leaf of the screen tree needs another sample.
//!
//! The priority of a leaf is `w · (v + v0)`:
//!
//! - `w` is its area, or `area² / pixel area` if it is smaller than a pixel, where the filter of the
//!   reconstruction averages it with its neighbours anyway;
//! - `v` is the largest of its parent's spread, 1/4 of its grandparent's and 1/16 of its
//!   great-grandparent's. The spread of a node is `(x1 - x2)² / 2`, the variance of the two samples that its
//!   halves had when it was split; the largest over the channels that drive the refinement;
//! - `v0 = (1/255)²`, so that no part of the screen is ever thought to be known: two samples that happen to
//!   agree do not hide a shadow between them.
//!
//! Plain variance × area (section 3.1) follows edges down to the smallest cells and misses shadows.
//!
//! All of it is fixed when the leaf is made: the priority depends on no other leaf, no count, no thread.

use std::cmp::Ordering;

use crate::cell::Cell;

/// The squared brightness step at which section 3.1 ends the subdivision.
const FLOOR: f64 = 1.0 / (255.0 * 255.0);

/// What a generation is worth beside the next one.
const DECAY: f64 = 0.25;

/// The spreads of a leaf's parent, grandparent and great-grandparent.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Ancestry([f64; 3]);

impl Ancestry {
    /// The ancestry of the children of a leaf that was split with this spread.
    pub(crate) const fn with_parent(self, spread: f64) -> Self {
        Self([spread, self.0[0], self.0[1]])
    }

    fn expected_variance(self) -> f64 {
        let [parent, grandparent, great_grandparent] = self.0;
        parent
            .max(DECAY * grandparent)
            .max(DECAY * DECAY * great_grandparent)
    }
}

/// A leaf that waits to be split.
///
/// The greatest comes first: leaves above the minimum depth, in the order of their making (breadth
/// first), then those of the highest priority, the older one first if they are equal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Candidate {
    pub(crate) node: u32,
    pub(crate) cell: Cell,
    pub(crate) ancestry: Ancestry,
    priority: f64,
}

impl Candidate {
    pub(crate) fn new(node: u32, cell: Cell, ancestry: Ancestry, rule: PriorityRule) -> Self {
        Self {
            node,
            cell,
            ancestry,
            priority: rule.priority(cell, ancestry),
        }
    }

    /// Whether the leaf lies above the minimum depth and is split whatever was found in it.
    pub(crate) fn is_due(&self) -> bool {
        self.priority == f64::INFINITY
    }
}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        self.priority
            .total_cmp(&other.priority)
            .then(other.node.cmp(&self.node))
    }
}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Candidate {}

/// What a priority depends on beside the leaf.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PriorityRule {
    /// Leaves above this depth come first.
    pub(crate) min_depth: u32,
    /// The fraction of the screen that a pixel covers.
    pub(crate) pixel_area: f64,
}

impl PriorityRule {
    fn priority(self, cell: Cell, ancestry: Ancestry) -> f64 {
        if cell.depth() < self.min_depth {
            return f64::INFINITY;
        }
        let area = cell.area();
        let weight = area * (area / self.pixel_area).min(1.0);
        weight * (ancestry.expected_variance() + FLOOR)
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
    fn the_priority_is_the_formula_above_and_below_a_pixel() {
        let ancestry = Ancestry::default()
            .with_parent(0.8)
            .with_parent(0.1)
            .with_parent(0.01);
        // v = max(.01, .1/4, .8/16) = .05
        let expected_v = 0.05 + 1.0 / 65025.0;
        let above = RULE.priority(descend(5), ancestry);
        assert!((above / (expected_v / 32.0) - 1.0).abs() < 1e-12);
        let below = RULE.priority(descend(8), ancestry);
        assert!((below / (expected_v * 64.0 / (256.0 * 256.0)) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn shallow_leaves_come_first_and_ties_fall_to_the_older_leaf() {
        let candidate = |node, levels, spread| {
            let ancestry = Ancestry::default().with_parent(spread);
            Candidate::new(node, descend(levels), ancestry, RULE)
        };
        let (due, later) = (candidate(9, 1, 0.0), candidate(2, 4, 1e9));
        assert!(due.is_due() && !later.is_due() && due > later);
        assert!(candidate(3, 4, 0.5) > candidate(4, 4, 0.5));
        assert!(candidate(4, 4, 0.6) > candidate(3, 4, 0.5));
    }
}
