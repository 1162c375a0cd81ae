//! `acuity check`, `run` and `simulate`: from stimuli to ratings.

use std::process::ExitCode;

use experiment::RunOptions;
use protocols::{Observer, Study};

use crate::command_line::{CheckArguments, RunArguments, SimulateArguments};
use crate::console::{self, Progress};

pub(crate) fn check(arguments: &CheckArguments) -> anyhow::Result<ExitCode> {
    let study = Study::read(&arguments.protocol)?;
    let stimuli = arguments.stimuli.of(&study);
    let data = arguments.data.of(&study);
    let missing = experiment::check_ready(&study, &stimuli, &data);
    if missing.is_empty() {
        console::print("ready")?;
        return Ok(ExitCode::SUCCESS);
    }
    for line in &missing {
        console::print(format!("not ready: {line}"))?;
    }
    Ok(ExitCode::from(2))
}

pub(crate) fn run(arguments: &RunArguments) -> anyhow::Result<()> {
    let study = Study::read(&arguments.protocol)?;
    let options = RunOptions {
        subject: arguments.subject.clone(),
        stimuli_dir: arguments.stimuli.of(&study),
        data_dir: arguments.data.of(&study),
        pilot: arguments.pilot,
    };
    let end = experiment::run(&study, &options)?;
    console::print(end)?;
    Ok(())
}

pub(crate) fn simulate(arguments: &SimulateArguments, progress: Progress) -> anyhow::Result<()> {
    let study = Study::read(&arguments.protocol)?;
    let stimuli = arguments.stimuli.of(&study);
    let data = arguments
        .data
        .clone()
        .unwrap_or_else(|| study.default_data_dir(Observer::Simulated));
    let summary = progress.of("simulate", |told| {
        experiment::simulate(
            &study,
            &stimuli,
            &data,
            arguments.subjects,
            arguments.seed,
            told,
        )
    })?;
    console::print(summary)?;
    Ok(())
}
