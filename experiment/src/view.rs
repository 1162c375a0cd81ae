//! What the session tells the experimenter's view, and what the view asks of it.
//!
//! The view is a program of its own, so that drawing it takes no frame of the subject's window and its death none of
//! the data. The session writes a [`Glance`] a line into its input; it prints an [`Order`] a line.

use protocols::rating::Phase;
use serde::{Deserialize, Serialize};

use crate::{Picture, Screen};

/// What the experimenter sees of the session at one moment.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Glance {
    /// The study and the subject's code.
    pub title: String,
    /// How many times faster a trial run is.
    pub pilot: Option<f64>,
    /// What is on the subject's screen, in words.
    pub screen: String,
    /// The image of the present trial.
    pub stimulus: Option<String>,
    /// The trial, from 1, and how many there are.
    pub trial: [usize; 2],
    /// Whether it is a practice trial.
    pub is_practice: bool,
    /// Whether the session rests.
    pub is_resting: bool,
    /// Seconds left on the present screen, if it ends by itself.
    pub screen_left_s: Option<f64>,
    /// Seconds left of the session at the pace so far.
    pub session_left_s: Option<f64>,
    /// The ratings so far, in the order of the trials.
    pub ratings: Vec<i32>,
    /// The ends of the scale.
    pub scale: [i32; 2],
    /// Frames of test images that came late, in this sitting.
    pub missed_frames: u32,
    /// Their refresh as it was measured, in words.
    pub refresh: String,
}

/// What the experimenter asks of the session.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Order {
    /// The view stands on the screen.
    Opened,
    /// The session rests.
    Pause,
    /// It goes on.
    Resume,
    /// It ends; every rating is kept.
    Stop,
    /// Words for the data.
    Note(String),
}

/// What is on the subject's screen, in the experimenter's words.
pub(crate) fn screen_in_words(screen: Screen) -> &'static str {
    match screen {
        Screen::Instructions | Screen::Page(_) => "reads the instructions",
        Screen::Break { .. } => "has a break",
        Screen::Resumed => "is told that the session goes on",
        Screen::PracticeOver => "is told that the practice is over",
        Screen::Blank => "sees grey",
        Screen::Exposure(_, picture) | Screen::RatedExposure(_, picture) => match picture {
            Picture::Flanked => "sees the image between its anchors",
            Picture::ZeroAnchor => "sees the zero anchor",
            Picture::Test => "sees the test image",
            Picture::TenAnchor => "sees the reference",
        },
        Screen::Rating => "rates",
        Screen::TooSlow => "is told that the answer took too long",
        Screen::Paused => "rests",
        Screen::ConfirmStop => "is asked whether to stop",
        Screen::Thanks => "is thanked: the session is over",
    }
}

/// Whether a trial of this phase is practice.
pub(crate) fn is_practice(phase: Phase) -> bool {
    phase == Phase::Practice
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_and_glances_pass_through_a_line_of_text() {
        for order in [
            Order::Opened,
            Order::Pause,
            Order::Resume,
            Order::Stop,
            Order::Note("coughs,\n\"twice\"".to_owned()),
        ] {
            let line = serde_json::to_string(&order).unwrap();
            assert!(!line.contains('\n'), "{line}");
            assert_eq!(serde_json::from_str::<Order>(&line).unwrap(), order);
        }
        let glance = Glance {
            ratings: vec![3, 10],
            screen_left_s: Some(1.5),
            ..Glance::default()
        };
        let line = serde_json::to_string(&glance).unwrap();
        assert_eq!(serde_json::from_str::<Glance>(&line).unwrap(), glance);
    }
}
