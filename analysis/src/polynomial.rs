//! Orthogonal polynomials on the levels of a factor: the linear, quadratic, ... trend.

use crate::interval::mean;

/// The orthonormal polynomials of degree 1 to `n_degrees` on `scores`, rising at the largest score.
///
/// Each is orthogonal to those of lower degree and to the constant, and has length 1, as R's `contr.poly`.
pub(crate) fn orthogonal_polynomials(scores: &[f64], n_degrees: usize) -> Vec<Vec<f64>> {
    let centre = mean(scores);
    let reach = (scores.iter())
        .map(|score| (score - centre).abs())
        .fold(0.0, f64::max);
    let x: Vec<f64> = (scores.iter())
        .map(|score| (score - centre) / reach)
        .collect();
    let mut basis: Vec<Vec<f64>> = vec![normalised(&vec![1.0; x.len()])];
    for _ in 0..n_degrees {
        let previous = &basis[basis.len() - 1];
        let mut next: Vec<f64> = previous.iter().zip(&x).map(|(p, x)| p * x).collect();
        // Twice is enough to be orthogonal to the last bit.
        for _ in 0..2 {
            for lower in &basis {
                let shared: f64 = next.iter().zip(lower).map(|(a, b)| a * b).sum();
                for (value, lower) in next.iter_mut().zip(lower) {
                    *value -= shared * lower;
                }
            }
        }
        basis.push(normalised(&next));
    }
    basis.split_off(1)
}

fn normalised(values: &[f64]) -> Vec<f64> {
    let length = values.iter().map(|value| value * value).sum::<f64>().sqrt();
    values.iter().map(|value| value / length).collect()
}

/// The numbers that levels name, such as 10, 20, 100 for 10K, 20K, 100K; `None` unless every level is a number
/// with the same unit after it, and no two are equal.
pub(crate) fn scores_of_levels(levels: &[String]) -> Option<Vec<f64>> {
    let parts: Vec<(f64, &str)> = (levels.iter())
        .map(|level| {
            let is_unit =
                |letter: char| !letter.is_ascii_digit() && !matches!(letter, '.' | '-' | '+');
            let end = level.find(is_unit).unwrap_or(level.len());
            let number: f64 = level[..end].parse().ok()?;
            Some((number, &level[end..]))
        })
        .collect::<Option<_>>()?;
    let is_same_unit = parts.iter().all(|(_, unit)| *unit == parts[0].1);
    let rises = parts.windows(2).all(|pair| pair[0].0 < pair[1].0);
    (is_same_unit && rises).then(|| parts.into_iter().map(|(number, _)| number).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_steps_give_the_polynomials_of_the_tables() {
        // Fisher & Yates, five levels: (-2 -1 0 1 2), (2 -1 -2 -1 2), (-1 2 0 -2 1), (1 -4 6 -4 1).
        let tables: [([f64; 5], f64); 4] = [
            ([-2.0, -1.0, 0.0, 1.0, 2.0], 10.0),
            ([2.0, -1.0, -2.0, -1.0, 2.0], 14.0),
            ([-1.0, 2.0, 0.0, -2.0, 1.0], 10.0),
            ([1.0, -4.0, 6.0, -4.0, 1.0], 70.0),
        ];
        let found = orthogonal_polynomials(&[10.0, 20.0, 30.0, 40.0, 50.0], 4);
        for (found, (expected, square)) in found.iter().zip(tables) {
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected / square.sqrt()).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn levels_with_one_unit_are_numbers() {
        let scores = |levels: &[&str]| {
            scores_of_levels(
                &levels
                    .iter()
                    .map(|&level| level.to_owned())
                    .collect::<Vec<_>>(),
            )
        };
        assert_eq!(
            scores(&["10K", "20K", "100K"]),
            Some(vec![10.0, 20.0, 100.0])
        );
        assert_eq!(scores(&["-1.5", "2"]), Some(vec![-1.5, 2.0]));
        assert_eq!(scores(&["1s", "2m"]), None);
        assert_eq!(scores(&["low", "high"]), None);
    }
}
