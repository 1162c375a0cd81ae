//! Balanced Latin squares: each item in each place, and after each other item, equally often.
//!
//! Source: Williams (1949), *Aust. J. Sci. Res. A* 2, 149-168. The first row runs 0, 1, n-1, 2, n-2, ...; the
//! others add a constant modulo n. For an odd n one square is not enough: the rows read backwards follow,
//! which makes 2n rows.

/// How many rows the square of `n` items has.
pub(crate) fn row_count(n: usize) -> usize {
    if n.is_multiple_of(2) { n } else { 2 * n }
}

/// The row with this index, counted modulo the number of rows.
pub(crate) fn row(n: usize, index: usize) -> Vec<usize> {
    if n == 0 {
        return Vec::new();
    }
    let index = index % row_count(n);
    let first = |place: usize| match place {
        0 => 0,
        odd if !odd.is_multiple_of(2) => odd.div_ceil(2),
        even => n - even / 2,
    };
    let mut row: Vec<usize> = (0..n).map(|place| (first(place) + index) % n).collect();
    if index >= n {
        row.reverse();
    }
    row
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    #[test]
    fn over_all_rows_each_item_stands_in_each_place_and_after_each_other_equally_often() {
        for n in [1_usize, 2, 3, 4, 5, 13, 14, 27] {
            let rows: Vec<_> = (0..row_count(n)).map(|index| row(n, index)).collect();
            let mut places = BTreeMap::new();
            let mut successors = BTreeMap::new();
            for row in &rows {
                for (place, &item) in row.iter().enumerate() {
                    *places.entry((place, item)).or_insert(0_usize) += 1;
                }
                for pair in row.windows(2) {
                    *successors.entry((pair[0], pair[1])).or_insert(0_usize) += 1;
                }
            }
            let each = row_count(n) / n;
            assert!(places.len() == n * n && places.values().all(|&count| count == each));
            assert_eq!(successors.len(), n * (n - 1));
            assert!(successors.values().all(|&count| count == each));
        }
    }
}
