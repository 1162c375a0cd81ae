//! What the program says: results on stdout, progress and errors on stderr.

use std::fmt::Display;
use std::io::{self, IsTerminal as _, Write as _};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Prints a result, one line or several, on stdout.
pub(crate) fn print(result: impl Display) -> io::Result<()> {
    match writeln!(io::stdout().lock(), "{result}") {
        // The reader, such as `head`, has what it wanted.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        written => written,
    }
}

/// Prints an error with its causes on stderr; what cannot be printed there can be printed nowhere.
pub(crate) fn print_error(error: &anyhow::Error) {
    _ = writeln!(io::stderr().lock(), "error: {error:#}");
}

/// Where progress goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Progress {
    /// A bar on stderr, if that is a terminal.
    Drawn,
    /// Nowhere.
    Silent,
}

impl Progress {
    /// Calls `work` with a function that takes the steps done and the steps to do.
    pub(crate) fn of<T>(
        self,
        what: &'static str,
        work: impl FnOnce(&(dyn Fn(u64, u64) + Sync)) -> T,
    ) -> T {
        let bar = ProgressBar::new(0);
        if self == Self::Silent || !io::stderr().is_terminal() {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        } else {
            bar.enable_steady_tick(Duration::from_millis(200));
        }
        if let Ok(style) =
            ProgressStyle::with_template("{prefix} {wide_bar} {percent:>3}%  {eta} left")
        {
            bar.set_style(style);
        }
        bar.set_prefix(what);
        let outcome = work(&|done, total| {
            bar.set_length(total);
            bar.set_position(done);
        });
        bar.finish_and_clear();
        outcome
    }
}
