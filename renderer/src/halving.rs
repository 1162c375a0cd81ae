//! Sixteen leaves halved side by side, and where the samples of their new halves lie.
//!
//! The arithmetic is that of [`GridCell`] and of [`Cell`], lane by lane, and gives
//! the same bits on any processor: whole numbers, and sums and products of doubles that are rounded one by one.
//! It is plain code, compiled for the widest registers that are there.
#![expect(
    clippy::inline_always,
    reason = "code for a processor's own instructions is compiled for them only where it is inlined"
)]

use pulp::{Arch, NullaryFnOnce};

use crate::cell::{Axis, Cell, JITTER, half_to_the};
use crate::chacha;
use crate::grid_cell::GridCell;
use crate::sampler::GridPoint;

/// How many are halved at once.
pub(crate) const LANES: usize = 16;

/// One number of each.
pub(crate) type Lanes = [u32; LANES];

/// Sixteen leaves. Where there are two of something, that along x comes first.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Wholes {
    /// Where their samples lie.
    pub(crate) points: [Lanes; 2],
    /// No more than 30 each.
    pub(crate) halvings: [Lanes; 2],
    /// 1 if they are to be halved along x where the picture leaves the choice, else 0.
    pub(crate) prefers_x: Lanes,
}

/// Their halves in which no sample lies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct FreeHalves {
    /// 1 if the leaf was halved along y, else 0.
    pub(crate) is_along_y: Lanes,
    /// Which half it is, 0 or 1.
    pub(crate) half: Lanes,
    /// Its first step.
    pub(crate) from: [Lanes; 2],
    /// Its halvings, which are those of the other half too.
    pub(crate) halvings: [Lanes; 2],
    /// Where its sample is taken.
    pub(crate) points: [Lanes; 2],
}

impl FreeHalves {
    /// The axis along which one of the leaves was halved.
    pub(crate) fn axis(&self, lane: usize) -> Axis {
        [Axis::X, Axis::Y][self.is_along_y[lane] as usize]
    }

    /// One of them.
    pub(crate) fn cell(&self, lane: usize) -> GridCell {
        #[expect(clippy::cast_possible_truncation, reason = "no more than 31")]
        let halvings = [self.halvings[0][lane] as u8, self.halvings[1][lane] as u8];
        GridCell {
            from: [self.from[0][lane], self.from[1][lane]],
            halvings,
        }
    }

    /// Where the sample of one of them is taken.
    pub(crate) fn point(&self, lane: usize) -> GridPoint {
        GridPoint([self.points[0][lane], self.points[1][lane]])
    }
}

/// How leaves are halved on one picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Halving {
    arch: Arch,
    seed: u64,
    /// With at most so many halvings along x more than along y, a cell is longer along x.
    longer_along_x: i32,
    /// With at least so many, along y.
    longer_along_y: i32,
}

impl Halving {
    /// On a picture of this size; the seed is that of the samples.
    pub(crate) fn new(size_px: [u32; 2], seed: u64) -> Self {
        let cut = |more: i32, preferred| {
            let [along_x, along_y] = [more.max(0), (-more).max(0)].map(i32::cast_unsigned);
            Cell::first_of([along_x, along_y]).cut(size_px, preferred)
        };
        let most = MOST_HALVINGS;
        Self {
            arch: Arch::new(),
            seed,
            longer_along_x: (-most..=most)
                .rfind(|&more| cut(more, Axis::Y) == Axis::X)
                .unwrap_or(-most - 1),
            longer_along_y: (-most..=most)
                .find(|&more| cut(more, Axis::X) == Axis::Y)
                .unwrap_or(most + 1),
        }
    }

    /// Where the sample of the whole screen is taken.
    pub(crate) fn first_point(&self) -> GridPoint {
        let mut screen = FreeHalves::default();
        self.place(&mut screen);
        screen.point(0)
    }

