//! The confusion axes of the three kinds of dichromats, in the opponent space of the stimuli.
//!
//! All colours on a line through a dichromat's copunctal point differ only in the cone that he lacks. So white
//! and white plus a part of the copunctal point's tristimulus values look alike to him.
//!
//! Sources: the points are those of Smith & Pokorny (1975), *Vision Research* 15, 161–171, which are chromaticities
//! (x', y') of Judd's corrected observer; Vos (1978), *Color Res. Appl.* 3, 125–128, gives the way there from the
//! CIE 1931 (x, y) of a display. It keeps lines straight, so the way back carries the points over. Eq. 1 of
//! Meyer & Liu has the points of Estévez (1979), on lines that differ by 5° at most.

use protocols::PerChannel;
use protocols::matrix3::{self, Matrix3};
use protocols::opponent::ac1c2_from_xyz;
use serde::{Deserialize, Serialize};

/// The white of the display: D65, Y = 1.
const WHITE_XYZ: [f64; 3] = [0.3127 / 0.3290, 1.0, (1.0 - 0.3127 - 0.3290) / 0.3290];

/// Vos (1978): x' and y' from x and y, with a common divisor, in homogeneous coordinates.
const JUDD_FROM_CIE: Matrix3 = [
    [1.0271, -0.00008, -0.00009],
    [0.00376, 1.0072, 0.00764],
    [0.03845, 0.01496, 1.0],
];
const CIE_FROM_JUDD: Matrix3 = matrix3::inverse(&JUDD_FROM_CIE);

/// Which cone a plate is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Axis {
    /// No cone: the digit differs in luminance, and everybody sees it.
    Control,
    /// The long-wavelength cone.
    Protan,
    /// The middle-wavelength cone.
    Deutan,
    /// The short-wavelength cone.
    Tritan,
}

impl Axis {
    /// The three axes of confusion.
    pub const CONFUSED: [Self; 3] = [Self::Protan, Self::Deutan, Self::Tritan];

    /// The word in the data.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Control => "control",
            Self::Protan => "protan",
            Self::Deutan => "deutan",
            Self::Tritan => "tritan",
        }
    }

    /// The copunctal point, as chromaticities x and y of CIE 1931; the control has none.
    pub fn copunctal_point(self) -> Option<[f64; 2]> {
        let judd = match self {
            Self::Control => return None,
            Self::Protan => [0.7465, 0.2535],
            Self::Deutan => [1.4000, -0.4000],
            Self::Tritan => [0.1748, 0.0044],
        };
        let [x, y, divisor] = matrix3::times(&CIE_FROM_JUDD, [judd[0], judd[1], 1.0]);
        Some([x / divisor, y / divisor])
    }

    /// White plus `excursion` times the copunctal point (as X, Y, Z with the sum 1), in AC1C2.
    ///
    /// For the control the excursion is added to the luminance alone.
    pub fn color(self, excursion: f64) -> PerChannel<f64> {
        let Some([x, y]) = self.copunctal_point() else {
            return ac1c2_from_xyz(WHITE_XYZ.map(|value| value * (1.0 + excursion)));
        };
        let point = [x, y, 1.0 - x - y];
        let [a, b, c] = [0, 1, 2].map(|i| WHITE_XYZ[i] + excursion * point[i]);
        ac1c2_from_xyz([a, b, c])
    }
}
