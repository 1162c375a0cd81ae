//! The pixels along one axis of a picture, and how much of each pixel's filter an interval takes.

use std::ops::Range;

use crate::filter::{RADIUS_PX, integral_up_to};

/// The pixels along one axis.
#[derive(Clone, Debug)]
pub(crate) struct PixelAxis {
    /// Where the pixels have their centres, in pixels.
    centres: Vec<f64>,
    /// The part of each pixel's filter that lies on the screen.
    on_screen: Vec<f64>,
}

impl PixelAxis {
    pub(crate) fn new(size_px: u32) -> Self {
        let mut axis = Self {
            centres: (0..size_px).map(|pixel| f64::from(pixel) + 0.5).collect(),
            on_screen: Vec::new(),
        };
        let mut on_screen = Vec::new();
        axis.weigh([0.0, 1.0], 0..axis.len(), &mut on_screen);
        axis.on_screen = on_screen;
        axis
    }

    /// How many pixels there are.
    pub(crate) fn len(&self) -> usize {
        self.centres.len()
    }

    /// The part of each pixel's filter that lies on the screen: 1, and less at both ends.
    pub(crate) fn on_screen(&self) -> &[f64] {
        &self.on_screen
    }

    /// The weight of an interval for each pixel of `among` whose filter meets it.
    ///
    /// Gives the first of those pixels. The interval is from its `start` of this `length`, as parts of the screen.
    pub(crate) fn weigh(
        &self,
        [start, length]: [f64; 2],
        among: Range<usize>,
        weights: &mut Vec<f64>,
    ) -> usize {
        let pixels = self.len() as f64;
        let (from, to) = (start * pixels, (start + length) * pixels);
        let first = to_index(from + 0.5 - RADIUS_PX).max(among.start);
        let end = (to_index(to - 0.5 + RADIUS_PX) + 1).min(among.end);
        weights.clear();
        if let Some(centres) = self.centres.get(first..end) {
            let weight = |centre| integral_up_to(to - centre) - integral_up_to(from - centre);
            weights.extend(centres.iter().map(weight));
        }
        first
    }

    /// The part of the screen that lies within reach of the filters of some pixels.
    pub(crate) fn reached_by(&self, pixels: &Range<usize>) -> Range<f64> {
        let place = |pixel: usize, reach: f64| (pixel as f64 + reach) / self.len() as f64;
        place(pixels.start, 0.5 - RADIUS_PX)..place(pixels.end, RADIUS_PX - 0.5)
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a pixel's place, at most 16384; below the first pixel it saturates at 0"
)]
fn to_index(place: f64) -> usize {
    place as usize
}
