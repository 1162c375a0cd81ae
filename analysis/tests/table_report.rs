//! Reports of tables that any program wrote.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use analysis::{AnalysisError, Decimal, Design, TableStudy, anova_of_table, report_of_tables};
use protocols::{AnalysisPlan, Correction, Exclusion, FollowUpPlan, Missing, Scale, SumsOfSquares};
use tempfile::TempDir;

/// What a report holds, the figure in four forms.
const FILES: [&str; 14] = [
    "anova.csv",
    "anova.json",
    "asymptotes.csv",
    "figure-outlined.svg",
    "figure.pdf",
    "figure.png",
    "figure.svg",
    "follow-ups.csv",
    "means.csv",
    "report.html",
    "report.md",
    "report.pdf",
    "tables.tex",
    "to-paste.txt",
];

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests")
        .join(name)
}

fn names(names: &[&str]) -> Vec<String> {
    names.iter().map(|&name| name.to_owned()).collect()
}

fn study(rating: &str, within: &[&str], between: &[&str]) -> TableStudy {
    let plan = AnalysisPlan {
        within: names(within),
        between: names(between),
        exclude: Vec::new(),
        sums_of_squares: SumsOfSquares::TypeThree,
        missing: Missing::Drop,
        correction: Correction::GreenhouseGeisser,
        confidence: 0.95,
        follow_ups: Vec::new(),
        asymptote: None,
        permutations: 200,
        seed: 1,
        published: Vec::new(),
    };
    TableStudy {
        study: "table".to_owned(),
        title: "A table <of> ratings & more".to_owned(),
        source: String::new(),
        design: Design {
            subject: "id".to_owned(),
            rating: rating.to_owned(),
            within: names(within),
            between: names(between),
            ..Design::default()
        },
        plan,
        scale: None,
        protocol: None,
    }
}

struct Report {
    folder: TempDir,
}

impl Report {
    fn of(tables: &[PathBuf], study: &TableStudy) -> Result<Self, AnalysisError> {
        let folder = tempfile::tempdir().unwrap();
        report_of_tables(tables, study, &folder.path().join("report"))?;
        Ok(Self { folder })
    }

    fn text(&self, name: &str) -> String {
        fs::read_to_string(self.folder.path().join("report").join(name)).unwrap()
    }

    fn files(&self) -> Vec<(String, Vec<u8>)> {
        let entries = fs::read_dir(self.folder.path().join("report")).unwrap();
        let mut files: Vec<(String, Vec<u8>)> = entries
            .map(|entry| entry.unwrap())
            .map(|entry| {
                let name = entry.file_name().into_string().unwrap();
                (name, fs::read(entry.path()).unwrap())
            })
            .collect();
        files.sort();
        files
    }
}

/// A table: subjects in two groups rate under three factors; subject 9 lacks a cell, subject 1 rates one twice.
fn many_factors(folder: &Path) -> PathBuf {
    let mut text = String::from("id,group,way,size,hour,kind,score\n");
    let mut state = 7_u32;
    for subject in 1..=9 {
        let group = if subject % 2 == 0 { "even" } else { "odd, too" };
        for cell in 0..20 {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let (way, size, hour) = (cell % 2, cell / 2 % 2, cell / 4);
            let score = f64::from(state >> 20) / 512.0 + f64::from(hour * (1 + way));
            if subject == 9 && cell == 3 {
                continue;
            }
            let row = format!("{subject},\"{group}\",w{way},s{size},h{hour},rating,{score}\n");
            text.push_str(&row);
            if subject == 1 && cell == 0 {
                text.push_str(&row);
            }
        }
        _ = writeln!(text, "{subject},\"{group}\",w0,s0,h0,practice,99");
    }
    let file = folder.join("many.csv");
    fs::write(&file, text).unwrap();
    file
}

