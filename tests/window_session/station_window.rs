//! The station's window as hands and eyes meet it.

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::process::Stdio;
use std::thread::sleep;
use std::time::Duration;

use experiment::StationFile;

use crate::display::{Display, Manager, SIZE, Screenshot};
use crate::{PROTOCOL, output_of};

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
    for _ in 0..12 {
        display.key("Left");
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
