//! Which leaf lies where: a map of the screen on a grid of squares, kept while the tree grows.
//!
//! A square belongs to the leaf that covers its middle. The grid has at least four squares for each leaf, as
//! long as it has no more than [`MOST_ALONG_A_SIDE`]. Leaves that are smaller than a square share one, and the
//! map then knows one of them.
//!
//! Not here: what is made of the neighbours that are found; see [`leaves`](crate::leaves).

use crate::cell::{Axis, Rectangle};

/// Squares for each leaf before the grid is made finer.
const SQUARES_PER_LEAF: usize = 4;

/// The finest grid has no more squares along a side.
const MOST_ALONG_A_SIDE: usize = 8192;

/// A leaf beside another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Neighbour {
    pub(crate) leaf: u32,
    /// The axis along which one goes from one to the other.
    pub(crate) axis: Axis,
    /// Where on that axis the first leaf ends and this one begins.
    pub(crate) border: f64,
}

/// The leaf at every place of the screen.
#[derive(Clone, Debug)]
pub(crate) struct LeafMap {
    columns: usize,
    rows: usize,
    finest: [usize; 2],
    leaves: Vec<u32>,
}

impl LeafMap {
    /// The map of a screen that is one leaf, number 0.
    pub(crate) fn new(size_px: [u32; 2]) -> Self {
        let longest = size_px[0].max(size_px[1]).max(1);
        let finest = size_px.map(|size| {
            let part = f64::from(size.max(1)) / f64::from(longest);
            to_index(MOST_ALONG_A_SIDE as f64 * part)
                .next_power_of_two()
                .min(MOST_ALONG_A_SIDE)
        });
        let mut map = Self {
            columns: 0,
            rows: 0,
            finest,
            leaves: Vec::new(),
        };
        map.resize(1);
        map
    }

    /// Makes the grid as fine as this many leaves ask for; whether it changed, and is to be filled again.
    pub(crate) fn resize(&mut self, leaves: usize) -> bool {
        let [columns, rows] = self.finest;
        let is_enough = |coarser: &u32| {
            (columns >> coarser).max(1) * (rows >> coarser).max(1) >= SQUARES_PER_LEAF * leaves
        };
        let coarser = (0..usize::BITS).take_while(is_enough).last().unwrap_or(0);
        let size = [(columns >> coarser).max(1), (rows >> coarser).max(1)];
        let is_changed = size != [self.columns, self.rows];
        if is_changed {
            [self.columns, self.rows] = size;
            self.leaves = vec![0; self.columns * self.rows];
        }
        is_changed
    }

    /// Enters a leaf.
    pub(crate) fn enter(&mut self, leaf: u32, place: &Rectangle) {
        let [from, to] = middles(place.left, place.width, self.columns);
        let [first_row, end_row] = middles(place.top, place.height, self.rows);
        for row in first_row..end_row {
            let start = row * self.columns;
            self.leaves[start + from..start + to].fill(leaf);
        }
    }

    /// Whether a leaf at this place has a square of its own.
    pub(crate) fn shows(&self, place: &Rectangle) -> bool {
        place.width * self.columns as f64 >= 1.0 && place.height * self.rows as f64 >= 1.0
    }

    /// The leaf beyond the middle of each side of a place, as far as the screen goes and the map knows.
    pub(crate) fn around(&self, place: &Rectangle) -> [Option<Neighbour>; 4] {
        let Rectangle {
            left,
            top,
            width,
            height,
        } = *place;
        let (right, bottom) = (left + width, top + height);
        let column = square(left + 0.5 * width, self.columns);
        let row = square(top + 0.5 * height, self.rows);
        let found = |column: Option<usize>, row: Option<usize>, axis, border| {
            let (column, row) = (column?, row?);
            let is_on_screen = column < self.columns && row < self.rows;
            let leaf = is_on_screen.then(|| self.leaves[row * self.columns + column])?;
            Some(Neighbour { leaf, axis, border })
        };
        let (columns, rows) = (self.columns, self.rows);
        [
            found(square_before(left, columns), Some(row), Axis::X, left),
            found(Some(square(right, columns)), Some(row), Axis::X, right),
            found(Some(column), square_before(top, rows), Axis::Y, top),
            found(Some(column), Some(square(bottom, rows)), Axis::Y, bottom),
        ]
    }
}

