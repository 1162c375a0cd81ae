//! From the opponent space of the stimuli to the codes of one display.
//!
//! The colours are reproduced as they are, white point included: nothing is adapted to the display's own white.
//! The stimuli's white (D65, Y = 1) becomes the brightest D65 that the display has.
//!
//! A code is the nearest in the display's own steps; a primary beyond the first or last code by more than half a
//! step is out of gamut, is clipped, and is counted.
//!
//! Not here: where the numbers of a display come from (`display_color`).

use protocols::PerChannel;
use protocols::matrix3::{self, Matrix3};
use protocols::opponent::{
    LINEAR_SRGB_FROM_XYZ, XYZ_FROM_AC1C2, ac1c2_from_xyz, linear_srgb_from_ac1c2,
};
use protocols::srgb::{is_out_of_srgb_gamut, srgb_decoded, srgb_encode};

/// The white of the stimuli: D65, Y = 1.
const WHITE_XYZ: [f64; 3] = [0.3127 / 0.3290, 1.0, (1.0 - 0.3127 - 0.3290) / 0.3290];

const XYZ_FROM_LINEAR_SRGB: Matrix3 = matrix3::inverse(&LINEAR_SRGB_FROM_XYZ);

/// How colours get to one display.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Display {
    /// IEC 61966-2-1, by declaration: the bytes of the set's PNG files.
    #[default]
    Srgb,
    /// By its primaries, white and transfer curves.
    Characterised(Box<Characterised>),
}

/// A display whose colours are known.
#[derive(Clone, Debug, PartialEq)]
pub struct Characterised {
    rgb_from_ac1c2: Matrix3,
    /// With the display's own white at Y = 1.
    xyz_from_rgb: Matrix3,
    curves: [Steps; 3],
    /// The luminance of the stimuli's white, as a part of that of the display's own.
    white_luminance: f64,
}

/// Where the codes of one primary begin, in linear light from 0 to 1.
#[derive(Clone, Debug, PartialEq)]
struct Steps {
    /// Between each code and the next: 255 of them, rising.
    limits: Vec<f64>,
    /// At each code.
    lights: Vec<f64>,
}

impl Steps {
    fn of(decoded: impl Fn(f64) -> f64) -> Self {
        let limits = (0..255).map(|code| decoded((f64::from(code) + 0.5) / 255.0));
        let lights = (0..=255).map(|code| decoded(f64::from(code) / 255.0));
        Self {
            limits: limits.collect(),
            lights: lights.collect(),
        }
    }

    fn code(&self, linear: f64) -> u8 {
        let below = self.limits.partition_point(|&limit| limit <= linear);
        u8::try_from(below).unwrap_or(u8::MAX)
    }

    fn is_in(&self, linear: f64) -> bool {
        let first = self.limits.first().copied().unwrap_or(0.0);
        let last = self.limits.last().copied().unwrap_or(1.0);
        (-first..=2.0 - last).contains(&linear)
    }
}

impl Characterised {
    /// A display with these primaries (columns of `xyz_from_rgb`, any unit) and curves from codes (0 to 1) to linear
    /// light (0 to 1).
    ///
    /// ```text
    /// rgb = s · (XYZ from RGB)⁻¹ · (XYZ from AC1C2) · AC1C2,   s = 1 / max(rgb of the stimuli's white at s = 1)
    /// ```
    pub(crate) fn new(xyz_from_rgb: &Matrix3, decoded: [&dyn Fn(f64) -> f64; 3]) -> Self {
        let rgb_from_xyz = matrix3::inverse(xyz_from_rgb);
        let white = matrix3::times(&rgb_from_xyz, WHITE_XYZ);
        let most = white.into_iter().fold(f64::MIN, f64::max);
        let scaled = rgb_from_xyz.map(|row| row.map(|entry| entry / most));
        let full: f64 = xyz_from_rgb[1].iter().sum();
        Self {
            rgb_from_ac1c2: matrix3::product(&scaled, &XYZ_FROM_AC1C2),
            xyz_from_rgb: xyz_from_rgb.map(|row| row.map(|entry| entry / full)),
            curves: decoded.map(Steps::of),
            white_luminance: 1.0 / most / full,
        }
    }
}

impl Display {
    /// The codes of a colour, and whether the display has it.
    pub fn shown(&self, ac1c2: PerChannel<f64>) -> ([u8; 3], bool) {
        match self {
            Self::Srgb => {
                let linear = linear_srgb_from_ac1c2(ac1c2);
                (linear.map(srgb_encode), !is_out_of_srgb_gamut(linear))
            }
            Self::Characterised(display) => {
                let channels = [ac1c2.a, ac1c2.c1, ac1c2.c2];
                let linear = matrix3::times(&display.rgb_from_ac1c2, channels);
                let [red, green, blue] = &display.curves;
                let curves = [red, green, blue];
                let codes = [0, 1, 2].map(|primary| curves[primary].code(linear[primary]));
                let is_in = (0..3).all(|primary| curves[primary].is_in(linear[primary]));
                (codes, is_in)
            }
        }
    }

    /// The codes of a neutral grey that is named by its sRGB code.
    pub fn grey(&self, srgb: u8) -> [u8; 3] {
        match self {
            Self::Srgb => [srgb; 3],
            Self::Characterised(_) => self.shown(ac1c2_of_srgb([srgb; 3])).0,
        }
    }

