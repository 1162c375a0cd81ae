//! The analysis of variance against the numbers of R (afex, car) and own R code; see reference/README.md.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

#[path = "reference/asymptote.rs"]
mod asymptote;
#[path = "reference/case.rs"]
mod case;
#[path = "reference/distribution_free.rs"]
mod distribution_free;
#[path = "reference/follow_ups.rs"]
mod follow_ups;

use analysis::{AnovaTable, EffectRow, anova_of_table, cell_summaries};
use protocols::SumsOfSquares;
use serde_json::Value;

use case::{Case, assert_near, assert_p_near, is_refused, number, own_cases, published_cases};

fn assert_effect(case: &Case, found: &EffectRow, expected: &Value) {
    let what = |field: &str| format!("{}, {}, {field}", case.id(), found.effect);
    let tolerance = case.tolerance();
    assert_eq!(found.effect, expected["effect"].as_str().unwrap());
    assert_eq!(found.df_num as u64, expected["df1"].as_u64().unwrap());
    assert_eq!(found.df_den as u64, expected["df2"].as_u64().unwrap());
    let near = |field: &str, found, key: &str| {
        assert_near(&what(field), found, number(&expected[key]), tolerance);
    };
    near("ss_effect", Some(found.ss_effect), "ss");
    near("ss_error", Some(found.ss_error), "ss_error");
    near("f", found.f, "F");
    near("pes", found.pes, "pes");
    near("ges", found.ges, "ges");
    let is_p_defined = number(&expected["F"]).is_some();
    let p = |key: &str| number(&expected[key]).filter(|_| is_p_defined);
    assert_p_near(
        &what("p"),
        found.p,
        p("p").map(|p| p.max(5e-324)),
        tolerance,
    );
    near("ln_p", found.ln_p, "log_p");
    if expected["n_contrasts"] == 1 {
        let is_within = expected["stratum"] != "between";
        assert_eq!(
            found.gg_epsilon,
            is_within.then_some(1.0),
            "{}",
            what("gg_epsilon")
        );
        assert_eq!(found.p_gg, found.p.filter(|_| is_within));
        assert_eq!(found.mauchly_w, None);
        return;
    }
    assert_sphericity(case, found, expected);
}

fn assert_sphericity(case: &Case, found: &EffectRow, expected: &Value) {
    let what = |field: &str| format!("{}, {}, {field}", case.id(), found.effect);
    let tolerance = case.tolerance();
    let near = |field: &str, found, key: &str| {
        assert_near(&what(field), found, number(&expected[key]), tolerance);
    };
    let is_p_defined = number(&expected["F"]).is_some();
    let p = |key: &str| number(&expected[key]).filter(|_| is_p_defined);
    near("gg_epsilon", found.gg_epsilon, "gg_eps");
    near("hf_epsilon", found.hf_epsilon, "hf_eps");
    near(
        "hf_epsilon_classic",
        found.hf_epsilon_classic,
        "hf_eps_classic",
    );
    near("cm_epsilon", found.cm_epsilon, "cm_eps");
    if found.ss_error > 0.0 {
        near("lb_epsilon", found.lb_epsilon, "lb_eps");
    }
    assert_p_near(
        &what("p_hf_classic"),
        found.p_hf_classic,
        p("p_hf_classic"),
        tolerance,
    );
    assert_p_near(&what("p_cm"), found.p_cm, p("p_cm"), tolerance);
    assert_p_near(&what("p_lb"), found.p_lb, p("p_lb"), tolerance);
    assert_p_near(&what("p_gg"), found.p_gg, p("p_gg"), tolerance);
    assert_p_near(&what("p_hf"), found.p_hf, p("p_hf"), tolerance);
    let is_singular = expected["singular"] == true;
    let w = number(&expected["mauchly_W"]).filter(|_| !is_singular);
    assert_near(&what("mauchly_w"), found.mauchly_w, w, tolerance);
    assert_p_near(
        &what("mauchly_p"),
        found.mauchly_p,
        number(&expected["mauchly_p_car"]),
        tolerance,
    );
}

fn assert_case(case: &Case) {
    if is_refused(case) {
        let error = case.analyse().unwrap_err();
        assert!(error.is_input(), "{}: {error}", case.id());
        return;
    }
    let table = case
        .analyse()
        .unwrap_or_else(|error| panic!("{}: {error}", case.id()));
    let design = &case.expected["design"];
    assert_eq!(
        table.n_subjects as u64,
        design["n_subjects"].as_u64().unwrap(),
        "{}",
        case.id()
    );
    let mut dropped: Vec<&str> = design["dropped_subjects"]
        .as_array()
        .unwrap()
        .iter()
        .map(|name| name.as_str().unwrap())
        .collect();
    dropped.sort_by(|left, right| analysis::natural_order(left, right));
    assert_eq!(table.dropped_subjects, dropped, "{}", case.id());
    let expected = case.rows("anova_type3");
    assert_eq!(table.effects.len(), expected.len(), "{}", case.id());
    for (found, expected) in table.effects.iter().zip(expected) {
        assert_effect(case, found, expected);
    }
    assert_omega_squared(case, &table);
    let mut design_two = case.design();
    design_two.sums_of_squares = SumsOfSquares::TypeTwo;
    let type_two = anova_of_table(&case.table, &design_two).unwrap();
    for (found, expected) in type_two.effects.iter().zip(case.rows("anova_type2")) {
        assert_effect(case, found, expected);
    }
    let json = table.to_json();
    let read: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(
        read["effects"].as_array().unwrap().len(),
        table.effects.len()
    );
    for row in &table.effects {
        assert_every_null_has_its_reason(case.id(), row, &table.warnings);
    }
}

