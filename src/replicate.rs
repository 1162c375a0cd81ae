//! `acuity replicate`: the paper's study end to end, with simulated observers.

use analysis::Pilots;
use protocols::Study;

use crate::analyse::{report_dir, write_report};
use crate::command_line::ReplicateArguments;
use crate::console::{self, Progress};

/// Render, simulate, report; prints the path of the report last.
pub(crate) fn replicate(arguments: &ReplicateArguments, progress: Progress) -> anyhow::Result<()> {
    let study = Study::read(&arguments.protocol)?;
    let stimuli = study.default_stimuli_dir();
    let data = study.default_simulated_data_dir();
    let out = report_dir(&study, &data);

    let set = progress.of("render", |told| {
        renderer::render_set(&study, &stimuli, None, told)
    })?;
    console::print(set)?;
    let ratings = progress.of("simulate", |told| {
        experiment::simulate(
            &study,
            &stimuli,
            &data,
            arguments.subjects,
            arguments.seed,
            told,
        )
    })?;
    console::print(ratings)?;
    write_report(&study, &data, &out, Pilots::LeftOut)
}
