//! The section of a report that says whether the observers can be trusted: agreement, screens, bias, drift.

use protocols::rating::RatingRow;

use crate::apa;
use crate::document::{Block, Section, Table};
use crate::figure::Palette;
use crate::findings::Findings;
use crate::fragility_section::FEWEST_OBSERVERS;
use crate::interval::{mean, standard_deviation};
use crate::observer_figure::ObserverFigure;
use crate::page::escaped;
use crate::screening::{ObserverScreening, correlation};
use crate::sections::Sections;
use crate::study_analysis::opinion_score;
use crate::tail::{f_tail, t_quantile};

impl Findings<'_> {
    /// How the observers agree; `drifts` are how they changed over the session, one for each or none at all.
    pub(crate) fn agreement(&self, drifts: &[Drift]) -> Option<Section> {
        let screening = self.observers?;
        let columns = [
            "Observer",
            "above, below",
            "BT.500",
            "<i>r</i>",
            "BT.1788",
            "bias",
            "inconsistency",
            "change over the session",
            "slower or faster (<i>r</i>)",
        ];
        let caption = "Each observer beside the others. Above, below: ratings far from the mean opinion (BT.500); <i>r</i>: the \
                       smaller of Pearson’s and Spearman’s correlation with the mean opinions (BT.1788); bias and inconsistency by the \
                       model of P.910, Annex E.";
        let shown = if drifts.is_empty() { 7 } else { columns.len() };
        let mut table = Table::new(caption, &columns[..shown]);
        for index in 0..screening.observers.len() {
            let mut cells = observer_cells(screening, index);
            cells.extend(drifts.get(index).into_iter().flat_map(Drift::cells));
            table.row(&cells);
        }
        let section = Section::new("Can the observers be trusted?");
        let section = section.paragraph(self.trust_in_words(screening, drifts));
        let of_drift = if drifts.is_empty() {
            ""
        } else {
            " The change over the session is the slope of the ratings, less mean opinion and bias, from the first trial to the \
             last; slower or faster is the correlation of the logarithm of the answer time with the trial."
        };
        let section = section.table(table);
        let section = match self.observer_figure(Palette::PAGE) {
            Some(figure) => section.block(curves(&figure)),
            None => section,
        };
        Some(section.note(format!(
            "Both screens are reported; neither was applied: every observer above is in every result. Against random, inverted, \
             constant and half-shuffled ratings the correlation screen finds nearly all and the kurtosis screen few, so it is the \
             one to act on.{of_drift}"
        )))
    }

    fn trust_in_words(&self, screening: &ObserverScreening, drifts: &[Drift]) -> String {
        let n = screening.observers.len();
        let mut sentences = Vec::new();
        if n < FEWEST_OBSERVERS {
            sentences.push(format!(
                "With {n} observers the study is informal by BT.500, which asks for at least {FEWEST_OBSERVERS}."
            ));
        }
        if let Some(icc) = screening.intraclass {
            sentences.push(format!(
                "One observer’s ratings agree with the others’ with ICC(2,1) = {}, the mean of all {n} with ICC(2,k) = {}; up to a \
                 bias of each observer ICC(3,1) = {}.",
                apa::fraction(icc.single, 2),
                apa::fraction(icc.of_mean, 2),
                apa::fraction(icc.single_consistency, 2)
            ));
        }
        let widths: Vec<f64> = screening
            .opinions
            .iter()
            .map(|one| one.half_bt500)
            .collect();
        let widths_t: Vec<f64> = screening.opinions.iter().map(|one| one.half_t).collect();
        sentences.push(format!(
            "A mean opinion is known within ± {:.2} on average as BT.500 counts (1.96 standard errors), ± {:.2} by <i>t</i>.",
            mean(&widths),
            mean(&widths_t)
        ));
        let changes: Vec<f64> = drifts.iter().filter_map(|drift| drift.rating).collect();
        if let Some(sd) = standard_deviation(&changes).filter(|sd| *sd > 0.0) {
            let (count, change) = (changes.len() as f64, mean(&changes));
            let error = sd / count.sqrt();
            let half = t_quantile((1.0 - self.plan.confidence) / 2.0, count - 1.0) * error;
            sentences.push(format!(
                "From the first trial to the last the ratings changed by {} on average, {} CI [{}, {}], {}.",
                apa::signed(change, 2),
                self.percent(),
                apa::signed(change - half, 2),
                apa::signed(change + half, 2),
                apa::p_in_html(f_tail((change / error).powi(2), 1.0, count - 1.0))
            ));
        }
        sentences.join(" ")
    }
}

