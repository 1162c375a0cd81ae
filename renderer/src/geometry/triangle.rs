//! A triangle, and where exactly a ray meets it.
//!
//! Source: Möller & Trumbore (1997).
#![expect(
    clippy::inline_always,
    reason = "code for a processor's own instructions is compiled for them only where it is inlined"
)]

use super::{Bounds, Ray, Span, Vector};

/// By how much a triangle is larger than its edges say, so that rounding opens no gap between neighbours.
const SLACK: f64 = 1e-12;

/// A triangle's corners, and which face of a mesh it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle {
    pub(crate) corners: [[f32; 3]; 3],
    pub(crate) face: u32,
}

impl Triangle {
    #[inline]
    fn vectors(&self) -> [Vector; 3] {
        let [a, b, c] = self.corners;
        [vector(a), vector(b), vector(c)]
    }

    /// Whether it has a finite area other than 0.
    pub(crate) fn has_area(&self) -> bool {
        let [a, b, c] = self.vectors();
        let doubled_area = (b - a).cross(c - a).length();
        doubled_area > 0.0 && doubled_area.is_finite()
    }

    /// The box that holds it, with no margin.
    #[inline]
    pub(crate) fn bounds(&self) -> Bounds {
        let [a, b, c] = self.vectors();
        Bounds::tight(a.min(b).min(c), a.max(b).max(c))
    }

    /// The distance along the ray at which it meets the triangle, if that is within the span.
    ///
    /// A ray that nearly lies in the triangle's plane gives a distance that is mostly rounding; it counts only
    /// if the place is within `reach_m` of the box of the triangle.
    #[inline(always)]
    pub(crate) fn hit(&self, ray: &Ray, span: Span, reach_m: f64) -> Option<f64> {
        let [a, b, c] = self.vectors();
        let (edge_b, edge_c) = (b - a, c - a);
        let across = ray.direction.cross(edge_c);
        let determinant = edge_b.dot(across);
        // Everything is compared as a multiple of it, so that most misses are known without a division.
        let size = determinant.abs();
        let sign = if determinant < 0.0 { -1.0 } else { 1.0 };
        let slack = SLACK * size;
        let offset = ray.origin - a;
        let of_b = offset.dot(across) * sign;
        // A ray along the triangle has a determinant of 0: it is let through here, and stopped below.
        if !(of_b >= -slack && of_b <= size + slack) {
            return None;
        }
        let over = offset.cross(edge_b);
        let of_c = ray.direction.dot(over) * sign;
        if !(of_c >= -slack && of_b + of_c <= size + slack) || size == 0.0 {
            return None;
        }
        let distance_m = edge_c.dot(over) / determinant;
        if !span.holds(distance_m) {
            return None;
        }
        let is_near = self.bounds().is_within(ray.at(distance_m), reach_m);
        is_near.then_some(distance_m)
    }
}

/// A vertex in double precision.
#[inline]
pub(crate) fn vector([x, y, z]: [f32; 3]) -> Vector {
    Vector::new(f64::from(x), f64::from(y), f64::from(z))
}
