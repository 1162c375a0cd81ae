//! A flat disc.

use super::{Bounds, Frame, Hit, Part, Ray, Span, SurfacePoint, Vector};

/// A disc, seen from both sides.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Disc {
    center: Vector,
    frame: Frame,
    radius_m: f64,
}

impl Disc {
    /// A disc across a unit normal.
    pub(crate) fn new(center: Vector, normal: Vector, radius_m: f64) -> Self {
        Self {
            center,
            frame: Frame::about(normal),
            radius_m,
        }
    }

    pub(crate) fn bounds(&self) -> Bounds {
        Bounds::of_discs(self.frame.axis, [(self.center, self.radius_m); 2])
    }

    /// A ball round the disc.
    pub(crate) fn ball(&self) -> (Vector, f64) {
        (self.center, self.radius_m)
    }

    #[inline]
    pub(crate) fn hit(&self, ray: &Ray, span: Span) -> Option<Hit> {
        let normal = self.frame.axis;
        let distance_m = (self.center - ray.origin).dot(normal) / ray.direction.dot(normal);
        if !span.holds(distance_m) {
            return None;
        }
        let from_center = ray.at(distance_m) - self.center;
        (from_center.length_squared() <= self.radius_m * self.radius_m).then_some(Hit {
            distance_m,
            part: Part::Side,
        })
    }

    pub(crate) fn normal(&self) -> Vector {
        self.frame.axis
    }

    /// Flat coordinates from the centre.
    pub(crate) fn surface_point(&self, place: Vector) -> SurfacePoint {
        self.frame.flat(place - self.center)
    }
}
