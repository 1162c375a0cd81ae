//! Random numbers whose stream is fixed for good: `ChaCha20`, keyed by words.
//!
//! The key is the SHA-256 of a sentence that says what the numbers are for, so that the order of one
//! subject's trials and the noise of one observer never share a stream. Bounded numbers, the shuffle and
//! the normal distribution are written out here, so that no new version of a library changes a study.

use protocols::Sha256Digest;
use rand_chacha::ChaCha20Rng;
use rand_chacha::rand_core::{Rng as _, SeedableRng as _};

/// A stream of random numbers.
#[derive(Clone, Debug)]
pub(crate) struct Random(ChaCha20Rng);

impl Random {
    /// The stream whose ChaCha20 key is the SHA-256 of `purpose`, with counter and nonce zero.
    pub(crate) fn keyed_by(purpose: &str) -> Self {
        let digest = Sha256Digest::of(purpose.as_bytes());
        let digits = digest.as_str().as_bytes();
        let mut key = [0; 32];
        for (byte, pair) in key.iter_mut().zip(digits.chunks_exact(2)) {
            *byte = 16 * hexadecimal_value(pair[0]) + hexadecimal_value(pair[1]);
        }
        Self(ChaCha20Rng::from_seed(key))
    }

    /// A whole number from 0 to `bound - 1`, each as likely: words of 32 bits at or above the largest
    /// multiple of `bound` are drawn again.
    fn below(&mut self, bound: u32) -> u32 {
        let excess = (u32::MAX % bound + 1) % bound;
        loop {
            let word = self.0.next_u32();
            if word <= u32::MAX - excess {
                return word % bound;
            }
        }
    }

    /// Fisher and Yates's shuffle, from the last place to the second (Durstenfeld 1964, algorithm 235).
    pub(crate) fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            let bound = u32::try_from(last + 1).unwrap_or(u32::MAX);
            items.swap(last, self.below(bound) as usize);
        }
    }

    /// A whole number below `length`, each as likely; 0 if there is none.
    pub(crate) fn index(&mut self, length: usize) -> usize {
        let bound = u32::try_from(length).unwrap_or(u32::MAX);
        if bound == 0 {
            0
        } else {
            self.below(bound) as usize
        }
    }

    /// True with this probability.
    pub(crate) fn is_below(&mut self, probability: f64) -> bool {
        probability >= 1.0 || self.uniform() <= probability
    }

    /// Evenly distributed on (0, 1], in steps of 2^-53.
    pub(crate) fn uniform(&mut self) -> f64 {
        let steps = (self.0.next_u64() >> 11) + 1;
        steps as f64 * 2.0_f64.powi(-53)
    }

    /// Normally distributed with mean 0 and SD 1 (Box & Muller 1958, the cosine branch).
    pub(crate) fn normal(&mut self) -> f64 {
        let radius = libm::sqrt(-2.0 * libm::log(self.uniform()));
        radius * libm::cos(std::f64::consts::TAU * self.uniform())
    }
}

fn hexadecimal_value(digit: u8) -> u8 {
    match digit {
        b'0'..=b'9' => digit - b'0',
        _ => digit - b'a' + 10,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_order_of_four_is_as_likely() {
        let mut random = Random::keyed_by("every order of four");
        let mut counts = std::collections::BTreeMap::new();
        let draws = 24_000;
        for _ in 0..draws {
            let mut items = [0, 1, 2, 3];
            random.shuffle(&mut items);
            *counts.entry(items).or_insert(0.0) += 1.0;
        }
        let expected = f64::from(draws) / 24.0;
        let chi_square: f64 = counts
            .values()
            .map(|count: &f64| (count - expected).powi(2) / expected)
            .sum();
        assert_eq!(counts.len(), 24);
        // The upper 1e-4 point of chi-square with 23 df is 55.5 (R: qchisq(1e-4, 23, lower.tail = FALSE)).
        assert!(chi_square < 55.5, "chi-square {chi_square}");
    }

    #[test]
    fn normal_numbers_have_the_moments_of_a_normal_distribution() {
        let mut random = Random::keyed_by("moments");
        let n = 100_000;
        let values: Vec<f64> = (0..n).map(|_| random.normal()).collect();
        let moment =
            |power: i32| values.iter().map(|value| value.powi(power)).sum::<f64>() / f64::from(n);
        // Standard errors 0.0032, 0.0045, 0.012 and 0.031: four and more of them.
        assert!(moment(1).abs() < 0.015);
        assert!((moment(2) - 1.0).abs() < 0.02);
        assert!(moment(3).abs() < 0.06);
        assert!((moment(4) - 3.0).abs() < 0.15);
    }
}
