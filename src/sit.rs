//! `acuity check`, `run` and `simulate`: from stimuli to ratings.

use std::path::Path;
use std::process::ExitCode;

use anyhow::Context as _;
use experiment::{RunOptions, StationFile, StimulusSet, ViewProgram};
use protocols::{DataSet, InputError, Observer, Study};
use renderer::Scene;

use crate::command_line::{
    CheckArguments, CloseArguments, ExportArguments, RunArguments, SimulateArguments,
};
use crate::console::{self, Progress};

pub(crate) fn check(arguments: &CheckArguments) -> anyhow::Result<ExitCode> {
    if renderer::is_scene(&arguments.protocol) {
        return check_scene(&arguments.protocol);
    }
    let study = Study::read(&arguments.protocol)?;
    if let Ok(scene) = study.scene_path() {
        match Scene::read(&scene) {
            Ok(scene) => console::print_warnings(scene.warnings()),
            Err(error) => console::print_warnings(&[error.to_string()]),
        }
    }
    let stimuli = arguments.stimuli.of(&study);
    let data = arguments.data.of(&study);
    let mut missing = experiment::check_ready(&study, &stimuli, &data);
    let station = match experiment::station_for(&study, arguments.station.as_deref()) {
        Ok(Some(station)) => {
            for line in station_lines(&study, &stimuli, &station) {
                console::print(line)?;
            }
            Some(station)
        }
        Ok(None) => {
            console::print(
                "station: not measured (acuity station); colour: sRGB by declaration, nothing was measured",
            )?;
            None
        }
        Err(error) => {
            missing.push(error.to_string());
            None
        }
    };
    let screen = experiment::check_screen(station.as_ref());
    for line in screen.lines {
        console::print(line)?;
    }
    if let Some(line) = last_session(&study, &data) {
        console::print(line)?;
    }
    missing.extend(screen.faults);
    if missing.is_empty() {
        console::print("ready")?;
        return Ok(ExitCode::SUCCESS);
    }
    for line in &missing {
        console::print(format!("not ready: {line}"))?;
    }
    Ok(ExitCode::from(2))
}

/// The refresh of the display as the last session measured it, if there was one.
fn last_session(study: &Study, data: &Path) -> Option<String> {
    let sessions = experiment::session_list(study, data).unwrap_or_default();
    let measured = sessions.sessions.iter();
    let measured = measured.filter(|session| session.refresh.is_some());
    let last = measured.max_by(|left, right| left.started_at.cmp(&right.started_at));
    let refresh = last?.refresh?;
    Some(format!(
        "refresh in the last session: {}",
        refresh.in_words()
    ))
}

/// What is known of the screen and the room, a line each.
fn station_lines(study: &Study, stimuli: &Path, station: &StationFile) -> Vec<String> {
    let advice = station.advice(study.protocol.viewing);
    let peak = station
        .peak_luminance_cd_m2
        .map_or_else(|| "not measured".to_owned(), |peak| format!("{peak} cd/m2"));
    let surround = station.surround.as_deref().unwrap_or("not noted");
    let number = |value: Option<f64>, unit: &str| {
        value.map_or_else(
            || "not measured".to_owned(),
            |value| format!("{value} {unit}"),
        )
    };
    let room = number(station.room_lux, "lx");
    let behind = number(station.background_cd_m2, "cd/m2");
    let mut lines = vec![
        format!("station: {advice}"),
        format!("refresh: {}", station.refresh_in_words()),
        format!("colour: {}", station.color.in_words()),
        format!("peak luminance: {peak} (ITU-R BT.500 advises 70 to 250 in a laboratory)"),
        format!("lights and surround: {surround} (BT.500: dim, a background of 15 % of the peak)"),
        format!(
            "room: {room} (ITU-T P.910 advises at most 20); behind the screen: {behind} (P.910: at most 20 % of the peak)"
        ),
    ];
    let set = StimulusSet::read(study, stimuli).and_then(|set| {
        let display = station.display()?;
        set.for_display(study, stimuli, &display)
    });
    // What is wrong with the set is said below, among what is not ready.
    if let Ok((set, lacking)) = set {
        let clipped = lacking.values().filter(|&&count| count > 0).count();
        let whole = set.images().len();
        match lacking.iter().max_by_key(|(_, count)| **count) {
            Some((id, most)) if clipped > 0 => lines.push(format!(
                "gamut: {clipped} of {whole} images have pixels that this display lacks, {id} the most ({most})"
            )),
            Some(_) => lines.push(format!("gamut: this display has every pixel of all {whole} images")),
            None => {}
        }
    }
    lines
}

