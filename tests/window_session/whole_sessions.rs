//! Whole sessions with every page that a protocol may have: one by keys alone, as with a subject, and one by the mouse
//! alone, on a display whose colours were typed.

use std::fs;
use std::process::{Child, Stdio};
use std::thread::sleep;
use std::time::Duration;

use protocols::rating::{Phase, RatingRow, read_ratings};

use crate::attention::take_focus;
use crate::display::{Display, Manager, SIZE, Screenshot};
use crate::picture_study::{CORNER, NAMES, PICTURE, pixels, place};
use crate::{CONTINUE, GREY, is_button, is_page, output_of, rating_button};

const PAGES: &str = r#"
layout = "flanking"
exposure_s = 2.0
practice = ["one"]
progress = true
photodiode = true

[session.consent]
text = "You may stop at any time."

[[session.form]]
key = "age"
label = "How old are you?"
kind = "number"
lowest = 18
unit = "years"

[[session.form]]
key = "glasses"
label = "Do you wear glasses?"
kind = "choice"
choices = ["yes", "no"]

[session.screening]
seed = 1
grades = [1.0]
strokes_px = [6]
letters_each = 1

[[session.pages]]
text = "The worst and the best."
pictures = ["worst", "original"]
captions = ["0", "10"]

[session.breaks]
every = 2
seconds = 2
"#;

/// Where things are on a screen of 1280 x 1024 pixels.
const AGREE: [usize; 2] = [460, 901];
const AGE: [usize; 2] = [300, 219];
const HAND_IN: [usize; 2] = [640, 901];
const DIGIT_3: [usize; 2] = [509, 824];
const TO_THE_RIGHT: [usize; 2] = [924, 471];

fn is_plate(shot: &Screenshot) -> bool {
    is_button(shot, DIGIT_3, 30)
}

fn is_letter(shot: &Screenshot) -> bool {
    is_button(shot, TO_THE_RIGHT, 34)
}

fn is_form(shot: &Screenshot) -> bool {
    is_button(shot, HAND_IN, 120) && !is_plate(shot)
}

/// What the three places of the paper's layout show, with 24 pixels between.
fn flanked(shot: &Screenshot) -> [Vec<u8>; 3] {
    let step = PICTURE[0] + 24;
    let [left, top] = CORNER;
    [left - step, left, left + step].map(|left| shot.part([left, top], PICTURE))
}

/// How a subject goes through the pages.
trait Hands {
    fn agree(&self, display: &Display);
    fn fill_in(&self, display: &Display);
    fn digit(&self, display: &Display);
    fn side(&self, display: &Display);
    fn go_on(&self, display: &Display);
    fn rate(&self, display: &Display, rating: usize);
}

struct Keys;
struct Mouse;

impl Hands for Keys {
    fn agree(&self, display: &Display) {
        display.key("Tab");
        display.key("Return");
    }

    fn fill_in(&self, display: &Display) {
        for keys in [
            &["Tab"][..],
            &["3", "4", "Tab", "Tab", "space", "Tab", "Return"],
        ] {
            sleep(Duration::from_millis(300));
            for key in keys {
                display.key(key);
                sleep(Duration::from_millis(100));
            }
        }
    }

    fn digit(&self, display: &Display) {
        display.key("3");
    }

    fn side(&self, display: &Display) {
        display.key("Right");
    }

    fn go_on(&self, display: &Display) {
        display.key("space");
    }

    fn rate(&self, display: &Display, rating: usize) {
        display.write(&rating.to_string());
        display.key("Return");
    }
}

impl Hands for Mouse {
    fn agree(&self, display: &Display) {
        display.click(AGREE);
    }

    /// An age is typed all the same.
    fn fill_in(&self, display: &Display) {
        display.click(AGE);
        display.write("34");
        let no = [370, 342];
        display.click(no);
        sleep(Duration::from_millis(300));
        display.click(HAND_IN);
    }

    fn digit(&self, display: &Display) {
        display.click(DIGIT_3);
    }

    fn side(&self, display: &Display) {
        display.click(TO_THE_RIGHT);
    }

    fn go_on(&self, display: &Display) {
        display.click(CONTINUE);
    }

    fn rate(&self, display: &Display, rating: usize) {
        display.click(rating_button(rating));
    }
}

