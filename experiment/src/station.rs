//! The station: how large the screen's pixels are, and where the subject must sit.
//!
//! It belongs to a computer, not to a study, so it stands in a file of its own, which every session copies into
//! its sidecar. A pixel of pitch *p* seen from the distance *d* subtends the angle *a* with `p = d tan(a)`.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use protocols::{Access, InputError, ReadError, Study, Viewing, write_atomically};
use serde::{Deserialize, Serialize};

use crate::{Display, DisplayColor, ExperimentError, Refresh};

/// A computer's screen and chair, as they were measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StationFile {
    /// The monitor by the name that the window system gives it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub monitor: Option<String>,
    /// The width of the picture on the screen, without the frame.
    pub width_mm: f64,
    /// The pixels of that width.
    pub width_px: u32,
    /// From the eye to the screen.
    pub distance_cm: f64,
    /// The peak luminance, if it was measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub peak_luminance_cd_m2: Option<f64>,
    /// Lights and surround, in words.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub surround: Option<String>,
    /// The luminance of what stands behind the screen, if it was measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub background_cd_m2: Option<f64>,
    /// The light of the room on the screen, if it was measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub room_lux: Option<f64>,
    /// The monitor of the experimenter's view, by its name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub experimenter_monitor: Option<String>,
    /// Why the monitor runs at another resolution than its own; without it no session does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub not_native_because: Option<String>,
    /// What the display's colours are taken for.
    #[serde(default)]
    pub color: DisplayColor,
    /// The refresh of the monitor as it was last measured here.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refresh: Option<Refresh>,
    /// Every monitor of this computer that was measured, by its name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub screens: BTreeMap<String, ScreenSize>,
}

/// The size of one monitor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScreenSize {
    /// The width of the picture, without the frame.
    pub width_mm: f64,
    /// The pixels of that width.
    pub width_px: u32,
}

