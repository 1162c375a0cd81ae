//! The analysis-of-variance table: one row for each effect, as numbers, JSON, CSV and text.

use std::fmt::Write as _;

use serde::Serialize;

/// An analysis of variance.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AnovaTable {
    /// How many complete subjects it rests on.
    pub n_subjects: usize,
    /// The effects: those between subjects, then those within, smaller sets of factors first.
    pub effects: Vec<EffectRow>,
    /// Subjects left out because a cell is missing.
    pub dropped_subjects: Vec<String>,
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
    /// Sum of squares of the effect, type III.
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
    /// Partial eta squared.
    pub pes: Option<f64>,
    /// Generalized eta squared.
    pub ges: Option<f64>,
    /// Mauchly's W.
    pub mauchly_w: Option<f64>,
    /// Its p value.
    pub mauchly_p: Option<f64>,
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
        let mut csv = String::from(
            "effect,df_num,df_den,ss_effect,ss_error,f,p,ln_p,gg_epsilon,p_gg,hf_epsilon,p_hf,pes,ges,mauchly_w,mauchly_p\n",
        );
        for row in &self.effects {
            let optional = [
                row.f,
                row.p,
                row.ln_p,
                row.gg_epsilon,
                row.p_gg,
                row.hf_epsilon,
                row.p_hf,
                row.pes,
                row.ges,
                row.mauchly_w,
                row.mauchly_p,
            ];
            let numbers = optional.map(|value| value.map(shortest).unwrap_or_default());
            // Writing to a `String` cannot fail.
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

    /// The table as text for a terminal, with its warnings below.
    pub fn to_text(&self) -> String {
        let header = [
            "effect", "df", "F", "p", "GG eps", "p (GG)", "HF eps", "p (HF)", "pes", "ges", "W",
            "p (W)",
        ];
        let mut lines = vec![header.map(str::to_owned)];
        lines.extend(self.effects.iter().map(EffectRow::text_fields));
        let widths: Vec<usize> = (0..header.len())
            .map(|column| {
                lines
                    .iter()
                    .map(|line| line[column].chars().count())
                    .max()
                    .unwrap_or(0)
            })
            .collect();
        let mut text = String::new();
        for line in &lines {
            let padded = line
                .iter()
                .zip(&widths)
                .enumerate()
                .map(|(column, (field, &width))| {
                    if column == 0 {
                        format!("{field:<width$}")
                    } else {
                        format!("{field:>width$}")
                    }
                });
            text.push_str(padded.collect::<Vec<_>>().join("  ").trim_end());
            text.push('\n');
        }
        _ = writeln!(text, "\n{} subjects", self.n_subjects);
        for warning in &self.warnings {
            _ = writeln!(text, "- {warning}");
        }
        text
    }
}

impl EffectRow {
    fn text_fields(&self) -> [String; 12] {
        let decimals = |value: Option<f64>, places: usize| {
            value.map_or_else(|| "-".to_owned(), |value| format!("{value:.places$}"))
        };
        let p = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), p_text);
        [
            self.effect.clone(),
            format!("{}, {}", self.df_num, self.df_den),
            decimals(self.f, 2),
            p(self.p),
            decimals(self.gg_epsilon, 3),
            p(self.p_gg),
            decimals(self.hf_epsilon, 3),
            p(self.p_hf),
            decimals(self.pes, 3),
            decimals(self.ges, 3),
            decimals(self.mauchly_w, 3),
            p(self.mauchly_p),
        ]
    }
}

/// A p value for a table: four decimals down to .0001, then two digits and an exponent.
pub(crate) fn p_text(p: f64) -> String {
    if p >= 1e-4 {
        format!("{p:.4}")
    } else {
        format!("{p:.1e}")
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
