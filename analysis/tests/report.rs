//! The report of a study, from ratings files to the page.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod simulated_study;

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use analysis::{
    AnalysisError, Design, Pilots, ReportSummary, anova_of_table, report, report_beside,
};
use protocols::{Observer, Study};
use simulated_study::{paper, session, write_people, write_session};
use tempfile::TempDir;

/// A data set and the report made from it.
struct Trial {
    study: Study,
    folder: TempDir,
}

impl Trial {
    fn new() -> Self {
        Self {
            study: paper(),
            folder: tempfile::tempdir().unwrap(),
        }
    }

    fn with_people(n: u64) -> Self {
        let trial = Self::new();
        write_people(&trial.study, &trial.data(), n);
        trial
    }

    fn data(&self) -> std::path::PathBuf {
        self.folder.path().join("data")
    }

    fn out(&self) -> std::path::PathBuf {
        self.folder.path().join("report")
    }

    fn report(&self) -> Result<ReportSummary, AnalysisError> {
        report(
            &self.study,
            &self.data(),
            Some(&self.out()),
            Pilots::LeftOut,
        )
    }

    fn page(&self) -> String {
        fs::read_to_string(self.out().join("report.html")).unwrap()
    }

    fn refusal(&self) -> String {
        let error = self.report().unwrap_err();
        assert!(error.is_input(), "{error}");
        assert!(
            !self.out().exists(),
            "nothing is written of a report that is refused"
        );
        error.to_string()
    }
}

#[test]
fn every_file_is_written_and_no_other() {
    let trial = Trial::with_people(12);
    let summary = trial.report().unwrap();
    assert_eq!(summary.n_subjects, 12);
    let mut names: Vec<String> = fs::read_dir(trial.out())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(
        names,
        [
            "anova.csv",
            "anova.json",
            "asymptotes.csv",
            "figure-10-outlined.svg",
            "figure-10-plain-outlined.svg",
            "figure-10-plain.pdf",
            "figure-10-plain.png",
            "figure-10-plain.svg",
            "figure-10.pdf",
            "figure-10.png",
            "figure-10.svg",
            "follow-ups.csv",
            "means.csv",
            "observers.png",
            "observers.svg",
            "report.html",
            "report.md",
            "report.pdf",
            "tables.tex",
            "to-paste.txt"
        ]
    );
    // Kept for the eye: target/tmp/report.
    let kept = Path::new(env!("CARGO_TARGET_TMPDIR")).join("report");
    fs::create_dir_all(&kept).unwrap();
    for name in names {
        fs::copy(trial.out().join(&name), kept.join(&name)).unwrap();
    }
}

#[test]
fn the_same_ratings_give_the_same_bytes() {
    let (first, second) = (Trial::with_people(5), Trial::with_people(5));
    let (first_files, second_files) = (
        first.report().unwrap().files,
        second.report().unwrap().files,
    );
    for (one, other) in first_files.iter().zip(&second_files) {
        assert!(
            fs::read(one).unwrap() == fs::read(other).unwrap(),
            "{}",
            one.display()
        );
    }
}

#[test]
fn its_analysis_of_variance_is_that_of_the_table_of_its_ratings() {
    let trial = Trial::with_people(7);
    let summary = trial.report().unwrap();
    let mut table = String::from("who,channel,rays,rating\n");
    for subject in 1..=7 {
        for row in session(&trial.study, &format!("{subject:02}"), subject) {
            if row.phase == protocols::rating::Phase::Test && row.levels[1] != "140K" {
                let (channel, rays) = (&row.levels[0], &row.levels[1]);
                writeln!(table, "{subject},{channel},{rays},{}", row.rating).unwrap();
            }
        }
    }
    let path = trial.folder.path().join("table.csv");
    fs::write(&path, table).unwrap();
    let design = Design {
        subject: "who".to_owned(),
        rating: "rating".to_owned(),
        within: vec!["channel".to_owned(), "rays".to_owned()],
        ..Design::default()
    };
    assert_eq!(
        anova_of_table(&path, &design).unwrap().effects,
        summary.anova.effects
    );
}

