//! Is everything ready for the first subject?

use std::env;
use std::path::Path;

use protocols::{DataSet, Observer, Study};

use crate::{data_set_files, script_fonts, stimulus_set};

/// What is not ready for a session of `study`: one line for each thing; empty when all is.
///
/// Nothing is written but a trial file in the folder that will hold the ratings, which goes away at once.
pub fn check_ready(study: &Study, stimuli_dir: &Path, data_dir: &Path) -> Vec<String> {
    let mut faults = stimulus_set::faults(study, stimuli_dir);
    faults.extend(session_hindrances(study, data_dir));
    faults.extend(script_fonts::text_faults(study));
    faults.extend(display_fault());
    faults
}

/// What would end a session of `study` before its first screen, beside stimuli, station and display: an order that
/// cannot be, a data folder that is another study's or takes no file.
///
/// Nothing is written but a trial file, as in [`check_ready`].
pub fn session_hindrances(study: &Study, data_dir: &Path) -> Vec<String> {
    let faults = [order_fault(study), data_fault(study, data_dir)];
    faults.into_iter().flatten().collect()
}

/// Whether the protocol's limits leave the first subject an order.
fn order_fault(study: &Study) -> Option<String> {
    let subject = "01".parse().ok()?;
    let order = crate::trials(study, &subject, 1);
    order.err().map(|error| error.to_string())
}

fn data_fault(study: &Study, data_dir: &Path) -> Option<String> {
    let data_set = DataSet::new(data_dir, &study.protocol.study);
    if data_set.description_path().exists() {
        let checked = data_set_files::check(&data_set, study, Observer::Person);
        if let Err(error) = checked {
            return Some(error.to_string());
        }
    }
    let sessions = data_set.data_folder();
    let above = sessions.ancestors().find(|folder| folder.exists());
    let folder = match above {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let tried = tempfile::Builder::new()
        .prefix(".acuity-check-")
        .tempfile_in(folder);
    tried.err().map(|error| {
        let folder = folder.display();
        format!("\"{folder}\": found a folder that takes no file ({error}), expected to write the ratings there; make it writable for you, or name another with --data")
    })
}

fn display_fault() -> Option<String> {
    let is_set = env::var_os("DISPLAY").is_some_and(|display| !display.is_empty());
    (!is_set).then(|| {
        "display: found no DISPLAY, expected an X11 display for the session's window; log in to the desktop".to_owned()
    })
}
