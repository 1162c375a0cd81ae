//! What would make a conclusion fragile: how each effect fares when one subject is left out, and how many ratings lie
//! at the ends of the scale.
//!
//! Not here: how it is worded (`fragility_section`).

use protocols::{AnalysisPlan, Scale};

use crate::anova::anova;
use crate::apa::LeadingTest;
use crate::{AnovaTable, CellMatrix};

/// With more subjects than this none can matter much, and leaving out each takes long.
const MOST_SUBJECTS: usize = 200;

/// How much a result hangs on single subjects and on the ends of the scale.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Fragility {
    /// For each effect, what happens without each subject; empty with too few or too many of them.
    pub(crate) left_out: Vec<LeftOut>,
    /// The share of the cell means at the lowest and at the highest rating.
    pub(crate) at_ends: [f64; 2],
}

/// One effect in the analyses that each leave out one subject.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LeftOut {
    pub(crate) effect: String,
    /// The smallest and the largest F.
    pub(crate) f: [f64; 2],
    /// The subjects without whom it would be significant if it is not, or the other way round.
    pub(crate) decided_by: Vec<String>,
}

impl Fragility {
    /// Leaves out each subject in turn.
    pub(crate) fn new(
        cells: &CellMatrix,
        table: &AnovaTable,
        plan: &AnalysisPlan,
        scale: Option<Scale>,
    ) -> Self {
        let n = cells.scores.len() as f64;
        let share = |end: i32| {
            let at_end = cells
                .scores
                .iter()
                .filter(|score| **score == f64::from(end));
            at_end.count() as f64 / n
        };
        Self {
            left_out: left_out(cells, table, plan),
            at_ends: scale.map_or([0.0; 2], |scale| [scale.lowest, scale.highest].map(share)),
        }
    }
}

fn left_out(cells: &CellMatrix, table: &AnovaTable, plan: &AnalysisPlan) -> Vec<LeftOut> {
    let n = cells.subjects.len();
    let is_too_few = n <= cells.n_groups() + 1 || cells.group_sizes().contains(&1);
    if is_too_few || n > MOST_SUBJECTS {
        return Vec::new();
    }
    let is_significant = |table: &AnovaTable, effect: &str| {
        let row = table.effect(effect);
        let test = row.and_then(|row| LeadingTest::new(row, plan.correction));
        test.is_some_and(|test| test.p < 1.0 - plan.confidence)
    };
    let without: Vec<AnovaTable> = (0..n)
        .map(|subject| anova(&without(cells, subject), &[], plan.sums_of_squares))
        .collect();
    (table.effects.iter())
        .map(|row| {
            let effect = row.effect.as_str();
            let fs = without.iter().filter_map(|table| table.effect(effect)?.f);
            let ends = fs.fold([f64::INFINITY, 0.0_f64], |[low, high], f| {
                [low.min(f), high.max(f)]
            });
            let now = is_significant(table, effect);
            let changed =
                (0..n).filter(|&subject| is_significant(&without[subject], effect) != now);
            LeftOut {
                effect: row.effect.clone(),
                f: ends,
                decided_by: changed
                    .map(|subject| cells.subjects[subject].clone())
                    .collect(),
            }
        })
        .filter(|left_out| left_out.f[0].is_finite())
        .collect()
}

/// The same cells without one subject.
fn without(cells: &CellMatrix, subject: usize) -> CellMatrix {
    let mut fewer = cells.clone();
    fewer.subjects.remove(subject);
    fewer.groups.remove(subject);
    fewer.scores = cells.scores.clone().remove_row(subject);
    fewer.warnings.clear();
    fewer
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::Observations;

    /// Ratings under a and b of each subject.
    fn cells(ratings: &[(&str, f64, f64)]) -> CellMatrix {
        let mut observations = Observations::new(Path::new("test"), &[], &["way".to_owned()]);
        for (subject, a, b) in ratings {
            observations.push(subject, ["a"], Some(*a));
            observations.push(subject, ["b"], Some(*b));
        }
        CellMatrix::new(&observations).unwrap()
    }

    #[test]
    fn the_subject_on_whom_an_effect_hangs_is_named() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../protocols/meyer-liu-1992.toml");
        let study = protocols::Study::read(&path).unwrap();
        let plan = &study.protocol.analysis;
        let scale = Some(study.protocol.session.scale);
        // Differences 1, 2, 1, 2, 1 and -4: t(5) = .5 / (2.26 / sqrt 6) = .54; without the last, t(4) = 5.72, F = 32.67.
        let cells = cells(&[
            ("1", 4.0, 5.0),
            ("2", 3.0, 5.0),
            ("3", 6.0, 7.0),
            ("4", 5.0, 7.0),
            ("5", 0.0, 1.0),
            ("odd", 10.0, 6.0),
        ]);
        let table = anova(&cells, &[], plan.sums_of_squares);
        let found = Fragility::new(&cells, &table, plan, scale);
        let [way] = found.left_out.as_slice() else {
            panic!("one effect");
        };
        assert_eq!(way.decided_by, ["odd"]);
        // t = mean / (sd / sqrt n) = 1.4 / sqrt(.3 / 5): F = 1.96 / .06.
        assert!((way.f[1] - 1.96 / 0.06).abs() < 1e-9, "{way:?}");
        assert_eq!(found.at_ends, [1.0 / 12.0, 1.0 / 12.0]);
    }
}
