//! The session as a pure machine: what is on the screen, and what each event changes.
//!
//! ```text
//! instructions -> practice trials -> practice over -> test trials -> thanks
//! trial: pause (grey) -> exposure -> rating (waits) -> saving -> next trial
//! ```
//!
//! A sequence layout has three exposures (zero anchor, test image, ten anchor), each after its own pause.
//!
//! What holds, whatever the events, and the tests check it:
//!
//! 1. no rating without a whole exposure of its image, none twice, none out of order;
//! 2. a click counts only if both its press and its release came after the frame with the scale was
//!    submitted; nothing is preselected;
//! 3. the next trial begins only after [`Event::Saved`];
//! 4. an exposure that is interrupted is shown again from its beginning.
//!
//! Time is passed in, in seconds of any clock that never runs backwards. The driver says when it begins to
//! draw a frame ([`Event::Frame`]); the frame before has then been submitted. The window, the simulated
//! observers and the tests drive this same machine.
//!
//! Not here: clocks, files, random numbers, pictures.

use crate::button::{Button, Key};
use crate::frame_clock::{FrameClock, Interval};
use crate::order::Trial;

use protocols::rating::Phase;
use protocols::{Layout, Scale, SessionPlan};

/// Characters of a typed number; a scale has at most three digits and a sign.
const MOST_TYPED: usize = 4;

/// What the machine must know of the protocol.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules {
    /// How the anchors stand to the test image.
    pub layout: Layout,
    /// For how long the images are shown (in a sequence, each of them).
    pub exposure_s: f64,
    /// Grey before each exposure.
    pub pause_s: f64,
    /// The rating scale.
    pub scale: Scale,
}

impl Rules {
    /// The rules of a session at the speed of its protocol.
    pub fn of(plan: &SessionPlan) -> Self {
        Self {
            layout: plan.layout,
            exposure_s: plan.exposure_s,
            pause_s: plan.pause_s,
            scale: plan.scale,
        }
    }

    /// The same rules with times this many times shorter.
    #[must_use]
    pub fn faster(self, speed: f64) -> Self {
        Self {
            exposure_s: self.exposure_s / speed,
            pause_s: self.pause_s / speed,
            ..self
        }
    }
}

/// Something that happens to the session.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    /// The driver begins to draw a frame: the one before has been submitted, and [`Session::screen`] now
    /// says what this one shows.
    Frame,
    /// The pointer's button went down, on this button of the screen or beside all of them.
    Press(Option<Button>),
    /// The pointer's button went up.
    Release(Option<Button>),
    /// A key went down.
    Key(Key),
    /// The rating of [`Session::to_save`] is safely on disk.
    Saved,
}

/// What a frame shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Screen {
    /// The instructions, with a button to begin.
    Instructions,
    /// That the practice is over, with a button to go on.
    PracticeOver,
    /// Grey.
    Blank,
    /// Images of the trial with this index.
    Exposure(usize, Picture),
    /// The rating scale.
    Rating,
    /// Whether to stop.
    ConfirmStop,
    /// The end.
    Thanks,
}

/// Which images are on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Picture {
    /// Zero anchor, test image and ten anchor, side by side.
    Flanked,
    /// The zero anchor alone.
    ZeroAnchor,
    /// The test image alone.
    Test,
    /// The ten anchor alone.
    TenAnchor,
}

impl Picture {
    fn all_of(layout: Layout) -> &'static [Self] {
        match layout {
            Layout::Flanking => &[Self::Flanked],
            Layout::Sequence => &[Self::ZeroAnchor, Self::Test, Self::TenAnchor],
        }
    }

    fn has_test_image(self) -> bool {
        matches!(self, Self::Flanked | Self::Test)
    }
}

/// The answer to one trial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// The index of the trial in the session.
    pub trial: usize,
    /// The rating.
    pub rating: i32,
    /// From the first frame submitted with the scale to the answer.
    pub response_time_s: f64,
    /// From the first frame submitted with the test image to the first without it.
    pub exposure_submitted_s: f64,
    /// Frames of the test image later than one and a half frame times after the one before.
    pub missed_frames: u32,
    /// When the trial began, by the driver's clock.
    pub started_s: f64,
}

/// How a session ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// Every trial is rated.
    Complete,
    /// The subject stopped; what was rated is kept.
    Stopped,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum State {
    Instructions,
    PracticeOver,
    /// Grey before the picture with this index in the layout.
    Pause(usize),
    Exposure(usize),
    Rating,
    Saving(Answer),
    Thanks,
    Over(Ending),
}

/// How long the present screen has been there, and what was begun on it.
#[derive(Clone, Debug, Default)]
struct View {
    /// A frame with it is being drawn or has been.
    is_drawn: bool,
    /// When its first frame was submitted.
    shown_s: Option<f64>,
    /// The button that the pointer was pressed on.
    pressed: Option<Button>,
}

/// When the test image of the present trial came and went.
#[derive(Clone, Copy, Debug, Default)]
struct Exposed {
    started_s: f64,
    onset_s: Option<f64>,
    offset_s: Option<f64>,
    missed_frames: u32,
    /// When the scale was first submitted.
    scale_s: Option<f64>,
}

