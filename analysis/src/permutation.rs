//! Permutation tests of every effect: no distribution is assumed, and no sphericity.
//!
//! Under the hypothesis that a within-subject effect is absent, the signs of each subject's contrast scores could
//! as well be turned; without an effect of groups, subjects could as well have been in another group. What the
//! other terms of the model explain is taken out first (Freedman & Lane 1983, *J. Bus. Econ. Stat.* 1, 292–298),
//! so that the test of one group and the test of one between factor are exact, and the others nearly.

use nalgebra::DMatrix;
use protocols::SumsOfSquares;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng as _, SeedableRng as _};
use serde::Serialize;

use crate::anova::effect_name;
use crate::between_model::{BetweenModel, BetweenTerm, level_counts};
use crate::cell_matrix::CellMatrix;
use crate::contrasts::{effect_contrasts, factor_sets};

/// Up to this many arrangements all are tried.
const MOST_EXACT: u64 = 1 << 16;

/// The permutation test of one effect.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PermutationTest {
    /// Its factors joined by `:`, between factors first.
    pub effect: String,
    /// The share of arrangements whose F is no smaller than the one found; `None` without error variance.
    pub p: Option<f64>,
    /// How many arrangements were tried.
    pub n_arrangements: u64,
    /// Whether these are all that there are.
    pub is_exact: bool,
}

/// The permutation test of every effect of `cells`: all arrangements where there are at most 65 536, else
/// `n_random` from `seed`.
pub(crate) fn permutation_tests(
    cells: &CellMatrix,
    kind: SumsOfSquares,
    n_random: u32,
    seed: u64,
) -> Vec<PermutationTest> {
    let between = BetweenModel::new(cells, kind);
    let centred = cells.scores.add_scalar(-cells.scores.mean());
    let mut tests = Vec::new();
    for held in factor_sets(cells.within.len()) {
        let contrasts = effect_contrasts(&level_counts(&cells.within), &held);
        let scores = &centred * contrasts;
        for term in &between.terms {
            if !held.contains(&true) && !term.holds.contains(&true) {
                continue;
            }
            let reduced = Reduced::new(cells, &between, term, &scores);
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            random.set_stream(tests.len() as u64);
            let mut test = reduced.test(n_random, &mut random);
            test.effect = effect_name(cells, &term.holds, &held);
            tests.push(test);
        }
    }
    tests
}

/// What is left of the contrast scores when all terms but one are taken out.
struct Reduced<'a> {
    groups: &'a [usize],
    sizes: Vec<usize>,
    term: &'a BetweenTerm,
    between: &'a BetweenModel,
    /// Subjects × contrasts.
    residuals: DMatrix<f64>,
    /// Whether the term is the constant, so that signs are turned and not groups exchanged.
    turns_signs: bool,
    total: f64,
}

impl<'a> Reduced<'a> {
    fn new(
        cells: &'a CellMatrix,
        between: &'a BetweenModel,
        term: &'a BetweenTerm,
        scores: &DMatrix<f64>,
    ) -> Self {
        let sizes = cells.group_sizes();
        let means = group_means(scores, &cells.groups, &sizes);
        let fitted = between.fitted_by_others(term, &means);
        let mut residuals = scores.clone();
        for (row, &group) in cells.groups.iter().enumerate() {
            let mut residual = residuals.row_mut(row);
            residual -= fitted.row(group);
        }
        Self {
            groups: &cells.groups,
            sizes,
            term,
            between,
            total: residuals.norm_squared(),
            residuals,
            turns_signs: !term.holds.contains(&true),
        }
    }

    /// The share of effect and error that the effect has; it rises with F.
    fn share(&self, residuals: &DMatrix<f64>) -> f64 {
        let means = group_means(residuals, self.groups, &self.sizes);
        let effect = self.between.explained(self.term, &means).norm_squared();
        let of_groups: f64 = (means.row_iter().zip(&self.sizes))
            .map(|(mean, &size)| size as f64 * mean.norm_squared())
            .sum();
        let error = (self.total - of_groups).max(0.0);
        effect / (effect + error).max(f64::MIN_POSITIVE)
    }

