//! What the screen tree asks of a scene: rays in two steps, as in section 3.3 of Meyer & Liu (1992).
//!
//! Intersection makes the ray tree, geometry only; shading then computes only the channels asked for.
//! Both depend on nothing but their arguments, so that samples can be taken in any order on any thread.

use std::ops::Range;

use protocols::{Channel, PerChannel};

/// A point of the screen: x from 0 (left) to 1 (right), y from 0 (top) to 1 (bottom).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScreenPoint {
    /// From left to right.
    pub x: f64,
    /// From top to bottom.
    pub y: f64,
}

/// A point of the screen on a grid of 2³² × 2³², as it is stored: no cell is smaller than two of its steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct GridPoint(pub(crate) [u32; 2]);

/// The steps of the grid.
const STEPS: f64 = 4_294_967_296.0;

impl From<ScreenPoint> for GridPoint {
    /// The next point of the grid to the left and above, which lies in the same cell.
    fn from(point: ScreenPoint) -> Self {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "rounded down on purpose; a coordinate is never negative and less than 1"
        )]
        let step = |coordinate: f64| (coordinate * STEPS) as u32;
        Self([step(point.x), step(point.y)])
    }
}

impl From<GridPoint> for ScreenPoint {
    fn from(GridPoint([x, y]): GridPoint) -> Self {
        Self {
            x: f64::from(x) / STEPS,
            y: f64::from(y) / STEPS,
        }
    }
}

/// Something that can be sampled at any point of the screen.
pub trait Sampler: Sync {
    /// What one ray found: hits, lights that are visible from them, reflected rays; no colour.
    type RayTree: Default + Clone + Send + Sync;

    /// Follows the ray through `at` and all rays that it spawns; `tree` is overwritten, its memory reused.
    fn intersect(&self, at: ScreenPoint, tree: &mut Self::RayTree);

    /// What [`Self::intersect`] gives for each of many points, bit for bit; it may cost less than one by one.
    ///
    /// There is a tree for each point.
    fn intersect_all(&self, points: &[ScreenPoint], trees: &mut [Self::RayTree]) {
        for (&at, tree) in points.iter().zip(trees) {
            self.intersect(at, tree);
        }
    }

    /// The tristimulus value of one channel for a ray tree; the same whatever else is shaded.
    fn shade(&self, tree: &Self::RayTree, channel: Channel) -> f32;

    /// What [`Self::shade`] gives for each channel, bit for bit; it may cost less than one by one.
    fn shade_all(&self, tree: &Self::RayTree) -> PerChannel<f32> {
        PerChannel::from_fn(|channel| self.shade(tree, channel))
    }

    /// The wavelengths in nm at which there is a spectrum; none for a picture without.
    fn wavelengths_nm(&self) -> &[f64] {
        &[]
    }

    /// The radiance of a ray tree at some of the wavelengths, one for each place of `out`.
    fn radiance(&self, _tree: &Self::RayTree, _wavelengths: Range<usize>, _out: &mut [f32]) {}
}
