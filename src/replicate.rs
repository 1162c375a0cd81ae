//! `acuity replicate`: the paper's study end to end, with simulated observers.

use analysis::Pilots;
use protocols::Study;

use crate::analyse::{report_dir, write_report};
use crate::command_line::ReplicateArguments;
use crate::console::Console;

/// Render, simulate, report; prints the path of the report last.
pub(crate) fn replicate(arguments: &ReplicateArguments, console: &Console) -> anyhow::Result<()> {
    let study = Study::read(&arguments.protocol)?;
    let stimuli = study.default_stimuli_dir();
    let data = study.default_simulated_data_dir();
    let out = report_dir(&study, &data);

    let set = console.with_progress("render", |progress| {
        renderer::render_set(&study, &stimuli, None, progress)
    })?;
    console.result(&set.to_string())?;
    let ratings = console.with_progress("simulate", |progress| {
        experiment::simulate(
            &study,
            &stimuli,
            &data,
            arguments.subjects,
            arguments.seed,
            progress,
        )
    })?;
    console.result(&ratings.to_string())?;
    write_report(&study, &data, &out, Pilots::LeftOut, console)
}
