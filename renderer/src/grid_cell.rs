//! A cell on the grid of the sample points, in whole numbers: what the growing tree asks of it.
//!
//! A cell of `h` halvings along an axis is 2^(32 - h) steps long there and begins at a multiple of that, so
//! any point inside it and its halvings are the cell.

use crate::cell::Cell;
use crate::sampler::GridPoint;

/// A rectangle of the screen that halving leads to, in steps of the grid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct GridCell {
    /// Its first step along x and along y.
    pub(crate) from: [u32; 2],
    /// How often the screen was halved along x and along y; no more than 31 times each.
    pub(crate) halvings: [u8; 2],
}

impl GridCell {
    /// The cell of so many halvings that holds a point.
    pub(crate) fn holding(GridPoint([x, y]): GridPoint, halvings: [u8; 2]) -> Self {
        let [along_x, along_y] = halvings.map(|halvings| u64::from(u32::MAX) >> halvings);
        Self {
            from: [x & !low_bits(along_x), y & !low_bits(along_y)],
            halvings,
        }
    }

    /// How many halvings lead here.
    pub(crate) fn depth(self) -> u32 {
        self.halvings.map(u32::from).iter().sum()
    }

    /// The first steps beyond it along x and along y; 0 where it ends with the screen.
    pub(crate) fn ends(self) -> [u32; 2] {
        [0, 1].map(|along| {
            let length = (1_u64 << 32) >> self.halvings[along];
            low_bits(u64::from(self.from[along]) + length)
        })
    }

    /// The places of its left, right, upper and lower side; 0 where it ends with the screen.
    pub(crate) fn sides(self) -> [u32; 4] {
        let ([left, top], [right, bottom]) = (self.from, self.ends());
        [left, right, top, bottom]
    }

    /// The same as halvings of the screen.
    pub(crate) fn cell(self) -> Cell {
        Cell::holding(GridPoint(self.from), self.halvings)
    }
}

/// The lower half of a number, which has no other.
#[expect(
    clippy::cast_possible_truncation,
    reason = "the number is less than 2³²"
)]
const fn low_bits(number: u64) -> u32 {
    number as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cell::{Axis, Rectangle};

    const STEPS: f64 = 4_294_967_296.0;

    /// By halving the screen step by step, with the rectangles of the plain cells.
    #[test]
    fn it_is_the_cell_that_halving_step_by_step_leads_to() {
        for number in 0..2000_u64 {
            let mut choices = number.wrapping_mul(0x9e37_79b9_7f4a_7c15);
            let point = GridPoint([low_bits(choices & 0xffff_ffff), low_bits(choices >> 32)]);
            let (mut plain, mut halvings) = (Cell::ROOT, [0_u8; 2]);
            for _ in 0..number % 49 {
                let is_x = halvings[1] == 31 || (halvings[0] < 31 && choices & 1 == 0);
                let axis = if is_x { Axis::X } else { Axis::Y };
                choices = choices.rotate_right(7);
                let half = plain.half_of(point.into(), axis);
                plain = plain.halves(axis)[half];
                halvings[axis as usize] += 1;
            }
            let cell = GridCell::holding(point, halvings);
            assert_eq!(cell.depth(), plain.depth());
            assert_eq!(cell.cell(), plain);
            let Rectangle {
                left,
                top,
                width,
                height,
            } = plain.rectangle();
            assert_eq!(cell.from.map(f64::from), [left * STEPS, top * STEPS]);
            let [right, bottom] = [left + width, top + height].map(|end| end * STEPS);
            assert_eq!(cell.ends().map(f64::from), [right % STEPS, bottom % STEPS]);
        }
    }
}
