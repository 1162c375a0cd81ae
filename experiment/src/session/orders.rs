//! What the experimenter does to the session, and what can be told of it meanwhile.

use super::{Ending, Screen, Session, State};
use crate::button::Button;
use crate::note::Noted;
use crate::view::Order;

impl Session {
    /// Takes an order of the experimenter. A rating that is being put on disk is not disturbed.
    pub fn order(&mut self, order: &Order, at_s: f64) {
        match order {
            Order::Opened => self.note(Noted::View, at_s, "opened"),
            Order::Note(words) => self.note(Noted::Words, at_s, words),
            Order::Pause if self.asking.is_none() && self.state != State::Thanks => {
                self.wait(Screen::Paused, Noted::Pause, at_s);
                if self.asking.is_some() {
                    self.note(Noted::Experimenter, at_s, "pause");
                }
            }
            Order::Resume if self.asking.is_some() => {
                self.note(Noted::Experimenter, at_s, "resume");
                self.push(Button::Continue, at_s);
            }
            Order::Stop => self.stop(at_s),
            Order::Pause | Order::Resume => {}
        }
    }

    fn stop(&mut self, at_s: f64) {
        let ending = match self.state {
            State::Over(_) | State::Saving(_) => return,
            State::Thanks => Ending::Complete,
            _ => Ending::Stopped,
        };
        self.note(Noted::Experimenter, at_s, "stop");
        self.asking = None;
        self.go(State::Over(ending));
    }

    /// Seconds left on the present screen, if it ends by itself.
    pub fn screen_left_s(&self, at_s: f64) -> Option<f64> {
        if self.asking.is_some() {
            return None;
        }
        let duration_s = match self.state {
            State::Pause(_) => self.rules.pause_s,
            State::Exposure(_) => self.rules.exposure_s,
            State::Break => match self.rest_screen() {
                Screen::Break { left_s, .. } => return Some(f64::from(left_s)),
                _ => return None,
            },
            _ => return None,
        };
        let began_s = self.view.shown_s.unwrap_or(at_s);
        Some((began_s + duration_s - at_s).max(0.0))
    }

    /// Whether the session waits until someone lets it go on.
    pub fn is_resting(&self) -> bool {
        self.asking.is_some()
    }
}