    /// The halves of leaves in which their samples do not lie.
    pub(crate) fn halve(&self, wholes: &Wholes) -> FreeHalves {
        self.arch.dispatch(Halve(self, wholes))
    }

    /// Chooses the axis by which halvings a leaf has already, and the half by where its sample lies.
    #[inline(always)]
    fn choose(&self, wholes: &Wholes) -> FreeHalves {
        let mut free = FreeHalves::default();
        for lane in 0..LANES {
            let [x, y] = [wholes.points[0][lane], wholes.points[1][lane]];
            let [halved_x, halved_y] = [wholes.halvings[0][lane], wholes.halvings[1][lane]];
            let more = halved_x.cast_signed() - halved_y.cast_signed();
            let prefers_x = u32::from(more < self.longer_along_y) & wholes.prefers_x[lane];
            let is_along_x = u32::from(more <= self.longer_along_x) | prefers_x;
            let is_along_y = is_along_x ^ 1;
            // The bit that says in which half a point lies; 0 along the other axis.
            let bit_x = (is_along_x << 31) >> halved_x;
            let bit_y = (is_along_y << 31) >> halved_y;
            free.is_along_y[lane] = is_along_y;
            free.half[lane] = u32::from((x & bit_x) | (y & bit_y) == 0);
            free.from[0][lane] = (x & !(u32::MAX >> halved_x)) | (!x & bit_x);
            free.from[1][lane] = (y & !(u32::MAX >> halved_y)) | (!y & bit_y);
            free.halvings[0][lane] = halved_x + is_along_x;
            free.halvings[1][lane] = halved_y + is_along_y;
        }
        free
    }

    /// Finds where the samples are taken, each a function of the seed and its cell alone.
    ///
    /// Uniform within [`JITTER`] of the width and of the height around the middle: an edge that cuts off a
    /// part `p` of a cell is missed by `p (1 - p)` on average by a uniform point and by `min(p, 1 - p)²`, half
    /// of that, by the middle, which however errs in the same way in every cell along the edge.
    #[inline(always)]
    fn place(&self, free: &mut FreeHalves) {
        let mut numbers = [[0; LANES]; 2];
        for (along, numbers) in numbers.iter_mut().enumerate() {
            for (lane, number) in numbers.iter_mut().enumerate() {
                let halvings = free.halvings[along][lane];
                // Two shifts, since one by 32 has no meaning.
                let place = (free.from[along][lane] >> 1) >> (31 - halvings);
                *number = place | (1 << halvings);
            }
        }
        let [x, y] = numbers;
        let [x_low, x_high, y_low, y_high] = chacha::first_words(self.seed, [y, x]);
        for (along, [low, high]) in [[x_low, x_high], [y_low, y_high]].into_iter().enumerate() {
            for lane in 0..LANES {
                // The upper 53 bits of the number, as a part of one.
                let upper = f64::from(high[lane]) * TWO_TO_21 + f64::from(low[lane] >> 11);
                let length = half_to_the(free.halvings[along][lane]);
                let start = f64::from(free.from[along][lane]) * half_to_the(32);
                let middle = start + 0.5 * length;
                let anywhere = start + length * (upper * half_to_the(53));
                let inner = middle + JITTER * (anywhere - middle);
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "rounded down on purpose; a place is never negative and less than 1"
                )]
                let step = (inner * TWO_TO_32) as u32;
                free.points[along][lane] = step;
            }
        }
    }
}

/// Along one axis.
const MOST_HALVINGS: i32 = 31;
const TWO_TO_21: f64 = 2_097_152.0;
const TWO_TO_32: f64 = 4_294_967_296.0;

struct Halve<'a>(&'a Halving, &'a Wholes);

