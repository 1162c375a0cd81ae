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
/// How many swaps are kept: a swap is looked up some frames after it is heard.
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

/// The frames of one exposure, and their swaps as far as they were heard.
#[derive(Clone, Copy, Debug)]
struct Pending {
    trial: usize,
    frames: [u64; 2],
    swaps: [Option<Swap>; 2],
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
    /// The trial whose test image stands, and the first frame with it.
    standing: Option<(usize, u64)>,
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
        for pending in &mut self.pending {
            let first_swap = pending.first_swap;
            for (swap, frame) in pending.swaps.iter_mut().zip(pending.frames) {
                *swap = swap.or_else(|| done(swaps, number_of(frame, first_swap)));
            }
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
            (None, Some(trial)) => self.standing = Some((trial, frame)),
            (Some((trial, onset)), None) => {
                self.standing = None;
                self.pending
                    .extend(self.first_swap.map(|first_swap| Pending {
                        trial,
                        frames: [onset, frame],
                        swaps: [None, None],
                        first_swap,
                    }));
            }
            _ => {}
        }
    }

    /// No frame followed `frame` for a while, so the latest swap is its own.
    fn rest(&mut self, frame: u64, began_s: f64) -> Vec<SwappedExposure> {
        let latest = self.swaps.back().filter(|swap| swap.at_s >= began_s);
        self.first_swap = latest.map(|swap| swap.number.wrapping_sub(low_bits(frame)));
        let first_swap = self.first_swap;
        let certain = |pending: Pending| match pending.swaps {
            [Some(onset), Some(offset)] if first_swap == Some(pending.first_swap) => {
                Some(SwappedExposure {
                    trial: pending.trial,
                    onset,
                    offset,
                })
            }
            _ => None,
        };
        self.pending.drain(..).filter_map(certain).collect()
    }
}

/// The number of the swap of a frame.
fn number_of(frame: u64, first_swap: u32) -> u32 {
    first_swap.wrapping_add(low_bits(frame))
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
