//! The app driven by the names of its widgets, as a screen reader would, and by the keyboard alone.

use std::collections::VecDeque;
use std::ffi::OsString;
use std::io;
use std::sync::{Condvar, Mutex};
use std::thread::sleep;
use std::time::Duration;

use eframe::egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

mod faults;
mod keyboard;
mod view;

use super::*;
use crate::app::fixture::Fixture;
use crate::app::launcher::Ended;

/// Starts nothing; notes what was wanted, and answers as it was told to.
#[derive(Default)]
struct FakeLauncher {
    wanted: Mutex<Vec<Vec<String>>>,
    opened: Mutex<Vec<PathBuf>>,
    answers: Mutex<VecDeque<Ended>>,
    is_held: Mutex<bool>,
    released: Condvar,
}

impl FakeLauncher {
    fn answer(&self, code: Option<i32>, said: &str) {
        let said = said.to_owned();
        self.answers.lock().unwrap().push_back(Ended { code, said });
    }

    fn hold(&self, is_held: Option<()>) {
        *self.is_held.lock().unwrap() = is_held.is_some();
        self.released.notify_all();
    }

    fn wanted(&self) -> Vec<Vec<String>> {
        self.wanted.lock().unwrap().clone()
    }
}

impl Launcher for FakeLauncher {
    fn run(&self, _folder: &Path, arguments: &[OsString]) -> io::Result<Ended> {
        let words = arguments
            .iter()
            .map(|word| word.to_string_lossy().into_owned());
        self.wanted.lock().unwrap().push(words.collect());
        let held = self.is_held.lock().unwrap();
        drop(self.released.wait_while(held, |is_held| *is_held).unwrap());
        let answer = self.answers.lock().unwrap().pop_front();
        answer.ok_or_else(|| io::Error::other("no program"))
    }

    fn open(&self, file: &Path) -> io::Result<()> {
        self.opened.lock().unwrap().push(file.to_owned());
        Err(io::Error::other("no browser"))
    }
}

/// The app on a study, and the hands and eyes of its user.
struct User<'a> {
    harness: Harness<'a, StudyApp>,
    launcher: Arc<FakeLauncher>,
    settings: PathBuf,
}

impl User<'_> {
    fn at(fixture: &Fixture) -> Self {
        let launcher = Arc::new(FakeLauncher::default());
        let settings = fixture.place.root.join("config/app.toml");
        let app = StudyApp::new(
            fixture.place.clone(),
            Arc::clone(&launcher) as Arc<dyn Launcher>,
            Some(settings.clone()),
        );
        let harness = Harness::builder()
            .with_size([1280.0, 800.0])
            .with_context_setup(look::dress)
            .build_ui_state(|ui, app: &mut StudyApp| app.show(ui), app);
        Self {
            harness,
            launcher,
            settings,
        }
    }

    fn with(fixture: &Fixture) -> Self {
        let mut user = Self::at(fixture);
        user.harness.state_mut().open(&fixture.protocol);
        user.wait("Stimuli:");
        user
    }

    fn sees(&self, words: &str) -> bool {
        self.harness
            .query_all_by_label_contains(words)
            .next()
            .is_some()
    }

    /// Frames until a widget's name contains `words`.
    fn wait(&mut self, words: &str) {
        for _ in 0..2000 {
            self.harness.step();
            if self.sees(words) {
                return;
            }
            sleep(Duration::from_millis(5));
        }
        panic!("{words:?} does not appear");
    }

    fn click(&mut self, name: &str) {
        self.harness.get_by_label(name).click();
        self.harness.run_steps(3);
    }

    /// Goes to the page of a step.
    fn go(&mut self, step: &str) {
        let label = format!("{step}:");
        self.harness.get_by_label_contains(&label).click();
        self.harness.run_steps(3);
    }

    /// Tab until a widget whose name begins so has the keyboard.
    fn tab_to(&mut self, name: &str) {
        for _ in 0..40 {
            self.harness.key_press(Key::Tab);
            self.harness.run_steps(2);
            if self.focused().starts_with(name) {
                return;
            }
        }
        panic!("no Tab leads to {name:?}");
    }

    fn focused(&self) -> String {
        let is_focused = |node: &egui_kittest::Node<'_>| node.is_focused();
        let mut nodes = self.harness.root().children_recursive();
        let node = nodes.find(is_focused);
        node.and_then(|node| node.accesskit_node().label())
            .unwrap_or_default()
    }

    fn type_into(&mut self, name: &str, text: &str) {
        let field = self.harness.get_by_role_and_label(Role::TextInput, name);
        field.focus();
        field.type_text(text);
        self.harness.run_steps(3);
    }

    /// The right edge of everything on the page.
    fn rightmost(&self) -> f64 {
        let nodes = self.harness.root().children_recursive();
        let boxes = nodes.filter_map(|node| node.accesskit_node().bounding_box());
        boxes.map(|found| found.x1).fold(0.0, f64::max)
    }

    fn is_enabled(&self, name: &str) -> bool {
        !self
            .harness
            .get_by_label(name)
            .accesskit_node()
            .is_disabled()
    }
}

