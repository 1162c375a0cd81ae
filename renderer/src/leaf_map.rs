//! Which leaf lies where: a map of the screen on a grid of squares, kept while the tree grows.
//!
//! A square belongs to the leaf that covers its middle. The grid has at least four squares for each leaf, as
//! long as it has no more than 2¹³ along a side. Leaves that are smaller than a square share one, and the map
//! then knows one of them.
//!
//! Squares stand in Morton's order, the bits of row and column in turn, so that what is near on the screen is
//! near in memory and most cells are one run of it.
//!
//! Not here: what is made of the neighbours that are found; see [`leaves`](crate::leaves).
//!
//! Source: Morton (1966), "A computer oriented geodetic data base", for the order.

use crate::cell::Axis;
use crate::grid_cell::GridCell;

/// Squares for each leaf before the grid is made finer.
const SQUARES_PER_LEAF: usize = 4;

/// The finest grid has 2 to the power of this many squares along its longer side.
const FINEST: u32 = 13;

/// The leaf at every place of the screen.
#[derive(Clone, Debug)]
pub(crate) struct LeafMap {
    /// How often the screen is halved along x and along y to make the squares.
    halvings: [u32; 2],
    finest: [u32; 2],
    leaves: Vec<u32>,
}

impl LeafMap {
    /// The map of a screen that is one leaf, number 0.
    pub(crate) fn new(size_px: [u32; 2]) -> Self {
        let longest = u64::from(size_px[0].max(size_px[1]).max(1));
        let finest = size_px.map(|size| {
            let squares = (u64::from(size) << FINEST) / longest;
            squares.max(1).next_power_of_two().ilog2()
        });
        let mut map = Self {
            halvings: [0; 2],
            finest,
            leaves: vec![0],
        };
        map.resize(1);
        map
    }

    /// Makes the grid as fine as this many leaves ask for; whether it changed, and is to be filled again.
    pub(crate) fn resize(&mut self, leaves: usize) -> bool {
        let coarsened = |by: u32| self.finest.map(|halvings| halvings.saturating_sub(by));
        let is_enough = |&by: &u32| {
            let [along_x, along_y] = coarsened(by);
            1 << (along_x + along_y) >= SQUARES_PER_LEAF * leaves
        };
        let halvings = coarsened((0..=FINEST).rev().find(is_enough).unwrap_or(0));
        let is_changed = halvings != self.halvings;
        if is_changed {
            self.halvings = halvings;
            // The order may leave places unused on a long picture; memory that is never touched is never taken.
            let last = halvings.map(|halvings| (1 << halvings) - 1);
            self.leaves = vec![0; place(last) + 1];
        }
        is_changed
    }

    /// Enters a leaf.
    pub(crate) fn enter(&mut self, leaf: u32, cell: GridCell) {
        let mut blocks = [0; 2];
        for axis in [0, 1] {
            let (cells, squares) = (u32::from(cell.halvings[axis]), self.halvings[axis]);
            // A part of a square has it if it begins in its middle.
            if cells > squares && (cell.from[axis] << squares) != 1 << 31 {
                return;
            }
            blocks[axis] = squares.saturating_sub(cells);
        }
        // The cell in blocks of as many columns as rows, of which each is one run.
        let size = blocks[0].min(blocks[1]);
        let first = self.square(cell.from).map(|number| number >> size);
        let [columns, rows] = blocks.map(|block| 1 << (block - size));
        if [size, columns, rows] == [0, 1, 1] {
            self.leaves[place(first)] = leaf;
            return;
        }
        for row in 0..rows {
            for column in 0..columns {
                let start = place([first[0] + column, first[1] + row]) << (2 * size);
                self.leaves[start..start + (1 << (2 * size))].fill(leaf);
            }
        }
    }

    /// Whether a leaf at this place has a square of its own.
    pub(crate) fn shows(&self, cell: GridCell) -> bool {
        let [along_x, along_y] = cell.halvings.map(u32::from);
        along_x <= self.halvings[0] && along_y <= self.halvings[1]
    }

    /// The leaves beyond the middles of the left, right, upper and lower side of a leaf, as far as the map knows;
    /// the leaf itself where the screen ends.
    #[inline]
    pub(crate) fn around(&self, leaf: u32, cell: GridCell) -> [u32; 4] {
        let ([left, top], [right, bottom]) = (cell.from, cell.ends());
        let middle = [Axis::X, Axis::Y].map(|axis| cell.middle(axis));
        let before = [left.wrapping_sub(1), top.wrapping_sub(1)];
        let [before, middle, after] =
            [before, middle, [right, bottom]].map(|point| dilated(self.square(point)));
        let found = |side: u32, [x, y]: [u32; 2]| {
            let found = self.leaves[(x | (y << 1)) as usize];
            if side == 0 { leaf } else { found }
        };
        [
            found(left, [before[0], middle[1]]),
            found(right, [after[0], middle[1]]),
            found(top, [middle[0], before[1]]),
            found(bottom, [middle[0], after[1]]),
        ]
    }

    /// The column and the row of the square that holds a point.
    fn square(&self, point: [u32; 2]) -> [u32; 2] {
        let number = |axis: usize| {
            let [halvings, step] = [self.halvings[axis], point[axis]];
            // Two shifts, since one by 32 has no meaning.
            step >> (31 - halvings) >> 1
        };
        [number(0), number(1)]
    }
}

/// Where the square of a column and a row stands in Morton's order.
fn place(square: [u32; 2]) -> usize {
    let [x, y] = dilated(square);
    (x | (y << 1)) as usize
}

