//! The laboratory example as a research assistant meets it: check, station, a whole session by mouse and keys from
//! consent to thanks, the export and the report; and what is in the files.

use std::cell::Cell;
use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::Duration;

use experiment::Trial;
use protocols::Study;
use protocols::rating::{Phase, RatingRow, ShownFirst, read_ratings};

use crate::display::{Display, Manager, Screenshot, is_on_path, png_pixels};
use crate::{CONTINUE, GREY, is_button, output_of};

/// Where things are on a screen of 1280 x 1024 pixels.
const AGREE: [usize; 2] = [459, 901];
const HAND_IN: [usize; 2] = [640, 901];
const AGE: [usize; 2] = [347, 217];
const GLASSES: [usize; 2] = [410, 341];
const EMAIL: [usize; 2] = [575, 490];
const DIGIT_5: [usize; 2] = [684, 824];
const RIGHT: [usize; 2] = [924, 471];
const ENTER_MARKS: [usize; 2] = [640, 911];
const PHOTODIODE: [usize; 2] = [20, 1000];
/// The bars' middle columns, and the lower end and height of both.
const BARS_X: [usize; 2] = [498, 782];
const BARS_PX: [usize; 2] = [829, 573];
/// The left upper corner of the test picture, and of the left one on the page of instructions.
const PICTURE: [usize; 2] = [576, 464];
const FIRST_OF_PAGE: [usize; 2] = [424, 515];
const PICTURE_PX: [usize; 2] = [128, 96];

const TRIALS: usize = 14;

fn is_consent(shot: &Screenshot) -> bool {
    is_button(shot, AGREE, 100) && shot.pixel(HAND_IN) == GREY
}

fn is_form(shot: &Screenshot) -> bool {
    is_button(shot, HAND_IN, 120) && !is_button(shot, DIGIT_5, 25)
}

fn is_plate(shot: &Screenshot) -> bool {
    is_button(shot, DIGIT_5, 25)
}

fn is_letter(shot: &Screenshot) -> bool {
    is_button(shot, RIGHT, 35)
}

fn is_scale(shot: &Screenshot) -> bool {
    BARS_X.iter().all(|&x| shot.pixel([x, 300]) != GREY)
}

fn is_page(shot: &Screenshot) -> bool {
    is_button(shot, CONTINUE, 120) && !is_scale(shot)
}

/// A copy of the example with short exposures, and a display.
struct Laboratory {
    folder: tempfile::TempDir,
    display: Display,
}

impl Laboratory {
    fn new(display: Display) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/examples/laboratory");
        fs::create_dir(folder.path().join("pictures")).unwrap();
        for entry in fs::read_dir(example.join("pictures")).unwrap() {
            let entry = entry.unwrap();
            let copy = folder.path().join("pictures").join(entry.file_name());
            fs::copy(entry.path(), copy).unwrap();
        }
        let protocol = fs::read_to_string(example.join("protocol.toml")).unwrap();
        let protocol = ["exposure_s = 3.0", "pause_s = 0.5", "seconds = 20"]
            .into_iter()
            .zip(["exposure_s = 0.4", "pause_s = 0.1", "seconds = 1"])
            .fold(protocol, |text, (long, short)| {
                assert!(text.contains(long), "{long}");
                text.replace(long, short)
            });
        fs::write(folder.path().join("protocol.toml"), protocol).unwrap();
        Self { folder, display }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn command(&self, words: &str) -> Command {
        let mut command = self.display.command(env!("CARGO_BIN_EXE_acuity"));
        command
            .current_dir(self.folder.path())
            .args(words.split(' '))
            .env("XDG_CONFIG_HOME", self.folder.path());
        command
    }

    fn output(&self, words: &str) -> Output {
        self.command(words).output().unwrap()
    }

    fn succeeds(&self, words: &str) -> String {
        let output = self.output(words);
        let text = [&output.stdout[..], &output.stderr].concat();
        let text = String::from_utf8(text).unwrap();
        assert!(output.status.success(), "{words}: {text}");
        text
    }

    fn ratings(&self, subject: &str) -> PathBuf {
        let name = format!("study-laboratory_subject-{subject}_session-1_task-rating_data.csv");
        self.path("data/laboratory/data").join(name)
    }

    fn rows(&self, subject: &str) -> Vec<RatingRow> {
        let factors = ["scene", "blurred", "blur_px"].map(str::to_owned);
        read_ratings(&self.ratings(subject), &factors).unwrap().rows
    }

    fn table(&self, name: &str) -> String {
        fs::read_to_string(self.path("data/laboratory").join(name)).unwrap()
    }

    fn sit(&self) -> Child {
        self.command("run protocol.toml --subject 01")
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap()
    }

