//! Observers against Netflix's sureal and against published examples; see observers/README.md.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use analysis::ObserverScreening;
use serde_json::Value;

fn sureal() -> (Vec<Vec<Option<f64>>>, Value) {
    let table = include_str!("observers/small_sample_data.csv");
    let ratings = (table.lines())
        .map(|line| {
            let fields = line.split(',');
            fields
                .map(|field| field.parse().ok().filter(|u: &f64| u.is_finite()))
                .collect()
        })
        .collect();
    let golden = include_str!("observers/golden_small_sample_data.json");
    (ratings, serde_json::from_str(golden).unwrap())
}

fn screened(ratings: &[Vec<Option<f64>>]) -> ObserverScreening {
    let subjects = (1..=ratings[0].len()).map(|one| one.to_string()).collect();
    ObserverScreening::new(subjects, ratings, 0.7)
}

fn assert_all_near(what: &str, found: &[f64], expected: &Value, tolerance: f64) {
    let expected = expected.as_array().unwrap();
    assert_eq!(found.len(), expected.len(), "{what}");
    for (place, (found, expected)) in found.iter().zip(expected).enumerate() {
        let expected = expected.as_f64().unwrap();
        assert!(
            (found - expected).abs() <= tolerance * expected.abs().max(1.0),
            "{what} {place}: {found} and {expected}"
        );
    }
}

#[test]
fn opinions_and_screens_agree_with_sureal() {
    let (ratings, golden) = sureal();
    let found = screened(&ratings);
    let of = |f: fn(&analysis::Opinion) -> f64| found.opinions.iter().map(f).collect::<Vec<_>>();
    assert_all_near("mos", &of(|one| one.mean), &golden["mos"], 1e-12);
    assert_all_near("sd", &of(|one| one.sd), &golden["sd"], 1e-12);
    assert_all_near(
        "1.96",
        &of(|one| one.half_bt500),
        &golden["ci95_bt500"],
        1e-12,
    );
    assert_all_near("t", &of(|one| one.half_t), &golden["ci95_t"], 1e-9);
    let expected = &golden["bt500_ddof1"];
    let of = |f: fn(&analysis::Observer) -> u32| -> Vec<f64> {
        found
            .observers
            .iter()
            .map(|one| f64::from(f(one)))
            .collect()
    };
    assert_all_near("P", &of(|one| one.n_above), &expected["P"], 0.0);
    assert_all_near("Q", &of(|one| one.n_below), &expected["Q"], 0.0);
    for (one, reject) in found
        .observers
        .iter()
        .zip(expected["reject"].as_array().unwrap())
    {
        assert_eq!(
            Value::from(one.is_rejected_by_bt500),
            *reject,
            "{}",
            one.subject
        );
    }
}

#[test]
fn bias_and_inconsistency_agree_with_sureal() {
    let (ratings, golden) = sureal();
    let model = screened(&ratings).model;
    let expected = &golden["p910_ap"];
    assert_all_near("quality", &model.quality, &expected["mos_j"], 1e-7);
    assert_all_near("bias", &model.bias, &expected["bias_i"], 1e-7);
    assert_all_near(
        "inconsistency",
        &model.inconsistency,
        &expected["inconsistency_i"],
        1e-7,
    );
    // P.910 Annex E: 1.96 / sqrt of the sum of 1 / inconsistency^2 over those who rated, by sureal's numbers.
    let of_sureal: Vec<f64> = (expected["inconsistency_i"].as_array().unwrap().iter())
        .map(|sd| sd.as_f64().unwrap())
        .collect();
    for (row, half) in ratings.iter().zip(&model.quality_half) {
        let present = row.iter().zip(&of_sureal).filter(|(u, _)| u.is_some());
        let information: f64 = present.map(|(_, sd)| sd.powi(-2)).sum();
        assert!((half * information.sqrt() / 1.96 - 1.0).abs() < 1e-7);
    }
}

#[test]
fn agreement_is_that_of_shrout_and_fleiss() {
    // Shrout & Fleiss (1979), tables 2 and 4: ICC(2,1) .29, ICC(2,4) .62, ICC(3,1) .71.
    let table = [
        [9, 2, 5, 8],
        [6, 1, 3, 2],
        [8, 4, 6, 8],
        [7, 1, 2, 6],
        [10, 5, 6, 9],
        [6, 2, 4, 7],
    ];
    let ratings: Vec<Vec<Option<f64>>> = (table.iter())
        .map(|row| row.iter().map(|&u| Some(f64::from(u))).collect())
        .collect();
    let icc = screened(&ratings).intraclass.unwrap();
    assert!((icc.single - 0.29).abs() < 0.005, "{icc:?}");
    assert!((icc.of_mean - 0.62).abs() < 0.005, "{icc:?}");
    assert!((icc.single_consistency - 0.71).abs() < 0.005, "{icc:?}");
}

#[test]
fn an_observer_who_turns_the_scale_round_is_found_by_correlation() {
    let quality = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0];
    let ratings: Vec<Vec<Option<f64>>> = (quality.iter().enumerate())
        .map(|(image, q)| {
            (0..6)
                .map(|observer| {
                    let wobble = f64::from(u8::from((image + observer) % 3 == 0)) * 0.5;
                    Some(if observer == 4 { 9.0 - q } else { q + wobble })
                })
                .collect()
        })
        .collect();
    let found = screened(&ratings).observers;
    let rejected: Vec<bool> = found.iter().map(|one| one.is_rejected_by_bt1788).collect();
    assert_eq!(rejected, [false, false, false, false, true, false]);
}

#[test]
fn observers_who_never_vary_leave_numbers_and_no_nan() {
    let ratings = vec![vec![Some(5.0); 3]; 4];
    let found = screened(&ratings);
    assert!(found.intraclass.is_none());
    assert!(found.observers.iter().all(|one| one.correlation.is_none()));
    assert!(!found.observers.iter().any(|one| one.is_rejected_by_bt500));
    assert!(
        !serde_json::to_string(&found.observers)
            .unwrap()
            .contains("NaN")
    );
}
