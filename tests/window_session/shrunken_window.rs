//! A window that no longer fills the monitor in the middle of a session.

use std::fs;

use crate::display::{Display, Manager};
use crate::{Place, is_page, output_of};

#[test]
fn a_window_that_shrinks_is_noted_and_ends_the_session_with_its_ratings_kept() {
    let Some(display) = Display::open(Manager::None) else {
        return;
    };
    let place = Place::new();
    let child = place.session(&display, "Z1", "40").spawn().unwrap();
    display.wait_for("the instructions", is_page);
    place.rate_until(&display, "Z1", 2);
    display.place("subject Z1", [800, 600]);
    let (code, text) = output_of(child);
    assert_eq!(code, Some(1), "{text}");
    let found = "found a window of 800 x 600 pixels on a monitor of 1280 x 1024";
    assert!(text.contains(found), "{text}");
    assert_eq!(place.rows("Z1").len(), 2);
    let name = "study-meyerliu1992_subject-Z1_session-1_task-pilot_events.csv";
    let events = fs::read_to_string(place.folder.path().join("data/timing").join(name)).unwrap();
    assert!(
        events.contains(",window_size,\"800 x 600 pixels\""),
        "{events}"
    );
}
