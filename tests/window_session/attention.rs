//! What a subject does besides rating: too soon, too late, away, a rest, and the key Escape; each is in the log.

use std::thread::sleep;
use std::time::Duration;

use x11rb::connection::Connection as _;
use x11rb::protocol::xproto::{ConnectionExt as _, CreateWindowAux, InputFocus, WindowClass};
use x11rb::wrapper::ConnectionExt as _;

use crate::display::{Display, Manager};
use crate::picture_study::{CLEAR, picture_on, place, see, see_to_the_end};
use crate::{CONTINUE, Place, STOP, is_button, is_page, is_scale, output_of, rating_button};

/// Stops a session with three trials of which so many are rated, at the next picture.
fn stop(display: &Display, child: std::process::Child, rated: usize) {
    see(display, CLEAR);
    display.key("Escape");
    display.wait_for("the question", |shot| is_button(shot, STOP, 100));
    display.click(STOP);
    let (code, text) = output_of(child);
    assert_eq!(code, Some(0), "{text}");
    let words = format!("stopped after {rated} of 3 trials");
    assert!(text.contains(&words), "{text}");
}

#[test]
fn an_answer_too_soon_is_not_taken_and_one_too_late_sees_the_picture_again() {
    let Some(display) = Display::open(Manager::Openbox) else {
        return;
    };
    let place = place(
        "layout = \"single\"\nexposure_s = 1.5\npractice = []\n\
         shortest_response_s = 3.0\nlongest_response_s = 8.0\n",
        [0, 10],
    );
    let child = place.session(&display, "T1", "1").spawn().unwrap();
    display.wait_for("the instructions", is_page);
    display.click(CONTINUE);
    let name = see_to_the_end(&display, CLEAR);
    display.wait_for("the scale", is_scale);
    display.click(rating_button(9));
    display.wait_for("that it took too long", is_page);
    assert!(place.rows("T1").is_empty());
    display.click(CONTINUE);
    assert_eq!(see_to_the_end(&display, CLEAR), name);
    display.wait_for("the scale", is_scale);
    sleep(Duration::from_millis(3500));
    display.click(rating_button(6));
    place.wait_for_row("T1", 1);
    let row = place.rows("T1")[0].clone();
    assert_eq!((row.stimulus_id.as_str(), row.rating), (name, 6));
    assert_eq!(row.showings, 2);
    assert!((3.0..8.0).contains(&row.response_time_s), "{row:?}");
    stop(&display, child, 1);
    for event in ["answer_too_soon", "answer_too_late"] {
        assert_eq!(place.count_events("T1", event), 1, "{event}");
    }
}

/// A window of another program takes the keyboard for a second.
pub(crate) fn take_focus(display: &Display) {
    let (server, screen) = x11rb::connect(Some(display.name())).unwrap();
    let root = server.setup().roots[screen].root;
    let window = server.generate_id().unwrap();
    let look = CreateWindowAux::new().override_redirect(1);
    let class = WindowClass::INPUT_OUTPUT;
    server
        .create_window(0, window, root, 0, 0, 1, 1, 0, class, 0, &look)
        .unwrap();
    server.map_window(window).unwrap();
    server
        .set_input_focus(InputFocus::PARENT, window, x11rb::CURRENT_TIME)
        .unwrap();
    server.sync().unwrap();
    sleep(Duration::from_secs(1));
}

fn interrupt(display: &Display, key: &str, place: &Place) -> &'static str {
    let name = see(display, CLEAR);
    display.key(key);
    display.wait_for("no picture", |shot| picture_on(shot).is_none());
    assert!(place.rows("T2").is_empty());
    name
}

#[test]
fn rests_questions_and_a_lost_keyboard_interrupt_a_picture_that_is_then_shown_again() {
    let Some(display) = Display::open(Manager::Openbox) else {
        return;
    };
    let place = place(
        "layout = \"single\"\nexposure_s = 4.0\npractice = []\n",
        [0, 10],
    );
    let child = place.session(&display, "T2", "1").spawn().unwrap();
    display.wait_for("the instructions", is_page);
    display.click(CONTINUE);
    let name = interrupt(&display, "p", &place);
    display.wait_for("the rest", is_page);
    display.key("Return");
    assert_eq!(interrupt(&display, "Escape", &place), name);
    display.wait_for("the question", |shot| is_button(shot, STOP, 100));
    display.key("Escape");
    assert_eq!(see(&display, CLEAR), name);
    take_focus(&display);
    display.wait_for("the end of the picture", |shot| picture_on(shot).is_none());
    display.wait_for("the scale", is_scale);
    // The other window has gone with its connection; openbox gives the keyboard back.
    display.click(rating_button(4));
    place.wait_for_row("T2", 1);
    let row = place.rows("T2")[0].clone();
    assert_eq!((row.stimulus_id.as_str(), row.rating), (name, 4));
    assert_eq!(row.showings, 3);
    stop(&display, child, 1);
    for (event, count) in [
        ("pause", 1),
        ("escape", 2),
        ("exposure_interrupted", 2),
        ("focus_lost", 1),
        ("focus_regained", 2),
    ] {
        assert_eq!(place.count_events("T2", event), count, "{event}");
    }
}
