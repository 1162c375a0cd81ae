//! A cell of the screen tree: a rectangle of the screen that follows from halvings alone.
//!
//! The root is the whole screen. A cell may be halved along x or along y; [`Cell::cut`] says which of the two
//! keeps it about as wide as high on the picture. Its number along an axis is 1 for the whole screen, then `2n`
//! for the half nearer to 0 and `2n + 1` for the other; the two numbers are the cell, however the halvings
//! along x and y followed each other, so that its random numbers can be a function of the cell and of nothing
//! else.
//!
//! Source: Painter & Sloan (1989), as described in section 3.1 of Meyer & Liu (1992).

use rand::Rng as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use crate::sampler::{GridPoint, ScreenPoint};

/// A rectangle that halving the screen leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Cell {
    x: u32,
    y: u32,
}

/// An axis of the screen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Axis {
    /// From left to right.
    #[default]
    X,
    /// From top to bottom.
    Y,
}

/// The part of the width and of the height of a new cell in which its sample may lie.
pub(crate) const JITTER: f64 = 0.7;

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
    pub const ROOT: Self = Self { x: 1, y: 1 };

    /// No cell is halved at this depth: on a square picture its side is then 2⁻²⁴ of the screen, and on a picture
    /// one of whose sides is 2¹⁴ times the other no less than 2⁻³¹.
    pub const DEEPEST: u32 = 48;

    /// The cell of so many halvings along x and along y that holds a point.
    pub(crate) fn holding(GridPoint([x, y]): GridPoint, halvings: [u8; 2]) -> Self {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "a number of at most 31 halvings has at most 32 bits"
        )]
        let number = |step, halvings| (((1 << 32) | u64::from(step)) >> (32 - halvings)) as u32;
        Self {
            x: number(x, halvings[0]),
            y: number(y, halvings[1]),
        }
    }

    /// The first cell of so many halvings along x and along y, no more than 31 each.
    pub(crate) const fn first_of([along_x, along_y]: [u32; 2]) -> Self {
        Self {
            x: 1 << along_x,
            y: 1 << along_y,
        }
    }

    /// How many halvings lead here: 0 for the whole screen.
    pub const fn depth(self) -> u32 {
        self.x.ilog2() + self.y.ilog2()
    }

    /// How many halvings lead here along x and along y.
    #[cfg(test)]
    pub(crate) const fn halvings(self) -> [u32; 2] {
        [self.x.ilog2(), self.y.ilog2()]
    }

    /// The fraction of the screen that the cell covers, 2^−depth.
    pub fn area(self) -> f64 {
        half_to_the(self.depth())
    }

    /// Which of all cells with this many halvings along x and y it lies in, row by row.
    ///
    /// It must have at least as many itself.
    pub(crate) fn place_among(self, [along_x, along_y]: [u32; 2]) -> usize {
        let ancestor = |number: u32, halvings: u32| {
            let ancestor = number >> (number.ilog2() - halvings);
            (ancestor ^ (1 << halvings)) as usize
        };
        (ancestor(self.y, along_y) << along_x) | ancestor(self.x, along_x)
    }

    /// The two halves along an axis, the one nearer to 0 first.
    pub const fn halves(self, axis: Axis) -> [Self; 2] {
        let Self { x, y } = self;
        match axis {
            Axis::X => [Self { x: 2 * x, y }, Self { x: 2 * x + 1, y }],
            Axis::Y => [Self { x, y: 2 * y }, Self { x, y: 2 * y + 1 }],
        }
    }

    /// The axis along which the cell is halved on a picture of this size: that of its longer side, or the one
    /// that is preferred where the cell is a square or nearly so.
    ///
    /// So no cell is more than 2.2 times as long as wide, but the first on a long picture; and of two halvings
    /// of a square one is along x and one along y.
    pub fn cut(self, size_px: [u32; 2], preferred: Axis) -> Axis {
        let [width, height] = size_px.map(f64::from);
        let sides = [
            width * half_to_the(self.x.ilog2()),
            height * half_to_the(self.y.ilog2()),
        ];
        longer(sides).unwrap_or(preferred)
    }

    /// The least depth at which no side of a cell is longer than this many pixels of the picture, whatever axes
    /// were preferred.
    pub fn depth_of_side(size_px: [u32; 2], longest_px: f64) -> u32 {
        let [along_x, along_y] = Self::halvings_to_side(size_px, longest_px);
        (along_x + along_y).min(Self::DEEPEST)
    }

    /// The halvings along x and along y that every cell of that depth has.
    pub(crate) fn halvings_to_side(size_px: [u32; 2], longest_px: f64) -> [u32; 2] {
        let [mut width, mut height] = size_px.map(f64::from);
        let [mut along_x, mut along_y] = [0, 0];
        while along_x + along_y < Self::DEEPEST && width.max(height) > longest_px {
            let cut = longer([width, height]);
            if cut != Some(Axis::Y) {
                width *= 0.5;
                along_x += 1;
            }
            // Where either may come first, the longer side may come second.
            if cut != Some(Axis::X) {
                height *= 0.5;
                along_y += 1;
            }
        }
        [along_x, along_y]
    }

    /// Where the cell lies; exact, since every edge is a dyadic fraction.
    pub fn rectangle(self) -> Rectangle {
        let [(left, width), (top, height)] = [self.x, self.y].map(|number| {
            let halvings = number.ilog2();
            let length = half_to_the(halvings);
            (f64::from(number ^ (1 << halvings)) * length, length)
        });
        Rectangle {
            left,
            top,
            width,
            height,
        }
    }

    /// Which of the two halves along an axis holds `point`, which lies in the cell: 0 or 1.
    pub fn half_of(self, point: ScreenPoint, axis: Axis) -> usize {
        let middle = self.rectangle().middle();
        let is_second = match axis {
            Axis::X => point.x >= middle.x,
            Axis::Y => point.y >= middle.y,
        };
        usize::from(is_second)
    }

    /// The uniform random point of this cell, a function of the seed and the cell alone.
    ///
    /// Two 53-bit fractions from the `ChaCha8` stream whose key is the seed and whose number is the cell.
    pub fn random_point(self, seed: u64) -> ScreenPoint {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        let mut random = ChaCha8Rng::from_seed(key);
        random.set_stream(self.stream());
        self.rectangle()
            .point([random.next_u64(), random.next_u64()])
    }

    /// The number of the stream of this cell's random numbers.
    fn stream(self) -> u64 {
        (u64::from(self.x) << 32) | u64::from(self.y)
    }
}