impl StationFile {
    /// Where the file stands unless the user says otherwise: `$XDG_CONFIG_HOME/acuity/station.toml`, or
    /// `~/.config/acuity/station.toml`.
    pub fn default_path() -> Option<PathBuf> {
        let variable = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty());
        let config = variable("XDG_CONFIG_HOME").map(PathBuf::from);
        let config = config.or_else(|| Some(PathBuf::from(variable("HOME")?).join(".config")));
        config.map(|config| config.join("acuity/station.toml"))
    }

    /// Reads a station.
    ///
    /// # Errors
    ///
    /// The file is missing, is no station, or a number in it is out of range.
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        let kind = "a station (TOML)";
        let text =
            fs::read_to_string(path).map_err(|error| ReadError::from_io(path, kind, error))?;
        let station: Self = toml::from_str(&text).map_err(|error| {
            InputError::new(path, error.to_string().trim_end(), kind)
                .remedy("measure the screen again: acuity station")
        })?;
        station.check(path)?;
        Ok(station)
    }

    /// Writes the station, whole or not at all.
    ///
    /// # Errors
    ///
    /// A number is out of range, or the system will not take the file.
    pub fn write(&self, path: &Path) -> Result<(), ExperimentError> {
        self.check(path)?;
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(ExperimentError::io("create", folder))?;
        }
        let text = toml::to_string(self).map_err(|error| {
            InputError::new(path, error.to_string(), "a station that can be written")
        })?;
        write_atomically(path, text.as_bytes(), Access::Owner)
            .map_err(ExperimentError::io("write", path))
    }

    fn check(&self, path: &Path) -> Result<(), InputError> {
        let range = |field: &str, found: f64, lowest: f64, highest: f64| {
            if found.is_finite() && (lowest..=highest).contains(&found) {
                return Ok(());
            }
            let expected = format!("a number from {lowest} to {highest}");
            Err(InputError::new(path, found.to_string(), expected).at(format!("field {field}")))
        };
        range("width_mm", self.width_mm, 50.0, 5000.0)?;
        range("width_px", f64::from(self.width_px), 320.0, 32_768.0)?;
        range("distance_cm", self.distance_cm, 10.0, 1000.0)?;
        let peak = self.peak_luminance_cd_m2.unwrap_or(100.0);
        range("peak_luminance_cd_m2", peak, 1.0, 10_000.0)?;
        let background = self.background_cd_m2.unwrap_or(0.0);
        range("background_cd_m2", background, 0.0, 10_000.0)?;
        range("room_lux", self.room_lux.unwrap_or(0.0), 0.0, 100_000.0)?;
        for (name, screen) in &self.screens {
            range(
                &format!("screens.{name}.width_mm"),
                screen.width_mm,
                50.0,
                5000.0,
            )?;
        }
        Ok(())
    }

    /// How colours get to the station's display.
    ///
    /// # Errors
    ///
    /// The chromaticities are no display's, or the ICC profile is not the one that was named.
    pub fn display(&self) -> Result<Display, ReadError> {
        self.color.display(Path::new("station.toml"))
    }

    /// The width of a pixel.
    pub fn pixel_pitch_mm(&self) -> f64 {
        self.width_mm / f64::from(self.width_px)
    }

    /// The angle that a pixel subtends at this station: `atan(p / d)`.
    ///
    /// ```
    /// // The paper's station: a pitch of 0.33692 mm from 101.6 cm is 0.019 degrees.
    /// let station = experiment::StationFile {
    ///     monitor: None,
    ///     width_mm: 0.336_918_371_154_940_44 * 1280.0,
    ///     width_px: 1280,
    ///     distance_cm: 101.6,
    ///     color: experiment::DisplayColor::Srgb,
    ///     peak_luminance_cd_m2: None,
    ///     surround: None,
    ///     background_cd_m2: None,
    ///     room_lux: None,
    ///     experimenter_monitor: None,
    ///     not_native_because: None,
    ///     refresh: None,
    ///     screens: std::collections::BTreeMap::new(),
    /// };
    /// assert!((station.degrees_per_pixel() - 0.019).abs() < 1e-12);
    /// ```
    pub fn degrees_per_pixel(&self) -> f64 {
        libm::atan(self.pixel_pitch_mm() / (10.0 * self.distance_cm)).to_degrees()
    }

    /// How far from this screen a pixel subtends the protocol's angle: `d = p / tan(a)`.
    pub fn distance_cm_for(&self, viewing: Viewing) -> f64 {
        self.pixel_pitch_mm() / 10.0 / libm::tan(viewing.degrees_per_pixel.to_radians())
    }

    /// Where to sit, in words.
    pub fn advice(&self, viewing: Viewing) -> String {
        format!(
            "a pixel is {:.4} mm wide; it subtends the protocol's {} degrees from {:.1} cm (d = p / tan a); from {:.1} cm it subtends {:.5} degrees",
            self.pixel_pitch_mm(),
            viewing.degrees_per_pixel,
            self.distance_cm_for(viewing),
            self.distance_cm,
            self.degrees_per_pixel()
        )
    }

    /// The refresh as it was last measured, in words.
    pub fn refresh_in_words(&self) -> String {
        self.refresh.map_or_else(
            || "not measured here; every session measures it".to_owned(),
            Refresh::in_words,
        )
    }

    /// Whether the station keeps to the study's tolerance and lowest refresh, if it has them.
    ///
    /// # Errors
    ///
    /// The angle of a pixel differs by more than the tolerance, or the display was found to be slower.
    pub fn check_for(&self, study: &Study, path: &Path) -> Result<(), InputError> {
        self.check_refresh(study, path)?;
        let Some(tolerance) = study.protocol.session.viewing_tolerance else {
            return Ok(());
        };
        let wanted = study.protocol.viewing.degrees_per_pixel;
        let found = self.degrees_per_pixel();
        if (found / wanted - 1.0).abs() <= tolerance {
            return Ok(());
        }
        let found = format!("{found:.5} degrees per pixel");
        let expected = format!("{wanted} degrees within {} %", tolerance * 100.0);
        let remedy = format!(
            "seat the subject {:.1} cm from the screen and write that down: acuity station",
            self.distance_cm_for(study.protocol.viewing)
        );
        Err(InputError::new(path, found, expected).remedy(remedy))
    }

    fn check_refresh(&self, study: &Study, path: &Path) -> Result<(), InputError> {
        let lowest_hz = study.protocol.session.lowest_refresh_hz;
        match (self.refresh, lowest_hz) {
            (Some(refresh), Some(lowest_hz)) if !refresh.reaches(lowest_hz) => {
                let found = format!("a refresh of {:.2} Hz", refresh.rate_hz());
                let expected =
                    format!("at least {lowest_hz} Hz: the protocol has session.lowest_refresh_hz");
                let remedy = "set the monitor to a higher rate and measure it again: acuity station P --window";
                Err(InputError::new(path, found, expected).remedy(remedy))
            }
            _ => Ok(()),
        }
    }
}

