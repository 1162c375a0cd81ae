//! `acuity predict`: the ratings that two models of vision expect.

use std::path::PathBuf;

use anyhow::Context as _;
use experiment::StimulusSet;
use protocols::{Access, Study, write_atomically};

use crate::command_line::PredictArguments;
use crate::console;

/// Prints the predictions and writes them where the report looks for them.
pub(crate) fn predict(arguments: &PredictArguments) -> anyhow::Result<()> {
    let study = Study::read(&arguments.protocol)?;
    let set = StimulusSet::read(&study, &arguments.stimuli.of(&study))?;
    let predictions = experiment::predict(&study, &set)?;
    let file = arguments
        .out
        .clone()
        .unwrap_or_else(|| default_file(&study));
    write_atomically(&file, predictions.to_csv().as_bytes(), Access::Owner)
        .with_context(|| format!("cannot write \"{}\"", file.display()))?;
    console::print(predictions.to_text())?;
    console::print(file.display())?;
    Ok(())
}

/// Where predictions stand unless the user says otherwise.
pub(crate) fn default_file(study: &Study) -> PathBuf {
    format!("reports/{}-predicted/predictions.csv", study.protocol.study).into()
}
