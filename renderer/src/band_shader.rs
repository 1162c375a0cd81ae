//! From a ray tree to the radiance at each wavelength that light is carried at: what spectral images hold.
//!
//! The same ways and the same powers as in `shader`, before the weights of a channel are applied; so the
//! weighted sum over the wavelengths of a rule is what that gives, but for rounding.

use std::ops::Range;

use crate::ray_tree::{LightShare, RayTree};
use crate::scene::Scene;
use crate::scene::material::Reflectance;
use crate::shader::{Shader, single};
use crate::spectra::WavelengthRule;

/// The spectra of a scene at the wavelengths of a rule.
#[derive(Clone, Debug)]
pub(crate) struct BandShader {
    nodes_nm: Vec<f64>,
    /// The power of each light, and last of ambient light.
    powers: Vec<Vec<f64>>,
    /// All reflectances, and last a perfect white.
    reflectances: Vec<Vec<f64>>,
    tints: Vec<Vec<f64>>,
}

impl BandShader {
    /// Takes the spectra of a scene at the wavelengths of a rule; `shader` is that of the same scene.
    pub(crate) fn new(scene: &Scene, rule: &WavelengthRule, shader: &Shader) -> Self {
        let nodes_nm = rule.nodes_nm.clone();
        let emissions = scene.lights.iter().map(|light| Some(&light.emission));
        let ambient = scene.ambient.as_ref().map(|ambient| &ambient.emission);
        let powers = emissions.chain([ambient]).map(|emission| {
            emission.map_or_else(
                || vec![0.0; nodes_nm.len()],
                |emission| rule.power_at_nodes(emission),
            )
        });
        let spectra = scene.reflectances.iter();
        let mut reflectances: Vec<Vec<f64>> = spectra
            .map(|spectrum| nodes_nm.iter().map(|&nm| spectrum.at(nm)).collect())
            .collect();
        let tints = shader.tints().metals().iter().map(|metals| {
            let at = |node: usize| -> f64 {
                let metals = metals.iter().map(|&metal| usize::from(metal));
                metals.map(|metal| reflectances[metal][node]).product()
            };
            (0..nodes_nm.len()).map(at).collect()
        });
        let tints = tints.collect();
        reflectances.push(vec![1.0; nodes_nm.len()]);
        Self {
            powers: powers.collect(),
            reflectances,
            tints,
            nodes_nm,
        }
    }

    /// The wavelengths, in nm.
    pub(crate) fn nodes_nm(&self) -> &[f64] {
        &self.nodes_nm
    }

    /// The radiance that arrives at some of the wavelengths, power per nm with Y = 1 for a perfect diffuser
    /// under an illuminance of 1.
    pub(crate) fn radiance(
        &self,
        shader: &Shader,
        tree: &RayTree,
        bands: Range<usize>,
        out: &mut [f32],
    ) {
        for (band, out) in bands.zip(out) {
            let arriving = |shares: &[LightShare]| -> f64 {
                let powers = shares.iter().map(|share| {
                    f64::from(share.share) * self.powers[usize::from(share.light)][band]
                });
                powers.sum()
            };
            let of_paths = tree.paths().iter().map(|path| {
                let (way, light) = shader.way(path.product as usize);
                let share = LightShare {
                    light,
                    share: path.share,
                };
                arriving(&[share])
                    * self.reflectances[way.reflectance][band]
                    * self.tints[way.tint][band]
            });
            let of_surfaces = tree.surfaces().map(|(surface, shares)| {
                let reflectance = match surface.reflectance {
                    Reflectance::Table(place) => self.reflectances[usize::from(place)][band],
                    Reflectance::Sigmoid(curve) => curve.at(self.nodes_nm[band]),
                };
                arriving(shares) * reflectance * self.tints[usize::from(surface.tint)][band]
            });
            *out = single(of_paths.chain(of_surfaces).sum());
        }
    }
}