/// One sitting of one subject.
#[derive(Clone, Debug)]
pub struct Session {
    trials: Vec<Trial>,
    rules: Rules,
    state: State,
    /// Where the session goes on if the subject does not stop after all.
    asking: Option<State>,
    trial: usize,
    exposed: Exposed,
    typed: String,
    view: View,
    clock: FrameClock,
}

impl Session {
    /// A session of `trials`, of which the first `rated` are rated already.
    pub fn new(trials: Vec<Trial>, rated: usize, rules: Rules) -> Self {
        let state = if rated >= trials.len() {
            State::Thanks
        } else {
            State::Instructions
        };
        Self {
            trials,
            rules,
            state,
            asking: None,
            trial: rated,
            exposed: Exposed::default(),
            typed: String::new(),
            view: View::default(),
            clock: FrameClock::default(),
        }
    }

    /// What the frame that is drawn now shows.
    pub fn screen(&self) -> Screen {
        if self.asking.is_some() {
            return Screen::ConfirmStop;
        }
        match self.state {
            State::Instructions => Screen::Instructions,
            State::PracticeOver => Screen::PracticeOver,
            State::Pause(_) | State::Saving(_) => Screen::Blank,
            State::Exposure(part) => Screen::Exposure(self.trial, self.picture(part)),
            State::Rating => Screen::Rating,
            State::Thanks | State::Over(_) => Screen::Thanks,
        }
    }

    /// The answer that must be on disk before the session goes on.
    pub fn to_save(&self) -> Option<&Answer> {
        match &self.state {
            State::Saving(answer) => Some(answer),
            _ => None,
        }
    }

    /// How the session ended, once it has.
    pub fn ending(&self) -> Option<Ending> {
        match self.state {
            State::Over(ending) => Some(ending),
            _ => None,
        }
    }

    /// Whether frames must follow each other without a rest: time runs on the screen, or a frame waits to
    /// be submitted.
    pub fn needs_frames(&self) -> bool {
        let is_timed = matches!(
            self.state,
            State::Pause(_) | State::Exposure(_) | State::Saving(_)
        );
        (is_timed && self.asking.is_none()) || self.view.shown_s.is_none()
    }

    /// The number that is being typed.
    pub fn typed(&self) -> &str {
        &self.typed
    }

    /// The button that the pointer is held down on.
    pub fn pressed(&self) -> Option<Button> {
        self.view.pressed
    }

    /// The trials, in their order.
    pub fn trials(&self) -> &[Trial] {
        &self.trials
    }

    /// How many trials have been rated.
    pub fn rated(&self) -> usize {
        self.trial
    }

    /// The frame times measured so far.
    pub fn frame_clock(&self) -> &FrameClock {
        &self.clock
    }

    /// Takes one event that happened at `at_s`.
    pub fn on(&mut self, event: Event, at_s: f64) {
        match event {
            Event::Frame => self.frame(at_s),
            Event::Press(button) if self.view.shown_s.is_some() => self.view.pressed = button,
            Event::Release(button) => {
                let pressed = self.view.pressed.take();
                if let Some(button) = button.filter(|_| pressed == button) {
                    self.push(button, at_s);
                }
            }
            Event::Key(key) if self.view.shown_s.is_some() => self.key(key, at_s),
            Event::Saved if self.to_save().is_some() => self.next_trial(at_s),
            Event::Press(_) | Event::Key(_) | Event::Saved => {}
        }
    }

    fn picture(&self, part: usize) -> Picture {
        Picture::all_of(self.rules.layout)[part]
    }

    fn go(&mut self, state: State) {
        self.state = state;
        self.view = View::default();
        self.typed.clear();
    }

    fn frame(&mut self, at_s: f64) {
        let is_standing = self.asking.is_none()
            && self.exposed.onset_s.is_some()
            && self.exposed.offset_s.is_none();
        let interval = match (self.view.is_drawn && self.needs_frames(), is_standing) {
            (false, _) => Interval::Rest,
            (true, false) => Interval::Running,
            (true, true) => Interval::Exposure,
        };
        let is_late = self.clock.frame(at_s, interval);
        if interval == Interval::Exposure && is_late {
            self.exposed.missed_frames += 1;
        }
        if self.view.is_drawn && self.view.shown_s.is_none() {
            self.view.shown_s = Some(at_s);
            self.submitted(at_s);
        }
        if self.asking.is_none() && self.is_due(at_s) {
            self.next_part(at_s);
        }
        self.view.is_drawn = true;
    }

    /// The first frame of the present screen has been submitted.
    fn submitted(&mut self, at_s: f64) {
        let has_test_image = match self.screen() {
            Screen::Exposure(_, picture) => picture.has_test_image(),
            _ => false,
        };
        let is_scale = self.screen() == Screen::Rating;
        let exposed = &mut self.exposed;
        if is_scale {
            exposed.scale_s = exposed.scale_s.or(Some(at_s));
        }
        if has_test_image {
            exposed.onset_s = Some(at_s);
        } else if exposed.onset_s.is_some() {
            exposed.offset_s = exposed.offset_s.or(Some(at_s));
        }
    }

