//! What a picture cost: ray trees made and channels shaded, the two parts of the cost in section 3.3.

use std::fmt;
use std::iter::Sum;
use std::ops::Add;

use protocols::{Channel, PerChannel};

/// How many ray trees were made, and how many of them were shaded for each channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayAccount {
    /// Camera rays followed through the scene, each with all rays that it spawns.
    pub intersections: u64,
    /// Ray trees shaded for each channel.
    pub shadings: PerChannel<u64>,
}

impl RayAccount {
    /// What `rays` samples cost when every channel is shaded for each of them.
    pub fn full(rays: u64) -> Self {
        Self {
            intersections: rays,
            shadings: PerChannel::from_fn(|_| rays),
        }
    }

    /// The shadings of all channels together.
    pub fn total_shadings(&self) -> u64 {
        Channel::ALL
            .iter()
            .map(|&channel| self.shadings[channel])
            .sum()
    }

    /// How many shadings a full computation (three for each ray tree) would have had beyond these.
    pub fn saved_shadings(&self) -> u64 {
        (3 * self.intersections).saturating_sub(self.total_shadings())
    }
}

impl Add for RayAccount {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            intersections: self.intersections + other.intersections,
            shadings: PerChannel::from_fn(|channel| {
                self.shadings[channel] + other.shadings[channel]
            }),
        }
    }
}

impl Sum for RayAccount {
    fn sum<I: Iterator<Item = Self>>(accounts: I) -> Self {
        accounts.fold(Self::default(), Add::add)
    }
}

impl fmt::Display for RayAccount {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let full = 3 * self.intersections;
        let percent = 100.0 * self.saved_shadings() as f64 / (full.max(1)) as f64;
        write!(
            formatter,
            "{} intersections; shadings A {}, C1 {}, C2 {}: {} of {full}, {percent:.1}% saved",
            self.intersections,
            self.shadings.a,
            self.shadings.c1,
            self.shadings.c2,
            self.total_shadings(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 140K + 2 × 30K of 3 × 140K are 200K of 420K: 220K, or 52.4%, saved.
    #[test]
    fn a_stopped_chromatic_pair_is_counted_against_three_full_channels() {
        let account = RayAccount {
            intersections: 140_000,
            shadings: PerChannel {
                a: 140_000,
                c1: 30_000,
                c2: 30_000,
            },
        };
        assert_eq!(account.saved_shadings(), 220_000);
        assert!(
            account
                .to_string()
                .ends_with("200000 of 420000, 52.4% saved")
        );
        assert_eq!(RayAccount::full(5).saved_shadings(), 0);
    }
}
