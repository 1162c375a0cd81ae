//! A display's colours while they are being typed: which way they are known, and the words in each field.
//!
//! Not here: the page (`window/station`), and what a display makes of the numbers (`display_color`).

use std::path::Path;

use protocols::ReadError;

use crate::station_draft::number;
use crate::{Calibration, Display, DisplayColor, Fit, MeasuredColor, Patch, Reading};

/// The way in which the colours are known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum ColorSource {
    /// Taken for sRGB.
    #[default]
    Declared,
    /// Chromaticities and an exponent, typed.
    Typed,
    /// A profile of the monitor.
    Profile,
    /// Patches read by a meter.
    Patches,
}

/// Fields of a display's colours.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ColorDraft {
    pub(crate) source: ColorSource,
    /// x and y of red, green, blue and white.
    pub(crate) chromaticities: [[String; 2]; 4],
    /// Empty for the curve of sRGB.
    pub(crate) gamma: String,
    /// The profile's file.
    pub(crate) profile: String,
    /// For each patch the luminance, x and y.
    pub(crate) readings: Vec<(Patch, [String; 3])>,
}

impl Default for ColorDraft {
    fn default() -> Self {
        let readings = Patch::all().into_iter();
        Self {
            source: ColorSource::default(),
            chromaticities: Default::default(),
            gamma: String::new(),
            profile: String::new(),
            readings: readings.map(|patch| (patch, Default::default())).collect(),
        }
    }
}

impl ColorDraft {
    /// The fields of colours that are known already.
    pub(crate) fn of(color: &DisplayColor) -> Self {
        let mut draft = Self::default();
        match color {
            DisplayColor::Srgb => {}
            DisplayColor::Measured(measured) => {
                let points = [measured.red, measured.green, measured.blue, measured.white];
                draft.source = ColorSource::Typed;
                draft.chromaticities = points.map(|point| point.map(|value| value.to_string()));
                draft.gamma = measured
                    .gamma
                    .map_or_else(String::new, |gamma| gamma.to_string());
            }
            DisplayColor::Icc(profile) => {
                draft.source = ColorSource::Profile;
                draft.profile = profile.file.display().to_string();
            }
            DisplayColor::Calibrated(calibration) => {
                draft.source = ColorSource::Patches;
                for (patch, fields) in &mut draft.readings {
                    if let Some(read) = calibration.reading(*patch) {
                        let values = [read.luminance_cd_m2, read.x, read.y];
                        *fields = values.map(|value| value.to_string());
                    }
                }
            }
        }
        draft
    }

    /// The colours, by the way that was chosen.
    ///
    /// # Errors
    ///
    /// What is missing or cannot be, in words.
    pub(crate) fn color(&self) -> Result<DisplayColor, String> {
        let color = match self.source {
            ColorSource::Declared => DisplayColor::Srgb,
            ColorSource::Typed => DisplayColor::Measured(self.typed()?),
            ColorSource::Profile => {
                let file = self.profile.trim();
                if file.is_empty() {
                    return Err("name the file of the monitor's ICC profile".to_owned());
                }
                DisplayColor::from_profile(Path::new(file)).map_err(|error| in_words(&error))?
            }
            ColorSource::Patches => DisplayColor::Calibrated(self.calibration()?),
        };
        match color.display(Path::new("the fields")) {
            Ok(_) => Ok(color),
            Err(error) => Err(in_words(&error)),
        }
    }

    /// What was fitted to the readings, once all are there.
    pub(crate) fn fit(&self) -> Result<Fit, String> {
        self.calibration()?.fit()
    }

    /// How many patches have a whole reading.
    pub(crate) fn count_read(&self) -> usize {
        let is_whole = |fields: &[String; 3]| fields.iter().all(|field| !field.trim().is_empty());
        self.readings
            .iter()
            .filter(|(_, fields)| is_whole(fields))
            .count()
    }

    /// What a meter should read on a patch, if the display is what the fields say; where readings are taken, what
    /// an sRGB display with the white that was read would give.
    pub(crate) fn expected(&self, patch: Patch, peak_cd_m2: f64) -> Reading {
        let display = match self.source {
            ColorSource::Patches => Display::Srgb,
            _ => match self
                .color()
                .map(|color| color.display(Path::new("the fields")))
            {
                Ok(Ok(display)) => display,
                _ => Display::Srgb,
            },
        };
        let xyz = display.xyz(patch.codes).map(|part| part * peak_cd_m2);
        Reading::of(patch, xyz)
    }

