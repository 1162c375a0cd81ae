//! How long the images stand, what of it is logged, and what interrupts them.

use experiment::{Button, Event, Key, Screen};

use crate::screening::{FLANKING, Screening};

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

/// No other key counts before the first frame of a screen was submitted.
#[test]
fn escape_and_pause_are_taken_before_the_first_frame_of_a_picture_too() {
    for key in [Key::Escape, Key::Pause] {
        let mut screening = Screening::new(FLANKING);
        screening.click(Button::Continue);
        screening.until(|screen| matches!(screen, Screen::Exposure(..)));
        assert!(!screening.session.is_shown());
        screening.on(Event::Key(key));
        let asked = screening.session.screen();
        assert!(matches!(asked, Screen::ConfirmStop | Screen::Paused));
        // Nobody has seen the question yet, so nobody has answered it.
        screening.on(Event::Key(Key::Escape));
        screening.on(Event::Key(Key::Enter));
        assert_eq!(screening.session.screen(), asked);
        screening.frames(2);
        screening.on(Event::Key(Key::Enter));
        assert_eq!(screening.session.screen(), Screen::Blank);
    }
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
