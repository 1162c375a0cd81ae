//! What every page is given, and what it may ask for in return.

use std::path::PathBuf;
use std::sync::Arc;

use eframe::egui::Context;

use super::job::{Job, WhenDropped};
use super::launcher::{Ended, Launcher};
use super::study_state::{Place, StudyState};

/// What a page works with.
#[derive(Clone)]
pub(crate) struct Tools {
    /// Starts sessions and opens reports.
    pub(crate) launcher: Arc<dyn Launcher>,
    /// Where the study is worked on.
    pub(crate) place: Place,
}

/// What a page is about.
#[derive(Clone, Copy)]
pub(crate) struct Around<'a> {
    /// The study as it was last read.
    pub(crate) state: &'a StudyState,
    pub(crate) tools: &'a Tools,
    /// Why nothing heavy may begin now, if so.
    pub(crate) hold: Option<&'static str>,
}

/// What a page asks for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Asked {
    /// Nothing.
    #[default]
    Nothing,
    /// The sessions may have changed; nothing else is looked at.
    ReadSessions,
    /// The files have changed, or may have.
    ReadAgain,
}

/// `acuity` with these words, in the working folder, as a process of its own.
pub(crate) fn launch(
    context: &Context,
    tools: &Tools,
    arguments: Vec<std::ffi::OsString>,
) -> Job<std::io::Result<Ended>> {
    let launcher = Arc::clone(&tools.launcher);
    let root = tools.place.root.clone();
    Job::start(context, WhenDropped::Leave, move |_| {
        launcher.run(&root, &arguments)
    })
}

/// Opens a file in the desktop's own program; the answer is the file, if that failed.
pub(crate) fn open(context: &Context, tools: &Tools, file: PathBuf) -> Job<Option<PathBuf>> {
    let launcher = Arc::clone(&tools.launcher);
    Job::start(context, WhenDropped::Leave, move |_| {
        launcher.open(&file).is_err().then_some(file)
    })
}
