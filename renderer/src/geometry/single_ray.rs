//! A ray in the single precision of a box tree.
//!
//! It begins where the ray comes near the tree, so that its rounding is small beside the tree's size however
//! far off the ray's own origin is.

use wide::f32x4;

use super::{Ray, Span, Vector};

/// Stands for a coordinate of the direction that is nearly 0, so that no reciprocal is infinite.
const LEVEL: f32 = 1e-18;

/// A ray in the coordinates of a tree, which have their origin in the tree's middle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SingleRay {
    pub(crate) origin: [f32; 3],
    pub(crate) direction: [f32; 3],
    /// The reciprocals of the direction, all finite.
    pub(crate) inverse: [f32; 3],
    /// For each axis 1 if the upper plane of a box is met first, else 0.
    pub(crate) from_above: [usize; 3],
    /// The distance along the ray of the new origin.
    start_m: f64,
}

impl SingleRay {
    /// The ray with a new origin at this distance along it, which is `origin` beside the tree's middle.
    #[inline]
    pub(crate) fn from(ray: &Ray, start_m: f64, origin: Vector) -> Self {
        let direction = rounded(ray.direction);
        let [x, y, z] = direction;
        let level = f32x4::new([x, y, z, 1.0]);
        let sign = level & f32x4::splat(-0.0);
        let steep = level.abs().fast_max(f32x4::splat(LEVEL)) | sign;
        let [x, y, z, _] = (f32x4::ONE / steep).to_array();
        let from_above = sign.to_bitmask();
        let bit = |axis: u32| (from_above >> axis & 1) as usize;
        Self {
            origin: rounded(origin),
            direction,
            inverse: [x, y, z],
            from_above: [bit(0), bit(1), bit(2)],
            start_m,
        }
    }

    /// The end of the span from the new origin on, never too near.
    #[inline]
    pub(crate) fn end(&self, span: Span) -> f32 {
        single(span.to_m - self.start_m) * (1.0 + 2.0 * f32::EPSILON)
    }
}

/// Each coordinate rounded to the nearest single.
pub(crate) fn rounded(vector: Vector) -> [f32; 3] {
    [single(vector.x), single(vector.y), single(vector.z)]
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding to the nearest single is meant"
)]
#[inline]
pub(crate) fn single(value: f64) -> f32 {
    value as f32
}
