//! What can go wrong between a table of ratings and a report.

use std::io;
use std::path::PathBuf;

use protocols::{InputError, ReadError};

/// Why an analysis gave no result.
#[derive(Debug, thiserror::Error)]
pub enum AnalysisError {
    /// The table, the ratings or the design cannot be used; the text says what to do.
    #[error(transparent)]
    Input(#[from] InputError),
    /// A file is there but the system would not give it.
    #[error("cannot read \"{}\"", file.display())]
    Read {
        /// The file.
        file: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// A file could not be written.
    #[error("cannot write \"{}\"", file.display())]
    Write {
        /// The file.
        file: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// A figure could not be turned into pixels.
    #[error("cannot draw the figure: {0}")]
    Figure(String),
}

impl AnalysisError {
    /// Whether the user's input is at fault (exit code 2) and not the system (exit code 1).
    pub fn is_input(&self) -> bool {
        matches!(self, Self::Input(_))
    }
}

impl From<ReadError> for AnalysisError {
    fn from(error: ReadError) -> Self {
        match error {
            ReadError::Input(error) => Self::Input(error),
            ReadError::Io { file, source } => Self::Read { file, source },
        }
    }
}
