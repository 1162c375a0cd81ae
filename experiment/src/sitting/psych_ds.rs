//! The rules of Psych-DS, each held over a data set of people with all that a session can write, and over one of
//! simulated observers.
//!
//! The rules are those of <https://psych-ds.github.io> (schema reference, "Rules"), read plainly from the files: no
//! type of the program takes part. A rule is a function that names what breaks it; the last test breaks every one.

use std::collections::BTreeSet;
use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};

use protocols::{Access, Layout};
use serde_json::Value;

use super::intake_kept::{answers, place};
use super::resumed;
use super::tests::Place;
use crate::{Finished, export_bids, simulate};

/// The keys of file names that the standard defines.
const OFFICIAL_KEYS: [&str; 9] = [
    "study",
    "site",
    "subject",
    "session",
    "task",
    "condition",
    "trial",
    "stimulus",
    "description",
];
/// What a description must say, and what a sidecar would take away from it: a key there replaces the whole.
const REQUIRED: [&str; 5] = [
    "@context",
    "@type",
    "name",
    "description",
    "variableMeasured",
];

/// Says what in a data set breaks it.
type Rule = fn(&Path) -> Vec<String>;

/// A session with form, screening and ratings and a trial run of the same subject; a simulation; whole sessions of pairs
/// on two bars, and of single pictures on five grades.
fn data_sets() -> (Place, Vec<PathBuf>) {
    let mut place = place();
    let consent = place.study.protocol.session.consent.clone().unwrap();
    for pilot in [None, Some(10.0)] {
        place.options.pilot = pilot;
        let mut sitting = place.open().unwrap();
        let screening = Finished::Screening(Vec::new(), Vec::new());
        for finished in [Finished::Consent(consent.sha256()), answers(), screening] {
            sitting.keep(finished, 1.0).unwrap();
        }
        drop(sitting);
        place.rate(3);
    }
    let simulated = place.folder().join("simulated");
    let stimuli = &place.options.stimuli_dir;
    simulate(&place.study, stimuli, &simulated, 2, 1, &|_, _| {}).unwrap();
    let mut roots = vec![place.options.data_dir.clone(), simulated];
    for layout in [Layout::Dscqs, Layout::Single] {
        let data = format!("{layout:?}");
        let other = resumed::place(&place, &data, (1, layout, false, false));
        resumed::sit(&other, &[]);
        roots.push(other.options.data_dir.clone());
    }
    (place, roots)
}

fn is_csv(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "csv")
}

fn name_of(path: &Path) -> String {
    path.file_name().unwrap().to_string_lossy().into_owned()
}

/// Every file below a folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path));
        } else {
            found.push(path);
        }
    }
    found.sort();
    found
}

fn tables(root: &Path) -> Vec<PathBuf> {
    let all = files(&root.join("data")).into_iter();
    all.filter(|path| is_csv(path)).collect()
}

fn json(path: &Path) -> Value {
    let text = fs::read_to_string(path).unwrap_or_default();
    serde_json::from_str(&text).unwrap_or_default()
}

/// Header and rows, by another program's reader, which takes no row that is shorter or longer than the header.
fn read(path: &Path) -> Result<(Vec<String>, Vec<csv::StringRecord>), csv::Error> {
    let mut reader = csv::Reader::from_path(path)?;
    let header = reader.headers()?.iter().map(str::to_owned).collect();
    Ok((header, reader.records().collect::<Result<_, _>>()?))
}

/// The keys and values of `([a-z]+-[a-zA-Z0-9]+)(_[a-z]+-[a-zA-Z0-9]+)*_data\.csv`, or `None`.
fn keys(name: &str) -> Option<Vec<(&str, &str)>> {
    let is_key = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_lowercase());
    let is_value = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_alphanumeric());
    let pairs = name.strip_suffix("_data.csv")?.split('_');
    pairs
        .map(|pair| {
            pair.split_once('-')
                .filter(|(key, value)| is_key(key) && is_value(value))
        })
        .collect()
}

/// The root has a description in JSON-LD: a schema.org data set with name, description and variables.
fn broken_description(root: &Path) -> Vec<String> {
    let description = json(&root.join("dataset_description.json"));
    let mut broken = Vec::new();
    let expected = [("@context", "schema.org"), ("@type", "Dataset")];
    for (key, word) in expected {
        let is_said = description[key]
            .as_str()
            .is_some_and(|text| text.contains(word));
        broken.extend((!is_said).then(|| format!("{key} does not say {word}")));
    }
    for key in ["name", "description"] {
        let is_said = description[key]
            .as_str()
            .is_some_and(|text| !text.is_empty());
        broken.extend((!is_said).then(|| format!("no {key}")));
    }
    let variables = description["variableMeasured"].as_array();
    let has_variables = variables.is_some_and(|variables| !variables.is_empty());
    broken.extend((!has_variables).then(|| "no variableMeasured".to_owned()));
    broken
}

