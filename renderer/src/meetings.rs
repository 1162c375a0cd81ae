//! What halves and their neighbours lead to expect in each other, many side by side.
//!
//! The arithmetic is that of [`expected`](crate::expected), lane by lane: plain code, compiled for the widest
//! registers that are there, so that the bits are the same on any processor.
//!
//! A leaf beyond which the screen ends meets itself, without a difference.
//!
//! Not here: where the neighbours are ([`leaf_map`](crate::leaf_map)), and what is made of what was found
//! ([`leaves`](crate::leaves)).
#![expect(
    clippy::inline_always,
    reason = "code for a processor's own instructions is compiled for them only where it is inlined"
)]

use arrayvec::ArrayVec;

use crate::cell::Axis;
use crate::expected::{Expected, expected_variances, halved_square, share};
use crate::leaf_map::Grid;

/// So many halves look around at once.
pub(crate) const AT_ONCE: usize = 64;

/// One thing of each half.
pub(crate) type Each<T> = [T; AT_ONCE];

/// The axes on which the neighbours beyond the left, right, upper and lower side lie.
pub(crate) const SIDES: [Axis; 4] = [Axis::X, Axis::X, Axis::Y, Axis::Y];

/// Halves that look around, and what they meet beyond their four sides.
#[derive(Clone, Debug)]
pub(crate) struct Meetings {
    pub(crate) own: Each<u32>,
    /// Where their samples lie along x and along y.
    pub(crate) points: [Each<u32>; 2],
    pub(crate) shown: Each<f32>,
    /// Along x and along y.
    pub(crate) halvings: [Each<u32>; 2],
    /// Where their sides are.
    pub(crate) borders: [Each<u32>; 4],
    /// The squares of the map beyond their sides.
    pub(crate) squares: [Each<u32>; 4],
    pub(crate) others: [Each<u32>; 4],
    /// Where the samples of the others lie along the axis on which they are met.
    pub(crate) their_points: [Each<u32>; 4],
    pub(crate) their_shown: [Each<f32>; 4],
    /// What is expected in the others already.
    pub(crate) their_expected: [Each<Expected>; 4],
    /// The variance of both samples.
    pub(crate) variances: [Each<f32>; 4],
    here: Each<Expected>,
    there: [Each<Expected>; 4],
}

/// What some halves found.
#[derive(Clone, Debug, Default)]
pub(crate) struct Found {
    /// What is to be expected in each half.
    pub(crate) here: ArrayVec<(u32, Expected), AT_ONCE>,
    /// Leaves around them in which more is to be expected than before.
    pub(crate) there: Vec<(u32, Expected)>,
}

impl Default for Meetings {
    fn default() -> Self {
        Self {
            own: [0; AT_ONCE],
            points: [[0; AT_ONCE]; 2],
            shown: [0.0; AT_ONCE],
            halvings: [[0; AT_ONCE]; 2],
            borders: [[0; AT_ONCE]; 4],
            squares: [[0; AT_ONCE]; 4],
            others: [[0; AT_ONCE]; 4],
            their_points: [[0; AT_ONCE]; 4],
            their_shown: [[0.0; AT_ONCE]; 4],
            their_expected: [[Expected::NOTHING; AT_ONCE]; 4],
            variances: [[0.0; AT_ONCE]; 4],
            here: [Expected::NOTHING; AT_ONCE],
            there: [[Expected::NOTHING; AT_ONCE]; 4],
        }
    }
}

impl Meetings {
    /// Finds the sides of the halves and the squares beyond them.
    #[inline(always)]
    pub(crate) fn find_squares(&mut self, grid: Grid) {
        for lane in 0..AT_ONCE {
            let point = [self.points[0][lane], self.points[1][lane]];
            let halvings = [self.halvings[0][lane], self.halvings[1][lane]];
            let (borders, squares) = grid.around(point, halvings);
            for side in 0..4 {
                self.borders[side][lane] = borders[side];
                self.squares[side][lane] = squares[side];
            }
        }
    }

    /// The variances by A alone.
    #[inline(always)]
    pub(crate) fn compare(&mut self) {
        for side in 0..4 {
            for lane in 0..AT_ONCE {
                let difference = self.shown[lane] - self.their_shown[side][lane];
                self.variances[side][lane] = halved_square(difference);
            }
        }
    }

    /// What the halves and those around them lead to expect in each other.
    #[inline(always)]
    pub(crate) fn meet(&mut self) {
        self.here = [Expected::NOTHING; AT_ONCE];
        for (side, axis) in SIDES.into_iter().enumerate() {
            for lane in 0..AT_ONCE {
                let places = [
                    self.points[axis as usize][lane],
                    self.their_points[side][lane],
                ];
                let share = share(self.borders[side][lane], places);
                let [here, there] = expected_variances(self.variances[side][lane], share);
                self.here[lane] = self.here[lane].max(Expected::new(here, axis));
                self.there[side][lane] = Expected::new(there, axis);
            }
        }
    }

    /// What the first `count` of them found.
    #[inline(always)]
    pub(crate) fn report(&self, count: usize, found: &mut Found) {
        found.here.clear();
        found
            .here
            .extend(self.own.into_iter().zip(self.here).take(count));
        found.there.resize(4 * AT_ONCE, (0, Expected::NOTHING));
        let mut raised = 0;
        for side in 0..4 {
            for lane in 0..count {
                // Each is written; the next one takes the place of one that raises nothing.
                let there = self.there[side][lane];
                found.there[raised] = (self.others[side][lane], there);
                raised += usize::from(there > self.their_expected[side][lane]);
            }
        }
        found.there.truncate(raised);
    }
}