    fn test(&self, n_random: u32, random: &mut ChaCha8Rng) -> PermutationTest {
        let observed = self.share(&self.residuals);
        let mut counter = Counter {
            threshold: observed * (1.0 - 1e-10),
            n_tried: 0,
            n_reached: 0,
        };
        let is_exact = if self.turns_signs {
            self.all_signs(&mut counter)
        } else {
            self.all_groupings(&mut counter)
        };
        if !is_exact {
            counter.count(observed); // The arrangement found is one of them.
            for _ in 0..n_random {
                let rearranged = if self.turns_signs {
                    self.with_random_signs(random)
                } else {
                    self.shuffled(random)
                };
                counter.count(self.share(&rearranged));
            }
        }
        let has_variance = self.total > 0.0 && observed < 1.0 - 1e-12;
        PermutationTest {
            effect: String::new(),
            p: has_variance.then(|| counter.n_reached as f64 / counter.n_tried as f64),
            n_arrangements: counter.n_tried,
            is_exact,
        }
    }

    /// Tries all signs, and says whether there are few enough. Turning all of them changes nothing, so the
    /// first stays.
    fn all_signs(&self, counter: &mut Counter) -> bool {
        let n = self.residuals.nrows();
        if n > 30 || 1_u64 << (n - 1) > MOST_EXACT / 2 {
            return false;
        }
        let mut turned = self.residuals.clone();
        counter.count_twice(self.share(&turned));
        for step in 1..1_u64 << (n - 1) {
            // Gray code: one sign changes at a time.
            let row = step.trailing_zeros() as usize + 1;
            turned.row_mut(row).neg_mut();
            counter.count_twice(self.share(&turned));
        }
        true
    }

    /// Tries all ways to divide the subjects into two groups of the same sizes, and says whether there are few
    /// enough.
    fn all_groupings(&self, counter: &mut Counter) -> bool {
        let [first, second] = self.sizes.as_slice() else {
            return false;
        };
        let n = first + second;
        let n_ways = (0..*first).try_fold(1_u64, |ways, taken| {
            let more = ways.checked_mul((n - taken) as u64)? / (taken as u64 + 1);
            (more <= u64::MAX >> 8).then_some(more)
        });
        if n_ways.is_none_or(|ways| ways > MOST_EXACT) {
            return false;
        }
        let mut chosen: Vec<usize> = (0..*first).collect();
        loop {
            counter.count(self.share(&self.divided(&chosen)));
            // The next combination in lexicographic order.
            let Some(place) = (0..*first).rev().find(|&i| chosen[i] < n - first + i) else {
                return true;
            };
            chosen[place] += 1;
            for later in place + 1..*first {
                chosen[later] = chosen[later - 1] + 1;
            }
        }
    }

    /// The residuals with those of `chosen` in the first group.
    fn divided(&self, chosen: &[usize]) -> DMatrix<f64> {
        let mut others = (0..self.residuals.nrows()).filter(|row| !chosen.contains(row));
        let mut chosen = chosen.iter().copied();
        let order: Vec<usize> = (self.groups.iter())
            .filter_map(|&group| {
                if group == 0 {
                    chosen.next()
                } else {
                    others.next()
                }
            })
            .collect();
        self.residuals.select_rows(&order)
    }

    fn with_random_signs(&self, random: &mut ChaCha8Rng) -> DMatrix<f64> {
        let mut turned = self.residuals.clone();
        let mut bits = 0;
        for row in 0..turned.nrows() {
            if row % 64 == 0 {
                bits = random.next_u64();
            }
            if bits >> (row % 64) & 1 == 1 {
                turned.row_mut(row).neg_mut();
            }
        }
        turned
    }

    fn shuffled(&self, random: &mut ChaCha8Rng) -> DMatrix<f64> {
        let mut order: Vec<usize> = (0..self.residuals.nrows()).collect();
        for last in (1..order.len()).rev() {
            order.swap(last, below(random, last + 1));
        }
        self.residuals.select_rows(&order)
    }
}

/// A random whole number below `bound`.
pub(crate) fn below(random: &mut ChaCha8Rng, bound: usize) -> usize {
    let product = u128::from(random.next_u64()) * bound as u128;
    // The upper half of the product is below `bound`.
    usize::try_from(product >> 64).unwrap_or(0)
}

/// How often a threshold was reached.
struct Counter {
    threshold: f64,
    n_tried: u64,
    n_reached: u64,
}

impl Counter {
    fn count(&mut self, share: f64) {
        self.n_tried += 1;
        self.n_reached += u64::from(share >= self.threshold);
    }

    fn count_twice(&mut self, share: f64) {
        self.count(share);
        self.count(share);
    }
}

fn group_means(scores: &DMatrix<f64>, groups: &[usize], sizes: &[usize]) -> DMatrix<f64> {
    let mut means = DMatrix::zeros(sizes.len(), scores.ncols());
    for (row, &group) in groups.iter().enumerate() {
        let mut mean = means.row_mut(group);
        mean += scores.row(row) / sizes[group] as f64;
    }
    means
}