#[test]
fn the_page_is_whole_by_itself() {
    let trial = Trial::with_people(12);
    trial.report().unwrap();
    let page = trial.page();
    for outside in [
        "<script", "http://", "https://", "src=", "url(", "@import", "<link",
    ] {
        let page = page.replace("http://www.w3.org/2000/svg", "");
        assert!(!page.contains(outside), "{outside}");
    }
    assert!(page.contains("<svg") && page.ends_with("</html>\n"));
    assert!(!page.contains("NaN") && !page.contains(">inf"));
    // The curves that made these ratings: A worse than C1C2, both rising.
    assert!(page.contains("cost less image quality"), "{page}");
    // Printed: rays F(12, 120) = 51.44; R: pf(51.44, 12, 120, lower.tail = FALSE) is 1.70256e-41.
    assert!(page.contains("51.44 (12, 120)") && page.contains("1.7 × 10<sup>−41</sup>"));
    // What follows from the printed F values: 24.03 / (24.03 + 10) = .706 and so on.
    for eta in ["<td>.706</td>", "<td>.837</td>", "<td>.537</td>"] {
        assert!(page.contains(eta), "{eta}");
    }
    assert!(page.contains("11 subjects who each rated everything, or 12 subjects in two groups"));
    assert!(
        page.contains("rank 11"),
        "it says why Mauchly's test does not exist"
    );
    assert!(!page.contains("SIMULATED"));
}

#[test]
fn means_are_those_of_the_ratings() {
    let trial = Trial::with_people(3);
    trial.report().unwrap();
    let means = fs::read_to_string(trial.out().join("means.csv")).unwrap();
    assert_eq!(means.lines().count(), 1 + 27);
    let ratings: Vec<i32> = (1..=3)
        .flat_map(|subject| session(&trial.study, &format!("{subject:02}"), subject))
        .filter(|row| {
            row.stimulus_id.as_str() == "a010k_c140k" && row.phase == protocols::rating::Phase::Test
        })
        .map(|row| row.rating)
        .collect();
    let mean = f64::from(ratings.iter().sum::<i32>()) / 3.0;
    let row = means
        .lines()
        .find(|line| line.starts_with("a010k_c140k,"))
        .unwrap();
    let fields: Vec<&str> = row.split(',').collect();
    assert_eq!(fields[1..4], ["achromatic", "10K", "3"]);
    assert!(
        (fields[4].parse::<f64>().unwrap() - mean).abs() < 1e-12,
        "{row} and {mean}"
    );
}

#[test]
fn the_picture_is_the_figure_at_300_dots_an_inch() {
    let trial = Trial::with_people(4);
    trial.report().unwrap();
    let png = fs::read(trial.out().join("figure-10.png")).unwrap();
    assert_eq!(&png[..8], b"\x89PNG\r\n\x1a\n");
    let size = |at: usize| u32::from_be_bytes(png[at..at + 4].try_into().unwrap());
    // 7.6 by 4.7 inches; pHYs is in dots a metre.
    assert_eq!((size(16), size(20)), (2280, 1410));
    let chunk = png.windows(4).position(|name| name == b"pHYs").unwrap();
    assert_eq!([size(chunk + 4), size(chunk + 8)], [11_811; 2]);
    let svg = fs::read_to_string(trial.out().join("figure-10.svg")).unwrap();
    // One square or diamond for each of 14 ray counts, and one in the legend.
    assert_eq!(svg.matches("h9v9h-9z").count(), 15);
    assert_eq!(svg.matches("l6,-6l6,6l-6,6z").count(), 15);
}

#[test]
fn the_figure_stands_in_the_published_form_beside_ours() {
    let trial = Trial::with_people(4);
    trial.report().unwrap();
    let svg = fs::read_to_string(trial.out().join("figure-10-plain.svg")).unwrap();
    assert_eq!(svg.matches("h9v9h-9z").count(), 15);
    assert_eq!(svg.matches("l6,-6l6,6l-6,6z").count(), 15);
    // Two curves and two keys, nothing dashed, no bars, no plateaus, one ink.
    assert_eq!(svg.matches("<polyline").count(), 4);
    for absent in ["dasharray", "opacity", "c64b00", "interval"] {
        assert!(!svg.contains(absent), "{absent}");
    }
    for number in [">10<", ">140<", "thousands", ">4 subjects<"] {
        assert!(svg.contains(number), "{number}");
    }
    let page = trial.page();
    let pair = page.split("<div class=\"beside\">").nth(1).unwrap();
    assert_eq!(
        pair.split("</div>").next().unwrap().matches("<svg").count(),
        2
    );
    for name in ["figure-10-plain", "observers.svg"] {
        assert!(page.contains(&format!("<code>{name}</code>")), "{name}");
    }
    let markdown = fs::read_to_string(trial.out().join("report.md")).unwrap();
    let [plain, ours] =
        ["(figure-10-plain.png)", "(figure-10.png)"].map(|name| markdown.find(name));
    assert!(plain.unwrap() < ours.unwrap());
}

