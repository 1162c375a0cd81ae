//! Four triangles side by side: a sieve that lets through every triangle that a ray may meet, and few others.
//!
//! The sieve is the test of Möller & Trumbore (1997) in single precision with room for all of its rounding.
//! With u = 2⁻²⁴, D the tree's size (no place of it is further than that from the origin of a [`SingleRay`]) and
//! e the longer of the two edges at the first corner, rounding moves a product of the offset from that corner,
//! the direction and an edge by less than 12 u D e, and the determinant by less than 10 u e². The sum of two
//! products takes the bounds of both and of the determinant, 34 u D e. Where the determinant's sign is wrong, it
//! is itself less than its bound, and so is every product that counts as a hit: 22 u D e is room enough.
//!
//! Not here: where the ray meets a triangle ([`Triangle::hit`]).
#![expect(
    clippy::inline_always,
    reason = "code for a processor's own instructions is compiled for them only where it is inlined"
)]

use wide::f32x4;

use super::single_ray::{SingleRay, single};
use super::triangle::{Triangle, vector};

/// How many triangles a packet holds.
pub(crate) const LANES: usize = 4;
/// The room for rounding, in units of the tree's size times the longer edge: 48 u.
const ROUNDING: f64 = 48.0 / 16_777_216.0;
/// More than what is lost where products are too small for single precision, in a tree of a nanometre or more.
const VANISHING: f64 = 1e-33;

/// Up to four triangles.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct Packet {
    /// The three coordinates of the three corners.
    corners: [[f32x4; 3]; 3],
    /// The room for rounding; below 0 in a lane that is not used, which nothing passes.
    slack: f32x4,
    faces: [u32; LANES],
}

impl Packet {
    /// The packet of these triangles, at most four, in a tree of this size.
    pub(crate) fn of(triangles: impl Iterator<Item = Triangle>, size_m: f64) -> Self {
        let mut packet = Self {
            corners: [[f32x4::ZERO; 3]; 3],
            slack: f32x4::splat(f32::NEG_INFINITY),
            faces: [u32::MAX; LANES],
        };
        for (lane, triangle) in triangles.take(LANES).enumerate() {
            for (planes, corner) in packet.corners.iter_mut().zip(triangle.corners) {
                for (plane, coordinate) in planes.iter_mut().zip(corner) {
                    plane.as_mut_array()[lane] = coordinate;
                }
            }
            let [a, b, c] = triangle.corners.map(vector);
            let edge_m = (b - a).length().max((c - a).length());
            packet.slack.as_mut_array()[lane] = single((ROUNDING * size_m * edge_m).max(VANISHING));
            packet.faces[lane] = triangle.face;
        }
        packet
    }

    /// How many triangles there are.
    pub(crate) fn len(&self) -> usize {
        self.lanes_used().count_ones() as usize
    }

    /// A bit for each lane that holds a triangle.
    pub(crate) fn lanes_used(&self) -> u32 {
        self.slack.simd_ge(f32x4::ZERO).to_bitmask()
    }

    /// The triangle of a lane.
    #[inline(always)]
    pub(crate) fn triangle(&self, lane: usize) -> Triangle {
        let lane = lane % LANES;
        let corner =
            |[x, y, z]: &[f32x4; 3]| [x.as_array()[lane], y.as_array()[lane], z.as_array()[lane]];
        let [a, b, c] = &self.corners;
        Triangle {
            corners: [corner(a), corner(b), corner(c)],
            face: self.faces[lane],
        }
    }

    /// A bit for each lane whose triangle the ray may meet before `end`.
    #[inline(always)]
    pub(crate) fn may_meet(&self, middle: &[f32x4; 3], ray: &SingleRay) -> u32 {
        let [a, b, c] = &self.corners;
        let offset = |axis: usize| f32x4::splat(ray.origin[axis]) - (a[axis] - middle[axis]);
        let offset = [offset(0), offset(1), offset(2)];
        let edge_b = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
        let edge_c = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
        let direction = ray.direction.map(f32x4::splat);
        let across = cross(&direction, &edge_c);
        let determinant = dot(&edge_b, &across);
        let sign = determinant & f32x4::splat(-0.0);
        let of_b = dot(&offset, &across) ^ sign;
        let of_c = dot(&direction, &cross(&offset, &edge_b)) ^ sign;
        let beyond = (of_b + of_c).simd_gt((determinant ^ sign) + self.slack);
        let missed = of_b.fast_min(of_c).simd_lt(-self.slack) | beyond;
        !missed.to_bitmask() & 0xf
    }
}

#[inline(always)]
fn dot(one: &[f32x4; 3], other: &[f32x4; 3]) -> f32x4 {
    one[0] * other[0] + one[1] * other[1] + one[2] * other[2]
}

#[inline(always)]
fn cross(one: &[f32x4; 3], other: &[f32x4; 3]) -> [f32x4; 3] {
    let across = |y: usize, z: usize| one[y] * other[z] - one[z] * other[y];
    [across(1, 2), across(2, 0), across(0, 1)]
}
