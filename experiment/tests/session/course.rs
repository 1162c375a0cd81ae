//! Instructions, pages, practice, trials and thanks, one after another; stopped and resumed.

use experiment::{Button, Ending, Key, Picture, Rules, Screen};

use crate::screening::{FLANKING, Screening};

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