#[test]
fn an_unfinished_session_is_left_out_by_name() {
    let trial = Trial::with_people(4);
    let mut rows = session(&trial.study, "unfinished", 99);
    rows.truncate(20);
    write_session(&trial.study, &trial.data(), &rows);
    let summary = trial.report().unwrap();
    assert_eq!(summary.n_subjects, 4);
    assert_eq!(summary.anova.dropped_subjects, ["unfinished"]);
    let page = trial.page();
    assert!(
        page.contains("unfinished (17 of 27 images)"),
        "three of the twenty were practice"
    );
}

#[test]
fn pilots_are_left_out_unless_asked_for() {
    let trial = Trial::with_people(3);
    let mut rows = session(&trial.study, "04", 4);
    for row in &mut rows {
        row.pilot = true;
    }
    write_session(&trial.study, &trial.data(), &rows);
    assert_eq!(trial.report().unwrap().n_subjects, 3);
    assert!(
        trial
            .page()
            .contains("Trial runs left out: study-meyerliu1992_subject-04_session-1_task-pilot")
    );
    let with_pilots = report(
        &trial.study,
        &trial.data(),
        Some(&trial.out()),
        Pilots::Included,
    )
    .unwrap();
    assert_eq!(with_pilots.n_subjects, 4);
    assert!(trial.page().contains("PILOT"));
}

#[test]
fn simulated_observers_are_marked_and_never_mixed_with_people() {
    let simulated = |trial: &Trial, subject: &str, seed: u64| {
        let mut rows = session(&trial.study, subject, seed);
        for row in &mut rows {
            row.observer = Observer::Simulated;
        }
        write_session(&trial.study, &trial.data(), &rows);
    };
    let trial = Trial::new();
    for seed in 1..=3 {
        simulated(&trial, &format!("sim{seed}"), seed);
    }
    let summary = trial.report().unwrap();
    assert_eq!(summary.observer, Observer::Simulated);
    assert!(trial.page().contains("SIMULATED"));
    let svg = fs::read_to_string(trial.out().join("figure-10.svg")).unwrap();
    assert!(
        svg.contains("3 simulated observers"),
        "the figure says so wherever it goes"
    );
    let mixed = Trial::with_people(2);
    simulated(&mixed, "sim1", 1);
    let message = mixed.refusal();
    assert!(
        message.contains("subject-01_") && message.contains("subject-sim1_"),
        "{message}"
    );
}

#[test]
fn a_block_rated_twice_is_averaged_within_the_subject() {
    let trial = Trial::with_people(3);
    let first = session(&trial.study, "01", 1);
    let mut second = session(&trial.study, "01", 50);
    for row in &mut second {
        row.session_id = 2;
    }
    write_session(&trial.study, &trial.data(), &second);
    trial.report().unwrap();
    let means = fs::read_to_string(trial.out().join("means.csv")).unwrap();
    let row = means
        .lines()
        .find(|line| line.starts_with("a030k_c140k,"))
        .unwrap();
    let rating = |rows: &[protocols::rating::RatingRow]| {
        let is_it = |row: &&protocols::rating::RatingRow| row.stimulus_id.as_str() == "a030k_c140k";
        f64::from(rows.iter().find(is_it).unwrap().rating)
    };
    let others = rating(&session(&trial.study, "02", 2)) + rating(&session(&trial.study, "03", 3));
    let expected = (f64::midpoint(rating(&first), rating(&second)) + others) / 3.0;
    let found: f64 = row.split(',').nth(4).unwrap().parse().unwrap();
    assert!((found - expected).abs() < 1e-12, "{row} and {expected}");
}

