//! Whole sessions in a real window, with a real mouse and keyboard: what is on the screen, and what is on the disk.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

#[path = "window_session/app_window.rs"]
mod app_window;
#[path = "window_session/attention.rs"]
mod attention;
mod display;
#[path = "window_session/driver_swaps.rs"]
mod driver_swaps;
#[path = "window_session/experimenters_view.rs"]
mod experimenters_view;
#[path = "window_session/laboratory.rs"]
mod laboratory;
#[path = "window_session/layouts.rs"]
mod layouts;
#[path = "window_session/picture_study.rs"]
mod picture_study;
#[path = "window_session/screensaver.rs"]
mod screensaver;
#[path = "window_session/shrunken_window.rs"]
mod shrunken_window;
#[path = "window_session/slow_display.rs"]
mod slow_display;
#[path = "window_session/station_window.rs"]
mod station_window;
#[path = "window_session/whole_sessions.rs"]
mod whole_sessions;
#[path = "window_session/wrong_pixel.rs"]
mod wrong_pixel;

use std::fs::{self, OpenOptions};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::Duration;

use display::{Display, Manager, SIZE, Screenshot, png_pixels};
use protocols::Study;
use protocols::rating::{Phase, RatingRow, read_ratings};

const PROTOCOL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/protocols/meyer-liu-1992.toml");
const GREY: [u8; 3] = [128; 3];
/// Where the buttons are on a screen of 1280 x 1024 pixels.
const CONTINUE: [usize; 2] = [640, 880];
const STOP: [usize; 2] = [780, 573];
const SCALE_Y: usize = 512;

fn rating_button(rating: usize) -> [usize; 2] {
    [640 - 5 * 99 + rating * 99, SCALE_Y]
}

/// The face of a button, beside its words: idle, under the mouse, or pressed.
fn is_button(shot: &Screenshot, [x, y]: [usize; 2], left: usize) -> bool {
    matches!(
        shot.pixel([x - left, y]),
        [180, 180, 180] | [215, 215, 215] | [245, 245, 245]
    )
}

fn is_page(shot: &Screenshot) -> bool {
    is_button(shot, CONTINUE, 120)
}

fn is_scale(shot: &Screenshot) -> bool {
    let has_button = |rating| is_button(shot, rating_button(rating), 30);
    let has_gap = |rating| {
        let [x, y] = rating_button(rating);
        shot.pixel([x + 49, y]) == GREY
    };
    (0..=10).all(has_button) && (0..10).all(has_gap)
}

/// A folder with a study's stimuli.
struct Place {
    folder: tempfile::TempDir,
    study: Study,
}

impl Place {
    /// The paper's study.
    fn new() -> Self {
        Self::of(tempfile::tempdir().unwrap(), Path::new(PROTOCOL))
    }

    /// A study of one's own, with its stimuli made in the folder.
    fn of(folder: tempfile::TempDir, protocol: &Path) -> Self {
        let study = Study::read(protocol).unwrap();
        let place = Self { folder, study };
        let mut render = Command::new(env!("CARGO_BIN_EXE_acuity"));
        let output = render
            .args(["-q", "render"])
            .arg(protocol)
            .arg("--out")
            .arg(place.stimuli())
            .output();
        let output = output.unwrap();
        assert!(output.status.success(), "{output:?}");
        place
    }

    fn stimuli(&self) -> PathBuf {
        self.folder.path().join("stimuli")
    }

    /// A file of the data set; kinds are `data/..._task-pilot_data.csv` and the like.
    fn file(&self, subject: &str, [folder, kind]: [&str; 2]) -> PathBuf {
        let study = self.study.protocol.study.replace('-', "");
        let name = format!("study-{study}_subject-{subject}_session-1_{kind}");
        self.folder.path().join("data").join(folder).join(name)
    }

    fn ratings(&self, subject: &str) -> PathBuf {
        self.file(subject, ["data", "task-pilot_data.csv"])
    }

    /// How often an event stands in the log.
    fn count_events(&self, subject: &str, event: &str) -> usize {
        let events = self.file(subject, ["timing", "task-pilot_events.csv"]);
        let events = fs::read_to_string(events).unwrap();
        events.matches(&format!(",{event},")).count()
    }

