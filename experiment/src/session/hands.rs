//! What the subject's hands do to the session: clicks and keys.

use super::{Ending, Given, Interruption, Screen, Session, State, View};
use crate::button::{Button, Key};
use crate::note::Noted;
use crate::response::Response;

impl Session {
    pub(super) fn press(&mut self, button: Option<Button>, at_s: f64) {
        if button.is_none() || self.view.shown_s.is_none() {
            self.note(Noted::StrayClick, at_s, format!("{:?}", self.screen()));
        }
        if self.view.shown_s.is_some() {
            self.view.pressed = button;
            self.drag(button);
        }
    }

    /// A mark follows the pointer while it is held down on its bar.
    pub(super) fn drag(&mut self, button: Option<Button>) {
        let (Some(pressed), Some(button)) = (self.view.pressed, button) else {
            return;
        };
        if let Button::Bar(bar, value) = button
            && pressed.is_same(button)
            && self.is_rating()
        {
            self.response.mark(bar, value, self.rules.scale);
        }
    }

    pub(super) fn release(&mut self, button: Option<Button>, at_s: f64) {
        let pressed = self.view.pressed.take();
        if let (Some(pressed), Some(button)) = (pressed, button)
            && pressed.is_same(button)
        {
            self.push(button, at_s);
        }
    }

    pub(super) fn push(&mut self, button: Button, at_s: f64) {
        if let Some(asking) = self.asking {
            match (asking.screen, button) {
                (_, Button::Continue) => {
                    self.note(Noted::GoneOn, at_s, "");
                    self.go_on(asking.state, at_s);
                }
                (Screen::ConfirmStop, Button::Stop) => self.go(State::Over(Ending::Stopped)),
                _ => return,
            }
            self.asking = None;
            return;
        }
        match (self.state, button) {
            (State::Instructions, Button::Continue) => self.turn_page(0, at_s),
            (State::Page(page), Button::Continue) => self.turn_page(page + 1, at_s),
            (State::Break, Button::Continue) => self.end_rest(at_s),
            (State::Resumed, Button::Continue) => self.enter_trial(at_s),
            (State::PracticeOver | State::TooSlow, Button::Continue) => self.begin_trial(at_s),
            (State::Thanks, Button::Continue) => self.go(State::Over(Ending::Complete)),
            (_, Button::Rating(rating))
                if self.is_rating() && !Response::has_bars(self.rules.response) =>
            {
                self.rate([Some(rating), None], at_s);
            }
            (_, Button::Continue) if self.is_rating() => self.enter_marks(at_s),
            _ => {}
        }
    }

    /// Goes on after all: with the trial from its beginning, unless its images were seen to the end.
    fn go_on(&mut self, state: State, at_s: f64) {
        match state {
            State::Exposure(_) => {
                self.note(Noted::ExposureInterrupted, at_s, "");
                self.begin_trial(at_s);
            }
            State::Pause(_) => self.begin_trial(at_s),
            seen => {
                self.response = Response::default();
                self.go(seen);
            }
        }
    }

    /// To this page, or to the first trial after the last.
    fn turn_page(&mut self, page: usize, at_s: f64) {
        if page < self.rules.pages {
            self.go(State::Page(page));
        } else {
            self.enter_trial(at_s);
        }
    }

    /// Whether a key lets the session rest or asks to stop: it does so at any time, also before the first frame of a
    /// screen was submitted.
    pub(super) fn interrupts(&self, key: Key) -> bool {
        let is_over = matches!(self.state, State::Thanks | State::Over(_));
        matches!(key, Key::Escape | Key::Pause) && self.asking.is_none() && !is_over
    }

    pub(super) fn wait(&mut self, screen: Screen, event: Noted, at_s: f64) {
        if matches!(
            self.state,
            State::Saving(_) | State::Leaving(_) | State::Over(_)
        ) || self.asking.is_some()
        {
            return;
        }
        self.note(event, at_s, format!("{:?}", self.screen()));
        self.asking = Some(Interruption {
            screen,
            state: self.state,
        });
        self.view = View::default();
    }

    pub(super) fn key(&mut self, key: Key, at_s: f64) {
        match key {
            Key::Escape if self.asking.is_some() => self.push(Button::Continue, at_s),
            Key::Escape if self.state == State::Thanks => self.go(State::Over(Ending::Complete)),
            Key::Escape => self.wait(Screen::ConfirmStop, Noted::Escape, at_s),
            Key::Pause if self.state != State::Thanks => {
                self.wait(Screen::Paused, Noted::Pause, at_s);
            }
            _ if self.is_rating() => self.rating_key(key, at_s),
            Key::Enter | Key::Character(' ') => self.push(Button::Continue, at_s),
            _ => {}
        }
    }

    fn rating_key(&mut self, key: Key, at_s: f64) {
        let scale = self.rules.scale;
        let has_bars = Response::has_bars(self.rules.response);
        match key {
            Key::Enter if has_bars && self.response.typed().is_empty() => self.enter_marks(at_s),
            Key::Enter if has_bars => self.response.enter_mark(scale, self.rules.marks()),
            Key::Enter => {
                if let Some(rating) = self.response.enter(scale) {
                    self.rate([Some(rating), None], at_s);
                }
            }
            Key::Backspace => self.response.backspace(),
            Key::Character(character) => self.response.type_character(character, scale),
            Key::Tab if has_bars => self.response.next_bar(self.rules.marks()),
            Key::Up if has_bars => self.response.nudge(1, scale),
            Key::Down if has_bars => self.response.nudge(-1, scale),
            _ => {}
        }
    }

    fn enter_marks(&mut self, at_s: f64) {
        let is_whole = self.response.is_whole(self.rules.marks());
        if Response::has_bars(self.rules.response) && is_whole {
            self.rate(self.response.marks(), at_s);
        }
    }

    /// Takes an answer, unless it is off the scale or comes too soon.
    fn rate(&mut self, marks: [Option<i32>; 2], at_s: f64) {
        let (Some(scale_s), Some(_)) = (self.exposed.scale_s, self.view.shown_s) else {
            return;
        };
        let scale = self.rules.scale;
        if marks.iter().flatten().any(|&mark| !scale.contains(mark)) {
            return;
        }
        let response_time_s = at_s - scale_s;
        if response_time_s < self.rules.shortest_response_s {
            self.note(Noted::TooSoon, at_s, format!("{response_time_s:.4} s"));
            self.response = Response::default();
            return;
        }
        let given = Given {
            marks,
            response_time_s,
        };
        self.response = Response::default();
        match self.exposed.offset_s {
            Some(_) => self.wait_for_disk(given),
            None => self.go(State::Leaving(given)),
        }
    }
}
