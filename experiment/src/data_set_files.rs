//! The Psych-DS data set around the ratings: its folders and its `dataset_description.json`.
//!
//! A data set is of people or of simulated observers, never of both; the description says which, and what
//! is written into it must agree.

use std::fs::{self, DirBuilder};
use std::io::ErrorKind;
use std::os::unix::fs::DirBuilderExt as _;
use std::path::Path;

use protocols::rating::{Column, columns};
use protocols::{
    Access, DataSet, InputError, Observer, ReadError, Study, settle_names, write_atomically,
};
use serde_json::{Value, json};

use crate::{ExperimentError, timing_log};

/// Makes the folders and the description of the data set, or checks those that are there.
pub(crate) fn prepare(
    data_set: &DataSet,
    study: &Study,
    observer: Observer,
) -> Result<(), ExperimentError> {
    create_private_folder(data_set.root())?;
    create_private_folder(&data_set.data_folder())?;
    let path = data_set.description_path();
    if path.exists() {
        check(data_set, study, observer)?;
        return describe_new_columns(&path, &description(study, observer));
    }
    if has_entries(&data_set.data_folder())? {
        let remedy = "restore it, or name another folder with --data";
        return Err(InputError::new(
            path,
            "no such file beside ratings that are there",
            "the description of the data set",
        )
        .remedy(remedy)
        .into());
    }
    let text = format!("{:#}\n", description(study, observer));
    write_atomically(&path, text.as_bytes(), Access::Owner)
        .map_err(ExperimentError::io("write", &path))
}

/// Adds the columns that the description lacks, as after a question was added to the protocol's form.
fn describe_new_columns(path: &Path, present: &Value) -> Result<(), ExperimentError> {
    let kind = "the description of a data set (JSON)";
    let text = fs::read_to_string(path).map_err(|error| ReadError::from_io(path, kind, error))?;
    let mut found: Value = serde_json::from_str(&text)
        .map_err(|error| InputError::new(path, error.to_string(), kind))?;
    let wanted = present["variableMeasured"].as_array();
    let Some(known) = found["variableMeasured"].as_array_mut() else {
        let expected = "the columns of every table";
        return Err(InputError::new(path, "no variableMeasured", expected).into());
    };
    let before = known.len();
    for variable in wanted.into_iter().flatten() {
        if known.iter().all(|old| old["name"] != variable["name"]) {
            known.push(variable.clone());
        }
    }
    if known.len() == before {
        return Ok(());
    }
    let text = format!("{found:#}\n");
    write_atomically(path, text.as_bytes(), Access::Owner)
        .map_err(ExperimentError::io("write", path))
}

/// Checks that the data set is of this study and of this kind of observer.
pub(crate) fn check(
    data_set: &DataSet,
    study: &Study,
    observer: Observer,
) -> Result<(), ExperimentError> {
    let path = data_set.description_path();
    let kind = "the description of a data set (JSON)";
    let text = fs::read_to_string(&path).map_err(|error| ReadError::from_io(&path, kind, error))?;
    let found: Value = serde_json::from_str(&text)
        .map_err(|error| InputError::new(&path, error.to_string(), kind))?;
    let expected = [
        ("identifier", study.protocol.study.as_str()),
        ("observer", observer_word(observer)),
    ];
    for (field, expected) in expected {
        if found[field].as_str() != Some(expected) {
            return Err(
                InputError::new(&path, found[field].to_string(), format!("{expected:?}"))
                    .at(format!("field {field}"))
                    .remedy("people and simulated observers, and two studies, never share a data set: name another folder with --data")
                    .into(),
            );
        }
    }
    Ok(())
}

pub(crate) fn observer_word(observer: Observer) -> &'static str {
    match observer {
        Observer::Person => "person",
        Observer::Simulated => "simulated",
    }
}

/// The description: JSON-LD of schema.org, as Psych-DS asks, with every column of the ratings.
fn description(study: &Study, observer: Observer) -> Value {
    let protocol = &study.protocol;
    let (name, who) = match observer {
        Observer::Person => (protocol.study.clone(), "people"),
        Observer::Simulated => (
            format!("{} (simulated)", protocol.study),
            "simulated observers (a model of vision with bias, gain and noise; no person took part)",
        ),
    };
    // Simulated sessions have no frames.
    let has_timing = observer == Observer::Person;
    let timing = timing_log::columns().filter(|_| has_timing);
    let of_ratings = columns(&study.protocol.stimuli.factors());
    let variables = variables(
        of_ratings
            .into_iter()
            .chain(crate::intake_files::columns(&study.protocol.session))
            .chain(timing),
    );
    json!({
        "@context": "https://schema.org",
        "@type": "Dataset",
        "name": name,
        "description": format!("Ratings of image quality by {who}. {}", protocol.title),
        "identifier": protocol.study,
        "observer": observer_word(observer),
        "citation": protocol.source,
        "creator": { "@type": "SoftwareApplication", "name": "acuity", "softwareVersion": env!("CARGO_PKG_VERSION") },
        "keywords": ["psychophysics", "image quality", observer_word(observer)],
        "variableMeasured": variables,
    })
}

/// A description of each name, once: where a factor is called as a column of another table is, it says both.
fn variables(columns: impl Iterator<Item = Column>) -> Vec<Value> {
    let mut named: Vec<Column> = Vec::new();
    for column in columns {
        match named.iter_mut().find(|known| known.name == column.name) {
            None => named.push(column),
            Some(known) if known.description == column.description => {}
            Some(known) => {
                known.description += "; in a table without that: ";
                known.description += &column.description;
            }
        }
    }
    let variable = |column: Column| {
        let mut variable = json!({
            "@type": "PropertyValue",
            "name": column.name,
            "description": column.description,
        });
        if let Some(unit) = column.unit {
            variable["unitText"] = unit.into();
        }
        variable
    };
    named.into_iter().map(variable).collect()
}

/// Creates a folder that only its owner may enter, and the folders above it; their names outlast a power cut.
pub(crate) fn create_private_folder(folder: &Path) -> Result<(), ExperimentError> {
    let is_missing = |path: &&Path| !path.as_os_str().is_empty() && !path.exists();
    let missing: Vec<&Path> = folder.ancestors().take_while(is_missing).collect();
    DirBuilder::new()
        .recursive(true)
        .mode(0o700)
        .create(folder)
        .map_err(|error| match error.kind() {
            ErrorKind::AlreadyExists | ErrorKind::NotADirectory => {
                InputError::new(folder, "a file", "a folder for the ratings")
                    .remedy("name another with --data")
                    .into()
            }
            _ => ExperimentError::io("create", folder)(error),
        })?;
    for made in missing {
        let above = match made.parent() {
            Some(above) if !above.as_os_str().is_empty() => above,
            _ => Path::new("."),
        };
        settle_names(above).map_err(ExperimentError::io("sync", above))?;
    }
    Ok(())
}

pub(crate) fn has_entries(folder: &Path) -> Result<bool, ExperimentError> {
    let mut entries = fs::read_dir(folder).map_err(ExperimentError::io("read", folder))?;
    Ok(entries.next().is_some())
}
