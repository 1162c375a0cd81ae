//! What a display's colours are taken for: sRGB by declaration, a colorimeter's readings, or an ICC profile.
//!
//! A profile is read for its primaries and curves alone; its white is taken out of the profile's connection space
//! (D50) by the chromatic adaptation that the profile names, or by Bradford's where it names none.
//!
//! Sources: ICC.1:2022; Lindbloom, "RGB/XYZ Matrices" and "Chromatic Adaptation".

use std::fs;
use std::path::{Path, PathBuf};

use moxcms::{ColorProfile, DataColorSpace, ToneReprCurve, Xyzd};
use protocols::matrix3::{self, Matrix3};
use protocols::srgb::srgb_decoded;
use protocols::{InputError, ReadError, Sha256Digest};
use serde::{Deserialize, Serialize};

use crate::Calibration;
use crate::display::{Characterised, Display};

/// What the display's colours are taken for.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum DisplayColor {
    /// IEC 61966-2-1 by declaration; nothing was measured.
    #[default]
    #[serde(rename = "sRGB, declared")]
    Srgb,
    /// By a colorimeter.
    #[serde(rename = "measured")]
    Measured(MeasuredColor),
    /// By the monitor's ICC profile.
    #[serde(rename = "icc")]
    Icc(ProfileFile),
    /// By a colorimeter, patch by patch.
    #[serde(rename = "calibrated")]
    Calibrated(Calibration),
}

/// Chromaticities x, y (CIE 1931) as a colorimeter reads them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeasuredColor {
    /// Red alone at full drive.
    pub red: [f64; 2],
    /// Green alone.
    pub green: [f64; 2],
    /// Blue alone.
    pub blue: [f64; 2],
    /// All three.
    pub white: [f64; 2],
    /// The exponent of the transfer curve; without it the curve of sRGB.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gamma: Option<f64>,
}

/// An ICC profile, and which bytes it had.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ProfileFile {
    /// The file.
    pub file: PathBuf,
    /// The SHA-256 of its bytes when the station was written.
    pub sha256: Sha256Digest,
}

/// Bradford's cone responses (Lam 1985).
const BRADFORD: Matrix3 = [
    [0.8951, 0.2664, -0.1614],
    [-0.7502, 1.7135, 0.0367],
    [0.0389, -0.0685, 1.0296],
];
/// The white of the profile connection space (ICC.1:2022, 7.2.16).
const D50_XYZ: [f64; 3] = [0.9642, 1.0, 0.8249];

impl DisplayColor {
    /// The profile in a file, with its digest.
    ///
    /// # Errors
    ///
    /// The file cannot be read, or is no profile of a display by primaries and curves.
    pub fn from_profile(file: &Path) -> Result<Self, ReadError> {
        let bytes = read(file)?;
        characterised(file, &bytes)?;
        Ok(Self::Icc(ProfileFile {
            file: file.to_owned(),
            sha256: Sha256Digest::of(&bytes),
        }))
    }

    /// How colours get to this display; `station` is the file that says so.
    ///
    /// # Errors
    ///
    /// The chromaticities are no display's, or the profile is not the one that was named.
    pub fn display(&self, station: &Path) -> Result<Display, ReadError> {
        match self {
            Self::Srgb => Ok(Display::Srgb),
            Self::Measured(measured) => Ok(measured.display(station)?),
            Self::Calibrated(calibration) => match calibration.fit() {
                Ok(fit) => Ok(Display::Characterised(Box::new(fit.display()))),
                Err(found) => Err(InputError::new(station, found, "readings of one display")
                    .at("field color.calibrated.readings")
                    .remedy("read the patches again: acuity station P --window")
                    .into()),
            },
            Self::Icc(profile) => {
                let bytes = read(&profile.file)?;
                let found = Sha256Digest::of(&bytes);
                if found != profile.sha256 {
                    let expected = format!("{}, as the station says", profile.sha256);
                    let found = format!("SHA-256 {found}");
                    return Err(InputError::new(&profile.file, found, expected)
                        .remedy("write the station down again with the new profile: acuity station --icc")
                        .into());
                }
                Ok(characterised(&profile.file, &bytes)?)
            }
        }
    }

