//! Resuming is identity: a session that is cut off at any moments, and resumed from what is on disk, has the trials,
//! the lots and the rated rows of one that was never cut off.
//!
//! The subject answers by a rule of the trial alone, so both sessions have the same answers. Everything is real but the
//! window and the clock: the sitting, its files, the lock. What a dying program leaves is made from the files before
//! and after a write: of a row any number of bytes, of a sidecar the old one or the new one.

use std::cell::Cell;
use std::fs;

use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use protocols::rating::RatingRow;
use protocols::{BreakPlan, Layout, RatingTime, ResponseStyle, Scale};
use serde_json::Value;

use super::intake_kept;
use super::tests::Place;
use super::*;
use crate::{Button, First, Key, Reply, Step, Trial};

/// How many random sessions, unless the variable `ACUITY_RESUMED_SESSIONS` says otherwise.
const SESSIONS: u32 = 32;

/// What happens to a session besides being answered.
#[derive(Clone, Copy, Debug)]
pub(super) enum Happening {
    /// So many frames, in which the subject does what the screen asks.
    GoOn(u32),
    /// So many frames, in which the subject does nothing.
    Dawdle(u32),
    Key(Key),
    Press(Option<Button>),
    Release(Option<Button>),
    /// The experimenter lets the session rest, go on, or notes something.
    Pause,
    Resume,
    Note,
    /// The subject stops the session; or the experimenter does.
    Escape,
    Stop,
    /// The program is killed.
    Death,
    /// It is killed while it writes what comes next: this part of a row is there, and nothing that follows it.
    DeathInWrite(f64),
}

fn happenings() -> impl Strategy<Value = Vec<Happening>> {
    let key = prop_oneof![
        3 => "[0-9]".prop_map(|text| Key::Character(text.chars().next().unwrap_or('0'))),
        1 => Just(Key::Pause),
        1 => Just(Key::Backspace),
        1 => Just(Key::Tab),
    ];
    let button = (0..2_usize, 0..11).prop_map(|(bar, place)| Some(Button::Bar(bar, place)));
    let happening = prop_oneof![
        12 => prop_oneof![1..15_u32, 1..160_u32].prop_map(Happening::GoOn),
        2 => (1..40_u32).prop_map(Happening::Dawdle),
        2 => key.prop_map(Happening::Key),
        1 => button.prop_map(Happening::Press),
        1 => Just(Happening::Press(None)),
        1 => Just(Happening::Release(None)),
        1 => Just(Happening::Pause),
        1 => Just(Happening::Resume),
        1 => Just(Happening::Note),
        1 => Just(Happening::Escape),
        1 => Just(Happening::Stop),
        4 => Just(Happening::Death),
        4 => prop_oneof![Just(0.0), Just(1.0), 0.0..1.0].prop_map(Happening::DeathInWrite),
    ];
    prop::collection::vec(happening, 0..50)
}

/// Which session it is: subject, layout, whether the scale stands during the exposure, whether it is a trial run.
pub(super) type Kind = (u32, Layout, bool, bool);

fn kind() -> impl Strategy<Value = Kind> {
    let layout = prop_oneof![
        Just(Layout::Flanking),
        Just(Layout::Sequence),
        Just(Layout::Single),
        Just(Layout::Dsis),
        Just(Layout::Dscqs),
    ];
    (1..100_u32, layout, any::<bool>(), any::<bool>())
}

/// A study with all that comes before and between the trials, in a data folder of its own.
pub(super) fn place(
    stimuli: &Place,
    data: &str,
    (subject, layout, is_rated_at_once, is_pilot): Kind,
) -> Place {
    let mut place = Place::at(stimuli.folder());
    place.options.data_dir = stimuli.folder().join(data);
    place.options.subject = format!("S{subject}").parse().unwrap();
    place.options.pilot = is_pilot.then_some(4.0);
    let plan = &mut place.study.protocol.session;
    intake_kept::ask(plan);
    plan.layout = layout;
    plan.longest_response_s = Some(0.5);
    plan.breaks = Some(BreakPlan {
        every: 10,
        seconds: 1.0,
        can_be_cut_short: false,
        text: "A break.".to_owned(),
    });
    if layout == Layout::Dscqs {
        plan.response = ResponseStyle::Continuous;
        (plan.scale.lowest, plan.scale.highest) = (0, 100);
    } else if layout == Layout::Single {
        plan.response = ResponseStyle::Labelled;
        (plan.scale.lowest, plan.scale.highest) = (1, 5);
        plan.texts.labels = ["bad", "poor", "fair", "good", "excellent"]
            .map(str::to_owned)
            .to_vec();
    } else if is_rated_at_once {
        plan.rating = RatingTime::DuringExposure;
    }
    place
}

