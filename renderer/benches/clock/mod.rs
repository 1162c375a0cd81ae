//! The CPU time of this thread, so that what else the machine does counts little.

use std::time::Duration;

/// How long the thread has run.
///
/// From Linux's `/proc/thread-self/schedstat`, in nanoseconds.
pub(crate) fn cpu_time() -> Duration {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let nanoseconds = text
        .split(' ')
        .next()
        .and_then(|number| number.parse().ok());
    let nanoseconds = nanoseconds.unwrap_or_else(|| unreachable!("the benches run on Linux"));
    Duration::from_nanos(nanoseconds)
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
