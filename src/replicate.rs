//! `acuity replicate`: the paper's study end to end, with simulated observers.

use analysis::Pilots;
use protocols::{Observer, Study};

use crate::analyse::{Place, write_report};
use crate::command_line::ReplicateArguments;
use crate::console::Progress;
use crate::render::make_set;
use crate::sit::{Observers, rate_by_model};

/// Render, simulate, report; prints the path of the report last.
pub(crate) fn replicate(arguments: &ReplicateArguments, progress: Progress) -> anyhow::Result<()> {
    let study = Study::read(&arguments.protocol)?;
    let stimuli = study.default_stimuli_dir();
    let data = study.default_data_dir(Observer::Simulated);

    make_set(&study, &stimuli, None, progress)?;
    let observers = Observers {
        number: arguments.subjects,
        seed: arguments.seed,
    };
    rate_by_model(&study, (&stimuli, &data), observers, progress)?;
    write_report(&study, &data, Place::default(), Pilots::LeftOut)
}
