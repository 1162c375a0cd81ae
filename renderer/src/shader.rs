//! From a ray tree to the tristimulus value of one channel: section 3.3 of Meyer & Liu (1992), step 2.
//!
//! Light is carried back along the tree wavelength by wavelength and then summed with the channel's
//! weights. Only wavelengths that count for the channel are computed.
//!
//! Each channel has tables of its own, so that its wavelengths stand side by side; they are filled up to a
//! multiple of four with wavelengths of weight zero.

use protocols::{Channel, PerChannel};

use crate::ray_tree::{MAX_LIGHTS, RayNode, RayTree};
use crate::scene::Scene;
use crate::scene::material::ReflectanceIndex;
use crate::spectra::WavelengthRule;

/// Wavelengths that are computed side by side.
const LANES: usize = 4;

type Lanes = [f32; LANES];

/// The spectra of a scene at the wavelengths of one channel.
#[derive(Clone, Debug)]
struct ChannelTables {
    /// How many wavelengths count.
    wavelengths: usize,
    weights: Vec<Lanes>,
    /// For each light and last for ambient light, as `weights`.
    powers: [Vec<Lanes>; MAX_LIGHTS + 1],
    /// All reflectances one after another, and last a perfect white.
    reflectances: Vec<Lanes>,
}

/// The spectra of a scene, ready for each channel.
#[derive(Clone, Debug)]
pub(crate) struct Shader {
    tables: PerChannel<ChannelTables>,
    lights: usize,
}

impl Shader {
    /// The place of the perfect white after `reflectances` reflectances: what a clear coat mirrors with.
    pub(crate) fn white(scene: &Scene) -> ReflectanceIndex {
        ReflectanceIndex::try_from(scene.reflectances.len()).unwrap_or(ReflectanceIndex::MAX)
    }

    /// Takes the spectra of a scene at the wavelengths of a rule.
    pub(crate) fn new(scene: &Scene, rule: &WavelengthRule) -> Self {
        Self {
            tables: PerChannel::from_fn(|channel| ChannelTables::new(scene, rule, channel)),
            lights: scene.lights.len(),
        }
    }

    /// How many wavelengths are computed for a channel.
    pub(crate) fn wavelengths(&self, channel: Channel) -> usize {
        self.tables[channel].wavelengths
    }

    /// The tristimulus value of a channel.
    #[inline]
    pub(crate) fn shade(&self, tree: &RayTree, channel: Channel) -> f32 {
        let tables = &self.tables[channel];
        let mut sums: Lanes = [0.0; LANES];
        for (group, weights) in tables.weights.iter().enumerate() {
            let mut radiance: Lanes = [0.0; LANES];
            for node in tree.nodes().iter().rev() {
                radiance = self.leaving(node, tables, group, radiance);
            }
            for lane in 0..LANES {
                sums[lane] += weights[lane] * radiance[lane];
            }
        }
        (sums[0] + sums[1]) + (sums[2] + sums[3])
    }

    /// The light that leaves a hit towards the viewer, given what its mirrored ray brings.
    #[inline]
    fn leaving(
        &self,
        node: &RayNode,
        tables: &ChannelTables,
        group: usize,
        mirrored: Lanes,
    ) -> Lanes {
        let reflectances = |index: ReflectanceIndex| {
            &tables.reflectances[usize::from(index) * tables.weights.len() + group]
        };
        let (body, mirror) = (reflectances(node.body), reflectances(node.mirror));
        let ambient = &tables.powers[MAX_LIGHTS][group];
        let mut leaving: Lanes = [0.0; LANES];
        for lane in 0..LANES {
            leaving[lane] = body[lane] * node.scattered_ambient * ambient[lane]
                + mirror[lane] * node.mirrored * mirrored[lane];
        }
        for light in 0..self.lights {
            let power = &tables.powers[light][group];
            for lane in 0..LANES {
                let share = body[lane] * node.scattered[light] + node.highlights[light];
                leaving[lane] += power[lane] * share;
            }
        }
        leaving
    }
}