    /// Whether the frame that is drawn now must show the next part: it will be submitted one frame time
    /// from now, and the nearest frame to the end is taken. So the switch is at `T - 1.5` frame times.
    fn is_due(&self, at_s: f64) -> bool {
        let duration_s = match self.state {
            State::Pause(_) => self.rules.pause_s,
            State::Exposure(_) => self.rules.exposure_s,
            _ => return false,
        };
        let margin_s = 1.5 * self.clock.frame_s();
        let shown_s = self.view.shown_s;
        shown_s.is_some_and(|shown_s| at_s - shown_s >= duration_s - margin_s)
    }

    fn next_part(&mut self, at_s: f64) {
        match self.state {
            State::Pause(part) => self.go(State::Exposure(part)),
            State::Exposure(part) if part + 1 < Picture::all_of(self.rules.layout).len() => {
                self.go(State::Pause(part + 1));
            }
            State::Exposure(_) => self.go(State::Rating),
            _ => self.begin_trial(at_s),
        }
    }

    /// Begins the present trial, or says before it that the practice is over.
    fn enter_trial(&mut self, at_s: f64) {
        let phase_of = |index: usize| self.trials.get(index).map(|trial| trial.phase);
        let before = self.trial.checked_sub(1).and_then(phase_of);
        match phase_of(self.trial) {
            None => self.go(State::Thanks),
            Some(Phase::Test) if before == Some(Phase::Practice) => self.go(State::PracticeOver),
            Some(_) => self.begin_trial(at_s),
        }
    }

    fn begin_trial(&mut self, at_s: f64) {
        self.exposed = Exposed {
            started_s: at_s,
            ..Exposed::default()
        };
        self.go(State::Pause(0));
    }

    fn next_trial(&mut self, at_s: f64) {
        self.trial += 1;
        self.enter_trial(at_s);
    }

    fn push(&mut self, button: Button, at_s: f64) {
        if let Some(state) = self.asking {
            match button {
                Button::Continue => self.go_on(state, at_s),
                Button::Stop => self.go(State::Over(Ending::Stopped)),
                Button::Rating(_) => return,
            }
            self.asking = None;
            return;
        }
        match (self.state, button) {
            (State::Instructions, Button::Continue) => self.enter_trial(at_s),
            (State::PracticeOver, Button::Continue) => self.begin_trial(at_s),
            (State::Rating, Button::Rating(rating)) => self.rate(rating, at_s),
            (State::Thanks, Button::Continue) => self.go(State::Over(Ending::Complete)),
            _ => {}
        }
    }

    /// Goes on after all: with the trial from its beginning, unless its images were seen to the end.
    fn go_on(&mut self, state: State, at_s: f64) {
        match state {
            State::Pause(_) | State::Exposure(_) => self.begin_trial(at_s),
            seen => self.go(seen),
        }
    }

    fn key(&mut self, key: Key, at_s: f64) {
        match key {
            Key::Escape if self.asking.is_some() => self.push(Button::Continue, at_s),
            Key::Escape => match self.state {
                State::Thanks => self.go(State::Over(Ending::Complete)),
                State::Saving(_) | State::Over(_) => {}
                state => {
                    self.asking = Some(state);
                    self.view = View::default();
                }
            },
            Key::Enter if self.is_rating() => match self.typed.parse() {
                Ok(rating) if self.rules.scale.contains(rating) => self.rate(rating, at_s),
                _ => self.typed.clear(),
            },
            Key::Backspace if self.is_rating() => {
                self.typed.pop();
            }
            Key::Character(character) if self.is_rating() => self.type_character(character),
            Key::Enter | Key::Character(' ') => self.push(Button::Continue, at_s),
            Key::Backspace | Key::Character(_) => {}
        }
    }

    fn is_rating(&self) -> bool {
        self.asking.is_none() && self.state == State::Rating
    }

    /// Adds a digit, or the sign of a scale that goes below zero. A number off the scale can be typed but
    /// not entered, so that a digit too many never turns it into another rating.
    fn type_character(&mut self, character: char) {
        let is_sign = character == '-' && self.typed.is_empty() && self.rules.scale.lowest < 0;
        if (character.is_ascii_digit() || is_sign) && self.typed.len() < MOST_TYPED {
            self.typed.push(character);
        }
    }

    fn rate(&mut self, rating: i32, at_s: f64) {
        let exposed = self.exposed;
        let (Some(onset_s), Some(offset_s)) = (exposed.onset_s, exposed.offset_s) else {
            return;
        };
        let (Some(scale_s), Some(_)) = (exposed.scale_s, self.view.shown_s) else {
            return;
        };
        if !self.rules.scale.contains(rating) {
            return;
        }
        self.go(State::Saving(Answer {
            trial: self.trial,
            rating,
            response_time_s: at_s - scale_s,
            exposure_submitted_s: offset_s - onset_s,
            missed_frames: exposed.missed_frames,
            started_s: exposed.started_s,
        }));
    }
}
