//! The experimenter's orders.

use experiment::{Button, Ending, Noted, Order, Screen};

use crate::screening::{FLANKING, Screening};

#[test]
fn the_experimenter_lets_an_exposure_rest_and_it_is_shown_again() {
    let mut screening = Screening::new(FLANKING);
    screening.click(Button::Continue);
    screening.until_exposure();
    screening.frames(30);
    let left_s = screening.session.screen_left_s(screening.now_s).unwrap();
    // 30 frames since the first with the images was drawn, 29 since it was submitted, of 2 s.
    assert!((left_s - (2.0 - 29.0 / 60.0)).abs() < 1e-9, "{left_s}");
    screening.session.order(&Order::Pause, screening.now_s);
    assert!(screening.session.is_resting());
    assert_eq!(screening.session.screen(), Screen::Paused);
    screening.frames(600);
    screening
        .session
        .order(&Order::Note("coughs".to_owned()), screening.now_s);
    screening.session.order(&Order::Resume, screening.now_s);
    assert!(!screening.session.is_resting());
    screening.until_scale();
    screening.click(Button::Rating(4));
    let answer = *screening.session.to_save().unwrap();
    assert_eq!((answer.showings, answer.rating), (2, 4));
    assert!((answer.exposure_submitted_s - 2.0).abs() < 1.0 / 60.0);
    let notes = screening.session.take_notes();
    let count = |event: Noted| notes.iter().filter(|note| note.event == event).count();
    assert_eq!((count(Noted::Experimenter), count(Noted::Words)), (2, 1));
    assert_eq!(count(Noted::ExposureInterrupted), 1);
}

#[test]
fn the_experimenter_stops_a_session_but_not_an_answer_on_its_way_to_the_disk() {
    let mut screening = Screening::new(FLANKING);
    screening.click(Button::Continue);
    screening.until_scale();
    screening.click(Button::Rating(4));
    screening.session.order(&Order::Stop, screening.now_s);
    assert_eq!(
        (
            screening.session.ending(),
            screening.session.to_save().is_some()
        ),
        (None, true)
    );
    screening.saved();
    screening.session.order(&Order::Stop, screening.now_s);
    assert_eq!(screening.session.ending(), Some(Ending::Stopped));
    assert_eq!(screening.session.rated(), 1);
}
