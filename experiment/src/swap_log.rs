//! Which frame each swap of the driver belongs to, and for how long an exposure stood between two swaps.
//!
//! A driver numbers its swaps and says when each was done, some frames later; it does not say which frame of ours it
//! was. At a rest, when no frame has been begun for a while, every swap has been heard, so the latest belongs to the
//! latest frame; from there both count up. An exposure is given only if the count is the same at the rest before it
//! and at the first rest after it, so a swap too many or too few in between is never taken for a time.
//!
//! Not here: how swaps are heard (`window/swap_watch`).

use std::collections::VecDeque;

/// After this long without a new frame every swap is done and heard.
const REST_S: f64 = 0.1;
/// How many swaps are kept: one is looked up some frames after its own frame was begun.
const KEPT: usize = 1024;

/// One swap, as the driver tells it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Swap {
    /// Its number; it wraps.
    pub(crate) number: u32,
    /// When it was done, by the clock of the session.
    pub(crate) at_s: f64,
    /// The refresh of the display that it was done at (media stream counter).
    pub(crate) refresh: u64,
    /// Whether a later frame took its place, so that it was never done.
    pub(crate) is_skipped: bool,
}

/// An exposure of a test image between two swaps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SwappedExposure {
    /// The index of the trial.
    pub(crate) trial: usize,
    /// The first swap with the image.
    pub(crate) onset: Swap,
    /// The first swap without it.
    pub(crate) offset: Swap,
}

impl SwappedExposure {
    /// The exposure in words, for the log of events.
    pub(crate) fn in_words(&self) -> String {
        let Self { onset, offset, .. } = self;
        let exposure_s = offset.at_s - onset.at_s;
        let refreshes = offset.refresh.saturating_sub(onset.refresh);
        let (first, last) = (onset.number, offset.number);
        format!("{exposure_s:.6} s, {refreshes} refreshes, from swap {first} to swap {last}")
    }
}

/// A frame whose swap is sought.
#[derive(Clone, Copy, Debug)]
struct Edge {
    frame: u64,
    swap: Option<Swap>,
}

impl Edge {
    fn of(frame: u64) -> Self {
        Self { frame, swap: None }
    }

    fn seek(&mut self, swaps: &VecDeque<Swap>, first_swap: u32) {
        let number = first_swap.wrapping_add(low_bits(self.frame));
        self.swap = self.swap.or_else(|| done(swaps, number));
    }
}

/// An exposure that goes on.
#[derive(Clone, Copy, Debug)]
struct Standing {
    trial: usize,
    onset: Edge,
    /// The number of the swap of frame 0 at the rest before, if it was known.
    first_swap: Option<u32>,
}

/// An exposure that is over, and not yet certain.
#[derive(Clone, Copy, Debug)]
struct Pending {
    trial: usize,
    onset: Edge,
    offset: Edge,
    /// The number of the swap of frame 0 at the rest before.
    first_swap: u32,
}

/// The swaps of one window.
#[derive(Clone, Debug, Default)]
pub(crate) struct SwapLog {
    swaps: VecDeque<Swap>,
    /// The number of the swap of frame 0.
    first_swap: Option<u32>,
    /// The frame that was begun last, and when.
    latest: Option<(u64, f64)>,
    standing: Option<Standing>,
    pending: Vec<Pending>,
}

impl SwapLog {
    /// Whether the driver has told of any swap.
    pub(crate) fn has_heard(&self) -> bool {
        !self.swaps.is_empty()
    }

    /// The driver has told of a swap.
    pub(crate) fn heard(&mut self, swap: Swap) {
        if self.swaps.len() == KEPT {
            self.swaps.pop_front();
        }
        self.swaps.push_back(swap);
    }

    /// A frame is begun; returns the exposures that are certain by now.
    pub(crate) fn begin(&mut self, frame: u64, at_s: f64) -> Vec<SwappedExposure> {
        let swaps = &self.swaps;
        if let Some(standing) = &mut self.standing
            && let Some(first_swap) = standing.first_swap
        {
            standing.onset.seek(swaps, first_swap);
        }
        for pending in &mut self.pending {
            pending.onset.seek(swaps, pending.first_swap);
            pending.offset.seek(swaps, pending.first_swap);
        }
        let before = self.latest.replace((frame, at_s));
        match before {
            Some((frame, began_s)) if at_s - began_s >= REST_S => self.rest(frame, began_s),
            _ => Vec::new(),
        }
    }

    /// The frame that was begun last shows the test image of this trial, or none.
    pub(crate) fn drawn(&mut self, test_image_of: Option<usize>) {
        let Some((frame, _)) = self.latest else {
            return;
        };
        match (self.standing, test_image_of) {
            (None, Some(trial)) => {
                self.standing = Some(Standing {
                    trial,
                    onset: Edge::of(frame),
                    first_swap: self.first_swap,
                });
            }
            (Some(standing), None) => {
                self.standing = None;
                let pending = standing.first_swap.map(|first_swap| Pending {
                    trial: standing.trial,
                    onset: standing.onset,
                    offset: Edge::of(frame),
                    first_swap,
                });
                self.pending.extend(pending);
            }
            _ => {}
        }
    }

    /// No frame followed `frame` for a while, so the latest swap is its own.
    fn rest(&mut self, frame: u64, began_s: f64) -> Vec<SwappedExposure> {
        let latest = self.swaps.back().filter(|swap| swap.at_s >= began_s);
        self.first_swap = latest.map(|swap| swap.number.wrapping_sub(low_bits(frame)));
        let first_swap = self.first_swap;
        let certain = |pending: Pending| {
            let is_same = first_swap == Some(pending.first_swap);
            let (onset, offset) = (pending.onset.swap?, pending.offset.swap?);
            is_same.then_some(SwappedExposure {
                trial: pending.trial,
                onset,
                offset,
            })
        };
        self.pending.drain(..).filter_map(certain).collect()
    }
}

/// A frame's number as it wraps in the driver's.
#[expect(
    clippy::cast_possible_truncation,
    reason = "the driver's numbers are these bits"
)]
fn low_bits(frame: u64) -> u32 {
    frame as u32
}

/// The swap with this number, or the first after it that was done.
fn done(swaps: &VecDeque<Swap>, number: u32) -> Option<Swap> {
    let mut from = swaps.iter().skip_while(|swap| swap.number != number);
    from.find(|swap| !swap.is_skipped).copied()
}

#[cfg(test)]
mod tests;
