//! What is wrong, on the page, with what to do.

use std::fs;

use eframe::egui::DroppedFile;

use super::*;

/// A file that is let go over the window.
#[derive(Debug)]
struct Dropped(PathBuf);

impl DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        fs::read(&self.0).map_err(|error| error.to_string())
    }
}

impl User<'_> {
    fn drop_file(&mut self, path: &Path) {
        let file = Arc::new(Dropped(path.to_owned()));
        self.harness.input_mut().dropped_files.push(file);
        self.harness.run_steps(3);
    }

    fn sees_all(&self, words: &[&str]) {
        for words in words {
            assert!(self.sees(words), "{words:?} is not on the page");
        }
    }
}

#[test]
fn a_dropped_file_that_is_no_protocol_is_explained_and_a_right_one_opens() {
    let fixture = ready();
    let mut user = User::at(&fixture);
    let image = fixture.state().folders.stimuli.join("a010k_c140k.png");
    let scene = fixture.state().study.scene_path().unwrap();
    let missing = fixture.place.root.join("gone.toml");
    for (wrong, words) in [
        (image, "a010k_c140k.png"),
        (scene, "unknown field"),
        (missing, "no such file"),
    ] {
        user.drop_file(&wrong);
        user.wait("The protocol cannot be used");
        user.wait(words);
        user.sees_all(&["Where", "Found", "Expected"]);
        user.click("Other study");
        user.wait("Which study?");
    }
    user.drop_file(&fixture.protocol);
    user.wait("Stimuli: 28 images ready");
}

#[test]
fn stimuli_of_another_version_of_the_protocol_are_named_and_hold_sessions_back() {
    let fixture = ready();
    fixture.replace_in_protocol("seed = 1992", "seed = 1993");
    let mut user = User::with(&fixture);
    user.sees_all(&["Made from an older protocol", "What to do", "manifest.json"]);
    user.go("Sessions");
    user.sees_all(&["Make the stimuli first"]);
    assert!(!user.is_enabled("Next subject"));
    user.go("Stimuli");
    user.click("Make the stimuli");
    user.wait("Stimuli: 28 images ready");
    user.go("Sessions");
    assert!(user.is_enabled("Next subject"));
}

#[test]
fn a_data_folder_that_takes_no_file_is_named_before_a_session_begins() {
    let fixture = ready();
    // A file where the folder should be: it takes no file whoever asks, even the superuser.
    fs::write(fixture.place.root.join("data"), "").unwrap();
    let mut user = User::with(&fixture);
    user.go("Sessions");
    user.sees_all(&["takes no file", "What to do"]);
    assert!(!user.is_enabled("Next subject"));
    fs::remove_file(fixture.place.root.join("data")).unwrap();
    user.harness.key_press(Key::F5);
    for _ in 0..400 {
        user.harness.run_steps(1);
        sleep(Duration::from_millis(5));
        if user.is_enabled("Next subject") {
            break;
        }
    }
    assert!(user.is_enabled("Next subject") && !user.sees("takes no file"));
}

#[test]
fn an_order_that_cannot_be_is_named_before_a_session_begins() {
    let fixture = Fixture::new();
    // Blocks of one channel, with no two trials of a channel in a row.
    fixture.replace_in_protocol(
        "order_seed = 1992",
        "order_seed = 1992
order.most_in_a_row = [{ factor = \"channel\", most = 1 }]
order.blocked_by = { factor = \"channel\", levels = [\"achromatic\", \"chromatic\"] }",
    );
    fixture.make_stimuli();
    let mut user = User::with(&fixture);
    user.go("Sessions");
    user.sees_all(&["13 trials with channel", "session.order"]);
    assert!(!user.is_enabled("Next subject"));
}

#[test]
fn a_station_that_is_missing_or_does_not_fit_holds_sessions_back_where_the_protocol_has_a_tolerance()
 {
    let fixture = Fixture::new();
    fixture.replace_in_protocol("blocks = 1", "viewing_tolerance = 0.02\nblocks = 1");
    fixture.make_stimuli();
    let mut user = User::with(&fixture);
    user.go("Sessions");
    user.sees_all(&["Measure the station first", "Not measured, but needed"]);
    assert!(!user.is_enabled("Next subject"));
    user.go("Station");
    user.click("Type the width");
    user.type_into("Width in mm", "527.04");
    user.type_into("Width in pixels", "1920");
    user.type_into("Distance of the eye in cm", "60");
    user.click("Save the station");
    user.wait("Station: Does not fit the protocol");
    // 82.8 cm, as in experiment/src/station.rs.
    user.sees_all(&["within 2 %", "82.8 cm"]);
    user.go("Sessions");
    user.sees_all(&["Mend the station first"]);
    assert!(!user.is_enabled("Next subject"));
    user.go("Station");
    user.click("Type the width");
    user.type_into("Width in mm", "527.04");
    user.type_into("Width in pixels", "1920");
    user.click("Save the station");
    user.wait("Station: Measured");
    user.go("Sessions");
    assert!(user.is_enabled("Next subject"));
}