fn ready() -> Fixture {
    let fixture = Fixture::new();
    fixture.make_stimuli();
    fixture
}

#[test]
fn the_next_subject_starts_with_two_clicks() {
    let fixture = ready();
    let mut user = User::with(&fixture);
    user.launcher
        .answer(Some(0), "subject 01: all 30 trials rated, in data");
    user.go("Sessions");
    user.click("Next subject");
    user.click("Start session 01");
    user.wait("all 30 trials rated");
    let protocol = fixture.protocol.to_string_lossy().into_owned();
    let words = ["run", &protocol, "--subject", "01", "--session", "1"];
    assert_eq!(user.launcher.wanted(), [words]);
}

#[test]
fn the_next_subject_starts_by_the_keyboard_alone() {
    let fixture = ready();
    let mut user = User::with(&fixture);
    user.launcher.answer(Some(0), "the end of it");
    user.tab_to("Sessions");
    user.harness.key_press(Key::Enter);
    user.harness.run_steps(2);
    user.tab_to("Next subject");
    user.harness.key_press(Key::Space);
    user.harness.run_steps(3);
    assert_eq!(user.focused(), "Start session 01");
    user.harness.key_press(Key::Enter);
    user.wait("the end of it");
    assert_eq!(user.launcher.wanted().len(), 1);
}

#[test]
fn no_session_begins_without_its_images() {
    let fixture = Fixture::new();
    let mut user = User::with(&fixture);
    user.go("Sessions");
    assert!(!user.is_enabled("Next subject") && !user.is_enabled("Trial run"));
    assert!(user.sees("Make the stimuli first"));
}

#[test]
fn a_code_that_is_no_code_is_refused_in_words() {
    let fixture = ready();
    let mut user = User::with(&fixture);
    user.go("Sessions");
    user.click("Next subject");
    user.type_into("Code", " Ann");
    assert!(user.sees("and no name"));
    assert!(!user.is_enabled("Start session 01 Ann"));
}

#[test]
fn a_trial_run_is_started_as_one() {
    let fixture = ready();
    let mut user = User::with(&fixture);
    user.launcher.answer(Some(0), "the end of it");
    user.go("Sessions");
    user.click("Trial run");
    assert!(user.sees("PILOT"));
    user.click("Start the trial run");
    user.wait("the end of it");
    let wanted = user.launcher.wanted();
    assert_eq!(
        wanted[0][2..],
        ["--subject", "try", "--session", "1", "--pilot", "20"]
    );
}

