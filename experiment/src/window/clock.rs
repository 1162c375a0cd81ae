//! The one clock of a session: seconds that never run backwards, and the UTC of their zero.

use std::time::Instant;

use jiff::Timestamp;

/// A clock that was started with the session.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clock {
    start: Instant,
    zero: Timestamp,
}

impl Clock {
    #[expect(
        clippy::disallowed_methods,
        reason = "the window's one clock: everything else is told the time"
    )]
    pub(crate) fn start() -> Self {
        Self {
            start: Instant::now(),
            zero: Timestamp::now(),
        }
    }

    /// Seconds since the start.
    pub(crate) fn now_s(self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }

    /// When the clock read zero.
    pub(crate) fn zero(self) -> Timestamp {
        self.zero
    }
}
