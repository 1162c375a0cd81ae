//! The time from frame to frame, measured while frames follow each other.

use std::collections::VecDeque;

/// Assumed until enough frames are measured.
const NOMINAL_FRAME_S: f64 = 1.0 / 60.0;
/// The frame time is the median of this many intervals.
const WINDOW: usize = 31;
/// From how many intervals on the median is taken.
const ENOUGH: usize = 5;

/// What lay between two frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Interval {
    /// A rest: the second frame had nothing to wait for.
    Rest,
    /// They followed each other at once.
    Running,
    /// They followed each other at once, and the test image stood between them.
    Exposure,
}

/// The frame time, and every interval between two frames with a test image.
#[derive(Clone, Debug, Default)]
pub struct FrameClock {
    previous_s: Option<f64>,
    recent_s: VecDeque<f64>,
    exposure_intervals_s: Vec<f64>,
    missed: u32,
}

/// The frames of all exposures of a test image, in short.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameSummary {
    /// How many intervals were measured.
    pub intervals: usize,
    /// Their median.
    pub median_s: f64,
    /// The 99th percentile.
    pub p99_s: f64,
    /// The longest.
    pub longest_s: f64,
    /// How many were longer than one and a half frame times.
    pub missed: u32,
}

impl FrameClock {
    /// Takes the beginning of a frame; says whether it came later than one and a half frame times after
    /// the one before.
    pub(crate) fn frame(&mut self, at_s: f64, interval: Interval) -> bool {
        let previous_s = self.previous_s.replace(at_s);
        let Some(interval_s) = previous_s.map(|previous_s| at_s - previous_s) else {
            return false;
        };
        if interval == Interval::Rest {
            return false;
        }
        let is_late = interval_s > 1.5 * self.frame_s();
        self.recent_s.push_back(interval_s);
        if self.recent_s.len() > WINDOW {
            self.recent_s.pop_front();
        }
        if interval == Interval::Exposure {
            self.exposure_intervals_s.push(interval_s);
            self.missed += u32::from(is_late);
        }
        is_late
    }

    /// The median of the latest intervals.
    pub fn frame_s(&self) -> f64 {
        if self.recent_s.len() < ENOUGH {
            return NOMINAL_FRAME_S;
        }
        let recent_s: Vec<f64> = self.recent_s.iter().copied().collect();
        quantile(recent_s, 0.5)
    }

    /// How many frames with a test image came late.
    pub fn missed(&self) -> u32 {
        self.missed
    }

    /// What the frames of all exposures were like, if there were any.
    pub fn summary(&self) -> Option<FrameSummary> {
        let intervals_s = &self.exposure_intervals_s;
        (!intervals_s.is_empty()).then(|| FrameSummary {
            intervals: intervals_s.len(),
            median_s: quantile(intervals_s.clone(), 0.5),
            p99_s: quantile(intervals_s.clone(), 0.99),
            longest_s: quantile(intervals_s.clone(), 1.0),
            missed: self.missed,
        })
    }
}

/// The value below which the part `q` of `values` lies, by nearest rank.
fn quantile(mut values: Vec<f64>, q: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let last = values.len().saturating_sub(1);
    let ranks = values.iter().enumerate();
    let at_least = |&(rank, _): &(usize, &f64)| rank as f64 >= q * last as f64;
    ranks
        .filter(at_least)
        .map(|(_, &value)| value)
        .next()
        .unwrap_or(f64::NAN)
}
