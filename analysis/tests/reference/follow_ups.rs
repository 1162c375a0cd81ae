//! Follow-ups against R's emmeans and own R code.

use analysis::{Comparison, FollowUp, FollowUpSettings};
use protocols::{FollowUpPlan, SumsOfSquares};
use serde_json::Value;

use crate::case::{
    Case, assert_near, assert_p_near, is_refused, number, own_cases, published_cases,
};

const SETTINGS: FollowUpSettings = FollowUpSettings {
    confidence: 0.95,
    sums_of_squares: SumsOfSquares::TypeThree,
};

fn all_cases() -> impl Iterator<Item = Case> {
    let cases = own_cases().into_iter();
    cases
        .chain(published_cases().into_iter().flatten())
        .filter(|case| !is_refused(case))
}

fn table<'a>(case: &'a Case, path: &[&str]) -> Vec<&'a Value> {
    let value = path.iter().fold(&case.expected, |value, key| &value[*key]);
    value.as_array().into_iter().flatten().collect()
}

fn text(value: &Value) -> String {
    value.as_str().unwrap().to_owned()
}

/// The comparison of the levels `a` and `b`, which our order of levels may have turned round, with its sign.
fn comparison<'a>(family: &'a FollowUp, at: Option<&str>, row: &Value) -> (&'a Comparison, f64) {
    let (a, b) = (text(&row["a"]), text(&row["b"]));
    let find = |name: String| {
        let mut all = family.comparisons.iter();
        all.find(|one| one.name == name && one.at.as_deref() == at)
    };
    find(format!("{a} - {b}"))
        .map(|one| (one, 1.0))
        .or_else(|| find(format!("{b} - {a}")).map(|one| (one, -1.0)))
        .unwrap_or_else(|| panic!("{at:?} {a} - {b}"))
}

fn assert_comparison(what: &str, (found, sign): (&Comparison, f64), row: &Value, tolerance: f64) {
    let near = |key: &str, found: Option<f64>| {
        assert_near(
            &format!("{what}, {key}"),
            found,
            number(&row[key]),
            tolerance,
        );
    };
    let scale = found.estimate.abs().max(found.se);
    let difference = number(&row["difference"]).unwrap();
    assert!(
        (sign * found.estimate - difference).abs() < tolerance * scale,
        "{what}"
    );
    near("se", Some(found.se));
    assert_eq!(found.df as f64, row["df"].as_f64().unwrap(), "{what}");
    if found.estimate.abs() > 1e-9 * scale {
        near("t", found.t.map(|t| sign * t));
    }
    assert_p_near(what, found.p, number(&row["p"]), tolerance);
}

#[test]
fn pairs_of_levels_agree_with_emmeans() {
    let mut n_rows = 0;
    for case in all_cases() {
        let cells = case.cells();
        let factors = case.expected["pairwise"].as_object().into_iter().flatten();
        for (factor, rows) in factors {
            let plan = FollowUpPlan::Pairwise {
                factor: factor.clone(),
                at: None,
            };
            let family = FollowUp::new(&plan, &cells, SETTINGS).unwrap();
            let rows = rows.as_array().unwrap();
            assert_eq!(family.comparisons.len(), rows.len(), "{}", case.id());
            for row in rows {
                let what = format!("{}, {factor}, {} - {}", case.id(), row["a"], row["b"]);
                let (one, sign) = comparison(&family, None, row);
                assert_comparison(&what, (one, sign), row, case.tolerance());
                let (low, high) = if sign > 0.0 {
                    (one.low, one.high)
                } else {
                    (-one.high, -one.low)
                };
                for (found, key) in [(low, "ci_low"), (high, "ci_high")] {
                    let expected = number(&row[key]).unwrap();
                    let scale = one.se.max(one.estimate.abs());
                    assert!((found - expected).abs() < 1e-9 * scale, "{what}, {key}");
                }
                assert_p_near(&what, one.p_holm, number(&row["p_holm"]), 1e-9);
                assert_p_near(&what, one.p_bonferroni, number(&row["p_bonferroni"]), 1e-9);
                // R's ptukey is off by 5e-3 at p = .001, k = 11; ours is held to 1e-9 of forty-digit values elsewhere.
                let expected = number(&row["p_tukey"]);
                if expected.is_some_and(|p| p > 0.01) {
                    assert_near(&what, one.p_tukey, expected, 1e-4);
                }
                n_rows += 1;
            }
        }
    }
    assert!(n_rows > 400, "{n_rows}");
}

