//! `acuity report` of tables: the study that protocol and options make of them.

use std::path::{Path, PathBuf};

use analysis::{Design, ReportSummary, TableStudy, folder_name};
use protocols::{AnalysisPlan, AsymptotePlan, Correction, InputError, TableProtocol};

use crate::analyse;
use crate::analysis_arguments::{Columns, ReportArguments};
use crate::follow_up;

/// Writes the report of `tables`; what the protocol does not say, the options do, and where both do the options count.
pub(crate) fn write(
    protocol: Option<&Path>,
    tables: &[PathBuf],
    arguments: &ReportArguments,
) -> anyhow::Result<ReportSummary> {
    let first = tables.first().map_or(Path::new(""), |table| table);
    if let Some(option) = of_studies(arguments) {
        let found = format!("the option {option}, which is for sessions of this program");
        return Err(InputError::new(first, found, "a report on tables without it").into());
    }
    let study = match protocol {
        Some(path) => with_protocol(first, &TableProtocol::read(path)?, arguments)?,
        None => without_protocol(first, arguments)?,
    };
    let out = match &arguments.out {
        Some(folder) => folder.clone(),
        None => Path::new("reports").join(folder_name(&study.study)?),
    };
    Ok(analysis::report_of_tables(tables, &study, &out)?)
}

fn of_studies(arguments: &ReportArguments) -> Option<&'static str> {
    let given = [
        (arguments.data.is_named(), "--data"),
        (arguments.predictions.is_some(), "--predictions"),
        (arguments.include_pilot, "--include-pilot"),
    ];
    let first = given.into_iter().find(|(is_given, _)| *is_given);
    first.map(|(_, option)| option)
}

fn without_protocol(first: &Path, arguments: &ReportArguments) -> Result<TableStudy, InputError> {
    let design = analyse::design(first, &arguments.columns)?;
    let beside = &arguments.beside;
    let plan = AnalysisPlan {
        within: design.within.clone(),
        between: design.between.clone(),
        exclude: Vec::new(),
        sums_of_squares: design.sums_of_squares,
        missing: design.missing,
        correction: (arguments.correction).map_or(Correction::GreenhouseGeisser, Into::into),
        confidence: beside.confidence,
        follow_ups: beside.follow_ups(),
        asymptote: beside.asymptote.as_ref().map(|text| {
            let (factor, by) = follow_up::place(text);
            AsymptotePlan {
                factor,
                by,
                delta: beside.delta,
                resamples: beside.resamples,
            }
        }),
        permutations: beside.permutations,
        seed: beside.seed,
        published: Vec::new(),
    };
    let name = first.file_name().unwrap_or_default().to_string_lossy();
    let stem = first.file_stem().unwrap_or_default().to_string_lossy();
    let title = || format!("Analysis of {name}");
    Ok(TableStudy {
        study: stem.into_owned(),
        title: arguments.title.clone().unwrap_or_else(title),
        source: String::new(),
        design,
        plan,
        scale: arguments.scale,
        protocol: None,
    })
}

fn with_protocol(
    first: &Path,
    protocol: &TableProtocol,
    arguments: &ReportArguments,
) -> Result<TableStudy, InputError> {
    let (columns, table, plan) = (&arguments.columns, &protocol.table, &protocol.analysis);
    let beside = &arguments.beside;
    let stated = [
        (!columns.within.is_empty(), "--within"),
        (!columns.between.is_empty(), "--between"),
        (columns.sums_of_squares.is_some(), "--type"),
        (columns.missing.is_some(), "--missing"),
        (arguments.correction.is_some(), "--correction"),
        (
            !beside.follow_ups().is_empty(),
            "--simple, --pairwise, --control, --trends or --contrast",
        ),
        (beside.asymptote.is_some(), "--asymptote"),
    ];
    if let Some((_, option)) = stated.into_iter().find(|(is_given, _)| *is_given) {
        let found = format!("the option {option} beside a protocol");
        let expected = "the analysis in [analysis] alone, so that the file says what was done";
        return Err(InputError::new(&protocol.path, found, expected));
    }
    let mut filters = columns.filters.clone();
    for filter in &table.filters {
        let read = filter.parse().map_err(|error: String| {
            InputError::new(&protocol.path, error, "rows to keep").at("field table.where")
        });
        filters.push(read?);
    }
    let or =
        |named: &Option<String>, stated: &Option<String>| named.clone().or_else(|| stated.clone());
    let named = Columns {
        subject: or(&columns.subject, &table.subject),
        rating: or(&columns.rating, &table.rating),
        filters,
        decimal_comma: columns.decimal_comma,
        within: plan.within.clone(),
        between: plan.between.clone(),
        observed: if columns.observed.is_empty() {
            table.observed.clone()
        } else {
            columns.observed.clone()
        },
        sums_of_squares: None,
        missing: None,
    };
    Ok(TableStudy {
        study: protocol.study.clone(),
        title: arguments.title.as_ref().unwrap_or(&protocol.title).clone(),
        source: protocol.source.clone(),
        design: Design {
            sums_of_squares: plan.sums_of_squares,
            missing: plan.missing,
            ..analyse::design(first, &named)?
        },
        plan: plan.clone(),
        scale: arguments.scale.or(table.scale),
        protocol: Some((protocol.path.clone(), protocol.sha256.clone())),
    })
}