    /// A session of its own with a subject, or a trial run so many times faster.
    fn session<'a>(
        &self,
        display: &Display,
        subject: &str,
        speed: impl Into<Option<&'a str>>,
    ) -> Command {
        let mut command = display.command(env!("CARGO_BIN_EXE_acuity"));
        command
            .arg("run")
            .arg(&self.study.path)
            .args(["--subject", subject])
            .arg("--stimuli")
            .arg(self.stimuli())
            .arg("--data")
            .arg(self.folder.path().join("data"))
            // No station of the person who runs the tests.
            .env("XDG_CONFIG_HOME", self.folder.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        if let Some(speed) = speed.into() {
            command.args(["--pilot", speed]);
        }
        command
    }

    fn rows(&self, subject: &str) -> Vec<RatingRow> {
        let path = self.ratings(subject);
        let factors = self.study.protocol.stimuli.factors();
        read_ratings(&path, &factors).unwrap().rows
    }

    /// Waits up to a second for so many rows.
    fn wait_for_row(&self, subject: &str, count: usize) {
        let mut waits = 0..100;
        while self.rows(subject).len() < count && waits.next().is_some() {
            sleep(Duration::from_millis(10));
        }
    }

    /// Clicks through the session until `count` trials are on disk; trial *n* gets the rating *n* mod 11.
    fn rate_until(&self, display: &Display, subject: &str, count: usize) {
        loop {
            let rated = self.rows(subject).len();
            if rated == count {
                return;
            }
            let shot = display.wait_for("a page or the scale", |shot| {
                is_page(shot) || is_scale(shot)
            });
            if is_page(&shot) {
                display.click(CONTINUE);
                display.wait_for("the end of the page", |shot| !is_page(shot));
            } else {
                display.click(rating_button((rated + 1) % 11));
                self.wait_for_row(subject, rated + 1);
            }
        }
    }
}

fn output_of(child: Child) -> (Option<i32>, String) {
    let Output {
        status,
        stdout,
        stderr,
    } = child.wait_with_output().unwrap();
    let text = [stdout, stderr].concat();
    (status.code(), String::from_utf8(text).unwrap())
}

/// Escape, Stop, and the program's exit.
fn stop(display: &Display, child: Child) {
    display.key("Escape");
    display.wait_for("the question", |shot| is_button(shot, STOP, 100));
    display.click(STOP);
    let (code, text) = output_of(child);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("stopped after 0 of 30 trials"), "{text}");
}

/// The test image of the first practice trial between the anchors, byte for byte, and grey all around,
/// with `scale` pixels for each point of the desktop.
fn check_exposure(display: &Display, place: &Place, subject: &str, scale: &str) {
    let mut session = place.session(display, subject, "2");
    let child = session
        .env("WINIT_X11_SCALE_FACTOR", scale)
        .spawn()
        .unwrap();
    display.wait_for("the instructions", is_page);

    let second = place.session(display, subject, "2").output().unwrap();
    assert_eq!(second.status.code(), Some(1));
    let text = String::from_utf8(second.stderr).unwrap();
    assert!(text.contains("is in a session already"), "{text}");

    display.click(CONTINUE);
    let pixels = |id: &str| png_pixels(&place.stimuli().join(format!("{id}.png")));
    let practice = place.study.protocol.session.practice[0].as_str();
    let expected = [
        pixels("a010k_c010k"),
        pixels(practice),
        pixels("a140k_c140k"),
    ];
    // 3 images of 320 pixels and 2 gaps of 24, in the middle of 1280 x 1024.
    let corners = [[136, 352], [480, 352], [824, 352]];
    let is_there = |shot: &Screenshot| {
        let mut images = corners.iter().zip(&expected);
        images.all(|(&corner, image)| shot.part(corner, [320, 320]) == *image)
    };
    let shot = display.wait_for("the three images, every byte of them", is_there);
    // Above and below are the bands that say PILOT.
    for y in 54..SIZE[1] - 54 {
        for x in 0..SIZE[0] {
            let is_image = corners.iter().any(|&[left, top]| {
                (left..left + 320).contains(&x) && (top..top + 320).contains(&y)
            });
            assert!(is_image || shot.pixel([x, y]) == GREY, "pixel {x}, {y}");
        }
    }
    stop(display, child);
    assert!(place.rows(subject).is_empty());
}

