//! A cone with a flat base.

use super::ray::quadratic_roots;
use super::{Bounds, Frame, Hit, Part, Ray, Span, SurfacePoint, Vector};

/// A cone from the middle of its base to its apex.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cone {
    base: Vector,
    frame: Frame,
    height_m: f64,
    radius_m: f64,
}

impl Cone {
    /// The cone between the middle of its base and its apex, which differ.
    pub(crate) fn between(base: Vector, apex: Vector, radius_m: f64) -> Self {
        Self {
            base,
            frame: Frame::about((apex - base).normalized()),
            height_m: (apex - base).length(),
            radius_m,
        }
    }

    /// By how much the radius shrinks for each metre of height.
    fn taper(&self) -> f64 {
        self.radius_m / self.height_m
    }

    pub(crate) fn bounds(&self) -> Bounds {
        let axis = self.frame.axis;
        let apex = self.base + axis * self.height_m;
        Bounds::of_discs(axis, [(self.base, self.radius_m), (apex, 0.0)])
    }

    /// Balls round the base and the apex.
    pub(crate) fn ends(&self) -> [(Vector, f64); 2] {
        let apex = self.base + self.frame.axis * self.height_m;
        [(self.base, self.radius_m), (apex, 0.0)]
    }

    #[inline]
    pub(crate) fn hit(&self, ray: &Ray, span: Span) -> Option<Hit> {
        let axis = self.frame.axis;
        let offset = ray.origin - self.base;
        let (rise, height_m) = (ray.direction.dot(axis), offset.dot(axis));
        let across = ray.direction - axis * rise;
        let aside = offset - axis * height_m;
        let (across_squared, across_aside) = (across.length_squared(), across.dot(aside));
        let taper_squared = self.taper() * self.taper();
        let below_apex_m = self.height_m - height_m;
        let roots = quadratic_roots(
            across_squared - taper_squared * rise * rise,
            across_aside + taper_squared * rise * below_apex_m,
            aside.length_squared() - taper_squared * below_apex_m * below_apex_m,
        );
        let mut span = span;
        let on_side =
            |&t: &f64| span.holds(t) && (0.0..=self.height_m).contains(&(height_m + t * rise));
        let side = roots.and_then(|roots| roots.into_iter().find(on_side));
        let mut nearest = side.map(|distance_m| Hit {
            distance_m,
            part: Part::Side,
        });
        span.to_m = side.unwrap_or(span.to_m);
        let distance_m = -height_m / rise;
        let from_axis_squared = (aside + across * distance_m).length_squared();
        if span.holds(distance_m) && from_axis_squared <= self.radius_m * self.radius_m {
            nearest = Some(Hit {
                distance_m,
                part: Part::Cap,
            });
        }
        nearest
    }

    pub(crate) fn normal(&self, place: Vector, part: Part) -> Vector {
        let axis = self.frame.axis;
        if part == Part::Cap {
            return -axis;
        }
        let offset = place - self.base;
        let aside = offset - axis * offset.dot(axis);
        let distance_m = aside.length();
        if distance_m < 1e-12 {
            return axis;
        }
        (aside * distance_m.recip() + axis * self.taper()).normalized()
    }

    /// On the side u round the base by angle and v up the slope; flat coordinates on the base.
    pub(crate) fn surface_point(&self, place: Vector, part: Part) -> SurfacePoint {
        let offset = place - self.base;
        match part {
            Part::Side | Part::Face(_) => SurfacePoint {
                u_m: self.radius_m * self.frame.angle_rad(offset),
                v_m: offset.dot(self.frame.axis) * (1.0 + self.taper() * self.taper()).sqrt(),
            },
            Part::Cap => self.frame.flat(offset),
        }
    }
}