    /// Consent, the form, and a digit and a side for every plate and letter.
    fn answer_before_the_trials(&self) {
        let display = &self.display;
        display.wait_for("the consent", is_consent);
        display.click(AGREE);
        display.wait_for("the form", is_form);
        display.click(HAND_IN);
        sleep(Duration::from_millis(300));
        assert!(is_form(&display.screenshot()), "an empty form was taken");
        for (place, words) in [(AGE, "33"), (GLASSES, ""), (EMAIL, "me@x.org")] {
            display.click(place);
            sleep(Duration::from_millis(200));
            display.write(words);
        }
        sleep(Duration::from_millis(200));
        display.click(HAND_IN);
        let mut shot = display.wait_for("a plate", is_plate);
        while is_plate(&shot) {
            display.key("5");
            sleep(Duration::from_millis(150));
            shot = display.wait_for("a plate or a letter", |shot| {
                is_plate(shot) || is_letter(shot)
            });
        }
        while is_letter(&shot) {
            display.key("Right");
            sleep(Duration::from_millis(150));
            shot = display.wait_for("a letter or a page", |shot| {
                is_letter(shot) || is_page(shot)
            });
        }
    }

    /// Clicks until it shows: a click before a page has stood for a frame does not count.
    fn click_until(&self, place: [usize; 2], is_it: impl Fn(&Screenshot) -> bool) {
        for _ in 0..10 {
            sleep(Duration::from_millis(200));
            self.display.click(place);
            for _ in 0..20 {
                if is_it(&self.display.screenshot()) {
                    return;
                }
                sleep(Duration::from_millis(50));
            }
        }
        panic!("the click at {place:?} changed nothing");
    }

    /// The instructions, and the page whose pictures are the files' bytes.
    fn read_the_instructions(&self) {
        let original = png_pixels(&self.path("pictures/village-original.png"));
        self.click_until(CONTINUE, |shot| {
            shot.part(FIRST_OF_PAGE, PICTURE_PX) == original
        });
        self.click_until(CONTINUE, |shot| !is_page(shot));
    }

    /// The two pictures of a trial: the test picture, and its reference.
    fn pictures(&self, trial: &Trial) -> [Vec<u8>; 2] {
        let id = trial.stimulus_id.as_str();
        let (scene, _) = id.split_once('-').unwrap();
        [id.to_owned(), format!("{scene}-original")]
            .map(|name| png_pixels(&self.path(&format!("pictures/{name}.png"))))
    }

    /// Marks both bars, by mouse in odd trials and by keys in even ones; trial *n* gets the marks of [`marks`].
    ///
    /// Meanwhile the corner for the photodiode is looked at: white while the test picture stands, black with the reference.
    fn rate_all(&self) {
        let display = &self.display;
        let study = Study::read(&self.path("protocol.toml")).unwrap();
        let trials = experiment::trials(&study, &"01".parse().unwrap(), 1).unwrap();
        let seen = [Cell::new(0), Cell::new(0)];
        loop {
            let rated = self.rows("01").len();
            if rated == TRIALS {
                break;
            }
            let [test, reference] = self.pictures(&trials[rated]);
            let shot = display.wait_for("a page or the scale", |shot| {
                let picture = shot.part(PICTURE, PICTURE_PX);
                if shot.pixel(PHOTODIODE) == [255; 3] {
                    assert!(picture == test, "another picture in trial {}", rated + 1);
                    seen[0].set(seen[0].get() + 1);
                } else if picture == reference {
                    seen[1].set(seen[1].get() + 1);
                }
                assert!(picture != test || shot.pixel(PHOTODIODE) == [255; 3]);
                is_page(shot) || is_scale(shot)
            });
            if is_page(&shot) {
                self.click_until(CONTINUE, |shot| !is_page(shot));
                continue;
            }
            let marks = marks(rated + 1);
            for (x, mark) in BARS_X.into_iter().zip(marks) {
                if rated.is_multiple_of(2) {
                    display.click([x, BARS_PX[0] - (BARS_PX[1] * mark + 50) / 100]);
                } else {
                    display.write(&mark.to_string());
                    display.key("Return");
                }
            }
            if rated.is_multiple_of(2) {
                display.click(ENTER_MARKS);
            } else {
                display.key("Return");
            }
            let mut waits = 0..200;
            while self.rows("01").len() == rated && waits.next().is_some() {
                sleep(Duration::from_millis(10));
            }
        }
        assert!(seen.iter().all(|count| count.get() > 0), "{seen:?}");
    }
}

/// How the two bars are marked in trial *n*.
fn marks(trial: usize) -> [usize; 2] {
    [20 + 3 * trial, 95 - 2 * trial]
}

