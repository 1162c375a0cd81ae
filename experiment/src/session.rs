//! The session as a pure machine: what is on the screen, and what each event changes.
//!
//! ```text
//! instructions, pages -> practice trials -> practice over -> test trials, breaks -> thanks
//! trial: pause (grey) -> exposure -> rating (waits) -> saving -> next trial
//! ```
//!
//! A layout of several pictures has several exposures, each after its own pause. Where the protocol lets the
//! subject rate during the exposure, the scale stands below the last picture, and an answer ends it.
//!
//! What holds, whatever the events, and the tests check it:
//!
//! 1. no rating without an exposure of its image (a whole one, unless it may be rated before), none twice, none
//!    out of order;
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

mod answer;
mod hands;
mod orders;
mod rest;
mod screen;

use crate::button::{Button, Key};
use crate::frame_clock::{FrameClock, Interval};
use crate::frame_log::FrameLog;
use crate::note::{Note, Noted};
use crate::order::Trial;
use crate::picture::{First, Picture};
use crate::response::Response;
use crate::rules::Rules;

use protocols::RatingTime;
use protocols::rating::Phase;

pub use answer::{Answer, Ending};
pub use screen::Screen;

/// Something that happens to the session.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    /// The driver begins to draw a frame: the one before has been submitted, and [`Session::screen`] now
    /// says what this one shows.
    Frame,
    /// The pointer's button went down, on this button of the screen or beside all of them.
    Press(Option<Button>),
    /// The pointer moved with its button down.
    Drag(Option<Button>),
    /// The pointer's button went up.
    Release(Option<Button>),
    /// A key went down.
    Key(Key),
    /// The rating of [`Session::to_save`] is safely on disk.
    Saved,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum State {
    Instructions,
    Page(usize),
    Break,
    Resumed,
    PracticeOver,
    /// Grey before the picture with this index in the layout.
    Pause(usize),
    Exposure(usize),
    Rating,
    TooSlow,
    /// Answered while the images stood; they are going.
    Leaving(Given),
    Saving(Answer),
    Thanks,
    Over(Ending),
}

/// What was answered, and when.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Given {
    marks: [Option<i32>; 2],
    response_time_s: f64,
}

/// Why the session waits, and where it goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Interruption {
    screen: Screen,
    state: State,
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
    /// Whether a frame was drawn since the trial began: the one before is not of this trial.
    is_drawn: bool,
    onset_s: Option<f64>,
    offset_s: Option<f64>,
    missed_frames: u32,
    /// When the scale was first submitted.
    scale_s: Option<f64>,
}

impl Exposed {
    /// A frame with this screen has been submitted. What is asked of the session before may already have changed.
    fn submitted(&mut self, screen: Screen, at_s: f64) {
        if screen.has_scale() {
            self.scale_s = self.scale_s.or(Some(at_s));
        }
        let has_test_image = screen
            .picture()
            .is_some_and(|(_, picture)| picture.has_test_image());
        match (has_test_image, self.onset_s, self.offset_s) {
            (true, None, _) | (true, _, Some(_)) => {
                self.onset_s = Some(at_s);
                self.offset_s = None;
            }
            (false, Some(_), None) => self.offset_s = Some(at_s),
            _ => {}
        }
    }
}

/// One sitting of one subject.
#[derive(Clone, Debug)]
pub struct Session {
    trials: Vec<Trial>,
    rules: Rules,
    state: State,
    /// Why the session waits, if it does.
    asking: Option<Interruption>,
    trial: usize,
    exposed: Exposed,
    /// How often the present trial was begun.
    showings: u32,
    response: Response,
    view: View,
    rest: rest::Rest,
    clock: FrameClock,
    frames: FrameLog,
    /// What the latest frame showed.
    drawn: Option<Screen>,
    notes: Vec<Note>,
}

