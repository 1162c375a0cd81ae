//! From leaves to pixels: the piecewise-constant picture, filtered exactly and sampled at pixel centres.
//!
//! The picture is constant over each leaf. With a separable filter `f(x) f(y)` the integral of the filter
//! over a rectangle is the product of two differences of its integral `F`, so nothing is approximated:
//!
//! ```text
//! pixel = Σ value (F(right) - F(left)) (F(bottom) - F(top)) / Σ (F(right) - F(left)) (F(bottom) - F(top))
//! ```
//!
//! with the edges in pixels from the pixel's centre. The lower sum, over all leaves, is the part of the
//! filter that lies on the screen: 1, and less at the borders. Sums are in `f64`, in the order of the
//! leaves, so that the same leaves give the same bytes.
//!
//! Source: Painter & Sloan (1989); Meyer & Liu (1992), section 3.1. The choice of filter is ours.

use crate::channel_image::ChannelImage;
use crate::filter::{RADIUS_PX, integral_up_to};
use crate::screen_tree::Leaf;

/// The picture of leaves that tile the screen.
pub fn reconstruct(leaves: &[Leaf], size_px: [u32; 2]) -> ChannelImage {
    let [columns, rows] = size_px.map(|size| Pixels {
        count: size as usize,
    });
    let mut sums = vec![0.0; columns.count * rows.count];
    let (mut along_x, mut along_y) = (Vec::new(), Vec::new());
    for leaf in leaves {
        let rectangle = leaf.cell.rectangle();
        let first_column = columns.weigh(rectangle.left, rectangle.width, &mut along_x);
        let first_row = rows.weigh(rectangle.top, rectangle.height, &mut along_y);
        let value = f64::from(leaf.value);
        for (row, weight_y) in (first_row..).zip(&along_y) {
            let start = row * columns.count + first_column;
            let weighted = value * weight_y;
            for (sum, weight_x) in sums[start..].iter_mut().zip(&along_x) {
                *sum += weighted * weight_x;
            }
        }
    }
    let on_screen_x = columns.on_screen();
    let on_screen_y = rows.on_screen();
    let weights = on_screen_y
        .iter()
        .flat_map(|y| on_screen_x.iter().map(move |x| x * y));
    let values = sums
        .iter()
        .zip(weights)
        .map(|(sum, weight)| to_f32(sum / weight));
    let values = values.collect();
    ChannelImage::from_rows(size_px, values)
}

/// The pixels along one axis.
#[derive(Clone, Copy)]
struct Pixels {
    count: usize,
}

impl Pixels {
    /// The weight of the interval from `start` of this `length` for each pixel whose filter meets it.
    ///
    /// Gives the first of those pixels.
    fn weigh(self, start: f64, length: f64, weights: &mut Vec<f64>) -> usize {
        let pixels = self.count as f64;
        let (from, to) = (start * pixels, (start + length) * pixels);
        // Pixel i has its centre at i + 1/2.
        let first = to_index(from - 0.5 - RADIUS_PX);
        let end = to_index((to - 0.5 + RADIUS_PX).ceil()).min(self.count);
        weights.clear();
        weights.extend((first..end).map(|pixel| {
            let centre = pixel as f64 + 0.5;
            integral_up_to(to - centre) - integral_up_to(from - centre)
        }));
        first
    }

    /// The part of each pixel's filter that lies on the screen.
    fn on_screen(self) -> Vec<f64> {
        let mut weights = Vec::new();
        self.weigh(0.0, 1.0, &mut weights);
        weights
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

#[expect(
    clippy::cast_possible_truncation,
    reason = "tristimulus values are stored as f32"
)]
fn to_f32(value: f64) -> f32 {
    value as f32
}