/// Every file below a folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path));
        }
        found.push(path);
    }
    found
}

#[test]
fn the_laboratory_example_goes_from_consent_to_the_report() {
    let Some(display) = Display::open(Manager::Openbox) else {
        return;
    };
    let laboratory = Laboratory::new(display);
    laboratory.succeeds("-q render protocol.toml");
    let output = laboratory.output("check protocol.toml");
    let text = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(text.contains("station"), "{text}");
    laboratory.succeeds("station protocol.toml --width-mm 351 --width-px 1280");
    laboratory.succeeds("check protocol.toml");

    let session = laboratory.sit();
    laboratory.answer_before_the_trials();
    laboratory.read_the_instructions();
    laboratory.rate_all();
    sleep(Duration::from_millis(300));
    laboratory.display.key("Return");
    let (code, text) = output_of(session);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("all 14 trials rated"), "{text}");

    check_ratings(&laboratory);
    check_intake(&laboratory);
    check_sidecar_and_events(&laboratory);
    check_export(&laboratory);
    check_files(&laboratory);
    check_report(&laboratory);
}

/// What was marked is in the table, in an order that the protocol allows.
fn check_ratings(laboratory: &Laboratory) {
    let rows = laboratory.rows("01");
    assert_eq!(rows.len(), TRIALS);
    let table = fs::read_to_string(laboratory.ratings("01")).unwrap();
    for ((number, row), line) in (1..).zip(&rows).zip(table.lines().skip(1)) {
        let [a, b] = marks(number).map(|mark| i32::try_from(mark).unwrap());
        let expected = match row.shown_first {
            Some(ShownFirst::Test) => [a, b],
            Some(ShownFirst::Reference) => [b, a],
            None => panic!("{line}"),
        };
        assert_eq!(
            [Some(row.rating), row.reference_rating],
            expected.map(Some),
            "{line}"
        );
        // 0.4 s, within a frame of a display that is not locked to anything.
        assert!((row.exposure_submitted_s - 0.4).abs() < 0.1, "{line}");
    }
    let test: Vec<&RatingRow> = rows.iter().filter(|row| row.phase == Phase::Test).collect();
    let one_scene =
        |three: &[&RatingRow]| three.iter().all(|row| row.levels[0] == three[0].levels[0]);
    let one_blur = |four: &[&RatingRow]| four.iter().all(|row| row.levels[1] == four[0].levels[1]);
    assert_eq!(test.len(), 12);
    assert!(!test.windows(3).any(one_scene) && !test.windows(4).any(one_blur));
}

fn check_intake(laboratory: &Laboratory) {
    let stem = "study-laboratory_subject-01_session-1_task-";
    let form = laboratory.table(&format!("data/{stem}form_data.csv"));
    assert_eq!(
        form,
        "subject_id,session_id,pilot,age,glasses\n01,1,false,33,glasses\n"
    );
    let apart = laboratory.table(&format!("private/{stem}form_data.json"));
    let apart: serde_json::Value = serde_json::from_str(&apart).unwrap();
    assert_eq!(apart, serde_json::json!({ "email": "me@x.org" }));
    let screening = laboratory.table(&format!("data/{stem}screening_data.csv"));
    let rows: Vec<Vec<&str>> = screening
        .lines()
        .map(|line| line.split(',').collect())
        .collect();
    let column = |name: &str| rows[0].iter().position(|column| *column == name).unwrap();
    let (kind, shown, seen, correct) = (
        column("item_kind"),
        column("shown"),
        column("seen"),
        column("correct"),
    );
    let count = |word: &str| rows.iter().filter(|row| row[kind] == word).count();
    // A control plate and two grades on three axes; two sizes of the letter.
    assert_eq!((count("plate"), count("letter"), rows.len()), (7, 2, 10));
    for row in &rows[1..] {
        assert!(["5", "right"].contains(&row[seen]), "{row:?}");
        assert_eq!(row[correct], (row[seen] == row[shown]).to_string());
    }
}

fn check_sidecar_and_events(laboratory: &Laboratory) {
    let sidecar = fs::read(laboratory.ratings("01").with_extension("json")).unwrap();
    let sidecar: serde_json::Value = serde_json::from_slice(&sidecar).unwrap();
    let study = Study::read(&laboratory.path("protocol.toml")).unwrap();
    let consent = study.protocol.session.consent.unwrap().sha256();
    assert_eq!(sidecar["intake"]["consent_sha256"], consent.as_str());
    assert_eq!(sidecar["intake"]["screening"]["has_measured_angle"], true);
    let sitting = &sidecar["sittings"][0];
    assert_eq!(sitting["ending"], "complete");
    assert_eq!(sitting["station"]["measured"]["distance_cm"], 82.7);
    assert_eq!(sitting["station"]["refresh"]["frames"], 300);
    let stem = "timing/study-laboratory_subject-01_session-1_task-rating_";
    let events = laboratory.table(&format!("{stem}events.csv"));
    for (event, count) in [
        ("rating_on_disk", TRIALS),
        ("break", 1),
        ("pixels_compared", 1),
        ("ended", 1),
    ] {
        assert_eq!(
            events.matches(&format!(",{event},")).count(),
            count,
            "{event}"
        );
    }
    let frames = laboratory.table(&format!("{stem}frames.csv"));
    // Twice in each trial.
    assert_eq!(frames.matches(",test,").count(), 2 * TRIALS);
}

