//! Families of tests that follow an analysis of variance: simple effects, pairs of levels, levels against a
//! control, trends, contrasts of one's own.

use protocols::{FollowUpPlan, InputError, SumsOfSquares};
use serde::Serialize;

use crate::anova::anova;
use crate::anova_table::EffectRow;
use crate::apa::decimals_for;
use crate::cell_matrix::CellMatrix;
use crate::comparison::Comparison;
use crate::factor_place::FactorPlace;
use crate::p_adjustment::{bonferroni, holm};
use crate::polynomial::{orthogonal_polynomials, scores_of_levels};
use crate::studentized_range::studentized_range_tail;
use crate::text_table::{TextTable, decimals, optional_p};

/// One family of tests.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FollowUp {
    /// What was asked.
    pub plan: FollowUpPlan,
    /// What it is, in words.
    pub title: String,
    /// The effect of the factor at each level of the other; for simple effects.
    pub simple_effects: Vec<SimpleEffect>,
    /// The comparisons, for all other kinds.
    pub comparisons: Vec<Comparison>,
    /// What the reader must know.
    pub warnings: Vec<String>,
}

/// The effect of a factor at one level of another.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SimpleEffect {
    /// The level.
    pub at: String,
    /// The effect there, as an analysis of variance of these ratings alone has it.
    pub effect: EffectRow,
    /// The Greenhouse–Geisser p (the plain p between subjects) after Holm, over all levels.
    pub p_holm: Option<f64>,
}

/// What all follow-ups of one analysis share.
#[derive(Clone, Copy, Debug)]
pub struct FollowUpSettings {
    /// The confidence level of the intervals.
    pub confidence: f64,
    /// The type of the sums of squares.
    pub sums_of_squares: SumsOfSquares,
}

impl FollowUp {
    /// Answers `plan` on `cells`.
    ///
    /// # Errors
    ///
    /// A factor, level or control that the cells do not have, weights that do not sum to zero, more degrees than
    /// levels allow. The error names no file; the caller adds it.
    pub fn new(
        plan: &FollowUpPlan,
        cells: &CellMatrix,
        settings: FollowUpSettings,
    ) -> Result<Self, InputError> {
        let mut family = Self {
            plan: plan.clone(),
            title: title(plan),
            simple_effects: Vec::new(),
            comparisons: Vec::new(),
            warnings: Vec::new(),
        };
        let at = plan
            .at()
            .map(|at| FactorPlace::find(cells, at))
            .transpose()?;
        if plan.at() == Some(plan.factor()) {
            let found = format!("the factor {} at its own levels", plan.factor());
            return Err(FactorPlace::error(cells, found, "two different factors"));
        }
        match plan {
            FollowUpPlan::SimpleEffects { .. } => family.add_simple_effects(cells, settings)?,
            FollowUpPlan::Trends { degrees, .. } => {
                family.add_trends(cells, *degrees, settings.confidence)?;
            }
            _ if family.has_error_term(cells, None) => {
                let contrasts = level_contrasts(plan, cells)?;
                let n_levels = at.map_or(1, |at| at.levels(cells).len());
                for level in 0..n_levels {
                    let place = at.map(|at| (at, level));
                    family.compare(cells, place, &contrasts, settings.confidence)?;
                }
            }
            _ => {}
        }
        family.adjust();
        Ok(family)
    }

    /// Contrasts of the levels of the factor, at one level of another where one is named. The error is that of
    /// all groups.
    fn compare(
        &mut self,
        cells: &CellMatrix,
        place: Option<(FactorPlace, usize)>,
        contrasts: &[LevelContrast],
        confidence: f64,
    ) -> Result<(), InputError> {
        let factor = FactorPlace::find(cells, self.plan.factor())?;
        let n_levels = factor.levels(cells).len();
        let weights_of = |of_levels: &[f64]| {
            let mut weights = factor.weights(cells, of_levels);
            if let Some((at, level)) = place {
                at.restrict(cells, &mut weights, level);
            }
            weights
        };
        for contrast in contrasts {
            let weights = weights_of(&contrast.weights);
            let mut one = Comparison::new(contrast.name.clone(), cells, &weights, confidence);
            if let (true, Some(pair)) = (factor.is_within(), contrast.pair) {
                let sds = pair.map(|level| {
                    let mut of_level = vec![0.0; n_levels];
                    of_level[level] = 1.0;
                    cells.sd_within_groups(&weights_of(&of_level).cells)
                });
                one = one.with_average_sd(sds);
            }
            if matches!(self.plan, FollowUpPlan::Pairwise { .. }) {
                let q = one.t.map(|t| t.abs() * std::f64::consts::SQRT_2);
                one.p_tukey = q.map(|q| studentized_range_tail(q, n_levels, one.df as f64));
            }
            one.at = place.map(|(at, level)| at.levels(cells)[level].clone());
            self.comparisons.push(one);
        }
        Ok(())
    }

