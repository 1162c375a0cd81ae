//! `acuity station`: this computer's screen and chair.

use anyhow::Context as _;
use experiment::{DisplayColor, MeasuredColor, StationFile};
use protocols::Study;

use crate::command_line::StationArguments;
use crate::console;

/// Writes the station down and says where to sit.
pub(crate) fn measure(arguments: &StationArguments) -> anyhow::Result<()> {
    let study = Study::read(&arguments.protocol)?;
    let viewing = study.protocol.viewing;
    let path = arguments.out.clone().or_else(StationFile::default_path);
    let path =
        path.context("found no HOME, expected a folder for the station; name a file with --out")?;
    let mut station = StationFile {
        monitor: arguments.monitor.clone(),
        width_mm: arguments.width_mm,
        width_px: arguments.width_px,
        distance_cm: arguments.distance_cm.unwrap_or(viewing.distance_cm),
        color: color(arguments)?,
        peak_luminance_cd_m2: arguments.peak_luminance,
        surround: arguments.surround.clone(),
    };
    if arguments.distance_cm.is_none() {
        station.distance_cm = (station.distance_cm_for(viewing) * 10.0).round() / 10.0;
    }
    station.color.display(&path)?;
    station.write(&path)?;
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
