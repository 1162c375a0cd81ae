//! A session on a screen with a constant frame time, as every test drives it.

use experiment::{Button, Event, First, Key, Noted, Rules, Screen, Session, Trial};
use protocols::rating::Phase;
use protocols::{Layout, RatingTime, ResponseStyle, Scale};

pub(crate) const FLANKING: Rules = Rules {
    layout: Layout::Flanking,
    exposure_s: 2.0,
    pause_s: 0.5,
    scale: Scale {
        lowest: 0,
        highest: 10,
    },
    response: ResponseStyle::Buttons,
    rating: RatingTime::AfterExposure,
    shortest_response_s: 0.0,
    longest_response_s: f64::INFINITY,
    pages: 0,
    breaks: None,
};

pub(crate) fn trial(index: u32, phase: Phase) -> Trial {
    Trial {
        trial_id: index + 1,
        phase,
        stimulus_id: format!("image-{index}").try_into().unwrap(),
        repetition: 1,
        first: First::Test,
        levels: Vec::new(),
    }
}

/// One practice trial and two of the study.
pub(crate) fn three_trials() -> Vec<Trial> {
    vec![
        trial(0, Phase::Practice),
        trial(1, Phase::Test),
        trial(2, Phase::Test),
    ]
}

/// A session on a screen with a constant frame time.
pub(crate) struct Screening {
    pub(crate) session: Session,
    pub(crate) now_s: f64,
    pub(crate) frame_s: f64,
}

impl Screening {
    pub(crate) fn new(rules: Rules) -> Self {
        Self::resumed(rules, 0)
    }

    pub(crate) fn resumed(rules: Rules, rated: usize) -> Self {
        let session = Session::new(three_trials(), rated, rules);
        let mut screening = Self {
            session,
            now_s: 100.0,
            frame_s: 1.0 / 60.0,
        };
        screening.frames(2);
        screening
    }

    pub(crate) fn on(&mut self, event: Event) {
        self.session.on(event, self.now_s);
    }

    pub(crate) fn frames(&mut self, count: u32) {
        for _ in 0..count {
            self.now_s += self.frame_s;
            self.on(Event::Frame);
        }
    }

    pub(crate) fn key(&mut self, key: Key) {
        self.on(Event::Key(key));
        self.frames(2);
    }

    pub(crate) fn type_all(&mut self, text: &str) {
        for character in text.chars() {
            self.key(Key::Character(character));
        }
    }

    pub(crate) fn click(&mut self, button: Button) {
        self.on(Event::Press(Some(button)));
        self.on(Event::Release(Some(button)));
    }

    pub(crate) fn saved(&mut self) {
        self.on(Event::Saved);
        self.frames(2);
    }

    /// Frames until `is_there` or half a minute has passed.
    pub(crate) fn until(&mut self, is_there: impl Fn(Screen) -> bool) {
        let end_s = self.now_s + 30.0;
        while !is_there(self.session.screen()) {
            assert!(self.now_s < end_s, "stuck at {:?}", self.session.screen());
            self.frames(1);
        }
    }

    pub(crate) fn until_exposure(&mut self) {
        self.until(|screen| matches!(screen, Screen::Exposure(..)));
    }

    /// The scale, submitted.
    pub(crate) fn until_scale(&mut self) {
        self.until(|screen| screen == Screen::Rating);
        self.frames(1);
    }
}

pub(crate) const PAIR: Rules = Rules {
    layout: Layout::Dscqs,
    response: ResponseStyle::Continuous,
    scale: Scale {
        lowest: 0,
        highest: 100,
    },
    ..FLANKING
};

/// A pair of which the reference comes first, if `first` says so, up to the scale.
pub(crate) fn pair(first: First) -> Screening {
    let mut trials = three_trials();
    trials[0].first = first;
    let mut screening = Screening::new(PAIR);
    screening.session = Session::new(trials, 0, PAIR);
    screening.frames(2);
    screening.click(Button::Continue);
    screening
}

pub(crate) fn noted(screening: &mut Screening) -> Vec<Noted> {
    let notes = screening.session.take_notes();
    notes.into_iter().map(|note| note.event).collect()
}
