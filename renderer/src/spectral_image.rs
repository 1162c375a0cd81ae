//! The picture at each wavelength that light is carried at, from the tree that is there.
//!
//! The tree holds no spectra, only where the rays went. So each ray of its leaves is followed once more and
//! shaded at some wavelengths, as many as fit into a fixed memory, and the leaves are filtered as those of a
//! channel are.

use rayon::prelude::*;

use crate::channel_image::ChannelImage;
use crate::reconstruct::reconstruct;
use crate::sampler::Sampler;
use crate::screen_tree::{Leaf, PlacedNode, Reach, ScreenTree};

/// No more values are held at once, 128 MiB of them, beside the images; but always those of one wavelength.
const MOST_VALUES: usize = 1 << 25;

/// The picture at each wavelength of the sampler, as far into the tree as `reach` says.
pub(crate) fn spectral_images<S: Sampler>(
    sampler: &S,
    tree: &ScreenTree,
    reach: Reach,
    size_px: [u32; 2],
) -> Vec<ChannelImage> {
    spectral_images_within(sampler, (tree, reach), size_px, MOST_VALUES)
}

fn spectral_images_within<S: Sampler>(
    sampler: &S,
    (tree, reach): (&ScreenTree, Reach),
    size_px: [u32; 2],
    most_values: usize,
) -> Vec<ChannelImage> {
    let leaves: Vec<PlacedNode> = tree.leaf_nodes(reach).collect();
    let bands = sampler.wavelengths_nm().len();
    let at_once = (most_values / leaves.len().max(1)).clamp(1, bands.max(1));
    let mut images = Vec::with_capacity(bands);
    for first in (0..bands).step_by(at_once) {
        let end = bands.min(first + at_once);
        let count = end - first;
        let mut values = vec![0.0_f32; leaves.len() * count];
        values
            .par_chunks_mut(count)
            .zip(&leaves)
            .with_min_len(256)
            .for_each_init(S::RayTree::default, |ray_tree, (values, leaf)| {
                sampler.intersect(tree.point(leaf.sample), ray_tree);
                sampler.radiance(ray_tree, first..end, values);
            });
        let image = |band: usize| {
            let leaf = |(leaf, values): (&PlacedNode, &[f32])| Leaf {
                cell: leaf.cell,
                value: values[band],
            };
            let leaves: Vec<Leaf> = leaves.iter().zip(values.chunks(count)).map(leaf).collect();
            reconstruct(&leaves, size_px)
        };
        images.extend((0..count).into_par_iter().map(image).collect::<Vec<_>>());
    }
    images
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use protocols::{Channel, PerChannel, Quadrature, RefinementDriver};

    use super::*;
    use crate::opponent::xyz_from_ac1c2;
    use crate::refine::{TracePlan, trace};
    use crate::scene::Scene;
    use crate::spectra::{WavelengthRule, cie};

    /// Metal, a clear coat, a checker, two lights and ambient light.
    const SCENE: &str = r#"
sphere = [
    { material = "ball", center_m = [0.0, 0.0, 0.5], radius_m = 0.5 },
    { material = "copper", center_m = [1.1, 0.2, 0.5], radius_m = 0.5 },
]
ground = [{ material = "tiles", height_m = 0.0 }]
camera = { position_m = [0.3, -5.0, 1.5], look_at_m = [0.5, 0.0, 0.4], up = [0, 0, 1], vertical_field_of_view_deg = 30 }
ambient = { emittance = "A", illuminance = 0.1 }
distant_light = [{ from = [-1.0, -2.0, 2.0], emittance = "D65", illuminance = 0.8 }]
point_light = [{ position_m = [3.0, -2.0, 3.0], emittance = "blackbody 3200 K", intensity = 3.0 }]
[glossy.ball]
reflectance = "colorchecker blue"
highlight = 0.3
exponent = 50
refractive_index = 1.5
[glossy.tiles]
reflectance = "colorchecker yellow"
checker = { reflectance = "colorchecker red", size_m = 0.3 }
highlight = 0.1
exponent = 20
refractive_index = 1.4
[mirror.copper]
reflectance = [[400, 0.4], [560, 0.5], [620, 0.9], [700, 0.95]]
"#;
    const SIZE_PX: [u32; 2] = [24, 20];

    fn plan() -> TracePlan {
        TracePlan {
            until: None,
            seed: 1,
            size_px: SIZE_PX,
            min_depth: 6,
            driver: RefinementDriver::A,
            stops: PerChannel::from_fn(|_| Reach::rays(1500)),
        }
    }

    /// The picture of each channel, and that at each wavelength.
    fn images(quadrature: Quadrature) -> (PerChannel<ChannelImage>, Vec<ChannelImage>) {
        let scene = Scene::from_toml(Path::new("test.toml"), SCENE).unwrap();
        let sampler = scene.sampler(quadrature, SIZE_PX);
        let tree = trace(&sampler, &plan(), &|_, _| ());
        let reach = Reach::rays(1500);
        let channel = |c| reconstruct(&tree.leaves(c, reach).unwrap(), SIZE_PX);
        let whole = spectral_images(&sampler, &tree, reach, SIZE_PX);
        let in_parts = spectral_images_within(&sampler, (&tree, reach), SIZE_PX, 4000);
        assert!(whole == in_parts, "the memory changes the images");
        (PerChannel::from_fn(channel), whole)
    }

    #[test]
    fn the_weighted_sum_of_the_wavelengths_is_each_channel() {
        for quadrature in [Quadrature::Bands(16), Quadrature::Meyer1988] {
            let rule = WavelengthRule::new(quadrature);
            let (channels, spectrum) = images(quadrature);
            for channel in Channel::ALL {
                for (pixel, &value) in channels[channel].values().iter().enumerate() {
                    let products = rule.weights[channel].iter().zip(&spectrum);
                    let sum: f64 = products
                        .map(|(weight, image)| weight * f64::from(image.values()[pixel]))
                        .sum();
                    // Single precision over at most ten products of values up to 3.
                    assert!(
                        (sum - f64::from(value)).abs() < 1e-5,
                        "{channel} at {pixel}"
                    );
                }
            }
        }
    }

    /// XYZ of a pixel by the colour-matching functions at 1 nm: constant over each band of 400 to 700 nm, level
    /// outside.
    fn xyz_by_the_cie(spectrum: &[ChannelImage], pixel: usize) -> [f64; 3] {
        let last = spectrum.len() - 1;
        let radiance = |nm: f64| {
            let band = ((nm - 400.0) / 300.0 * spectrum.len() as f64).floor();
            let place = (0..=last).rev().find(|&place| place as f64 <= band);
            f64::from(spectrum[place.unwrap_or(0)].values()[pixel])
        };
        [0, 1, 2].map(|axis| {
            let rows = cie::colour_matching().iter();
            let products = rows.map(|row| radiance(row.wavelength_nm) * row.xyz[axis]);
            products.sum::<f64>() / cie::sum_of_y()
        })
    }

    /// A reader who does not know our weights. Lights are changed to be exact in our sums, and those are the sums of
    /// the functions over each band, so that theirs are the same but for the rounding of the values.
    #[test]
    fn a_reader_who_sums_with_the_tables_of_the_cie_gets_the_xyz_image() {
        for bands in [16, 61] {
            let (channels, spectrum) = images(Quadrature::Bands(bands));
            for pixel in 0..spectrum[0].values().len() {
                let value = |channel: Channel| f64::from(channels[channel].values()[pixel]);
                let expected = xyz_from_ac1c2(PerChannel::from_fn(value));
                let found = xyz_by_the_cie(&spectrum, pixel);
                for (found, expected) in found.into_iter().zip(expected) {
                    // The inverse of Eq. 2 has entries up to 2, and each value errs by single precision.
                    assert!((found - expected).abs() < 5e-5, "{bands} bands at {pixel}");
                }
            }
        }
    }
}
