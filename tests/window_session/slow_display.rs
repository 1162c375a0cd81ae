//! A display with fewer frames a second than the protocol asks for.

use crate::display::{Display, Manager};
use crate::output_of;
use crate::picture_study::place;

/// No software renderer draws a thousand frames a second.
const SESSION: &str =
    "layout = \"single\"\nexposure_s = 2.0\npractice = [\"two\"]\nlowest_refresh_hz = 1000\n";

#[test]
fn a_display_that_is_too_slow_for_the_protocol_ends_the_session_before_it_begins() {
    let Some(display) = Display::open(Manager::Openbox) else {
        return;
    };
    let place = place(SESSION, [0, 10]);
    let (code, text) = output_of(place.session(&display, "V1", "20").spawn().unwrap());
    assert_eq!(code, Some(1), "{text}");
    let asked = "expected at least 1000 (session.lowest_refresh_hz)";
    assert!(
        text.contains(asked) && text.contains("frames a second"),
        "{text}"
    );
    assert!(!place.ratings("V1").exists());
}
