//! The ratings of one session on disk: appended row by row, never rewritten.
//!
//! A row is one `write_all`, then `fsync`; only then may the next trial begin. So a crash can tear the
//! last line, but never one that the session went on from: the torn line is cut off when the session is
//! resumed. The file is locked while it is open.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read as _, Seek as _, SeekFrom, Write as _};
use std::os::unix::fs::{MetadataExt as _, OpenOptionsExt as _};
use std::path::{Path, PathBuf};

use protocols::rating::{RatingRow, header_line, read_ratings};
use protocols::{DataSet, InputError};

use crate::sidecar::SessionKey;
use crate::{ExperimentError, Trial};

/// An open ratings file.
#[derive(Debug)]
pub(crate) struct RatingsLog {
    file: File,
    path: PathBuf,
    ratings: Vec<i32>,
}

impl Drop for RatingsLog {
    /// Gives the lock back at once: closing the file alone would leave it to a program that is just being
    /// started by another thread, until that program is in place of its copy of this one.
    fn drop(&mut self) {
        // A lock that cannot be given back goes with the file.
        _ = self.file.unlock();
    }
}

impl RatingsLog {
    /// Opens the ratings of a session, whose trials are `trials`, and locks them.
    pub(crate) fn open(
        data_set: &DataSet,
        key: &SessionKey,
        trials: &[Trial],
        factors: &[String],
    ) -> Result<Self, ExperimentError> {
        let path = data_set.ratings_path(&key.subject_id, key.session_id, key.task());
        let mut file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .mode(0o600)
            .open(&path)
            .map_err(ExperimentError::io("open", &path))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                let subject = key.subject_id.clone();
                return Err(ExperimentError::Busy {
                    subject,
                    holder: holder(&file),
                    file: path,
                });
            }
            Err(TryLockError::Error(error)) => {
                return Err(ExperimentError::io("lock", &path)(error));
            }
        }
        let found = read_ratings(&path, factors)?;
        check_order(&path, &found.rows, key, trials)?;
        let header = (found.whole_bytes == 0).then(|| header_line(factors));
        mend(&mut file, found.whole_bytes, header.as_deref())
            .and_then(|()| File::open(data_set.data_folder())?.sync_all())
            .map_err(ExperimentError::io("write", &path))?;
        Ok(Self {
            file,
            path,
            ratings: found.rows.iter().map(|row| row.rating).collect(),
        })
    }

    /// The open file and its lock once more, as a program that is being started holds them for a moment.
    #[cfg(test)]
    pub(crate) fn held_elsewhere(&self) -> File {
        self.file.try_clone().unwrap()
    }

    /// How many trials are on disk.
    pub(crate) fn rated(&self) -> usize {
        self.ratings.len()
    }

    /// The ratings on disk, in the order of the trials.
    pub(crate) fn ratings(&self) -> &[i32] {
        &self.ratings
    }

    /// The file.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Writes one row; it is on disk when this returns.
    pub(crate) fn append(&mut self, row: &RatingRow) -> Result<(), ExperimentError> {
        self.file
            .write_all(row.to_line().as_bytes())
            .and_then(|()| self.file.sync_data())
            .map_err(ExperimentError::io("write", &self.path))?;
        self.ratings.push(row.rating);
        Ok(())
    }

    /// Whether the file is still where it was opened: a file that was removed takes writes all the same.
    pub(crate) fn is_in_place(&self) -> bool {
        let identity = |metadata: std::fs::Metadata| (metadata.dev(), metadata.ino());
        let here = self.file.metadata().map(identity);
        let there = std::fs::metadata(&self.path).map(identity);
        matches!((here, there), (Ok(here), Ok(there)) if here == there)
    }

    /// Every row written so far, from the open file, wherever that is.
    pub(crate) fn read_back(&mut self) -> Result<Vec<u8>, ExperimentError> {
        let mut bytes = Vec::new();
        self.file
            .seek(SeekFrom::Start(0))
            .and_then(|_| self.file.read_to_end(&mut bytes))
            .map_err(ExperimentError::io("read", &self.path))?;
        Ok(bytes)
    }
}

/// The process that holds the lock of a file, as `/proc/locks` has it: by device (major and minor, hexadecimal) and
/// inode.
fn holder(file: &File) -> Option<u32> {
    let metadata = file.metadata().ok()?;
    let (device, inode) = (metadata.dev(), metadata.ino());
    let major = (device >> 8 & 0xfff) | (device >> 32 & !0xfff);
    let minor = (device & 0xff) | (device >> 12 & !0xff);
    let wanted = format!("{major:02x}:{minor:02x}:{inode}");
    let locks = std::fs::read_to_string("/proc/locks").ok()?;
    let mut lines = locks.lines().map(|line| line.split_whitespace());
    lines.find_map(|mut words| {
        let (kind, process) = (words.nth(1)?, words.nth(2)?);
        let is_it = kind == "FLOCK" && words.next()? == wanted;
        is_it.then(|| process.parse().ok())?
    })
}

/// Cuts off what lies beyond the whole lines, writes the header of a file that has none, and goes to the
/// end.
fn mend(file: &mut File, whole_bytes: u64, header: Option<&str>) -> std::io::Result<()> {
    file.set_len(whole_bytes)?;
    file.seek(SeekFrom::End(0))?;
    file.write_all(header.unwrap_or_default().as_bytes())?;
    file.sync_all()
}

/// Checks that the rows are the beginning of this session in its order.
fn check_order(
    path: &Path,
    rows: &[RatingRow],
    key: &SessionKey,
    trials: &[Trial],
) -> Result<(), InputError> {
    if rows.len() > trials.len() {
        let found = format!("{} rows", rows.len());
        return Err(InputError::new(
            path,
            found,
            format!("at most the {} trials of the protocol", trials.len()),
        ));
    }
    for (line, (row, trial)) in (2..).zip(rows.iter().zip(trials)) {
        let is_same_session = row.subject_id == key.subject_id
            && row.session_id == key.session_id
            && row.observer == key.observer
            && row.pilot == key.pilot_speed.is_some();
        let is_same_trial = row.trial_id == trial.trial_id
            && row.phase == trial.phase
            && row.stimulus_id == trial.stimulus_id
            && row.repetition == trial.repetition
            && row.levels == trial.levels;
        if !(is_same_session && is_same_trial) {
            let found = format!(
                "subject {}, session {}, trial {}, stimulus {}",
                row.subject_id, row.session_id, row.trial_id, row.stimulus_id
            );
            let expected = format!(
                "subject {}, session {}, trial {}, stimulus {} (the subject's own order)",
                key.subject_id, key.session_id, trial.trial_id, trial.stimulus_id
            );
            return Err(InputError::new(path, found, expected)
                .at(format!("line {line}"))
                .remedy("the file was changed or belongs to another protocol: restore it, or take another subject code"));
        }
    }
    Ok(())
}
