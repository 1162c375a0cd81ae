//! `acuity check`, `run` and `simulate`: from stimuli to ratings.

use std::process::ExitCode;

use experiment::RunOptions;
use protocols::Study;

use crate::command_line::{CheckArguments, RunArguments, SimulateArguments};
use crate::console::Console;

pub(crate) fn check(arguments: &CheckArguments, console: &Console) -> anyhow::Result<ExitCode> {
    let study = Study::read(&arguments.protocol)?;
    let stimuli = arguments
        .stimuli
        .clone()
        .unwrap_or_else(|| study.default_stimuli_dir());
    let data = arguments
        .data
        .clone()
        .unwrap_or_else(|| study.default_data_dir());
    let missing = experiment::check_ready(&study, &stimuli, &data);
    if missing.is_empty() {
        console.result("ready")?;
        return Ok(ExitCode::SUCCESS);
    }
    for line in &missing {
        console.result(&format!("not ready: {line}"))?;
    }
    Ok(ExitCode::from(2))
}

pub(crate) fn run(arguments: &RunArguments, console: &Console) -> anyhow::Result<()> {
    let study = Study::read(&arguments.protocol)?;
    let options = RunOptions {
        subject: arguments.subject.clone(),
        stimuli_dir: arguments
            .stimuli
            .clone()
            .unwrap_or_else(|| study.default_stimuli_dir()),
        data_dir: arguments
            .data
            .clone()
            .unwrap_or_else(|| study.default_data_dir()),
        pilot: arguments.pilot,
    };
    let end = experiment::run(&study, &options)?;
    console.result(&end.to_string())?;
    Ok(())
}

pub(crate) fn simulate(arguments: &SimulateArguments, console: &Console) -> anyhow::Result<()> {
    let study = Study::read(&arguments.protocol)?;
    let stimuli = arguments
        .stimuli
        .clone()
        .unwrap_or_else(|| study.default_stimuli_dir());
    let data = arguments
        .data
        .clone()
        .unwrap_or_else(|| study.default_simulated_data_dir());
    let summary = console.with_progress("simulate", |progress| {
        experiment::simulate(
            &study,
            &stimuli,
            &data,
            arguments.subjects,
            arguments.seed,
            progress,
        )
    })?;
    console.result(&summary.to_string())?;
    Ok(())
}
