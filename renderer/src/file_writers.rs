//! Files written by threads of their own, while others make the next ones.
//!
//! To write a file so that it outlasts a power cut is mostly to wait for the disk, and a disk settles many files
//! in the time of one. So many threads wait, and none of them is one that computes.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Mutex, PoisonError};
use std::thread;

use protocols::{Access, settle_names, write_unsettled};

use crate::error::RendererError;

/// Files that are written one after another.
pub(crate) type Files = Vec<(PathBuf, Vec<u8>)>;

/// No more writers than this: beyond, nothing was gained on an SSD.
const MOST_WRITERS: u64 = 28;

/// No more bytes than this wait to be written, but always those of one picture.
const MOST_BYTES: u64 = 1 << 28;

/// How many writers there may be for pictures of this size, as EXR (12 bytes a pixel) and PNG.
pub(crate) fn writers_for(size_px: [u32; 2]) -> u64 {
    let bytes = 16 * u64::from(size_px[0]) * u64::from(size_px[1]);
    (MOST_BYTES / bytes.max(1)).clamp(1, MOST_WRITERS)
}

/// Calls `work` with a way to hand over files of the folder `out`, and waits until all of them are written.
///
/// `written` is called when what was handed over stands in the folder; with all of it, the names are settled. Files that nobody is free for wait with those who
/// made them, so that no more are held in memory than there are writers.
///
/// # Errors
///
/// That of `work`, or else that of a file that could not be written, or of threads that could not be started.
pub(crate) fn while_writing<T>(
    writers: u64,
    out: &Path,
    written: &(dyn Fn() + Sync),
    work: impl FnOnce(&SyncSender<Files>) -> Result<T, RendererError>,
) -> Result<T, RendererError> {
    let (sender, receiver) = sync_channel(0);
    let receiver = Mutex::new(receiver);
    thread::scope(|scope| {
        let start = |_| {
            let writer = || write_received(&receiver, written);
            thread::Builder::new().spawn_scoped(scope, writer)
        };
        let threads: Result<Vec<_>, _> = (0..writers).map(start).collect();
        let made = match &threads {
            Ok(_) => work(&sender),
            Err(error) => Err(RendererError::Encoding {
                path: out.to_owned(),
                reason: error.to_string(),
            }),
        };
        drop(sender);
        let outcomes: Result<Vec<()>, RendererError> = threads
            .into_iter()
            .flatten()
            .map(|thread| {
                thread
                    .join()
                    .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
            })
            .collect();
        let made = made?;
        outcomes?;
        settle_names(out).map_err(|error| RendererError::writing(out, error))?;
        Ok(made)
    })
}

/// Writes what is handed over until the sender is gone; after an error takes the rest and writes none of it.
fn write_received(
    receiver: &Mutex<Receiver<Files>>,
    written: &(dyn Fn() + Sync),
) -> Result<(), RendererError> {
    let next = || {
        let receiver = receiver.lock().unwrap_or_else(PoisonError::into_inner);
        receiver.recv()
    };
    let mut outcome = Ok(());
    while let Ok(files) = next() {
        if outcome.is_ok() {
            outcome = files.iter().try_for_each(|(path, bytes)| {
                write_unsettled(path, bytes, Access::Ordinary)
                    .map_err(|error| RendererError::writing(path, error))
            });
        }
        if outcome.is_ok() {
            written();
        }
    }
    outcome
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    #[test]
    fn every_file_is_written_before_the_call_returns() {
        let folder = tempfile::tempdir().unwrap();
        let path = |place: usize| folder.path().join(place.to_string());
        let count = AtomicUsize::new(0);
        let written = || {
            count.fetch_add(1, Ordering::Relaxed);
        };
        while_writing(3, folder.path(), &written, |sender| {
            for place in (0..40).step_by(2) {
                let file = |place: usize| (path(place), vec![7; place]);
                sender.send(vec![file(place), file(place + 1)]).unwrap();
            }
            Ok(())
        })
        .unwrap();
        assert_eq!(count.into_inner(), 20);
        for place in 0..40 {
            assert_eq!(fs::read(path(place)).unwrap(), vec![7; place]);
        }
    }

    /// More files than writers, all of which fail: nobody waits for ever.
    #[test]
    fn a_file_that_cannot_be_written_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("taken");
        fs::create_dir(&path).unwrap();
        fs::write(path.join("inside"), "old").unwrap();
        let outcome = while_writing(
            2,
            folder.path(),
            &|| unreachable!("nothing is written"),
            |sender| {
                for _ in 0..9 {
                    sender.send(vec![(path.clone(), vec![1])]).unwrap();
                }
                Ok(())
            },
        );
        assert!(
            matches!(outcome, Err(RendererError::Io { .. })),
            "{outcome:?}"
        );
    }
}
