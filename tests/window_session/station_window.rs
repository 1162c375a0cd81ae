//! The station's window as hands and eyes meet it.

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::process::Stdio;
use std::thread::sleep;
use std::time::Duration;

use experiment::StationFile;

use crate::display::{Display, Manager, SIZE, Screenshot};
use crate::{PROTOCOL, Place, output_of};

/// The outline's line stands upright at its left and right end: the most distant columns of its blue in the left part.
fn outline_px(shot: &Screenshot) -> Option<usize> {
    let is_line = |x: usize, y: usize| {
        let [red, green, blue] = shot.pixel([x, y]);
        blue > 200 && blue > green && green > red
    };
    let rows = (0..SIZE[1]).rev().filter_map(|y| {
        let columns: Vec<usize> = (0..SIZE[0]).filter(|&x| is_line(x, y)).collect();
        Some(columns.last()? - columns.first()? + 1)
    });
    rows.max().filter(|width| *width > 50)
}

/// The window opens on the first page; the outline is 324 pixels wide (a card at 96 pixels an inch).
#[test]
fn an_outline_made_as_wide_as_a_card_is_the_size_of_the_screen() {
    let Some(display) = Display::open(Manager::Openbox) else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("station.toml");
    let mut command = display.command(env!("CARGO_BIN_EXE_acuity"));
    let child = command
        .args(["station", PROTOCOL, "--window", "--out"])
        .arg(&path)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let is_there =
        |shot: &Screenshot| outline_px(shot).is_some_and(|width| width.abs_diff(324) <= 1);
    display.wait_for("the outline", is_there);
    // The page takes its last size within a few frames.
    sleep(Duration::from_millis(500));
    let shot = display.screenshot();
    assert_eq!(outline_px(&shot).unwrap().abs_diff(324), 0);
    display.click([400, 350]);
    // On a busy machine a key may repeat: then the other one goes back.
    for _ in 0..60 {
        match outline_px(&display.screenshot()) {
            Some(312) => break,
            Some(width) if width < 312 => display.key("Right"),
            _ => display.key("Left"),
        }
        sleep(Duration::from_millis(100));
    }
    display.wait_for("an outline of 312 pixels", |shot| {
        outline_px(shot) == Some(312)
    });
    // "Save and close" is the last button of the foot.
    display.click([SIZE[0] - 80, SIZE[1] - 36]);
    let (code, text) = output_of(child);
    assert_eq!(code, Some(0), "{text}");
    let station = StationFile::read(&path).unwrap();
    // 85.60 mm / 312 = 0.27436 mm; 1280 of them are 351.18 mm; 0.27436 / tan(0.019 degrees) = 82.7 cm (bc -l).
    assert!((station.width_mm - 351.18).abs() < 0.01, "{station:?}");
    assert_eq!((station.width_px, station.distance_cm), (1280, 82.7));
    assert!(text.contains("82.7 cm"), "{text}");
    let mode = fs::metadata(&path).unwrap().permissions().mode();
    assert_eq!(mode & 0o777, 0o600);
}

/// Where there is a display, `check` asks it; Xvfb has one monitor, "screen".
#[test]
fn check_asks_the_display_for_the_monitor_of_the_station() {
    let Some(display) = Display::open(Manager::None) else {
        return;
    };
    let place = Place::new();
    let station = place.folder.path().join("acuity/station.toml");
    fs::create_dir(station.parent().unwrap()).unwrap();
    let check = |text: &str| {
        fs::write(&station, text).unwrap();
        let mut command = display.command(env!("CARGO_BIN_EXE_acuity"));
        let output = command
            .args(["check", PROTOCOL, "--stimuli"])
            .arg(place.folder.path().join("stimuli"))
            .arg("--data")
            .arg(place.folder.path().join("data"))
            .env("XDG_CONFIG_HOME", place.folder.path())
            .output()
            .unwrap();
        (
            output.status.code(),
            String::from_utf8(output.stdout).unwrap(),
        )
    };
    let good = "monitor = \"screen\"\nwidth_mm = 431.26\nwidth_px = 1280\ndistance_cm = 101.6\n";
    let (code, said) = check(good);
    assert_eq!(code, Some(0), "{said}");
    assert!(
        said.contains("screen: monitor screen, 1280 x 1024 pixels"),
        "{said}"
    );
    assert!(said.trim_end().ends_with("ready"), "{said}");
    for (old, new, named) in [
        ("\"screen\"", "\"DP-7\"", "expected one named \"DP-7\""),
        ("width_px = 1280", "width_px = 1920", "expected the 1920"),
    ] {
        let (code, said) = check(&good.replace(old, new));
        assert_eq!(code, Some(2), "{said}");
        assert!(
            said.contains("not ready: ") && said.contains(named),
            "{said}"
        );
    }
}
