//! A picture in XYZ that knows its own noise: Mitsuba's from a file, ours from independent renders.

use std::path::Path;

use exr::prelude::{FlatSamples, read_first_flat_layer_from_file};
use protocols::{Channel, PerChannel};
use rand::Rng as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;
use rayon::prelude::*;
use renderer::{Sampler, SceneSampler, ScreenPoint, xyz_from_ac1c2};

/// Independent renders of ours.
const RENDERS: usize = 32;
/// Each takes a sample in each of 3 × 3 equal parts of the filter of a pixel.
const STRATA: usize = 3;
/// How many samples of ours a pixel has in all.
pub(crate) const SAMPLES: usize = RENDERS * STRATA * STRATA;

/// For each pixel the mean of X, Y and Z, and the standard error of that mean.
#[derive(Debug)]
pub(crate) struct Picture {
    pub(crate) size_px: [u32; 2],
    pub(crate) mean: Vec<[f64; 3]>,
    pub(crate) error: Vec<[f64; 3]>,
}

impl Picture {
    /// A picture with the channels X, Y, Z, error.X, error.Y and error.Z; and what its comments say.
    pub(crate) fn read(path: &Path) -> (Self, String) {
        let image = read_first_flat_layer_from_file(path).unwrap();
        let layer = image.layer_data;
        let column = |name: &str| -> Vec<f64> {
            let mut channels = layer.channel_data.list.iter();
            let channel = channels.find(|channel| channel.name.eq(name)).unwrap();
            match &channel.sample_data {
                FlatSamples::F32(samples) => samples.iter().copied().map(f64::from).collect(),
                other => panic!("{name} is {other:?}"),
            }
        };
        let triples = |names: [&str; 3]| -> Vec<[f64; 3]> {
            let columns = names.map(column);
            (0..layer.size.area())
                .map(|pixel| [0, 1, 2].map(|i: usize| columns[i][pixel]))
                .collect()
        };
        let [width, height] = [layer.size.x(), layer.size.y()];
        let picture = Self {
            size_px: [width, height].map(|size| u32::try_from(size).unwrap()),
            mean: triples(["X", "Y", "Z"]),
            error: triples(["error.X", "error.Y", "error.Z"]),
        };
        let comments = layer.attributes.comments.unwrap_or_default();
        (picture, comments.to_string())
    }

    /// Our picture, filtered by the tent: pixel by pixel, without the screen tree.
    pub(crate) fn of(sampler: &SceneSampler<'_>, size_px: [u32; 2]) -> Self {
        let [width, height] = size_px;
        let pixels = (0..width * height).into_par_iter();
        let estimates: Vec<[[f64; 3]; 2]> = pixels
            .map(|pixel| pixel_of(sampler, size_px, pixel))
            .collect();
        Self {
            size_px,
            mean: estimates.iter().map(|[mean, _]| *mean).collect(),
            error: estimates.iter().map(|[_, error]| *error).collect(),
        }
    }
}

/// The mean of X, Y, Z over the renders and its standard error.
fn pixel_of(sampler: &SceneSampler<'_>, size_px: [u32; 2], pixel: u32) -> [[f64; 3]; 2] {
    let mut random = ChaCha8Rng::seed_from_u64(u64::from(pixel));
    let renders: Vec<[f64; 3]> = (0..RENDERS)
        .map(|_| one_render(sampler, size_px, pixel, &mut random))
        .collect();
    let n = RENDERS as f64;
    let mean = [0, 1, 2].map(|i: usize| renders.iter().map(|xyz| xyz[i]).sum::<f64>() / n);
    let error = [0, 1, 2].map(|i: usize| {
        let squares = renders.iter().map(|xyz| (xyz[i] - mean[i]).powi(2));
        (squares.sum::<f64>() / (n - 1.0) / n).sqrt()
    });
    [mean, error]
}

/// The mean of one sample in each stratum of the pixel's tent; what falls beside the screen does not count.
fn one_render(
    sampler: &SceneSampler<'_>,
    [width, height]: [u32; 2],
    pixel: u32,
    random: &mut ChaCha8Rng,
) -> [f64; 3] {
    let mut tree = <SceneSampler<'_> as Sampler>::RayTree::default();
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    for stratum in 0..STRATA * STRATA {
        let mut offset = |stratum: usize| {
            let fraction = (random.next_u64() >> 11) as f64 / 9_007_199_254_740_992.0;
            offset_in_tent((stratum as f64 + fraction) / STRATA as f64)
        };
        let across = f64::from(pixel % width) + 0.5 + offset(stratum % STRATA);
        let down = f64::from(pixel / width) + 0.5 + offset(stratum / STRATA);
        let at = ScreenPoint {
            x: across / f64::from(width),
            y: down / f64::from(height),
        };
        if !(0.0..1.0).contains(&at.x) || !(0.0..1.0).contains(&at.y) {
            continue;
        }
        sampler.intersect(at, &mut tree);
        let ac1c2 =
            PerChannel::from_fn(|channel: Channel| f64::from(sampler.shade(&tree, channel)));
        let xyz = xyz_from_ac1c2(ac1c2);
        (0..3).for_each(|i| sum[i] += xyz[i]);
        count += 1.0;
    }
    sum.map(|sum| sum / count)
}

/// The inverse of the tent's integral: offsets from −1 to 1 with the tent's density.
fn offset_in_tent(fraction: f64) -> f64 {
    if fraction < 0.5 {
        (2.0 * fraction).sqrt() - 1.0
    } else {
        1.0 - (2.0 * (1.0 - fraction)).sqrt()
    }
}
