//! The images of one tree at several ray counts, in one walk over it.
//!
//! A new sample changes the picture in its own half of the cell that it splits, from the value of the old
//! sample to its own. So with `W` the weight of a rectangle in a pixel, as in [`mod@crate::reconstruct`],
//!
//! ```text
//! pixel at N rays = value(0) W(screen) + Σ (value(k) - value(old of k)) W(half of k),   k = 1 .. N - 1
//! ```
//!
//! and the image at every count is a partial sum on the way to the last. Each half is weighed once, for all
//! channels. Sums are in `f64` in the order of the samples: an image has the same bits whatever other
//! images are wanted, and on any number of threads, each of which does some rows. The sums differ from
//! those over the leaves by rounding, 2⁻⁵³ of the largest value for each change of a pixel.
//!
//! A change whose cell lies below a channel's depth is left out: the value above stands for it.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use protocols::{Channel, PerChannel};
use rayon::prelude::*;

use crate::cell::Cell;
use crate::channel_image::ChannelImage;
use crate::pixel_axis::PixelAxis;
use crate::reconstruct::normalise;
use crate::screen_tree::{PlacedNode, ScreenTree};

/// The rows of a picture that are worked on at a time, so that their sums stay in a processor's cache.
const BAND_ROWS: usize = 40;

/// Changes whose values are read at a time, so that the waits for memory pass together.
const BATCH: usize = 64;

/// Which images of one channel are wanted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Wanted {
    /// After how many rays.
    pub rays: BTreeSet<usize>,
    /// Cells below this depth are not entered.
    pub depth: u32,
}

impl Wanted {
    /// Whether any of the images depends on this sample, which lies in a half of this depth.
    fn depends_on(&self, sample: u32, depth: u32) -> bool {
        let most = self.rays.last().copied().unwrap_or(0);
        (sample as usize) < most && depth <= self.depth
    }
}

/// The images of each channel, by their ray counts; `None` if a channel stopped before one of them.
///
/// A ray count beyond the end of the tree means the whole tree. Runs in the current rayon pool.
pub fn snapshots(
    tree: &ScreenTree,
    wanted: &PerChannel<Wanted>,
    size_px: [u32; 2],
) -> Option<PerChannel<BTreeMap<usize, ChannelImage>>> {
    snapshots_by_bands(tree, wanted, size_px, BAND_ROWS)
}

fn snapshots_by_bands(
    tree: &ScreenTree,
    wanted: &PerChannel<Wanted>,
    size_px: [u32; 2],
    band_rows: usize,
) -> Option<PerChannel<BTreeMap<usize, ChannelImage>>> {
    let [columns, rows] = &size_px.map(PixelAxis::new);
    let mut images = blank_images(wanted, columns.len() * rows.len());
    let mut bands: Vec<Band<'_>> = (0..rows.len())
        .step_by(band_rows)
        .map(|first| Band {
            rows: first..rows.len().min(first + band_rows),
            frames: Vec::with_capacity(images.len()),
        })
        .collect();
    for (&(rays, channel), values) in &mut images {
        let parts = values.chunks_mut(band_rows * columns.len());
        for (band, values) in bands.iter_mut().zip(parts) {
            band.frames.push(Frame {
                channel,
                rays,
                values,
            });
        }
    }
    bands
        .into_par_iter()
        .with_max_len(1)
        .try_for_each(|band| band.paint(tree, wanted, [columns, rows]))?;
    let mut by_channel = PerChannel::<BTreeMap<usize, ChannelImage>>::default();
    for ((rays, channel), values) in images {
        by_channel[channel].insert(rays, ChannelImage::from_rows(size_px, values));
    }
    Some(by_channel)
}

/// Room for every image, by ray count.
fn blank_images(
    wanted: &PerChannel<Wanted>,
    pixels: usize,
) -> BTreeMap<(usize, Channel), Vec<f32>> {
    let of_channel = |channel: Channel| {
        let rays = wanted[channel].rays.iter();
        rays.map(move |&rays| ((rays, channel), vec![0.0; pixels]))
    };
    Channel::ALL.into_iter().flat_map(of_channel).collect()
}

/// Some rows of every image.
struct Band<'a> {
    rows: Range<usize>,
    /// By ray count.
    frames: Vec<Frame<'a>>,
}

/// Some rows of one image.
struct Frame<'a> {
    channel: Channel,
    rays: usize,
    values: &'a mut [f32],
}

impl Band<'_> {
    /// `None` if a channel has no value where one is needed.
    fn paint(
        self,
        tree: &ScreenTree,
        wanted: &PerChannel<Wanted>,
        [columns, rows]: [&PixelAxis; 2],
    ) -> Option<()> {
        let changes = changes(tree, wanted, &rows.reached_by(&self.rows));
        let on_screen = [columns.on_screen(), &rows.on_screen()[self.rows.clone()]];
        let mut sums = Sums {
            columns,
            rows,
            range: self.rows.clone(),
            pixels: PerChannel::from_fn(|_| vec![0.0; self.rows.len() * columns.len()]),
            along_x: Vec::new(),
            along_y: Vec::new(),
        };
        let mut steps = Vec::with_capacity(BATCH);
        let mut begun = 0;
        for frame in self.frames {
            let is_before = |change: &Change| (change.sample as usize) < frame.rays;
            let end = changes.partition_point(is_before);
            for batch in changes[begun..end].chunks(BATCH) {
                steps.clear();
                for change in batch {
                    steps.push(change.steps(tree, wanted)?);
                }
                for (change, steps) in batch.iter().zip(&steps) {
                    sums.add(change.cell, steps);
                }
            }
            begun = end;
            normalise(&sums.pixels[frame.channel], on_screen, frame.values);
        }
        Some(())
    }
}