/// What a scene asks for in vain, by name.
fn check_scene(file: &Path) -> anyhow::Result<ExitCode> {
    let scene = Scene::read(file)?;
    for warning in scene.warnings() {
        console::print(format!("warning: {warning}"))?;
    }
    match scene.warnings().len() {
        0 => console::print("ready")?,
        1 => console::print("ready, with 1 warning")?,
        count => console::print(format!("ready, with {count} warnings"))?,
    }
    Ok(ExitCode::SUCCESS)
}

pub(crate) fn run(arguments: &RunArguments) -> anyhow::Result<()> {
    let study = Study::read(&arguments.protocol)?;
    let station = experiment::station_for(&study, arguments.station.as_deref())?;
    let measured = station.as_ref().and_then(|station| station.monitor.clone());
    let view = if arguments.experimenter {
        Some(view(
            arguments.experimenter_monitor.clone(),
            station.as_ref(),
        )?)
    } else {
        None
    };
    let options = RunOptions {
        subject: arguments.subject.clone(),
        stimuli_dir: arguments.stimuli.of(&study),
        data_dir: arguments.data.of(&study),
        pilot: arguments.pilot,
        view,
        session: arguments.session,
        monitor: arguments.monitor.clone().or(measured),
        station,
    };
    let end = experiment::run(&study, &options)?;
    console::print(end)?;
    Ok(())
}

/// This program once more, as the experimenter's view on the monitor named, or on the station's.
fn view(named: Option<String>, station: Option<&StationFile>) -> anyhow::Result<ViewProgram> {
    let program = std::env::current_exe().context("cannot find this program's own file")?;
    let noted = station.and_then(|station| station.experimenter_monitor.clone());
    let mut arguments = vec!["view".to_owned()];
    if let Some(monitor) = named.or(noted) {
        arguments.extend(["--monitor".to_owned(), monitor]);
    }
    Ok(ViewProgram { program, arguments })
}

pub(crate) fn close(arguments: &CloseArguments) -> anyhow::Result<()> {
    let study = Study::read(&arguments.protocol)?;
    let options = RunOptions {
        subject: arguments.subject.clone(),
        stimuli_dir: study.default_stimuli_dir(),
        data_dir: arguments.data.of(&study),
        pilot: None,
        view: None,
        session: arguments.session,
        monitor: None,
        station: None,
    };
    let end = experiment::close_session(&study, &options, &arguments.reason)?;
    console::print(format!(
        "subject {}: closed with {} of {} trials rated, in {}",
        end.subject,
        end.rated,
        end.trials,
        end.ratings_path.display()
    ))?;
    Ok(())
}

pub(crate) fn export(arguments: &ExportArguments) -> anyhow::Result<()> {
    let study = Study::read(&arguments.protocol)?;
    let stimuli = arguments.stimuli.of(&study);
    let data = arguments.data.of(&study);
    let sessions = experiment::export_bids(&study, &stimuli, &data, &arguments.bids)?;
    let folder = arguments.bids.display();
    let word = if sessions == 1 { "session" } else { "sessions" };
    console::print(format!("{sessions} {word} in {folder}"))?;
    Ok(())
}

pub(crate) fn simulate(arguments: &SimulateArguments, progress: Progress) -> anyhow::Result<()> {
    let study = Study::read(&arguments.protocol)?;
    let stimuli = arguments.stimuli.of(&study);
    let data = arguments
        .data
        .clone()
        .unwrap_or_else(|| study.default_data_dir(Observer::Simulated));
    let description = DataSet::new(&data, &study.protocol.study).description_path();
    if description.exists() && !arguments.replace {
        let expected = "a folder without ratings";
        return Err(InputError::new(&data, "a data set", expected)
            .remedy(
                "say --replace to replace simulated ratings, or name another folder with --data",
            )
            .into());
    }
    let observers = Observers {
        number: arguments.subjects,
        seed: arguments.seed,
    };
    rate_by_model(&study, (&stimuli, &data), observers, progress)
}

/// Which simulated observers take part.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Observers {
    pub(crate) number: u32,
    pub(crate) seed: u64,
}

/// Lets simulated observers rate a set into a data folder, and prints who did.
pub(crate) fn rate_by_model(
    study: &Study,
    (stimuli, data): (&Path, &Path),
    Observers { number, seed }: Observers,
    progress: Progress,
) -> anyhow::Result<()> {
    let summary = progress.of("simulate", |told| {
        experiment::simulate(study, stimuli, data, number, seed, told)
    })?;
    console::print(summary)?;
    Ok(())
}
