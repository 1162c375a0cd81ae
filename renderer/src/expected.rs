//! The variance that its neighbours lead to expect in a leaf, and the axis on which they lie.

use crate::cell::Axis;

/// The largest variance that a neighbour leads to expect, and the axis on which that neighbour lies.
///
/// One number, larger for a larger variance, and of equal ones for x: the bits of the variance, which is not
/// negative, and below them one for the axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Expected(u32);

impl Expected {
    pub(crate) const NOTHING: Self = Self(1);

    /// What is not a number is nothing.
    #[inline]
    pub(crate) fn new(variance: f32, axis: Axis) -> Self {
        let variance = if variance > 0.0 { variance } else { 0.0 };
        Self((variance.to_bits() << 1) | u32::from(axis == Axis::X))
    }

    pub(crate) const fn variance(self) -> f32 {
        f32::from_bits(self.0 >> 1)
    }

    pub(crate) const fn axis(self) -> Axis {
        if self.0 & 1 == 1 { Axis::X } else { Axis::Y }
    }
}

/// What two neighbours whose samples have this variance lead to expect in each other, `f² variance`.
///
/// `share` is the part `f` of the way between the samples that lies in the first.
#[inline]
pub(crate) fn expected_variances(variance: f32, share: f32) -> [f32; 2] {
    let rest = 1.0 - share;
    [variance * share * share, variance * rest * rest]
}

/// The part of the way from one sample to its neighbour's that lies on its own side of the border, from the
/// places of all three along the axis.
#[inline]
pub(crate) fn share(border: u32, [own, other]: [u32; 2]) -> f32 {
    let way = |to: u32| {
        let length = (to.max(own) - to.min(own)) as f32;
        if to >= own { length } else { -length }
    };
    let share = way(border) / way(other);
    // Where several leaves share a square of the map it may name one that does not lie beyond the border.
    if (0.0..=1.0).contains(&share) {
        share
    } else {
        0.5
    }
}

/// The variance of two samples, from their difference.
#[inline]
pub(crate) fn halved_square(difference: f32) -> f32 {
    0.5 * difference * difference
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_larger_variance_is_more_and_of_equal_ones_that_along_x() {
        let rising = [
            Expected::new(0.0, Axis::Y),
            Expected::NOTHING,
            Expected::new(1e-30, Axis::Y),
            Expected::new(0.5, Axis::Y),
            Expected::new(0.5, Axis::X),
            Expected::new(1.99, Axis::Y),
        ];
        assert!(rising.is_sorted_by(|one, other| one < other));
        assert_eq!((rising[3].variance(), rising[3].axis()), (0.5, Axis::Y));
        assert_eq!((rising[4].variance(), rising[4].axis()), (0.5, Axis::X));
        assert_eq!(Expected::new(0.0, Axis::X), Expected::NOTHING);
        assert_eq!(Expected::new(f32::NAN, Axis::X), Expected::NOTHING);
    }

    /// A quarter of the way: 1/16 and 9/16 of the variance.
    #[test]
    fn the_way_is_parted_by_the_border_in_both_directions() {
        assert_eq!(share(150, [100, 300]), 0.25);
        assert_eq!(share(150, [300, 100]), 0.75);
        assert_eq!(share(u32::MAX, [0, u32::MAX]), 1.0);
        assert_eq!([share(50, [100, 300]), share(100, [100, 100])], [0.5; 2]);
        assert_eq!(expected_variances(16.0, 0.25), [1.0, 9.0]);
    }
}
