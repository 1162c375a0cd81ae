//! Every frame and every event of a session, in two small tables beside the data set's ratings.
//!
//! `timing/<session>_frames.csv` has a line for each run of frames with one screen; `timing/<session>_events.csv`
//! a line for each event. Both grow after each rating and at the end, a whole line at a time, and are not
//! synced: a crash may cost the frames of the trial that it cut off, never a rating.

use std::fs::OpenOptions;
use std::io::Write as _;
use std::os::unix::fs::{FileExt as _, OpenOptionsExt as _};
use std::path::{Path, PathBuf};

use jiff::Timestamp;
use protocols::DataSet;
use protocols::rating::Column;

use crate::rating_row::utc;
use crate::{ExperimentError, FrameLog, Note, data_set_files};

/// The columns of both tables that the ratings do not have, with unit and meaning.
const COLUMNS: [(&str, Option<&str>, &str); 8] = [
    (
        "sitting",
        None,
        "sitting of the session, from 1: a resumed session has more",
    ),
    ("screen", None, "what the frames showed"),
    (
        "began_us",
        Some("us"),
        "first frame of the run, on the clock of the sitting",
    ),
    (
        "intervals_us",
        Some("us"),
        "times from each frame of the run to the next, with spaces between",
    ),
    (
        "at_us",
        Some("us"),
        "the event, on the clock of the sitting",
    ),
    ("at_utc", None, "the event, UTC, ISO 8601"),
    ("event", None, "what happened"),
    (
        "detail",
        None,
        "more about it, in words or a number with its unit",
    ),
];
const FRAMES_HEADER: &str = "sitting,trial_id,screen,began_us,intervals_us\n";
const EVENTS_HEADER: &str = "sitting,at_us,at_utc,trial_id,event,detail\n";

/// The two tables of one session.
#[derive(Debug)]
pub(crate) struct TimingLog {
    frames: PathBuf,
    events: PathBuf,
    clock_zero: Timestamp,
    /// Which sitting of the session this is, from 1.
    sitting: usize,
}

/// The columns that the two tables add to the data set.
pub(crate) fn columns() -> impl Iterator<Item = Column> {
    COLUMNS.into_iter().map(|(name, unit, description)| Column {
        name: name.to_owned(),
        description: description.to_owned(),
        unit,
    })
}

impl TimingLog {
    /// The tables that belong to a ratings file.
    pub(crate) fn beside(
        data_set: &DataSet,
        ratings: &Path,
        clock_zero: Timestamp,
    ) -> Result<Self, ExperimentError> {
        let folder = data_set.root().join("timing");
        data_set_files::create_private_folder(&folder)?;
        let stem = ratings.file_stem().unwrap_or_default().to_string_lossy();
        let stem = stem.trim_end_matches("_data");
        Ok(Self {
            frames: folder.join(format!("{stem}_frames.csv")),
            events: folder.join(format!("{stem}_events.csv")),
            clock_zero,
            sitting: 1,
        })
    }

    /// Says which sitting the lines to come belong to.
    pub(crate) fn begin(&mut self, sitting: usize) {
        self.sitting = sitting;
    }

    /// Adds frames and events.
    pub(crate) fn append(&self, frames: &FrameLog, notes: &[Note]) -> Result<(), ExperimentError> {
        let sitting = self.sitting;
        let mut lines = Vec::new();
        for run in frames.runs() {
            let intervals: Vec<String> = run.intervals_us.iter().map(u64::to_string).collect();
            let (trial, screen, began) = (run.trial + 1, run.screen, run.began_us);
            let intervals = intervals.join(" ");
            lines.push(format!(
                "{sitting},{trial},{screen},{began},{intervals}
"
            ));
        }
        append_lines(&self.frames, FRAMES_HEADER, &lines.concat())?;
        let mut lines = Vec::new();
        for note in notes {
            let at_us = (note.at_s * 1e6).round();
            let at_utc = utc(self.clock_zero, note.at_s);
            let detail = note.detail.replace(['"', '\n', '\r'], " ");
            let (trial, event) = (note.trial + 1, note.event.as_str());
            lines.push(format!(
                "{sitting},{at_us},{at_utc},{trial},{event},\"{detail}\"\n"
            ));
        }
        append_lines(&self.events, EVENTS_HEADER, &lines.concat())
    }
}

/// Appends lines in one write; a new file begins with the header. A line that was torn is ended first, so that it costs
/// no other.
fn append_lines(path: &Path, header: &str, lines: &str) -> Result<(), ExperimentError> {
    if lines.is_empty() {
        return Ok(());
    }
    let write = || {
        let mut file = OpenOptions::new()
            .read(true)
            .append(true)
            .create(true)
            .mode(0o600)
            .open(path)?;
        let length = file.metadata()?.len();
        let mut last = [b'\n'];
        if length > 0 {
            file.read_exact_at(&mut last, length - 1)?;
        }
        let before = match (length, last) {
            (0, _) => header,
            (_, [b'\n']) => "",
            _ => "\n",
        };
        let text = [before, lines].concat();
        file.write_all(text.as_bytes())
    };
    write().map_err(ExperimentError::io("write", path))
}
