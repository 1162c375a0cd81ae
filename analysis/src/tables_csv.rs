//! What follows the analysis of variance as CSV: every number in full, one line for each test.

use std::fmt::Write as _;

use crate::TableAnalysis;
use crate::anova_table::{quoted, shortest};
use crate::comparison::Comparison;

/// The columns of `follow-ups.csv`.
const FOLLOW_UPS: &str = "family,at,name,df_num,df_den,f,epsilon,estimate,se,low,high,t,p,p_holm,p_bonferroni,p_tukey,pes,dz,dz_low,\
dz_high,dav,dav_low,dav_high";

impl TableAnalysis {
    /// Every simple effect and every comparison; of simple effects `epsilon` and `p` are Greenhouse and Geisser's.
    pub(crate) fn follow_ups_csv(&self) -> String {
        let mut csv = format!("{FOLLOW_UPS}\n");
        let number = |value: Option<f64>| value.map(shortest).unwrap_or_default();
        for family in &self.follow_ups {
            let title = quoted(&family.title);
            for one in &family.simple_effects {
                let row = &one.effect;
                // Writing to a `String` cannot fail, here and below.
                _ = writeln!(
                    csv,
                    "{title},{},{},{},{},{},{},,,,,,{},{},,,{},,,,,,",
                    quoted(&one.at),
                    quoted(&row.effect),
                    row.df_num,
                    row.df_den,
                    number(row.f),
                    number(row.gg_epsilon),
                    number(row.p_gg.or(row.p)),
                    number(one.p_holm),
                    number(row.pes)
                );
            }
            for one in &family.comparisons {
                _ = writeln!(csv, "{title},{}", comparison_fields(one).join(","));
            }
        }
        csv
    }

    /// The plateau point of each curve and of their difference; empty below the header where none was sought.
    pub(crate) fn asymptotes_csv(&self) -> String {
        let mut csv = String::from(
            "curve,n,psi,low,high,confidence,level,slope,outcome,lowest_equivalent,unit\n",
        );
        let Some(found) = &self.asymptotes else {
            return csv;
        };
        let confidence = shortest(found.settings.confidence);
        let unit = quoted(&found.unit);
        for curve in &found.curves {
            _ = writeln!(
                csv,
                "{},{},{},{},{},{confidence},{},{},{},{},{unit}",
                quoted(&curve.level),
                curve.n,
                shortest(curve.psi.value),
                shortest(curve.psi.low),
                shortest(curve.psi.high),
                shortest(curve.fit.level),
                shortest(curve.fit.slope),
                quoted(curve.outcome.in_words()),
                shortest(curve.lowest_equivalent)
            );
        }
        if let Some(one) = found.difference {
            let [value, low, high] = [one.value, one.low, one.high].map(shortest);
            _ = writeln!(
                csv,
                "difference,,{value},{low},{high},{confidence},,,,,{unit}"
            );
        }
        csv
    }
}

fn comparison_fields(one: &Comparison) -> Vec<String> {
    let number = |value: Option<f64>| value.map(shortest).unwrap_or_default();
    vec![
        quoted(one.at.as_deref().unwrap_or_default()),
        quoted(&one.name),
        "1".to_owned(),
        one.df.to_string(),
        number(one.t.map(|t| t * t)),
        String::new(),
        shortest(one.estimate),
        shortest(one.se),
        shortest(one.low),
        shortest(one.high),
        number(one.t),
        number(one.p),
        number(one.p_holm),
        number(one.p_bonferroni),
        number(one.p_tukey),
        String::new(),
        number(one.dz),
        number(one.dz_low),
        number(one.dz_high),
        number(one.dav),
        number(one.dav_low),
        number(one.dav_high),
    ]
}
