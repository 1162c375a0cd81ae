//! Statistics as the *Publication Manual* of the APA (7th ed., section 6) writes them.

use crate::EffectRow;
use protocols::Correction;

/// `p < .001`, `p = .023`: three decimals, no leading zero.
///
/// ```text
/// 1.7e-41 -> p < .001      .0234 -> p = .023      .9996 -> p > .999
/// ```
pub(crate) fn p_value(p: f64) -> String {
    if p < 0.001 {
        "p < .001".to_owned()
    } else if p > 0.999 {
        "p > .999".to_owned()
    } else {
        format!("p = {}", fraction(p, 3))
    }
}

/// A number that cannot exceed 1, without its leading zero.
pub(crate) fn fraction(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix("0.") {
        Some(rest) => format!(".{rest}"),
        None => text,
    }
}

/// Degrees of freedom: whole as they are, fractions with two decimals.
pub(crate) fn degrees_of_freedom(df: f64) -> String {
    if df.fract() == 0.0 {
        format!("{df:.0}")
    } else {
        format!("{df:.2}")
    }
}

/// How many decimals show differences as small as the smallest of `spreads`: `least`, or more in small units.
pub(crate) fn decimals_for(spreads: impl Iterator<Item = f64>, least: usize) -> usize {
    let smallest = spreads
        .filter(|&spread| spread > 0.0)
        .fold(f64::INFINITY, f64::min);
    let (mut decimals, mut unit) = (0, 1.0);
    while smallest < 10.0 * unit && decimals < 12 {
        decimals += 1;
        unit /= 10.0;
    }
    // Two digits of the smallest spread; on a scale of whole ratings that is no more than `least`.
    if smallest < 0.02 { decimals } else { least }
}

/// A number with a true minus sign.
pub(crate) fn signed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.bytes().any(|digit| (b'1'..=b'9').contains(&digit)) => {
            format!("−{digits}")
        }
        Some(digits) => digits.to_owned(),
        None => text,
    }
}

/// An effect's test as the report leads with it: the epsilon that multiplies both degrees of freedom (1
/// without correction), and the p value that goes with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LeadingTest {
    pub(crate) epsilon: f64,
    pub(crate) p: f64,
}

impl LeadingTest {
    /// The test of `row` under `correction`; `None` where F or the epsilon does not exist.
    pub(crate) fn new(row: &EffectRow, correction: Correction) -> Option<Self> {
        let (epsilon, p) = match correction {
            Correction::None => (Some(1.0), row.p),
            Correction::GreenhouseGeisser => (row.gg_epsilon, row.p_gg),
            Correction::HuynhFeldt => (row.hf_epsilon.map(|epsilon| epsilon.min(1.0)), row.p_hf),
            Correction::ChiMuller => {
                let held = |epsilon: f64| Some(epsilon.max(row.lb_epsilon?).min(1.0));
                (row.cm_epsilon.and_then(held), row.p_cm)
            }
        };
        if row.gg_epsilon.is_none() {
            // Between subjects there is nothing to correct.
            return row.p.map(|p| Self { epsilon: 1.0, p });
        }
        epsilon.zip(p).map(|(epsilon, p)| Self { epsilon, p })
    }
}

/// `F(3.14, 34.55) = 51.44, p < .001, η²p = .84`, in HTML; no line breaks at its signs.
pub(crate) fn f_test(row: &EffectRow, correction: Correction) -> String {
    let (Some(test), Some(f)) = (LeadingTest::new(row, correction), row.f) else {
        return "<i>F</i> does not exist".to_owned();
    };
    let df = |df: usize| degrees_of_freedom(df as f64 * test.epsilon);
    let eta = row
        .pes
        .map(|pes| format!(", η²<sub>p</sub>\u{a0}=\u{a0}{}", fraction(pes, 2)))
        .unwrap_or_default();
    format!(
        "<i>F</i>({},\u{a0}{})\u{a0}=\u{a0}{f:.2}, {}{eta}",
        df(row.df_num),
        df(row.df_den),
        p_in_html(test.p)
    )
}

/// A p value with its letter in italics and its sign escaped.
pub(crate) fn p_in_html(p: f64) -> String {
    p_value(p)
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace(' ', "\u{a0}")
        .replacen('p', "<i>p</i>", 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn p_values_are_written_as_the_manual_has_them() {
        // APA Publication Manual, 7th ed., section 6.36: two or three decimals, p < .001, no leading zero.
        assert_eq!(p_value(1.7e-41), "p < .001");
        assert_eq!(p_value(0.0234), "p = .023");
        assert_eq!(p_value(0.9999), "p > .999");
        assert_eq!(fraction(0.837, 2), ".84");
        assert_eq!(fraction(1.0, 2), "1.00");
    }

    #[test]
    fn small_units_have_more_decimals() {
        assert_eq!(decimals_for([1.2, 0.3, 0.0].into_iter(), 2), 2);
        assert_eq!(decimals_for([0.0].into_iter(), 2), 2);
        // .0012 and .0015 differ in the fourth decimal.
        assert_eq!(decimals_for([0.0012, 3.0].into_iter(), 2), 4);
    }

    #[test]
    fn a_minus_is_a_minus_sign_and_zero_has_none() {
        assert_eq!(signed(-2.345, 2), "−2.35");
        assert_eq!(signed(-0.001, 2), "0.00");
        assert_eq!(signed(3.0, 1), "3.0");
    }
}
