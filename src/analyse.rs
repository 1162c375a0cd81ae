//! `acuity report` and `anova`: from ratings to an analysis of variance.

use std::path::Path;

use analysis::{AnalysisOptions, AsymptoteOption, Design, Pilots, TableAnalysis};
use protocols::Study;

use crate::command_line::{AnovaArguments, BesideAnova, ReportArguments};
use crate::console;
use crate::follow_up;
use crate::predict::default_file;

pub(crate) fn report(arguments: &ReportArguments) -> anyhow::Result<()> {
    let study = Study::read(&arguments.protocol)?;
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
    let summary = analysis::report_beside(study, data, place.out, pilots, predictions)?;
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
    let (Some(subject), Some(rating)) = (&arguments.subject, &arguments.rating) else {
        anyhow::bail!("a table, --subject and --rating are needed");
    };
    let design = Design {
        subject: subject.clone(),
        rating: rating.clone(),
        within: arguments.within.clone(),
        between: arguments.between.clone(),
        observed: arguments.observed.clone(),
        sums_of_squares: arguments.sums_of_squares.into(),
        missing: arguments.missing.into(),
        filters: arguments.filters.clone(),
    };
    let analysis =
        TableAnalysis::of_tables(&arguments.tables, &design, &options(&arguments.beside))?;
    console::print(if arguments.json {
        analysis.to_json()
    } else {
        analysis.to_text()
    })?;
    Ok(())
}

fn options(beside: &BesideAnova) -> AnalysisOptions {
    let follow_ups = [
        &beside.simple,
        &beside.pairwise,
        &beside.control,
        &beside.trends,
        &beside.contrast,
    ];
    AnalysisOptions {
        follow_ups: follow_ups.into_iter().flatten().cloned().collect(),
        confidence: beside.confidence,
        n_permutations: beside.distribution_free.then_some(beside.permutations),
        asymptote: beside.asymptote.as_ref().map(|text| {
            let (factor, by) = follow_up::place(text);
            AsymptoteOption { factor, by }
        }),
        n_resamples: beside.resamples,
        delta: beside.delta,
        seed: beside.seed,
    }
}