    fn has_error_term(&mut self, cells: &CellMatrix, level: Option<&str>) -> bool {
        let has = cells.subjects.len() > cells.n_groups();
        if !has {
            self.warnings.push(format!(
                "at {}: too few subjects for an error term, so there is no test",
                level.unwrap_or("all levels")
            ));
        }
        has
    }

    fn add_simple_effects(
        &mut self,
        cells: &CellMatrix,
        settings: FollowUpSettings,
    ) -> Result<(), InputError> {
        let factor = self.plan.factor().to_owned();
        FactorPlace::find(cells, &factor)?;
        let at = FactorPlace::find(cells, self.plan.at().unwrap_or_default())?;
        for (place, level) in at.levels(cells).iter().cloned().enumerate() {
            let cells = at.restricted(cells, place);
            if !self.has_error_term(&cells, Some(&level)) {
                continue;
            }
            let table = anova(&cells, &[], settings.sums_of_squares);
            if let Some(effect) = table.effect(&factor) {
                self.simple_effects.push(SimpleEffect {
                    at: level,
                    effect: effect.clone(),
                    p_holm: None,
                });
            }
        }
        Ok(())
    }

    /// Trends over all other cells, and the difference of each trend between the levels of a within factor with
    /// two.
    fn add_trends(
        &mut self,
        cells: &CellMatrix,
        degrees: Option<usize>,
        confidence: f64,
    ) -> Result<(), InputError> {
        let factor = FactorPlace::find(cells, self.plan.factor())?;
        let levels = factor.levels(cells);
        let degrees = degrees.unwrap_or_else(|| (levels.len() - 1).min(3));
        if degrees == 0 || degrees >= levels.len() {
            return Err(FactorPlace::error(
                cells,
                format!("trends up to degree {degrees}"),
                format!("1 to {}, for {} levels", levels.len() - 1, levels.len()),
            ));
        }
        let scores = scores_of_levels(levels).unwrap_or_else(|| {
            self.warnings.push(format!(
                "the levels of {} are not numbers of one unit, so they count as equally spaced",
                factor.name(cells)
            ));
            (1..=levels.len()).map(|place| place as f64).collect()
        });
        let polynomials = orthogonal_polynomials(&scores, degrees);
        let others = (cells.within.iter()).filter(|other| other.name != self.plan.factor());
        let pairs = others.filter(|other| other.levels.len() == 2);
        let pairs: Vec<Option<&str>> = std::iter::once(None)
            .chain(pairs.map(|other| Some(other.name.as_str())))
            .collect();
        for by in pairs {
            for (degree, polynomial) in polynomials.iter().enumerate() {
                let mut weights = factor.weights(cells, polynomial);
                let mut name = trend_name(degree + 1);
                if let Some(by) = by {
                    let by = FactorPlace::find(cells, by)?;
                    let sign = by.weights(cells, &[1.0, -1.0]).cells;
                    weights
                        .cells
                        .component_mul_assign(&sign.map(|sign| 2.0 * sign.signum()));
                    let [first, second] = [0, 1].map(|level| &by.levels(cells)[level]);
                    name = format!("{name}: {first} - {second}");
                }
                let trend = Comparison::new(name, cells, &weights, confidence);
                self.comparisons.push(trend);
            }
        }
        Ok(())
    }

    fn adjust(&mut self) {
        let p_values: Vec<Option<f64>> = self.comparisons.iter().map(|one| one.p).collect();
        let adjusted = holm(&p_values).into_iter().zip(bonferroni(&p_values));
        for (one, (holm, bonferroni)) in self.comparisons.iter_mut().zip(adjusted) {
            (one.p_holm, one.p_bonferroni) = (holm, bonferroni);
        }
        let p_values: Vec<Option<f64>> = (self.simple_effects.iter())
            .map(|one| one.effect.p_gg.or(one.effect.p))
            .collect();
        for (one, holm) in self.simple_effects.iter_mut().zip(holm(&p_values)) {
            one.p_holm = holm;
        }
    }
}

