//! The choice of the experimenter's view: as the station says, unless the box says otherwise.

use std::fs;

use super::*;

const BOX: &str = "Experimenter's view in a second window";
const STATION: &str = "width_mm = 527.04\nwidth_px = 1920\ndistance_cm = 82.8\n";

/// Writes the station, with a monitor for the view or without.
fn station(fixture: &Fixture, monitor: Option<&str>) {
    let path = fixture.place.station.clone().unwrap();
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    let monitor = monitor.map(|name| format!("experimenter_monitor = \"{name}\"\n"));
    fs::write(path, format!("{STATION}{}", monitor.unwrap_or_default())).unwrap();
}

/// Starts the next subject's session; says whether the view was asked for.
fn starts_with_view(user: &mut User<'_>) -> bool {
    user.launcher.answer(Some(0), "the end of it");
    let before = user.launcher.wanted().len();
    user.go("Sessions");
    user.click("Next subject");
    user.click("Start session 01");
    for _ in 0..400 {
        user.harness.run_steps(1);
        if user.launcher.wanted().len() > before && user.sees("the end of it") {
            break;
        }
        sleep(Duration::from_millis(5));
    }
    let words = user.launcher.wanted()[before].clone();
    assert!(
        words.len() == 6 || words[6..] == ["--experimenter"],
        "{words:?}"
    );
    words.len() == 7
}

#[test]
fn the_view_opens_where_the_box_is_ticked() {
    let fixture = ready();
    let mut user = User::with(&fixture);
    assert!(!starts_with_view(&mut user));
    user.click(BOX);
    assert!(user.sees("Alt-Tab"));
    assert!(starts_with_view(&mut user));
    user.click(BOX);
    assert!(!starts_with_view(&mut user));
}

#[test]
fn a_station_with_a_monitor_for_the_view_ticks_the_box() {
    let fixture = ready();
    station(&fixture, Some("DP-2"));
    let mut user = User::with(&fixture);
    user.go("Sessions");
    assert!(user.sees("On the monitor DP-2"));
    assert!(starts_with_view(&mut user));
    user.click(BOX);
    assert!(!user.sees("DP-2") && !starts_with_view(&mut user));
}

#[test]
fn a_resumed_session_and_a_trial_run_have_the_view_too() {
    let fixture = ready();
    let sessions = fixture.simulate_people(1);
    Fixture::cut_to(&sessions[0], 12);
    let mut user = User::with(&fixture);
    user.launcher.answer(Some(0), "stopped after 14 of 30");
    user.launcher.answer(Some(0), "the end of it");
    user.go("Sessions");
    user.click(BOX);
    user.click(&format!("Resume subject {}", sessions[0].subject));
    user.wait("stopped after 14 of 30");
    user.click("Trial run");
    user.click("Start the trial run");
    user.wait("the end of it");
    for words in user.launcher.wanted() {
        assert!(words.ends_with(&["--experimenter".to_owned()]), "{words:?}");
    }
}