/// One session from consent to thanks; `as_shown` says what a display makes of bytes. Says which pictures were between
/// the anchors.
fn go_through(
    display: &Display,
    hands: &dyn Hands,
    mut child: Child,
    as_shown: &dyn Fn(&[u8]) -> Vec<u8>,
) -> Vec<&'static str> {
    display.wait_for("the consent", |shot| is_button(shot, AGREE, 110));
    hands.agree(display);
    display.wait_for("the form", is_form);
    hands.fill_in(display);
    // A control, and a plate for each of three axes.
    let mut plate = display.wait_for("a plate", is_plate);
    for _ in 0..4 {
        hands.digit(display);
        plate = display.wait_for("the next", |shot| {
            (is_plate(shot) || is_letter(shot))
                && shot.part([500, 300], [280, 280]) != plate.part([500, 300], [280, 280])
        });
    }
    display.wait_for("a letter", is_letter);
    hands.side(display);
    display.wait_for("the instructions", |shot| is_page(shot) && !is_letter(shot));
    hands.go_on(display);
    sleep(Duration::from_millis(300));
    display.wait_for("a page with pictures", is_page);
    hands.go_on(display);

    let expected = NAMES.map(|name| (name, as_shown(&pixels(name))));
    let mut seen = Vec::new();
    while seen.len() < 4 {
        let shot = display.wait_for("three pictures, a page or a break's end", |shot| {
            flanked(shot)[0] == expected[0].1 || is_page(shot)
        });
        if is_page(&shot) {
            hands.go_on(display);
            display.wait_for("the end of the page", |shot| !is_page(shot));
            continue;
        }
        let [worst, between, best] = flanked(&shot);
        assert!(worst == expected[0].1 && best == expected[1].1);
        let found = expected.iter().find(|(_, bytes)| *bytes == between);
        seen.push(found.unwrap().0);
        // The corner for a photodiode.
        assert_eq!(shot.pixel([5, SIZE[1] - 5]), [255; 3]);
        let shot = display.wait_for("the scale", |shot| is_scale_on(shot, as_shown));
        assert_eq!(shot.pixel([5, SIZE[1] - 5]), [0; 3]);
        hands.rate(display, seen.len() + 2);
        display.wait_for("the end of the scale", |shot| !is_scale_on(shot, as_shown));
    }
    sleep(Duration::from_millis(500));
    display.key("Return");
    let deadline = 100;
    for _ in 0..deadline {
        if child.try_wait().unwrap().is_some() {
            break;
        }
        sleep(Duration::from_millis(50));
    }
    let (code, text) = output_of(child);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("all 4 trials rated"), "{text}");
    seen
}

/// The scale on the grey of this display.
fn is_scale_on(shot: &Screenshot, as_shown: &dyn Fn(&[u8]) -> Vec<u8>) -> bool {
    let grey = as_shown(&GREY);
    let [x, y] = rating_button(5);
    let is_grey = shot.pixel([x + 49, y])[..] == grey[..];
    is_grey && (0..=10).all(|rating| is_button(shot, rating_button(rating), 30))
}

/// What is on disk after it.
fn check_rows(rows: &[RatingRow], seen: &[&str]) {
    let rated: Vec<(&str, i32)> = (rows.iter())
        .map(|row| (row.stimulus_id.as_str(), row.rating))
        .collect();
    let given: Vec<(&str, i32)> = seen.iter().copied().zip(3..).collect();
    assert_eq!(rated, given);
    assert_eq!((seen[0], rows[0].phase), ("one", Phase::Practice));
    assert!(rows[1..].iter().all(|row| row.phase == Phase::Test));
    let mut rated = seen[1..].to_vec();
    rated.sort_unstable();
    assert_eq!(rated, ["one", "three", "two"]);
}

/// With a subject's times and without the bands of a trial run.
#[test]
fn a_whole_session_by_keys_alone() {
    let Some(display) = Display::open(Manager::Openbox) else {
        return;
    };
    let place = place(PAGES, [0, 10]);
    let child = place.session(&display, "7", None).spawn().unwrap();
    let is_consent = |shot: &Screenshot| is_button(shot, AGREE, 110);
    display.wait_for("the consent", is_consent);
    display.key("Escape");
    display.wait_for("the question", |shot| !is_consent(shot));
    display.key("Escape");
    let seen = go_through(&display, &Keys, child, &<[u8]>::to_vec);
    let factors = place.study.protocol.stimuli.factors();
    let ratings = place.file("7", ["data", "task-rating_data.csv"]);
    check_rows(&read_ratings(&ratings, &factors).unwrap().rows, &seen);
    let text = |kind: &str| fs::read_to_string(place.file("7", ["data", kind])).unwrap();
    let events = fs::read_to_string(place.file("7", ["timing", "task-rating_events.csv"])).unwrap();
    for line in [",escape,\"Consent\"", ",gone_on,\"Consent\"", ",break,"] {
        assert_eq!(events.matches(line).count(), 1, "{line}: {events}");
    }
    assert!(text("task-form_data.csv").ends_with(",34,no\n"));
    // A control, three plates, a letter.
    assert_eq!(text("task-screening_data.csv").lines().count(), 1 + 5);
    let sidecar: serde_json::Value = serde_json::from_str(&text("task-rating_data.json")).unwrap();
    assert_eq!(sidecar["sittings"][0]["station"]["refresh"]["frames"], 300);
    assert_eq!(sidecar["sittings"][0]["ending"], "complete");
}

