//! A cylinder with flat ends.

use super::ray::quadratic_roots;
use super::{Bounds, Frame, Hit, Part, Ray, Span, SurfacePoint, Vector};

/// A cylinder from the middle of its base along its axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cylinder {
    base: Vector,
    frame: Frame,
    height_m: f64,
    radius_m: f64,
}

impl Cylinder {
    /// The cylinder between the middles of its ends, which differ.
    pub(crate) fn between(base: Vector, top: Vector, radius_m: f64) -> Self {
        Self {
            base,
            frame: Frame::about((top - base).normalized()),
            height_m: (top - base).length(),
            radius_m,
        }
    }

    pub(crate) fn bounds(&self) -> Bounds {
        let axis = self.frame.axis;
        let top = self.base + axis * self.height_m;
        Bounds::of_discs(axis, [(self.base, self.radius_m), (top, self.radius_m)])
    }

    /// Balls round the two ends.
    pub(crate) fn ends(&self) -> [(Vector, f64); 2] {
        let top = self.base + self.frame.axis * self.height_m;
        [(self.base, self.radius_m), (top, self.radius_m)]
    }

    #[inline]
    pub(crate) fn hit(&self, ray: &Ray, span: Span) -> Option<Hit> {
        let axis = self.frame.axis;
        let offset = ray.origin - self.base;
        let (rise, height_m) = (ray.direction.dot(axis), offset.dot(axis));
        let across = ray.direction - axis * rise;
        let aside = offset - axis * height_m;
        let (a, half_b) = (across.length_squared(), across.dot(aside));
        let c = aside.length_squared() - self.radius_m * self.radius_m;
        let mut nearest = None;
        let mut span = span;
        let roots = quadratic_roots(a, half_b, c);
        // Without roots the ray misses the endless cylinder, unless it runs along the axis.
        if roots.is_none() && a > 0.0 {
            return None;
        }
        let on_side =
            |&t: &f64| span.holds(t) && (0.0..=self.height_m).contains(&(height_m + t * rise));
        if let Some(distance_m) = roots.and_then(|roots| roots.into_iter().find(on_side)) {
            span.to_m = distance_m;
            nearest = Some(Hit {
                distance_m,
                part: Part::Side,
            });
        }
        for end_m in [0.0, self.height_m] {
            let distance_m = (end_m - height_m) / rise;
            let inside = a * distance_m * distance_m + 2.0 * half_b * distance_m + c <= 0.0;
            if span.holds(distance_m) && inside {
                span.to_m = distance_m;
                nearest = Some(Hit {
                    distance_m,
                    part: Part::Cap,
                });
            }
        }
        nearest
    }

    pub(crate) fn normal(&self, place: Vector, part: Part) -> Vector {
        let axis = self.frame.axis;
        let offset = place - self.base;
        match part {
            Part::Side | Part::Face(_) => (offset - axis * offset.dot(axis)).normalized(),
            Part::Cap if offset.dot(axis) < 0.5 * self.height_m => -axis,
            Part::Cap => axis,
        }
    }

    /// On the side u round the axis and v up from the base; flat coordinates on the ends.
    pub(crate) fn surface_point(&self, place: Vector, part: Part) -> SurfacePoint {
        let offset = place - self.base;
        match part {
            Part::Side | Part::Face(_) => SurfacePoint {
                u_m: self.radius_m * self.frame.angle_rad(offset),
                v_m: offset.dot(self.frame.axis),
            },
            Part::Cap => self.frame.flat(offset),
        }
    }
}
