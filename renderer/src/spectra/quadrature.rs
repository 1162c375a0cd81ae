//! At which wavelengths light is carried, and what each of them counts for each channel.
//!
//! - *N bands*: equal bands over 400–700 nm with light taken at their middles; a weight is the sum of the
//!   channel's sensitivity over the band at 1 nm, the end bands taking all that lies outside.
//! - *Meyer 1988*: his four wavelengths, found again on the tables used here: for C2 the node of its
//!   one-point Gauss rule, for C1 those of its two-point rule, for A these two and the middle node of its
//!   three-point rule. (A widely copied table has the weight +0.318 of C1 under 557.7 nm; its own Gauss
//!   rule puts it under 490.9 nm.)
//!
//! A few wavelengths do not give a light its exact colour. So the power of a light at the nodes is changed
//! by the least relative amount (in the sense of least squares) that makes the light itself exact in all
//! three channels; a neutral surface under it then is exact too.
//!
//! Source: Meyer (1988), *CVGIP* 41, 57–79.

use protocols::{Channel, PerChannel, Quadrature};

use super::{Emission, cie, sensitivities};
use crate::matrix3::{self, Matrix3};

/// Meyer's wavelengths in nm. `wavelengths.py` (numpy), `rederived_4`.
const MEYER_1988_NM: [f64; 4] = [
    456.388_861_951_886_7,
    490.870_916_483_570_6,
    557.784_382_046_052_9,
    631.453_095_649_344_8,
];

/// The weights of A, C1 and C2 at Meyer's wavelengths. `wavelengths.py` (numpy), `rederived_4`.
const MEYER_1988_WEIGHTS: [[f64; 4]; 3] = [
    [
        0.0,
        0.178_782_084_051_911_82,
        0.638_094_767_128_494_7,
        0.181_724_146_061_730_68,
    ],
    [0.0, 0.300_823_830_879_853_04, 0.0, -0.434_840_734_637_765_4],
    [0.516_689_638_690_258_7, 0.0, 0.0, 0.0],
];

/// Wavelengths and their weights for each channel.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct WavelengthRule {
    pub(crate) nodes_nm: Vec<f64>,
    pub(crate) weights: PerChannel<Vec<f64>>,
}

impl WavelengthRule {
    /// The rule of a quadrature.
    pub(crate) fn new(quadrature: Quadrature) -> Self {
        match quadrature {
            Quadrature::Bands(count) => Self::bands(count),
            Quadrature::Meyer1988 => {
                let [a, c1, c2] = MEYER_1988_WEIGHTS.map(Vec::from);
                Self {
                    nodes_nm: Vec::from(MEYER_1988_NM),
                    weights: PerChannel { a, c1, c2 },
                }
            }
        }
    }

    fn bands(count: u32) -> Self {
        let edge_nm = |edge: u32| 400.0 + 300.0 * f64::from(edge) / f64::from(count);
        let nodes_nm = (0..count).map(|band| 0.5 * (edge_nm(band) + edge_nm(band + 1)));
        let weight = |band: u32, channel: Channel| {
            let is_in_band = |nm: f64| {
                (band == 0 || edge_nm(band) <= nm) && (band + 1 == count || nm < edge_nm(band + 1))
            };
            let rows = sensitivities().iter();
            let inside = rows.filter(|row| is_in_band(row.wavelength_nm));
            inside.map(|row| row.ac1c2[channel]).sum::<f64>() / cie::sum_of_y()
        };
        Self {
            nodes_nm: nodes_nm.collect(),
            weights: PerChannel::from_fn(|channel| {
                (0..count).map(|band| weight(band, channel)).collect()
            }),
        }
    }

    /// The wavelengths that count for a channel, as places in `nodes_nm`: all others need no shading.
    pub(crate) fn nodes_of(&self, channel: Channel) -> Vec<usize> {
        let weights = self.weights[channel].iter().enumerate();
        let counting = weights.filter(|&(_, &weight)| weight != 0.0);
        counting.map(|(node, _)| node).collect()
    }

    /// The power of a light of Y = 1 at the nodes, such that its own channels are exact.
    ///
    /// Where that cannot be had with powers of zero or more (a light of few lines), the power is as emitted.
    pub(crate) fn power_at_nodes(&self, light: &Emission) -> Vec<f64> {
        let emitted: Vec<f64> = self.nodes_nm.iter().map(|&nm| light.at(nm)).collect();
        let rows = Channel::ALL.map(|channel| {
            let weights = self.weights[channel].iter();
            weights
                .zip(&emitted)
                .map(|(weight, power)| weight * power)
                .collect::<Vec<f64>>()
        });
        let exact = light.ac1c2();
        let missing = [0, 1, 2].map(|row| exact[Channel::ALL[row]] - rows[row].iter().sum::<f64>());
        let gram: Matrix3 =
            [0, 1, 2].map(|row| [0, 1, 2].map(|column| dot(&rows[row], &rows[column])));
        let multipliers = matrix3::times(&matrix3::inverse(&gram), missing);
        let corrected: Vec<f64> = (0..emitted.len())
            .map(|node| {
                let change: f64 = (0..3).map(|row| rows[row][node] * multipliers[row]).sum();
                emitted[node] * (1.0 + change)
            })
            .collect();
        let is_light = |&power: &f64| power.is_finite() && power >= 0.0;
        if corrected.iter().all(is_light) {
            corrected
        } else {
            emitted
        }
    }
}