/// The first square whose middle lies in an interval, and the first beyond.
fn middles(start: f64, length: f64, squares: usize) -> [usize; 2] {
    [start, start + length].map(|end| up_to_index(end * squares as f64 - 0.5))
}

/// The square that begins at a place or holds it.
fn square(place: f64, squares: usize) -> usize {
    to_index(place * squares as f64)
}

/// The square that ends at a place or holds it.
fn square_before(place: f64, squares: usize) -> Option<usize> {
    up_to_index(place * squares as f64).checked_sub(1)
}

/// The least whole number that is no less, without a call of `ceil`.
fn up_to_index(place: f64) -> usize {
    let below = to_index(place);
    below + usize::from((below as f64) < place)
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a place on the grid; what lies before its beginning saturates at 0"
)]
fn to_index(place: f64) -> usize {
    place as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(left: f64, top: f64, width: f64, height: f64) -> Rectangle {
        Rectangle {
            left,
            top,
            width,
            height,
        }
    }

    fn leaf(neighbour: Option<Neighbour>) -> Option<u32> {
        neighbour.map(|neighbour| neighbour.leaf)
    }

    /// Leaf 0 is the upper left quarter, 1 the lower left one, 2 the right half.
    fn three_leaves() -> LeafMap {
        let mut map = LeafMap::new([8, 8]);
        map.enter(2, &place(0.5, 0.0, 0.5, 1.0));
        map.enter(1, &place(0.0, 0.5, 0.5, 0.5));
        map
    }

    #[test]
    fn the_leaf_beyond_each_side_is_found_and_nothing_beyond_the_screen() {
        let map = three_leaves();
        let around = map.around(&place(0.0, 0.0, 0.5, 0.5));
        assert_eq!(around.map(leaf), [None, Some(2), None, Some(1)]);
        assert_eq!(
            around[1],
            Some(Neighbour {
                leaf: 2,
                axis: Axis::X,
                border: 0.5
            })
        );
        let around = map.around(&place(0.5, 0.0, 0.5, 1.0));
        // The middle of its left side is where 1 begins.
        assert_eq!(around.map(leaf), [Some(1), None, None, None]);
    }

    #[test]
    fn a_finer_grid_is_empty_until_it_is_filled_and_has_an_end() {
        let mut map = LeafMap::new([16, 4]);
        assert_eq!([map.columns, map.rows], [4, 1]);
        assert!(!map.resize(1));
        map.enter(5, &place(0.0, 0.0, 1.0, 1.0));
        assert!(map.resize(3) && map.leaves.iter().all(|&leaf| leaf == 0));
        assert_eq!([map.columns, map.rows], [8, 2]);
        let mut long = LeafMap::new([16_384, 1]);
        long.resize(1_000_000);
        assert_eq!([long.columns, long.rows], [MOST_ALONG_A_SIDE, 1]);
    }

    /// Halves of one square: the second covers the middle.
    #[test]
    fn of_leaves_that_share_a_square_the_map_knows_the_one_over_its_middle() {
        let mut map = LeafMap::new([1, 1]);
        assert_eq!([map.columns, map.rows], [2, 2]);
        assert!(map.shows(&place(0.0, 0.0, 0.5, 0.5)) && !map.shows(&place(0.0, 0.0, 0.25, 0.5)));
        map.enter(1, &place(0.0, 0.0, 0.25, 0.5));
        map.enter(2, &place(0.25, 0.0, 0.25, 0.5));
        let around = map.around(&place(0.0, 0.0, 0.25, 0.5));
        assert_eq!(leaf(around[1]), Some(2));
        let around = map.around(&place(0.5, 0.0, 0.5, 0.5));
        assert_eq!(leaf(around[0]), Some(2));
    }
}
