//! What counts as an answer by buttons, and what never does.

use experiment::{Button, Event, Key, Rules, Screen};
use protocols::Scale;

use crate::screening::{FLANKING, Screening};

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
