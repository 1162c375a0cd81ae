//! The station from outside: what is typed, what `check` says of it, and what a session refuses.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod acuity;

use std::fs;
use std::path::Path;

use acuity::{PROTOCOL, acuity, stderr, text_of};

/// The paper's study with a tolerance of 2 % on the angle of a pixel, beside its scene.
fn strict_study(folder: &Path) {
    let text = fs::read_to_string(PROTOCOL).unwrap();
    let scene = Path::new(PROTOCOL).with_file_name("../stimuli/scenes/opponent-solids.toml");
    let text = text
        .replace(
            "../stimuli/scenes/opponent-solids.toml",
            &scene.to_string_lossy(),
        )
        .replace("size_px = [320, 320]", "size_px = [32, 32]")
        .replace("blocks = 1", "viewing_tolerance = 0.02\nblocks = 1");
    fs::write(folder.join("strict.toml"), text).unwrap();
}

fn run(folder: &Path, command: &str) -> (Option<i32>, String, String) {
    let output = acuity(folder, &command.split(' ').collect::<Vec<_>>());
    let said = text_of(&output.stdout);
    (output.status.code(), said, stderr(&output))
}

/// 0.02745 / tan(0.019 degrees) = 82.78 cm (bc -l).
#[test]
fn the_tolerance_of_the_protocol_decides_whether_a_session_may_start() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    strict_study(at);
    assert_eq!(run(at, "-q render strict.toml").0, Some(0));
    let start = "run strict.toml --subject 01";

    let (code, _, said) = run(at, start);
    assert_eq!(code, Some(2), "{said}");
    for words in ["no station", "viewing_tolerance", "acuity station"] {
        assert!(said.contains(words), "{said}");
    }

    let typed = "station strict.toml --width-mm 527.04 --width-px 1920 --distance-cm";
    let (code, said, _) = run(at, &format!("{typed} 60"));
    assert_eq!(code, Some(0));
    assert!(
        said.contains("82.8 cm") && said.contains("d = p / tan a"),
        "{said}"
    );
    let (code, _, said) = run(at, start);
    assert_eq!(code, Some(2), "{said}");
    for words in ["0.02621 degrees", "0.019 degrees within 2 %", "82.8 cm"] {
        assert!(said.contains(words), "{said}");
    }
    let (code, said, _) = run(at, "check strict.toml");
    assert_eq!(code, Some(2));
    assert!(
        said.contains("not ready:") && said.contains("within 2 %"),
        "{said}"
    );

    // At the right place the display alone is missing: there is none in this test.
    assert_eq!(run(at, &format!("{typed} 82.8")).0, Some(0));
    let (code, _, said) = run(at, start);
    assert_eq!(code, Some(1), "{said}");
    assert!(
        said.contains("DISPLAY") && !said.contains("degrees"),
        "{said}"
    );
    assert!(
        !at.join("data").exists() || data_is_empty(at),
        "no rating was made"
    );
}

/// Whether no row of a rating stands below `data`.
fn data_is_empty(folder: &Path) -> bool {
    let tables = folder.join("data/meyer-liu-1992/data");
    let entries = fs::read_dir(tables).into_iter().flatten();
    entries.flatten().all(|entry| {
        let text = fs::read_to_string(entry.path()).unwrap();
        entry
            .path()
            .extension()
            .is_none_or(|ending| ending != "csv")
            || text.lines().count() <= 1
    })
}

#[test]
fn check_says_all_that_is_known_of_the_station_in_one_list() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    strict_study(at);
    assert_eq!(run(at, "-q render strict.toml").0, Some(0));
    let typed = "station strict.toml --width-mm 527.04 --width-px 1920 --monitor DP-1 --peak-luminance 120 --surround dim --background-luminance 18 --room-lux 15 --primaries .68,.32,.265,.69,.15,.06,.3127,.329 --gamma 2.2";
    assert_eq!(run(at, typed).0, Some(0));
    let (code, said, _) = run(at, "check strict.toml");
    assert_eq!(code, Some(2), "there is no display in this test");
    for line in [
        "station: a pixel is 0.2745 mm wide",
        // atan(.02745 / 82.8) = .0189948 degrees (bc -l).
        "from 82.8 cm it subtends 0.01899 degrees",
        "colour: ",
        "peak luminance: 120 cd/m2 (ITU-R BT.500 advises 70 to 250 in a laboratory)",
        "lights and surround: dim (BT.500",
        "room: 15 lx (ITU-T P.910 advises at most 20); behind the screen: 18 cd/m2",
        "gamut: ",
        "refresh: not measured here",
        "not ready: display: found no DISPLAY",
    ] {
        assert!(said.contains(line), "{line:?} is missing in:\n{said}");
    }
    assert_eq!(said.matches("not ready").count(), 1, "{said}");
}
