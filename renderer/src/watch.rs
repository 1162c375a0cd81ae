//! How a caller follows a long piece of work, and how it ends it early.
//!
//! Not here: what is kept of work that was ended; see [`crate::checkpoint`].

use std::sync::atomic::{AtomicBool, Ordering};

/// What is being counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Rays through the scene.
    Rays,
    /// Image files written.
    Images,
}

/// How far the work has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// What is being counted.
    pub stage: Stage,
    /// How many are done.
    pub done: u64,
    /// How many there will be.
    pub total: u64,
}

/// A caller's ear and hand on the work.
#[derive(Clone, Copy)]
pub struct Watch<'a> {
    progress: &'a (dyn Fn(Step) + Sync),
    is_cancelled: &'a AtomicBool,
}

static NEVER: AtomicBool = AtomicBool::new(false);

impl<'a> Watch<'a> {
    /// Nobody listens, and nobody ends the work.
    pub const UNWATCHED: Watch<'static> = Watch {
        progress: &|_| (),
        is_cancelled: &NEVER,
    };

    /// `progress` is told each step; when `is_cancelled` turns true the work ends at the next one.
    pub const fn new(progress: &'a (dyn Fn(Step) + Sync), is_cancelled: &'a AtomicBool) -> Self {
        Self {
            progress,
            is_cancelled,
        }
    }

    pub(crate) fn tell(&self, stage: Stage, done: u64, total: u64) {
        (self.progress)(Step { stage, done, total });
    }

    pub(crate) fn is_cancelled(&self) -> bool {
        self.is_cancelled.load(Ordering::Relaxed)
    }
}

impl std::fmt::Debug for Watch<'_> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut watch = formatter.debug_struct("Watch");
        watch.field("is_cancelled", &self.is_cancelled);
        watch.finish_non_exhaustive()
    }
}
