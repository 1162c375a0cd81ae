//! `acuity report` and `anova`: from ratings to an analysis of variance.

use std::path::Path;

use analysis::{
    AnalysisOptions, AsymptoteOption, Decimal, Design, Pilots, ReportSummary, TableAnalysis,
};
use protocols::{InputError, Study, TableProtocol};

use crate::analysis_arguments::{AnovaArguments, Columns, ReportArguments};
use crate::console;
use crate::follow_up;
use crate::predict::default_file;
use crate::table_report;

pub(crate) fn report(arguments: &ReportArguments) -> anyhow::Result<()> {
    let (protocols, tables): (Vec<_>, Vec<_>) =
        (arguments.files.iter().cloned()).partition(|file| {
            file.extension()
                .is_some_and(|extension| extension == "toml")
        });
    let first = arguments.files.first().map_or(Path::new(""), |file| file);
    let protocol = match protocols.as_slice() {
        [] => None,
        [one] => Some(one.as_path()),
        [_, second, ..] => {
            let error = InputError::new(second, "a second protocol", "one protocol at most");
            return Err(error.into());
        }
    };
    match protocol {
        Some(path) if tables.is_empty() => {
            if let Some(option) = (arguments.columns.first_given())
                .or_else(|| arguments.title.as_ref().map(|_| "--title"))
            {
                let found = format!("the option {option} and no table");
                let expected = "a protocol alone, or the tables of ratings after it";
                return Err(InputError::new(first, found, expected).into());
            }
            if TableProtocol::is_of_tables_only(path) {
                let found = "an analysis without stimuli and sessions, and no table";
                let error = InputError::new(path, found, "the tables of ratings after it");
                let remedy = format!("name the tables: acuity report {} TABLE...", path.display());
                return Err(error.remedy(remedy).into());
            }
            report_of_study(path, arguments)
        }
        _ => {
            let summary = table_report::write(protocol, &tables, arguments)?;
            print(&summary)
        }
    }
}

fn report_of_study(path: &Path, arguments: &ReportArguments) -> anyhow::Result<()> {
    let study = Study::read(path)?;
    let data = arguments.data.of(&study);
    let out = arguments.out.as_deref();
    let predictions = arguments.predictions.as_deref();
    let pilots = if arguments.include_pilot {
        Pilots::Included
    } else {
        Pilots::LeftOut
    };
    write_report(&study, &data, Place { out, predictions }, pilots)
}

/// Where a report goes and which predictions it shows, if not the usual ones.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Place<'a> {
    out: Option<&'a Path>,
    predictions: Option<&'a Path>,
}

/// Writes the report and prints its warnings, its test statistics and, last, its path.
pub(crate) fn write_report(
    study: &Study,
    data: &Path,
    place: Place<'_>,
    pilots: Pilots,
) -> anyhow::Result<()> {
    let usual = Some(default_file(study)).filter(|file| file.is_file());
    let predictions = place.predictions.or(usual.as_deref());
    print(&analysis::report_beside(
        study,
        data,
        place.out,
        pilots,
        predictions,
    )?)
}

fn print(summary: &ReportSummary) -> anyhow::Result<()> {
    for warning in &summary.warnings {
        console::print(format!("warning: {warning}"))?;
    }
    console::print(summary.anova.to_text())?;
    console::print(summary.page.display())?;
    Ok(())
}

pub(crate) fn anova(arguments: &AnovaArguments) -> anyhow::Result<()> {
    if let Some(printed) = &arguments.explain {
        console::print(if arguments.json {
            printed.to_json()
        } else {
            printed.explained()
        })?;
        return Ok(());
    }
    let first = arguments.tables.first().map_or(Path::new(""), |file| file);
    let options = options(arguments);
    let design = design(first, &arguments.columns)?;
    let analysis = TableAnalysis::of_tables(&arguments.tables, &design, &options)?;
    console::print(if arguments.json {
        analysis.to_json()
    } else {
        analysis.to_text()
    })?;
    Ok(())
}

/// The roles of the columns; `table` is only named in the error.
pub(crate) fn design(table: &Path, columns: &Columns) -> Result<Design, InputError> {
    let named = |column: &Option<String>, option: &str, what: &str| {
        column.clone().ok_or_else(|| {
            let found = format!("no column named for {what}");
            InputError::new(table, found, format!("{option} COLUMN"))
        })
    };
    Ok(Design {
        subject: named(&columns.subject, "--subject", "the subject")?,
        rating: named(&columns.rating, "--rating", "the rating")?,
        within: columns.within.clone(),
        between: columns.between.clone(),
        observed: columns.observed.clone(),
        sums_of_squares: columns.sums_of_squares.map(Into::into).unwrap_or_default(),
        missing: columns.missing.map(Into::into).unwrap_or_default(),
        filters: columns.filters.clone(),
        decimal: if columns.decimal_comma {
            Decimal::Comma
        } else {
            Decimal::Point
        },
    })
}

fn options(arguments: &AnovaArguments) -> AnalysisOptions {
    let beside = &arguments.beside;
    AnalysisOptions {
        follow_ups: beside.follow_ups(),
        confidence: beside.confidence,
        n_permutations: (arguments.distribution_free).then_some(beside.permutations),
        asymptote: beside.asymptote.as_ref().map(|text| {
            let (factor, by) = follow_up::place(text);
            AsymptoteOption { factor, by }
        }),
        n_resamples: beside.resamples,
        delta: beside.delta,
        seed: beside.seed,
    }
}
