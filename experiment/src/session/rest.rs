//! Breaks between the test trials, with a countdown.

use protocols::rating::Phase;

use super::{Screen, Session, State};
use crate::note::Noted;
use crate::rules::Breaks;

/// A break that is on.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Rest {
    began_s: f64,
    /// How long it has been on, as of the latest frame.
    passed_s: f64,
}

impl Rest {
    /// Says what time it is.
    pub(super) fn tell(&mut self, at_s: f64) {
        self.passed_s = at_s - self.began_s;
    }
}

impl Session {
    /// Whether a break comes before the present trial: after every so many test trials.
    pub(super) fn is_rest_due(&self) -> bool {
        let rated = &self.trials[..self.trial];
        let is_test = |trial: &&crate::Trial| trial.phase == Phase::Test;
        let tested = rated.iter().filter(is_test).count();
        let is_due = |breaks: Breaks| tested > 0 && tested % breaks.every as usize == 0;
        self.state != State::Resumed && self.rules.breaks.is_some_and(is_due)
    }

    pub(super) fn begin_rest(&mut self, at_s: f64) {
        self.rest = Rest {
            began_s: at_s,
            passed_s: 0.0,
        };
        self.note(Noted::Break, at_s, "");
        self.go(State::Break);
    }

    /// Goes on, if the break is over or may be cut short.
    pub(super) fn end_rest(&mut self, at_s: f64) {
        if self.can_rest_end() {
            let lasted = format!("after a break of {:.1} s", at_s - self.rest.began_s);
            self.note(Noted::GoneOn, at_s, lasted);
            self.begin_trial(at_s);
        }
    }

    pub(super) fn rest_screen(&self) -> Screen {
        let breaks = self.rules.breaks;
        let left_s = breaks.map_or(0.0, |breaks| breaks.seconds - self.rest.passed_s);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "at most an hour, and never below zero"
        )]
        let left_s = left_s.max(0.0).ceil() as u32;
        Screen::Break {
            left_s,
            can_go_on: self.can_rest_end(),
        }
    }

    pub(super) fn is_rest_over(&self) -> bool {
        let is_over = |breaks: Breaks| self.rest.passed_s >= breaks.seconds;
        self.rules.breaks.is_none_or(is_over)
    }

    fn can_rest_end(&self) -> bool {
        let can_be_cut_short = |breaks: Breaks| breaks.can_be_cut_short;
        self.is_rest_over() || self.rules.breaks.is_some_and(can_be_cut_short)
    }
}
