//! `acuity render` and `figures`: from a protocol to pictures.

use std::num::NonZeroUsize;
use std::path::Path;

use protocols::{Stimuli, Study};
use renderer::{RendererError, Watch};

use crate::command_line::{FiguresArguments, RenderArguments};
use crate::console::{self, Progress};
use crate::interrupt::Interrupt;

pub(crate) fn set(arguments: &RenderArguments, progress: Progress) -> anyhow::Result<()> {
    let study = Study::read(&arguments.protocol)?;
    let out = arguments
        .out
        .clone()
        .unwrap_or_else(|| study.default_stimuli_dir());
    make_set(&study, &out, arguments.threads, progress)
}

/// Makes a stimulus set and prints what it cost; Ctrl-C leaves a checkpoint.
pub(crate) fn make_set(
    study: &Study,
    out: &Path,
    threads: Option<NonZeroUsize>,
    progress: Progress,
) -> anyhow::Result<()> {
    let interrupt = Interrupt::listen()?;
    let made = progress.of_rendering(|told| {
        let watch = Watch::new(told, interrupt.flag());
        make(study, out, threads, &watch)
    })?;
    console::print_warnings(&made.warnings);
    console::print(made.account)?;
    Ok(())
}

/// A stimulus set that was made.
pub(crate) struct Made {
    /// What it cost, in words.
    pub(crate) account: String,
    /// What its scene asked for in vain.
    pub(crate) warnings: Vec<String>,
}

/// Makes the stimulus set of a study, whichever way its images come.
pub(crate) fn make(
    study: &Study,
    out: &Path,
    threads: Option<NonZeroUsize>,
    watch: &Watch<'_>,
) -> Result<Made, RendererError> {
    match &study.protocol.stimuli {
        Stimuli::Rendered(_) => {
            let summary = renderer::render_set(study, out, threads, watch)?;
            Ok(Made {
                account: summary.to_string(),
                warnings: summary.warnings,
            })
        }
        Stimuli::Pictures(pictures) => {
            let summary = renderer::make_picture_set(study, pictures, out, watch)?;
            Ok(Made {
                account: summary.to_string(),
                warnings: Vec::new(),
            })
        }
    }
}

pub(crate) fn figures(arguments: &FiguresArguments) -> anyhow::Result<()> {
    let study = Study::read(&arguments.protocol)?;
    let stimuli = arguments.stimuli.of(&study);
    for path in renderer::draw_figures(&study, &stimuli, &arguments.out)? {
        console::print(path.display())?;
    }
    Ok(())
}
