//! The tables of the CIE: colour-matching functions and standard illuminants.

use std::sync::LazyLock;

use super::Spectrum;
use super::table::Table;

/// The colour-matching functions at one wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ColourMatching {
    pub(crate) wavelength_nm: f64,
    pub(crate) xyz: [f64; 3],
}

static COLOUR_MATCHING: LazyLock<Vec<ColourMatching>> = LazyLock::new(|| {
    let table = Table::compiled_in(include_str!("../../data/cie_1931_2deg.csv"));
    let row = |row: &Vec<f64>| ColourMatching {
        wavelength_nm: row[0],
        xyz: [row[1], row[2], row[3]],
    };
    table.rows.iter().map(row).collect()
});

static ILLUMINANTS: LazyLock<Table> =
    LazyLock::new(|| Table::compiled_in(include_str!("../../data/cie_illuminants.csv")));

/// The CIE 1931 2° colour-matching functions, 360–830 nm at 1 nm.
pub(crate) fn colour_matching() -> &'static [ColourMatching] {
    &COLOUR_MATCHING
}

/// The sum of ȳ over the table: what every sum over wavelengths is divided by.
pub(crate) fn sum_of_y() -> f64 {
    colour_matching().iter().map(|row| row.xyz[1]).sum()
}

/// Standard illuminant D65: daylight, and the white of the display.
pub(crate) fn d65() -> Spectrum {
    Spectrum::of_points(ILLUMINANTS.column(1))
}

/// Standard illuminant A: an incandescent lamp.
pub(crate) fn a() -> Spectrum {
    Spectrum::of_points(ILLUMINANTS.column(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_functions_cover_360_to_830_nm_and_sum_as_numpy_says() {
        // `color_reference.py`, `cmf_sums_1nm_360_830`.
        let numpy = [
            106.865_469_489_594_84,
            106.856_917_101_172_03,
            106.892_251_278_635_97,
        ];
        for (function, theirs) in numpy.into_iter().enumerate() {
            let ours: f64 = colour_matching().iter().map(|row| row.xyz[function]).sum();
            assert!((ours / theirs - 1.0).abs() < 1e-12);
        }
        let nms = colour_matching().iter().map(|row| row.wavelength_nm);
        assert!(nms.eq((360..=830).map(f64::from)));
    }
}