#[test]
fn the_screen_holds_the_very_bytes_of_the_images_on_neutral_grey() {
    let Some(display) = Display::open(Manager::Openbox) else {
        return;
    };
    let place = Place::new();
    for (subject, scale) in [
        ("P1", "1"),
        ("P125", "1.25"),
        ("P175", "1.75"),
        ("P200", "2"),
    ] {
        check_exposure(&display, &place, subject, scale);
    }
}

#[test]
fn a_session_that_is_killed_goes_on_and_has_every_rating_once() {
    let Some(display) = Display::open(Manager::Openbox) else {
        return;
    };
    let place = Place::new();
    let mut killed = place.session(&display, "P2", "40").spawn().unwrap();
    display.wait_for("the instructions", is_page);
    place.rate_until(&display, "P2", 8);
    display.wait_for("the scale", is_scale);
    sleep(Duration::from_millis(100));
    // In the middle, at 0.62 of the height (634.9), not where the last rating was clicked.
    assert_eq!(display.mouse(), [640, 635]);
    killed.kill().unwrap();
    killed.wait().unwrap();
    assert_eq!(place.rows("P2").len(), 8);
    // What a crash in the middle of a write leaves behind.
    let mut file = OpenOptions::new()
        .append(true)
        .open(place.ratings("P2"))
        .unwrap();
    file.write_all(b"P2,1,9,test,a0").unwrap();

    let resumed = place.session(&display, "P2", "40").spawn().unwrap();
    display.wait_for("the instructions", is_page);
    place.rate_until(&display, "P2", 30);
    sleep(Duration::from_millis(300));
    display.key("Return");
    let (code, text) = output_of(resumed);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("all 30 trials rated"), "{text}");

    let rows = place.rows("P2");
    let order = experiment::trials(&place.study, &"P2".parse().unwrap(), 1).unwrap();
    assert_eq!(rows.len(), 30);
    for ((number, row), trial) in (1..).zip(&rows).zip(&order) {
        assert_eq!(
            (row.trial_id, row.rating),
            (number, i32::try_from(number % 11).unwrap())
        );
        assert_eq!(
            (&row.stimulus_id, row.phase),
            (&trial.stimulus_id, trial.phase)
        );
        assert!(row.pilot);
    }
    let test = rows.iter().filter(|row| row.phase == Phase::Test);
    let mut images: Vec<_> = test.map(|row| &row.stimulus_id).collect();
    images.sort_unstable();
    images.dedup();
    assert_eq!(images.len(), 27);

    let sidecar = fs::read(place.ratings("P2").with_extension("json")).unwrap();
    let sidecar: serde_json::Value = serde_json::from_slice(&sidecar).unwrap();
    assert_eq!(sidecar["sittings"][0]["ending"], serde_json::Value::Null);
    assert_eq!(sidecar["sittings"][1]["ending"], "complete");
    assert_eq!(sidecar["sittings"][1]["first_trial_id"], 9);
    // Each sitting compared the three images with what the window held: 3 x 320 x 320 pixels.
    for sitting in 0..2 {
        let station = &sidecar["sittings"][sitting]["station"];
        assert_eq!(station["compared_px"], 307_200);
        assert_eq!(station["refresh"]["frames"], 20);
    }
    assert!(sidecar["sittings"][0]["frames"]["measured"].as_u64() > Some(0));

    let again = place.session(&display, "P2", "40").output().unwrap();
    assert_eq!(again.status.code(), Some(2));
}

#[test]
fn without_a_window_manager_the_window_still_fills_the_screen() {
    let Some(display) = Display::open(Manager::None) else {
        return;
    };
    let place = Place::new();
    let child = place.session(&display, "P3", "2").spawn().unwrap();
    display.wait_for("the instructions", is_page);
    stop(&display, child);
}

#[test]
fn an_image_that_was_changed_stops_the_session_before_a_window_opens() {
    let Some(display) = Display::open(Manager::None) else {
        return;
    };
    let place = Place::new();
    let image = place.stimuli().join("a070k_c140k.png");
    let mut bytes = fs::read(&image).unwrap();
    *bytes.last_mut().unwrap() ^= 1;
    fs::write(&image, bytes).unwrap();
    let output = place.session(&display, "P4", "2").output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(
        text.contains("a070k_c140k.png") && text.contains("SHA-256"),
        "{text}"
    );
    assert!(!place.folder.path().join("data").exists());
}
