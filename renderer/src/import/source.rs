//! A file to import: its bytes, where the files that it names are, and how to speak of it.

use std::fs::File;
use std::io::{self, ErrorKind, Read as _};
use std::path::{Path, PathBuf};

use protocols::{InputError, ReadError};

/// No file larger than this is read.
const LARGEST_BYTES: u64 = 1 << 30;

/// What a file is, by its ending.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Format {
    Gltf,
    Obj,
    Ply,
}

impl Format {
    /// The format of an ending, in either case.
    pub(crate) fn known(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        match ending.as_str() {
            "gltf" | "glb" => Some(Self::Gltf),
            "obj" => Some(Self::Obj),
            "ply" => Some(Self::Ply),
            _ => None,
        }
    }

    /// The format of a file.
    ///
    /// # Errors
    ///
    /// If the ending is none of those known.
    pub(super) fn of(path: &Path) -> Result<Self, InputError> {
        Self::known(path).ok_or_else(|| {
            let found = "a mesh whose ending is not known";
            InputError::new(path, found, "a file that ends in .gltf, .glb, .obj or .ply")
        })
    }
}

/// A file that was read.
#[derive(Debug)]
pub(crate) struct Source {
    pub(super) path: PathBuf,
    pub(super) bytes: Vec<u8>,
}

impl Source {
    /// Reads a file.
    ///
    /// # Errors
    ///
    /// If it is missing, a folder, or larger than a gibibyte.
    pub(crate) fn open(path: &Path) -> Result<Self, ReadError> {
        Ok(Self {
            path: path.to_owned(),
            bytes: bounded_bytes(path)?,
        })
    }

    /// The path of a file that this one names: a relative one stands beside it.
    pub(crate) fn beside(&self, name: &str) -> PathBuf {
        let folder = self.path.parent().unwrap_or(Path::new(""));
        folder.join(name)
    }

    /// An error about the file as a whole.
    pub(super) fn error(
        &self,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> InputError {
        InputError::new(&self.path, found, expected)
    }

    /// A warning about a thing in the file.
    pub(super) fn warning(&self, thing: &str, what: &str) -> String {
        format!("\"{}\", {thing}: {what}", self.path.display())
    }

    /// The file as text.
    ///
    /// # Errors
    ///
    /// If it is not UTF-8.
    pub(super) fn text(&self) -> Result<&str, InputError> {
        std::str::from_utf8(&self.bytes)
            .map_err(|error| self.error(format!("bytes that are not text ({error})"), "UTF-8 text"))
    }
}

/// The bytes of a file, if they are not too many.
///
/// # Errors
///
/// As for [`Source::open`].
pub(crate) fn bounded_bytes(path: &Path) -> Result<Vec<u8>, ReadError> {
    let failed = |error: io::Error| match error.kind() {
        ErrorKind::InvalidInput | ErrorKind::InvalidFilename | ErrorKind::NotADirectory => {
            let found = format!("a name that no file has ({error})");
            InputError::new(path, found, "a file to import").into()
        }
        _ => ReadError::from_io(path, "a file to import", error),
    };
    let file = File::open(path).map_err(failed)?;
    let mut bytes = Vec::new();
    let mut bounded = file.take(LARGEST_BYTES + 1);
    bounded.read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > LARGEST_BYTES {
        let expected = format!("a file of at most {LARGEST_BYTES} bytes");
        return Err(InputError::new(path, "a larger file", expected).into());
    }
    Ok(bytes)
}