#[test]
fn a_session_under_another_protocol_is_said() {
    let trial = Trial::with_people(3);
    let sidecar = trial
        .data()
        .join("data/study-meyerliu1992_subject-02_session-1_task-rating_data.json");
    fs::write(
        &sidecar,
        format!("{{\"protocol_sha256\": \"{}\"}}", "0".repeat(64)),
    )
    .unwrap();
    let warnings = trial.report().unwrap().warnings;
    assert_eq!(warnings.len(), 1);
    assert!(
        warnings[0].contains("subject-02") && warnings[0].contains("000000000000…"),
        "{warnings:?}"
    );
    let other_images = format!(
        "{{\"protocol_sha256\": \"{}\", \"manifest_sha256\": \"1\", \"acuity_version\": \"9.8.7\"}}",
        trial.study.sha256
    );
    fs::write(&sidecar, &other_images).unwrap();
    fs::write(
        ratings_path(&trial, "03").with_extension("json"),
        other_images.replace("\"1\"", "\"2\""),
    )
    .unwrap();
    let warnings = trial.report().unwrap().warnings;
    assert!(
        warnings[0].contains("2 different stimulus sets"),
        "{warnings:?}"
    );
    assert!(trial.page().contains("ratings taken with 9.8.7"));
    fs::remove_file(&sidecar).unwrap();
    assert!(trial.report().unwrap().warnings[0].contains("no readable sidecar"));
}

#[test]
fn a_torn_last_line_is_said_and_left_out() {
    let trial = Trial::with_people(3);
    let path = ratings_path(&trial, "03");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, &text[..text.len() - 9]).unwrap();
    let summary = trial.report().unwrap();
    assert!(
        summary.warnings[0].contains("torn"),
        "{:?}",
        summary.warnings
    );
    assert_eq!(summary.anova.dropped_subjects, ["03"]);
}

fn ratings_path(trial: &Trial, subject: &str) -> std::path::PathBuf {
    let name = format!("data/study-meyerliu1992_subject-{subject}_session-1_task-rating_data.csv");
    trial.data().join(name)
}

#[test]
fn missing_and_empty_data_are_refused_with_what_to_do() {
    let trial = Trial::new();
    assert!(trial.refusal().contains("acuity run"));
    fs::create_dir_all(trial.data().join("data")).unwrap();
    assert!(trial.refusal().contains("found no ratings"));
    let mut rows = session(&trial.study, "04", 4);
    for row in &mut rows {
        row.pilot = true;
    }
    write_session(&trial.study, &trial.data(), &rows);
    assert!(trial.refusal().contains("only trial runs"));
}

#[test]
fn one_subject_is_refused() {
    let message = Trial::with_people(1).refusal();
    assert!(message.contains("one complete subject (01)"), "{message}");
}

#[test]
fn malformed_and_contradictory_ratings_are_refused_with_their_line() {
    let cases = [
        // A rating off the scale, of no number, of another image's levels, of another subject, of no image.
        (
            ",achromatic,10K,",
            ",achromatic,20K,",
            "line 5, column channel and rays",
        ),
        (
            "test,a010k_c140k,1,achromatic",
            "test,a011k_c140k,1,achromatic",
            "line 5, column stimulus_id",
        ),
        ("02,1,4,test", "03,1,4,test", "line 5, columns subject_id"),
        ("02,1,4,test", "02,one,4,test", "line 5, column session_id"),
        ("02,1,5,test", "02,1,4,test", "trial 4"),
        ("02,1,4,test", "02,2,4,test", "line 5, columns subject_id"),
        ("02,1,4,test", "02,1,999,test", "line 5, column trial_id"),
        ("140k,1,", "140k,2,", "line 5, column repetition"),
        (",false", ",true", "line 5, columns subject_id"),
        ("response_time_s", "reaction_time_s", "line 1"),
    ];
    for (from, to, place) in cases {
        let trial = Trial::with_people(3);
        let path = ratings_path(&trial, "02");
        let text = fs::read_to_string(&path).unwrap();
        let practice_end = text.find("02,1,4,").unwrap();
        let (practice, test) = text.split_at(if place == "line 1" { 0 } else { practice_end });
        let changed = test.replacen(from, to, 1);
        assert_ne!(changed, test, "{from}");
        fs::write(&path, practice.to_owned() + &changed).unwrap();
        let message = trial.refusal();
        assert!(message.contains(place), "{message}");
    }
}

#[test]
fn a_rating_off_the_scale_is_refused() {
    let trial = Trial::with_people(2);
    let mut rows = session(&trial.study, "09", 9);
    rows[10].rating = 11;
    write_session(&trial.study, &trial.data(), &rows);
    let message = trial.refusal();
    assert!(
        message.contains("line 12, column rating: found 11"),
        "{message}"
    );
}