/// The station of this computer: the file named, or the default one if it is there.
///
/// # Errors
///
/// The file cannot be used, the study has a tolerance and there is no file, or the station does not keep to it.
pub fn station_for(study: &Study, named: Option<&Path>) -> Result<Option<StationFile>, ReadError> {
    let default = StationFile::default_path().filter(|path| path.exists());
    let Some(path) = named.map(Path::to_owned).or(default) else {
        if study.protocol.session.viewing_tolerance.is_none() {
            return Ok(None);
        }
        let expected =
            "the size of the screen and the distance: the protocol has session.viewing_tolerance";
        return Err(InputError::new("station.toml", "no station", expected)
            .remedy("measure the screen: acuity station")
            .into());
    };
    let station = StationFile::read(&path)?;
    station.check_for(study, &path)?;
    station.color.display(&path)?;
    Ok(Some(station))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::small_study;

    fn station() -> StationFile {
        StationFile {
            monitor: Some("DP-1".to_owned()),
            width_mm: 527.04,
            width_px: 1920,
            distance_cm: 82.8,
            color: DisplayColor::Srgb,
            peak_luminance_cd_m2: Some(120.0),
            surround: Some("dim, 20 lx".to_owned()),
            background_cd_m2: Some(18.0),
            room_lux: Some(20.0),
            experimenter_monitor: Some("DP-2".to_owned()),
            not_native_because: Some("a cathode-ray tube".to_owned()),
            refresh: Some(Refresh::of(&[1.0 / 60.0; 300], None)),
            screens: BTreeMap::from([(
                "DP-1".to_owned(),
                ScreenSize {
                    width_mm: 527.04,
                    width_px: 1920,
                },
            )]),
        }
    }

    /// A 24-inch screen of 1920 pixels: 0.2745 mm; 0.02745 / tan(0.019 degrees) = 82.78 cm (bc -l).
    #[test]
    fn a_screen_of_24_inches_wants_a_chair_at_82_8_cm() {
        let folder = tempfile::tempdir().unwrap();
        let study = small_study(folder.path());
        let distance = station().distance_cm_for(study.protocol.viewing);
        assert!((distance - 82.78).abs() < 0.005, "{distance}");
    }

    #[test]
    fn a_station_is_read_as_it_was_written_and_what_is_wrong_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/station.toml");
        let missing = StationFile::read(&path).unwrap_err().to_string();
        assert!(missing.contains("station.toml") && missing.contains("no such file"));
        station().write(&path).unwrap();
        assert_eq!(StationFile::read(&path).unwrap(), station());
        let text = fs::read_to_string(&path).unwrap();
        for (good, bad, named) in [
            ("width_mm = 527.04", "width_mm = 5.0", "width_mm"),
            ("width_mm = 527.04", "width_mm = nan", "width_mm"),
            ("room_lux = 20.0", "room_lux = -1.0", "room_lux"),
            (
                "[screens.DP-1]\nwidth_mm = 527.04",
                "[screens.DP-1]\nwidth_mm = 1.0",
                "screens.DP-1.width_mm",
            ),
            ("width_px = 1920", "", "width_px"),
            (
                "distance_cm = 82.8",
                "distance_cm = \"near\"",
                "distance_cm",
            ),
            ("monitor", "screen", "screen"),
        ] {
            assert!(text.contains(good), "{good}");
            fs::write(&path, text.replacen(good, bad, 1)).unwrap();
            let error = StationFile::read(&path).unwrap_err().to_string();
            assert!(
                error.contains(named) && error.contains("station.toml"),
                "{error}"
            );
        }
        fs::write(&path, &text[..text.len() / 2]).unwrap();
        assert!(StationFile::read(&path).is_err());
    }

    /// A display at 30 Hz, which a protocol that asks for 60 does not take.
    #[test]
    fn a_display_that_was_found_slow_is_refused_where_the_protocol_asks_for_more() {
        let folder = tempfile::tempdir().unwrap();
        let mut study = small_study(folder.path());
        let slow = StationFile {
            refresh: Some(Refresh::of(&[1.0 / 30.0; 300], Some(30.0))),
            ..station()
        };
        let path = Path::new("station.toml");
        slow.check_for(&study, path).unwrap();
        study.protocol.session.lowest_refresh_hz = Some(60.0);
        station().check_for(&study, path).unwrap();
        let error = slow.check_for(&study, path).unwrap_err().to_string();
        assert!(
            error.contains("30.00 Hz") && error.contains("60"),
            "{error}"
        );
    }

    #[test]
    fn a_tolerance_in_the_protocol_decides_whether_a_session_may_start() {
        let folder = tempfile::tempdir().unwrap();
        let mut study = small_study(folder.path());
        let path = folder.path().join("station.toml");
        station().write(&path).unwrap();
        study.protocol.session.viewing_tolerance = Some(0.02);
        assert!(station_for(&study, Some(&path)).is_ok());
        let near = StationFile {
            distance_cm: 60.0,
            ..station()
        };
        near.write(&path).unwrap();
        let error = station_for(&study, Some(&path)).unwrap_err().to_string();
        assert!(
            error.contains("82.8 cm") && error.contains("within 2 %"),
            "{error}"
        );
        study.protocol.session.viewing_tolerance = None;
        assert_eq!(station_for(&study, Some(&path)).unwrap(), Some(near));
    }
}
