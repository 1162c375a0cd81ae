//! Every frame's time, in runs of one screen: small enough to keep beside the data.

use crate::{Picture, Screen};

/// Frames of one screen that followed each other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FrameRun {
    /// The index of the trial that was on.
    pub trial: usize,
    /// What the frames showed.
    pub screen: &'static str,
    /// When the first of them was submitted, by the driver's clock.
    pub began_us: u64,
    /// The time from each to the next one.
    pub intervals_us: Vec<u64>,
}

/// Runs of frames, in their order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FrameLog {
    runs: Vec<FrameRun>,
    latest_us: u64,
}

impl FrameLog {
    /// The runs.
    pub fn runs(&self) -> &[FrameRun] {
        &self.runs
    }

    /// A frame with this screen had been submitted at `at_s`.
    pub(crate) fn submitted(&mut self, at_s: f64, trial: usize, screen: Screen) {
        let at_us = microseconds(at_s);
        let screen = word(screen);
        match self.runs.last_mut() {
            Some(run) if run.screen == screen && run.trial == trial => {
                run.intervals_us.push(at_us.saturating_sub(self.latest_us));
            }
            _ => self.runs.push(FrameRun {
                trial,
                screen,
                began_us: at_us,
                intervals_us: Vec::new(),
            }),
        }
        self.latest_us = at_us;
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a clock that starts at zero; it saturates after half a million years"
)]
fn microseconds(seconds: f64) -> u64 {
    (seconds * 1e6).round() as u64
}

/// The word for a screen in the log.
fn word(screen: Screen) -> &'static str {
    match screen {
        Screen::Instructions => "instructions",
        Screen::Page(_) => "page",
        Screen::Break { .. } => "break",
        Screen::Resumed => "resumed",
        Screen::PracticeOver => "practice_over",
        Screen::Blank => "grey",
        Screen::Rating => "scale",
        Screen::TooSlow => "too_slow",
        Screen::Paused => "paused",
        Screen::ConfirmStop => "confirm_stop",
        Screen::Thanks => "thanks",
        Screen::Exposure(_, picture) | Screen::RatedExposure(_, picture) => match picture {
            Picture::Flanked => "flanked",
            Picture::ZeroAnchor => "zero_anchor",
            Picture::Test => "test",
            Picture::TenAnchor => "ten_anchor",
        },
    }
}