#[test]
fn two_groups_of_six_have_the_degrees_of_freedom_of_the_paper() {
    let mut trial = Trial::new();
    trial.study.protocol.analysis.within = vec!["rays".to_owned()];
    trial.study.protocol.analysis.between = vec!["channel".to_owned()];
    for subject in 1..=12 {
        let mut rows = session(&trial.study, &format!("{subject:02}"), subject);
        let own = if subject <= 6 {
            "achromatic"
        } else {
            "chromatic"
        };
        rows.retain(|row| row.levels[0] == own || row.levels[0] == "both");
        write_session(&trial.study, &trial.data(), &rows);
    }
    let summary = trial.report().unwrap();
    assert_eq!(summary.n_subjects, 12);
    // Meyer & Liu (1992), section 3.4: F(1,10), F(12,120), F(12,120).
    let dfs: Vec<(usize, usize)> = summary
        .anova
        .effects
        .iter()
        .map(|row| (row.df_num, row.df_den))
        .collect();
    assert_eq!(dfs, [(1, 10), (12, 120), (12, 120)]);
    let page = trial.page();
    assert!(page.contains("12 subjects here, in two groups, give 10 for each contrast, as many"));
    assert!(
        !page.contains("The two sequences at each ray count"),
        "no one rated both"
    );
    let means = fs::read_to_string(trial.out().join("means.csv")).unwrap();
    assert_eq!(
        means.lines().count(),
        1 + 28,
        "each group has its own mean of the image that both saw"
    );
}