/// Tables of data stand in `data/`, under names of official keys, each once; nowhere else.
fn broken_names(root: &Path) -> Vec<String> {
    let mut broken = Vec::new();
    for path in files(root).iter().filter(|path| is_csv(path)) {
        let name = name_of(path);
        let keys = keys(&name);
        if path.starts_with(root.join("data")) {
            let names: Option<Vec<_>> = keys.map(|keys| keys.iter().map(|pair| pair.0).collect());
            let is_good = names.is_some_and(|names| {
                let once: BTreeSet<_> = names.iter().collect();
                once.len() == names.len() && names.iter().all(|name| OFFICIAL_KEYS.contains(name))
            });
            broken.extend((!is_good).then(|| format!("the name {name}")));
        } else {
            broken.extend(keys.map(|_| format!("{name} is not in data/")));
        }
    }
    let has_tables = !tables(root).is_empty();
    broken.extend((!has_tables).then(|| "no table".to_owned()));
    broken
}

/// A table is UTF-8 with commas; its first row names the columns, each once, and no row is shorter or longer.
fn broken_tables(root: &Path) -> Vec<String> {
    let mut broken = Vec::new();
    for path in tables(root) {
        let name = name_of(&path);
        let bytes = fs::read(&path).unwrap();
        if bytes.is_empty() || bytes.starts_with(&[0xEF, 0xBB, 0xBF]) {
            broken.push(format!("{name} is empty or has a byte order mark"));
        }
        match read(&path) {
            Err(error) => broken.push(format!("{name}: {error}")),
            Ok((header, _)) => {
                let once: BTreeSet<_> = header.iter().collect();
                let is_named =
                    |column: &String| column.parse::<f64>().is_err() && !column.is_empty();
                if once.len() != header.len() || !header.iter().all(is_named) {
                    broken.push(format!("{name}: the header {header:?}"));
                }
            }
        }
    }
    broken
}

/// A sidecar has the name of its table, is a JSON object, and replaces no key of the description.
fn broken_sidecars(root: &Path) -> Vec<String> {
    let mut broken = Vec::new();
    for path in files(&root.join("data")) {
        if is_csv(&path) {
            continue;
        }
        let (name, sidecar) = (name_of(&path), json(&path));
        if path.extension().is_none_or(|ending| ending != "json") {
            broken.push(format!("{name} is neither table nor sidecar"));
        } else if !path.with_extension("csv").exists() {
            broken.push(format!("{name} has no table"));
        } else if !sidecar.is_object() {
            broken.push(format!("{name} is no JSON object"));
        }
        let replaced = REQUIRED.iter().filter(|key| !sidecar[**key].is_null());
        broken.extend(replaced.map(|key| format!("{name} replaces {key}")));
    }
    broken
}

/// Every column, also of the tables that the standard does not ask for, is described, with the unit that its name
/// ends in.
fn broken_columns(root: &Path) -> Vec<String> {
    let description = json(&root.join("dataset_description.json"));
    let none = Vec::new();
    let variables = description["variableMeasured"].as_array().unwrap_or(&none);
    let mut broken = Vec::new();
    for path in files(root).iter().filter(|path| is_csv(path)) {
        let header = read(path).map(|read| read.0).unwrap_or_default();
        for column in header {
            let mut same = variables
                .iter()
                .filter(|known| known["name"] == column.as_str());
            let (Some(variable), None) = (same.next(), same.next()) else {
                broken.push(format!(
                    "{column} of {} is not described once",
                    name_of(path)
                ));
                continue;
            };
            let unit = match column.rsplit_once('_').map(|(_, unit)| unit) {
                Some(unit @ ("s" | "us" | "px" | "arcmin")) => Some(unit),
                _ => None,
            };
            let is_said = variable["description"]
                .as_str()
                .is_some_and(|text| text.len() > 3);
            if !is_said || variable["unitText"].as_str() != unit {
                broken.push(format!("{column} is described as {variable}"));
            }
        }
    }
    broken
}

/// `row_id`, or else subject, session and trial, tell rows apart, and the columns that identify say what the name of
/// the file says.
fn broken_identifiers(root: &Path) -> Vec<String> {
    let mut broken = Vec::new();
    for path in tables(root) {
        let name = name_of(&path);
        let Ok((header, rows)) = read(&path) else {
            continue;
        };
        let column = |name: &str| header.iter().position(|column| column == name);
        for (key, value) in keys(&name).unwrap_or_default() {
            let Some(index) = column(&format!("{key}_id")) else {
                continue;
            };
            let others = rows.iter().filter(|row| &row[index] != value);
            broken.extend(others.map(|row| format!("{name}: {key}_id {}", &row[index])));
        }
        let key = ["row_id", "subject_id", "session_id", "trial_id", "item"];
        let key: Vec<_> = key.into_iter().filter_map(column).collect();
        let of_row =
            |row: &csv::StringRecord| key.iter().map(|&index| row[index].to_owned()).collect();
        let once: BTreeSet<Vec<String>> = rows.iter().map(of_row).collect();
        if once.len() != rows.len() {
            broken.push(format!("{name}: two rows are one"));
        }
    }
    broken
}

