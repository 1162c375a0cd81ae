//! A ray, the part of it that is asked for, and what it meets.

use super::Vector;

/// A half-line: an origin and a unit direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ray {
    pub(crate) origin: Vector,
    pub(crate) direction: Vector,
}

impl Ray {
    /// The place at a distance along the ray.
    #[inline]
    pub(crate) fn at(&self, distance_m: f64) -> Vector {
        self.origin + self.direction * distance_m
    }
}

/// The distances along a ray at which a hit counts; both ends excluded.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    pub(crate) from_m: f64,
    pub(crate) to_m: f64,
}

impl Span {
    /// From just off the origin to a distance.
    pub(crate) const fn up_to(to_m: f64) -> Self {
        Self { from_m: 1e-9, to_m }
    }

    #[inline]
    pub(crate) fn holds(self, distance_m: f64) -> bool {
        self.from_m < distance_m && distance_m < self.to_m
    }
}

/// Which part of a shape was hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    /// The only surface, or the curved one.
    Side,
    /// A flat end of a cylinder or a cone.
    Cap,
    /// A face of a mesh.
    Face(u32),
}

/// Where along a ray a shape was met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hit {
    pub(crate) distance_m: f64,
    pub(crate) part: Part,
}

/// A place on a surface in the surface's own coordinates, in metres along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SurfacePoint {
    pub(crate) u_m: f64,
    pub(crate) v_m: f64,
}

/// The real roots of `a t² + 2 half_b t + c`, the smaller first; of a linear equation its root twice.
///
/// The form that does not cancel: Press et al., *Numerical Recipes*, section 5.6.
#[inline]
pub(crate) fn quadratic_roots(a: f64, half_b: f64, c: f64) -> Option<[f64; 2]> {
    let discriminant = half_b * half_b - a * c;
    if discriminant < 0.0 {
        return None;
    }
    let q = -(half_b + discriminant.sqrt().copysign(half_b));
    let (one, other) = (q / a, c / q);
    let (one, other) = match (one.is_finite(), other.is_finite()) {
        (true, true) => (one, other),
        (true, false) => (one, one),
        (false, true) => (other, other),
        (false, false) => return None,
    };
    Some(if one < other {
        [one, other]
    } else {
        [other, one]
    })
}
