//! A sphere.

use super::ray::quadratic_roots;
use super::{Bounds, Hit, Part, Ray, Span, SurfacePoint, Vector};

/// A sphere; its poles are along z.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sphere {
    pub(crate) center: Vector,
    pub(crate) radius_m: f64,
}

impl Sphere {
    pub(crate) fn bounds(&self) -> Bounds {
        let extent = Vector::new(self.radius_m, self.radius_m, self.radius_m);
        Bounds::of_corners(self.center - extent, self.center + extent)
    }

    #[inline]
    pub(crate) fn hit(&self, ray: &Ray, span: Span) -> Option<Hit> {
        let offset = ray.origin - self.center;
        let c = offset.length_squared() - self.radius_m * self.radius_m;
        let roots = quadratic_roots(1.0, offset.dot(ray.direction), c)?;
        let distance_m = roots.into_iter().find(|&distance| span.holds(distance))?;
        Some(Hit {
            distance_m,
            part: Part::Side,
        })
    }

    pub(crate) fn normal(&self, place: Vector) -> Vector {
        (place - self.center).normalized()
    }

    /// u along the equator from x by y, v along a meridian from the equator.
    pub(crate) fn surface_point(&self, place: Vector) -> SurfacePoint {
        let normal = self.normal(place);
        SurfacePoint {
            u_m: self.radius_m * libm::atan2(normal.y, normal.x),
            v_m: self.radius_m * libm::asin(normal.z.clamp(-1.0, 1.0)),
        }
    }
}
