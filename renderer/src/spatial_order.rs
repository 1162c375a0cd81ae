//! An order in which things that are near on the screen are near, so that what is kept of them is in the cache.
//!
//! The screen in tiles, row by row; a sort by counting, in which what shares a tile keeps its order.

use crate::sampler::GridPoint;

/// At most 2 to the power of this many tiles along a side: their counts are to stay in the nearest cache.
const MOST_HALVINGS: u32 = 6;

/// The places of points, in the order of the tiles in which the points lie.
pub(crate) fn spatial_order(points: impl ExactSizeIterator<Item = GridPoint>) -> Vec<u32> {
    let halvings = (points.len().max(2).ilog2() / 2).min(MOST_HALVINGS);
    let mut begins = vec![0_u32; 1 << (2 * halvings)];
    let tiles: Vec<u32> = points
        .map(|GridPoint(point)| {
            // Two shifts, since one by 32 has no meaning.
            let [column, row] = point.map(|step| step >> 1 >> (31 - halvings));
            let tile = (row << halvings) | column;
            begins[tile as usize] += 1;
            tile
        })
        .collect();
    let mut end = 0;
    for begin in &mut begins {
        (*begin, end) = (end, end + *begin);
    }
    let mut order = vec![0; tiles.len()];
    for (place, tile) in (0..).zip(tiles) {
        let begin = &mut begins[tile as usize];
        order[*begin as usize] = place;
        *begin += 1;
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By a stable sort of the tiles' rows and columns.
    #[test]
    fn it_is_the_order_of_a_stable_sort_by_tiles() {
        for (count, tiles) in [(0, 1), (1, 1), (3, 1), (4, 2), (70, 8), (20_000, 64)] {
            let points: Vec<GridPoint> = (0..count)
                .map(|number: u32| {
                    let x = number.wrapping_mul(0x9e37_79b9);
                    GridPoint([x, x.wrapping_mul(0x85eb_ca6b)])
                })
                .collect();
            let tile = |step: u32| (f64::from(step) / 4_294_967_296.0 * f64::from(tiles)).floor();
            let mut expected: Vec<u32> = (0..count).collect();
            expected.sort_by(|&one, &other| {
                let [one, other] = [one, other].map(|place| {
                    let GridPoint([x, y]) = points[place as usize];
                    [tile(y), tile(x)]
                });
                one.partial_cmp(&other).unwrap()
            });
            assert_eq!(spatial_order(points.into_iter()), expected);
        }
    }
}
