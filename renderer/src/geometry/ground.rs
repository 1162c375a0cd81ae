//! The ground: a level plane without end.

use super::{Hit, Part, Ray, Span, SurfacePoint, Vector};

/// A plane across z.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ground {
    pub(crate) height_m: f64,
}

impl Ground {
    #[inline]
    pub(crate) fn hit(self, ray: &Ray, span: Span) -> Option<Hit> {
        let distance_m = (self.height_m - ray.origin.z) / ray.direction.z;
        span.holds(distance_m).then_some(Hit {
            distance_m,
            part: Part::Side,
        })
    }

    /// x and y of the world.
    pub(crate) fn surface_point(place: Vector) -> SurfacePoint {
        SurfacePoint {
            u_m: place.x,
            v_m: place.y,
        }
    }
}
