//! The app as hands and eyes meet it: two clicks to the next subject, and what becomes of a session without it.

use std::fs;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use experiment::Standing;
use image::{Rgb, RgbImage};
use protocols::Study;

use crate::display::{Display, Manager, SIZE, Screenshot};
use crate::{CONTINUE, is_page, is_scale};

/// Three pictures, each for .3 s: a session that counts, in a few seconds.
const STUDY: &str = r#"
study = "greys"
title = "Three greys"
source = "a test; no published study"
[stimuli]
set = "greys"
images = "pictures/*.png"
factors = "pictures/factors.csv"
[viewing]
distance_cm = 101.6
degrees_per_pixel = 0.019
[session]
layout = "single"
exposure_s = 0.3
pause_s = 0.1
gap_px = 24
background_srgb = 128
response = "buttons"
practice = []
blocks = 1
order_seed = 1
scale = { lowest = 0, highest = 10 }
[session.texts]
instructions = "Three greys."
practice_over = ""
question = "How bright?"
lowest = "dark"
highest = "bright"
thanks = "Thank you."
[simulation]
peak_luminance_cd_m2 = 100.0
bias = { mean = 0.0, sd = 0.3 }
gain = { mean = 0.95, sd = 0.1 }
noise = { mean = 0.0, sd = 0.5 }
ln_response_time = { mean = 0.92, sd = 0.35 }
[analysis]
within = ["grey"]
correction = "greenhouse-geisser"
confidence = 0.95
"#;
/// A pixel of .3369 mm, seen from 101.6 cm: the protocol's .019 degrees.
const STATION: &str = "width_mm = 431.26\nwidth_px = 1280\ndistance_cm = 101.6\n";
/// The fill of the button that a page leads to, and of the mark of a step that is done, in the light theme.
const ACCENT: [u8; 3] = [33, 94, 153];
const DONE: [u8; 3] = [32, 117, 74];

/// A folder with a study whose stimuli are made and whose station is measured.
struct Lab {
    folder: tempfile::TempDir,
}