impl Session {
    /// A session of `trials`, of which the first `rated` are rated already.
    pub fn new(trials: Vec<Trial>, rated: usize, rules: Rules) -> Self {
        let state = match rated {
            all if all >= trials.len() => State::Thanks,
            0 => State::Instructions,
            _ => State::Resumed,
        };
        Self {
            trials,
            rules,
            state,
            asking: None,
            trial: rated,
            exposed: Exposed::default(),
            showings: 0,
            response: Response::default(),
            view: View::default(),
            rest: rest::Rest::default(),
            clock: FrameClock::default(),
            frames: FrameLog::default(),
            drawn: None,
            notes: Vec::new(),
        }
    }

    /// What the frame that is drawn now shows.
    pub fn screen(&self) -> Screen {
        if let Some(asking) = self.asking {
            return asking.screen;
        }
        match self.state {
            State::Instructions => Screen::Instructions,
            State::Page(page) => Screen::Page(page),
            State::Break => self.rest_screen(),
            State::Resumed => Screen::Resumed,
            State::PracticeOver => Screen::PracticeOver,
            State::Pause(_) | State::Leaving(_) | State::Saving(_) => Screen::Blank,
            State::Exposure(part) if self.is_rated_now(part) => {
                Screen::RatedExposure(self.trial, self.pictures()[part])
            }
            State::Exposure(part) => Screen::Exposure(self.trial, self.pictures()[part]),
            State::Rating => Screen::Rating,
            State::TooSlow => Screen::TooSlow,
            State::Thanks | State::Over(_) => Screen::Thanks,
        }
    }

