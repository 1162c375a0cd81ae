//! A cell of the screen tree: a rectangle of the screen that follows from a path of halvings alone.
//!
//! The root is the whole screen. A cell at an even depth is halved along x, at an odd depth along y. The
//! path is the number of the cell: 1 for the root, then `2p` for the half nearer to 0 and `2p + 1` for the
//! other, so that the random numbers of a cell can be a function of the cell and of nothing else.
//!
//! Source: Painter & Sloan (1989), as described in section 3.1 of Meyer & Liu (1992).

use rand::Rng as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use crate::sampler::ScreenPoint;

/// A rectangle that halving the screen leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Cell {
    path: u64,
}

/// An axis-aligned rectangle of the screen, in screen coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    /// The left edge.
    pub left: f64,
    /// The top edge.
    pub top: f64,
    /// From left to right.
    pub width: f64,
    /// From top to bottom.
    pub height: f64,
}

impl Cell {
    /// The whole screen.
    pub const ROOT: Self = Self { path: 1 };

    /// No cell is halved at this depth: its side is then 2⁻²⁴ of the screen.
    pub const DEEPEST: u32 = 48;

    /// How many halvings lead here: 0 for the whole screen.
    pub const fn depth(self) -> u32 {
        self.path.ilog2()
    }

    /// The fraction of the screen that the cell covers, 2^−depth.
    pub fn area(self) -> f64 {
        half_to_the(self.depth())
    }

    /// The two halves, the one nearer to 0 first.
    pub const fn halves(self) -> [Self; 2] {
        let path = self.path << 1;
        [Self { path }, Self { path: path | 1 }]
    }

    /// Where the cell lies; exact, since every edge is a dyadic fraction.
    pub fn rectangle(self) -> Rectangle {
        let depth = self.depth();
        let halvings = self.path ^ (1 << depth);
        let (along_x, along_y) = if depth.is_multiple_of(2) {
            (even_bits(halvings >> 1), even_bits(halvings))
        } else {
            (even_bits(halvings), even_bits(halvings >> 1))
        };
        let width = half_to_the(depth.div_ceil(2));
        let height = half_to_the(depth / 2);
        Rectangle {
            left: f64::from(along_x) * width,
            top: f64::from(along_y) * height,
            width,
            height,
        }
    }

    /// Which of the two halves holds `point`, which lies in the cell: 0 or 1.
    pub fn half_of(self, point: ScreenPoint) -> usize {
        let Rectangle {
            left,
            top,
            width,
            height,
        } = self.rectangle();
        let is_second = if self.depth().is_multiple_of(2) {
            point.x >= left + 0.5 * width
        } else {
            point.y >= top + 0.5 * height
        };
        usize::from(is_second)
    }

    /// The uniform random point of this cell, a function of the seed and the cell alone.
    ///
    /// Two 53-bit fractions from the `ChaCha8` stream whose key is the seed and whose number is the path.
    pub fn random_point(self, seed: u64) -> ScreenPoint {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        let mut random = ChaCha8Rng::from_seed(key);
        random.set_stream(self.path);
        let mut fraction = || (random.next_u64() >> 11) as f64 * half_to_the(53);
        let rectangle = self.rectangle();
        ScreenPoint {
            x: rectangle.left + rectangle.width * fraction(),
            y: rectangle.top + rectangle.height * fraction(),
        }
    }
}

impl Rectangle {
    /// Its share of the screen.
    pub fn area(&self) -> f64 {
        self.width * self.height
    }
}

fn half_to_the(exponent: u32) -> f64 {
    f64::from_bits((1023 - u64::from(exponent)) << 52)
}

/// The bits at the even places of the lower 48, pushed together.
fn even_bits(bits: u64) -> u32 {
    let mut bits = bits & 0x5555_5555_5555_5555;
    for (shift, mask) in [
        (1, 0x3333_3333_3333_3333),
        (2, 0x0f0f_0f0f_0f0f_0f0f),
        (4, 0x00ff_00ff_00ff_00ff),
        (8, 0x0000_ffff_0000_ffff),
        (16, 0x0000_0000_ffff_ffff),
    ] {
        bits = (bits | (bits >> shift)) & mask;
    }
    u32::try_from(bits).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The plain way: halve the rectangle step by step along the path.
    fn rectangle_by_halving(cell: Cell) -> Rectangle {
        let mut rectangle = Rectangle {
            left: 0.0,
            top: 0.0,
            width: 1.0,
            height: 1.0,
        };
        for step in 0..cell.depth() {
            let is_second = (cell.path >> (cell.depth() - 1 - step)) & 1 == 1;
            let (start, length) = if step % 2 == 0 {
                (&mut rectangle.left, &mut rectangle.width)
            } else {
                (&mut rectangle.top, &mut rectangle.height)
            };
            *length *= 0.5;
            if is_second {
                *start += *length;
            }
        }
        rectangle
    }

    #[test]
    fn a_rectangle_is_what_halving_step_by_step_gives() {
        let paths = (1..5000).chain([(1 << 47) | 0x1234_5678_9abc, (1 << 48) | 0x0fed_cba9_8765]);
        for path in paths {
            let cell = Cell { path };
            assert_eq!(cell.rectangle(), rectangle_by_halving(cell));
            assert_eq!(cell.rectangle().area(), cell.area());
        }
    }

    #[test]
    fn a_random_point_lies_in_its_cell_and_in_the_half_that_is_named() {
        for path in 1..2000 {
            let cell = Cell { path };
            let point = cell.random_point(7);
            let half = cell.halves()[cell.half_of(point)].rectangle();
            assert!((half.left..half.left + half.width).contains(&point.x));
            assert!((half.top..half.top + half.height).contains(&point.y));
        }
    }

    /// Their mean is the middle of the screen, as it is for uniform points.
    #[test]
    fn random_points_are_uniform_and_change_with_the_seed() {
        let n = 20_000;
        let points = (0..n).map(|seed| Cell::ROOT.random_point(seed));
        let (sum_x, sum_y) = points.fold((0.0, 0.0), |(x, y), point| (x + point.x, y + point.y));
        // The standard error of the mean of n uniform numbers is 1/√(12 n) = .002; five of it.
        let tolerance = 5.0 / (12.0 * n as f64).sqrt();
        assert!((sum_x / n as f64 - 0.5).abs() < tolerance);
        assert!((sum_y / n as f64 - 0.5).abs() < tolerance);
    }
}
