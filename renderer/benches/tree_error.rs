//! How far the picture of A at N rays is from the truth: the refined tree beside uniform sampling.
//!
//! `cargo bench -p renderer --bench tree_error -- SCENE...` prints one line for each scene and ray count; by
//! default for three scenes of the project. The truth has 256 jittered samples a pixel and the same exact
//! filter. Uniform sampling is one jittered sample in each cell of a grid of N cells as square as can be, with
//! the same reconstruction. Errors are those of the linear value of A, not of the shown code.
#![expect(clippy::print_stdout, reason = "a bench prints what it measured")]

use std::path::{Path, PathBuf};

use protocols::{Channel, PerChannel, Quadrature, RefinementDriver};
use rayon::prelude::*;
use renderer::{
    Cell, ChannelImage, Reach, RendererError, Sampler, Scene, ScreenPoint, TracePlan, reconstruct,
    trace,
};

const SIZE_PX: [u32; 2] = [320, 320];

/// The scenes measured where none is named.
const SCENES: [&str; 3] = ["opponent-solids", "soft-spheres", "toy-village"];

fn main() -> Result<(), RendererError> {
    let named = std::env::args()
        .skip(1)
        .filter(|argument| !argument.starts_with("--"));
    let mut scenes: Vec<PathBuf> = named.map(PathBuf::from).collect();
    if scenes.is_empty() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../stimuli/scenes");
        scenes.extend(SCENES.map(|name| folder.join(name).with_extension("toml")));
    }
    for path in scenes {
        println!("{}", path.display());
        println!("    rays   tree   uniform  ratio");
        measure(&Scene::read(&path)?);
    }
    Ok(())
}

fn measure(scene: &Scene) {
    let sampler = scene.sampler(Quadrature::Bands(16), SIZE_PX);
    let plan = TracePlan {
        seed: 1992,
        size_px: SIZE_PX,
        min_depth: 8,
        driver: RefinementDriver::A,
        stops: PerChannel::from_fn(|_| Reach::rays(140_000)),
        until: None,
    };
    let tree = trace(&sampler, &plan, &|_, _| ());
    let truth = uniform(&sampler, Channel::A, [16 * SIZE_PX[0]; 2]);
    for rays in [10_000_u32, 30_000, 50_000, 90_000, 140_000] {
        let leaves = tree
            .leaves(Channel::A, Reach::rays(rays as usize))
            .unwrap_or_default();
        let refined = rms(&reconstruct(&leaves, SIZE_PX), &truth);
        let columns = count(f64::from(rays).sqrt());
        let grid = uniform(&sampler, Channel::A, [columns, rays / columns]);
        let even = rms(&grid, &truth);
        println!("{rays:>8} {refined:.4} {even:.4} {:.2}", refined / even);
    }
}

fn rms(image: &ChannelImage, truth: &ChannelImage) -> f64 {
    image.rms_difference(truth).unwrap_or(f64::NAN)
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the root of a ray count"
)]
fn count(side: f64) -> u32 {
    side.round() as u32
}

/// One jittered sample in each cell of a grid, constant over the cell, filtered with a tent as exactly as
/// the tree is: each cell is cut along the pixels that it meets by [`overlap`].
fn uniform<S: Sampler>(sampler: &S, channel: Channel, cells: [u32; 2]) -> ChannelImage {
    let [columns, rows] = cells;
    let along_x = overlaps(columns, SIZE_PX[0]);
    let along_y = overlaps(rows, SIZE_PX[1]);
    let [width, height] = SIZE_PX.map(|size| size as usize);
    let (mut sums, mut weights) = (vec![0.0; width * height], vec![0.0; width * height]);
    for row in 0..rows {
        let value = |column: u32| {
            let seed = (u64::from(row) << 32) | u64::from(column);
            let jitter = Cell::ROOT.random_point(seed);
            let at = ScreenPoint {
                x: (f64::from(column) + jitter.x) / f64::from(columns),
                y: (f64::from(row) + jitter.y) / f64::from(rows),
            };
            let mut ray_tree = S::RayTree::default();
            sampler.intersect(at, &mut ray_tree);
            f64::from(sampler.shade(&ray_tree, channel))
        };
        let values: Vec<f64> = (0..columns).into_par_iter().map(value).collect();
        for &(pixel_y, weight_y) in &along_y[row as usize] {
            for (value, places) in values.iter().zip(&along_x) {
                for &(pixel_x, weight_x) in places {
                    sums[pixel_y * width + pixel_x] += value * weight_x * weight_y;
                    weights[pixel_y * width + pixel_x] += weight_x * weight_y;
                }
            }
        }
    }
    #[expect(clippy::cast_possible_truncation, reason = "images are of f32")]
    let values = sums
        .iter()
        .zip(&weights)
        .map(|(sum, weight)| (sum / weight) as f32)
        .collect();
    ChannelImage::new(SIZE_PX, values).unwrap_or_else(|| unreachable!("as many values as pixels"))
}

/// For each of `cells` intervals the pixels whose tent it meets, and the part of the tent in it.
fn overlaps(cells: u32, pixels: u32) -> Vec<Vec<(usize, f64)>> {
    let up_to = |t: f64| {
        let t = t.clamp(-1.0, 1.0);
        if t < 0.0 {
            (1.0 + t).powi(2) / 2.0
        } else {
            1.0 - (1.0 - t).powi(2) / 2.0
        }
    };
    let scale = f64::from(pixels) / f64::from(cells);
    let overlap = |cell: u32| {
        let (from, to) = (f64::from(cell) * scale, f64::from(cell + 1) * scale);
        let part = |pixel: u32| {
            let centre = f64::from(pixel) + 0.5;
            (pixel as usize, up_to(to - centre) - up_to(from - centre))
        };
        (0..pixels)
            .map(part)
            .filter(|(_, weight)| *weight > 0.0)
            .collect()
    };
    (0..cells).map(overlap).collect()
}
