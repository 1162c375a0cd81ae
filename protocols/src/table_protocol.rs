//! A protocol of an analysis alone: for tables of ratings that other programs wrote.
//!
//! It has `study`, `title`, `source`, `[analysis]` as in a whole protocol, and `[table]` for the columns. A whole protocol
//! serves too: then only these parts of it are looked at.

use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::{AnalysisPlan, InputError, ReadError, Scale, Sha256Digest};

/// What a table holds, and how it is analysed.
#[derive(Clone, Debug)]
pub struct TableProtocol {
    /// The name of the study, and of its folder below `reports/`.
    pub study: String,
    /// One line for the head of the report.
    pub title: String,
    /// Where the study comes from; may be empty.
    pub source: String,
    /// Which column is what.
    pub table: TablePlan,
    /// How the ratings are analysed.
    pub analysis: AnalysisPlan,
    /// The file.
    pub path: PathBuf,
    /// The digest of the file.
    pub sha256: Sha256Digest,
}

/// Which column of a table is what; the factors are those of the analysis.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TablePlan {
    /// The column that names the subject, or `@` and an entity of the files' names.
    #[serde(default)]
    pub subject: Option<String>,
    /// The column of the ratings; `COLUMN.KEY` for a number in a JSON object.
    #[serde(default)]
    pub rating: Option<String>,
    /// Which rows are ratings: `COLUMN=VALUE` or `COLUMN!=VALUE`, each of which must hold.
    #[serde(default, rename = "where")]
    pub filters: Vec<String>,
    /// Factors that were observed and not manipulated.
    #[serde(default)]
    pub observed: Vec<String>,
    /// The ends of the scale, if it has any.
    #[serde(default)]
    pub scale: Option<Scale>,
}

/// The file as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    study: String,
    title: String,
    #[serde(default)]
    source: String,
    #[serde(default)]
    table: TablePlan,
    analysis: AnalysisPlan,
}

/// The parts of a whole protocol that are not looked at.
const OF_SESSIONS: [&str; 5] = ["stimuli", "viewing", "acuity", "session", "simulation"];

impl TableProtocol {
    /// Whether a file states an analysis and nothing of sessions, so that it is of no use without tables.
    #[must_use]
    pub fn is_of_tables_only(path: &Path) -> bool {
        let text = fs::read_to_string(path).ok();
        let written = text.and_then(|text| text.parse::<toml::Table>().ok());
        written.is_some_and(|written| {
            written.contains_key("analysis")
                && !OF_SESSIONS.iter().any(|&key| written.contains_key(key))
        })
    }

    /// Reads a protocol file for the analysis that it states.
    ///
    /// # Errors
    ///
    /// [`ReadError::Input`] if the file is missing, is no TOML, has an unknown or missing key or an analysis that
    /// contradicts itself; [`ReadError::Io`] if the system would not give it.
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        let kind = "a protocol with [analysis] (TOML)";
        let bytes = fs::read(path).map_err(|error| ReadError::from_io(path, kind, error))?;
        let sha256 = Sha256Digest::of(&bytes);
        let wrong = |found: String| InputError::new(path, found, kind);
        let text = String::from_utf8(bytes)
            .map_err(|error| wrong(format!("bytes that are not UTF-8 ({})", error.utf8_error())))?;
        let found = |error: toml::de::Error| {
            let remedy = "see \"Any other table\" in docs/manual.md";
            wrong(error.to_string().trim_end().to_owned()).remedy(remedy)
        };
        let is_whole = toml::from_str::<toml::Table>(&text)
            .map_err(found)?
            .contains_key("stimuli");
        let written: Written = if is_whole {
            let mut table: toml::Table = toml::from_str(&text).map_err(found)?;
            table.retain(|key, _| !OF_SESSIONS.contains(&key));
            table.try_into().map_err(found)?
        } else {
            toml::from_str(&text).map_err(found)?
        };
        let factors: Vec<String> = written.analysis.factors().map(str::to_owned).collect();
        let excluded = written.analysis.exclude.iter();
        let known: Vec<String> = excluded
            .map(|exclusion| exclusion.factor.clone())
            .chain(factors)
            .collect();
        if let Some((field, found, expected)) = written.analysis.fault(&known) {
            let error = InputError::new(path, found, expected);
            return Err(error.at(format!("field {field}")).into());
        }
        Ok(Self {
            study: written.study,
            title: written.title,
            source: written.source,
            table: written.table,
            analysis: written.analysis,
            path: path.to_owned(),
            sha256,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHOLE: &str = "study = \"codecs\"\ntitle = \"T\"\n[table]\nsubject = \"id\"\nrating = \"y\"\nwhere = [\"kind=rating\"]\n\
        scale = { lowest = 1, highest = 9 }\n[analysis]\nwithin = [\"a\"]\ncorrection = \"greenhouse-geisser\"\nconfidence = 0.95\n";

    fn read(text: &str) -> Result<TableProtocol, String> {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("p.toml");
        fs::write(&file, text).unwrap();
        TableProtocol::read(&file).map_err(|error| error.to_string())
    }

    #[test]
    fn an_analysis_alone_is_a_protocol() {
        let protocol = read(WHOLE).unwrap();
        assert_eq!(protocol.table.subject.as_deref(), Some("id"));
        assert_eq!(protocol.table.filters, ["kind=rating"]);
        assert_eq!(protocol.table.scale.unwrap().highest, 9);
        assert_eq!(protocol.analysis.within, ["a"]);
    }

    #[test]
    fn the_analysis_of_a_whole_protocol_serves() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("meyer-liu-1992.toml");
        let protocol = TableProtocol::read(&path).unwrap();
        assert_eq!(protocol.analysis.within, ["channel", "rays"]);
        assert_eq!(protocol.table, TablePlan::default());
    }

    #[test]
    fn what_cannot_be_used_is_refused_with_its_place() {
        for (from, to, expected) in [
            ("rating =", "ratings =", "unknown field `ratings`"),
            ("[analysis]", "[anlysis]", "unknown field `anlysis`"),
            ("0.95", "95", "a level above 0.5 and below 1"),
            ("title = \"T\"", "", "missing field `title`"),
            ("[\"a\"]", "[\"a\", \"a\"]", "none twice"),
            ("confidence", "confid", "confid"),
            ("[table]", "[table", "TOML parse error"),
        ] {
            let found = read(&WHOLE.replace(from, to)).unwrap_err();
            assert!(found.contains(expected), "{found}");
        }
        let found = TableProtocol::read(Path::new("nowhere.toml")).unwrap_err();
        assert!(found.to_string().contains("no such file"), "{found}");
    }
}