/// The export has the session, nothing that identifies, and satisfies the standard's own validator.
fn check_export(laboratory: &Laboratory) {
    let said = laboratory.succeeds("export protocol.toml --bids bids");
    assert!(said.starts_with("1 session in"), "{said}");
    let stem = "bids/sub-01/ses-1/beh/sub-01_ses-1_task-rating_events";
    let events = fs::read_to_string(laboratory.path(&format!("{stem}.tsv"))).unwrap();
    assert_eq!(events.lines().count(), 1 + TRIALS);
    assert!(
        events
            .lines()
            .next()
            .unwrap()
            .contains("\treference_rating\tshown_first\t")
    );
    let about = fs::read(laboratory.path(&format!("{stem}.json"))).unwrap();
    let about: serde_json::Value = serde_json::from_slice(&about).unwrap();
    let presentation = &about["StimulusPresentation"];
    assert_eq!(presentation["ScreenDistance"], 0.827);
    // 351 mm wide; 1024 pixels of 0.27422 mm high.
    assert_eq!(
        presentation["ScreenSize"],
        serde_json::json!([0.351, 0.2808])
    );
    if is_on_path("bids-validator-deno") {
        let mut validator = Command::new("bids-validator-deno");
        let output = validator.arg(laboratory.path("bids")).output().unwrap();
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stdout)
        );
    }
}

/// Only the owner may read any file, and one file alone says who the subject is.
fn check_files(laboratory: &Laboratory) {
    for folder in ["data", "bids"] {
        for path in files(&laboratory.path(folder)) {
            let mode = fs::metadata(&path).unwrap().permissions().mode() & 0o777;
            assert_eq!(
                mode,
                if path.is_dir() { 0o700 } else { 0o600 },
                "{}",
                path.display()
            );
            let is_apart = path.parent().unwrap().ends_with("private");
            if path.is_file() && !is_apart {
                let bytes = fs::read(&path).unwrap();
                let text = String::from_utf8_lossy(&bytes);
                assert!(!text.contains("me@x.org"), "{}", path.display());
            }
        }
    }
}

/// A report needs more than one subject: the session again under two other codes, with ratings moved a little.
fn check_report(laboratory: &Laboratory) {
    let original = laboratory.ratings("01");
    for (subject, step) in [("02", 3), ("03", 7)] {
        let mut rows = laboratory.rows("01");
        for (place, row) in (0..).zip(&mut rows) {
            row.subject_id = subject.parse().unwrap();
            row.rating = (row.rating + place * step % 11).min(100);
        }
        let table = fs::read_to_string(&original).unwrap();
        let header = table.lines().next().unwrap().to_owned() + "\n";
        let lines: String = rows.iter().map(RatingRow::to_line).collect();
        fs::write(laboratory.ratings(subject), header + &lines).unwrap();
        let sidecar = fs::read_to_string(original.with_extension("json")).unwrap();
        let sidecar = sidecar.replace(
            "\"subject_id\": \"01\"",
            &format!("\"subject_id\": \"{subject}\""),
        );
        fs::write(laboratory.ratings(subject).with_extension("json"), sidecar).unwrap();
    }
    let said = laboratory.succeeds("report protocol.toml");
    let report = laboratory.path(said.lines().last().unwrap());
    let anova = fs::read(report.with_file_name("anova.json")).unwrap();
    let anova: serde_json::Value = serde_json::from_slice(&anova).unwrap();
    let effects = anova["effects"].as_array().unwrap();
    let df = |name: &str| {
        let effect = effects
            .iter()
            .find(|effect| effect["effect"] == name)
            .unwrap();
        [&effect["df_num"], &effect["df_den"]].map(|df| df.as_u64().unwrap())
    };
    // Two channels and three blurs, three subjects.
    assert_eq!(df("blurred"), [1, 2]);
    assert_eq!(df("blur_px"), [2, 4]);
    assert!(
        fs::read_to_string(&report)
            .unwrap()
            .contains("Blur of luma and of chroma")
    );
}
