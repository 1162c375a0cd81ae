//! From an error to the exit code: 2 where the input or the command is wrong, 1 for all else.

use std::process::ExitCode;

use analysis::AnalysisError;
use experiment::ExperimentError;
use protocols::ReadError;
use renderer::RendererError;

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
        || matches!(error.downcast_ref(), Some(ReadError::Input(_)));
    ExitCode::from(if is_input { 2 } else { 1 })
}