fn dot(left: &[f64], right: &[f64]) -> f64 {
    left.iter().zip(right).map(|(l, r)| l * r).sum()
}

#[cfg(test)]
mod tests {
    use super::super::colour_difference::{ciede2000, lab_from_xyz};
    use super::super::{Spectrum, measured};
    use super::*;
    use crate::opponent::xyz_from_ac1c2;

    /// The channels of a surface under a light, summed at 1 nm: the slow way that judges the rules.
    fn at_1_nm(surface: &Spectrum, light: &Emission) -> PerChannel<f64> {
        PerChannel::from_fn(|channel| {
            let products = sensitivities().iter().map(|row| {
                let nm = row.wavelength_nm;
                row.ac1c2[channel] * surface.at(nm) * light.at(nm)
            });
            products.sum::<f64>() / cie::sum_of_y()
        })
    }

    fn by_rule(rule: &WavelengthRule, powers: &[f64], surface: &Spectrum) -> PerChannel<f64> {
        PerChannel::from_fn(|channel| {
            let nodes = rule.nodes_nm.iter().zip(&rule.weights[channel]);
            nodes
                .zip(powers)
                .map(|((&nm, weight), power)| weight * power * surface.at(nm))
                .sum()
        })
    }

    /// The mean and the largest CIEDE2000 over the `ColorChecker`, with light as emitted or as corrected.
    fn colour_errors(quadrature: Quadrature, light: &str, corrected: Light) -> (f64, f64) {
        let (rule, light) = (
            WavelengthRule::new(quadrature),
            Emission::named(light).unwrap(),
        );
        let powers = match corrected {
            Light::AsEmitted => rule.nodes_nm.iter().map(|&nm| light.at(nm)).collect(),
            Light::Corrected => rule.power_at_nodes(&light),
        };
        let white = xyz_from_ac1c2(light.ac1c2());
        let lab = |channels| lab_from_xyz(xyz_from_ac1c2(channels), white);
        let errors = measured::names().into_iter().map(|name| {
            let patch = measured::reflectance(&name).unwrap();
            let exact = lab(at_1_nm(&patch, &light));
            ciede2000(lab(by_rule(&rule, &powers, &patch)), exact)
        });
        let errors: Vec<f64> = errors.collect();
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        (mean, errors.into_iter().fold(0.0, f64::max))
    }

    #[derive(Clone, Copy)]
    enum Light {
        AsEmitted,
        Corrected,
    }

    #[test]
    fn the_rules_are_as_far_off_as_colour_science_says() {
        // `renderer/data/quadrature_errors.py` (colour-science 0.4.7, numpy).
        for (quadrature, light, mean, most) in [
            (Quadrature::Bands(8), "E", 0.457_479_824, 1.340_461_600),
            (Quadrature::Bands(8), "D65", 0.740_370_178, 1.676_121_150),
            (Quadrature::Bands(16), "E", 0.131_008_910, 0.279_503_191),
            (Quadrature::Bands(16), "D65", 0.211_886_586, 0.366_456_692),
            (Quadrature::Bands(16), "A", 0.183_561_145, 0.399_346_863),
            (Quadrature::Meyer1988, "E", 3.559_483_020, 17.885_503_102),
            (Quadrature::Meyer1988, "D65", 4.662_976_023, 10.677_502_620),
            (Quadrature::Meyer1988, "A", 7.484_907_977, 28.457_472_166),
        ] {
            let ours = colour_errors(quadrature, light, Light::AsEmitted);
            assert!((ours.0 - mean).abs() < 1e-6, "{light}: mean {}", ours.0);
            assert!((ours.1 - most).abs() < 1e-6, "{light}: most {}", ours.1);
        }
    }

    #[test]
    fn correcting_the_light_makes_colours_better_and_white_exact() {
        for quadrature in [Quadrature::Bands(16), Quadrature::Meyer1988] {
            let (raw, _) = colour_errors(quadrature, "D65", Light::AsEmitted);
            let (mean, _) = colour_errors(quadrature, "D65", Light::Corrected);
            assert!(mean < raw, "{mean} is not below {raw}");
        }
        for quadrature in [
            Quadrature::Bands(3),
            Quadrature::Bands(16),
            Quadrature::Bands(301),
            Quadrature::Meyer1988,
        ] {
            for light in ["D65", "A", "E", "blackbody 5000 K"] {
                let (rule, light) = (
                    WavelengthRule::new(quadrature),
                    Emission::named(light).unwrap(),
                );
                let white = Spectrum::constant(1.0);
                let ours = by_rule(&rule, &rule.power_at_nodes(&light), &white);
                let exact = light.ac1c2();
                for channel in Channel::ALL {
                    assert!((ours[channel] - exact[channel]).abs() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn meyers_rule_shades_a_without_the_wavelength_of_c2() {
        let rule = WavelengthRule::new(Quadrature::Meyer1988);
        assert_eq!(rule.nodes_of(Channel::A), [1, 2, 3]);
        assert_eq!(rule.nodes_of(Channel::C1), [1, 3]);
        assert_eq!(rule.nodes_of(Channel::C2), [0]);
    }

    #[test]
    fn a_light_of_one_line_keeps_its_powers() {
        let line = Spectrum::of_points(vec![[588.0, 0.0], [589.0, 1.0], [590.0, 0.0]]);
        let light = Emission::of(line).unwrap();
        let rule = WavelengthRule::new(Quadrature::Meyer1988);
        assert_eq!(rule.power_at_nodes(&light), [0.0; 4]);
    }
}
