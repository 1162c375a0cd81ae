//! What holds in the session machine whatever happens, judged by a plain record of the frames.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

use experiment::{
    Answer, Button, Event, First, Key, Order, Picture, Rules, Screen, Session, Trial,
};
use proptest::prelude::*;
use protocols::rating::Phase;
use protocols::{Layout, RatingTime, ResponseStyle, Scale};

const EXPOSURE_S: f64 = 0.2;
const LONGEST_FRAME_S: f64 = 0.05;
const SCALE: Scale = Scale {
    lowest: 0,
    highest: 10,
};

#[derive(Clone, Copy, Debug)]
enum Happening {
    Frames(u32, f64),
    Press(Option<Button>),
    Release(Option<Button>),
    Key(Key),
    Saved,
    /// The experimenter asks for one of [`ORDERS`].
    Order(usize),
}

const ORDERS: [Order; 3] = [Order::Pause, Order::Resume, Order::Stop];

/// Rests and their ends, and seldom a stop.
fn order() -> impl Strategy<Value = usize> {
    (0..60_usize).prop_map(|number| if number == 0 { 2 } else { number % 2 })
}

fn button() -> impl Strategy<Value = Option<Button>> {
    prop_oneof![
        6 => (-1..12).prop_map(|rating| Some(Button::Rating(rating))),
        3 => Just(Some(Button::Continue)),
        1 => Just(Some(Button::Stop)).prop_filter("rarely", |_| true),
        1 => Just(None),
    ]
}

fn key() -> impl Strategy<Value = Key> {
    prop_oneof![
        4 => Just(Key::Enter),
        1 => Just(Key::Escape),
        1 => Just(Key::Backspace),
        6 => "[0-9 -]".prop_map(|text| Key::Character(text.chars().next().unwrap())),
    ]
}

/// Happenings in groups, so that clicks and typed numbers are frequent.
fn happenings() -> impl Strategy<Value = Vec<Happening>> {
    let frames = || {
        (1..30_u32, 0.001..LONGEST_FRAME_S).prop_map(|(count, dt_s)| Happening::Frames(count, dt_s))
    };
    let click =
        button().prop_map(|button| vec![Happening::Press(button), Happening::Release(button)]);
    let group = prop_oneof![
        8 => frames().prop_map(|frames| vec![frames]),
        4 => click,
        1 => button().prop_map(|button| vec![Happening::Press(button)]),
        1 => button().prop_map(|button| vec![Happening::Release(button)]),
        3 => key().prop_map(|key| vec![Happening::Key(key)]),
        3 => Just(vec![Happening::Saved]),
        1 => order().prop_map(|order| vec![Happening::Order(order)]),
    ];
    prop::collection::vec(group, 0..300).prop_map(|groups| groups.concat())
}

/// What was drawn and submitted, written down without any knowledge of the machine's states.
#[derive(Default)]
struct Record {
    now_s: f64,
    drawn: Option<Screen>,
    /// Every submitted frame since the last screen that was no part of a trial.
    submitted: Vec<(f64, Screen)>,
    pressed_s: Option<(f64, Option<Button>)>,
    answers: Vec<Answer>,
}

impl Record {
    fn frame(&mut self, session: &mut Session, dt_s: f64) {
        self.now_s += dt_s;
        if let Some(screen) = self.drawn {
            self.submitted.push((self.now_s, screen));
        }
        session.on(Event::Frame, self.now_s);
        self.drawn = Some(session.screen());
    }

    /// When the frames of the last run of `is_it` began, and when the first frame after it came.
    fn last_run(&self, is_it: impl Fn(Screen) -> bool) -> Option<(f64, Option<f64>)> {
        let last = self
            .submitted
            .iter()
            .rposition(|&(_, screen)| is_it(screen))?;
        let before = self.submitted[..last]
            .iter()
            .rposition(|&(_, screen)| !is_it(screen));
        let first = before.map_or(0, |before| before + 1);
        let after_s = self.submitted.get(last + 1).map(|&(at_s, _)| at_s);
        Some((self.submitted[first].0, after_s))
    }

