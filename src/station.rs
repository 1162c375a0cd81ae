//! `acuity station`: this computer's screen and chair.

use std::path::Path;

use anyhow::Context as _;
use eframe::egui::Theme;
use experiment::{DisplayColor, MeasuredColor, ScreenSize, StationFile};
use protocols::{Study, Viewing};

use crate::command_line::{StationArguments, ThemeWord};
use crate::console;

/// Measures the station in a window, or writes down what was typed, and says where to sit.
pub(crate) fn measure(arguments: &StationArguments) -> anyhow::Result<()> {
    let study = Study::read(&arguments.protocol)?;
    let viewing = study.protocol.viewing;
    let path = arguments.out.clone().or_else(StationFile::default_path);
    let path =
        path.context("found no HOME, expected a folder for the station; name a file with --out")?;
    let (Some(width_mm), Some(width_px)) = (arguments.width_mm, arguments.width_px) else {
        let saved = experiment::measure_station(
            &study,
            &path,
            arguments.monitor.clone(),
            arguments.theme.map(Theme::from),
        )?;
        return match saved {
            Some(station) => print(&station, viewing, &path),
            None => console::print("closed without saving; the station is as it was")
                .map_err(Into::into),
        };
    };
    let before = StationFile::read(&path).ok();
    let same = before
        .as_ref()
        .filter(|before| before.monitor == arguments.monitor);
    let refresh = same.and_then(|before| before.refresh);
    let mut screens = before.map(|before| before.screens).unwrap_or_default();
    if let Some(monitor) = &arguments.monitor {
        screens.insert(monitor.clone(), ScreenSize { width_mm, width_px });
    }
    let mut station = StationFile {
        monitor: arguments.monitor.clone(),
        width_mm,
        width_px,
        distance_cm: arguments.distance_cm.unwrap_or(viewing.distance_cm),
        color: color(arguments)?,
        peak_luminance_cd_m2: arguments.peak_luminance,
        surround: arguments.surround.clone(),
        background_cd_m2: arguments.background_luminance,
        room_lux: arguments.room_lux,
        experimenter_monitor: arguments.experimenter_monitor.clone(),
        not_native_because: arguments.not_native_because.clone(),
        refresh,
        screens,
    };
    if arguments.distance_cm.is_none() {
        station.distance_cm = (station.distance_cm_for(viewing) * 10.0).round() / 10.0;
    }
    station.color.display(&path)?;
    station.write(&path)?;
    print(&station, viewing, &path)
}

impl From<ThemeWord> for Theme {
    fn from(word: ThemeWord) -> Self {
        match word {
            ThemeWord::Light => Self::Light,
            ThemeWord::Dark => Self::Dark,
        }
    }
}

/// Where to sit, what the colours are, and where that stands.
fn print(station: &StationFile, viewing: Viewing, path: &Path) -> anyhow::Result<()> {
    console::print(station.advice(viewing))?;
    console::print(format!("colour: {}", station.color.in_words()))?;
    console::print(format!("written to {}", path.display()))?;
    Ok(())
}

/// What the display's colours are taken for.
fn color(arguments: &StationArguments) -> anyhow::Result<DisplayColor> {
    if let Some(profile) = &arguments.icc {
        return Ok(DisplayColor::from_profile(profile)?);
    }
    let Some(numbers) = &arguments.primaries else {
        return Ok(DisplayColor::Srgb);
    };
    let point = |index: usize| [2 * index, 2 * index + 1].map(|place| numbers[place]);
    Ok(DisplayColor::Measured(MeasuredColor {
        red: point(0),
        green: point(1),
        blue: point(2),
        white: point(3),
        gamma: arguments.gamma,
    }))
}