    /// What it is, in words.
    pub fn in_words(&self) -> String {
        match self {
            Self::Srgb => "sRGB by declaration; nothing was measured".to_owned(),
            Self::Measured(measured) => {
                let curve = measured.gamma.map_or_else(
                    || "the curve of sRGB".to_owned(),
                    |gamma| format!("gamma {gamma}"),
                );
                let [x, y] = measured.white;
                format!("measured, white ({x}, {y}), {curve}")
            }
            Self::Icc(profile) => format!("ICC profile {}", profile.file.display()),
            Self::Calibrated(calibration) => match calibration.fit() {
                Ok(fit) => fit.in_words(),
                Err(fault) => format!("readings that fit no display: {fault}"),
            },
        }
    }
}

impl MeasuredColor {
    fn display(&self, station: &Path) -> Result<Display, InputError> {
        let wrong = |field: &str, found: String, expected: &str| {
            InputError::new(station, found, expected).at(format!("field color.measured.{field}"))
        };
        let points = [
            ("red", self.red),
            ("green", self.green),
            ("blue", self.blue),
            ("white", self.white),
        ];
        for (field, [x, y]) in points {
            if !(x >= 0.0 && y > 0.0 && x + y <= 1.0) {
                let expected = "chromaticities x and y, above 0 and with a sum up to 1";
                return Err(wrong(field, format!("{x}, {y}"), expected));
            }
        }
        let gamma = self.gamma.unwrap_or(2.2);
        if !(1.0..=4.0).contains(&gamma) {
            return Err(wrong("gamma", gamma.to_string(), "an exponent from 1 to 4"));
        }
        let primaries = matrix3::transpose(&[self.red, self.green, self.blue].map(xyz));
        let parts = matrix3::times(&matrix3::inverse(&primaries), xyz(self.white));
        if !parts.iter().all(|part| part.is_finite() && *part > 0.0) {
            let expected = "a white inside the triangle of the primaries";
            return Err(wrong("white", format!("{:?}", self.white), expected));
        }
        let columns = primaries.map(|row| [0, 1, 2].map(|primary| row[primary] * parts[primary]));
        let power = |code: f64| match self.gamma {
            Some(gamma) => libm::pow(code, gamma),
            None => srgb_decoded(code),
        };
        let curve: &dyn Fn(f64) -> f64 = &power;
        let display = Characterised::new(&columns, [curve; 3]);
        Ok(Display::Characterised(Box::new(display)))
    }
}

/// The tristimulus values of a chromaticity with Y = 1.
fn xyz([x, y]: [f64; 2]) -> [f64; 3] {
    [x / y, 1.0, (1.0 - x - y) / y]
}

fn read(file: &Path) -> Result<Vec<u8>, ReadError> {
    fs::read(file).map_err(|error| ReadError::from_io(file, "an ICC profile", error))
}

/// A display by the bytes of its profile.
fn characterised(file: &Path, bytes: &[u8]) -> Result<Display, InputError> {
    let kind = "the ICC profile of an RGB display, with primaries and curves";
    let wrong = |found: String| {
        InputError::new(file, found, kind)
            .remedy("make a matrix profile of the monitor, or type its primaries: acuity station --primaries")
    };
    let profile = match ColorProfile::new_from_slice(bytes) {
        Ok(profile) => profile,
        Err(error) => return Err(wrong(format!("{error:?}"))),
    };
    if profile.color_space != DataColorSpace::Rgb || profile.pcs != DataColorSpace::Xyz {
        return Err(wrong(format!(
            "a profile from {:?} to {:?}",
            profile.color_space, profile.pcs
        )));
    }
    let colorants = [
        profile.red_colorant,
        profile.green_colorant,
        profile.blue_colorant,
    ];
    let adapted = matrix3::transpose(&colorants.map(values));
    let columns = matrix3::product(&matrix3::inverse(&adaptation(&profile)), &adapted);
    let determinant = matrix3::determinant(&columns);
    if !(determinant.is_finite() && determinant > 1e-6) {
        return Err(wrong("primaries that span no colours".to_owned()));
    }
    let curves = [&profile.red_trc, &profile.green_trc, &profile.blue_trc];
    let [red, green, blue] = curves.map(|curve| curve.as_ref().and_then(decoded_codes));
    let (Some(red), Some(green), Some(blue)) = (red, green, blue) else {
        return Err(wrong("no transfer curve, or one that falls".to_owned()));
    };
    let curve = |table: &Vec<f64>, code: f64| {
        let place = (code * 510.0).round();
        let found = (0..)
            .zip(table)
            .find(|(at, _): &(u32, _)| f64::from(*at) == place);
        found.map_or(1.0, |(_, value)| *value)
    };
    let curves: [&dyn Fn(f64) -> f64; 3] = [
        &|code| curve(&red, code),
        &|code| curve(&green, code),
        &|code| curve(&blue, code),
    ];
    let display = Characterised::new(&columns, curves);
    Ok(Display::Characterised(Box::new(display)))
}

