//! Everything that can go wrong between a scene file and a stimulus set.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use protocols::{InputError, ReadError};

/// Why a picture or a stimulus set was not made.
#[derive(Debug, thiserror::Error)]
pub enum RendererError {
    /// A scene, protocol, manifest or image is wrong, or a command asks for what cannot be.
    #[error(transparent)]
    Input(#[from] InputError),
    /// The system refused a file.
    #[error("cannot {action} \"{}\"", path.display())]
    Io {
        /// What was tried: `read`, `write`.
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// An image or a figure could not be encoded.
    #[error("cannot encode \"{}\": {reason}", path.display())]
    Encoding {
        /// The file that was to be written.
        path: PathBuf,
        /// What the encoder said.
        reason: String,
    },
    /// The caller ended the work; what was done is kept.
    #[error(
        "interrupted after {rays} of {of_rays} rays; they are kept in \"{}\": give the same command again to go on",
        checkpoint.display()
    )]
    Interrupted {
        /// The file that holds the samples taken so far.
        checkpoint: PathBuf,
        /// How many there are.
        rays: u64,
        /// How many were asked for.
        of_rays: u64,
    },
}

impl RendererError {
    /// Whether the input or the command is wrong (exit code 2), rather than the system (exit code 1).
    pub fn is_input(&self) -> bool {
        matches!(self, Self::Input(_))
    }

    /// Whether the caller ended the work (exit code 130).
    pub fn is_interruption(&self) -> bool {
        matches!(self, Self::Interrupted { .. })
    }

    /// A refusal to write `path`.
    ///
    /// A file that stands where a folder must be is the user's to move.
    pub(crate) fn writing(path: &Path, source: std::io::Error) -> Self {
        let kind = source.kind();
        if matches!(kind, ErrorKind::NotADirectory | ErrorKind::AlreadyExists) {
            let found = "a file where a folder should be";
            let error = InputError::new(path, found, "a place for a file");
            return error.remedy("name another folder or move the file").into();
        }
        Self::Io {
            action: "write",
            path: path.to_owned(),
            source,
        }
    }
}

impl From<ReadError> for RendererError {
    fn from(error: ReadError) -> Self {
        match error {
            ReadError::Input(error) => Self::Input(error),
            ReadError::Io { file, source } => Self::Io {
                action: "read",
                path: file,
                source,
            },
        }
    }
}
