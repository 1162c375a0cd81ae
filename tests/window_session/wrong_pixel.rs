//! One wrong pixel at the start, and the session does not begin.

use std::thread::sleep;
use std::time::Duration;

use x11rb::connection::Connection as _;
use x11rb::protocol::xproto::{
    ConfigureWindowAux, ConnectionExt as _, CreateWindowAux, StackMode, WindowClass,
};
use x11rb::wrapper::ConnectionExt as _;

use crate::display::{Display, Manager};
use crate::output_of;
use crate::picture_study::{CORNER, PICTURE, pixels, place};

const SESSION: &str = "layout = \"single\"\nexposure_s = 2.0\npractice = [\"two\"]\n";

/// Another program holds a window of one pixel in front, one level off in blue.
#[test]
fn one_pixel_of_another_window_in_front_stops_the_session() {
    let Some(display) = Display::open(Manager::Openbox) else {
        return;
    };
    let place = place(SESSION, [0, 10]);
    let (x, y) = (40, 30);
    let start = 3 * (y * PICTURE[0] + x);
    let [red, green, blue] = pixels("two")[start..start + 3] else {
        unreachable!("three bytes")
    };
    let wrong = blue ^ 1;

    let (server, screen) = x11rb::connect(Some(display.name())).unwrap();
    let root = server.setup().roots[screen].root;
    let window = server.generate_id().unwrap();
    let color = u32::from_be_bytes([0, red, green, wrong]);
    let look = CreateWindowAux::new()
        .override_redirect(1)
        .background_pixel(color);
    let [left, top] = [CORNER[0] + x, CORNER[1] + y].map(|place| i16::try_from(place).unwrap());
    let class = WindowClass::INPUT_OUTPUT;
    server
        .create_window(0, window, root, left, top, 1, 1, 0, class, 0, &look)
        .unwrap();
    server.map_window(window).unwrap();

    let mut child = place.session(&display, "W1", "20").spawn().unwrap();
    let above = ConfigureWindowAux::new().stack_mode(StackMode::ABOVE);
    while child.try_wait().unwrap().is_none() {
        server.configure_window(window, &above).unwrap();
        server.sync().unwrap();
        sleep(Duration::from_millis(2));
    }
    let (code, text) = output_of(child);
    assert_eq!(code, Some(1), "{text}");
    let found = format!(
        "stimulus two, pixel {x}, {y}: the X server's screen holds {:?}, expected {:?}",
        [red, green, wrong],
        [red, green, blue]
    );
    assert!(text.contains(&found), "{text}");
    assert!(!place.ratings("W1").exists() || place.rows("W1").is_empty());
}

/// The graphics library draws with 24 bits all the same; the screen has 5 or 6 for each primary.
#[test]
fn a_screen_of_16_bits_a_pixel_stops_the_session() {
    let Some(display) = Display::of_depth(Manager::Openbox, 16) else {
        return;
    };
    let place = place(SESSION, [0, 10]);
    let output = place.session(&display, "W2", "20").output().unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{text}");
    for words in ["stimulus two, pixel 0, 0", "24 bits a pixel"] {
        assert!(text.contains(words), "{text}");
    }
}
