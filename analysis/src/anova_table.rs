//! The analysis-of-variance table: one row for each effect, as numbers, JSON, CSV and text.

use std::fmt::Write as _;

use protocols::SumsOfSquares;
use serde::Serialize;

use crate::text_table::{TextTable, decimals, optional_p};

/// An analysis of variance.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AnovaTable {
    /// How many complete subjects it rests on.
    pub n_subjects: usize,
    /// The type of its sums of squares; without between factors, or with equal groups, both are the same.
    #[serde(rename = "type")]
    pub sums_of_squares: SumsOfSquares,
    /// The effects: those between subjects, then those within, smaller sets of factors first.
    pub effects: Vec<EffectRow>,
    /// Subjects left out because a cell is missing.
    pub dropped_subjects: Vec<String>,
    /// How many cells were rated more than once by a subject, and averaged.
    pub n_averaged_cells: usize,
    /// What the reader must know; says why for everything that is `None`.
    pub warnings: Vec<String>,
}

/// One effect. What does not exist is `None`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EffectRow {
    /// Its factors joined by `:`, between factors first.
    pub effect: String,
    /// Degrees of freedom of the numerator, uncorrected.
    pub df_num: usize,
    /// Degrees of freedom of the denominator, uncorrected.
    pub df_den: usize,
    /// Sum of squares of the effect.
    pub ss_effect: f64,
    /// Sum of squares of its error term.
    pub ss_error: f64,
    /// The F value.
    pub f: Option<f64>,
    /// Its p value without correction; 5e-324 where it is smaller than any number.
    pub p: Option<f64>,
    /// The natural logarithm of `p`, exact also where `p` is too small for a number.
    pub ln_p: Option<f64>,
    /// The Greenhouse–Geisser epsilon.
    pub gg_epsilon: Option<f64>,
    /// p with both degrees of freedom multiplied by `gg_epsilon`.
    pub p_gg: Option<f64>,
    /// The Huynh–Feldt epsilon in Lecoutre's form, as it comes out; it may exceed 1.
    pub hf_epsilon: Option<f64>,
    /// p with both degrees of freedom multiplied by `hf_epsilon`, held to [1 / contrasts, 1].
    pub p_hf: Option<f64>,
    /// The Huynh–Feldt epsilon as published in 1976, as it comes out; equal to Lecoutre's without groups.
    pub hf_epsilon_classic: Option<f64>,
    /// p with `hf_epsilon_classic`, held as that of `hf_epsilon`.
    pub p_hf_classic: Option<f64>,
    /// The Chi–Muller epsilon, as it comes out: best calibrated with more contrasts than error degrees of
    /// freedom.
    pub cm_epsilon: Option<f64>,
    /// p with `cm_epsilon`, held likewise.
    pub p_cm: Option<f64>,
    /// The lower bound of epsilon: one over the contrasts of the within factors.
    pub lb_epsilon: Option<f64>,
    /// p with `lb_epsilon`: no covariance makes it larger.
    pub p_lb: Option<f64>,
    /// Partial eta squared.
    pub pes: Option<f64>,
    /// Generalized eta squared.
    pub ges: Option<f64>,
    /// Partial omega squared, never below 0.
    pub omega2: Option<f64>,
    /// Mauchly's W.
    pub mauchly_w: Option<f64>,
    /// Its p value by the chi-square approximation.
    pub mauchly_p: Option<f64>,
    /// Its p value by the law of W, right also with few subjects.
    pub mauchly_p_exact: Option<f64>,
}

impl AnovaTable {
    /// The row of one effect, named by its factors joined by `:`.
    pub fn effect(&self, name: &str) -> Option<&EffectRow> {
        self.effects.iter().find(|row| row.effect == name)
    }

    /// The table as JSON, with a line end.
    pub fn to_json(&self) -> String {
        // A struct of numbers and text cannot fail to be written.
        let mut json = serde_json::to_string_pretty(self).unwrap_or_default();
        json.push('\n');
        json
    }

    /// The effects as CSV with a header; what does not exist is empty.
    pub fn to_csv(&self) -> String {
        let mut csv = String::from("effect,df_num,df_den,ss_effect,ss_error");
        let names = EffectRow::named(None).map(|(name, _)| name);
        // Writing to a `String` cannot fail, here and below.
        _ = writeln!(csv, ",{}", names.join(","));
        for row in &self.effects {
            let numbers = EffectRow::named(Some(row))
                .map(|(_, value)| value.map(shortest).unwrap_or_default());
            _ = writeln!(
                csv,
                "{},{},{},{},{},{}",
                quoted(&row.effect),
                row.df_num,
                row.df_den,
                shortest(row.ss_effect),
                shortest(row.ss_error),
                numbers.join(",")
            );
        }
        csv
    }

