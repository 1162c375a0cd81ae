//! Which images a trial shows, in which order, and what is rated of them.

use experiment::{Button, First, Key, Picture, Rules, Screen};
use protocols::{Layout, RatingTime};

use crate::screening::{FLANKING, Screening, pair};

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
