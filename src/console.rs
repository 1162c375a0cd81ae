//! What the program says: results on stdout, progress and errors on stderr.

use std::fmt::{self, Display};
use std::io::{self, IsTerminal as _, Write as _};
use std::process::ExitCode;

use clap::CommandFactory as _;
use indicatif::{HumanCount, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use renderer::{Stage, Step};

use crate::command_line::CommandLine;

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

/// Prints what is wrong with a command on stderr, and how commands look; the exit code is 2.
pub(crate) fn print_help(wrong: &str) -> ExitCode {
    let help = CommandLine::command().render_help();
    _ = writeln!(io::stderr().lock(), "error: {wrong}\n\n{help}");
    ExitCode::from(2)
}

/// Prints the warnings of a scene on stderr.
pub(crate) fn print_warnings(warnings: &[String]) {
    for warning in warnings {
        _ = writeln!(io::stderr().lock(), "warning: {warning}");
    }
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
        let bar = self.bar("{prefix} {wide_bar} {percent:>3}%  {eta} left");
        bar.set_prefix(what);
        let outcome = work(&|done, total| {
            bar.set_length(total);
            bar.set_position(done);
        });
        bar.finish_and_clear();
        outcome
    }

    /// Calls `work` with a function that takes the steps of a renderer: rays, then image files.
    pub(crate) fn of_rendering<T>(self, work: impl FnOnce(&(dyn Fn(Step) + Sync)) -> T) -> T {
        let rays =
            self.bar("render {wide_bar} {human_pos} of {human_len} rays, {per_sec}, {eta} left");
        let images = self.bar("write  {wide_bar} {pos} of {len} images, {eta} left");
        let outcome = work(&|step| {
            let bar = match step.stage {
                Stage::Rays => &rays,
                Stage::Images => &images,
            };
            if step.stage == Stage::Images {
                rays.finish_and_clear();
            }
            bar.set_length(step.total);
            bar.set_position(step.done);
        });
        rays.finish_and_clear();
        images.finish_and_clear();
        outcome
    }

    /// A bar of this template; it is drawn when it is first told something.
    fn bar(self, template: &str) -> ProgressBar {
        let bar = ProgressBar::new(0);
        if self == Self::Silent || !io::stderr().is_terminal() {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        if let Ok(style) = ProgressStyle::with_template(template) {
            let per_second = |state: &ProgressState, out: &mut dyn fmt::Write| {
                // What cannot be drawn is left out.
                _ = write!(out, "{} rays/s", HumanCount(whole(state.per_sec())));
            };
            bar.set_style(style.with_key("per_sec", per_second));
        }
        bar
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a rate to be read; what is not a number saturates at 0"
)]
fn whole(rate: f64) -> u64 {
    rate as u64
}
