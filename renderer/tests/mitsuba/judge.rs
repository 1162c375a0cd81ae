//! Whether two pictures differ by more than chance: a z test for each pixel, and one for each block.
//!
//! A pixel is sensitive to geometry, the mean of a block of 8 × 8 pixels to brightness and colour. The
//! thresholds are Šidák's for an error of 0.001 over all tests of a picture, by Student's t of 31 degrees of
//! freedom, since both pictures are means of 32 renders (R: `qt(1 - (1 - (1 - .001)^(1/n))/2, 31)`).
//!
//! To the standard errors come:
//! - what one sample of ours counts, times the contrast about the pixel: an edge that barely touches the
//!   filter may be met by no sample, which a standard error cannot know;
//! - 0.05% of the value and 1e-5: Mitsuba computes in single precision, starts shadow rays 1e-4 off, and
//!   interpolates the colour-matching functions over 5 nm.

use std::fmt;

use crate::picture::{Picture, SAMPLES};

/// For 48 × 48 pixels of three values.
const MOST_IN_A_PIXEL: f64 = 6.758;
/// For 36 blocks of three values.
const MOST_IN_A_BLOCK: f64 = 5.293;
const BLOCK_PX: usize = 8;
/// Neighbours share samples: over a large block a tent correlates as if it held 2.25 times fewer pixels.
const SHARED: f64 = 2.25;

/// The largest differences found, in standard errors, and where.
pub(crate) struct Verdict {
    pixel: Worst,
    block: Worst,
}

#[derive(Clone, Copy, Default)]
struct Worst {
    z: f64,
    at_px: [usize; 2],
    ours: f64,
    theirs: f64,
}

impl fmt::Display for Worst {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            z,
            at_px: [x, y],
            ours,
            theirs,
        } = self;
        write!(
            formatter,
            "{z:.1} errors at ({x}, {y}): {ours:.5}, Mitsuba {theirs:.5}"
        )
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { pixel, block } = self;
        write!(formatter, "worst pixel {pixel}; worst block {block}")
    }
}

impl Verdict {
    pub(crate) fn is_same(&self) -> bool {
        self.pixel.z < MOST_IN_A_PIXEL && self.block.z < MOST_IN_A_BLOCK
    }
}

impl Worst {
    fn note(&mut self, at_px: [usize; 2], [ours, theirs]: [f64; 2], variance: f64) {
        let allowance = 5e-4 * theirs.abs() + 1e-5;
        let z = (ours - theirs).abs() / (variance + allowance * allowance).sqrt();
        if z > self.z {
            *self = Self {
                z,
                at_px,
                ours,
                theirs,
            };
        }
    }
}

/// Compares two pictures of the same size.
pub(crate) fn verdict(ours: &Picture, theirs: &Picture) -> Verdict {
    assert_eq!(ours.size_px, theirs.size_px);
    let [width, height] = ours.size_px.map(|size| size as usize);
    let mut pixel = Worst::default();
    let mut block = Worst::default();
    for value in 0..3 {
        let variance = |place: usize| {
            let missed = contrast(ours, place, value).max(contrast(theirs, place, value));
            let missed = missed / SAMPLES as f64;
            ours.error[place][value].powi(2) + theirs.error[place][value].powi(2) + missed * missed
        };
        for place in 0..width * height {
            let values = [ours.mean[place][value], theirs.mean[place][value]];
            pixel.note([place % width, place / width], values, variance(place));
        }
        for first in (0..height).step_by(BLOCK_PX).flat_map(|row| {
            let columns = (0..width).step_by(BLOCK_PX);
            columns.map(move |column| [column, row])
        }) {
            let places: Vec<usize> = places_of_block(first, width).collect();
            let mean = |of: &dyn Fn(usize) -> f64| {
                places.iter().map(|&place| of(place)).sum::<f64>() / places.len() as f64
            };
            let values = [ours, theirs].map(|picture| mean(&|place| picture.mean[place][value]));
            let of_mean = SHARED * mean(&variance) / places.len() as f64;
            block.note(first, values, of_mean);
        }
    }
    Verdict { pixel, block }
}

/// The places of the pixels of a block.
fn places_of_block([column, row]: [usize; 2], width: usize) -> impl Iterator<Item = usize> {
    let rows = row..row + BLOCK_PX;
    rows.flat_map(move |row| (column..column + BLOCK_PX).map(move |column| row * width + column))
}

/// From the least to the largest value in a pixel and its neighbours.
fn contrast(picture: &Picture, place: usize, value: usize) -> f64 {
    let width = picture.size_px[0] as usize;
    let (column, row) = (place % width, place / width);
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    for row in row.saturating_sub(1)..=row + 1 {
        for column in column.saturating_sub(1)..=(column + 1).min(width - 1) {
            if let Some(mean) = picture.mean.get(row * width + column) {
                least = least.min(mean[value]);
                most = most.max(mean[value]);
            }
        }
    }
    most - least
}
