//! `acuity replicate`: the paper's study end to end, with simulated observers.

use analysis::Pilots;
use protocols::{Observer, Study};

use crate::analyse::write_report;
use crate::command_line::ReplicateArguments;
use crate::console::{self, Progress};

/// Render, simulate, report; prints the path of the report last.
pub(crate) fn replicate(arguments: &ReplicateArguments, progress: Progress) -> anyhow::Result<()> {
    let study = Study::read(&arguments.protocol)?;
    let stimuli = study.default_stimuli_dir();
    let data = study.default_data_dir(Observer::Simulated);

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
    write_report(&study, &data, None, Pilots::LeftOut)
}