impl Sections<'_> {
    /// How the observers agree, and how each changed over the session.
    pub(crate) fn observers(&self) -> Option<Section> {
        let drifts = self.drifts(self.analysis.observers.as_ref()?);
        self.findings().agreement(&drifts)
    }

    /// How each observer changed over the session.
    fn drifts(&self, screening: &ObserverScreening) -> Vec<Drift> {
        let opinions = &self.analysis.opinions;
        (screening.observers.iter())
            .map(|observer| {
                let mut rows: Vec<&RatingRow> = (self.ratings.rows.iter())
                    .filter(|row| row.subject_id.to_string() == observer.subject)
                    .collect();
                rows.sort_by_key(|row| (row.session_id, row.trial_id));
                let residuals: Vec<f64> = (rows.iter())
                    .map(|row| {
                        let opinion = opinions.get(&row.stimulus_id).copied().unwrap_or(0.0);
                        opinion_score(row) - opinion - observer.bias
                    })
                    .collect();
                let ln_times: Vec<f64> = (rows.iter())
                    .map(|row| libm::log(row.response_time_s.max(1e-3)))
                    .collect();
                Drift::new(&residuals, &ln_times)
            })
            .collect()
    }
}

/// The curves of each observer as a figure.
fn curves(figure: &ObserverFigure<'_>) -> Block {
    let by = figure.by().map_or_else(String::new, |by| {
        format!(", a line for each level of {}", escaped(by))
    });
    Block::Figure {
        svg: figure.to_svg(),
        file: "observers".to_owned(),
        caption: format!(
            "Each observer’s ratings along {}{by}; the broad grey lines are the means of all.",
            escaped(figure.factor())
        ),
    }
}

fn observer_cells(screening: &ObserverScreening, index: usize) -> Vec<String> {
    let (one, model) = (&screening.observers[index], &screening.model);
    let verdict = |is_rejected| {
        let text = if is_rejected {
            "<b>would reject</b>"
        } else {
            "keeps"
        };
        text.to_owned()
    };
    let [low, high] = model.inconsistency_ends[index];
    vec![
        escaped(&one.subject),
        format!("{}, {}", one.n_above, one.n_below),
        verdict(one.is_rejected_by_bt500),
        or(one.correlation, "constant"),
        verdict(one.is_rejected_by_bt1788),
        format!(
            "{} ± {:.2}",
            apa::signed(model.bias[index], 2),
            model.bias_half[index]
        ),
        format!("{:.2} [{low:.2}, {high:.2}]", model.inconsistency[index]),
    ]
}

fn or(value: Option<f64>, none: &str) -> String {
    value.map_or_else(|| none.to_owned(), |value| apa::signed(value, 2))
}

/// How one observer changed from the first trial to the last.
pub(crate) struct Drift {
    /// The change of the ratings; `None` with fewer than three.
    rating: Option<f64>,
    /// The correlation of the logarithm of the answer time with the trial.
    time: Option<f64>,
}

impl Drift {
    fn cells(&self) -> [String; 2] {
        [or(self.rating, "–"), or(self.time, "–")]
    }

    fn new(residuals: &[f64], ln_times: &[f64]) -> Self {
        let n = residuals.len();
        let trials: Vec<f64> = (0..n).map(|trial| trial as f64).collect();
        let spread = standard_deviation(&trials).zip(standard_deviation(residuals));
        let slope = correlation(&trials, residuals)
            .zip(spread)
            .map(|(r, (of_trials, of_ratings))| r * of_ratings / of_trials);
        Self {
            rating: slope
                .filter(|_| n > 2)
                .map(|slope| slope * (n as f64 - 1.0)),
            time: correlation(&trials, ln_times).filter(|_| n > 2),
        }
    }
}
