//! Adjusting the p values of a family of tests.

/// Holm (1979), *Scand. J. Stat.* 6, 65–70: `p_(i) -> max over j <= i of min(1, (m - j + 1) p_(j))`. A missing p
/// is no member of the family and stays missing.
pub(crate) fn holm(p_values: &[Option<f64>]) -> Vec<Option<f64>> {
    let mut present: Vec<(usize, f64)> = (p_values.iter().enumerate())
        .filter_map(|(index, p)| p.map(|p| (index, p)))
        .collect();
    present.sort_by(|left, right| left.1.total_cmp(&right.1));
    let mut adjusted = vec![None; p_values.len()];
    let mut largest = 0.0_f64;
    for (rank, &(index, p)) in present.iter().enumerate() {
        let factor = (present.len() - rank) as f64;
        largest = largest.max((factor * p).min(1.0));
        adjusted[index] = Some(largest);
    }
    adjusted
}

/// Bonferroni: each p times the size of the family, at most 1.
pub(crate) fn bonferroni(p_values: &[Option<f64>]) -> Vec<Option<f64>> {
    let size = p_values.iter().flatten().count() as f64;
    (p_values.iter())
        .map(|p| p.map(|p| (p * size).min(1.0)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_are_as_in_r() {
        // R: p.adjust(c(.01, .04, .03, .005), "holm") is .03 .06 .06 .02; "bonferroni" .04 .16 .12 .02.
        let family = [0.01, 0.04, 0.03, 0.005].map(Some);
        let expected = [[0.03, 0.06, 0.06, 0.02], [0.04, 0.16, 0.12, 0.02]];
        for (found, expected) in [holm(&family), bonferroni(&family)].iter().zip(expected) {
            for (found, expected) in found.iter().zip(expected) {
                assert!((found.unwrap() - expected).abs() < 1e-15);
            }
        }
        assert_eq!(holm(&[None, Some(0.5)]), [None, Some(0.5)]);
    }
}
