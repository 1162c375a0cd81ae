//! Smooth reflectances of three numbers: a sigmoid of a quadratic in the wavelength.
//!
//! ```text
//! x = c0 t² + c1 t + c2,   t = (λ − 595 nm) / 235 nm, from −1 at 360 nm to 1 at 830 nm
//! reflectance = 1/2 + x / (2 √(1 + x²)), above 0 and below 1
//! ```
//!
//! Source: Jakob & Hanika (2019), *Comput. Graph. Forum* 38(2), 147–155.

/// A reflectance by its coefficients c0, c1, c2.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Sigmoid {
    pub(crate) coefficients: [f32; 3],
}

impl Sigmoid {
    /// The wavelength in the unit of the quadratic.
    pub(crate) fn t(wavelength_nm: f64) -> f64 {
        (wavelength_nm - 595.0) / 235.0
    }

    /// The reflectance at a wavelength.
    pub(crate) fn at(self, wavelength_nm: f64) -> f64 {
        let t = Self::t(wavelength_nm);
        let [c0, c1, c2] = self.coefficients.map(f64::from);
        sigmoid((c0 * t + c1) * t + c2)
    }

    /// The reflectance at a wavelength in the unit of the quadratic, in single precision.
    #[inline]
    pub(crate) fn single_at(self, t: f32) -> f32 {
        let [c0, c1, c2] = self.coefficients;
        let x = (c0 * t + c1) * t + c2;
        0.5 + 0.5 * x / (1.0 + x * x).sqrt()
    }

    /// The largest reflectance from 360 to 830 nm: that of an end, or of the quadratic's top.
    pub(crate) fn peak(self) -> f64 {
        let [c0, c1, _] = self.coefficients.map(f64::from);
        let top = (-c1 / (2.0 * c0)).clamp(-1.0, 1.0);
        let top_nm = 595.0 + 235.0 * if top.is_finite() { top } else { 0.0 };
        [360.0, top_nm, 830.0]
            .into_iter()
            .map(|nm| self.at(nm))
            .fold(0.0, f64::max)
    }

    /// The same reflectance at every wavelength; 0 and 1 are met within 1e-6.
    pub(crate) fn constant(reflectance: f64) -> Self {
        let s = reflectance.clamp(1e-6, 1.0 - 1e-6);
        let x = (s - 0.5) / (s * (1.0 - s)).sqrt();
        Self::rounded([0.0, 0.0, x])
    }

    /// The coefficients in single precision.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "rounding to the nearest single is meant"
    )]
    pub(crate) fn rounded(coefficients: [f64; 3]) -> Self {
        Self {
            coefficients: coefficients.map(|coefficient| coefficient as f32),
        }
    }
}

/// 1/2 + x / (2 √(1 + x²)).
#[inline]
pub(crate) fn sigmoid(x: f64) -> f64 {
    0.5 + 0.5 * x / (1.0 + x * x).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_formula_at_places_worked_out_by_hand() {
        // At 595 nm t = 0; x = 3/4 gives 1/2 + 3/4 / (2 · 5/4) = 0.8.
        let curve = Sigmoid {
            coefficients: [-1.0, 0.25, 0.75],
        };
        assert!((curve.at(595.0) - 0.8).abs() < 1e-12);
        // At 830 nm x = −1 + 1/4 + 3/4 = 0.
        assert!((curve.at(830.0) - 0.5).abs() < 1e-12);
        let most = (360..=830).map(|nm| curve.at(f64::from(nm)));
        assert!((curve.peak() - most.fold(0.0, f64::max)).abs() < 1e-6);
    }

    #[test]
    fn a_constant_is_level() {
        for reflectance in [0.0, 0.18, 0.5, 1.0] {
            let level = Sigmoid::constant(reflectance);
            for nm in [360.0, 500.0, 830.0] {
                assert!((level.at(nm) - reflectance).abs() < 2e-6);
            }
            assert!((level.peak() - reflectance).abs() < 2e-6);
        }
    }
}
