//! The reference sets: a table and what others computed of it.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use analysis::{
    AnalysisError, AnovaTable, CellMatrix, Decimal, Design, anova_of_table, read_observations,
};
use protocols::{Missing, SumsOfSquares};
use serde_json::Value;

fn own_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/reference")
}

/// One data set: its table, and what is expected of it.
pub(crate) struct Case {
    pub(crate) table: PathBuf,
    pub(crate) expected: Value,
}

impl Case {
    pub(crate) fn id(&self) -> &str {
        self.expected["id"].as_str().unwrap()
    }

    pub(crate) fn design(&self) -> Design {
        let design = &self.expected["design"];
        let names = |key: &str| -> Vec<String> {
            let names = design[key].as_array().unwrap();
            names
                .iter()
                .map(|name| name.as_str().unwrap().to_owned())
                .collect()
        };
        Design {
            subject: design["subject"].as_str().unwrap().to_owned(),
            rating: design["dv"].as_str().unwrap().to_owned(),
            within: names("within"),
            between: names("between"),
            observed: names("observed"),
            sums_of_squares: SumsOfSquares::TypeThree,
            missing: Missing::Drop,
            filters: Vec::new(),
            decimal: Decimal::Point,
        }
    }

    pub(crate) fn cells(&self) -> CellMatrix {
        let observations = read_observations(&[&self.table], &self.design()).unwrap();
        CellMatrix::new(&observations).unwrap()
    }

    pub(crate) fn analyse(&self) -> Result<AnovaTable, AnalysisError> {
        anova_of_table(&self.table, &self.design())
    }

    /// Expected rows, without the intercept; none where there is no such analysis.
    pub(crate) fn rows(&self, analysis: &str) -> Vec<&Value> {
        let rows = self.expected[analysis]["ref"].as_array();
        rows.into_iter()
            .flatten()
            .filter(|row| row["effect"] != "(Intercept)")
            .collect()
    }

    /// How far a value may be off, relative: an offset of 1e7 costs the data themselves digits.
    pub(crate) fn tolerance(&self) -> f64 {
        if self.id() == "edge_offset_1e7" {
            1e-7
        } else {
            1e-9
        }
    }
}

fn cases(expected_folder: &Path, table_folder: &Path) -> Vec<Case> {
    let mut paths: Vec<PathBuf> = fs::read_dir(expected_folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "json")
        })
        .collect();
    paths.sort();
    let case = |path: &PathBuf| Case {
        table: table_folder.join(path.with_extension("csv").file_name().unwrap()),
        expected: serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap(),
    };
    paths.iter().map(case).collect()
}

pub(crate) fn own_cases() -> Vec<Case> {
    let cases = cases(&own_folder(), &own_folder());
    assert_eq!(cases.len(), 32, "the reference sets of this project");
    cases
}

pub(crate) fn is_refused(case: &Case) -> bool {
    case.expected["expect"] == "error"
}

/// A number, or `None` for what is null, absent or NaN.
pub(crate) fn number(value: &Value) -> Option<f64> {
    value.as_f64()
}

pub(crate) fn assert_near(what: &str, found: Option<f64>, expected: Option<f64>, tolerance: f64) {
    match (found, expected) {
        (None, None) => {}
        (Some(found), Some(expected)) => {
            let error = (found - expected).abs() / expected.abs().max(1e-300);
            assert!(
                found == expected || error <= tolerance,
                "{what}: found {found:e}, expected {expected:e}, off by {error:e}"
            );
        }
        _ => panic!("{what}: found {found:?}, expected {expected:?}"),
    }
}

/// p values below 1e-10 are compared by their logarithm.
pub(crate) fn assert_p_near(what: &str, found: Option<f64>, expected: Option<f64>, tolerance: f64) {
    let ln = |p: Option<f64>| p.map(f64::ln);
    if expected.is_some_and(|p| p < 1e-10) {
        assert_near(what, ln(found), ln(expected), tolerance);
    } else {
        assert_near(what, found, expected, tolerance);
    }
}

/// The sets of R packages under the GPL, which are not copied here; `None` where they are not beside this checkout.
pub(crate) fn published_cases() -> Option<Vec<Case>> {
    let shared = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/reference/stats");
    if !shared.is_dir() {
        let skipped = format!(
            "skipped: the data sets of R packages (GPL) are not here: {}\n",
            shared.display()
        );
        std::io::stdout().write_all(skipped.as_bytes()).unwrap();
        return None;
    }
    let cases = cases(&shared.join("expected"), &shared.join("data"));
    assert!(cases.len() >= 50, "{} sets", cases.len());
    Some(cases)
}
