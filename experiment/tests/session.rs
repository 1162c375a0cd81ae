//! The session machine, event by event.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

use experiment::{
    Breaks, Button, Ending, Event, First, Key, Noted, Picture, Rules, Screen, Session, Trial,
};
use protocols::rating::Phase;
use protocols::{Layout, RatingTime, ResponseStyle, Scale};

const FLANKING: Rules = Rules {
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

fn trial(index: u32, phase: Phase) -> Trial {
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
fn three_trials() -> Vec<Trial> {
    vec![
        trial(0, Phase::Practice),
        trial(1, Phase::Test),
        trial(2, Phase::Test),
    ]
}

/// A session on a screen with a constant frame time.
struct Screening {
    session: Session,
    now_s: f64,
    frame_s: f64,
}

impl Screening {
    fn new(rules: Rules) -> Self {
        Self::resumed(rules, 0)
    }

    fn resumed(rules: Rules, rated: usize) -> Self {
        let session = Session::new(three_trials(), rated, rules);
        let mut screening = Self {
            session,
            now_s: 100.0,
            frame_s: 1.0 / 60.0,
        };
        screening.frames(2);
        screening
    }

    fn on(&mut self, event: Event) {
        self.session.on(event, self.now_s);
    }

    fn frames(&mut self, count: u32) {
        for _ in 0..count {
            self.now_s += self.frame_s;
            self.on(Event::Frame);
        }
    }

    fn key(&mut self, key: Key) {
        self.on(Event::Key(key));
        self.frames(2);
    }

    fn type_all(&mut self, text: &str) {
        for character in text.chars() {
            self.key(Key::Character(character));
        }
    }

    fn click(&mut self, button: Button) {
        self.on(Event::Press(Some(button)));
        self.on(Event::Release(Some(button)));
    }

    fn saved(&mut self) {
        self.on(Event::Saved);
        self.frames(2);
    }

    /// Frames until `is_there` or half a minute has passed.
    fn until(&mut self, is_there: impl Fn(Screen) -> bool) {
        let end_s = self.now_s + 30.0;
        while !is_there(self.session.screen()) {
            assert!(self.now_s < end_s, "stuck at {:?}", self.session.screen());
            self.frames(1);
        }
    }

    fn until_exposure(&mut self) {
        self.until(|screen| matches!(screen, Screen::Exposure(..)));
    }

    /// The scale, submitted.
    fn until_scale(&mut self) {
        self.until(|screen| screen == Screen::Rating);
        self.frames(1);
    }
}

#[test]
fn a_session_goes_from_the_instructions_through_every_trial_to_the_thanks() {
    let mut screening = Screening::new(FLANKING);
    assert_eq!(screening.session.screen(), Screen::Instructions);
    screening.click(Button::Continue);
    for index in 0..3 {
        if index == 1 {
            assert_eq!(screening.session.screen(), Screen::PracticeOver);
            screening.key(Key::Character(' '));
        }
        assert_eq!(screening.session.screen(), Screen::Blank);
        screening.until_exposure();
        let shown = Screen::Exposure(index, Picture::Flanked);
        assert_eq!(screening.session.screen(), shown);
        screening.until_scale();
        screening.now_s += 1.5;
        screening.click(Button::Rating(7));
        let answer = *screening.session.to_save().unwrap();
        assert_eq!(
            (answer.trial, answer.rating, answer.missed_frames),
            (index, 7, 0)
        );
        assert!((answer.response_time_s - 1.5).abs() < 1e-9);
        screening.saved();
    }
    assert_eq!(screening.session.screen(), Screen::Thanks);
    assert_eq!(screening.session.ending(), None);
    screening.key(Key::Enter);
    assert_eq!(screening.session.ending(), Some(Ending::Complete));
}

#[test]
fn the_exposure_ends_with_the_frame_nearest_to_its_time() {
    for frame_s in [1.0 / 144.0, 1.0 / 60.0, 0.03, 0.07] {
        let mut screening = Screening::new(FLANKING);
        screening.frame_s = frame_s;
        screening.click(Button::Continue);
        // Until the frame time is known, it is taken to be 1/60 s: measure it on the first pause.
        screening.until_scale();
        screening.click(Button::Rating(1));
        let exposure_s = screening.session.to_save().unwrap().exposure_submitted_s;
        assert!(
            (exposure_s - 2.0).abs() <= 0.5 * frame_s + 1e-9,
            "{frame_s}: {exposure_s}"
        );
    }
}

#[test]
fn a_late_frame_of_the_exposure_is_counted() {
    let mut screening = Screening::new(FLANKING);
    screening.click(Button::Continue);
    screening.until_exposure();
    screening.frames(10);
    screening.now_s += 0.02;
    screening.frames(10);
    screening.until_scale();
    screening.click(Button::Rating(1));
    assert_eq!(screening.session.to_save().unwrap().missed_frames, 1);
    let summary = screening.session.frame_clock().summary().unwrap();
    assert_eq!(summary.missed, 1);
    assert!((summary.longest_s - (0.02 + 1.0 / 60.0)).abs() < 1e-9);
}

#[test]
fn a_rating_during_the_exposure_is_not_taken() {
    let mut screening = Screening::new(FLANKING);
    screening.click(Button::Continue);
    screening.until_exposure();
    screening.frames(20);
    screening.click(Button::Rating(3));
    screening.type_all("3");
    screening.key(Key::Enter);
    assert!(matches!(screening.session.screen(), Screen::Exposure(0, _)));
    screening.until_scale();
    assert_eq!(screening.session.response().typed(), "");
    assert_eq!(screening.session.to_save(), None);
}

#[test]
fn a_click_begun_during_the_exposure_does_not_count() {
    let mut screening = Screening::new(FLANKING);
    screening.click(Button::Continue);
    screening.until_exposure();
    screening.frames(20);
    screening.on(Event::Press(Some(Button::Rating(3))));
    screening.until_scale();
    screening.on(Event::Release(Some(Button::Rating(3))));
    assert_eq!(screening.session.to_save(), None);
}

#[test]
fn a_click_before_the_scale_was_submitted_does_not_count() {
    let mut screening = Screening::new(FLANKING);
    screening.click(Button::Continue);
    screening.until(|screen| screen == Screen::Rating);
    screening.click(Button::Rating(3));
    screening.frames(1);
    assert_eq!(screening.session.to_save(), None);
    screening.click(Button::Rating(3));
    assert_eq!(screening.session.to_save().unwrap().rating, 3);
}

#[test]
fn a_click_that_slides_to_another_rating_is_no_answer() {
    let mut screening = Screening::new(FLANKING);
    screening.click(Button::Continue);
    screening.until_scale();
    screening.on(Event::Press(Some(Button::Rating(3))));
    screening.on(Event::Release(Some(Button::Rating(4))));
    screening.on(Event::Press(Some(Button::Rating(3))));
    screening.on(Event::Release(None));
    screening.on(Event::Release(Some(Button::Rating(3))));
    assert_eq!(screening.session.to_save(), None);
}

#[test]
fn nothing_is_preselected() {
    let mut screening = Screening::new(FLANKING);
    screening.click(Button::Continue);
    screening.until_scale();
    screening.key(Key::Enter);
    screening.key(Key::Character(' '));
    screening.frames(1000);
    assert_eq!(screening.session.screen(), Screen::Rating);
    assert_eq!(screening.session.to_save(), None);
}

#[test]
fn ten_is_typed_as_one_and_nought_and_what_is_off_the_scale_is_never_another_rating() {
    let mut screening = Screening::new(FLANKING);
    screening.click(Button::Continue);
    screening.until_scale();
    for off_scale in ["12", "77", "011", ""] {
        screening.type_all(off_scale);
        assert_eq!(screening.session.response().typed(), off_scale);
        screening.key(Key::Enter);
        assert_eq!(screening.session.to_save(), None, "{off_scale}");
        assert_eq!(screening.session.response().typed(), "");
    }
    screening.type_all("x-1.1");
    assert_eq!(screening.session.response().typed(), "11");
    screening.key(Key::Backspace);
    screening.type_all("0");
    screening.key(Key::Enter);
    assert_eq!(screening.session.to_save().unwrap().rating, 10);
}

#[test]
fn a_scale_below_zero_is_typed_with_a_minus() {
    let scale = Scale {
        lowest: -3,
        highest: 3,
    };
    let mut screening = Screening::new(Rules { scale, ..FLANKING });
    screening.click(Button::Continue);
    screening.until_scale();
    for off_scale in ["-", "-4", "42"] {
        screening.type_all(off_scale);
        screening.key(Key::Enter);
        assert_eq!(screening.session.to_save(), None);
    }
    screening.type_all("-2");
    screening.key(Key::Enter);
    assert_eq!(screening.session.to_save().unwrap().rating, -2);
}

#[test]
fn the_response_time_runs_on_while_the_subject_is_asked_whether_to_stop() {
    let mut screening = Screening::new(FLANKING);
    screening.click(Button::Continue);
    screening.until_scale();
    screening.key(Key::Escape);
    // Two seconds at 60 frames a second.
    screening.frames(120);
    screening.key(Key::Escape);
    screening.frames(2);
    screening.type_all("5");
    screening.key(Key::Enter);
    assert!(screening.session.to_save().unwrap().response_time_s >= 2.0);
}

#[test]
fn the_next_trial_waits_until_the_rating_is_saved() {
    let mut screening = Screening::new(FLANKING);
    screening.click(Button::Continue);
    screening.until_scale();
    screening.click(Button::Rating(5));
    screening.frames(1000);
    screening.click(Button::Rating(6));
    screening.key(Key::Escape);
    assert_eq!(screening.session.screen(), Screen::Blank);
    assert_eq!(screening.session.to_save().unwrap().rating, 5);
    assert_eq!(screening.session.rated(), 0);
    screening.saved();
    assert_eq!(screening.session.rated(), 1);
}

#[test]
fn escape_asks_and_an_interrupted_exposure_is_shown_again_from_its_beginning() {
    let mut screening = Screening::new(FLANKING);
    screening.click(Button::Continue);
    screening.until_exposure();
    screening.frames(60);
    screening.key(Key::Escape);
    assert_eq!(screening.session.screen(), Screen::ConfirmStop);
    screening.frames(1000);
    assert_eq!(screening.session.screen(), Screen::ConfirmStop);
    screening.click(Button::Continue);
    assert_eq!(screening.session.screen(), Screen::Blank);
    screening.until_scale();
    screening.click(Button::Rating(2));
    let answer = screening.session.to_save().unwrap();
    assert!((answer.exposure_submitted_s - 2.0).abs() < 0.02);
    assert_eq!((answer.trial, answer.missed_frames), (0, 0));
}

#[test]
fn escape_on_the_scale_keeps_the_exposure_that_was_seen() {
    let mut screening = Screening::new(FLANKING);
    screening.click(Button::Continue);
    screening.until_scale();
    screening.key(Key::Escape);
    screening.click(Button::Rating(2));
    assert_eq!(screening.session.screen(), Screen::ConfirmStop);
    screening.key(Key::Escape);
    assert_eq!(screening.session.screen(), Screen::Rating);
    screening.click(Button::Rating(2));
    assert!(screening.session.to_save().is_some());
}

#[test]
fn a_session_that_is_stopped_keeps_its_ratings_and_goes_no_further() {
    let mut screening = Screening::new(FLANKING);
    screening.click(Button::Continue);
    screening.until_scale();
    screening.click(Button::Rating(2));
    screening.saved();
    screening.key(Key::Escape);
    screening.click(Button::Stop);
    assert_eq!(screening.session.ending(), Some(Ending::Stopped));
    assert_eq!(screening.session.rated(), 1);
    screening.frames(1000);
    screening.key(Key::Enter);
    assert_eq!(screening.session.ending(), Some(Ending::Stopped));
}

#[test]
fn a_resumed_session_goes_on_with_the_next_trial() {
    let mut screening = Screening::resumed(FLANKING, 2);
    assert_eq!(screening.session.screen(), Screen::Resumed);
    screening.click(Button::Continue);
    screening.until_exposure();
    assert_eq!(
        screening.session.screen(),
        Screen::Exposure(2, Picture::Flanked)
    );

    let mut between = Screening::resumed(FLANKING, 1);
    between.click(Button::Continue);
    assert_eq!(between.session.screen(), Screen::PracticeOver);

    let complete = Screening::resumed(FLANKING, 3);
    assert_eq!(complete.session.screen(), Screen::Thanks);
}

#[test]
fn a_sequence_shows_zero_anchor_test_image_and_ten_anchor_one_after_another() {
    let mut screening = Screening::new(Rules {
        layout: Layout::Sequence,
        ..FLANKING
    });
    screening.click(Button::Continue);
    for picture in [Picture::ZeroAnchor, Picture::Test, Picture::TenAnchor] {
        assert_eq!(screening.session.screen(), Screen::Blank);
        screening.until_exposure();
        assert_eq!(screening.session.screen(), Screen::Exposure(0, picture));
        let began_s = screening.now_s;
        screening.until(|screen| !matches!(screen, Screen::Exposure(..)));
        assert!((screening.now_s - began_s - 2.0).abs() < 0.02);
    }
    screening.until_scale();
    screening.click(Button::Rating(2));
    let exposure_s = screening.session.to_save().unwrap().exposure_submitted_s;
    assert!(
        (exposure_s - 2.0).abs() < 0.02,
        "that of the test image alone: {exposure_s}"
    );
}

const PAIR: Rules = Rules {
    layout: Layout::Dscqs,
    response: ResponseStyle::Continuous,
    scale: Scale {
        lowest: 0,
        highest: 100,
    },
    ..FLANKING
};

#[test]
fn a_single_stimulus_is_shown_alone_and_an_impairment_after_its_reference() {
    for (layout, pictures) in [
        (Layout::Single, vec![Picture::Test]),
        (Layout::Dsis, vec![Picture::TenAnchor, Picture::Test]),
    ] {
        let mut screening = Screening::new(Rules { layout, ..FLANKING });
        screening.click(Button::Continue);
        for picture in pictures {
            screening.until_exposure();
            assert_eq!(screening.session.screen(), Screen::Exposure(0, picture));
            screening.until(|screen| !matches!(screen, Screen::Exposure(..)));
        }
        screening.until_scale();
        screening.click(Button::Rating(4));
        assert_eq!(screening.session.to_save().unwrap().rating, 4);
    }
}

/// A pair of which the reference comes first, if `first` says so, up to the scale.
fn pair(first: First) -> Screening {
    let mut trials = three_trials();
    trials[0].first = first;
    let mut screening = Screening::new(PAIR);
    screening.session = Session::new(trials, 0, PAIR);
    screening.frames(2);
    screening.click(Button::Continue);
    screening
}

#[test]
fn a_pair_is_shown_twice_and_both_are_rated_whichever_comes_first() {
    for (first, order, rating, reference) in [
        (First::Test, [Picture::Test, Picture::TenAnchor], 30, 80),
        (
            First::Reference,
            [Picture::TenAnchor, Picture::Test],
            80,
            30,
        ),
    ] {
        let mut screening = pair(first);
        for picture in [order, order].concat() {
            screening.until_exposure();
            assert_eq!(screening.session.screen(), Screen::Exposure(0, picture));
            screening.until(|screen| !matches!(screen, Screen::Exposure(..)));
        }
        screening.until_scale();
        screening.click(Button::Bar(0, 30));
        screening.click(Button::Bar(1, 80));
        screening.click(Button::Continue);
        let answer = screening.session.to_save().unwrap();
        assert_eq!(
            (answer.rating, answer.reference_rating),
            (rating, Some(reference))
        );
        assert!(
            (answer.exposure_submitted_s - 2.0).abs() < 0.02,
            "one showing"
        );
    }
}

#[test]
fn bars_are_entered_only_when_every_one_is_marked_and_none_is_to_begin_with() {
    let mut screening = pair(First::Test);
    screening.until_scale();
    assert_eq!(screening.session.response().marks(), [None, None]);
    screening.click(Button::Continue);
    screening.key(Key::Up);
    screening.click(Button::Bar(1, 55));
    screening.click(Button::Continue);
    screening.key(Key::Enter);
    assert_eq!(screening.session.to_save(), None);
    assert_eq!(screening.session.response().marks(), [None, Some(55)]);
    screening.click(Button::Bar(0, 101));
    assert_eq!(screening.session.response().marks(), [None, Some(55)]);
    screening.click(Button::Bar(0, 100));
    screening.click(Button::Continue);
    let answer = screening.session.to_save().unwrap();
    assert_eq!((answer.rating, answer.reference_rating), (100, Some(55)));
}

#[test]
fn a_mark_follows_the_pointer_while_it_is_held_and_only_on_its_own_bar() {
    let mut screening = pair(First::Test);
    screening.until_scale();
    screening.on(Event::Press(Some(Button::Bar(0, 10))));
    screening.on(Event::Drag(Some(Button::Bar(0, 20))));
    screening.on(Event::Drag(Some(Button::Bar(1, 60))));
    screening.on(Event::Drag(None));
    screening.on(Event::Release(None));
    screening.on(Event::Drag(Some(Button::Bar(0, 70))));
    assert_eq!(screening.session.response().marks(), [Some(20), None]);
}

#[test]
fn bars_can_be_marked_by_keys_alone() {
    let mut screening = pair(First::Test);
    screening.until_scale();
    screening.type_all("42");
    screening.key(Key::Enter);
    screening.type_all("7");
    screening.key(Key::Enter);
    screening.key(Key::Down);
    screening.key(Key::Tab);
    screening.key(Key::Up);
    assert_eq!(screening.session.response().marks(), [Some(43), Some(6)]);
    screening.key(Key::Enter);
    let answer = screening.session.to_save().unwrap();
    assert_eq!((answer.rating, answer.reference_rating), (43, Some(6)));
}

#[test]
fn an_answer_during_the_exposure_ends_it_and_its_length_is_what_was_shown() {
    let mut screening = Screening::new(Rules {
        layout: Layout::Single,
        rating: RatingTime::DuringExposure,
        ..FLANKING
    });
    screening.click(Button::Continue);
    screening.until(|screen| screen == Screen::RatedExposure(0, Picture::Test));
    screening.click(Button::Rating(3));
    assert_eq!(
        screening.session.to_save(),
        None,
        "its frame is not submitted yet"
    );
    // Half a second at 60 frames a second.
    screening.frames(30);
    screening.click(Button::Rating(3));
    screening.frames(2);
    let answer = *screening.session.to_save().unwrap();
    assert_eq!(answer.rating, 3);
    assert!(
        (answer.exposure_submitted_s - 0.55).abs() < 0.06,
        "{answer:?}"
    );
    assert!(answer.response_time_s < answer.exposure_submitted_s);
    screening.saved();
    screening.click(Button::Continue);
    screening.until(|screen| matches!(screen, Screen::RatedExposure(1, _)));
    screening.type_all("1");
    screening.until(|screen| screen == Screen::Rating);
    screening.frames(2);
    screening.type_all("0");
    screening.key(Key::Enter);
    screening.frames(2);
    let answer = screening.session.to_save().unwrap();
    assert_eq!(
        answer.rating, 0,
        "keys before the frame with the scale do not count"
    );
    assert!((answer.exposure_submitted_s - 2.0).abs() < 0.02);
}

fn noted(screening: &mut Screening) -> Vec<Noted> {
    let notes = screening.session.take_notes();
    notes.into_iter().map(|note| note.event).collect()
}

#[test]
fn an_answer_too_soon_is_not_taken_and_noted() {
    let mut screening = Screening::new(Rules {
        shortest_response_s: 0.3,
        ..FLANKING
    });
    screening.click(Button::Continue);
    screening.until_scale();
    screening.frames(6);
    screening.click(Button::Rating(3));
    assert_eq!(screening.session.to_save(), None);
    assert_eq!(noted(&mut screening), [Noted::TooSoon]);
    screening.frames(20);
    screening.click(Button::Rating(4));
    assert_eq!(screening.session.to_save().unwrap().rating, 4);
}

#[test]
fn without_an_answer_in_time_the_pictures_are_shown_again_and_both_showings_count() {
    let mut screening = Screening::new(Rules {
        longest_response_s: 1.0,
        ..FLANKING
    });
    screening.click(Button::Continue);
    screening.until_scale();
    assert!(
        screening.session.needs_frames(),
        "so that the time can run out"
    );
    screening.until(|screen| screen == Screen::TooSlow);
    screening.frames(2);
    screening.click(Button::Rating(3));
    assert_eq!(screening.session.to_save(), None);
    assert_eq!(noted(&mut screening), [Noted::TooLate]);
    screening.click(Button::Continue);
    screening.until_exposure();
    screening.until_scale();
    screening.click(Button::Rating(5));
    let answer = screening.session.to_save().unwrap();
    assert_eq!((answer.rating, answer.showings), (5, 2));
    assert!(answer.response_time_s < 1.0);
}

#[test]
fn the_pause_key_and_stray_clicks_are_noted_with_their_time() {
    let mut screening = Screening::new(FLANKING);
    screening.click(Button::Continue);
    screening.until_exposure();
    screening.frames(10);
    screening.on(Event::Press(None));
    screening.on(Event::Release(None));
    screening.key(Key::Pause);
    assert_eq!(screening.session.screen(), Screen::Paused);
    screening.click(Button::Stop);
    assert_eq!(screening.session.screen(), Screen::Paused);
    let paused_s = screening.now_s;
    screening.click(Button::Continue);
    screening.until_scale();
    let notes = screening.session.take_notes();
    let events: Vec<_> = notes.iter().map(|note| note.event).collect();
    assert_eq!(
        events,
        [
            Noted::StrayClick,
            Noted::Pause,
            Noted::GoneOn,
            Noted::ExposureInterrupted
        ]
    );
    assert!(notes[1].at_s <= paused_s && notes[2].at_s >= paused_s);
}

/// Every frame that was drawn is in the log, with its time: the log is judged by a plain list.
#[test]
fn the_frame_log_holds_every_frame() {
    let mut screening = Screening::new(FLANKING);
    screening.session.take_frames();
    screening.click(Button::Continue);
    let before = screening.now_s;
    screening.until_scale();
    let log = screening.session.take_frames();
    let count: usize = log
        .runs()
        .iter()
        .map(|run| run.intervals_us.len() + 1)
        .sum();
    let frames = ((screening.now_s - before) / screening.frame_s).round();
    let logged = count as f64;
    assert!((logged - frames).abs() <= 2.0, "{logged} of {frames}");
    let words: Vec<_> = log.runs().iter().map(|run| run.screen).collect();
    assert!(words.ends_with(&["grey", "flanked", "scale"]), "{words:?}");
    let exposure = &log.runs()[words.len() - 2];
    let long_us: u64 = exposure.intervals_us.iter().sum();
    // 2 s less the frame that ends it: the interval to the first frame of the scale is not in the run.
    assert!((1_960_000..2_000_000).contains(&long_us), "{long_us}");
}

#[test]
fn the_pages_follow_the_instructions_one_by_one() {
    let mut screening = Screening::new(Rules {
        pages: 2,
        ..FLANKING
    });
    for page in 0..2 {
        screening.click(Button::Continue);
        screening.frames(2);
        assert_eq!(screening.session.screen(), Screen::Page(page));
    }
    screening.key(Key::Enter);
    assert_eq!(screening.session.screen(), Screen::Blank);
    assert_eq!(screening.session.rated(), 0);
}

const BREAKS: Breaks = Breaks {
    every: 2,
    seconds: 5.0,
    can_be_cut_short: false,
};

/// One practice trial and four of the study, a break after every second of these.
fn with_breaks(breaks: Breaks) -> Screening {
    let mut trials = three_trials();
    trials.extend([trial(3, Phase::Test), trial(4, Phase::Test)]);
    let rules = Rules {
        breaks: Some(breaks),
        ..FLANKING
    };
    let mut screening = Screening::new(FLANKING);
    screening.session = Session::new(trials, 0, rules);
    screening.frames(2);
    screening
}

/// Rates until so many trials are done.
fn rate(screening: &mut Screening, count: usize) {
    while screening.session.rated() < count {
        screening.frames(1);
        match screening.session.screen() {
            Screen::Rating => {
                screening.frames(1);
                screening.click(Button::Rating(4));
                screening.saved();
            }
            Screen::Instructions | Screen::PracticeOver => screening.key(Key::Enter),
            _ => {}
        }
    }
}

#[test]
fn a_break_counts_down_and_cannot_be_left_before_it_is_over() {
    let mut screening = with_breaks(BREAKS);
    rate(&mut screening, 3);
    let resting = |left_s, can_go_on| Screen::Break { left_s, can_go_on };
    assert_eq!(screening.session.screen(), resting(5, false));
    assert!(screening.session.needs_frames());
    screening.click(Button::Continue);
    screening.frames(120);
    assert_eq!(screening.session.screen(), resting(3, false));
    screening.key(Key::Enter);
    assert_eq!(screening.session.screen(), resting(3, false));
    // An escape and back does not begin it anew.
    screening.key(Key::Escape);
    screening.key(Key::Escape);
    screening.frames(180);
    assert_eq!(screening.session.screen(), resting(0, true));
    assert!(!screening.session.needs_frames());
    screening.click(Button::Continue);
    screening.until_exposure();
    let notes = noted(&mut screening);
    assert!(notes.contains(&Noted::Break), "{notes:?}");
    // None comes after the last trial.
    rate(&mut screening, 5);
    assert_eq!(screening.session.screen(), Screen::Thanks);
}

#[test]
fn a_break_that_may_be_cut_short_has_its_button_from_the_start() {
    let mut screening = with_breaks(Breaks {
        can_be_cut_short: true,
        ..BREAKS
    });
    rate(&mut screening, 3);
    let resting = Screen::Break {
        left_s: 5,
        can_go_on: true,
    };
    assert_eq!(screening.session.screen(), resting);
    screening.click(Button::Continue);
    assert_eq!(screening.session.screen(), Screen::Blank);
    screening.until_exposure();
}
