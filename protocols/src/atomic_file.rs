//! Writing a file whole or not at all: a temporary file beside it, fsync, rename.

use std::fs::{self, File, Permissions};
use std::io::{self, Write as _};
use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;

/// Who may read a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Only the user who runs the program: all that was made from people's answers.
    Owner,
    /// Whom the user's umask allows: pictures and figures.
    Ordinary,
}

impl Access {
    const fn mode(self) -> u32 {
        match self {
            Self::Owner => 0o600,
            Self::Ordinary => 0o666,
        }
    }
}

/// Writes `bytes` to `path`; a reader sees the old file or the whole new one, even after a power cut.
///
/// # Errors
///
/// Any error of creating, writing, syncing or renaming; the old file then stands untouched.
pub fn write_atomically(path: &Path, bytes: &[u8], access: Access) -> io::Result<()> {
    write_unsettled(path, bytes, access)?;
    settle_names(folder_of(path))
}

/// Writes `bytes` to `path`; a reader sees the old file or the whole new one.
///
/// After a power cut the name may stand for either, until [`settle_names`] was called for the folder: once, after
/// many files.
///
/// # Errors
///
/// As for [`write_atomically`].
pub fn write_unsettled(path: &Path, bytes: &[u8], access: Access) -> io::Result<()> {
    let folder = folder_of(path);
    fs::create_dir_all(folder)?;
    let mut temporary = tempfile::Builder::new()
        .prefix(".writing-")
        .permissions(Permissions::from_mode(access.mode()))
        .tempfile_in(folder)?;
    temporary.write_all(bytes)?;
    temporary.as_file().sync_all()?;
    temporary.persist(path).map_err(|error| error.error)?;
    Ok(())
}

/// Makes the names in a folder outlast a power cut.
///
/// # Errors
///
/// Any error of opening or syncing the folder.
pub fn settle_names(folder: &Path) -> io::Result<()> {
    File::open(folder)?.sync_all()
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_leaves_what_stood_there_and_no_other_file() {
        let folder = tempfile::tempdir().unwrap();
        // A folder cannot be replaced by a file, so the rename fails.
        let path = folder.path().join("kept");
        fs::create_dir(&path).unwrap();
        fs::write(path.join("inside"), "old").unwrap();
        assert!(write_atomically(&path, b"new", Access::Owner).is_err());
        assert_eq!(fs::read(path.join("inside")).unwrap(), b"old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn what_people_answered_is_for_the_owner_only() {
        let folder = tempfile::tempdir().unwrap();
        let mode = |access| {
            let path = folder.path().join("file");
            write_atomically(&path, b"7", access).unwrap();
            fs::metadata(path).unwrap().permissions().mode() & 0o777
        };
        assert_eq!(mode(Access::Owner), 0o600);
        // Whatever the umask is, the owner may read and write, and nobody may execute.
        let ordinary = mode(Access::Ordinary);
        assert_eq!(ordinary & 0o711, 0o600, "{ordinary:o}");
    }
}
