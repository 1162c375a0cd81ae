//! From an error to the exit code: 2 where the input or the command is wrong, 130 where the user ended the
//! work, 1 for all else.

use std::process::ExitCode;

use analysis::AnalysisError;
use experiment::ExperimentError;
use protocols::{InputError, ReadError};
use renderer::RendererError;

/// What a shell gives for a program that Ctrl-C ended: 128 + SIGINT.
pub(crate) const INTERRUPTED: u8 = 130;

/// The exit code of an error of any crate.
pub(crate) fn of(error: &anyhow::Error) -> ExitCode {
    let is_input = error
        .downcast_ref::<RendererError>()
        .is_some_and(RendererError::is_input)
        || error
            .downcast_ref::<ExperimentError>()
            .is_some_and(ExperimentError::is_input)
        || error
            .downcast_ref::<AnalysisError>()
            .is_some_and(AnalysisError::is_input)
        || matches!(error.downcast_ref(), Some(ReadError::Input(_)))
        || error.is::<InputError>();
    let is_interruption = error
        .downcast_ref::<RendererError>()
        .is_some_and(RendererError::is_interruption);
    ExitCode::from(match (is_interruption, is_input) {
        (true, _) => INTERRUPTED,
        (false, true) => 2,
        (false, false) => 1,
    })
}