/// What one sample changes: in its cell stood the value of an older one.
#[derive(Clone, Copy, Debug)]
struct Change {
    sample: u32,
    old: Option<u32>,
    cell: Cell,
}

impl Change {
    /// By how much each channel changes; `None` if a value is needed that is not there.
    fn steps(&self, tree: &ScreenTree, wanted: &PerChannel<Wanted>) -> Option<PerChannel<f64>> {
        let mut steps = PerChannel::default();
        for channel in Channel::ALL {
            if wanted[channel].depends_on(self.sample, self.cell.depth()) {
                let value = |sample| tree.value(channel, sample).map(f64::from);
                let before = self.old.map_or(Some(0.0), value)?;
                steps[channel] = value(self.sample)? - before;
            }
        }
        Some(steps)
    }
}

/// The changes between some heights of the screen on which an image depends, in the order of their samples.
fn changes(tree: &ScreenTree, wanted: &PerChannel<Wanted>, heights: &Range<f64>) -> Vec<Change> {
    let wanted = [&wanted.a, &wanted.c1, &wanted.c2];
    let most = wanted.iter().filter_map(|wanted| wanted.rays.last()).max();
    let rays = most.copied().unwrap_or(0);
    let mut changes = vec![Change {
        sample: 0,
        old: None,
        cell: Cell::ROOT,
    }];
    // Level by level: the nodes of a level wait for memory together.
    let (mut level, mut next) = (vec![PlacedNode::ROOT], Vec::new());
    while !level.is_empty() {
        for node in level.drain(..) {
            for child in tree.children(node, rays).into_iter().flatten() {
                let cell = child.cell.rectangle();
                if cell.top >= heights.end || cell.top + cell.height <= heights.start {
                    continue;
                }
                let depth = child.cell.depth();
                let is_wanted = |wanted: &&Wanted| wanted.depends_on(child.sample, depth);
                if child.sample != node.sample && wanted.iter().any(is_wanted) {
                    changes.push(Change {
                        sample: child.sample,
                        old: Some(node.sample),
                        cell: child.cell,
                    });
                }
                next.push(child);
            }
        }
        std::mem::swap(&mut level, &mut next);
    }
    changes.sort_unstable_by_key(|change| change.sample);
    changes
}

/// The sums of some rows of pixels.
struct Sums<'a> {
    columns: &'a PixelAxis,
    rows: &'a PixelAxis,
    range: Range<usize>,
    pixels: PerChannel<Vec<f64>>,
    along_x: Vec<f64>,
    along_y: Vec<f64>,
}

impl Sums<'_> {
    /// Adds to the pixels around a cell what it contributes.
    fn add(&mut self, cell: Cell, steps: &PerChannel<f64>) {
        let (along_x, along_y) = (&mut self.along_x, &mut self.along_y);
        let (columns, cell) = (self.columns, cell.rectangle());
        let top = [cell.top, cell.height];
        let top = self.rows.weigh(top, self.range.clone(), along_y);
        let left = [cell.left, cell.width];
        let left = columns.weigh(left, 0..columns.len(), along_x);
        for channel in Channel::ALL {
            let step = steps[channel];
            if step == 0.0 {
                continue;
            }
            let pixels = &mut self.pixels[channel];
            for (row, weight_y) in (top - self.range.start..).zip(&*along_y) {
                let weighted = step * weight_y;
                let start = row * columns.len() + left;
                let row = &mut pixels[start..start + along_x.len()];
                for (sum, weight_x) in row.iter_mut().zip(&*along_x) {
                    *sum += weighted * weight_x;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use protocols::RefinementDriver;

    use super::*;
    use crate::refine::{TracePlan, trace};
    use crate::sampler::{Sampler, ScreenPoint};
    use crate::screen_tree::Reach;

    struct Rings;

    impl Sampler for Rings {
        type RayTree = f64;

        fn intersect(&self, at: ScreenPoint, tree: &mut f64) {
            *tree = at.x * at.x + at.y * at.y;
        }

        fn shade(&self, tree: &f64, channel: Channel) -> f32 {
            let phase = f64::from(channel as u8);
            let rings = (9.0 * tree + phase).rem_euclid(1.0);
            if rings < 0.5 { 0.1 } else { 0.9 }
        }
    }

    /// Cells reach over several bands; the sums of a pixel must not know.
    #[test]
    fn the_height_of_the_bands_changes_no_bit() {
        let size_px = [33, 50];
        let plan = TracePlan {
            until: None,
            seed: 3,
            size_px,
            min_depth: 4,
            driver: RefinementDriver::A,
            stops: PerChannel::from_fn(|_| Reach::rays(2000)),
        };
        let tree = trace(&Rings, &plan, &|_, _| ());
        let wanted = PerChannel::from_fn(|_| Wanted {
            rays: [5, 100, 2000].into(),
            depth: Cell::DEEPEST,
        });
        let whole = snapshots_by_bands(&tree, &wanted, size_px, 50);
        assert!(whole.is_some());
        for rows in [1, 7, 40, 49] {
            let in_bands = snapshots_by_bands(&tree, &wanted, size_px, rows);
            assert!(in_bands == whole, "{rows} rows");
        }
    }
}