impl ChannelTables {
    fn new(scene: &Scene, rule: &WavelengthRule, channel: Channel) -> Self {
        let nodes = rule.nodes_of(channel);
        let in_lanes = |values: &dyn Fn(usize) -> f64| -> Vec<Lanes> {
            let groups = nodes.chunks(LANES).map(|group| {
                let mut lanes = [0.0; LANES];
                for (lane, &node) in lanes.iter_mut().zip(group) {
                    *lane = single(values(node));
                }
                lanes
            });
            groups.collect()
        };
        let mut powers: [Vec<Lanes>; MAX_LIGHTS + 1] = std::array::from_fn(|_| in_lanes(&|_| 0.0));
        for (powers, light) in powers.iter_mut().zip(&scene.lights) {
            let power = rule.power_at_nodes(&light.emission);
            *powers = in_lanes(&|node| power[node]);
        }
        if let Some(ambient) = &scene.ambient {
            let power = rule.power_at_nodes(&ambient.emission);
            powers[MAX_LIGHTS] = in_lanes(&|node| power[node]);
        }
        let spectra = scene.reflectances.iter();
        let mut reflectances: Vec<Lanes> = spectra
            .flat_map(|spectrum| in_lanes(&|node| spectrum.at(rule.nodes_nm[node])))
            .collect();
        reflectances.extend(in_lanes(&|_| 1.0));
        Self {
            wavelengths: nodes.len(),
            weights: in_lanes(&|node| rule.weights[channel][node]),
            powers,
            reflectances,
        }
    }
}

/// Rounds to single precision: 24 bits are far finer than a display's 8.
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding to the nearest single is meant"
)]
pub(crate) fn single(value: f64) -> f32 {
    value as f32
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use protocols::Quadrature;

    use super::*;
    use crate::sampler::{Sampler as _, ScreenPoint};
    use crate::spectra::{Emission, Spectrum, cie, sensitivities};

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

    /// The radiance of a tree at one wavelength, straight from the definition in double precision.
    fn radiance(scene: &Scene, tree: &RayTree, nm: f64) -> f64 {
        let white = Spectrum::constant(1.0);
        let reflectance = |index: ReflectanceIndex| {
            let own = scene.reflectances.get(usize::from(index));
            own.unwrap_or(&white).at(nm)
        };
        let power = |emission: &Emission| emission.at(nm);
        let hits = tree.nodes().iter().rev();
        hits.fold(0.0, |mirrored, node| {
            let ambient = scene.ambient.as_ref().map_or(0.0, |a| power(&a.emission));
            let body = reflectance(node.body);
            let lights = scene.lights.iter().enumerate().map(|(place, light)| {
                let scattered = f64::from(node.scattered[place]);
                let highlight = f64::from(node.highlights[place]);
                power(&light.emission) * (body * scattered + highlight)
            });
            lights.sum::<f64>()
                + body * f64::from(node.scattered_ambient) * ambient
                + reflectance(node.mirror) * f64::from(node.mirrored) * mirrored
        })
    }

    fn at_1_nm(scene: &Scene, tree: &RayTree, channel: Channel) -> f64 {
        let products = sensitivities()
            .iter()
            .map(|row| row.ac1c2[channel] * radiance(scene, tree, row.wavelength_nm));
        products.sum::<f64>() / cie::sum_of_y()
    }

    #[test]
    fn a_channel_is_the_full_sum_at_1_nm_within_the_error_of_16_bands() {
        let scene = Scene::from_toml(Path::new("test.toml"), SCENE).unwrap();
        let sampler = scene.sampler(Quadrature::Bands(16), [320, 320]);
        let (mut tree, mut depth, mut most) = (RayTree::default(), 0, 0.0);
        for (x, y) in (0..40).flat_map(|x| (0..40).map(move |y| (x, y))) {
            let (x, y) = (f64::from(x) / 40.0 + 0.013, f64::from(y) / 40.0 + 0.007);
            sampler.intersect(ScreenPoint { x, y }, &mut tree);
            depth = depth.max(tree.nodes().len());
            for channel in Channel::ALL {
                let exact = at_1_nm(&scene, &tree, channel);
                let error = (f64::from(sampler.shade(&tree, channel)) - exact).abs();
                most = f64::max(most, error);
            }
        }
        // 0.36 CIEDE2000, the largest error over the ColorChecker, is about 0.004 of white in a channel.
        assert!(most < 0.004, "an error of {most}");
        assert!(
            depth >= 4,
            "the scene should mirror mirrors, found {depth} hits"
        );
    }
}
