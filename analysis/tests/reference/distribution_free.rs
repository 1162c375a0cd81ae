//! Rank tests and permutation tests against R.

use analysis::{AnalysisOptions, DistributionFree, TableAnalysis};
use protocols::SumsOfSquares;

use crate::case::{
    Case, assert_near, assert_p_near, is_refused, number, own_cases, published_cases,
};

fn all_cases(with: &str) -> Vec<Case> {
    let cases = own_cases().into_iter();
    cases
        .chain(published_cases().into_iter().flatten())
        .filter(|case| !is_refused(case) && !case.expected[with].is_null())
        .collect()
}

fn distribution_free(case: &Case, n_random: u32) -> DistributionFree {
    let options = AnalysisOptions {
        n_permutations: Some(n_random),
        ..AnalysisOptions::default()
    };
    let kind = SumsOfSquares::TypeThree;
    let analysis = TableAnalysis::new(&case.cells(), &[], kind, &options).unwrap();
    analysis.distribution_free.unwrap()
}

#[test]
fn friedman_agrees_with_r() {
    let cases = all_cases("friedman");
    assert!(cases.len() >= 2, "{}", cases.len());
    for case in cases {
        let expected = &case.expected["friedman"];
        let found = &distribution_free(&case, 10).friedman[0];
        let near = |key: &str, found| assert_near(case.id(), found, number(&expected[key]), 1e-9);
        near("chisq", Some(found.chi_square));
        near("df", Some(found.df as f64));
        near("kendall_W", Some(found.kendall_w));
        near("iman_davenport_F", found.f);
        near("f_df2", Some(found.f_df[1] as f64));
        assert_p_near(case.id(), Some(found.p), number(&expected["p"]), 1e-9);
        assert_p_near(case.id(), found.f_p, number(&expected["f_p"]), 1e-9);
    }
}

#[test]
fn aligned_ranks_agree_with_r() {
    let cases = all_cases("aligned_rank_transform");
    assert!(cases.len() >= 4, "{}", cases.len());
    for case in cases {
        let found = distribution_free(&case, 10).aligned_ranks;
        let rows = case.expected["aligned_rank_transform"].as_array().unwrap();
        assert_eq!(found.len(), rows.len(), "{}", case.id());
        for (found, row) in found.iter().zip(rows) {
            let what = format!("{}, {}", case.id(), found.effect);
            assert_eq!(found.effect, row["effect"].as_str().unwrap());
            assert_near(&what, found.f, number(&row["F"]), 1e-9);
            assert_p_near(&what, found.p, number(&row["p"]), 1e-9);
            assert_p_near(&what, found.p_gg.or(found.p), number(&row["p_gg"]), 1e-9);
        }
    }
}

#[test]
fn turned_signs_and_exchanged_groups_agree_with_a_full_count_in_r() {
    let mut n_tests = 0;
    for key in ["sign_flip", "group_permutation"] {
        for case in all_cases(key) {
            let expected = &case.expected[key];
            let tests = distribution_free(&case, 10).permutation;
            let mut tests = tests.iter();
            let test = tests.find(|test| test.effect == expected["effect"].as_str().unwrap());
            let test = test.unwrap();
            assert!(test.is_exact, "{}", case.id());
            assert_eq!(
                Some(test.n_arrangements),
                expected["n_permutations"].as_u64()
            );
            assert_near(case.id(), test.p, number(&expected["p_two_sided"]), 1e-12);
            n_tests += 1;
        }
    }
    assert!(n_tests >= 4, "{n_tests}");
}

#[test]
fn random_arrangements_come_near_the_full_count_and_repeat() {
    // 24 subjects have 2^24 signs, too many; the F test of the same set is far below 1e-4.
    let cases = own_cases();
    let case = cases
        .iter()
        .find(|case| case.id() == "paper_24x2x13")
        .unwrap();
    let once = distribution_free(case, 2000).permutation;
    assert_eq!(once, distribution_free(case, 2000).permutation);
    for test in &once {
        assert!(!test.is_exact);
        assert_eq!(test.n_arrangements, 2001);
        assert!(test.p.unwrap() < 0.01, "{test:?}");
    }
}