/// Holds a rule over both data sets.
fn hold(rule: Rule) {
    let (_place, roots) = data_sets();
    for root in roots {
        assert_eq!(rule(&root), Vec::<String>::new(), "{}", root.display());
    }
}

#[test]
fn the_root_has_a_description_with_what_is_required() {
    hold(broken_description);
}

#[test]
fn tables_stand_in_data_under_names_of_official_keys() {
    hold(broken_names);
}

#[test]
fn tables_are_utf8_with_commas_and_one_header_row() {
    hold(broken_tables);
}

#[test]
fn a_sidecar_belongs_to_a_table_and_replaces_nothing_of_the_description() {
    hold(broken_sidecars);
}

/// Not a rule of the standard but of ours: nobody but the owner may read what a session or an export leaves.
#[test]
fn only_the_owner_may_read_any_file() {
    let (place, mut roots) = data_sets();
    let (options, bids) = (&place.options, place.folder().join("bids"));
    export_bids(&place.study, &options.stimuli_dir, &options.data_dir, &bids).unwrap();
    roots.push(bids);
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
    for root in roots {
        let all = files(&root);
        assert!(all.len() >= 5);
        for path in all {
            assert_eq!(mode(&path), 0o600, "{}", path.display());
            assert_eq!(mode(path.parent().unwrap()), 0o700, "{}", path.display());
        }
    }
    let all = files(&options.data_dir);
    for part in ["timing", "private", "task-form", "task-screening"] {
        let has_it = |path: &PathBuf| path.to_string_lossy().contains(part);
        assert!(all.iter().any(has_it), "{part}");
    }
}

#[test]
fn every_column_is_described_with_its_unit() {
    hold(broken_columns);
}

#[test]
fn columns_that_identify_tell_rows_apart_and_agree_with_the_file_name() {
    hold(broken_identifiers);
}

/// What is changed in which file: the end of its name, the words, and what stands there instead.
type Change = (&'static str, &'static str, &'static str);

#[test]
fn each_rule_finds_what_breaks_it() {
    let (place, roots) = data_sets();
    let root = roots[0].clone();
    let ratings = "session-1_task-rating_data.csv";
    let sidecar = "session-1_task-rating_data.json";
    let about = "dataset_description.json";
    let changes: [(Rule, Change); 11] = [
        (broken_description, (about, "https://schema.org", "none")),
        (
            broken_description,
            (about, "\"name\": \"meyer", "\"title\": \"meyer"),
        ),
        (
            broken_description,
            (about, "\"variableMeasured\"", "\"columns\""),
        ),
        (
            broken_tables,
            (ratings, "subject_id,", "\u{feff}subject_id,"),
        ),
        (broken_tables, (ratings, "session_id,", "subject_id,")),
        (broken_tables, (ratings, ",person,", ",person,,")),
        (broken_sidecars, (sidecar, "\"study\"", "\"description\"")),
        (broken_columns, (ratings, "showings", "shows")),
        (
            broken_columns,
            (about, "\"unitText\": \"s\"", "\"unitText\": \"ms\""),
        ),
        (broken_identifiers, (ratings, "\nS1,1,2,", "\nS1,1,1,")),
        (broken_identifiers, (ratings, "\nS1,1,2,", "\nS2,1,2,")),
    ];
    for (rule, (end, words, other)) in changes {
        let mut all = files(&root).into_iter();
        let path = all.find(|path| name_of(path).ends_with(end)).unwrap();
        let whole = fs::read_to_string(&path).unwrap();
        assert!(whole.contains(words), "{words} in {whole}");
        fs::write(&path, whole.replacen(words, other, 1)).unwrap();
        assert_ne!(rule(&root), Vec::<String>::new(), "{words} -> {other}");
        fs::write(&path, whole).unwrap();
        assert_eq!(rule(&root), Vec::<String>::new());
    }
    let ratings = place.options.data_dir.join("data");
    for (name, rule) in [
        ("data/Ratings_data.csv", broken_names as Rule),
        ("data/subject-1_run-2_data.csv", broken_names),
        ("study-a_subject-1_data.csv", broken_names),
        ("data/study-a_data.json", broken_sidecars),
    ] {
        let path = root.join(name);
        protocols::write_atomically(&path, b"item\n", Access::Owner).unwrap();
        assert_eq!(rule(&root).len(), 1, "{name} in {}", ratings.display());
        fs::remove_file(path).unwrap();
    }
}
