//! Breaks and rests.

use experiment::{Breaks, Button, Event, Key, Noted, Rules, Screen, Session};
use protocols::rating::Phase;

use crate::screening::{FLANKING, Screening, noted, three_trials, trial};

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
