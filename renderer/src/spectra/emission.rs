//! What a light emits: a spectrum of Y = 1, to be scaled by how bright the light is.
//!
//! Sources: CIE 015 for D65, A and E; Planck's law with c2 = 1.438 776 877 × 10⁻² m·K (CODATA 2018).

use protocols::PerChannel;

use super::uplift::sigmoid_of_linear_srgb;
use super::{Spectrum, cie, sensitivities};

/// Planck's second radiation constant, in nm·K.
const C2_NM_K: f64 = 1.438_776_877e7;

/// A spectrum scaled so that Y = 1.
#[derive(Clone, Debug)]
pub(crate) struct Emission {
    spectrum: Spectrum,
    scale: f64,
}

impl Emission {
    /// The emission of a spectrum; `None` if it has no light that is seen.
    pub(crate) fn of(spectrum: Spectrum) -> Option<Self> {
        let functions = cie::colour_matching().iter();
        let y: f64 = functions
            .map(|row| spectrum.at(row.wavelength_nm) * row.xyz[1])
            .sum();
        let scale = cie::sum_of_y() / y;
        let is_seen = scale.is_finite() && scale > 0.0;
        is_seen.then_some(Self { spectrum, scale })
    }

    /// The emission of a name: `D65`, `A`, `E` or `blackbody 3200 K`.
    pub(crate) fn named(name: &str) -> Option<Self> {
        let spectrum = match name {
            "D65" => cie::d65(),
            "A" => cie::a(),
            "E" => Spectrum::constant(1.0),
            _ => {
                let kelvin = name.strip_prefix("blackbody ")?.strip_suffix(" K")?;
                let kelvin: f64 = kelvin.parse().ok()?;
                if !(500.0..=100_000.0).contains(&kelvin) {
                    return None;
                }
                blackbody(kelvin)
            }
        };
        Self::of(spectrum)
    }

    /// D65 seen through a filter of a linear sRGB colour, whose largest primary is taken as 1; `None` for
    /// black.
    pub(crate) fn of_linear_srgb(rgb: [f64; 3]) -> Option<Self> {
        let largest = rgb.into_iter().fold(0.0, f64::max);
        let filter = sigmoid_of_linear_srgb(rgb.map(|primary| primary / largest));
        let is_light = largest > 0.0 && largest.is_finite();
        is_light.then(|| Self::of(cie::d65().times(Spectrum::Sigmoid(filter))))?
    }

    /// Power per nm at a wavelength, for Y = 1.
    pub(crate) fn at(&self, wavelength_nm: f64) -> f64 {
        self.scale * self.spectrum.at(wavelength_nm)
    }

    /// The opponent channels of the light itself, summed at 1 nm.
    pub(crate) fn ac1c2(&self) -> PerChannel<f64> {
        PerChannel::from_fn(|channel| {
            let products = sensitivities()
                .iter()
                .map(|row| row.ac1c2[channel] * self.at(row.wavelength_nm));
            products.sum::<f64>() / cie::sum_of_y()
        })
    }
}

/// Planck's law at 1 nm, 1 at 560 nm.
fn blackbody(kelvin: f64) -> Spectrum {
    let power = |nm: f64| libm::pow(nm, -5.0) / libm::expm1(C2_NM_K / (nm * kelvin));
    let reference = power(560.0);
    let points = (360..=830).map(|nm| {
        let nm = f64::from(nm);
        [nm, power(nm) / reference]
    });
    Spectrum::of_points(points.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::opponent::linear_srgb_from_ac1c2;

    #[test]
    fn d65_and_e_have_the_opponent_channels_that_numpy_says() {
        // `color_reference.py`, `D65_spectral_ACC` and `E_ACC`.
        let d65 = Emission::named("D65").unwrap().ac1c2();
        assert!((d65.a - 1.000_125_114_944_255_4).abs() < 1e-9);
        assert!((d65.c1 - -0.029_368_524_960_972_5).abs() < 1e-9);
        assert!((d65.c2 - 0.553_620_892_428_914_4).abs() < 1e-9);
        // Eq. 2 on X = Y = Z = 1; the sums of the three functions are equal to 4 digits only.
        let e = Emission::named("E").unwrap().ac1c2();
        assert!((e.a - 0.9986).abs() < 1e-5);
        assert!((e.c1 - -0.1340).abs() < 1e-3);
        assert!((e.c2 - 0.5165).abs() < 1e-3);
    }

    #[test]
    fn a_blackbody_at_the_temperature_of_illuminant_a_is_illuminant_a() {
        // CIE 015: A is Planck's law at 2848 K with c2 = 1.435e-2, that is at 2855.5 K with today's c2.
        let lamp = Emission::named("blackbody 2855.5 K").unwrap();
        let a = Emission::named("A").unwrap();
        for nm in 380..=780 {
            let nm = f64::from(nm);
            assert!((lamp.at(nm) / a.at(nm) - 1.0).abs() < 1e-3, "at {nm} nm");
        }
    }

    #[test]
    fn a_light_of_an_rgb_colour_has_that_colour() {
        let [r, g, b] = [0.9, 0.5, 0.2];
        let light = Emission::of_linear_srgb([r, g, b]).unwrap();
        let ours = linear_srgb_from_ac1c2(light.ac1c2());
        // The luminance of the colour by the second row of the sRGB matrix (IEC 61966-2-1).
        let y = 0.212_639 * r + 0.715_169 * g + 0.072_192 * b;
        for (ours, theirs) in ours.into_iter().zip([r, g, b]) {
            assert!((ours - theirs / y).abs() < 0.01, "{ours} {}", theirs / y);
        }
        assert!(Emission::of_linear_srgb([0.0; 3]).is_none());
        let white = Emission::of_linear_srgb([5.0; 3]).unwrap();
        let d65 = Emission::named("D65").unwrap();
        assert!((white.at(450.0) / d65.at(450.0) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn names_of_no_light_are_refused() {
        for name in [
            "",
            "d65",
            "D50",
            "blackbody",
            "blackbody K",
            "blackbody -1 K",
            "blackbody NaN K",
        ] {
            assert!(Emission::named(name).is_none(), "{name:?} was taken");
        }
        assert!(Emission::of(Spectrum::constant(0.0)).is_none());
    }
}
