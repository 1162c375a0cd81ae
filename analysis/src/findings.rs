//! What an analysis found, as the sections of any report speak of it: of a study, or of a table of ratings.

use protocols::{AnalysisPlan, Scale};

use crate::axis::Axis;
use crate::figure::Palette;
use crate::fragility::Fragility;
use crate::observer_figure::ObserverFigure;
use crate::screening::ObserverScreening;
use crate::{CellMatrix, TableAnalysis};

/// With fewer subjects than this a report begins with a warning.
const FEW: usize = 6;

/// An analysis of variance, what follows it, and what the reader must know of those who rated.
#[derive(Clone, Debug)]
pub(crate) struct Findings<'a> {
    pub(crate) plan: &'a AnalysisPlan,
    pub(crate) table: &'a TableAnalysis,
    pub(crate) cells: &'a CellMatrix,
    pub(crate) fragility: &'a Fragility,
    /// How the observers agree, where all rated the same.
    pub(crate) observers: Option<&'a ObserverScreening>,
    pub(crate) n_subjects: usize,
    pub(crate) n_groups: usize,
    /// Who rated, such as `12 subjects`.
    pub(crate) who: String,
    /// The scale of the ratings; `None` for one without ends, or with ends that nobody stated.
    pub(crate) scale: Option<Scale>,
    pub(crate) is_simulated: bool,
    /// Whether all ratings are whole numbers.
    pub(crate) are_whole: bool,
}

impl Findings<'_> {
    /// The files of [`Self::observer_figure`], with the comma after them.
    pub(crate) fn observer_files(&self) -> &'static str {
        match self.observer_figure(Palette::PRINT) {
            Some(_) => "<code>observers.svg</code> and <code>.png</code>, and ",
            None => "and ",
        }
    }

    /// The curves of each observer, where all rated the same and a figure can hold them.
    pub(crate) fn observer_figure(&self, palette: Palette) -> Option<ObserverFigure<'_>> {
        self.observers?;
        ObserverFigure::new(self.cells, self.scale.map(Axis::of_scale), palette)
    }

    /// The banner for few subjects.
    pub(crate) fn too_few(&self) -> Option<String> {
        (self.n_subjects < FEW).then(|| {
            format!(
                "<strong>FEW SUBJECTS.</strong> With {}, every test and interval below has little power and rests on its assumptions.",
                self.who
            )
        })
    }

    /// The confidence level, such as `95%`.
    pub(crate) fn percent(&self) -> String {
        format!("{:.0}%", 100.0 * self.plan.confidence)
    }
}