impl NullaryFnOnce for Halve<'_> {
    type Output = FreeHalves;

    #[inline(always)]
    fn call(self) -> FreeHalves {
        let Self(halving, wholes) = self;
        let mut free = halving.choose(wholes);
        halving.place(&mut free);
        free
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampler::ScreenPoint;

    const SIZES_PX: [[u32; 2]; 8] = [
        [320, 320],
        [1, 1],
        [640, 320],
        [639, 320],
        [641, 320],
        [640, 480],
        [16_384, 1],
        [1, 16_384],
    ];

    fn random(number: u64) -> [u32; 2] {
        let bits = number.wrapping_mul(0x9e37_79b9_7f4a_7c15).to_le_bytes();
        [0, 4].map(|at| u32::from_le_bytes(std::array::from_fn(|byte| bits[at + byte])))
    }

    /// Sixteen leaves that splitting leads to, and the cells that they are.
    fn leaves(size_px: [u32; 2], round: u64) -> (Wholes, [Cell; LANES]) {
        let mut wholes = Wholes::default();
        let cells = std::array::from_fn(|lane| {
            let number = round * LANES as u64 + lane as u64;
            let [mut choices, depth] = random(number + 77);
            let point = GridPoint(random(number));
            let mut cell = Cell::ROOT;
            for _ in 0..depth % 48 {
                let preferred = if choices & 1 == 0 { Axis::X } else { Axis::Y };
                choices = choices.rotate_right(1);
                let axis = cell.cut(size_px, preferred);
                cell = cell.halves(axis)[cell.half_of(point.into(), axis)];
            }
            wholes.prefers_x[lane] = choices & 1;
            for along in [0, 1] {
                wholes.points[along][lane] = point.0[along];
                wholes.halvings[along][lane] = cell.halvings()[along];
            }
            cell
        });
        (wholes, cells)
    }

    /// The old sample's half by the rectangles of the cells, the new sample by the plain random numbers.
    #[test]
    fn sixteen_are_halved_as_each_is_alone() {
        for size_px in SIZES_PX {
            let halving = Halving::new(size_px, 1992);
            for round in 0..100 {
                let (wholes, cells) = leaves(size_px, round);
                let free = halving.halve(&wholes);
                for (lane, cell) in cells.into_iter().enumerate() {
                    let preferred = [Axis::Y, Axis::X][wholes.prefers_x[lane] as usize];
                    let axis = cell.cut(size_px, preferred);
                    let point = GridPoint(wholes.points.map(|along| along[lane]));
                    let half = 1 - cell.half_of(point.into(), axis);
                    assert_eq!(free.is_along_y[lane], axis as u32);
                    assert_eq!(free.half[lane] as usize, half);
                    let free_half = cell.halves(axis)[half];
                    assert_eq!(free.halvings.map(|along| along[lane]), free_half.halvings());
                    let rectangle = free_half.rectangle();
                    let corner = ScreenPoint {
                        x: rectangle.left,
                        y: rectangle.top,
                    };
                    assert_eq!(GridPoint(free.from.map(|along| along[lane])), corner.into());
                    assert_eq!(free.point(lane), sample_point(free_half));
                }
            }
        }
    }

    /// Nearer to the middle than the random point.
    fn sample_point(cell: Cell) -> GridPoint {
        let (point, middle) = (cell.random_point(1992), cell.rectangle().middle());
        let inner = ScreenPoint {
            x: middle.x + 0.7 * (point.x - middle.x),
            y: middle.y + 0.7 * (point.y - middle.y),
        };
        inner.into()
    }

    #[test]
    fn the_first_sample_is_that_of_the_whole_screen() {
        let halving = Halving::new([320, 200], 1992);
        assert_eq!(halving.first_point(), sample_point(Cell::ROOT));
    }

    /// The same code, compiled for no more than the processor is sure to have.
    #[test]
    fn the_bits_do_not_depend_on_the_processor() {
        let halving = Halving::new([640, 480], 7);
        let plain = Halving {
            arch: Arch::Scalar,
            ..halving
        };
        for round in 0..200 {
            let (wholes, _) = leaves([640, 480], round);
            assert_eq!(halving.halve(&wholes), plain.halve(&wholes));
        }
    }
}