/// R's effectsize 0.8.3, which agrees with JASP.
fn assert_omega_squared(case: &Case, table: &AnovaTable) {
    let rows = case.expected["effectsize"]["table"].as_array();
    for row in rows.into_iter().flatten() {
        let found = table.effect(row["effect"].as_str().unwrap()).unwrap();
        let what = format!("{}, {}, omega2", case.id(), found.effect);
        let expected = number(&row["omega2_partial"]);
        if found.f.is_some() {
            assert_near(&what, found.omega2, expected, case.tolerance());
        }
    }
}

fn assert_every_null_has_its_reason(id: &str, row: &EffectRow, warnings: &[String]) {
    let values = [
        row.f,
        row.p,
        row.gg_epsilon,
        row.p_gg,
        row.hf_epsilon,
        row.mauchly_w,
        row.mauchly_p,
    ];
    if values.contains(&None) {
        let start = format!("{}: ", row.effect);
        let is_said = warnings.iter().any(|warning| warning.starts_with(&start));
        assert!(is_said, "{id}, {}: null without a warning", row.effect);
    }
}

#[test]
fn our_simulated_sets_agree_with_r_to_1e_9() {
    for case in own_cases() {
        assert_case(&case);
    }
}

#[test]
fn published_sets_agree_with_r_to_1e_9() {
    for case in published_cases().into_iter().flatten() {
        assert_case(&case);
    }
}

#[test]
fn what_cannot_be_analysed_is_refused_with_the_reason() {
    let reasons = [
        ("error_empty_between_cell", "u:y"),
        ("error_empty_within_cell", "a2:b3"),
        ("error_one_level", "the factor a"),
        ("error_single_subject", "one complete subject"),
        ("error_subject_in_two_groups", "P1, P2, P3"),
    ];
    let cases = own_cases();
    let refused: Vec<&Case> = cases.iter().filter(|case| is_refused(case)).collect();
    assert_eq!(refused.len(), reasons.len());
    for (case, (id, reason)) in refused.into_iter().zip(reasons) {
        assert_eq!(case.id(), id);
        let message = case.analyse().unwrap_err().to_string();
        assert!(message.contains(reason), "{id}: {message}");
        assert!(message.contains(&format!("{id}.csv")), "{id}: {message}");
    }
}

#[test]
fn duplicates_and_missing_cells_are_said() {
    let table = |id: &str| {
        let cases = own_cases();
        cases
            .iter()
            .find(|case| case.id() == id)
            .unwrap()
            .analyse()
            .unwrap()
    };
    let duplicates = table("edge_duplicates").warnings;
    assert!(
        duplicates[0].contains("rated more than once"),
        "{duplicates:?}"
    );
    let missing = table("edge_missing_cells");
    assert_eq!(missing.dropped_subjects, ["S03", "S07"]);
    assert!(
        missing.warnings[0].contains("S03, S07"),
        "{:?}",
        missing.warnings
    );
}

#[test]
fn an_offset_and_a_unit_change_nothing() {
    let cases = own_cases();
    let table = |id: &str| {
        cases
            .iter()
            .find(|case| case.id() == id)
            .unwrap()
            .analyse()
            .unwrap()
    };
    let base = table("edge_offset_base");
    for other in [table("edge_offset_1e7"), table("edge_scale_1e-5")] {
        for (base, other) in base.effects.iter().zip(&other.effects) {
            assert_near("f", other.f, base.f, 1e-7);
            assert_near("p_gg", other.p_gg, base.p_gg, 1e-7);
            assert_near("mauchly_w", other.mauchly_w, base.mauchly_w, 1e-7);
        }
    }
    let natural = table("edge_singular_base_12x13");
    let scaled = table("edge_singular_scale_1e5");
    assert_eq!(natural.effects[0].mauchly_w, None);
    assert_eq!(scaled.effects[0].mauchly_w, None);
    assert_near(
        "gg_epsilon",
        scaled.effects[0].gg_epsilon,
        natural.effects[0].gg_epsilon,
        1e-9,
    );
}

#[test]
fn means_and_intervals_agree_with_afex() {
    let mut n_rows = 0;
    for case in own_cases() {
        let Some(rows) = case.expected["within_subject_ci95"]["table"].as_array() else {
            continue;
        };
        let cells = case.cells();
        let summaries = cell_summaries(&cells, 0.95);
        assert_eq!(summaries.len(), rows.len(), "{}", case.id());
        for summary in &summaries {
            let group = cells.group_levels(summary.group).join(":");
            let names = cells.within.iter().map(|factor| factor.name.as_str());
            let mut key: Vec<(&str, &str)> = names.zip(cells.cell_levels(summary.cell)).collect();
            if !group.is_empty() {
                key.push(("group", &group));
            }
            let is_same = |row: &&Value| key.iter().all(|(name, level)| row[*name] == *level);
            let row = rows.iter().find(is_same);
            let row = row.unwrap_or_else(|| panic!("{}: no row {key:?} in {rows:?}", case.id()));
            let near = |field: &str, found: Option<f64>, expected: &Value| {
                let what = format!("{}, {key:?}, {field}", case.id());
                // A zero interval is zero up to the rounding of the ratings.
                let is_zero = expected.as_f64().is_some_and(|half| half < 1e-12);
                if is_zero {
                    assert!(found.unwrap() < 1e-9, "{what}");
                } else {
                    assert_near(&what, found, number(expected), case.tolerance());
                }
            };
            assert_eq!(summary.n as u64, row["n"].as_u64().unwrap());
            near("mean", Some(summary.mean), &row["mean"]);
            near("between", summary.half_between, &row["ci_half_between"]);
            near(
                "within",
                summary.half_within,
                &row["ci_half_cousineau_morey"],
            );
            n_rows += 1;
        }
    }
    assert!(n_rows > 200, "{n_rows} rows");
}
