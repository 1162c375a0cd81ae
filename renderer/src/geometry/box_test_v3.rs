//! Eight boxes at once, on an x86 processor with AVX2 and FMA.
#![expect(
    clippy::inline_always,
    reason = "code for a processor's own instructions is compiled for them only where it is inlined"
)]

use pulp::x86::V3;
use pulp::{cast, f32x8};

use super::SingleRay;
use super::box_node::{BoxNode, BoxTest, Entries};

/// A ray for [`V3`].
pub(crate) struct V3Ray {
    /// The origin times the inverse.
    shift: [f32x8; 3],
    inverse: [f32x8; 3],
    near: [usize; 3],
}

impl BoxTest for V3 {
    type Ray = V3Ray;

    #[inline(always)]
    fn prepare(self, ray: &SingleRay) -> V3Ray {
        let inverse = |axis: usize| self.splat_f32x8(ray.inverse[axis]);
        let shift = |axis: usize| self.splat_f32x8(ray.origin[axis] * ray.inverse[axis]);
        V3Ray {
            shift: [shift(0), shift(1), shift(2)],
            inverse: [inverse(0), inverse(1), inverse(2)],
            near: ray.from_above,
        }
    }

    #[inline(always)]
    fn entries(self, node: &BoxNode, ray: &V3Ray, end: f32) -> Entries {
        let distance = |axis: usize, side: usize| {
            let plane = cast(node.planes[axis][side & 1]);
            self.mul_sub_f32x8(plane, ray.inverse[axis], ray.shift[axis])
        };
        let near = |axis: usize| distance(axis, ray.near[axis]);
        let far = |axis: usize| distance(axis, ray.near[axis] ^ 1);
        let entry = self.max_f32x8(near(2), self.splat_f32x8(0.0));
        let entry = self.max_f32x8(self.max_f32x8(near(0), near(1)), entry);
        let exit = self.min_f32x8(far(2), self.splat_f32x8(end));
        let exit = self.min_f32x8(self.min_f32x8(far(0), far(1)), exit);
        let met = self.cmp_le_f32x8(entry, exit);
        Entries {
            distances: cast(entry),
            met: self.avx._mm256_movemask_ps(cast(met)).cast_unsigned(),
        }
    }
}
