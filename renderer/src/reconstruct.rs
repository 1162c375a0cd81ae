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
    let mut reconstruction = Reconstruction::new(size_px);
    for &leaf in leaves {
        reconstruction.add(leaf);
    }
    reconstruction.into_image()
}

/// A picture that grows leaf by leaf, so that a large tree's leaves need not be listed first.
#[derive(Debug)]
pub(crate) struct Reconstruction {
    size_px: [u32; 2],
    sums: Vec<f64>,
    along_x: Vec<f64>,
    along_y: Vec<f64>,
}

impl Reconstruction {
    pub(crate) fn new(size_px: [u32; 2]) -> Self {
        let [width, height] = size_px.map(|size| size as usize);
        Self {
            size_px,
            sums: vec![0.0; width * height],
            along_x: Vec::new(),
            along_y: Vec::new(),
        }
    }

    fn axes(&self) -> [Pixels; 2] {
        self.size_px.map(|size| Pixels {
            count: size as usize,
        })
    }

    /// Adds what a leaf contributes to the pixels around it.
    pub(crate) fn add(&mut self, leaf: Leaf) {
        let [columns, rows] = self.axes();
        let rectangle = leaf.cell.rectangle();
        let first_column = columns.weigh(rectangle.left, rectangle.width, &mut self.along_x);
        let first_row = rows.weigh(rectangle.top, rectangle.height, &mut self.along_y);
        let value = f64::from(leaf.value);
        for (row, weight_y) in (first_row..).zip(&self.along_y) {
            let start = row * columns.count + first_column;
            let weighted = value * weight_y;
            for (sum, weight_x) in self.sums[start..].iter_mut().zip(&self.along_x) {
                *sum += weighted * weight_x;
            }
        }
    }

    /// The picture, once every leaf was added.
    pub(crate) fn into_image(self) -> ChannelImage {
        let [on_screen_x, on_screen_y] = self.axes().map(Pixels::on_screen);
        let weights = on_screen_y
            .iter()
            .flat_map(|y| on_screen_x.iter().map(move |x| x * y));
        let values = self.sums.iter().zip(weights);
        let values = values.map(|(sum, weight)| to_f32(sum / weight)).collect();
        ChannelImage::from_rows(self.size_px, values)
    }
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
