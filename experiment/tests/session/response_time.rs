//! Answers that come too soon or too late, and the time that an answer took.

use experiment::{Button, Key, Noted, Rules, Screen};

use crate::screening::{FLANKING, Screening, noted};

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
