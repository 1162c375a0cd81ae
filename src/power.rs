//! `acuity power`: how many subjects a study needs, by studies of model observers.

use std::collections::BTreeMap;

use analysis::{PowerDesign, PowerSettings};
use anyhow::Context as _;
use experiment::{ObserverPanel, StimulusSet};
use protocols::{Access, InputError, StimulusId, Study, write_atomically};

use crate::command_line::PowerArguments;
use crate::console::{self, Progress};

/// Prints the table, and writes it with its curves into a folder.
pub(crate) fn power(arguments: &PowerArguments, progress: Progress) -> anyhow::Result<()> {
    let study = Study::read(&arguments.protocol)?;
    let design = PowerDesign::new(&study)?;
    let fewest = design.fewest_subjects();
    let subjects = arguments.subjects.numbers();
    if let Some(few) = subjects.iter().find(|subjects| **subjects < fewest) {
        let expected = format!("at least {fewest}, as this design needs");
        return Err(
            InputError::new(&arguments.protocol, format!("{few} subjects"), expected).into(),
        );
    }
    let set = StimulusSet::read(&study, &arguments.stimuli.of(&study))?;
    let qualities: BTreeMap<StimulusId, f64> = (experiment::qualities(&study, &set)?.into_iter())
        .map(|(id, quality)| (id, quality.on_scale))
        .collect();
    let qualities = design.scaled(&qualities, &arguments.effect)?;
    let panel = ObserverPanel::new(&study, design.images(), &qualities, arguments.seed)?;
    let settings = PowerSettings {
        subjects,
        n_studies: arguments.studies,
        alpha: arguments.alpha,
        target: arguments.target,
        n_resamples: arguments.resamples,
        seed: arguments.seed,
    };
    let power = progress.of("power", |told| {
        analysis::power(
            &design,
            &settings,
            &|study, subject| panel.ratings(study, subject),
            told,
        )
    })?;
    if arguments.json {
        return Ok(console::print(power.to_json().trim_end())?);
    }
    let default = || format!("reports/{}-power", study.protocol.study).into();
    let folder = arguments.out.clone().unwrap_or_else(default);
    let figure = folder.join("power.svg");
    let files = [
        ("power.csv", power.to_csv()),
        ("power.json", power.to_json()),
        ("power.svg", power.to_svg()),
    ];
    for (name, text) in files {
        let file = folder.join(name);
        write_atomically(&file, text.as_bytes(), Access::Owner)
            .with_context(|| format!("cannot write \"{}\"", file.display()))?;
    }
    console::print(power.to_text())?;
    console::print(figure.display())?;
    Ok(())
}