fn values(xyz: Xyzd) -> [f64; 3] {
    [xyz.x, xyz.y, xyz.z]
}

/// From the display's own white to D50, as the profile did it.
///
/// Some programs write Bradford's cone responses where the adaptation belongs; these count as none.
fn adaptation(profile: &ColorProfile) -> Matrix3 {
    let named = profile.chromatic_adaptation.map(|matrix| matrix.v);
    let is_adaptation = |matrix: &Matrix3| {
        let pairs = matrix.iter().flatten().zip(BRADFORD.iter().flatten());
        pairs.fold(0.0, |most, (one, other)| {
            f64::max(most, (one - other).abs())
        }) > 1e-3
    };
    if let Some(matrix) = named.filter(is_adaptation) {
        return matrix;
    }
    let white = profile.media_white_point.map_or(D50_XYZ, values);
    let from = matrix3::times(&BRADFORD, white);
    let to = matrix3::times(&BRADFORD, D50_XYZ);
    let mut scaled = BRADFORD;
    for (row, (to, from)) in scaled.iter_mut().zip(to.into_iter().zip(from)) {
        *row = row.map(|entry| entry * to / from);
    }
    matrix3::product(&matrix3::inverse(&BRADFORD), &scaled)
}

/// Linear light at every half code: 511 values that never fall.
fn decoded_codes(curve: &ToneReprCurve) -> Option<Vec<f64>> {
    let evaluator = curve.make_linear_evaluator().ok()?;
    let mut values = Vec::new();
    for half in 0..=510_u16 {
        let code = f32::from(half) / 510.0;
        values.push(f64::from(evaluator.evaluate_value(code)));
    }
    let is_curve = values.iter().all(|value| value.is_finite()) && values.is_sorted();
    (is_curve && values.last() > values.first()).then_some(values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::display::ac1c2_of_srgb;
    use protocols::opponent::ac1c2_from_xyz;

    /// A colour by its linear drive of primaries with the white D65.
    fn driven(primaries: [[f64; 2]; 3], drive: [f64; 3]) -> protocols::PerChannel<f64> {
        let columns = matrix3::transpose(&primaries.map(xyz));
        let white = xyz([0.3127, 0.3290]);
        let parts = matrix3::times(&matrix3::inverse(&columns), white);
        let [r, g, b] = [0, 1, 2].map(|index| drive[index] * parts[index]);
        ac1c2_from_xyz(matrix3::times(&columns, [r, g, b]))
    }

    const P3: [[f64; 2]; 3] = [[0.680, 0.320], [0.265, 0.690], [0.150, 0.060]];
    const BT709: [[f64; 2]; 3] = [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]];

    fn measured(gamma: Option<f64>) -> MeasuredColor {
        MeasuredColor {
            red: P3[0],
            green: P3[1],
            blue: P3[2],
            white: [0.3127, 0.3290],
            gamma,
        }
    }

    /// From D65 to D50 by Bradford's method, as Lindbloom and the ICC print it. A profile made by moxcms names
    /// Bradford's cone responses in its place.
    const D50_FROM_D65: Matrix3 = [
        [1.047_811_2, 0.022_886_6, -0.050_127_0],
        [0.029_542_4, 0.990_484_4, -0.017_049_1],
        [-0.009_234_5, 0.015_043_6, 0.752_131_6],
    ];

    fn write(folder: &Path, profile: &ColorProfile) -> PathBuf {
        let path = folder.join("monitor.icc");
        fs::write(&path, profile.encode().unwrap()).unwrap();
        path
    }

    #[test]
    fn a_typed_display_is_driven_as_its_numbers_say() {
        let color = DisplayColor::Measured(measured(Some(2.0)));
        let display = color.display(Path::new("s.toml")).unwrap();
        // Codes are 255 · sqrt(drive): 128 (127.5 rounds up), 255, 64 (63.75).
        let shown = display.shown(driven(P3, [0.252_5, 1.0, 0.0625]));
        assert_eq!(shown, ([128, 255, 64], true));
        assert!(!display.shown(driven(P3, [-0.01, 0.5, 0.5])).1);
        // sRGB red on P3 needs some green: (x, y) stays (0.64, 0.33).
        let (codes, is_in) = display.shown(driven(BT709, [1.0, 0.0, 0.0]));
        assert!(is_in && codes[0] > 200 && codes[1] > 0, "{codes:?}");
    }

    /// Display P3 as SMPTE EG 432-1 and the curve of sRGB define it, against a profile made by moxcms.
    #[test]
    fn a_profile_of_display_p3_is_read_for_its_published_primaries() {
        let folder = tempfile::tempdir().unwrap();
        let mut profile = ColorProfile::new_display_p3();
        profile.chromatic_adaptation = Some(moxcms::Matrix3d { v: D50_FROM_D65 });
        let path = write(folder.path(), &profile);
        let color = DisplayColor::from_profile(&path).unwrap();
        let by_profile = color.display(Path::new("s.toml")).unwrap();
        let typed = DisplayColor::Measured(measured(None));
        let typed = typed.display(Path::new("s.toml")).unwrap();
        for code in (0..=255).step_by(5) {
            for rgb in [[code; 3], [code, 200, 30], [30, code, 200]] {
                let color = ac1c2_of_srgb(rgb);
                let (one, other) = (by_profile.shown(color).0, typed.shown(color).0);
                // The profile has 16 bits: a code on the edge of two may be either.
                for (one, other) in one.into_iter().zip(other) {
                    assert!(one.abs_diff(other) <= 1, "{rgb:?}: {one} {other}");
                }
            }
        }
        assert!(by_profile.white_luminance().unwrap() > 0.999);
    }

    /// Without a named adaptation the media's white says what to take out of the colorants.
    #[test]
    fn a_profile_of_srgb_gives_the_codes_of_srgb() {
        let folder = tempfile::tempdir().unwrap();
        let with_responses = ColorProfile::new_srgb();
        let mut without = with_responses.clone();
        without.chromatic_adaptation = None;
        let path = write(folder.path(), &with_responses);
        let by_responses = DisplayColor::from_profile(&path).unwrap();
        let by_responses = by_responses.display(Path::new("s.toml")).unwrap();
        let path = write(folder.path(), &without);
        let color = DisplayColor::from_profile(&path).unwrap();
        let display = color.display(Path::new("s.toml")).unwrap();
        assert_eq!(display, by_responses);
        let mut different = 0;
        for code in 0..=255_u8 {
            for rgb in [[code; 3], [code, 128, 10], [90, code, 255 - code]] {
                let (shown, _) = display.shown(ac1c2_of_srgb(rgb));
                let steps = shown
                    .iter()
                    .zip(rgb)
                    .map(|(one, other)| one.abs_diff(other));
                let steps = steps.max().unwrap();
                assert!(steps <= 1, "{rgb:?}: {shown:?}");
                different += u32::from(steps);
            }
        }
        assert!(different < 8, "{different} codes differ by one");
    }

    #[test]
    fn what_is_wrong_with_a_display_is_named() {
        let station = Path::new("station.toml");
        let fault = |change: &dyn Fn(&mut MeasuredColor)| {
            let mut color = measured(Some(2.2));
            change(&mut color);
            let error = DisplayColor::Measured(color).display(station);
            error.unwrap_err().to_string()
        };
        assert!(fault(&|color| color.red = [0.7, 0.4]).contains("color.measured.red"));
        assert!(fault(&|color| color.green = [f64::NAN, 0.4]).contains("color.measured.green"));
        assert!(fault(&|color| color.white = [0.1, 0.8]).contains("inside the triangle"));
        assert!(fault(&|color| color.blue = color.red).contains("color.measured.white"));
        assert!(fault(&|color| color.gamma = Some(0.4)).contains("color.measured.gamma"));

        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("monitor.icc");
        let error = |path: &Path| DisplayColor::from_profile(path).unwrap_err().to_string();
        assert!(error(&path).contains("no such file"));
        let bytes = ColorProfile::new_srgb().encode().unwrap();
        for bytes in [&bytes[..bytes.len() / 2], &b"not a profile"[..], &[]] {
            fs::write(&path, bytes).unwrap();
            assert!(error(&path).contains("monitor.icc"), "{}", error(&path));
        }
        let grey = ColorProfile::new_gray_with_gamma(2.2).encode().unwrap();
        fs::write(&path, grey).unwrap();
        assert!(error(&path).contains("Gray"), "{}", error(&path));
        let path = write(folder.path(), &ColorProfile::new_srgb());
        let named = DisplayColor::from_profile(&path).unwrap();
        write(folder.path(), &ColorProfile::new_display_p3());
        let changed = named.display(station).unwrap_err().to_string();
        assert!(changed.contains("as the station says"), "{changed}");
    }
}
