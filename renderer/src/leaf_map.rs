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
#![expect(
    clippy::inline_always,
    reason = "code for a processor's own instructions is compiled for them only where it is inlined"
)]

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

    /// Makes the grid as fine as this many leaves ask for. If it changes, gives the grid whose squares were kept:
    /// leaves of which it does not [show](Grid::shows) the whole are to be entered again.
    pub(crate) fn resize(&mut self, leaves: usize) -> Option<Grid> {
        let coarsened = |by: u32| self.finest.map(|halvings| halvings.saturating_sub(by));
        let is_enough = |&by: &u32| {
            let [along_x, along_y] = coarsened(by);
            1 << (along_x + along_y) >= SQUARES_PER_LEAF * leaves
        };
        let halvings = coarsened((0..=FINEST).rev().find(is_enough).unwrap_or(0));
        if halvings == self.halvings {
            return None;
        }
        let Self {
            halvings: coarse,
            leaves: old,
            ..
        } = std::mem::replace(
            self,
            Self {
                halvings,
                finest: self.finest,
                // The order may leave places unused on a long picture; memory that is never touched is never taken.
                leaves: vec![0; place(halvings.map(|halvings| (1 << halvings) - 1)) + 1],
            },
        );
        if halvings != coarse.map(|halvings| halvings + 1) {
            return Some(Grid { halvings: [0; 2] });
        }
        // The quarters of a square stand together.
        for (quarters, leaf) in self.leaves.chunks_exact_mut(4).zip(old) {
            quarters.fill(leaf);
        }
        Some(Grid { halvings: coarse })
    }

    /// Enters a leaf.
    #[inline]
    pub(crate) fn enter(&mut self, leaf: u32, cell: GridCell) {
        let Grid { halvings } = self.grid();
        let [along_x, along_y] = [u32::from(cell.halvings[0]), u32::from(cell.halvings[1])];
        // A part of a square has it if it begins in its middle.
        let is_beside_x = along_x > halvings[0] && cell.from[0] << halvings[0] != 1 << 31;
        let is_beside_y = along_y > halvings[1] && cell.from[1] << halvings[1] != 1 << 31;
        if is_beside_x || is_beside_y {
            return;
        }
        let [columns, rows] = [
            halvings[0].saturating_sub(along_x),
            halvings[1].saturating_sub(along_y),
        ];
        let first = self.grid().square(cell.from) as usize;
        // As many columns as rows are one run, and so are twice as many.
        if columns == rows || columns == rows + 1 {
            self.leaves[first..first + (1 << (columns + rows))].fill(leaf);
        } else {
            self.enter_blocks(leaf, first, [columns, rows]);
        }
    }

    /// Enters a leaf of more than one run: 2 to the power of these numbers of columns and of rows.
    fn enter_blocks(&mut self, leaf: u32, first: usize, [columns, rows]: [u32; 2]) {
        let size = columns.min(rows);
        for row in 0..1 << (rows - size) {
            for column in 0..1 << (columns - size) {
                let start = first + (place([column, row]) << (2 * size));
                self.leaves[start..start + (1 << (2 * size))].fill(leaf);
            }
        }
    }

    /// The leaves beyond the middles of the left, right, upper and lower side of a leaf, as far as the map knows;
    /// the leaf itself where the screen ends.
    pub(crate) fn around(&self, leaf: u32, cell: GridCell) -> [u32; 4] {
        let (borders, squares) = self.grid().around(cell.from, cell.halvings.map(u32::from));
        let (left, top) = (borders[0] == 0, borders[2] == 0);
        let ends = [left, borders[1] == 0, top, borders[3] == 0];
        std::array::from_fn(|side| {
            if ends[side] {
                leaf
            } else {
                self.at(squares[side])
            }
        })
    }

    /// The leaf that has a square.
    #[inline]
    pub(crate) fn at(&self, square: u32) -> u32 {
        self.leaves[square as usize]
    }

    /// The squares.
    pub(crate) const fn grid(&self) -> Grid {
        Grid {
            halvings: self.halvings,
        }
    }
}

/// The squares of a map.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    halvings: [u32; 2],
}