    /// When the first frame with the scale came after the last one of the exposure: questions in between
    /// do not stop the response time.
    fn first_scale_after(&self, trial: usize, picture: Picture) -> Option<f64> {
        let is_exposure = |&(_, screen): &(f64, Screen)| screen == Screen::Exposure(trial, picture);
        let last = self.submitted.iter().rposition(is_exposure)?;
        let mut later = self.submitted[last..].iter();
        let (at_s, _) = later.find(|&&(_, screen)| screen == Screen::Rating)?;
        Some(*at_s)
    }

    fn check_answer(&self, answer: &Answer, by_click: Option<Button>, picture: Picture) {
        assert_eq!(answer.trial, self.answers.len(), "in order, none twice");
        assert!(SCALE.contains(answer.rating));
        let (onset_s, offset_s) = self
            .last_run(|screen| screen == Screen::Exposure(answer.trial, picture))
            .unwrap();
        let exposure_s = offset_s.unwrap() - onset_s;
        assert_eq!(answer.exposure_submitted_s, exposure_s);
        assert!(
            exposure_s >= EXPOSURE_S - 1.5 * LONGEST_FRAME_S,
            "a whole exposure, not {exposure_s} s"
        );
        let (scale_s, _) = self.last_run(|screen| screen == Screen::Rating).unwrap();
        let first_scale_s = self.first_scale_after(answer.trial, picture).unwrap();
        assert_eq!(answer.response_time_s, self.now_s - first_scale_s);
        if let Some(released) = by_click {
            let (pressed_s, pressed) = self.pressed_s.unwrap();
            assert!(pressed_s >= scale_s, "pressed before the scale was there");
            assert_eq!(
                (pressed, released),
                (Some(released), Button::Rating(answer.rating))
            );
        }
    }
}

/// One practice trial and two of the study.
fn session(layout: Layout) -> Session {
    let phases = [Phase::Practice, Phase::Test, Phase::Test];
    let trials: Vec<Trial> = (1..)
        .zip(phases)
        .map(|(trial_id, phase)| Trial {
            trial_id,
            phase,
            stimulus_id: "image".to_owned().try_into().unwrap(),
            repetition: 1,
            first: First::Test,
            levels: Vec::new(),
        })
        .collect();
    let rules = Rules {
        layout,
        exposure_s: EXPOSURE_S,
        pause_s: 0.05,
        scale: SCALE,
        response: ResponseStyle::Buttons,
        rating: RatingTime::AfterExposure,
        shortest_response_s: 0.0,
        longest_response_s: f64::INFINITY,
        pages: 0,
        breaks: None,
    };
    Session::new(trials, 0, rules)
}

/// The same with pairs, both rated on bars.
fn pairs() -> Session {
    let trials = session(Layout::Dscqs).trials().to_vec();
    let rules = Rules {
        response: ResponseStyle::Continuous,
        layout: Layout::Dscqs,
        exposure_s: EXPOSURE_S,
        pause_s: 0.05,
        scale: SCALE,
        rating: RatingTime::AfterExposure,
        shortest_response_s: 0.0,
        longest_response_s: f64::INFINITY,
        pages: 0,
        breaks: None,
    };
    Session::new(trials, 0, rules)
}

