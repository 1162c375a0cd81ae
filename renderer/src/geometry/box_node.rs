//! Eight boxes side by side, tried together.
//!
//! Which boxes a ray is said to meet differs a little between machines, since some round once where others
//! round twice; the margin of the boxes covers either.
#![expect(
    clippy::inline_always,
    reason = "code for a processor's own instructions is compiled for them only where it is inlined"
)]

use wide::f32x4;

use super::SingleRay;

/// How many boxes a node holds.
pub(crate) const WIDTH: usize = 8;

/// Eight boxes, and what each holds.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct BoxNode {
    /// The lower and upper planes across x, y and z, each in halves.
    pub(crate) planes: [[[f32x4; 2]; 2]; 3],
    children: [Child; WIDTH],
}

/// What is in a box: a node, or the places of a leaf.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Child(u32);

/// The distances at which a ray enters the boxes of a node, and a bit for each box that it meets.
pub(crate) struct Entries {
    pub(crate) distances: [f32; WIDTH],
    pub(crate) met: u32,
}

/// A way to try eight boxes.
pub(crate) trait BoxTest: Copy {
    /// A ray as this way needs it.
    type Ray;

    /// Makes the ray ready.
    fn prepare(self, ray: &SingleRay) -> Self::Ray;

    /// Which boxes the ray meets no later than `end`.
    fn entries(self, node: &BoxNode, ray: &Self::Ray, end: f32) -> Entries;
}

/// The way that every machine knows: four boxes at a time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlainTest;

/// A ray for [`PlainTest`].
pub(crate) struct PlainRay {
    origin: [f32x4; 3],
    inverse: [f32x4; 3],
    near: [usize; 3],
}

impl BoxNode {
    /// A node of at most eight boxes, each with its lower and its upper corner.
    pub(crate) fn of(boxes: impl Iterator<Item = [[f32; 3]; 2]>) -> Self {
        // A place that is not used is a box that nothing meets.
        let mut planes = [[[f32::INFINITY; WIDTH], [f32::NEG_INFINITY; WIDTH]]; 3];
        for (slot, corners) in boxes.take(WIDTH).enumerate() {
            for (axis, planes) in planes.iter_mut().enumerate() {
                for (plane, corner) in planes.iter_mut().zip(corners) {
                    plane[slot] = corner[axis];
                }
            }
        }
        let halves = |[a, b, c, d, e, f, g, h]: [f32; WIDTH]| {
            [f32x4::new([a, b, c, d]), f32x4::new([e, f, g, h])]
        };
        Self {
            planes: planes.map(|planes| planes.map(halves)),
            children: [Child::default(); WIDTH],
        }
    }

    /// What is in one of the boxes.
    #[inline(always)]
    pub(crate) fn child(&self, slot: usize) -> Child {
        self.children[slot % WIDTH]
    }

    /// What is in the boxes.
    pub(crate) fn children_mut(&mut self) -> &mut [Child; WIDTH] {
        &mut self.children
    }
}

impl Child {
    /// The most places that a leaf can have.
    const MOST_PLACES: u32 = 7;

    /// A node, by its index.
    pub(crate) fn node(index: u32) -> Self {
        Self(index << 3)
    }

    /// A leaf, by its first place and how many there are: 1 to 7.
    pub(crate) fn leaf(first: u32, count: u32) -> Self {
        debug_assert!((1..=Self::MOST_PLACES).contains(&count));
        Self(first << 3 | count)
    }

    /// How many places a leaf has; 0 for a node.
    #[inline(always)]
    pub(crate) fn count(self) -> usize {
        (self.0 & Self::MOST_PLACES) as usize
    }

    /// The first place of a leaf, or the index of a node.
    #[inline(always)]
    pub(crate) fn first(self) -> usize {
        (self.0 >> 3) as usize
    }

    /// The child as a number.
    #[inline(always)]
    pub(crate) fn code(self) -> u32 {
        self.0
    }

    /// The child of a number that [`Self::code`] gave.
    #[inline(always)]
    pub(crate) fn of_code(code: u32) -> Self {
        Self(code)
    }
}

impl BoxTest for PlainTest {
    type Ray = PlainRay;

    #[inline(always)]
    fn prepare(self, ray: &SingleRay) -> PlainRay {
        PlainRay {
            origin: ray.origin.map(f32x4::splat),
            inverse: ray.inverse.map(f32x4::splat),
            near: ray.from_above,
        }
    }

    #[inline(always)]
    fn entries(self, node: &BoxNode, ray: &PlainRay, end: f32) -> Entries {
        let ([a, b, c, d], low) = half_entries(node, ray, end, 0);
        let ([e, f, g, h], high) = half_entries(node, ray, end, 1);
        Entries {
            distances: [a, b, c, d, e, f, g, h],
            met: low | high << 4,
        }
    }
}

#[inline(always)]
fn half_entries(node: &BoxNode, ray: &PlainRay, end: f32, half: usize) -> ([f32; 4], u32) {
    let distance = |axis: usize, side: usize| {
        (node.planes[axis][side & 1][half] - ray.origin[axis]) * ray.inverse[axis]
    };
    let near = |axis: usize| distance(axis, ray.near[axis]);
    let far = |axis: usize| distance(axis, ray.near[axis] ^ 1);
    let entry = near(2).fast_max(f32x4::ZERO);
    let entry = near(0).fast_max(near(1)).fast_max(entry);
    let exit = far(2).fast_min(f32x4::splat(end));
    let exit = far(0).fast_min(far(1)).fast_min(exit);
    (entry.to_array(), entry.simd_le(exit).to_bitmask())
}