    /// The tristimulus values that codes should give, with the display's own white at Y = 1 and no light at black.
    pub fn xyz(&self, codes: [u8; 3]) -> [f64; 3] {
        match self {
            Self::Srgb => {
                let linear = codes.map(|code| srgb_decoded(f64::from(code) / 255.0));
                matrix3::times(&XYZ_FROM_LINEAR_SRGB, linear)
            }
            Self::Characterised(display) => {
                let light = |primary: usize| {
                    let lights = &display.curves[primary].lights;
                    lights
                        .get(usize::from(codes[primary]))
                        .copied()
                        .unwrap_or(1.0)
                };
                matrix3::times(&display.xyz_from_rgb, [light(0), light(1), light(2)])
            }
        }
    }

    /// The luminance of the stimuli's white as a part of the display's own, where that is known.
    pub fn white_luminance(&self) -> Option<f64> {
        match self {
            Self::Srgb => None,
            Self::Characterised(display) => Some(display.white_luminance),
        }
    }
}

/// The opponent channels of 8-bit sRGB.
pub(crate) fn ac1c2_of_srgb(rgb: [u8; 3]) -> PerChannel<f64> {
    let linear = rgb.map(|code| srgb_decoded(f64::from(code) / 255.0));
    ac1c2_from_xyz(matrix3::times(&XYZ_FROM_LINEAR_SRGB, linear))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// sRGB's own primaries, as columns.
    fn srgb_by_its_numbers() -> Display {
        let matrix = matrix3::inverse(&LINEAR_SRGB_FROM_XYZ);
        let curve: &dyn Fn(f64) -> f64 = &srgb_decoded;
        Display::Characterised(Box::new(Characterised::new(&matrix, [curve; 3])))
    }

    #[test]
    fn a_display_with_the_numbers_of_srgb_gets_the_codes_of_srgb() {
        let display = srgb_by_its_numbers();
        for code in 0..=255 {
            for rgb in [[code; 3], [code, 255 - code, 7], [200, code, code / 2]] {
                assert_eq!(display.shown(ac1c2_of_srgb(rgb)), (rgb, true));
            }
        }
        assert!((display.white_luminance().unwrap() - 1.0).abs() < 1e-9);
        assert_eq!(display.grey(128), [128; 3]);
    }

    /// A meter on an sRGB display: white is D65, red (.64, .33) has Y = .2126, code 128 gives .2159 of the light.
    #[test]
    fn what_a_meter_should_read_is_what_the_standard_says() {
        for display in [Display::Srgb, srgb_by_its_numbers()] {
            for (codes, x, y, luminance) in [
                ([255, 255, 255], 0.3127, 0.3290, 1.0),
                ([255, 0, 0], 0.64, 0.33, 0.2126),
                ([0, 255, 0], 0.30, 0.60, 0.7152),
                ([0, 0, 255], 0.15, 0.06, 0.0722),
                ([128, 128, 128], 0.3127, 0.3290, 0.2159),
            ] {
                let xyz = display.xyz(codes);
                let sum: f64 = xyz.iter().sum();
                let found = [xyz[0] / sum, xyz[1] / sum, xyz[1]];
                for (found, expected) in found.into_iter().zip([x, y, luminance]) {
                    assert!(
                        (found - expected).abs() < 2e-4,
                        "{codes:?}: {found} {expected}"
                    );
                }
            }
        }
    }

    #[test]
    fn what_a_display_lacks_is_clipped_and_said() {
        for display in [Display::Srgb, srgb_by_its_numbers()] {
            // The green of BT.2020 (0.170, 0.797) is outside sRGB; Y = .4.
            let green = ac1c2_from_xyz([0.4 * 0.170 / 0.797, 0.4, 0.4 * 0.033 / 0.797]);
            let (codes, is_in) = display.shown(green);
            assert!(!is_in && codes[0] == 0 && codes[2] == 0, "{codes:?}");
        }
    }

    /// A display with a white of 9300 K shows the stimuli's white darker, with less blue and at full red.
    #[test]
    fn the_stimulis_white_keeps_its_colour_on_a_blue_display() {
        let srgb = matrix3::inverse(&LINEAR_SRGB_FROM_XYZ);
        // The columns scaled so that red is weak: the display's own white is blue.
        let blue = srgb.map(|[red, green, blue]| [0.8 * red, 0.95 * green, 1.2 * blue]);
        let curve: &dyn Fn(f64) -> f64 = &|code| code;
        let display = Characterised::new(&blue, [curve; 3]);
        // Red is at its full drive 1; green needs 0.8/0.95, blue 0.8/1.2 of theirs: codes 215 and 170, by hand.
        let display = Display::Characterised(Box::new(display));
        assert_eq!(
            display.shown(ac1c2_from_xyz(WHITE_XYZ)),
            ([255, 215, 170], true)
        );
        // Y of the stimuli's white is .8; the display's own is .8·.2126 + .95·.7152 + 1.2·.0722 = .93617.
        let luminance = display.white_luminance().unwrap();
        assert!((luminance - 0.8 / 0.936_17).abs() < 1e-3, "{luminance}");
    }
}