/// The primaries of a desktop monitor and a gamma of 2.2.
const PRIMARIES: &str = ".641,.332,.303,.598,.151,.062,.3127,.329";

/// XYZ of a chromaticity with Y = 1.
fn xyz([x, y]: [f64; 2]) -> [f64; 3] {
    [x / y, 1.0, (1.0 - x - y) / y]
}

fn determinant([a, b, c]: [[f64; 3]; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1])
        + c[0] * (a[1] * b[2] - a[2] * b[1])
}

/// How much of each of three colours makes another, by Cramer's rule.
fn mixed(primaries: [[f64; 3]; 3], color: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|index| {
        let mut with = primaries;
        with[index] = color;
        determinant(with) / determinant(primaries)
    })
}

/// The light of three primaries that together make their white.
fn lights(red: [f64; 2], green: [f64; 2], blue: [f64; 2]) -> [[f64; 3]; 3] {
    let primaries = [xyz(red), xyz(green), xyz(blue)];
    let amounts = mixed(primaries, xyz([0.3127, 0.329]));
    [0, 1, 2].map(|index| primaries[index].map(|part| part * amounts[index]))
}

/// The codes of that display for sRGB, the slow plain way: IEC 61966-2-1 to XYZ, the amounts of the display's
/// primaries, and the power of 1/2.2. Both whites are D65, so white stays white.
fn on_that_display(srgb: &[u8]) -> Vec<u8> {
    let of_srgb = lights([0.64, 0.33], [0.30, 0.60], [0.15, 0.06]);
    let of_display = lights([0.641, 0.332], [0.303, 0.598], [0.151, 0.062]);
    let decoded = |code: &u8| {
        let value = f64::from(*code) / 255.0;
        if value <= 0.04045 {
            value / 12.92
        } else {
            ((value + 0.055) / 1.055).powf(2.4)
        }
    };
    let convert = |pixel: &[u8]| {
        let light: Vec<f64> = pixel.iter().map(decoded).collect();
        let part = |axis: usize| {
            (0..3)
                .map(|index| light[index] * of_srgb[index][axis])
                .sum()
        };
        let amounts = mixed(of_display, [part(0), part(1), part(2)]);
        amounts.map(|amount| nearest(amount.clamp(0.0, 1.0).powf(1.0 / 2.2)))
    };
    srgb.chunks_exact(3).flat_map(convert).collect()
}

/// The nearest of 256 codes.
fn nearest(part: f64) -> u8 {
    let code = (0..=255_u8).min_by(|one, another| {
        let distance = |code: &u8| (f64::from(*code) / 255.0 - part).abs();
        distance(one).total_cmp(&distance(another))
    });
    code.unwrap()
}

#[test]
fn a_whole_session_by_the_mouse_on_a_display_of_typed_colors() {
    let Some(display) = Display::open(Manager::Openbox) else {
        return;
    };
    let place = place(PAGES, [0, 10]);
    let station = display
        .command(env!("CARGO_BIN_EXE_acuity"))
        .arg("station")
        .arg(&place.study.path)
        .args(["--width-mm", "400", "--width-px", "1280"])
        .args(["--primaries", PRIMARIES, "--gamma", "2.2"])
        .env("XDG_CONFIG_HOME", place.folder.path())
        .stdout(Stdio::null())
        .status();
    assert!(station.unwrap().success());
    let child = place.session(&display, "8", Some("1")).spawn().unwrap();
    display.wait_for("the consent", |shot| is_button(shot, AGREE, 110));
    take_focus(&display);
    let seen = go_through(&display, &Mouse, child, &on_that_display);
    check_rows(&place.rows("8"), &seen);
    // None of it is what an sRGB display would be sent.
    assert!(
        NAMES
            .iter()
            .all(|name| on_that_display(&pixels(name)) != pixels(name))
    );
    let sidecar = fs::read_to_string(place.ratings("8").with_extension("json")).unwrap();
    let sidecar: serde_json::Value = serde_json::from_str(&sidecar).unwrap();
    let station = &sidecar["sittings"][0]["station"];
    assert_eq!(station["compared_px"], 3 * PICTURE[0] * PICTURE[1]);
    assert_eq!(place.count_events("8", "focus_lost"), 1);
}
