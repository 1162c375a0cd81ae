//! The ten digits as coarse shapes, for plates made of dots.

/// Each digit in 5 columns and 7 rows.
const SHAPES: [[&str; 7]; 10] = [
    [
        ".###.", "#...#", "#...#", "#...#", "#...#", "#...#", ".###.",
    ],
    [
        "..#..", ".##..", "..#..", "..#..", "..#..", "..#..", ".###.",
    ],
    [
        ".###.", "#...#", "....#", "..##.", ".#...", "#....", "#####",
    ],
    [
        "####.", "....#", "....#", ".###.", "....#", "....#", "####.",
    ],
    [
        "...#.", "..##.", ".#.#.", "#..#.", "#####", "...#.", "...#.",
    ],
    [
        "#####", "#....", "####.", "....#", "....#", "#...#", ".###.",
    ],
    [
        ".###.", "#....", "#....", "####.", "#...#", "#...#", ".###.",
    ],
    [
        "#####", "....#", "...#.", "...#.", "..#..", "..#..", "..#..",
    ],
    [
        ".###.", "#...#", "#...#", ".###.", "#...#", "#...#", ".###.",
    ],
    [
        ".###.", "#...#", "#...#", ".####", "....#", "....#", ".###.",
    ],
];

/// Whether a place lies in a digit that fills the unit square around the origin: x to the right, y down, -1/2 to 1/2.
pub(super) fn contains(digit: u8, x: f64, y: f64) -> bool {
    let Some(shape) = SHAPES.get(usize::from(digit)) else {
        return false;
    };
    // The unit square holds 7 rows; the 5 columns stand in its middle.
    let (column, row) = ((x * 7.0 + 2.5).floor(), (y * 7.0 + 3.5).floor());
    let is_there = |(index, line): (usize, &&str)| {
        let mut cells = line.bytes().enumerate();
        index as f64 == row && cells.any(|(cell, mark)| cell as f64 == column && mark == b'#')
    };
    shape.iter().enumerate().any(is_there)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_digit_is_where_it_is_drawn_and_no_two_are_alike() {
        assert!(contains(1, 0.0, 0.0) && !contains(0, 0.0, 0.0));
        assert!(contains(7, -0.3, -0.49) && !contains(7, -0.3, 0.49));
        assert!(!contains(8, 0.45, 0.0) && !contains(8, 0.0, 0.6));
        for one in 0..SHAPES.len() {
            for other in 0..one {
                let cells = |digit: usize| SHAPES[digit].concat().into_bytes();
                let pairs = cells(one).into_iter().zip(cells(other));
                let different = pairs.filter(|(left, right)| left != right).count();
                assert!(different >= 2, "{one} and {other}");
            }
        }
    }
}
