//! The colour spaces of Meyer & Liu (1992) and the way to a display.
//!
//! XYZ are CIE 1931 2° tristimulus values with Y = 1 for the display's white, which is D65
//! (x = 0.3127, y = 0.3290). Both matrices of the paper are as printed; the inverse of Eq. 2 and the
//! product with the matrix of sRGB are worked out by the compiler.
//!
//! Not here: the spectral curves (the renderer's) and the transfer curve of sRGB ([`crate::srgb`]).
//!
//! Sources: Meyer & Liu (1992), Eqs. 1 and 2; IEC 61966-2-1 for sRGB.

use crate::PerChannel;

use crate::matrix3::{self, Matrix3};

/// Eq. 1: cone signals S, M, L from XYZ (confusion points of Estévez 1979).
pub const SML_FROM_XYZ: Matrix3 = [
    [0.0000, 0.0000, 0.5609],
    [-0.4227, 1.1723, 0.0911],
    [0.1150, 0.9364, -0.0203],
];

/// Eq. 2: opponent channels A, C1, C2 from XYZ.
pub const AC1C2_FROM_XYZ: Matrix3 = [
    [-0.0177, 1.0090, 0.0073],
    [-1.5370, 1.0821, 0.3209],
    [0.1946, -0.2045, 0.5264],
];

/// The inverse of Eq. 2.
pub const XYZ_FROM_AC1C2: Matrix3 = matrix3::inverse(&AC1C2_FROM_XYZ);

/// Linear sRGB from XYZ: the inverse of the primaries of ITU-R BT.709 scaled to the white
/// (0.3127, 0.3290), unrounded.
pub const LINEAR_SRGB_FROM_XYZ: Matrix3 = [
    [
        3.240_969_941_904_522,
        -1.537_383_177_570_094,
        -0.498_610_760_293_003_44,
    ],
    [
        -0.969_243_636_280_879_8,
        1.875_967_501_507_720_6,
        0.041_555_057_407_175_63,
    ],
    [
        0.055_630_079_696_993_64,
        -0.203_976_958_888_976_55,
        1.056_971_514_242_878_6,
    ],
];

/// Linear sRGB from the opponent channels.
pub const LINEAR_SRGB_FROM_AC1C2: Matrix3 =
    matrix3::product(&LINEAR_SRGB_FROM_XYZ, &XYZ_FROM_AC1C2);

/// The opponent channels of tristimulus values.
pub fn ac1c2_from_xyz(xyz: [f64; 3]) -> PerChannel<f64> {
    let [a, c1, c2] = matrix3::times(&AC1C2_FROM_XYZ, xyz);
    PerChannel { a, c1, c2 }
}

/// The tristimulus values of opponent channels.
pub fn xyz_from_ac1c2(ac1c2: PerChannel<f64>) -> [f64; 3] {
    matrix3::times(&XYZ_FROM_AC1C2, [ac1c2.a, ac1c2.c1, ac1c2.c2])
}

/// Linear sRGB, 1 for the full drive of a primary, not clipped.
///
/// ```
/// use protocols::PerChannel;
/// // The display's white in the opponent space, by color_reference.py (numpy): red, green, blue at full.
/// let white = PerChannel { a: 1.000_127_051_671_732_4, c1: -0.029_272_127_659_574_1, c2: 0.553_738_723_404_255_2 };
/// for primary in protocols::opponent::linear_srgb_from_ac1c2(white) {
///     assert!((primary - 1.0).abs() < 1e-12);
/// }
/// ```
#[inline]
pub fn linear_srgb_from_ac1c2(ac1c2: PerChannel<f64>) -> [f64; 3] {
    matrix3::times(&LINEAR_SRGB_FROM_AC1C2, [ac1c2.a, ac1c2.c1, ac1c2.c2])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// numpy's inverse of Eq. 2 (`color_reference.py`, `XYZ_from_ACC`).
    const NUMPY_XYZ_FROM_AC1C2: Matrix3 = [
        [
            0.731_102_828_809_128_8,
            -0.613_007_233_996_757_9,
            0.363_558_075_112_562_8,
        ],
        [
            1.003_041_564_411_791_4,
            -0.012_358_260_511_851,
            -0.006_376_211_287_904_81,
        ],
        [
            0.119_394_736_770_431,
            0.221_816_002_015_759_05,
            1.762_818_509_450_453_8,
        ],
    ];

    /// numpy's product (`color_reference.py`, `sRGB_linear_from_ACC`).
    const NUMPY_LINEAR_SRGB_FROM_AC1C2: Matrix3 = [
        [
            0.767_891_564_605_388_7,
            -2.078_338_483_148_808,
            0.309_123_196_291_470_1,
        ],
        [
            1.178_018_068_348_396,
            0.580_187_242_147_698_2,
            -0.291_083_891_521_588_3,
        ],
        [
            -0.037_729_223_597_737_005,
            0.202_872_354_648_190_06,
            1.884_774_314_149_958_2,
        ],
    ];

    fn largest_difference(left: &Matrix3, right: &Matrix3) -> f64 {
        let pairs = left.iter().flatten().zip(right.iter().flatten());
        pairs.fold(0.0, |most, (l, r)| f64::max(most, (l - r).abs()))
    }

    #[test]
    fn the_inverse_of_eq_2_and_the_way_to_srgb_agree_with_numpy() {
        assert!(largest_difference(&XYZ_FROM_AC1C2, &NUMPY_XYZ_FROM_AC1C2) < 1e-14);
        assert!(largest_difference(&LINEAR_SRGB_FROM_AC1C2, &NUMPY_LINEAR_SRGB_FROM_AC1C2) < 1e-14);
    }

    #[test]
    fn eq_2_is_the_karhunen_loeve_transform_of_eq_1() {
        // Section 2.3. A KL transform of SML has A = a sum of M and L with hardly any S: the rows of
        // (Eq. 2)(Eq. 1)^-1, by numpy, have these entries for A.
        let ac1c2_from_sml = matrix3::product(&AC1C2_FROM_XYZ, &matrix3::inverse(&SML_FROM_XYZ));
        let numpy = [
            9.984_673_142_191_187e-5,
            0.249_908_759_533_323_7,
            0.764_664_631_780_312_4,
        ];
        for (ours, theirs) in ac1c2_from_sml[0].iter().zip(numpy) {
            assert!((ours - theirs).abs() < 1e-13);
        }
    }

    #[test]
    fn the_primaries_of_srgb_come_back_from_the_opponent_space() {
        // `color_reference.py`, `sRGB_primaries_ACC`.
        let red = PerChannel {
            a: 0.207_394_554_753_970_2,
            c1: -0.397_544_730_492_384_8,
            c2: 0.046_942_315_808_319_375,
        };
        let [r, g, b] = linear_srgb_from_ac1c2(red);
        assert!((r - 1.0).abs() < 1e-12 && g.abs() < 1e-12 && b.abs() < 1e-12);
        let there_and_back = ac1c2_from_xyz(xyz_from_ac1c2(red));
        assert!((there_and_back.c1 - red.c1).abs() < 1e-15);
    }
}