/// The answer to a trial: of its image, and of the reference.
fn answer_to(trial: &Trial, scale: Scale) -> [i32; 2] {
    let letters: u32 = trial.stimulus_id.as_str().bytes().map(u32::from).sum();
    let steps = scale.ratings().count();
    [7, 11].map(|factor| {
        let step = (factor * trial.trial_id + letters) as usize % steps;
        scale.ratings().nth(step).unwrap()
    })
}

/// A subject who sits one session, however often it is cut off.
struct Subject<'a> {
    place: &'a Place,
    /// `None` only while one program has died and the next has not begun.
    sitting: Option<Sitting>,
    at_s: f64,
    /// How many trials were rated when each sitting began.
    begun_at: Vec<usize>,
    /// How much of the next write will be there when the program dies in it.
    dies_in_write: Option<f64>,
    is_done: bool,
}

impl<'a> Subject<'a> {
    fn seated(place: &'a Place) -> Self {
        Self {
            place,
            sitting: Some(place.open().unwrap()),
            at_s: 0.0,
            begun_at: vec![0],
            dies_in_write: None,
            is_done: false,
        }
    }

    fn sitting(&mut self) -> &mut Sitting {
        self.sitting.as_mut().unwrap()
    }

    fn takes(&mut self, happening: Happening) {
        match happening {
            Happening::GoOn(frames) => (0..frames).for_each(|_| self.go_on()),
            Happening::Dawdle(frames) => (0..frames).for_each(|_| self.frame()),
            Happening::Key(key) => self.event(Event::Key(key)),
            Happening::Press(button) => self.event(Event::Press(button)),
            Happening::Release(button) => self.event(Event::Release(button)),
            Happening::Pause => self.order(&Order::Pause),
            Happening::Resume => self.order(&Order::Resume),
            Happening::Note => self.order(&Order::Note("coughs".to_owned())),
            Happening::Stop => self.order(&Order::Stop),
            Happening::Escape => {
                self.event(Event::Key(Key::Escape));
                (0..2).for_each(|_| self.frame());
                self.click(Button::Stop);
            }
            Happening::Death => self.resume(),
            Happening::DeathInWrite(part) => self.dies_in_write = Some(part),
        }
    }

    /// Whether the trials have begun: the window passes nothing to the session before.
    fn is_in_session(&mut self) -> bool {
        !self.is_done && self.sitting().intake.step() == Step::Done
    }

    fn event(&mut self, event: Event) {
        if self.is_in_session() {
            let at_s = self.at_s;
            self.sitting().session.on(event, at_s);
            self.after_event();
        }
    }

    fn order(&mut self, order: &Order) {
        if self.is_in_session() {
            let at_s = self.at_s;
            self.sitting().order(order, at_s);
            self.sitting().keep_words().unwrap();
            self.after_event();
        }
    }

    fn click(&mut self, button: Button) {
        self.event(Event::Press(Some(button)));
        self.event(Event::Release(Some(button)));
    }

    fn frame(&mut self) {
        self.at_s += 1.0 / 60.0;
        self.event(Event::Frame);
    }

    /// A frame, and what the subject does when it stands.
    fn go_on(&mut self) {
        self.frame();
        if self.is_in_session() {
            self.reply_to_screen();
        } else if !self.is_done {
            self.reply_to_intake();
        }
    }

    fn reply_to_intake(&mut self) {
        let at_s = self.at_s;
        let intake = &mut self.sitting().intake;
        intake.shown(at_s - 0.25);
        let reply = match intake.step() {
            Step::Consent => Reply::Agree,
            Step::Form => {
                *intake.answer_mut(0).unwrap() = "left eye only".to_owned();
                *intake.answer_mut(1).unwrap() = "me@x.org".to_owned();
                Reply::HandIn
            }
            Step::Plate(index) => Reply::Digit(u8::try_from(index).ok()),
            Step::Letter(_) => Reply::Side(None),
            Step::Done | Step::Left => return,
        };
        let Some(finished) = intake.reply(reply, at_s) else {
            return;
        };
        let before = Files::of(self.sitting());
        self.sitting().keep(finished, at_s).unwrap();
        if self.dies_in_write.take().is_some() {
            fs::write(&before.sidecar.0, &before.sidecar.1).unwrap();
            self.resume();
        }
    }