#[test]
fn simple_comparisons_agree_with_emmeans() {
    let mut n_rows = 0;
    for case in all_cases() {
        let expected = &case.expected["simple_effects"];
        let rows = table(&case, &["simple_effects", "table"]);
        if rows.is_empty() {
            continue;
        }
        let plan = FollowUpPlan::Pairwise {
            factor: text(&expected["of"]),
            at: Some(text(&expected["at"])),
        };
        let family = FollowUp::new(&plan, &case.cells(), SETTINGS).unwrap();
        assert_eq!(family.comparisons.len(), rows.len(), "{}", case.id());
        for row in rows {
            let level = text(&row["level"]);
            let what = format!("{}, at {level}", case.id());
            let found = comparison(&family, Some(&level), row);
            assert_comparison(&what, found, row, case.tolerance());
            assert_p_near(&what, found.0.p_holm, number(&row["p_holm_all"]), 1e-9);
            n_rows += 1;
        }
    }
    assert!(n_rows >= 13, "{n_rows}");
}

#[test]
fn simple_effects_are_the_analysis_of_variance_of_the_part() {
    let mut n_rows = 0;
    for case in all_cases() {
        for row in table(&case, &["simple_main_effects"]) {
            let plan = FollowUpPlan::SimpleEffects {
                factor: text(&row["factor"]),
                at: text(&row["at"]),
            };
            let family = FollowUp::new(&plan, &case.cells(), SETTINGS).unwrap();
            let level = text(&row["level"]);
            let what = format!("{}, {} at {level}", case.id(), text(&row["factor"]));
            let mut all = family.simple_effects.iter();
            let effect = &all.find(|one| one.at == level).unwrap().effect;
            assert_near(&what, effect.f, number(&row["F"]), 1e-9);
            assert_p_near(&what, effect.p, number(&row["p"]), 1e-9);
            assert_p_near(&what, effect.p_gg.or(effect.p), number(&row["p_gg"]), 1e-9);
            assert_near(
                &what,
                effect.gg_epsilon.or(Some(1.0)),
                number(&row["gg_eps"]),
                1e-9,
            );
            assert_near(&what, effect.pes, number(&row["pes"]), 1e-9);
            n_rows += 1;
        }
    }
    assert!(n_rows > 40, "{n_rows}");
}

#[test]
fn trends_agree_with_r() {
    let mut n_rows = 0;
    for case in all_cases() {
        let rows = table(&case, &["trends_own_error", "table"]);
        let Some(first) = rows.first() else { continue };
        let (factor, _) = first["effect"].as_str().unwrap().split_once('^').unwrap();
        let degrees = rows
            .iter()
            .filter(|row| !row["effect"].as_str().unwrap().contains(':'))
            .count();
        let plan = FollowUpPlan::Trends {
            factor: factor.to_owned(),
            degrees: Some(degrees),
        };
        let family = FollowUp::new(&plan, &case.cells(), SETTINGS).unwrap();
        if case.id() == "indometh_singular" || !family.warnings.is_empty() {
            continue; // Scores that are not those that the levels name.
        }
        for (found, row) in family.comparisons.iter().zip(&rows) {
            let what = format!("{}, {}, {}", case.id(), row["effect"], found.name);
            if number(&row["F"]).is_some_and(|f| f < 1e-20) {
                assert!(found.t.unwrap().abs() < 1e-10, "{what}");
                continue; // Zero but for rounding.
            }
            assert_near(&what, found.t.map(|t| t * t), number(&row["F"]), 1e-8);
            assert_p_near(&what, found.p, number(&row["p"]), 1e-8);
            n_rows += 1;
        }
    }
    assert!(n_rows > 40, "{n_rows}");
}