    /// Which picture of a trial stands or is awaited, from 0.
    pub fn part(&self) -> usize {
        match self.state {
            State::Pause(part) | State::Exposure(part) => part,
            _ => 0,
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
        let is_timed = match self.state {
            State::Pause(_) | State::Exposure(_) | State::Leaving(_) | State::Saving(_) => true,
            State::Break => !self.is_rest_over(),
            State::Rating => self.rules.longest_response_s.is_finite(),
            _ => false,
        };
        (is_timed && self.asking.is_none()) || self.view.shown_s.is_none()
    }

    /// Whether the first frame of the present screen has been submitted.
    pub fn is_shown(&self) -> bool {
        self.view.shown_s.is_some()
    }

    /// The trial that comes first, and the different pictures that it shows.
    pub(crate) fn first_pictures(&self) -> Option<(&Trial, Vec<Picture>)> {
        let mut different: Vec<Picture> = Vec::new();
        for &picture in self.pictures() {
            if !different.contains(&picture) {
                different.push(picture);
            }
        }
        self.trials.get(self.trial).map(|trial| (trial, different))
    }

    /// What is typed and marked so far.
    pub fn response(&self) -> &Response {
        &self.response
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

    /// Every frame since this was last asked, in runs of one screen.
    pub fn take_frames(&mut self) -> FrameLog {
        std::mem::take(&mut self.frames)
    }

    /// What happened since this was last asked.
    pub fn take_notes(&mut self) -> Vec<Note> {
        std::mem::take(&mut self.notes)
    }

    /// Adds to what happened.
    pub fn note(&mut self, event: Noted, at_s: f64, detail: impl Into<String>) {
        self.note_of(self.trial, event, at_s, detail);
    }

    /// Adds to what happened in a trial, which need not be the present one.
    pub(crate) fn note_of(
        &mut self,
        trial: usize,
        event: Noted,
        at_s: f64,
        detail: impl Into<String>,
    ) {
        self.notes.push(Note {
            at_s,
            trial,
            event,
            detail: detail.into(),
        });
    }

    /// Takes one event that happened at `at_s`.
    pub fn on(&mut self, event: Event, at_s: f64) {
        match event {
            Event::Frame => self.frame(at_s),
            Event::Press(button) => self.press(button, at_s),
            Event::Drag(button) => self.drag(button),
            Event::Release(button) => self.release(button, at_s),
            Event::Key(key) if self.view.shown_s.is_some() || self.interrupts(key) => {
                self.key(key, at_s);
            }
            Event::Saved if self.to_save().is_some() => self.next_trial(at_s),
            Event::Key(_) | Event::Saved => {}
        }
    }

    fn pictures(&self) -> &'static [Picture] {
        let first = self.trials.get(self.trial).map(|trial| trial.first);
        Picture::all_of(self.rules.layout, first.unwrap_or(First::Test))
    }

    /// Whether the scale stands below this picture.
    fn is_rated_now(&self, part: usize) -> bool {
        self.rules.rating == RatingTime::DuringExposure && part + 1 == self.pictures().len()
    }

    fn go(&mut self, state: State) {
        self.state = state;
        self.view = View::default();
    }

    fn frame(&mut self, at_s: f64) {
        if let Some(drawn) = self.drawn {
            self.frames.submitted(at_s, self.trial, drawn);
        }
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
        if let (Some(drawn), true) = (self.drawn, self.exposed.is_drawn) {
            self.exposed.submitted(drawn, at_s);
        }
        if self.view.is_drawn && self.view.shown_s.is_none() {
            self.view.shown_s = Some(at_s);
        }
        if self.asking.is_none() {
            self.run(at_s);
        }
        self.view.is_drawn = true;
        self.exposed.is_drawn = true;
        self.drawn = Some(self.screen());
    }

    /// What time alone brings about.
    fn run(&mut self, at_s: f64) {
        if self.state == State::Break {
            self.rest.tell(at_s);
        }
        if let (State::Leaving(given), Some(_)) = (self.state, self.view.shown_s) {
            self.wait_for_disk(given);
        } else if self.is_due(at_s) {
            self.next_part(at_s);
        } else if self.is_too_late(at_s) {
            self.note(Noted::TooLate, at_s, "");
            self.go(State::TooSlow);
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

    fn is_too_late(&self, at_s: f64) -> bool {
        let waited = |scale_s: f64| at_s - scale_s > self.rules.longest_response_s;
        self.is_rating() && self.exposed.scale_s.is_some_and(waited)
    }

    fn is_rating(&self) -> bool {
        self.asking.is_none() && self.screen().has_scale()
    }

    fn next_part(&mut self, at_s: f64) {
        match self.state {
            State::Pause(part) => self.go(State::Exposure(part)),
            State::Exposure(part) if part + 1 < self.pictures().len() => {
                self.go(State::Pause(part + 1));
            }
            State::Exposure(_) => self.go(State::Rating),
            _ => self.begin_trial(at_s),
        }
    }

    /// Begins the present trial, or says before it that the practice is over.
    fn enter_trial(&mut self, at_s: f64) {
        self.showings = 0;
        let phase_of = |index: usize| self.trials.get(index).map(|trial| trial.phase);
        let before = self.trial.checked_sub(1).and_then(phase_of);
        match phase_of(self.trial) {
            None => self.go(State::Thanks),
            Some(Phase::Test) if before == Some(Phase::Practice) => self.go(State::PracticeOver),
            Some(_) if self.is_rest_due() => self.begin_rest(at_s),
            Some(_) => self.begin_trial(at_s),
        }
    }

    fn begin_trial(&mut self, at_s: f64) {
        self.exposed = Exposed {
            started_s: at_s,
            ..Exposed::default()
        };
        self.showings += 1;
        self.response = Response::default();
        self.go(State::Pause(0));
    }

    fn next_trial(&mut self, at_s: f64) {
        self.trial += 1;
        self.enter_trial(at_s);
    }

    /// The answer waits to be put on disk, if its images have come and gone.
    fn wait_for_disk(&mut self, given: Given) {
        let exposed = self.exposed;
        let (Some(onset_s), Some(offset_s)) = (exposed.onset_s, exposed.offset_s) else {
            return;
        };
        let [one, another] = given.marks;
        let first = self.trials.get(self.trial).map(|trial| trial.first);
        let (test, reference) = match first {
            Some(First::Reference) => (another, one),
            _ => (one, another),
        };
        let Some(rating) = test else { return };
        self.go(State::Saving(Answer {
            trial: self.trial,
            rating,
            reference_rating: reference,
            response_time_s: given.response_time_s,
            exposure_submitted_s: offset_s - onset_s,
            missed_frames: exposed.missed_frames,
            showings: self.showings,
            started_s: exposed.started_s,
        }));
    }
}