    fn typed(&self) -> Result<MeasuredColor, String> {
        let names = ["red", "green", "blue", "white"];
        let mut points = [[0.0; 2]; 4];
        for (point, (fields, name)) in points.iter_mut().zip(self.chromaticities.iter().zip(names))
        {
            for (value, (field, axis)) in point.iter_mut().zip(fields.iter().zip(["x", "y"])) {
                let what = format!("{axis} of {name}");
                *value = number(field, &what, [0.0, 1.0])?
                    .ok_or_else(|| format!("{what} is not typed"))?;
            }
        }
        let [red, green, blue, white] = points;
        Ok(MeasuredColor {
            red,
            green,
            blue,
            white,
            gamma: number(&self.gamma, "gamma", [1.0, 4.0])?,
        })
    }

    fn calibration(&self) -> Result<Calibration, String> {
        let mut readings = Vec::new();
        for (patch, fields) in &self.readings {
            let name = patch.name();
            let value = |index: usize, what: &str, highest: f64| {
                number(&fields[index], &format!("{what} of {name}"), [0.0, highest])
            };
            let Some(luminance_cd_m2) = value(0, "luminance", 10_000.0)? else {
                return Err(format!("{name} is not read yet"));
            };
            let (x, y) = (value(1, "x", 1.0)?, value(2, "y", 1.0)?);
            let dark = (luminance_cd_m2 == 0.0).then_some(0.0);
            let missing = |axis: &str| format!("{axis} of {name} is not read yet");
            readings.push(Reading {
                patch: *patch,
                luminance_cd_m2,
                x: x.or(dark).ok_or_else(|| missing("x"))?,
                y: y.or(dark).ok_or_else(|| missing("y"))?,
            });
        }
        Ok(Calibration { readings })
    }
}

fn in_words(error: &ReadError) -> String {
    error.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ProfileFile;
    use protocols::Sha256Digest;

    fn read_as_srgb(peak_cd_m2: f64) -> ColorDraft {
        let mut draft = ColorDraft {
            source: ColorSource::Patches,
            ..ColorDraft::default()
        };
        let plain = ColorDraft::default();
        for (patch, fields) in &mut draft.readings {
            let read = plain.expected(*patch, peak_cd_m2);
            *fields = [read.luminance_cd_m2, read.x, read.y].map(|value| format!("{value:.6}"));
        }
        draft
    }

    #[test]
    fn fields_come_back_from_what_they_said() {
        let mut typed = ColorDraft {
            source: ColorSource::Typed,
            gamma: "2.2".to_owned(),
            ..ColorDraft::default()
        };
        let points = [
            ["0.64", "0.33"],
            ["0.3", "0.6"],
            ["0.15", "0.06"],
            ["0.3127", "0.329"],
        ];
        typed.chromaticities = points.map(|point| point.map(str::to_owned));
        assert_eq!(ColorDraft::of(&typed.color().unwrap()), typed);
        let read = read_as_srgb(100.0).color().unwrap();
        let again = ColorDraft::of(&read);
        assert_eq!(again.color().unwrap(), read);
        assert_eq!(
            (again.count_read(), again.source),
            (12, ColorSource::Patches)
        );
        let profile = DisplayColor::Icc(ProfileFile {
            file: "/none/monitor.icc".into(),
            sha256: Sha256Digest::of(b""),
        });
        let draft = ColorDraft::of(&profile);
        let fault = draft.color().unwrap_err();
        assert!(fault.contains("/none/monitor.icc"), "{fault}");
        assert_eq!(ColorDraft::of(&DisplayColor::Srgb), ColorDraft::default());
    }

    #[test]
    fn what_is_missing_or_no_number_is_named() {
        let mut draft = read_as_srgb(100.0);
        draft.readings[5].1[0].clear();
        let name = draft.readings[5].0.name();
        assert_eq!(
            draft.color().unwrap_err(),
            format!("{name} is not read yet")
        );
        draft.readings[5].1[0] = "bright".to_owned();
        assert!(draft.color().unwrap_err().contains("found \"bright\""));
        draft.source = ColorSource::Typed;
        assert_eq!(draft.color().unwrap_err(), "x of red is not typed");
        draft.source = ColorSource::Profile;
        assert!(draft.color().unwrap_err().contains("ICC"));
        draft.source = ColorSource::Declared;
        assert_eq!(draft.color(), Ok(DisplayColor::Srgb));
    }

    /// Code 128 of sRGB gives .2159 of the light, D65.
    #[test]
    fn a_meter_should_read_what_srgb_says() {
        let grey = ColorDraft::default().expected(Patch { codes: [128; 3] }, 120.0);
        assert!(
            (grey.luminance_cd_m2 - 120.0 * 0.2159).abs() < 0.01,
            "{grey:?}"
        );
        assert!((grey.x - 0.3127).abs() < 1e-3 && (grey.y - 0.329).abs() < 1e-3);
    }
}
