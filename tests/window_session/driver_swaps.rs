//! A driver that tells when it swapped each frame, and what the data then say.
//!
//! Software rendering tells nothing, so the driver is played: a client of the X server presents one pixel, under the
//! next number, for each frame that it sees drawn, and writes down what the server says of each. The frames of an
//! exposure are counted by the program's own table of frames.

use std::collections::HashMap;
use std::fs;
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread::{self, sleep};
use std::time::Duration;

use x11rb::connection::Connection as _;
use x11rb::protocol::Event;
use x11rb::protocol::damage::{ConnectionExt as _, ReportLevel};
use x11rb::protocol::present::{CompleteMode, ConnectionExt as _, EventMask};
use x11rb::protocol::xproto::{ConnectionExt as _, MapState, Window};
use x11rb::rust_connection::RustConnection;

use crate::display::{Display, Manager, SIZE};
use crate::{Place, is_page, is_scale};

/// Its numbers wrap in the first exposure.
const FIRST_SWAP: u32 = u32::MAX - 60;
/// Longer than the rest after which the program takes every swap for heard, however busy the computer is.
const REST: Duration = Duration::from_millis(600);

/// What the server said of one swap.
struct Done {
    number: u32,
    at_us: u64,
    refresh: u64,
    /// Whether a later one took its place at the same refresh.
    is_skipped: bool,
}

/// Plays the driver of the window that fills this screen until the screen is gone.
fn play_driver(screen: String) -> Receiver<Done> {
    let (tell, done) = mpsc::channel();
    thread::spawn(move || {
        let (connection, screen) = RustConnection::connect(Some(&screen)).unwrap();
        let root = connection.setup().roots[screen].root;
        let window = window_that_fills(&connection, root);
        _ = follow(&connection, window, &tell);
    });
    done
}

fn window_that_fills(connection: &RustConnection, root: Window) -> Window {
    for _ in 0..3000 {
        let children = connection.query_tree(root).unwrap().reply().unwrap();
        for window in children.children {
            let looks = connection.get_window_attributes(window).unwrap().reply();
            if looks.is_ok_and(|looks| looks.map_state == MapState::VIEWABLE) {
                return window;
            }
        }
        sleep(Duration::from_millis(5));
    }
    panic!("no window")
}

fn follow(
    connection: &RustConnection,
    window: Window,
    tell: &Sender<Done>,
) -> Result<(), Box<dyn std::error::Error>> {
    connection.damage_query_version(1, 1)?.reply()?;
    connection.present_query_version(1, 2)?.reply()?;
    let events = connection.generate_id()?;
    connection.present_select_input(events, window, EventMask::COMPLETE_NOTIFY)?;
    let damage = connection.generate_id()?;
    connection.damage_create(damage, window, ReportLevel::RAW_RECTANGLES)?;
    let pixel = connection.generate_id()?;
    connection.create_pixmap(24, pixel, window, 1, 1)?;
    connection.flush()?;
    let mut number = FIRST_SWAP;
    loop {
        match connection.wait_for_event()? {
            Event::DamageNotify(drawn) if usize::from(drawn.area.width) == SIZE[0] => {
                connection.present_pixmap(
                    window,
                    pixel,
                    number,
                    0,
                    0,
                    0,
                    0,
                    0,
                    0,
                    0,
                    0,
                    0,
                    0,
                    0,
                    &[],
                )?;
                connection.flush()?;
                number = number.wrapping_add(1);
            }
            Event::PresentCompleteNotify(done) => tell.send(Done {
                number: done.serial,
                at_us: done.ust,
                refresh: done.msc,
                is_skipped: done.mode == CompleteMode::SKIP,
            })?,
            _ => {}
        }
    }
}

#[test]
fn an_exposure_is_known_between_the_swaps_of_a_driver_that_tells_them() {
    let Some(display) = Display::open(Manager::None) else {
        return;
    };
    let place = Place::new();
    let done = play_driver(display.name().to_owned());
    let mut child = place.session(&display, "D1", "5").spawn().unwrap();
    display.wait_for("the instructions", is_page);
    let data = place.folder.path().join("data");
    let stem = "study-meyerliu1992_subject-D1_session-1_task-pilot";
    let read = |name: String| fs::read_to_string(data.join(name)).unwrap();
    let seen = || -> Vec<Exposure> {
        let events = read(format!("timing/{stem}_events.csv"));
        events.lines().filter_map(Exposure::of).collect()
    };
    sleep(REST);
    display.key("Return");
    // On a busy computer the driver may be late; such an exposure is left out, never guessed.
    for trial in 1..=10 {
        display.wait_for("the scale", is_scale);
        for key in ["7", "Return"] {
            sleep(REST);
            display.key(key);
        }
        place.wait_for_row("D1", trial);
        if seen().len() >= 2 {
            break;
        }
    }
    child.kill().unwrap();
    child.wait().unwrap();

    let frames = read(format!("timing/{stem}_frames.csv"));
    let sidecar: serde_json::Value =
        serde_json::from_str(&read(format!("data/{stem}_data.json"))).unwrap();
    assert_eq!(sidecar["sittings"][0]["station"]["tells_swaps"], true);

    let swaps: HashMap<u32, Done> = done.try_iter().map(|done| (done.number, done)).collect();
    let exposures = seen();
    assert!(exposures.len() >= 2);
    for exposure in &exposures {
        let [onset, offset] = exposure.swaps.map(|number| &swaps[&number]);
        let trial = exposure.trial;
        assert_eq!(exposure.length_us, offset.at_us - onset.at_us);
        assert_eq!(exposure.refreshes, offset.refresh - onset.refresh);
        assert!(!onset.is_skipped && !offset.is_skipped);
        let [first, last] = exposure.swaps;
        let run = format!("1,{trial},flanked,");
        let run = frames.lines().find(|line| line.starts_with(&run)).unwrap();
        let intervals = run.split(',').next_back().unwrap();
        let frames = intervals.split(' ').count() + 1;
        // A skipped first frame hands over to the next one.
        let counted = usize::try_from(last.wrapping_sub(first)).unwrap();
        let [later, longer] = [first, last].map(|number| skipped_before(&swaps, number));
        assert!((frames - later..=frames + longer).contains(&counted));
    }
}

/// How many swaps just before this one were skipped.
fn skipped_before(swaps: &HashMap<u32, Done>, number: u32) -> usize {
    let before = (1..).map(|back| swaps.get(&number.wrapping_sub(back)));
    before
        .take_while(|done| done.is_some_and(|done| done.is_skipped))
        .count()
}

/// A line of the table of events.
struct Exposure {
    trial: u32,
    length_us: u64,
    refreshes: u64,
    swaps: [u32; 2],
}

impl Exposure {
    fn of(line: &str) -> Option<Self> {
        let (before, detail) = line.split_once(",exposure_swapped,")?;
        let words: Vec<&str> = detail.trim_matches('"').split(' ').collect();
        let number = |index: usize| words[index].trim_end_matches(',');
        Some(Self {
            trial: before.rsplit(',').next()?.parse().ok()?,
            length_us: number(0).replace('.', "").parse().ok()?,
            refreshes: number(2).parse().ok()?,
            swaps: [number(6).parse().ok()?, number(9).parse().ok()?],
        })
    }
}
