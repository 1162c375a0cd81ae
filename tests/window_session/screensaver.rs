//! The screensaver is held off while a session runs, and noted if it comes all the same.

use std::fs;
use std::thread::sleep;
use std::time::Duration;

use crate::display::{Display, Manager, is_on_path};
use crate::{Place, is_page, stop};

fn xset(display: &Display, arguments: &[&str]) {
    let status = display.command("xset").args(arguments).status().unwrap();
    assert!(status.success());
}

#[test]
fn the_screensaver_is_held_off_and_noted_when_it_is_forced() {
    if !is_on_path("xset") {
        return;
    }
    let Some(display) = Display::open(Manager::Openbox) else {
        return;
    };
    let place = Place::new();
    xset(&display, &["s", "2", "2"]);
    let child = place.session(&display, "S1", "2").spawn().unwrap();
    display.wait_for("the instructions", is_page);
    // Longer than the two seconds after which it would come by itself.
    sleep(Duration::from_secs(4));
    xset(&display, &["s", "activate"]);
    sleep(Duration::from_millis(1500));
    xset(&display, &["s", "reset"]);
    sleep(Duration::from_millis(1500));
    stop(&display, child);
    let name = "study-meyerliu1992_subject-S1_session-1_task-pilot_events.csv";
    let events = fs::read_to_string(place.folder.path().join("data/timing").join(name)).unwrap();
    assert!(
        events.contains("screensaver is watched and held off"),
        "{events}"
    );
    let count = |event: &str| events.matches(&format!(",{event},")).count();
    assert_eq!(
        (count("screensaver_on"), count("screensaver_off")),
        (1, 1),
        "{events}"
    );
}