#[cfg(test)]
mod tests {
    use pulp::{Arch, NullaryFnOnce};

    use super::*;
    use crate::grid_cell::GridCell;
    use crate::leaf_map::LeafMap;
    use crate::sampler::GridPoint;

    struct Meet<'a>(&'a mut Meetings, Grid);

    impl NullaryFnOnce for Meet<'_> {
        type Output = ();

        #[inline(always)]
        fn call(self) {
            let Self(meetings, grid) = self;
            meetings.find_squares(grid);
            meetings.compare();
            meetings.meet();
        }
    }

    fn random(number: u32) -> u32 {
        let mixed = (number ^ (number >> 16)).wrapping_mul(0x7feb_352d);
        (mixed ^ (mixed >> 15)).wrapping_mul(0x846c_a68b)
    }

    fn number(place: usize) -> u32 {
        u32::try_from(place).unwrap()
    }

    /// Halves and others at random places; some were not shaded.
    fn meetings(seed: u32) -> Meetings {
        let mut meetings = Meetings::default();
        let value = |number: u32| match random(number) {
            bits if bits % 16 == 0 => f32::NAN,
            bits => (bits >> 8) as f32 / 16_777_216.0,
        };
        for lane in 0..AT_ONCE {
            let first = 1000 * (seed * number(AT_ONCE) + number(lane));
            meetings.own[lane] = number(lane);
            meetings.shown[lane] = value(first);
            for along in [0, 1] {
                meetings.points[along][lane] = random(first + 10 + number(along));
                meetings.halvings[along][lane] = random(first + 20 + number(along)) % 32;
            }
            for side in 0..4 {
                meetings.others[side][lane] = 100 + number(lane);
                meetings.their_shown[side][lane] = value(first + 30 + number(side));
                meetings.their_points[side][lane] = random(first + 40 + number(side));
            }
        }
        meetings
    }

    /// With distances in whole numbers of 64 bits, as in the definition.
    fn plain(variance: f32, border: u32, [own, other]: [u32; 2]) -> [f32; 2] {
        let way = |to: u32| (i64::from(to) - i64::from(own)) as f32;
        let share = way(border) / way(other);
        let share = if (0.0..=1.0).contains(&share) {
            share
        } else {
            0.5
        };
        [share, 1.0 - share].map(|share| variance * share * share)
    }

    #[test]
    fn many_meet_as_each_does_alone() {
        let grid = LeafMap::new([320, 200]).grid();
        for seed in 0..50 {
            let mut meetings = meetings(seed);
            Arch::new().dispatch(Meet(&mut meetings, grid));
            for lane in 0..AT_ONCE {
                let point = GridPoint([0, 1].map(|along| meetings.points[along][lane]));
                let halvings = [0, 1].map(|along| meetings.halvings[along][lane].to_le_bytes()[0]);
                let sides = GridCell::holding(point, halvings).sides();
                let mut here = Expected::NOTHING;
                for (side, axis) in SIDES.into_iter().enumerate() {
                    let difference = meetings.shown[lane] - meetings.their_shown[side][lane];
                    let variance = 0.5 * difference * difference;
                    let places = [point.0[axis as usize], meetings.their_points[side][lane]];
                    let [mine, theirs] = plain(variance, sides[side], places);
                    here = here.max(Expected::new(mine, axis));
                    assert_eq!(meetings.there[side][lane], Expected::new(theirs, axis));
                }
                assert_eq!(meetings.here[lane], here);
            }
        }
    }

    /// The same code, compiled for no more than the processor is sure to have.
    #[test]
    fn the_bits_do_not_depend_on_the_processor() {
        let grid = LeafMap::new([320, 200]).grid();
        for seed in 0..50 {
            let mut wide = meetings(seed);
            let mut plain = wide.clone();
            Arch::new().dispatch(Meet(&mut wide, grid));
            Arch::Scalar.dispatch(Meet(&mut plain, grid));
            assert_eq!((wide.squares, wide.here), (plain.squares, plain.here));
            assert_eq!(wide.there, plain.there);
        }
    }

    #[test]
    fn only_what_is_more_than_expected_before_is_reported() {
        let grid = LeafMap::new([320, 200]).grid();
        let mut meetings = meetings(7);
        Meet(&mut meetings, grid).call();
        for (there, before) in meetings.there.iter().zip(&mut meetings.their_expected) {
            // As much was expected by every second one.
            before
                .iter_mut()
                .zip(there)
                .step_by(2)
                .for_each(|(before, there)| *before = *there);
        }
        let mut found = Found::default();
        meetings.report(9, &mut found);
        let expected = (0..4).flat_map(|side| [1, 3, 5, 7].map(|lane| (side, lane)));
        let expected =
            expected.map(|(side, lane)| (100 + number(lane), meetings.there[side][lane]));
        let expected = expected.filter(|(_, there)| *there > Expected::NOTHING);
        assert_eq!(found.there, expected.collect::<Vec<_>>());
        assert!(found.here.iter().map(|(own, _)| *own).eq(0..9));
    }
}
