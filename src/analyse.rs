//! `acuity report` and `anova`: from ratings to an analysis of variance.

use analysis::Design;

use crate::command_line::AnovaArguments;
use crate::console::Console;

pub(crate) fn anova(arguments: &AnovaArguments, console: &Console) -> anyhow::Result<()> {
    let design = Design {
        subject: arguments.subject.clone(),
        rating: arguments.rating.clone(),
        within: arguments.within.clone(),
        between: arguments.between.clone(),
        observed: arguments.observed.clone(),
    };
    let table = analysis::anova_of_table(&arguments.table, &design)?;
    console.result(&if arguments.json {
        table.to_json()
    } else {
        table.to_text()
    })?;
    Ok(())
}