/// Weights of the levels of a factor.
struct LevelContrast {
    name: String,
    weights: Vec<f64>,
    /// The two levels compared, where there are two.
    pair: Option<[usize; 2]>,
}

fn level_contrasts(
    plan: &FollowUpPlan,
    cells: &CellMatrix,
) -> Result<Vec<LevelContrast>, InputError> {
    let factor = FactorPlace::find(cells, plan.factor())?;
    let levels = factor.levels(cells);
    let difference = |plus: usize, minus: usize| {
        let mut weights = vec![0.0; levels.len()];
        (weights[plus], weights[minus]) = (1.0, -1.0);
        LevelContrast {
            name: format!("{} - {}", levels[plus], levels[minus]),
            weights,
            pair: Some([plus, minus]),
        }
    };
    match plan {
        FollowUpPlan::AgainstControl { control, .. } => {
            let control = factor.level(cells, control)?;
            let others = (0..levels.len()).filter(|&level| level != control);
            Ok(others.map(|level| difference(level, control)).collect())
        }
        FollowUpPlan::Contrast { name, weights, .. } => {
            let mut of_levels = vec![0.0; levels.len()];
            for (level, weight) in weights {
                of_levels[factor.level(cells, level)?] = *weight;
            }
            let largest = of_levels.iter().fold(0.0_f64, |most, w| most.max(w.abs()));
            let sum: f64 = of_levels.iter().sum();
            if !sum.is_finite() || largest == 0.0 || sum.abs() > 1e-9 * largest {
                let found = format!("the contrast {name:?} whose weights sum to {sum}");
                return Err(FactorPlace::error(
                    cells,
                    found,
                    "weights that sum to zero, not all zero",
                ));
            }
            Ok(vec![LevelContrast {
                name: name.clone(),
                weights: of_levels,
                pair: None,
            }])
        }
        _ => Ok((0..levels.len())
            .flat_map(|plus| (plus + 1..levels.len()).map(move |minus| (plus, minus)))
            .map(|(plus, minus)| difference(plus, minus))
            .collect()),
    }
}

fn trend_name(degree: usize) -> String {
    match degree {
        1 => "linear".to_owned(),
        2 => "quadratic".to_owned(),
        3 => "cubic".to_owned(),
        _ => format!("degree {degree}"),
    }
}

fn title(plan: &FollowUpPlan) -> String {
    let factor = plan.factor();
    let at = plan
        .at()
        .map_or_else(String::new, |at| format!(" at each level of {at}"));
    match plan {
        FollowUpPlan::SimpleEffects { .. } => format!("Effect of {factor}{at}"),
        FollowUpPlan::Pairwise { .. } => format!("Pairs of levels of {factor}{at}"),
        FollowUpPlan::AgainstControl { control, .. } => {
            format!("Levels of {factor} against {control}{at}")
        }
        FollowUpPlan::Trends { .. } => format!("Trends over {factor}"),
        FollowUpPlan::Contrast { name, .. } => format!("Contrast {name} of {factor}{at}"),
    }
}

impl FollowUp {
    /// The family as text for a terminal.
    pub(crate) fn to_text(&self) -> String {
        let mut text = format!("{}\n", self.title);
        if !self.simple_effects.is_empty() {
            let mut table =
                TextTable::new(&["at", "df", "F", "p", "GG eps", "p (GG)", "Holm", "pes"]);
            for SimpleEffect { at, effect, p_holm } in &self.simple_effects {
                table.row(&[
                    at.clone(),
                    format!("{}, {}", effect.df_num, effect.df_den),
                    decimals(effect.f, 2),
                    optional_p(effect.p),
                    decimals(effect.gg_epsilon, 3),
                    optional_p(effect.p_gg.or(effect.p)),
                    optional_p(*p_holm),
                    decimals(effect.pes, 3),
                ]);
            }
            text.push_str(&table.to_text());
        }
        if !self.comparisons.is_empty() {
            let mut table = TextTable::new(&[
                "comparison",
                "estimate",
                "low",
                "high",
                "t",
                "df",
                "p",
                "Holm",
                "Bonferroni",
                "Tukey",
                "dz",
                "low",
                "high",
                "dav",
            ]);
            let errors = self.comparisons.iter().map(|one| one.se);
            let n_decimals = decimals_for(errors, 3);
            for one in &self.comparisons {
                table.row(&one.text_fields(n_decimals));
            }
            text.push_str(&table.to_text());
        }
        for warning in &self.warnings {
            text.push_str("- ");
            text.push_str(warning);
            text.push('\n');
        }
        text
    }
}
