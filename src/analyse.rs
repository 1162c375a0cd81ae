//! `acuity report` and `anova`: from ratings to an analysis of variance.

use std::path::Path;

use analysis::{Design, Pilots};
use protocols::Study;

use crate::command_line::{AnovaArguments, ReportArguments};
use crate::console;

pub(crate) fn report(arguments: &ReportArguments) -> anyhow::Result<()> {
    let study = Study::read(&arguments.protocol)?;
    let data = arguments.data.of(&study);
    let pilots = if arguments.include_pilot {
        Pilots::Included
    } else {
        Pilots::LeftOut
    };
    write_report(&study, &data, arguments.out.as_deref(), pilots)
}

/// Writes the report and prints its warnings, its test statistics and, last, its path.
pub(crate) fn write_report(
    study: &Study,
    data: &Path,
    out: Option<&Path>,
    pilots: Pilots,
) -> anyhow::Result<()> {
    let summary = analysis::report(study, data, out, pilots)?;
    for warning in &summary.warnings {
        console::print(format!("warning: {warning}"))?;
    }
    console::print(summary.anova.to_text())?;
    console::print(summary.page.display())?;
    Ok(())
}

pub(crate) fn anova(arguments: &AnovaArguments) -> anyhow::Result<()> {
    let design = Design {
        subject: arguments.subject.clone(),
        rating: arguments.rating.clone(),
        within: arguments.within.clone(),
        between: arguments.between.clone(),
        observed: arguments.observed.clone(),
        sums_of_squares: arguments.sums_of_squares.into(),
        missing: arguments.missing.into(),
    };
    let table = analysis::anova_of_table(&arguments.table, &design)?;
    console::print(if arguments.json {
        table.to_json()
    } else {
        table.to_text()
    })?;
    Ok(())
}
