//! The experimenter's view beside a running session: it pauses and stops it, and its notes go into the data.

use std::fs;
use std::thread::sleep;
use std::time::Duration;

use crate::display::{Display, Manager};
use crate::{CONTINUE, Place, is_page, output_of};

const TITLE: &str = "experimenter's view";
const SIZE: [usize; 2] = [620, 560];

/// Clicks in the view, so many pixels above its lower edge.
fn click(display: &Display, x: usize, above_foot: usize) {
    display.click_in(TITLE, [x, SIZE[1] - above_foot]);
    sleep(Duration::from_millis(400));
}

#[test]
fn the_experimenter_pauses_notes_and_stops() {
    let Some(display) = Display::open(Manager::Openbox) else {
        return;
    };
    let place = Place::new();
    let mut session = place.session(&display, "V1", "2");
    let child = session.arg("--experimenter").spawn().unwrap();
    display.wait_for("the instructions", is_page);
    display.place(TITLE, SIZE);
    // For two seconds after the view has opened the subject's window takes the keyboard back.
    sleep(Duration::from_secs(3));
    click(&display, 200, 82);
    display.write("coughs");
    display.key("Return");
    sleep(Duration::from_millis(300));
    display.click(CONTINUE);
    display.wait_for("the end of the instructions", |shot| !is_page(shot));
    click(&display, 50, 32);
    display.wait_for("the rest", is_page);
    click(&display, 60, 32);
    display.wait_for("the end of the rest", |shot| !is_page(shot));
    click(&display, 180, 32);
    click(&display, 60, 32);
    let (code, text) = output_of(child);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("stopped after 0 of 30 trials"), "{text}");
    let sidecar = fs::read(place.ratings("V1").with_extension("json")).unwrap();
    let sidecar: serde_json::Value = serde_json::from_slice(&sidecar).unwrap();
    let notes = &sidecar["sittings"][0]["notes"];
    assert_eq!(
        (&notes[0]["text"], &notes[0]["trial_id"]),
        (&"coughs".into(), &1.into())
    );
    let name = "study-meyerliu1992_subject-V1_session-1_task-pilot_events.csv";
    let events = fs::read_to_string(place.folder.path().join("data/timing").join(name)).unwrap();
    for line in [
        "experimenters_view,\"opened\"",
        "note,\"coughs\"",
        "experimenter,\"pause\"",
        "experimenter,\"resume\"",
        "experimenter,\"stop\"",
        "ended,\"stopped\"",
        "screen_watch,",
    ] {
        assert_eq!(events.matches(line).count(), 1, "{line}: {events}");
    }
}
