//! What is said of a file that cannot be used: where, what was found, what was expected, what to do.

use std::fmt;
use std::path::{Path, PathBuf};

/// A file, or a command, that is wrong; the program ends with exit code 2.
///
/// Printed as one paragraph: `"ratings.csv", line 7, column rating: found "x", expected a whole number
/// from 0 to 10; correct the line or remove it`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InputError {
    file: PathBuf,
    place: Option<String>,
    found: String,
    expected: String,
    remedy: Option<String>,
}

impl InputError {
    /// An error in `file`: what was `found` there, and what was `expected`.
    pub fn new(
        file: impl Into<PathBuf>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        Self {
            file: file.into(),
            place: None,
            found: found.into(),
            expected: expected.into(),
            remedy: None,
        }
    }

    /// The same error with its place in the file: a line, a field, a column.
    #[must_use]
    pub fn at(self, place: impl Into<String>) -> Self {
        Self {
            place: Some(place.into()),
            ..self
        }
    }

    /// The same error with what the user should do.
    #[must_use]
    pub fn remedy(self, remedy: impl Into<String>) -> Self {
        Self {
            remedy: Some(remedy.into()),
            ..self
        }
    }

    /// The file that is wrong.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// Where in the file.
    pub fn place(&self) -> Option<&str> {
        self.place.as_deref()
    }

    /// What is there.
    pub fn found(&self) -> &str {
        &self.found
    }

    /// What should be there.
    pub fn expected(&self) -> &str {
        &self.expected
    }

    /// What the user should do.
    pub fn advice(&self) -> Option<&str> {
        self.remedy.as_deref()
    }
}

impl fmt::Display for InputError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "\"{}\"", self.file.display())?;
        if let Some(place) = &self.place {
            write!(formatter, ", {place}")?;
        }
        write!(
            formatter,
            ": found {}, expected {}",
            self.found, self.expected
        )?;
        match &self.remedy {
            Some(remedy) => write!(formatter, "; {remedy}"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for InputError {}

/// Why a file of the contract could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The file says something that cannot be used, or is not there.
    #[error(transparent)]
    Input(#[from] InputError),
    /// The file is there but the system would not give it.
    #[error("cannot read \"{}\"", file.display())]
    Io {
        /// The file.
        file: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
}

impl ReadError {
    /// What an I/O error on `file` means: a missing file is the user's to mend, all else the system's.
    ///
    /// `kind` says what the file should have been, such as `a protocol (TOML)`.
    pub fn from_io(file: &Path, kind: &str, source: std::io::Error) -> Self {
        match source.kind() {
            std::io::ErrorKind::IsADirectory => InputError::new(file, "a folder", kind).into(),
            std::io::ErrorKind::NotADirectory => {
                InputError::new(file, "a file where a folder should be", kind).into()
            }
            std::io::ErrorKind::NotFound => {
                InputError::new(file, format!("no such file ({source})"), kind).into()
            }
            std::io::ErrorKind::InvalidData => {
                InputError::new(file, "bytes that are not UTF-8 text", kind).into()
            }
            _ => Self::Io {
                file: file.to_owned(),
                source,
            },
        }
    }
}
