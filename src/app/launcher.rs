//! Sessions and other windows as processes of their own, so that they outlive the app whatever happens to it.

use std::ffi::OsString;
use std::fs::File;
use std::io::{self, Read as _, Seek as _, SeekFrom};
use std::os::unix::process::CommandExt as _;
use std::path::Path;
use std::process::{Command, Stdio};

/// How a process ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Ended {
    /// Its exit code; `None` if a signal ended it.
    pub(crate) code: Option<i32>,
    /// What it printed.
    pub(crate) said: String,
}

/// Starts this program again with other words, and waits for its end.
pub(crate) trait Launcher: Send + Sync {
    /// Runs `acuity` with `arguments` in `folder` and waits for its end.
    ///
    /// # Errors
    ///
    /// It could not be started.
    fn run(&self, folder: &Path, arguments: &[OsString]) -> io::Result<Ended>;

    /// Opens a file in the program that the desktop has for it.
    ///
    /// # Errors
    ///
    /// There is no such program, or it failed.
    fn open(&self, file: &Path) -> io::Result<()>;
}

/// The real one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Processes;

impl Launcher for Processes {
    fn run(&self, folder: &Path, arguments: &[OsString]) -> io::Result<Ended> {
        // A file, not a pipe: a session whose app is gone must not notice it.
        let mut said = tempfile::tempfile()?;
        let status = Command::new(std::env::current_exe()?)
            .args(arguments)
            .current_dir(folder)
            .stdin(Stdio::null())
            .stdout(said.try_clone()?)
            .stderr(said.try_clone()?)
            // Ctrl-C in the app's terminal is not for the session.
            .process_group(0)
            .status()?;
        Ok(Ended {
            code: status.code(),
            said: read_back(&mut said)?,
        })
    }

    fn open(&self, file: &Path) -> io::Result<()> {
        let status = Command::new("xdg-open")
            .arg(file)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status()?;
        if status.success() {
            return Ok(());
        }
        Err(io::Error::other(format!("xdg-open ended with {status}")))
    }
}

fn read_back(file: &mut File) -> io::Result<String> {
    let mut bytes = Vec::new();
    file.seek(SeekFrom::Start(0))?;
    file.read_to_end(&mut bytes)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