impl Grid {
    /// Where the left, right, upper and lower side of a cell are, 0 where the screen ends there, and where the
    /// squares beyond their middles stand in the map.
    ///
    /// The cell is that of so many halvings, no more than 31 each, which holds a point.
    #[inline(always)]
    pub(crate) fn around(self, point: [u32; 2], halvings: [u32; 2]) -> ([u32; 4], [u32; 4]) {
        let x = self.along(0, point[0], halvings[0]);
        let y = self.along(1, point[1], halvings[1]);
        let squares = [
            x.before | y.middle,
            x.after | y.middle,
            x.middle | y.before,
            x.middle | y.after,
        ];
        ([x.from, x.end, y.from, y.end], squares)
    }

    #[inline(always)]
    fn along(self, axis: usize, point: u32, halvings: u32) -> Along {
        let half = (1_u32 << 31) >> halvings;
        let from = point & !(half << 1).wrapping_sub(1);
        let end = from.wrapping_add(half << 1);
        Along {
            from,
            end,
            before: self.part(axis, from.wrapping_sub(1)),
            middle: self.part(axis, from | half),
            after: self.part(axis, end),
        }
    }

    /// Whether a cell of so many halvings has a square of its own.
    pub(crate) fn shows(self, halvings: [u8; 2]) -> bool {
        let [along_x, along_y] = halvings.map(u32::from);
        along_x <= self.halvings[0] && along_y <= self.halvings[1]
    }

    /// Where the square that holds a point stands in the map.
    fn square(self, [x, y]: [u32; 2]) -> u32 {
        self.part(0, x) | self.part(1, y)
    }

    /// What a step along an axis adds to the place of a square.
    #[inline(always)]
    const fn part(self, axis: usize, step: u32) -> u32 {
        // Two shifts, since one by 32 has no meaning.
        spread(step >> 1 >> (31 - self.halvings[axis])) << axis
    }
}

/// A cell along one axis: its sides, and what adds to the places of squares before, in and after its middle.
#[derive(Clone, Copy, Debug)]
struct Along {
    from: u32,
    end: u32,
    before: u32,
    middle: u32,
    after: u32,
}

/// Where the square of a column and a row stands in Morton's order.
const fn place([x, y]: [u32; 2]) -> usize {
    (spread(x) | (spread(y) << 1)) as usize
}

/// A number of 16 bits with a 0 above each bit.
#[inline(always)]
const fn spread(number: u32) -> u32 {
    let mut bits = number;
    bits = (bits | (bits << 8)) & 0x00ff_00ff;
    bits = (bits | (bits << 4)) & 0x0f0f_0f0f;
    bits = (bits | (bits << 2)) & 0x3333_3333;
    (bits | (bits << 1)) & 0x5555_5555
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
    fn a_finer_grid_shows_the_same_and_has_an_end() {
        let mut map = three_leaves();
        let before = map.clone();
        assert!(map.resize(1).is_none());
        let kept = map.resize(4).unwrap();
        assert_eq!((before.halvings, map.halvings), ([1, 1], [2, 2]));
        assert_eq!(kept.halvings, before.halvings);
        for (place, &leaf) in map.leaves.iter().enumerate() {
            assert_eq!(leaf, before.leaves[place / 4]);
        }
        // A picture that is not a square.
        let mut map = LeafMap::new([16, 4]);
        assert_eq!(map.halvings, [2, 0]);
        map.enter(5, cell([0.0, 0.0], [0, 0]));
        assert_eq!(map.resize(3).unwrap().halvings, [2, 0]);
        let mut long = LeafMap::new([16_384, 1]);
        assert_eq!(long.resize(1_000_000).unwrap().halvings, [0, 0]);
        assert_eq!(long.halvings, [FINEST, 0]);
    }

    /// Halves of one square: the second covers the middle.
    #[test]
    fn of_leaves_that_share_a_square_the_map_knows_the_one_over_its_middle() {
        let mut map = LeafMap::new([1, 1]);
        assert_eq!(map.halvings, [1, 1]);
        assert!(map.grid().shows([1, 1]) && !map.grid().shows([2, 1]));
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
