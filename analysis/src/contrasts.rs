//! Orthonormal contrasts: the questions that an effect asks of the cell means.

use nalgebra::DMatrix;

/// Orthonormal contrasts of `n_levels` levels (Helmert): *k* × (*k* − 1), each column of length 1 and
/// orthogonal to the constant.
///
/// ```text
/// column j (from 1):  (1, ..., 1, -j, 0, ..., 0) / sqrt(j (j + 1)),   j ones
/// ```
pub(crate) fn orthonormal(n_levels: usize) -> DMatrix<f64> {
    DMatrix::from_fn(n_levels, n_levels - 1, |row, column| {
        let j = (column + 1) as f64;
        let entry = match row.cmp(&(column + 1)) {
            std::cmp::Ordering::Less => 1.0,
            std::cmp::Ordering::Equal => -j,
            std::cmp::Ordering::Greater => 0.0,
        };
        entry / (j * (j + 1.0)).sqrt()
    })
}

/// The contrasts of one effect on all cells: cells × degrees of freedom.
///
/// The Kronecker product, over the factors in order, of a factor's orthonormal contrasts where the effect
/// holds the factor, and of the constant `1 / sqrt(k)` where it averages over it. `holds[i]` says whether
/// the effect holds the factor with `n_levels[i]` levels.
pub(crate) fn effect_contrasts(n_levels: &[usize], holds: &[bool]) -> DMatrix<f64> {
    let one = DMatrix::from_element(1, 1, 1.0);
    (n_levels.iter().zip(holds)).fold(one, |product, (&levels, &is_held)| {
        let factor = if is_held {
            orthonormal(levels)
        } else {
            DMatrix::from_element(levels, 1, (levels as f64).sqrt().recip())
        };
        product.kronecker(&factor)
    })
}

/// Every set of `n_factors` factors, smaller sets first, then in the order of the factors; the empty set
/// leads.
pub(crate) fn factor_sets(n_factors: usize) -> Vec<Vec<bool>> {
    let mut sets: Vec<Vec<bool>> = (0..1_usize << n_factors)
        .map(|bits| {
            (0..n_factors)
                .map(|factor| bits >> factor & 1 == 1)
                .collect()
        })
        .collect();
    let members =
        |set: &[bool]| -> Vec<usize> { (0..set.len()).filter(|&factor| set[factor]).collect() };
    sets.sort_by_key(|set| (members(set).len(), members(set)));
    sets
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contrasts_are_orthonormal_and_blind_to_what_they_average_over() {
        for holds in factor_sets(3) {
            let contrasts = effect_contrasts(&[2, 3, 13], &holds);
            let gram = contrasts.transpose() * &contrasts;
            let identity = DMatrix::identity(gram.nrows(), gram.ncols());
            assert!((gram - identity).amax() < 1e-14);
            if holds.contains(&true) {
                assert!(contrasts.row_sum().amax() < 1e-13);
            }
        }
    }

    #[test]
    fn effects_come_in_the_order_of_a_table() {
        let names: Vec<String> = factor_sets(3)
            .iter()
            .map(|set| {
                "abc"
                    .chars()
                    .zip(set)
                    .filter(|(_, held)| **held)
                    .map(|(c, _)| c)
                    .collect()
            })
            .collect();
        assert_eq!(names, ["", "a", "b", "c", "ab", "ac", "bc", "abc"]);
    }
}