    /// The table as text for a terminal: tests and effect sizes, corrections, Mauchly's test, warnings.
    pub fn to_text(&self) -> String {
        let numeral = self.sums_of_squares.numeral();
        let mut text = format!(
            "Analysis of variance, type {numeral}, {} subjects\n\n",
            self.n_subjects
        );
        let mut tests =
            TextTable::new(&["effect", "df", "F", "p", "p (GG)", "pes", "ges", "omega2"]);
        for row in &self.effects {
            tests.row(&row.test_fields());
        }
        text.push_str(&tests.to_text());
        let tested: Vec<&EffectRow> = (self.effects.iter())
            .filter(|row| row.gg_epsilon.is_some_and(|epsilon| epsilon < 1.0))
            .collect();
        if !tested.is_empty() {
            let mut corrections = TextTable::new(&[
                "sphericity",
                "GG",
                "HF",
                "p",
                "HF 1976",
                "p",
                "CM",
                "p",
                "bound",
                "p",
                "W",
                "p",
                "exact p",
            ]);
            for row in tested {
                corrections.row(&row.correction_fields());
            }
            text.push('\n');
            text.push_str(&corrections.to_text());
        }
        text.push('\n');
        for warning in &self.warnings {
            // Writing to a `String` cannot fail.
            _ = writeln!(text, "- {warning}");
        }
        text
    }
}

impl EffectRow {
    /// An effect of which only degrees of freedom and sums of squares (effect, error) are known.
    pub(crate) fn new(effect: String, df: [usize; 2], ss: [f64; 2]) -> Self {
        Self {
            effect,
            df_num: df[0],
            df_den: df[1],
            ss_effect: ss[0],
            ss_error: ss[1],
            f: None,
            p: None,
            ln_p: None,
            gg_epsilon: None,
            p_gg: None,
            hf_epsilon: None,
            p_hf: None,
            hf_epsilon_classic: None,
            p_hf_classic: None,
            cm_epsilon: None,
            p_cm: None,
            lb_epsilon: None,
            p_lb: None,
            pes: None,
            ges: None,
            omega2: None,
            mauchly_w: None,
            mauchly_p: None,
            mauchly_p_exact: None,
        }
    }

    /// Everything that may not exist, by the name of its column; the names alone without a row.
    fn named(row: Option<&Self>) -> [(&'static str, Option<f64>); 19] {
        let of = |value: fn(&Self) -> Option<f64>| row.and_then(value);
        [
            ("f", of(|row| row.f)),
            ("p", of(|row| row.p)),
            ("ln_p", of(|row| row.ln_p)),
            ("gg_epsilon", of(|row| row.gg_epsilon)),
            ("p_gg", of(|row| row.p_gg)),
            ("hf_epsilon", of(|row| row.hf_epsilon)),
            ("p_hf", of(|row| row.p_hf)),
            ("hf_epsilon_classic", of(|row| row.hf_epsilon_classic)),
            ("p_hf_classic", of(|row| row.p_hf_classic)),
            ("cm_epsilon", of(|row| row.cm_epsilon)),
            ("p_cm", of(|row| row.p_cm)),
            ("lb_epsilon", of(|row| row.lb_epsilon)),
            ("p_lb", of(|row| row.p_lb)),
            ("pes", of(|row| row.pes)),
            ("ges", of(|row| row.ges)),
            ("omega2", of(|row| row.omega2)),
            ("mauchly_w", of(|row| row.mauchly_w)),
            ("mauchly_p", of(|row| row.mauchly_p)),
            ("mauchly_p_exact", of(|row| row.mauchly_p_exact)),
        ]
    }

    fn test_fields(&self) -> Vec<String> {
        vec![
            self.effect.clone(),
            format!("{}, {}", self.df_num, self.df_den),
            decimals(self.f, 2),
            optional_p(self.p),
            optional_p(self.p_gg),
            decimals(self.pes, 3),
            decimals(self.ges, 3),
            decimals(self.omega2, 3),
        ]
    }

    fn correction_fields(&self) -> Vec<String> {
        vec![
            self.effect.clone(),
            decimals(self.gg_epsilon, 3),
            decimals(self.hf_epsilon, 3),
            optional_p(self.p_hf),
            decimals(self.hf_epsilon_classic, 3),
            optional_p(self.p_hf_classic),
            decimals(self.cm_epsilon, 3),
            optional_p(self.p_cm),
            decimals(self.lb_epsilon, 3),
            optional_p(self.p_lb),
            decimals(self.mauchly_w, 3),
            optional_p(self.mauchly_p),
            optional_p(self.mauchly_p_exact),
        ]
    }
}

/// The shortest text that reads back as the same number.
pub(crate) fn shortest(value: f64) -> String {
    if value == 0.0 || (1e-5..1e15).contains(&value.abs()) {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

/// A field of CSV, in quotes where it needs them.
pub(crate) fn quoted(field: &str) -> String {
    if field.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field.to_owned()
    }
}