#[test]
fn a_table_has_every_file_of_a_report_and_the_numbers_of_its_analysis() {
    let table = data("reference/sim_mixed_2within_unbalanced.csv");
    let header = fs::read_to_string(&table).unwrap();
    let columns: Vec<&str> = header.lines().next().unwrap().split(',').collect();
    let (rating, factors) = (columns[columns.len() - 1], &columns[1..columns.len() - 1]);
    let study = study(rating, &factors[1..], &factors[..1]);
    let report = Report::of(std::slice::from_ref(&table), &study).unwrap();
    let found: Vec<String> = report.files().into_iter().map(|(name, _)| name).collect();
    assert_eq!(found, FILES);
    let alone = anova_of_table(&table, &study.design).unwrap();
    assert_eq!(report.text("anova.csv"), alone.to_csv());
    let page = report.text("report.html");
    for foreign in ["<script", "http://", "https://", "NaN", "inf"] {
        let page = page.replace("http://www.w3.org/2000/svg", "");
        assert!(!page.contains(foreign), "{foreign}");
    }
    assert!(page.contains("A table &lt;of&gt; ratings &amp; more"));
    assert_eq!(
        Report::of(&[table], &study).unwrap().files(),
        report.files(),
        "the same table gives the same bytes"
    );
}

#[test]
fn what_was_left_out_averaged_and_not_drawn_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let table = many_factors(folder.path());
    let mut study = study("score", &["way", "size", "hour"], &["group"]);
    study.design.filters = vec!["kind=rating".parse().unwrap()];
    study.plan.exclude = vec![Exclusion {
        factor: "hour".to_owned(),
        levels: names(&["h4"]),
        reason: "the light failed".to_owned(),
    }];
    study.plan.follow_ups = vec![FollowUpPlan::Pairwise {
        factor: "way".to_owned(),
        at: None,
    }];
    let report = Report::of(&[table], &study).unwrap();
    let page = report.text("report.html");
    for said in [
        // 20 cells of 9 subjects, less the missing one, and one twice; without h4: 4 cells of each; 9 rows of practice.
        "144 rows of 1 file are ratings; 0 of them have no value.",
        "45 rows are left out by",
        "Left out, because a rating is missing: 9.",
        "1 cells were rated more than once",
        "h4 is left out: the light failed",
        "Pairs of levels of way",
        "8 subjects",
    ] {
        assert!(page.contains(said), "{said}");
    }
    // 2 groups x 2 x 2 lines fit; every cell has its line in the file: 2 x 2 x 2 x 4.
    assert!(!page.contains("averaged over"));
    let means = report.text("means.csv");
    assert_eq!(means.lines().count(), 1 + 32);
    assert!(means.starts_with("group,way,size,hour,n,mean,"), "{means}");
    assert!(means.contains("\n\"odd, too\",w1,s1,h3,4,"), "{means}");
}

#[test]
fn a_figure_of_too_many_lines_is_averaged_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let mut text = String::from("id,a,b,c,d,y\n");
    for cell in 0..6 * 3 * 3 * 2 * 2 {
        let (subject, a, b, c, d) = (
            cell / 36,
            cell / 12 % 3,
            cell / 4 % 3,
            cell / 2 % 2,
            cell % 2,
        );
        _ = writeln!(text, "{subject},{a},{b},{c},{d},{}", (cell * 7) % 11 + a);
    }
    let file = folder.path().join("t.csv");
    fs::write(&file, text).unwrap();
    let report = Report::of(&[file], &study("y", &["a", "b", "c", "d"], &[])).unwrap();
    let page = report.text("report.html");
    assert!(page.contains("averaged over a and c and d") || page.contains("averaged over c and d"));
    // One mark for each of the nine cells that are drawn, and one for each line of the legend.
    let svg = report.text("figure.svg");
    let marks = svg.matches("style=\"fill:#").count();
    assert!(marks >= 12, "{marks}");
    assert_eq!(report.text("means.csv").lines().count(), 1 + 36);
}

