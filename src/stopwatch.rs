//! How much CPU time a command took, for people to read; nothing that is made depends on it.

use rustix::time::{ClockId, clock_gettime};

/// Runs from its making on, for all threads of the program.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stopwatch {
    started_s: f64,
}

impl Stopwatch {
    pub(crate) fn start() -> Self {
        Self { started_s: cpu_s() }
    }

    /// The CPU time since it was started, in seconds.
    pub(crate) fn cpu_s(self) -> f64 {
        cpu_s() - self.started_s
    }
}

fn cpu_s() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}