impl Lab {
    fn new() -> Self {
        let lab = Self {
            folder: tempfile::tempdir().unwrap(),
        };
        fs::create_dir_all(lab.path("pictures")).unwrap();
        fs::create_dir_all(lab.path("config/acuity")).unwrap();
        fs::write(lab.path("greys.toml"), STUDY).unwrap();
        let mut factors = vec!["image,grey".to_owned()];
        for grey in [40, 80, 120] {
            let image = RgbImage::from_pixel(32, 32, Rgb([grey; 3]));
            let name = format!("g{grey}.png");
            image.save(lab.path("pictures").join(&name)).unwrap();
            factors.push(format!("{name},{grey}"));
        }
        fs::write(lab.path("pictures/factors.csv"), factors.join("\n") + "\n").unwrap();
        fs::write(lab.path("config/acuity/app.toml"), "theme = \"light\"").unwrap();
        fs::write(lab.path("config/acuity/station.toml"), STATION).unwrap();
        let mut render = Command::new(env!("CARGO_BIN_EXE_acuity"));
        let render = render.current_dir(lab.folder.path());
        let output = render.args(["-q", "render", "greys.toml"]).output();
        assert!(output.as_ref().unwrap().status.success(), "{output:?}");
        lab
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn app(&self, display: &Display) -> Child {
        let mut command = display.command(env!("CARGO_BIN_EXE_acuity"));
        command
            .args(["app", "greys.toml"])
            .current_dir(self.folder.path())
            .env("XDG_CONFIG_HOME", self.path("config"))
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        command.spawn().unwrap()
    }

    /// How every session stands: subject, ratings, trials, state.
    fn sessions(&self) -> Vec<(String, usize, usize, Standing)> {
        let study = Study::read(&self.path("greys.toml")).unwrap();
        let list = experiment::session_list(&study, &self.path("data/greys")).unwrap();
        assert!(list.faults.is_empty(), "{:?}", list.faults);
        let row = |session: experiment::ListedSession| {
            assert_eq!(session.pilot, None);
            let subject = session.subject.to_string();
            (subject, session.rated, session.trials, session.standing)
        };
        list.sessions.into_iter().map(row).collect()
    }

    fn sidecar(&self) -> serde_json::Value {
        let name = "study-greys_subject-01_session-1_task-rating_data.json";
        let text = fs::read(self.path("data/greys/data").join(name)).unwrap();
        serde_json::from_slice(&text).unwrap()
    }

    /// Clicks and types through the session that is on the screen, to its last one.
    fn sit(&self, display: &Display) {
        let rated = || self.sessions().first().map_or(0, |session| session.1);
        for _ in 0..30 {
            let before = rated();
            if before == 3 {
                break;
            }
            let shot = display.wait_for("a page or the scale", |shot| {
                is_page(shot) || is_scale(shot)
            });
            if is_page(&shot) {
                display.click(CONTINUE);
                display.wait_for("the end of the page", |shot| !is_page(shot));
            } else {
                display.key("7");
                display.key("Return");
                // Keys that came when the scale had just gone count for nothing; then there is another round.
                let mut waits = 0..100;
                while rated() == before && waits.next().is_some() {
                    sleep(Duration::from_millis(20));
                }
            }
        }
        assert_eq!(rated(), 3);
        sleep(Duration::from_millis(300));
        display.key("Return");
    }
}

fn wait(what: &str, is_so: impl Fn() -> bool) {
    for _ in 0..500 {
        if is_so() {
            return;
        }
        sleep(Duration::from_millis(20));
    }
    panic!("{what} did not come");
}

/// A place within the one button of the page that is filled: a block of its colour beside its words.
fn button(shot: &Screenshot) -> Option<[usize; 2]> {
    let is_filled = |x: usize, y: usize| {
        let block = shot.part([x, y], [8, 16]);
        block.chunks_exact(3).all(|pixel| pixel == ACCENT)
    };
    let mut places = (0..SIZE[1] - 16).flat_map(|y| (0..SIZE[0] - 8).map(move |x| [x, y]));
    places.find(|&[x, y]| shot.pixel([x, y]) == ACCENT && is_filled(x, y))
}

/// How many steps are marked as done: discs of the colour, far apart, in the first rows that have any of it.
fn steps_done(shot: &Screenshot) -> usize {
    let is_done = |x: usize, y: usize| shot.pixel([x, y]) == DONE;
    let mut rows = 0..SIZE[1] - 8;
    let Some(top) = rows.find(|&y| (0..SIZE[0]).any(|x| is_done(x, y))) else {
        return 0;
    };
    let has_done = |x: &usize| (top..top + 8).any(|y| is_done(*x, y));
    let columns: Vec<usize> = (0..SIZE[0]).filter(has_done).collect();
    1 + columns
        .windows(2)
        .filter(|pair| pair[1] - pair[0] > 60)
        .count()
}

/// The two clicks.
fn start_next(display: &Display) {
    let shot = display.wait_for("the button Next subject", |shot| button(shot).is_some());
    let next = button(&shot).unwrap();
    assert_eq!(steps_done(&shot), 2);
    display.click(next.map(|place| place + 4));
    let shot = display.wait_for("the button Start session", |shot| {
        button(shot).is_some_and(|start| start[1].abs_diff(next[1]) > 20)
    });
    display.click(button(&shot).unwrap().map(|place| place + 4));
    display.wait_for("the instructions", is_page);
}

#[test]
fn two_clicks_seat_a_subject_and_the_list_then_says_done() {
    let Some(display) = Display::open(Manager::Openbox) else {
        return;
    };
    let lab = Lab::new();
    let mut app = lab.app(&display);
    start_next(&display);
    lab.sit(&display);
    display.wait_for("a third step that is done", |shot| steps_done(shot) == 3);
    let done = ("01".to_owned(), 3, 3, Standing::Complete);
    assert_eq!(lab.sessions(), [done]);
    let station = &lab.sidecar()["sittings"][0]["station"];
    assert_eq!(station["refresh"]["frames"], 300);
    assert!(
        station["refresh"]["is_locked"].is_null(),
        "Xvfb names no refresh rate"
    );
    assert_eq!(station["measured"]["width_px"], 1280);
    assert!(
        station["native_px"].is_null(),
        "Xvfb says of no mode that it is the monitor's own"
    );
    app.kill().unwrap();
    app.wait().unwrap();
}

#[test]
fn a_session_goes_on_when_the_app_is_killed() {
    let Some(display) = Display::open(Manager::Openbox) else {
        return;
    };
    let lab = Lab::new();
    let mut app = lab.app(&display);
    start_next(&display);
    app.kill().unwrap();
    app.wait().unwrap();
    lab.sit(&display);
    wait("the end in the sidecar", || {
        lab.sidecar()["sittings"][0]["ending"] == "complete"
    });
    assert_eq!(lab.sessions()[0].3, Standing::Complete);
}