#[test]
fn simulated_ratings_and_a_scale_are_known_again() {
    let folder = tempfile::tempdir().unwrap();
    let mut text = String::from("id,way,score,observer\n");
    for (subject, [a, b, c]) in [[1, 5, 9], [2, 7, 10], [1, 4, 10], [0, 6, 10]]
        .into_iter()
        .enumerate()
    {
        _ = write!(
            text,
            "{subject},a,{a},simulated\n{subject},b,{b},simulated\n{subject},c,{c},simulated\n"
        );
    }
    let file = folder.path().join("t.csv");
    fs::write(&file, text).unwrap();
    let mut study = study("score", &["way"], &[]);
    study.scale = Some(Scale {
        lowest: 0,
        highest: 10,
    });
    let page = Report::of(&[file], &study).unwrap().text("report.html");
    assert!(page.contains("SIMULATED"));
    assert!(page.contains("4 simulated observers"));
    // Three tens among twelve ratings.
    assert!(page.contains("25% are 10"), "{page}");
    assert!(page.contains("FEW SUBJECTS"));
}

#[test]
fn a_table_that_cannot_be_analysed_leaves_no_report() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("report");
    let file = folder.path().join("t.csv");
    let study = study("y", &["w"], &[]);
    for (text, expected) in [
        ("id,w,y\n1,a,1\n", "one level"),
        ("id,w,y\n1,a,x\n", "expected a number"),
        ("id,w\n1,a\n", "a column \"y\""),
        ("", "no columns"),
        ("id,w,y\n1,a,1\n1,b,2\n", "at least 2 complete subjects"),
        (
            "id,w,y\n1,a,1\n2,b,2\n3,a,2\n",
            "every subject has one level of w: name it in --between",
        ),
        ("PK\u{3}\u{4}", "save the sheet as CSV"),
    ] {
        fs::write(&file, text).unwrap();
        let error = report_of_tables(std::slice::from_ref(&file), &study, &out).unwrap_err();
        assert!(error.is_input(), "{error}");
        assert!(error.to_string().contains(expected), "{error}");
        assert!(!out.exists());
    }
    for (bytes, expected) in [
        (&b"PK\x03\x04\xff\xff"[..], "save the sheet as CSV"),
        (&b"\xff\xfei\0d\0"[..], "text in UTF-16"),
        (&b"id,w,y\n1,\xe4,1\n"[..], "line 2"),
    ] {
        fs::write(&file, bytes).unwrap();
        let error = report_of_tables(std::slice::from_ref(&file), &study, &out).unwrap_err();
        assert!(error.to_string().contains(expected), "{error}");
    }
    let missing = report_of_tables(&[folder.path().join("no.csv")], &study, &out).unwrap_err();
    assert!(missing.to_string().contains("no such file"), "{missing}");
}

#[test]
fn a_decimal_comma_is_read_only_where_it_is_said_to_be_one() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: String| {
        let file = folder.path().join(name);
        fs::write(&file, text).unwrap();
        file
    };
    let rows = [("1", 1.5, 2.25), ("2", 0.5, 3.0), ("3", 2.0, 2.75)];
    let (mut points, mut commas) = (String::from("id,w,y\n"), String::from("id;w;y\n"));
    for (subject, a, b) in rows {
        _ = write!(points, "{subject},a,{a}\n{subject},b,{b}\n");
        let line = format!("{subject};a;{a}\n{subject};b;{b}\n");
        commas.push_str(&line.replace('.', ","));
    }
    let (points, commas) = (write("p.csv", points), write("c.csv", commas));
    let mut design = study("y", &["w"], &[]).design;
    let expected = anova_of_table(&points, &design).unwrap();
    let refused = anova_of_table(&commas, &design).unwrap_err().to_string();
    assert!(refused.contains("--decimal-comma"), "{refused}");
    design.decimal = Decimal::Comma;
    assert_eq!(anova_of_table(&commas, &design).unwrap(), expected);
}