    fn reply_to_screen(&mut self) {
        let session = &self.sitting().session;
        let (screen, trial) = (
            session.screen(),
            session.trials().get(session.rated()).cloned(),
        );
        if !screen.has_scale() {
            let is_grey = screen == Screen::Blank || screen.picture().is_some();
            if !is_grey {
                self.click(Button::Continue);
            }
            return;
        }
        let plan = &self.place.study.protocol.session;
        let trial = trial.unwrap();
        let [test, reference] = answer_to(&trial, plan.scale);
        if plan.layout == Layout::Dscqs {
            let bars = match trial.first {
                First::Test => [test, reference],
                First::Reference => [reference, test],
            };
            for (bar, place) in bars.into_iter().enumerate() {
                self.click(Button::Bar(bar, place));
            }
            self.click(Button::Continue);
        } else {
            self.click(Button::Rating(test));
        }
    }

    /// What the window does after every event: saves an answer, and notes the end.
    fn after_event(&mut self) {
        let at_s = self.at_s;
        let sitting = self.sitting();
        if sitting.session.to_save().is_some() {
            let before = Files::of(sitting);
            sitting.save(|| at_s).unwrap();
            if let Some(part) = self.dies_in_write.take() {
                before.tear(part);
                return self.resume();
            }
        }
        let sitting = self.sitting();
        if let Some(ending) = sitting.session.ending() {
            sitting.finish(ending, 0, at_s).unwrap();
            self.is_done = ending == Ending::Complete;
            self.resume();
        }
    }

    /// What is on disk is all that the next sitting has.
    fn resume(&mut self) {
        if self.is_done {
            return;
        }
        let on_disk = self.place.rows().len();
        let trials = self.sitting().session.trials().to_vec();
        // The lock goes with the program.
        drop(self.sitting.take());
        match self.place.open() {
            Ok(sitting) => {
                assert_eq!(sitting.session.trials(), trials);
                assert_eq!(sitting.session.rated(), on_disk);
                self.begun_at.push(on_disk);
                self.sitting = Some(sitting);
                self.at_s = 0.0;
            }
            Err(error) => {
                assert_eq!(on_disk, trials.len(), "{error}");
                self.is_done = true;
            }
        }
    }
}

/// Sidecar and ratings at one moment, and where they stand.
struct Files {
    sidecar: (PathBuf, Vec<u8>),
    ratings: (PathBuf, Vec<u8>),
}

impl Files {
    fn of(sitting: &Sitting) -> Self {
        let read = |path: &Path| (path.to_owned(), fs::read(path).unwrap());
        let ratings = sitting.ratings_path();
        Self {
            sidecar: read(&DataSet::sidecar_path(ratings)),
            ratings: read(ratings),
        }
    }

    /// Puts back the sidecar, and of what was added to the ratings since only a part.
    fn tear(&self, part: f64) {
        let (path, before) = &self.ratings;
        let after = fs::read(path).unwrap();
        assert!(after.starts_with(before) && after.len() > before.len());
        let added = (after.len() - before.len()) as f64;
        let kept = (0..).take_while(|&bytes| f64::from(bytes) <= part * added);
        fs::write(path, &after[..before.len() + kept.count() - 1]).unwrap();
        fs::write(&self.sidecar.0, &self.sidecar.1).unwrap();
    }
}

/// Sits the whole session; says how many trials were rated when each sitting began.
pub(super) fn sit(place: &Place, happenings: &[Happening]) -> Vec<usize> {
    let mut subject = Subject::seated(place);
    for &happening in happenings {
        subject.takes(happening);
    }
    for _ in 0..100_000 {
        if subject.is_done {
            return subject.begun_at;
        }
        subject.go_on();
    }
    panic!("the session is stuck");
}