impl Rectangle {
    /// Its share of the screen.
    pub fn area(&self) -> f64 {
        self.width * self.height
    }

    /// The point at two fractions of the width and the height, the upper 53 bits of two numbers.
    fn point(&self, numbers: [u64; 2]) -> ScreenPoint {
        let [x, y] = numbers.map(|number| (number >> 11) as f64 * half_to_the(53));
        ScreenPoint {
            x: self.left + self.width * x,
            y: self.top + self.height * y,
        }
    }

    pub(crate) fn middle(&self) -> ScreenPoint {
        ScreenPoint {
            x: self.left + 0.5 * self.width,
            y: self.top + 0.5 * self.height,
        }
    }
}

/// Half to the power of a number, which is no more than 1022.
#[inline]
pub(crate) const fn half_to_the(exponent: u32) -> f64 {
    f64::from_bits((1023 - exponent as u64) << 52)
}

/// The axis of the longer side of a rectangle, unless it is a square within a tenth.
fn longer([width, height]: [f64; 2]) -> Option<Axis> {
    if width > 1.1 * height {
        Some(Axis::X)
    } else if height > 1.1 * width {
        Some(Axis::Y)
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZES_PX: [[u32; 2]; 11] = [
        [320, 320],
        [1, 1],
        [330, 320],
        [640, 320],
        [639, 320],
        [641, 320],
        [640, 480],
        [320, 640],
        [100, 1281],
        [16_384, 1],
        [1, 16_384],
    ];

    /// A cell after some halvings, each by the bits of a number: the axis that is preferred, and the half.
    fn descend(size_px: [u32; 2], depth: u32, mut choices: u64) -> (Cell, Rectangle) {
        let mut cell = Cell::ROOT;
        let mut rectangle = cell.rectangle();
        for _ in 0..depth {
            let preferred = if choices & 1 == 0 { Axis::X } else { Axis::Y };
            let half = usize::from(choices & 2 != 0);
            choices = choices.rotate_right(2);
            let axis = cell.cut(size_px, preferred);
            cell = cell.halves(axis)[half];
            // The plain way.
            let (start, length) = match axis {
                Axis::X => (&mut rectangle.left, &mut rectangle.width),
                Axis::Y => (&mut rectangle.top, &mut rectangle.height),
            };
            *length *= 0.5;
            *start += half as f64 * *length;
        }
        (cell, rectangle)
    }

    fn choices(number: u64) -> u64 {
        number.wrapping_mul(0x9e37_79b9_7f4a_7c15)
    }

    #[test]
    fn a_rectangle_is_what_halving_step_by_step_gives() {
        for size_px in SIZES_PX {
            for number in 0..500 {
                let depth = (number % 49) as u32;
                let (cell, rectangle) = descend(size_px, depth, choices(number));
                assert_eq!(cell.depth(), depth);
                assert_eq!(cell.rectangle(), rectangle);
                assert_eq!(cell.rectangle().area(), cell.area());
            }
        }
    }

    #[test]
    fn a_cell_is_about_as_wide_as_high_on_the_picture() {
        for size_px in SIZES_PX {
            for number in 0..200 {
                let (_, rectangle) = descend(size_px, 30, choices(number));
                let width = rectangle.width * f64::from(size_px[0]);
                let height = rectangle.height * f64::from(size_px[1]);
                assert!((0.45..2.21).contains(&(width / height)), "{size_px:?}");
            }
        }
    }

    #[test]
    fn the_depth_of_a_side_is_the_first_at_which_no_side_is_longer() {
        let longest_side_px = |size_px: [u32; 2], depth| {
            let of_cell = |number| {
                let (_, rectangle) = descend(size_px, depth, choices(number));
                let width = rectangle.width * f64::from(size_px[0]);
                width.max(rectangle.height * f64::from(size_px[1]))
            };
            (0..200).map(of_cell).fold(0.0, f64::max)
        };
        for size_px in SIZES_PX {
            for longest_px in [0.3, 1.0, 2.39, 7.0, 5000.0] {
                let depth = Cell::depth_of_side(size_px, longest_px);
                assert!(longest_side_px(size_px, depth) <= longest_px, "{size_px:?}");
                assert!(
                    depth == 0 || longest_side_px(size_px, depth - 1) > longest_px,
                    "{size_px:?}, {longest_px}"
                );
            }
        }
    }

    #[test]
    fn a_random_point_lies_in_its_cell_and_in_the_half_that_is_named() {
        for number in 0..2000 {
            let (cell, _) = descend([640, 480], (number % 48) as u32, choices(number));
            let point = cell.random_point(7);
            for axis in [Axis::X, Axis::Y] {
                let half = cell.halves(axis)[cell.half_of(point, axis)].rectangle();
                assert!((half.left..half.left + half.width).contains(&point.x));
                assert!((half.top..half.top + half.height).contains(&point.y));
            }
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
