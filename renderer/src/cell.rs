//! A cell of the screen tree: a rectangle of the screen that follows from a path of halvings alone.
//!
//! The root is the whole screen. A cell is halved along its longer side as it is on the picture, along x if
//! both are equal: on a square picture along x at even depths and along y at odd ones, on a longer picture
//! first as often along the long side as makes the cells about square. So cells of the same depth are equal,
//! and a depth is a size. The path is the number of the cell: 1 for the root, then `2p` for the half nearer
//! to 0 and `2p + 1` for the other, so that the random numbers of a cell can be a function of the cell and of
//! nothing else.
//!
//! Source: Painter & Sloan (1989), as described in section 3.1 of Meyer & Liu (1992).

use rand::Rng as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use crate::sampler::ScreenPoint;

/// A rectangle that halving the screen leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Cell {
    /// The path in the lower bits; above [`SHAPE_SHIFT`] how the screen begins to be halved.
    bits: u64,
}

/// Above the longest path, of 49 bits.
const SHAPE_SHIFT: u32 = 56;
const PATH: u64 = (1 << SHAPE_SHIFT) - 1;
/// The bit of the shape that says that y comes first.
const Y_FIRST: u64 = 16;

/// An axis of the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Axis {
    X,
    Y,
}

/// The part of the width and of the height of a new cell in which its sample may lie.
const JITTER: f64 = 0.7;

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
    /// The whole screen of a square picture.
    pub const ROOT: Self = Self { bits: 1 };

    /// No cell is halved at this depth: on a square picture its side is then 2⁻²⁴ of the screen.
    pub const DEEPEST: u32 = 48;

    /// The whole screen of a picture of this size, none of whose sides is 2¹⁵ times the other or longer.
    pub fn screen(size_px: [u32; 2]) -> Self {
        let [width, height] = size_px.map(u64::from);
        let is_y_first = height > width;
        let is_long = |halvings: u32| {
            if is_y_first {
                height > width << halvings
            } else {
                width >= height << halvings
            }
        };
        // The first halving is along the long side in any case.
        let more: u64 = (1..=15).take_while(|&halvings| is_long(halvings)).count() as u64;
        let shape = more | if is_y_first { Y_FIRST } else { 0 };
        Self {
            bits: (shape << SHAPE_SHIFT) | 1,
        }
    }

    const fn path(self) -> u64 {
        self.bits & PATH
    }

    /// The axis of the first halving, and how many halvings are along it before the other has its turn.
    const fn beginning(self) -> (Axis, u32) {
        let shape = self.bits >> SHAPE_SHIFT;
        let axis = if shape & Y_FIRST == 0 {
            Axis::X
        } else {
            Axis::Y
        };
        (axis, 1 + (shape % Y_FIRST) as u32)
    }

    /// How many halvings along the first axis and along the other lead here.
    fn halvings(self) -> [u32; 2] {
        let (_, beginning) = self.beginning();
        let depth = self.depth();
        let alternating = depth.saturating_sub(beginning);
        [
            depth.min(beginning) + alternating / 2,
            alternating.div_ceil(2),
        ]
    }

    /// How many halvings lead here: 0 for the whole screen.
    pub const fn depth(self) -> u32 {
        self.path().ilog2()
    }

    /// The fraction of the screen that the cell covers, 2^−depth.
    pub fn area(self) -> f64 {
        half_to_the(self.depth())
    }

    /// The two halves, the one nearer to 0 first.
    pub const fn halves(self) -> [Self; 2] {
        let shape = self.bits & !PATH;
        let path = self.path() << 1;
        [
            Self { bits: shape | path },
            Self {
                bits: shape | path | 1,
            },
        ]
    }

    /// The least depth at which no side of a cell is longer than this many pixels of the picture.
    pub fn depth_of_side(size_px: [u32; 2], longest_px: f64) -> u32 {
        let [width, height] = size_px.map(f64::from);
        let mut cell = Self::screen(size_px);
        let is_too_long = |cell: Self| {
            let rectangle = cell.rectangle();
            rectangle.width * width > longest_px || rectangle.height * height > longest_px
        };
        while cell.depth() < Self::DEEPEST && is_too_long(cell) {
            cell = cell.halves()[0];
        }
        cell.depth()
    }

    /// Where the cell lies; exact, since every edge is a dyadic fraction.
    pub fn rectangle(self) -> Rectangle {
        let (axis, beginning) = self.beginning();
        let depth = self.depth();
        let steps = self.path() ^ (1 << depth);
        let alternating = depth.saturating_sub(beginning);
        let begun = steps >> alternating;
        // The other axis has the first turn, and every second one from there.
        let steps = steps & ((1 << alternating) - 1);
        let [first_steps, other_steps] = if alternating.is_multiple_of(2) {
            [steps, steps >> 1]
        } else {
            [steps >> 1, steps]
        };
        let along_first = (begun << (alternating / 2)) | u64::from(even_bits(first_steps));
        let [first, other] = self.halvings();
        let first = (along_first as f64 * half_to_the(first), half_to_the(first));
        let other_length = half_to_the(other);
        let other = (
            f64::from(even_bits(other_steps)) * other_length,
            other_length,
        );
        let ((left, width), (top, height)) = match axis {
            Axis::X => (first, other),
            Axis::Y => (other, first),
        };
        Rectangle {
            left,
            top,
            width,
            height,
        }
    }

    /// The axis along which the cell is halved.
    fn axis(self) -> Axis {
        let (axis, beginning) = self.beginning();
        let depth = self.depth();
        let is_first_turn = depth < beginning || !(depth - beginning).is_multiple_of(2);
        match (axis, is_first_turn) {
            (Axis::X, true) | (Axis::Y, false) => Axis::X,
            (Axis::Y, true) | (Axis::X, false) => Axis::Y,
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
        let is_second = match self.axis() {
            Axis::X => point.x >= left + 0.5 * width,
            Axis::Y => point.y >= top + 0.5 * height,
        };
        usize::from(is_second)
    }

    /// Where the sample of a new cell is taken, a function of the seed and the cell alone.
    ///
    /// Uniform within [`JITTER`] of the width and of the height around the middle: an edge that cuts off a
    /// part `p` of a cell is missed by `p (1 - p)` on average by a uniform point and by `min(p, 1 - p)²`, half
    /// of that, by the middle, which however errs in the same way in every cell along the edge.
    pub(crate) fn sample_point(self, seed: u64) -> ScreenPoint {
        let ScreenPoint { x, y } = self.random_point(seed);
        let middle = self.rectangle().middle();
        ScreenPoint {
            x: middle.x + JITTER * (x - middle.x),
            y: middle.y + JITTER * (y - middle.y),
        }
    }

    /// The uniform random point of this cell, a function of the seed and the cell alone.
    ///
    /// Two 53-bit fractions from the `ChaCha8` stream whose key is the seed and whose number is the path.
    pub fn random_point(self, seed: u64) -> ScreenPoint {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        let mut random = ChaCha8Rng::from_seed(key);
        random.set_stream(self.path());
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

    fn middle(&self) -> ScreenPoint {
        ScreenPoint {
            x: self.left + 0.5 * self.width,
            y: self.top + 0.5 * self.height,
        }
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

    /// The plain way: halve the longer side of the rectangle step by step along the path.
    fn rectangle_by_halving(path: u64, size_px: [u32; 2]) -> Rectangle {
        let mut rectangle = Rectangle {
            left: 0.0,
            top: 0.0,
            width: 1.0,
            height: 1.0,
        };
        let [width_px, height_px] = size_px.map(f64::from);
        let depth = path.ilog2();
        for step in 0..depth {
            let is_second = (path >> (depth - 1 - step)) & 1 == 1;
            let is_along_x = rectangle.width * width_px >= rectangle.height * height_px;
            let (start, length) = if is_along_x {
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

    const SIZES_PX: [[u32; 2]; 9] = [
        [320, 320],
        [1, 1],
        [640, 320],
        [639, 320],
        [641, 320],
        [320, 640],
        [100, 1281],
        [16_384, 1],
        [1, 16_384],
    ];

    #[test]
    fn a_rectangle_is_what_halving_the_longer_side_step_by_step_gives() {
        let far = [(1 << 47) | 0x1234_5678_9abc, (1 << 48) | 0x0fed_cba9_8765];
        for size_px in SIZES_PX {
            for path in (1..5000).chain(far) {
                let cell = Cell {
                    bits: Cell::screen(size_px).bits ^ 1 ^ path,
                };
                assert_eq!(cell.rectangle(), rectangle_by_halving(path, size_px));
                assert_eq!(cell.rectangle().area(), cell.area());
            }
        }
    }

    #[test]
    fn the_screen_of_a_square_picture_is_the_root() {
        assert_eq!(Cell::screen([320, 320]), Cell::ROOT);
    }

    #[test]
    fn the_depth_of_a_side_is_the_first_at_which_both_sides_are_no_longer() {
        for size_px in SIZES_PX {
            for longest_px in [0.3, 1.0, 2.39, 7.0, 5000.0] {
                let depth = Cell::depth_of_side(size_px, longest_px);
                let is_fine = |depth: u32| {
                    let rectangle = rectangle_by_halving(1 << depth, size_px);
                    rectangle.width * f64::from(size_px[0]) <= longest_px
                        && rectangle.height * f64::from(size_px[1]) <= longest_px
                };
                assert!(is_fine(depth));
                assert!(depth == 0 || !is_fine(depth - 1));
            }
        }
    }

    #[test]
    fn a_random_point_lies_in_its_cell_and_in_the_half_that_is_named() {
        for path in 1..2000 {
            let size_px = SIZES_PX[(path % 9) as usize];
            let cell = Cell {
                bits: Cell::screen(size_px).bits ^ 1 ^ path,
            };
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