/// What must not depend on when a session was cut off: each file without its times.
#[derive(Debug, PartialEq)]
struct Kept {
    rows: Vec<RatingRow>,
    /// Form and screening, and what the form keeps apart.
    intake: Vec<String>,
    /// What the sidecar says of consent and screening.
    record: [Value; 2],
}

impl Kept {
    fn of(place: &Place) -> Self {
        let timeless = |row: RatingRow| RatingRow {
            response_time_s: 0.0,
            exposure_submitted_s: 0.0,
            missed_frames: 0,
            // A trial that is resumed begins to count anew.
            showings: 0,
            started_at: String::new(),
            ..row
        };
        let ratings = place.ratings_path();
        let name = ratings.file_name().unwrap().to_string_lossy().into_owned();
        let task = if place.options.pilot.is_some() {
            "task-pilot"
        } else {
            "task-"
        };
        let word = if place.options.pilot.is_some() {
            "task-pilot"
        } else {
            "task-rating"
        };
        let table = |what: &str| name.replace(word, &format!("{task}{what}"));
        let form = ratings.with_file_name(table("form"));
        let apart = place.options.data_dir.join("private").join(table("form"));
        let screening = fs::read_to_string(ratings.with_file_name(table("screening"))).unwrap();
        // The last column is the time of the answer.
        let without_time = |line: &str| line.rsplit_once(',').unwrap().0.to_owned();
        let screening: Vec<String> = screening.lines().map(without_time).collect();
        let sidecar = fs::read(DataSet::sidecar_path(&ratings)).unwrap();
        let sidecar: Value = serde_json::from_slice(&sidecar).unwrap();
        let record = |field: &str| sidecar["intake"][field].clone();
        Self {
            rows: place.rows().into_iter().map(timeless).collect(),
            intake: vec![
                fs::read_to_string(form).unwrap(),
                fs::read_to_string(apart.with_extension("json")).unwrap(),
                screening.join("\n"),
            ],
            record: [record("consent_sha256"), record("screening")],
        }
    }
}

/// The sidecar has every sitting with its first trial.
fn check_sittings(place: &Place, begun_at: &[usize]) {
    let sidecar = fs::read(DataSet::sidecar_path(&place.ratings_path())).unwrap();
    let sidecar: Value = serde_json::from_slice(&sidecar).unwrap();
    let sittings = sidecar["sittings"].as_array().unwrap().iter();
    let first = sittings.map(|sitting| sitting["first_trial_id"].as_u64().unwrap() - 1);
    assert!(
        first.eq(begun_at.iter().map(|&rated| rated as u64)),
        "{begun_at:?}"
    );
}

#[test]
fn a_session_resumed_after_any_events_is_the_one_that_was_never_cut_off() {
    let wanted = std::env::var("ACUITY_RESUMED_SESSIONS").ok();
    let cases = wanted
        .and_then(|text| text.parse().ok())
        .unwrap_or(SESSIONS);
    let config = ProptestConfig {
        cases,
        failure_persistence: None,
        ..ProptestConfig::default()
    };
    let stimuli = Place::in_memory();
    let (number, inside, before_trials) = (Cell::new(0), Cell::new(0), Cell::new(0));
    let session = |(kind, happenings): (Kind, Vec<Happening>)| {
        number.set(number.get() + 1);
        let cut_off = place(&stimuli, &format!("cut-{}", number.get()), kind);
        let whole = place(&stimuli, &format!("whole-{}", number.get()), kind);
        prop_assert_eq!(sit(&whole, &[]), vec![0]);
        let begun_at = sit(&cut_off, &happenings);
        prop_assert_eq!(Kept::of(&cut_off), Kept::of(&whole));
        prop_assert_eq!(cut_off.rows().len(), 30);
        check_sittings(&cut_off, &begun_at);
        inside.set(inside.get() + begun_at.iter().filter(|&&rated| rated > 0).count());
        before_trials
            .set(before_trials.get() + begun_at[1..].iter().filter(|&&rated| rated == 0).count());
        for place in [cut_off, whole] {
            fs::remove_dir_all(&place.options.data_dir).unwrap();
        }
        Ok(())
    };
    let mut runner = TestRunner::new(config);
    runner.run(&(kind(), happenings()), session).unwrap();
    let (inside, before) = (inside.get(), before_trials.get());
    assert!(
        inside > cases as usize && before > 0,
        "of {cases} sessions {inside} deaths in the middle, {before} before the first rating"
    );
}
