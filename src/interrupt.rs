//! Ctrl-C: the first one ends the work in good order, the second ends the program at once.
//!
//! SIGTERM and SIGHUP count as Ctrl-C, so that a batch queue that ends a job leaves a checkpoint too.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::exit_code;

/// Whether somebody will look at the flag.
static IS_HEARD: AtomicBool = AtomicBool::new(false);
static IS_CANCELLED: AtomicBool = AtomicBool::new(false);
static HANDLER: OnceLock<()> = OnceLock::new();

/// While this stands, the first Ctrl-C only sets its flag; without it, Ctrl-C ends the program.
#[derive(Debug)]
pub(crate) struct Interrupt(());

impl Interrupt {
    /// Begins to listen.
    ///
    /// # Errors
    ///
    /// The system takes no handler.
    pub(crate) fn listen() -> Result<Self, ctrlc::Error> {
        if HANDLER.set(()).is_ok() {
            ctrlc::set_handler(on_interrupt)?;
        }
        IS_HEARD.store(true, Ordering::SeqCst);
        Ok(Self(()))
    }

    /// Turns true at Ctrl-C.
    #[expect(
        clippy::unused_self,
        reason = "there is no flag to look at unless somebody listens"
    )]
    pub(crate) fn flag(&self) -> &AtomicBool {
        &IS_CANCELLED
    }
}

impl Drop for Interrupt {
    fn drop(&mut self) {
        IS_HEARD.store(false, Ordering::SeqCst);
    }
}

#[expect(
    clippy::exit,
    reason = "the work did not end, or nobody would hear: only the end of the process is left"
)]
fn on_interrupt() {
    let is_second = IS_CANCELLED.swap(true, Ordering::SeqCst);
    if is_second || !IS_HEARD.load(Ordering::SeqCst) {
        std::process::exit(exit_code::INTERRUPTED.into());
    }
}
