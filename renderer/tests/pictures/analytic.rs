//! Pictures that are known in closed form, as samplers: no scene, no rays, but a count of what was asked.

use std::sync::atomic::{AtomicU64, Ordering};

use protocols::{Channel, PerChannel, RefinementDriver};
use renderer::{Reach, Sampler, ScreenPoint, TracePlan};

/// A picture given by a function of the screen and the channel.
pub(crate) struct Analytic<F> {
    value: F,
    intersections: AtomicU64,
    shadings: PerChannel<AtomicU64>,
}

impl<F: Fn(ScreenPoint, Channel) -> f64 + Sync> Analytic<F> {
    pub(crate) fn new(value: F) -> Self {
        Self {
            value,
            intersections: AtomicU64::new(0),
            shadings: PerChannel::default(),
        }
    }

    /// How often the sampler was asked to intersect, and to shade A, C1 and C2.
    pub(crate) fn calls(&self) -> [u64; 4] {
        let shadings = Channel::ALL.map(|channel| self.shadings[channel].load(Ordering::Relaxed));
        let intersections = self.intersections.load(Ordering::Relaxed);
        [intersections, shadings[0], shadings[1], shadings[2]]
    }
}

impl<F: Fn(ScreenPoint, Channel) -> f64 + Sync> Sampler for Analytic<F> {
    type RayTree = Option<ScreenPoint>;

    fn intersect(&self, at: ScreenPoint, tree: &mut Option<ScreenPoint>) {
        self.intersections.fetch_add(1, Ordering::Relaxed);
        *tree = Some(at);
    }

    fn shade(&self, tree: &Option<ScreenPoint>, channel: Channel) -> f32 {
        self.shadings[channel].fetch_add(1, Ordering::Relaxed);
        (self.value)(tree.unwrap(), channel) as f32
    }
}

/// A disc on a checkerboard with a slow ramp: curved and straight edges, smooth parts; each channel differs.
pub(crate) fn disc_and_checks() -> Analytic<impl Fn(ScreenPoint, Channel) -> f64 + Sync> {
    Analytic::new(|at: ScreenPoint, channel| {
        let is_in_disc = (at.x - 0.4).hypot(at.y - 0.55) < 0.23;
        let is_dark = ((at.x * 9.0).floor() + (at.y * 7.0).floor()).rem_euclid(2.0) == 0.0;
        let a = match (is_in_disc, is_dark) {
            (true, _) => 0.3 + 0.4 * at.x,
            (false, true) => 0.1,
            (false, false) => 0.8 - 0.2 * at.y,
        };
        match channel {
            Channel::A => a,
            Channel::C1 => 0.5 * a - 0.1,
            Channel::C2 => 0.2 - 0.3 * at.x * a,
        }
    })
}

/// A plan in which A alone drives and every channel goes as far as `rays`.
pub(crate) fn plan(rays: usize) -> TracePlan {
    TracePlan {
        seed: 1992,
        size_px: [64, 64],
        min_depth: 6,
        driver: RefinementDriver::A,
        stops: PerChannel::from_fn(|_| Reach::rays(rays)),
        until: None,
    }
}