/// Two numbers of 16 bits with a 0 above each bit.
#[expect(clippy::cast_possible_truncation, reason = "the two halves on purpose")]
const fn dilated([x, y]: [u32; 2]) -> [u32; 2] {
    let mut bits = x as u64 | ((y as u64) << 32);
    bits = (bits | (bits << 8)) & 0x00ff_00ff_00ff_00ff;
    bits = (bits | (bits << 4)) & 0x0f0f_0f0f_0f0f_0f0f;
    bits = (bits | (bits << 2)) & 0x3333_3333_3333_3333;
    bits = (bits | (bits << 1)) & 0x5555_5555_5555_5555;
    [bits as u32, (bits >> 32) as u32]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cell::Rectangle;
    use crate::sampler::GridPoint;

    /// The cell with these halvings in whose upper left corner lies the point at these fractions.
    fn cell(fractions: [f64; 2], halvings: [u8; 2]) -> GridCell {
        let [x, y] = fractions;
        GridCell::holding(crate::sampler::ScreenPoint { x, y }.into(), halvings)
    }

    /// Leaf 0 is the upper left quarter, 1 the lower left one, 2 the right half.
    fn three_leaves() -> LeafMap {
        let mut map = LeafMap::new([8, 8]);
        map.enter(2, cell([0.5, 0.0], [1, 0]));
        map.enter(1, cell([0.0, 0.5], [1, 1]));
        map
    }

    #[test]
    fn the_leaf_beyond_each_side_is_found_and_nothing_beyond_the_screen() {
        let map = three_leaves();
        assert_eq!(map.around(0, cell([0.0, 0.0], [1, 1])), [0, 2, 0, 1]);
        // The middle of its left side is where 1 begins.
        assert_eq!(map.around(2, cell([0.5, 0.0], [1, 0])), [1, 2, 2, 2]);
    }

    #[test]
    fn a_finer_grid_is_empty_until_it_is_filled_and_has_an_end() {
        let mut map = LeafMap::new([16, 4]);
        assert_eq!(map.halvings, [2, 0]);
        assert!(!map.resize(1));
        map.enter(5, cell([0.0, 0.0], [0, 0]));
        assert!(map.resize(3) && map.leaves.iter().all(|&leaf| leaf == 0));
        assert_eq!(map.halvings, [3, 1]);
        let mut long = LeafMap::new([16_384, 1]);
        long.resize(1_000_000);
        assert_eq!(long.halvings, [FINEST, 0]);
    }

    /// Halves of one square: the second covers the middle.
    #[test]
    fn of_leaves_that_share_a_square_the_map_knows_the_one_over_its_middle() {
        let mut map = LeafMap::new([1, 1]);
        assert_eq!(map.halvings, [1, 1]);
        assert!(map.shows(cell([0.0, 0.0], [1, 1])) && !map.shows(cell([0.0, 0.0], [2, 1])));
        map.enter(1, cell([0.0, 0.0], [2, 1]));
        map.enter(2, cell([0.25, 0.0], [2, 1]));
        assert_eq!(map.around(1, cell([0.0, 0.0], [2, 1]))[1], 2);
        assert_eq!(map.around(0, cell([0.5, 0.0], [1, 1]))[0], 2);
    }

    /// A plain grid of squares by rows.
    struct PlainMap {
        columns: usize,
        leaves: Vec<u32>,
    }

    impl PlainMap {
        fn enter(&mut self, leaf: u32, place: Rectangle) {
            let rows = self.leaves.len() / self.columns;
            for (square, holder) in self.leaves.iter_mut().enumerate() {
                let x = ((square % self.columns) as f64 + 0.5) / self.columns as f64;
                let y = ((square / self.columns) as f64 + 0.5) / rows as f64;
                let is_right = (place.left..place.left + place.width).contains(&x);
                if is_right && (place.top..place.top + place.height).contains(&y) {
                    *holder = leaf;
                }
            }
        }

        fn at(&self, x: f64, y: f64) -> Option<u32> {
            let rows = self.leaves.len() / self.columns;
            let begins =
                |square: usize, part: f64, count: usize| square as f64 <= part * count as f64;
            let index = |part, count| (0..count).rfind(|&square| begins(square, part, count));
            let is_on_screen = (0.0..1.0).contains(&x) && (0.0..1.0).contains(&y);
            let square = index(y, rows)? * self.columns + index(x, self.columns)?;
            is_on_screen.then(|| self.leaves[square])
        }
    }

    /// Cells of all sizes, entered one over the other; the places beyond the sides in fractions of the screen.
    #[test]
    fn it_finds_what_a_plain_grid_finds() {
        let little = 1e-7;
        for size_px in [[8, 8], [16, 4], [5, 40]] {
            let mut map = LeafMap::new(size_px);
            map.resize(60);
            let [columns, rows] = map.halvings.map(|halvings| 1_usize << halvings);
            let mut plain = PlainMap {
                columns,
                leaves: vec![0; columns * rows],
            };
            for number in 1..600_u32 {
                let bits = number.wrapping_mul(0x9e37_79b9);
                let [one, other, ..] = bits.to_le_bytes();
                let halvings = [one % 7, other % 7];
                let point = GridPoint([bits.wrapping_mul(77), bits.wrapping_mul(555)]);
                let cell = GridCell::holding(point, halvings);
                let place = cell.cell().rectangle();
                map.enter(number, cell);
                plain.enter(number, place);
                let x = place.left + 0.5 * place.width;
                let y = place.top + 0.5 * place.height;
                let expected = [
                    plain.at(place.left - little, y),
                    plain.at(place.left + place.width + little, y),
                    plain.at(x, place.top - little),
                    plain.at(x, place.top + place.height + little),
                ];
                let expected = expected.map(|leaf| leaf.unwrap_or(number));
                assert_eq!(map.around(number, cell), expected, "{cell:?}");
            }
        }
    }
}