fn check(happenings: &[Happening], layout: Layout) -> Result<usize, TestCaseError> {
    let mut session = session(layout);
    let picture = match layout {
        Layout::Flanking => Picture::Flanked,
        _ => Picture::Test,
    };
    let mut record = Record::default();
    for &happening in happenings {
        let waiting = session.to_save().copied();
        let ended = session.ending();
        let mut by_click = None;
        match happening {
            Happening::Frames(count, dt_s) => {
                (0..count).for_each(|_| record.frame(&mut session, dt_s));
            }
            Happening::Press(button) => {
                session.on(Event::Press(button), record.now_s);
                record.pressed_s = Some((record.now_s, button));
            }
            Happening::Release(button) => {
                session.on(Event::Release(button), record.now_s);
                by_click = button;
            }
            Happening::Key(key) => session.on(Event::Key(key), record.now_s),
            Happening::Order(order) => session.order(&ORDERS[order], record.now_s),
            Happening::Saved => {
                session.on(Event::Saved, record.now_s);
                record.answers.extend(waiting);
                prop_assert_eq!(session.to_save(), None);
            }
        }
        match (waiting, session.to_save()) {
            (None, Some(answer)) => record.check_answer(answer, by_click, picture),
            (Some(before), after) if !matches!(happening, Happening::Saved) => {
                prop_assert_eq!(after, Some(&before), "an answer waits until it is saved");
                prop_assert_eq!(session.screen(), Screen::Blank);
            }
            _ => {}
        }
        prop_assert_eq!(session.rated(), record.answers.len());
        if let Screen::Exposure(trial, _) = session.screen() {
            prop_assert_eq!(trial, record.answers.len());
        }
        if ended.is_some() {
            prop_assert_eq!(session.ending(), ended);
        }
    }
    Ok(record.answers.len())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn whatever_happens_every_rating_follows_a_whole_exposure_of_its_image(happenings in happenings()) {
        check(&happenings, Layout::Flanking)?;
    }

    #[test]
    fn the_same_holds_for_a_sequence(happenings in happenings()) {
        check(&happenings, Layout::Sequence)?;
    }

    #[test]
    fn of_pairs_exactly_what_was_marked_is_the_answer(happenings in happenings()) {
        check_pairs(&happenings)?;
    }
}

/// A session of pairs with bars: the answers are the marks, and nothing but a click or Enter gives them.
fn check_pairs(happenings: &[Happening]) -> Result<usize, TestCaseError> {
    let mut session = pairs();
    let mut now_s = 0.0;
    let mut saved = 0;
    for &happening in happenings {
        let (before, marks) = (session.to_save().copied(), session.response().marks());
        match happening {
            Happening::Frames(count, dt_s) => (0..count).for_each(|_| {
                now_s += dt_s;
                session.on(Event::Frame, now_s);
            }),
            Happening::Press(button) => session.on(Event::Press(button.map(on_bar)), now_s),
            Happening::Release(button) => session.on(Event::Release(button.map(on_bar)), now_s),
            Happening::Key(key) => session.on(Event::Key(key), now_s),
            Happening::Order(order) => session.order(&ORDERS[order], now_s),
            Happening::Saved => {
                session.on(Event::Saved, now_s);
                saved += usize::from(before.is_some());
            }
        }
        if let (None, Some(answer)) = (before, session.to_save()) {
            prop_assert_eq!([Some(answer.rating), answer.reference_rating], marks);
            prop_assert_eq!(answer.trial, saved);
            prop_assert!(answer.exposure_submitted_s >= EXPOSURE_S - 1.5 * LONGEST_FRAME_S);
        }
        if matches!(session.screen(), Screen::Exposure(..) | Screen::Blank) {
            prop_assert_eq!(
                session.response().marks(),
                [None; 2],
                "nothing is preselected"
            );
        }
        prop_assert_eq!(session.rated(), saved);
    }
    Ok(saved)
}

/// Numbers become places on the bars: even ones on the first.
fn on_bar(button: Button) -> Button {
    match button {
        Button::Rating(rating) => Button::Bar(usize::from(rating % 2 != 0), rating),
        other => other,
    }
}

#[test]
fn the_random_happenings_reach_ratings_often_enough_to_judge_them() {
    use proptest::strategy::ValueTree as _;
    use proptest::test_runner::TestRunner;
    let mut runner = TestRunner::deterministic();
    let mut rated = 0;
    for _ in 0..200 {
        let tree = happenings().new_tree(&mut runner).unwrap();
        rated += check(&tree.current(), Layout::Flanking).unwrap();
    }
    assert!(rated > 50, "only {rated} ratings in 200 sessions");
}
