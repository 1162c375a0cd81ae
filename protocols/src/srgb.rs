//! The transfer curve of sRGB, and the limits of its gamut.
//!
//! Computed with the crate `libm`, so that a picture has the same bytes on every platform.
//!
//! Source: IEC 61966-2-1.

/// The 8-bit code of a linear primary: the transfer curve, rounded to the nearest code, clipped to 0 and 255.
///
/// ```
/// // Mid-grey: 255 · (1.055 · 0.2158605^(1/2.4) − 0.055) = 128.0, by the formula of the standard.
/// assert_eq!(protocols::srgb::srgb_encode(0.215_860_5), 128);
/// assert_eq!((protocols::srgb::srgb_encode(-0.1), protocols::srgb::srgb_encode(1.1)), (0, 255));
/// ```
pub fn srgb_encode(linear: f64) -> u8 {
    let code = 255.0 * encoded(linear.clamp(0.0, 1.0));
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "from 0 to 255 after the clamp; not-a-number becomes 0"
    )]
    let rounded = (code + 0.5) as u8;
    rounded
}

/// The 16-bit code of a linear primary: the transfer curve, rounded to the nearest code, clipped.
pub fn srgb_encode_16(linear: f64) -> u16 {
    let code = 65_535.0 * encoded(linear.clamp(0.0, 1.0));
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "from 0 to 65535 after the clamp; not-a-number becomes 0"
    )]
    let rounded = (code + 0.5) as u16;
    rounded
}

/// Whether a colour cannot be shown: a primary beyond `[0, 1]` by more than half an 8-bit code, the most
/// that rounding would hide.
///
/// ```
/// assert!(!protocols::srgb::is_out_of_srgb_gamut([0.0, 0.5, 1.0]));
/// assert!(!protocols::srgb::is_out_of_srgb_gamut([-0.000_1, 0.5, 1.004]));
/// assert!(protocols::srgb::is_out_of_srgb_gamut([-0.000_2, 0.5, 1.0]));
/// assert!(protocols::srgb::is_out_of_srgb_gamut([0.0, 0.5, 1.005]));
/// ```
pub fn is_out_of_srgb_gamut(linear: [f64; 3]) -> bool {
    let is_shown = |&primary: &f64| (-0.5..=255.5).contains(&(255.0 * encoded(primary)));
    !linear.iter().all(is_shown)
}

/// The transfer curve, prolonged beyond 0 and 1.
fn encoded(linear: f64) -> f64 {
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055
    }
}

/// The linear primary of an encoded one from 0 to 1: the inverse of the transfer curve.
pub fn srgb_decoded(encoded: f64) -> f64 {
    if encoded <= 0.040_45 {
        encoded / 12.92
    } else {
        libm::pow((encoded + 0.055) / 1.055, 2.4)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The inverse curve as the standard prints it.
    fn decoded(code: u8) -> f64 {
        let encoded = f64::from(code) / 255.0;
        if encoded <= 0.040_45 {
            encoded / 12.92
        } else {
            ((encoded + 0.055) / 1.055).powf(2.4)
        }
    }

    #[test]
    fn every_code_comes_back_through_the_inverse_curve_of_the_standard() {
        for code in 0..=255 {
            assert_eq!(srgb_encode(decoded(code)), code);
        }
    }

    #[test]
    fn every_code_is_decoded_as_the_standard_says() {
        for code in 0..=255 {
            let ours = srgb_decoded(f64::from(code) / 255.0);
            assert!((ours - decoded(code)).abs() < 1e-15);
        }
    }

    #[test]
    fn a_colour_that_is_not_a_number_is_out_of_gamut() {
        assert!(is_out_of_srgb_gamut([f64::NAN, 0.5, 0.5]));
    }
}
