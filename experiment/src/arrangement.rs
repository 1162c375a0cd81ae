//! An order of images and the limits that it must keep: runs of one level, and gaps between repeats.
//!
//! Images are numbers here. An image may only change places within its *segment* (a block of the session).
//!
//! Whole shuffles are drawn until one keeps every limit: so each allowed order is exactly as likely. Where
//! hardly any shuffle does, a random walk over orders takes over: it swaps two images of a segment and takes the
//! new order with probability min(1, e^-4d), where d counts the faults added (Metropolis et al. 1953). Orders
//! without a fault are equally likely in the walk, too; it is looked at only once in
//! forty steps for each image.

use std::ops::Range;

use crate::random::Random;

/// Whole shuffles before the walk begins.
const SHUFFLES: usize = 10_000;
/// Steps of the walk before it is given up.
const STEPS: usize = 4_000_000;
/// Between two looks at the walk: so many steps for each image, so that one look tells nothing of the next. An
/// order taken at its first faultless moment would be one that is easy to reach, not one in as many.
const LOOKS: usize = 40;
/// e^-4 and its powers: how likely a step is that adds so many faults.
const ACCEPTED: [f64; 4] = [
    1.0,
    0.018_315_638_888_734_18,
    0.000_335_462_627_902_511_85,
    0.000_006_144_212_353_328_21,
];

/// What an order must keep.
#[derive(Clone, Debug, Default)]
pub(crate) struct Limits {
    /// For each limit: the level of each image, and how many in a row are allowed.
    pub(crate) runs: Vec<RunOfLevels>,
    /// For each image: so many other trials at least between two showings.
    pub(crate) gaps: Vec<usize>,
}

/// A limit to the runs of one factor.
#[derive(Clone, Debug)]
pub(crate) struct RunOfLevels {
    pub(crate) factor: String,
    /// The level of each image.
    pub(crate) levels: Vec<String>,
    pub(crate) most: usize,
}

/// Images in an order, in segments.
#[derive(Clone, Debug)]
pub(crate) struct Arrangement<'a> {
    pub(crate) images: Vec<usize>,
    pub(crate) segments: Vec<Range<usize>>,
    pub(crate) limits: &'a Limits,
}

impl Arrangement<'_> {
    /// Draws an order that keeps every limit; if there is none, or none is found, says why.
    pub(crate) fn draw(&mut self, random: &mut Random) -> Result<(), String> {
        if let Some(reason) = self.impossible() {
            return Err(reason);
        }
        for _ in 0..SHUFFLES {
            self.shuffle(random);
            if self.faults() == 0 {
                return Ok(());
            }
        }
        self.walk(random)
    }

    fn shuffle(&mut self, random: &mut Random) {
        for segment in &self.segments {
            random.shuffle(&mut self.images[segment.clone()]);
        }
    }

    fn walk(&mut self, random: &mut Random) -> Result<(), String> {
        let mut faults = self.faults();
        for step in 1..=STEPS {
            if let Some((i, j)) = self.two_places(random) {
                let before = self.faults_at(i, j);
                self.images.swap(i, j);
                let after = self.faults_at(i, j);
                let added = after.saturating_sub(before);
                if random.is_below(ACCEPTED.get(added).copied().unwrap_or(0.0)) {
                    faults = faults + after - before;
                } else {
                    self.images.swap(i, j);
                }
            }
            if faults == 0 && step.is_multiple_of(LOOKS * self.images.len()) {
                return Ok(());
            }
        }
        Err(format!(
            "no order in {SHUFFLES} shuffles and {STEPS} steps of a random walk kept every limit"
        ))
    }

    /// Two places of one segment: neighbours as often as not.
    fn two_places(&self, random: &mut Random) -> Option<(usize, usize)> {
        let i = random.index(self.images.len());
        let segment = self.segments.iter().find(|segment| segment.contains(&i))?;
        let j = match random.index(2) {
            0 => Some(i + 1).filter(|j| segment.contains(j))?,
            _ => segment.start + random.index(segment.len()),
        };
        (i != j).then_some((i, j))
    }

    /// How many runs are too long by one, and how many repeats too close, in the whole order.
    fn faults(&self) -> usize {
        let n = self.images.len();
        let runs = self.limits.runs.iter();
        let runs = runs.map(|run| (0..n).filter(|&start| self.is_long(run, start)).count());
        let repeats = (0..n).map(|place| self.close_repeats(place, |other| other > place));
        runs.sum::<usize>() + repeats.sum::<usize>()
    }

    /// The same, of those that touch two places.
    fn faults_at(&self, i: usize, j: usize) -> usize {
        let mut faults = 0;
        for run in &self.limits.runs {
            let near = |place: usize| place.saturating_sub(run.most)..=place;
            let of_j = near(j).filter(|start| !near(i).contains(start));
            let starts = near(i).chain(of_j);
            faults += starts.filter(|&start| self.is_long(run, start)).count();
        }
        faults
            + self.close_repeats(i, |other| other != i)
            + self.close_repeats(j, |other| other != j && other != i)
    }

    /// Whether one image more than allowed, from `start` on, has the same level.
    fn is_long(&self, run: &RunOfLevels, start: usize) -> bool {
        let Some(images) = self.images.get(start..=start + run.most) else {
            return false;
        };
        let level = |image: usize| &run.levels[image];
        images.iter().all(|&image| level(image) == level(images[0]))
    }

    fn close_repeats(&self, place: usize, counts: impl Fn(usize) -> bool) -> usize {
        let image = self.images[place];
        let gap = self.limits.gaps[image];
        let last = (place + gap).min(self.images.len() - 1);
        let near = place.saturating_sub(gap)..=last;
        near.filter(|&other| counts(other) && self.images[other] == image)
            .count()
    }

    /// Why no order can keep the limits, where that can be told by counting.
    fn impossible(&self) -> Option<String> {
        self.segments.iter().find_map(|segment| {
            let images = &self.images[segment.clone()];
            self.too_many_of_a_level(images)
                .or_else(|| self.too_many_of_an_image(images))
        })
    }

    fn too_many_of_a_level(&self, images: &[usize]) -> Option<String> {
        self.limits.runs.iter().find_map(|run| {
            images.iter().find_map(|&image| {
                let level = &run.levels[image];
                let same = |other: &&usize| run.levels[**other] == *level;
                let count = images.iter().filter(same).count();
                let others = images.len() - count;
                let room = run.most.saturating_mul(others + 1);
                (count > room).then(|| {
                    format!(
                        "a block has {count} trials with {} {level} and {others} others, which part them into at most {} runs: at most {} in a row leaves room for {room}",
                        run.factor, others + 1, run.most
                    )
                })
            })
        })
    }

    fn too_many_of_an_image(&self, images: &[usize]) -> Option<String> {
        images.iter().find_map(|&image| {
            let count = images.iter().filter(|&&other| other == image).count();
            let gap = self.limits.gaps[image];
            let needed = (count - 1) * (gap + 1) + 1;
            (needed > images.len()).then(|| {
                format!(
                    "an image that is rated {count} times in a block with {gap} trials between needs a block of {needed} trials, and it has {}",
                    images.len()
                )
            })
        })
    }
}

#[cfg(test)]
mod tests;