#[test]
fn the_error_of_a_session_is_shown_with_what_to_do() {
    let fixture = ready();
    let mut user = User::with(&fixture);
    let error = "error: found a screen of 800 x 600 pixels, expected at least 1024 x 320; use a larger monitor\n";
    user.launcher.answer(Some(1), error);
    user.launcher.answer(None, "");
    user.go("Sessions");
    user.click("Next subject");
    user.click("Start session 01");
    user.wait("What to do");
    assert!(user.sees("Use a larger monitor") && user.sees("800 x 600"));
    // A session that was killed, and a program that does not start.
    for words in ["ended from outside", "no program"] {
        user.click("Next subject");
        user.click("Start session 01");
        user.wait(words);
    }
}

#[test]
fn while_a_session_runs_nothing_else_may_begin() {
    let fixture = ready();
    let mut user = User::with(&fixture);
    user.launcher.hold(Some(()));
    user.launcher.answer(Some(0), "all trials rated");
    user.go("Sessions");
    user.click("Next subject");
    user.click("Start session 01");
    user.wait("Session of subject 01 is running");
    assert!(!user.is_enabled("Other study"));
    user.go("Stimuli");
    assert!(!user.is_enabled("Make them again"));
    assert!(user.sees("cost it frames"));
    user.launcher.hold(None);
    user.go("Sessions");
    user.wait("all trials rated");
    assert!(user.is_enabled("Next subject"));
}

#[test]
fn stimuli_are_made_on_the_page_and_shown() {
    let fixture = Fixture::new();
    let mut user = User::with(&fixture);
    user.click("Make the stimuli");
    user.wait("28 images ready");
    user.wait("A 10K, C 140K");
}

#[test]
fn an_unfinished_session_is_resumed_or_closed_with_a_reason() {
    let fixture = ready();
    let sessions = fixture.simulate_people(2);
    Fixture::cut_to(&sessions[1], 12);
    let subject = sessions[1].subject.to_string();
    let mut user = User::with(&fixture);
    user.launcher.answer(Some(0), "stopped after 14 of 30");
    user.launcher.answer(Some(0), "closed with 12 of 30");
    user.go("Sessions");
    assert!(user.sees("12 of 30"));
    user.click(&format!("Resume subject {subject}"));
    user.wait("stopped after 14 of 30");
    user.click(&format!("Close subject {subject}"));
    assert!(!user.is_enabled("Close the session"));
    user.type_into("Reason", "felt unwell");
    user.click("Close the session");
    user.wait("closed with 12 of 30");
    let wanted = user.launcher.wanted();
    assert_eq!(
        (wanted[0][0].as_str(), wanted[0][3].as_str()),
        ("run", subject.as_str())
    );
    assert_eq!(wanted[1][0], "close");
    assert_eq!(wanted[1][6..], ["--reason", "felt unwell"]);
}

#[test]
fn a_report_is_made_and_its_path_is_shown_where_no_browser_is() {
    let fixture = ready();
    fixture.simulate_people(3);
    let mut user = User::with(&fixture);
    user.go("Report");
    assert!(user.sees("Not made yet"));
    user.click("Make the report");
    user.wait("Open the report");
    user.click("Open the report");
    user.wait("No browser would open the report");
    let page = fixture.state().folders.report.join("report.html");
    assert!(page.is_file() && user.sees(&page.to_string_lossy()));
    assert_eq!(*user.launcher.opened.lock().unwrap(), [page]);
}

#[test]
fn data_that_cannot_be_analysed_are_explained() {
    let fixture = ready();
    let sessions = fixture.simulate_people(3);
    let path = &sessions[0].ratings_path;
    let text = std::fs::read_to_string(path).unwrap();
    std::fs::write(path, text.replacen(",person,", ",robot,", 1)).unwrap();
    let mut user = User::with(&fixture);
    for step in ["Sessions", "Report"] {
        user.go(step);
        assert!(
            user.sees("robot") && user.sees("Expected") && user.sees("What to do"),
            "{step}"
        );
    }
}

