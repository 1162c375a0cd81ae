//! The plain slow way as judge: type III and type II sums of squares as differences of residual sums of squares, from a
//! sum-to-zero coded design matrix, without contrasts, group means or shortcuts.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use analysis::{AnovaTable, CellMatrix, Observations, anova};
use nalgebra::DMatrix;
use protocols::SumsOfSquares;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng as _, SeedableRng as _};

/// Levels of the between factors f and g, and of the within factor w.
const LEVELS: [usize; 3] = [2, 3, 4];

/// Subjects with their two between levels and one rating for each within level.
type Data = Vec<([usize; 2], [f64; LEVELS[2]])>;

fn random_data(seed: u64) -> Data {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut data = Vec::new();
    for f in 0..LEVELS[0] {
        for g in 0..LEVELS[1] {
            let n = 2 + random.next_u32() % 4;
            for _ in 0..n {
                let ratings = [(); LEVELS[2]].map(|()| f64::from(random.next_u32() % 1000) / 100.0);
                data.push(([f, g], ratings));
            }
        }
    }
    data
}

/// Sum-to-zero columns of one factor.
fn sum_coded(level: usize, n_levels: usize) -> Vec<f64> {
    let entry = |column: usize| match () {
        () if level == n_levels - 1 => -1.0,
        () if level == column => 1.0,
        () => 0.0,
    };
    (0..n_levels - 1).map(entry).collect()
}

/// The columns of one between term for one subject: products of the columns of its factors.
fn term_columns(levels: [usize; 2], term: [bool; 2]) -> Vec<f64> {
    (0..2)
        .filter(|&factor| term[factor])
        .fold(vec![1.0], |columns, factor| {
            let coded = sum_coded(levels[factor], LEVELS[factor]);
            columns
                .iter()
                .flat_map(|column| coded.iter().map(move |code| column * code))
                .collect()
        })
}

const TERMS: [[bool; 2]; 4] = [[false, false], [true, false], [false, true], [true, true]];

/// The terms that stand in the larger of the two models whose difference is `term`.
fn terms_beside(term: [bool; 2], kind: SumsOfSquares) -> Vec<[bool; 2]> {
    let holds_term = |other: &[bool; 2]| (0..2).all(|factor| other[factor] || !term[factor]);
    match kind {
        SumsOfSquares::TypeThree => TERMS.to_vec(),
        SumsOfSquares::TypeTwo => (TERMS.into_iter())
            .filter(|other| *other == term || !holds_term(other))
            .collect(),
    }
}

/// The residual sum of squares of `scores` on the columns of `terms`.
fn residual_ss(data: &Data, scores: &[f64], terms: &[[bool; 2]]) -> f64 {
    if terms.is_empty() {
        return scores.iter().map(|score| score * score).sum();
    }
    let rows: Vec<Vec<f64>> = (data.iter())
        .map(|(levels, _)| {
            let terms = terms.iter();
            terms
                .flat_map(|term| term_columns(*levels, *term))
                .collect()
        })
        .collect();
    let design = DMatrix::from_fn(rows.len(), rows[0].len(), |row, column| rows[row][column]);
    let observed = DMatrix::from_column_slice(scores.len(), 1, scores);
    let coefficients = (design.transpose() * &design)
        .lu()
        .solve(&(design.transpose() * &observed))
        .unwrap();
    (observed - design * coefficients).norm_squared()
}

/// Contrast scores of the within levels: the mean and the differences from it, in the metric of the levels.
fn within_scores(data: &Data) -> (Vec<f64>, Vec<Vec<f64>>) {
    let k = LEVELS[2] as f64;
    let mean = |ratings: &[f64; LEVELS[2]]| ratings.iter().sum::<f64>() / k;
    let means = data
        .iter()
        .map(|(_, ratings)| mean(ratings) * k.sqrt())
        .collect();
    // Deviations from the mean hold the sums of squares of any orthonormal contrasts.
    let deviations = (0..LEVELS[2])
        .map(|level| {
            data.iter()
                .map(|(_, ratings)| ratings[level] - mean(ratings))
                .collect()
        })
        .collect();
    (means, deviations)
}

fn fast(data: &Data, kind: SumsOfSquares) -> AnovaTable {
    let names = |names: &[&str]| {
        names
            .iter()
            .map(|&name| name.to_owned())
            .collect::<Vec<_>>()
    };
    let mut observations =
        Observations::new("a test".as_ref(), &names(&["f", "g"]), &names(&["w"]));
    for (subject, (levels, ratings)) in data.iter().enumerate() {
        for (within, rating) in ratings.iter().enumerate() {
            let labels = [levels[0], levels[1], within].map(|level| level.to_string());
            observations.push(
                &subject.to_string(),
                labels.iter().map(String::as_str),
                Some(*rating),
            );
        }
    }
    anova(&CellMatrix::new(&observations).unwrap(), &[], kind)
}

#[test]
fn an_effect_is_the_residual_without_the_term_less_that_with_it() {
    for (seed, kind) in (0..10).flat_map(|seed| {
        [SumsOfSquares::TypeThree, SumsOfSquares::TypeTwo].map(|kind| (seed, kind))
    }) {
        let data = random_data(seed);
        let table = fast(&data, kind);
        let (means, deviations) = within_scores(&data);
        for term in TERMS {
            let names = ["f", "g"].into_iter().zip(term);
            let between: Vec<&str> = (names.filter(|(_, held)| *held))
                .map(|(name, _)| name)
                .collect();
            for (suffix, columns) in [(None, vec![means.clone()]), (Some("w"), deviations.clone())]
            {
                let names: Vec<&str> = between.iter().copied().chain(suffix).collect();
                let name = names.join(":");
                if name.is_empty() {
                    continue;
                }
                let sum = |terms: &[[bool; 2]]| {
                    let scores = columns.iter();
                    scores
                        .map(|scores| residual_ss(&data, scores, terms))
                        .sum::<f64>()
                };
                let error = sum(&TERMS);
                let with = terms_beside(term, kind);
                let without: Vec<[bool; 2]> =
                    with.iter().copied().filter(|one| *one != term).collect();
                let effect = sum(&without) - sum(&with);
                let row = table.effect(&name).unwrap();
                assert!(
                    (row.ss_effect - effect).abs() < 1e-9 * (effect + error),
                    "{seed} {name} {kind:?}"
                );
                assert!((row.ss_error / error - 1.0).abs() < 1e-10, "{seed} {name}");
            }
        }
        assert_eq!(table.effects.len(), 7);
    }
}

#[test]
fn the_order_of_subjects_changes_no_f() {
    let data = random_data(77);
    let mut reversed = data.clone();
    reversed.reverse();
    let kind = SumsOfSquares::TypeThree;
    let (one, other) = (fast(&data, kind), fast(&reversed, kind));
    for (one, other) in one.effects.iter().zip(&other.effects) {
        assert!((one.f.unwrap() / other.f.unwrap() - 1.0).abs() < 1e-10);
        assert!(
            (one.gg_epsilon.unwrap_or(1.0) / other.gg_epsilon.unwrap_or(1.0) - 1.0).abs() < 1e-10
        );
    }
}
