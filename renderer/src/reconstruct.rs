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
//! This is the plain way, for any leaves; the images of a tree are made by [`crate::snapshots()`].
//!
//! Source: Painter & Sloan (1989); Meyer & Liu (1992), section 3.1. The choice of filter is ours.

use crate::channel_image::ChannelImage;
use crate::pixel_axis::PixelAxis;
use crate::screen_tree::Leaf;

/// The picture of leaves that tile the screen.
pub fn reconstruct(leaves: &[Leaf], size_px: [u32; 2]) -> ChannelImage {
    let [columns, rows] = size_px.map(PixelAxis::new);
    let mut sums = vec![0.0; columns.len() * rows.len()];
    let (mut along_x, mut along_y) = (Vec::new(), Vec::new());
    for leaf in leaves {
        let cell = leaf.cell.rectangle();
        let left = columns.weigh([cell.left, cell.width], 0..columns.len(), &mut along_x);
        let top = rows.weigh([cell.top, cell.height], 0..rows.len(), &mut along_y);
        for (row, weight_y) in (top..).zip(&along_y) {
            let weighted = f64::from(leaf.value) * weight_y;
            let start = row * columns.len() + left;
            for (sum, weight_x) in sums[start..].iter_mut().zip(&along_x) {
                *sum += weighted * weight_x;
            }
        }
    }
    let mut values = vec![0.0; sums.len()];
    normalise(&sums, [columns.on_screen(), rows.on_screen()], &mut values);
    ChannelImage::from_rows(size_px, values)
}

/// Divides the sums of some rows of pixels by the part of each pixel's filter that lies on the screen.
pub(crate) fn normalise(sums: &[f64], [on_x, on_y]: [&[f64]; 2], values: &mut [f32]) {
    let rows = sums.chunks_exact(on_x.len());
    let rows = rows.zip(values.chunks_exact_mut(on_x.len()));
    for ((sums, values), on_y) in rows.zip(on_y) {
        for ((value, sum), on_x) in values.iter_mut().zip(sums).zip(on_x) {
            *value = to_f32(sum / (on_x * on_y));
        }
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "tristimulus values are stored as f32"
)]
fn to_f32(value: f64) -> f32 {
    value as f32
}
