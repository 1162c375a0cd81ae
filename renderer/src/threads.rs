//! Running work on a given number of threads.

use std::num::NonZeroUsize;
use std::path::Path;

use crate::error::RendererError;

/// Calls `work` in a pool of this many threads, one for each core if not said.
///
/// # Errors
///
/// That of `work`, or that of the system if it will not start the threads; `path` names what was being made.
pub(crate) fn on_threads<T: Send>(
    threads: Option<NonZeroUsize>,
    path: &Path,
    work: impl FnOnce() -> Result<T, RendererError> + Send,
) -> Result<T, RendererError> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads.map_or(0, NonZeroUsize::get))
        .build()
        .map_err(|error| RendererError::Encoding {
            path: path.to_owned(),
            reason: error.to_string(),
        })?;
    pool.install(work)
}