#[test]
fn a_protocol_that_is_mended_is_read_again() {
    let fixture = Fixture::new();
    fixture.replace_in_protocol("exposure_s", "exposure_sec");
    let mut user = User::at(&fixture);
    user.harness.state_mut().open(&fixture.protocol);
    user.wait("The protocol cannot be used");
    assert!(user.sees("exposure_sec") && user.sees("Expected"));
    fixture.replace_in_protocol("exposure_sec", "exposure_s");
    user.harness.key_press(Key::F5);
    user.wait("Stimuli:");
}

#[test]
fn the_working_folder_s_protocols_are_offered_and_the_choice_is_remembered() {
    let fixture = Fixture::new();
    let mut user = User::at(&fixture);
    user.wait("small.toml");
    user.click("small.toml");
    user.wait("Stimuli:");
    assert_eq!(
        Settings::read(&user.settings).recent,
        std::slice::from_ref(&fixture.protocol)
    );
    user.click("Theme: Dark");
    assert_eq!(Settings::read(&user.settings).theme, ThemeChoice::Dark);
    user.click("Other study");
    user.wait("Which study?");
    user.type_into("File", "protocols/none.toml");
    user.click("Open");
    user.wait("The protocol cannot be used");
}

#[test]
fn a_station_is_typed_and_written() {
    let fixture = Fixture::new();
    let mut user = User::with(&fixture);
    user.go("Station");
    user.click("Type the width");
    assert!(!user.is_enabled("Save the station"));
    user.type_into("Width in mm", "527.04");
    user.type_into("Width in pixels", "1920");
    // 0.02745 / tan(0.019 degrees) = 82.78 cm, as in experiment/src/station.rs.
    assert!(user.sees("82.8 cm"));
    user.click("Save the station");
    user.wait("Station: Measured");
    let path = fixture.place.station.clone().unwrap();
    let station = experiment::StationFile::read(&path).unwrap();
    assert_eq!((station.width_px, station.distance_cm), (1920, 82.8));
    user.click("Type the width");
    user.type_into("Width in pixels", "000000");
    user.click("Save the station");
    user.wait("width_px");
}

#[test]
fn the_station_s_window_opens_in_the_app_s_theme() {
    let fixture = Fixture::new();
    let mut user = User::with(&fixture);
    for (theme, word) in [("Theme: Dark", "dark"), ("Theme: Light", "light")] {
        user.launcher.answer(Some(0), "closed without saving");
        user.click(theme);
        user.go("Station");
        user.click("Measure in a window");
        for _ in 0..400 {
            user.harness.run_steps(1);
            if user.is_enabled("Measure in a window") {
                break;
            }
            sleep(Duration::from_millis(5));
        }
        let wanted = user.launcher.wanted().pop().unwrap();
        assert_eq!(wanted[2..], ["--window", "--theme", word]);
    }
}

#[test]
fn every_page_is_whole_at_three_sizes_in_both_themes() {
    let fixture = ready();
    let sessions = fixture.simulate_people(3);
    fixture.make_report();
    Fixture::cut_to(&sessions[1], 12);
    for size in [[1280.0, 800.0], [1920.0, 1080.0], [800.0, 500.0]] {
        let mut user = User::with(&fixture);
        user.harness.set_size(size.into());
        for theme in ["Theme: Light", "Theme: Dark"] {
            user.click(theme);
            for step in Step::ALL {
                user.go(step.name());
                // The harness itself refuses widgets without a name and letters without a glyph.
                user.harness.run_steps(2);
                assert!(
                    user.rightmost() <= f64::from(size[0]),
                    "{step:?} at {size:?}"
                );
            }
        }
    }
}

/// The theme switch ends where the steps end.
#[test]
fn head_and_steps_end_on_one_line() {
    let fixture = Fixture::new();
    for width in [800.0, 1280.0, 1920.0] {
        let mut user = User::with(&fixture);
        user.harness.set_size([width, 800.0].into());
        user.harness.run_steps(3);
        let right = |name: &str| user.harness.get_by_label_contains(name).rect().right();
        let (head, steps) = (right("Theme: Dark"), right("Report:"));
        assert!((head - steps).abs() < 0.1, "{width}: {head} and {steps}");
    }
}
