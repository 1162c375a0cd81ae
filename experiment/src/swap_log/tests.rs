//! A display of 100 Hz that is made up: frame `f` is begun at `f / 100` s and swapped `LATENCY` refreshes later, with
//! the number that the driver gives it. Expected times are those of this display.

use super::{Swap, SwapLog, SwappedExposure};

const LATENCY: u64 = 2;
/// The number of the swap of frame 0: it wraps during the test.
const FIRST: u32 = u32::MAX - 40;

/// The display, the program and the driver.
struct World {
    log: SwapLog,
    /// The present refresh.
    now: u64,
    frame: u64,
    /// The number of the next swap.
    number: u32,
    /// What was asked for and is not done: when, and its number.
    asked: Vec<(u64, u32, bool)>,
    /// The driver skips the next frame.
    skips: bool,
    seen: Vec<SwappedExposure>,
}

impl World {
    fn new() -> Self {
        Self {
            log: SwapLog::default(),
            now: 500,
            frame: 0,
            number: FIRST,
            asked: Vec::new(),
            skips: false,
            seen: Vec::new(),
        }
    }

    /// The driver does what is due.
    fn swap(&mut self) {
        let now = self.now;
        for &(due, number, is_skipped) in self.asked.iter().filter(|asked| asked.0 <= now) {
            let at_s = due as f64 / 100.0;
            self.log.heard(Swap {
                number,
                at_s,
                refresh: due,
                is_skipped,
            });
        }
        self.asked.retain(|asked| asked.0 > now);
    }

    /// One frame, and the refresh after it.
    fn frame(&mut self, test_image_of: Option<usize>) {
        let is_skipped = std::mem::take(&mut self.skips);
        self.swap();
        let seen = self.log.begin(self.frame, self.now as f64 / 100.0);
        self.seen.extend(seen);
        self.log.drawn(test_image_of);
        self.asked
            .push((self.now + LATENCY, self.number, is_skipped));
        self.number = self.number.wrapping_add(1);
        self.frame += 1;
        self.now += 1;
    }

    fn frames(&mut self, count: u64, test_image_of: Option<usize>) {
        for _ in 0..count {
            self.frame(test_image_of);
        }
    }

    fn rest(&mut self) {
        self.now += 50;
    }
}

#[test]
fn an_exposure_between_two_rests_is_known_to_the_refresh() {
    let mut world = World::new();
    world.frames(5, None);
    world.rest();
    world.frames(20, None);
    let onset = world.now;
    world.frames(30, Some(7));
    world.frames(4, None);
    assert!(world.seen.is_empty(), "no rest has confirmed it yet");
    world.rest();
    world.frames(1, None);
    let [exposure] = world.seen[..] else {
        panic!("{:?}", world.seen)
    };
    assert_eq!(exposure.trial, 7);
    assert_eq!(exposure.onset.refresh, onset + LATENCY);
    assert_eq!(exposure.offset.refresh, onset + 30 + LATENCY);
    // Frame 25 is the first with the image and frame 55 the first without; the numbers wrap between them.
    let words = format!(
        "0.300000 s, 30 refreshes, from swap {} to swap 14",
        FIRST + 25
    );
    assert_eq!(exposure.in_words(), words);
}

#[test]
fn a_frame_that_was_skipped_begins_or_ends_with_the_next() {
    let mut world = World::new();
    world.frames(1, None);
    world.rest();
    world.frames(1, None);
    let onset = world.now;
    world.skips = true;
    world.frames(10, Some(0));
    world.skips = true;
    world.frames(3, None);
    world.rest();
    world.frames(1, None);
    let refreshes: Vec<[u64; 2]> = world
        .seen
        .iter()
        .map(|exposure| [exposure.onset.refresh, exposure.offset.refresh])
        .collect();
    assert_eq!(refreshes, [[onset + 1 + LATENCY, onset + 10 + 1 + LATENCY]]);
}

#[test]
fn a_swap_too_many_or_unheard_gives_no_time() {
    for disturb in [
        |world: &mut World| world.number = world.number.wrapping_add(1),
        |world: &mut World| world.asked.clear(),
    ] {
        let mut world = World::new();
        world.frames(5, None);
        world.rest();
        world.frames(2, Some(0));
        disturb(&mut world);
        world.frames(9, Some(0));
        world.frames(3, None);
        world.rest();
        world.frames(5, None);
        let first = world.seen.len();
        // After the rest the count is right again.
        world.frames(10, Some(1));
        world.frames(3, None);
        world.rest();
        world.frames(1, None);
        assert!(first == 0, "{:?}", world.seen);
        let lengths: Vec<u64> = world
            .seen
            .iter()
            .map(|seen| seen.offset.refresh - seen.onset.refresh)
            .collect();
        assert_eq!(lengths, [10]);
    }
}

/// 1500 refreshes, more than the swaps that are kept: the paper's ten seconds at 150 Hz.
#[test]
fn a_long_exposure_has_its_onset_too() {
    let mut world = World::new();
    world.frames(5, None);
    world.rest();
    world.frames(1500, Some(0));
    world.frames(4, None);
    world.rest();
    world.frames(1, None);
    let [exposure] = world.seen[..] else {
        panic!("{:?}", world.seen)
    };
    assert_eq!(exposure.offset.refresh - exposure.onset.refresh, 1500);
}

/// The program stalls in the middle of the exposure, after a swap too many: the count is wrong for its onset.
#[test]
fn a_stall_within_an_exposure_mends_no_wrong_count() {
    let mut world = World::new();
    world.frames(5, None);
    world.rest();
    world.frames(3, Some(0));
    world.number = world.number.wrapping_add(1);
    world.frames(3, Some(0));
    world.rest();
    world.frames(3, Some(0));
    world.frames(3, None);
    world.rest();
    world.frames(1, None);
    assert_eq!(world.seen, []);
}

#[test]
fn a_driver_that_tells_nothing_gives_nothing() {
    let mut log = SwapLog::default();
    for frame in 0..40 {
        // A rest after every tenth frame.
        let at_s = frame as f64 / 100.0 + (frame / 10) as f64;
        assert_eq!(log.begin(frame, at_s), []);
        log.drawn((frame % 7 == 3).then_some(0));
    }
    assert!(!log.has_heard());
}
