//! The spectral sensitivities of the opponent channels and of the cones: figures 3 and 4 of the paper.
//!
//! Sources: CIE 1931 2° colour-matching functions through Eqs. 1 and 2 of Meyer & Liu (1992).

use std::sync::LazyLock;

use protocols::PerChannel;

use super::cie;
use crate::matrix3;
use crate::opponent::{SML_FROM_XYZ, ac1c2_from_xyz};

/// The sensitivities at one wavelength, in the units of the colour-matching functions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sensitivity {
    pub(crate) wavelength_nm: f64,
    /// A, C1 and C2 (Eq. 2).
    pub(crate) ac1c2: PerChannel<f64>,
    /// The cones S, M and L (Eq. 1).
    pub(crate) sml: [f64; 3],
}

static SENSITIVITIES: LazyLock<Vec<Sensitivity>> = LazyLock::new(|| {
    let functions = cie::colour_matching().iter();
    let sensitivity = functions.map(|row| Sensitivity {
        wavelength_nm: row.wavelength_nm,
        ac1c2: ac1c2_from_xyz(row.xyz),
        sml: matrix3::times(&SML_FROM_XYZ, row.xyz),
    });
    sensitivity.collect()
});

/// The sensitivities from 360 to 830 nm at 1 nm.
pub(crate) fn sensitivities() -> &'static [Sensitivity] {
    &SENSITIVITIES
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sensitivities_sum_and_peak_as_numpy_says() {
        // `color_reference.py`, `sensitivities`: the sum at 1 nm, the peak, and where it is.
        type Curve = fn(&Sensitivity) -> f64;
        let curves: [(Curve, f64, f64, f64); 6] = [
            (
                |s| s.sml[0],
                59.955_863_742_186_93,
                1.000_066_863_379_999_8,
                446.0,
            ),
            (
                |s| s.sml[1],
                89.834_214_055_935_86,
                0.999_954_967_303_999_9,
                543.0,
            ),
            (|s| s.sml[2], 110.180_433_463_884_58, 1.000_006_33, 560.0),
            (
                |s| s.ac1c2.a,
                106.707_423_979_450_74,
                1.000_012_814_229_999_8,
                554.0,
            ),
            (
                |s| s.ac1c2.c1,
                -14.320_633_175_014_99,
                0.708_339_619_145,
                524.0,
            ),
            (|s| s.ac1c2.c2, 55.211_861_888_559_5, 0.999_999_016, 445.0),
        ];
        for (curve, sum, peak, peak_nm) in curves {
            let ours: f64 = sensitivities().iter().map(curve).sum();
            assert!((ours / sum - 1.0).abs() < 1e-12);
            let highest = sensitivities()
                .iter()
                .max_by(|l, r| curve(l).total_cmp(&curve(r)));
            let highest = highest.unwrap();
            assert!((curve(highest) - peak).abs() < 1e-9);
            assert_eq!(highest.wavelength_nm, peak_nm);
        }
    }
}
