//! The refresh of the display as it was measured, and whether the frames keep to it.

use serde::{Deserialize, Serialize};

/// How far an interval may lie from a whole number of refreshes, as a part of one.
const TOLERANCE: f64 = 0.15;
/// How far the rate may lie below the lowest that is asked for: 59.94 Hz is as good as 60.
const RATE_TOLERANCE: f64 = 0.02;
/// The part of the intervals that must lie so near.
const MOST: f64 = 0.95;

/// Intervals between frames that followed each other at once, in short.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Refresh {
    /// What the window system says of the monitor.
    pub nominal_hz: Option<f64>,
    /// How many intervals were measured.
    pub frames: usize,
    /// Their mean.
    pub mean_ms: f64,
    /// Their median.
    pub median_ms: f64,
    /// Their standard deviation.
    pub sd_ms: f64,
    /// Whether the frames come with the display's refresh; null where its rate is unknown.
    pub is_locked: Option<bool>,
}

impl Refresh {
    /// The refresh by these intervals.
    ///
    /// Frames are locked to the refresh if the median interval is one refresh, and 95% of the intervals a
    /// whole number of refreshes, each within 15% of one.
    pub fn of(intervals_s: &[f64], nominal_hz: Option<f64>) -> Self {
        let nominal_hz = nominal_hz.filter(|hz| *hz > 0.0);
        let n = intervals_s.len() as f64;
        let mean_s = intervals_s.iter().sum::<f64>() / n.max(1.0);
        let squares: f64 = intervals_s.iter().map(|s| (s - mean_s).powi(2)).sum();
        let mut sorted = intervals_s.to_vec();
        sorted.sort_by(f64::total_cmp);
        let median_s = sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
        let is_locked = nominal_hz.map(|hz| {
            let refreshes = |s: &f64| s * hz;
            let is_whole = |s: &&f64| {
                let count = refreshes(s);
                count > 0.5 && (count - count.round()).abs() <= TOLERANCE
            };
            let whole = intervals_s.iter().filter(is_whole).count() as f64;
            (median_s * hz - 1.0).abs() <= TOLERANCE && whole >= MOST * n
        });
        let milliseconds = |s: f64| (s * 1e6).round() / 1e3;
        Self {
            nominal_hz,
            frames: intervals_s.len(),
            mean_ms: milliseconds(mean_s),
            median_ms: milliseconds(median_s),
            sd_ms: milliseconds((squares / (n - 1.0).max(1.0)).sqrt()),
            is_locked,
        }
    }

    /// Frames a second, by the median interval.
    pub fn rate_hz(self) -> f64 {
        1e3 / self.median_ms
    }

    /// Whether there are so many frames a second, within 2 %.
    pub fn reaches(self, lowest_hz: f64) -> bool {
        self.rate_hz() >= lowest_hz * (1.0 - RATE_TOLERANCE)
    }

    /// What the data and the experimenter should know.
    pub fn in_words(self) -> String {
        let lock = match self.is_locked {
            Some(true) => "locked to the display's refresh",
            Some(false) => "NOT locked to the display's refresh",
            None => "not known to be locked: the display names no refresh rate",
        };
        format!(
            "{} frames, mean {} ms, median {} ms ({:.2} Hz), SD {} ms: {lock}",
            self.frames,
            self.mean_ms,
            self.median_ms,
            self.rate_hz(),
            self.sd_ms
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_at_60_hz_are_locked_to_60_hz_and_to_nothing_else() {
        let intervals: Vec<f64> = (0..300)
            .map(|index| {
                if index % 50 == 7 {
                    2.0 / 60.0
                } else {
                    1.0 / 60.0
                }
            })
            .collect();
        let refresh = Refresh::of(&intervals, Some(60.0));
        assert_eq!(refresh.is_locked, Some(true));
        assert_eq!((refresh.median_ms, refresh.frames), (16.667, 300));
        // 294 of 16.667 ms and 6 of 33.333 ms.
        assert!((refresh.mean_ms - 17.0).abs() < 1e-9);
        assert_eq!(Refresh::of(&intervals, Some(75.0)).is_locked, Some(false));
        assert_eq!(Refresh::of(&intervals, Some(30.0)).is_locked, Some(false));
        assert_eq!(Refresh::of(&intervals, None).is_locked, None);
        assert_eq!(Refresh::of(&[], Some(60.0)).is_locked, Some(false));
    }

    /// 59.94 Hz is what monitors call 60; 30 Hz and 75 Hz are neither.
    #[test]
    fn a_display_at_30_hz_does_not_reach_60() {
        let at = |hz: f64| Refresh::of(&[1.0 / hz; 300], Some(hz));
        assert!(at(59.94).reaches(60.0) && at(75.0).reaches(60.0));
        assert!(!at(30.0).reaches(60.0) && !at(58.0).reaches(60.0));
        assert!((at(30.0).rate_hz() - 30.0).abs() < 0.01);
    }

    #[test]
    fn frames_that_run_free_are_not_locked_whatever_their_median() {
        let free: Vec<f64> = (0..300)
            .map(|index| 0.010 + 0.000_05 * f64::from(index))
            .collect();
        assert_eq!(Refresh::of(&free, Some(60.0)).is_locked, Some(false));
        assert_eq!(
            Refresh::of(&[0.002; 300], Some(60.0)).is_locked,
            Some(false)
        );
        let half: Vec<f64> = vec![1.0 / 30.0; 300];
        assert_eq!(Refresh::of(&half, Some(60.0)).is_locked, Some(false));
    }
}