#[test]
fn what_follows_the_table_is_on_the_page_and_in_the_json() {
    let trial = Trial::with_people(12);
    let summary = trial.report().unwrap();
    let page = fs::read_to_string(&summary.page).unwrap();
    for heading in [
        "Where the curves flatten",
        "Follow-up tests",
        "Does the scale matter?",
        "Can the observers be trusted?",
    ] {
        assert!(page.contains(heading), "{heading}");
    }
    assert!(!page.contains("NaN"), "a NaN on the page");
    let json = fs::read_to_string(summary.page.with_file_name("anova.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["asymptotes"]["curves"].as_array().unwrap().len(), 2);
    assert_eq!(json["follow_ups"].as_array().unwrap().len(), 4);
    // 12 subjects have 2^12 signs, so every effect within subjects is counted out.
    for test in json["distribution_free"]["permutation"].as_array().unwrap() {
        assert_eq!(test["n_arrangements"], 4096);
        assert_eq!(test["is_exact"], true);
    }
}

#[test]
fn every_format_holds_the_same_numbers() {
    let trial = Trial::with_people(12);
    let summary = trial.report().unwrap();
    let read = |name: &str| fs::read_to_string(trial.out().join(name)).unwrap();
    let (page, markdown, latex, text) = (
        trial.page(),
        read("report.md"),
        read("tables.tex"),
        read("to-paste.txt"),
    );
    let f = format!("{:.2}", summary.anova.effect("rays").unwrap().f.unwrap());
    for format in [&page, &markdown, &latex, &text] {
        assert!(format.contains(&f), "{f}");
    }
    // As many tables in each; in LaTeX a row has one sign fewer than columns.
    let tables = page.matches("<table>").count();
    assert_eq!(markdown.matches("\n| --- |").count(), tables);
    assert_eq!(latex.matches("\\caption").count(), tables);
    assert_eq!(latex.matches('{').count(), latex.matches('}').count());
    for table in latex.split("\\toprule").skip(1) {
        let rows = table.split("\\midrule").nth(1).unwrap().lines();
        let signs = |row: &&str| row.matches(" & ").count();
        let counts: Vec<usize> = rows
            .filter(|row| row.ends_with("\\\\"))
            .map(|row| signs(&row))
            .collect();
        assert!(
            counts.windows(2).all(|pair| pair[0] == pair[1]),
            "{counts:?}: {table}"
        );
    }
    // The paper's Figure 10 has 10K at the left; 12 subjects, 27 images: 324 trials.
    assert!(
        text.contains("In 324 trials 12 frames came late."),
        "{text}"
    );
    assert!(
        text.contains("F(1, 11)") || text.contains("F(1,\u{a0}11)"),
        "{text}"
    );
    assert!(!text.contains('<') || text.contains("p\u{a0}<"), "{text}");
    let follow_ups = read("follow-ups.csv");
    let columns = follow_ups.lines().next().unwrap().split(',').count();
    // 13 + 2 simple effects, 2 × 12 against the control, 3 trends and their differences.
    assert_eq!(follow_ups.lines().count(), 1 + 15 + 24 + 6);
    let mut reader = csv::Reader::from_reader(follow_ups.as_bytes());
    assert!(
        reader
            .records()
            .all(|record| record.unwrap().len() == columns)
    );
    assert_eq!(read("asymptotes.csv").lines().count(), 1 + 2 + 1);
    assert!(!read("figure-10-outlined.svg").contains("<text"));
}

#[test]
fn deviations_are_named_and_their_absence_too() {
    let trial = Trial::with_people(3);
    trial.report().unwrap();
    assert!(
        trial
            .page()
            .contains("every session followed the file that is analysed here")
    );
    assert!(trial.page().contains("Sessions: all complete."));
    let station = |width_mm: f64| {
        format!(
            "{{\"operating_system\": \"linux\", \"monitor_px\": [1920, 1080], \"monitor\": \"DP-1\", \
             \"measured\": {{\"width_mm\": {width_mm}, \"width_px\": 1920, \"distance_cm\": 101.6}}}}"
        )
    };
    let sidecar = |sha256: &str, width_mm: f64, ended: &str| {
        format!(
            "{{\"protocol_sha256\": \"{sha256}\", \"acuity_version\": \"1.2.3\", \"sittings\": \
             [{{\"started_at\": \"x\", \"ended_at\": {ended}, \"focus_losses\": 2, \"station\": {}}}]}}",
            station(width_mm)
        )
    };
    let write = |subject: &str, text: String| {
        fs::write(ratings_path(&trial, subject).with_extension("json"), text).unwrap();
    };
    let here = trial.study.sha256.to_string();
    // .336918 mm a pixel is .019 degrees at 101.6 cm (the reference's geometry.py): 646.88 mm for 1920.
    write("01", sidecar(&here, 646.88, "\"y\""));
    write("02", sidecar(&"0".repeat(64), 646.88, "null"));
    write("03", sidecar(&here, 711.57, "\"y\""));
    trial.report().unwrap();
    let page = trial.page();
    for said in [
        "Protocol: changed.</b> Under another version of the file: subject 02, session 1.",
        "Cut off (a crash, or the mains):</b> subject 02, session 1.",
        // 711.57 mm is 10.0% wider.
        "differed</b> from the 0.019° of the protocol by up to 10.0%",
        "Program: one version",
    ] {
        assert!(page.contains(said), "{said}");
    }
    assert!(page.contains("DP-1, 1920 × 1080 pixels, at 101.6 cm, linux"));
}

#[test]
fn predictions_stand_beside_the_ratings() {
    let trial = Trial::with_people(4);
    trial.report().unwrap();
    assert!(!trial.page().contains("Predicted before"));
    // The means themselves as one model's prediction, one step more as the other's.
    let means = fs::read_to_string(trial.out().join("means.csv")).unwrap();
    let mut text = String::from("stimulus_id,cvvdp_rating,scielab_rating,manifest_sha256\n");
    for line in means.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let mean: f64 = fields[4].parse().unwrap();
        writeln!(text, "{},{mean},{},abc", fields[0], mean + 1.0).unwrap();
    }
    let file = trial.folder.path().join("predictions.csv");
    fs::write(&file, text).unwrap();
    let out = trial.out();
    report_beside(
        &trial.study,
        &trial.data(),
        Some(&out),
        Pilots::LeftOut,
        Some(&file),
    )
    .unwrap();
    let page = trial.page();
    for row in [
        "<td>ColorVideoVDP</td><td>27</td><td>1.000</td><td>0.00</td><td>0.00</td>",
        "<td>S-CIELAB</td><td>27</td><td>1.000</td><td>1.00</td><td>1.00</td>",
    ] {
        assert!(page.contains(row), "{row}");
    }
    let svg = fs::read_to_string(out.join("figure-predicted.svg")).unwrap();
    // Two lines for each curve; a mark for each of 14 counts on both, and one in the legend.
    assert_eq!(svg.matches("<polyline").count(), 4);
    assert_eq!(svg.matches("h9v9h-9z").count(), 15);
}
