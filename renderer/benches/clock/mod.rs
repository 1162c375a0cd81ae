//! The CPU time of this thread, so that what else the machine does counts little.

use std::time::Duration;

use rustix::time::{ClockId, clock_gettime};

/// How long the thread has run.
pub(crate) fn cpu_time() -> Duration {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    let seconds = u64::try_from(time.tv_sec).unwrap_or_default();
    let nanoseconds = u32::try_from(time.tv_nsec).unwrap_or_default();
    Duration::new(seconds, nanoseconds)
}

/// The least CPU time of one of `rounds` runs, in seconds.
pub(crate) fn least_secs(rounds: usize, mut work: impl FnMut()) -> f64 {
    let time = |_| {
        let start = cpu_time();
        work();
        cpu_time().saturating_sub(start).as_secs_f64()
    };
    (0..rounds).map(time).fold(f64::INFINITY, f64::min)
}
