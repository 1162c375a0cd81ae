//! A flat rectangle.

use super::{Bounds, Hit, Part, Ray, Span, SurfacePoint, Vector};

/// A rectangle, seen from both sides.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rectangle {
    corner: Vector,
    u: Vector,
    v: Vector,
    width_m: f64,
    height_m: f64,
    normal: Vector,
}

impl Rectangle {
    /// The rectangle of a corner and the two edges that leave it, which are at right angles.
    pub(crate) fn new(corner: Vector, edge_u: Vector, edge_v: Vector) -> Self {
        let (u, v) = (edge_u.normalized(), edge_v.normalized());
        Self {
            corner,
            u,
            v,
            width_m: edge_u.length(),
            height_m: edge_v.length(),
            normal: u.cross(v).normalized(),
        }
    }

    pub(crate) fn bounds(&self) -> Bounds {
        let (right, top) = (self.u * self.width_m, self.v * self.height_m);
        let one = Bounds::of_corners(self.corner, self.corner + right + top);
        one.joined(&Bounds::of_corners(self.corner + right, self.corner + top))
    }

    /// The four corners, one after another round it.
    pub(crate) fn corners(&self) -> [Vector; 4] {
        let (right, top) = (self.u * self.width_m, self.v * self.height_m);
        let corner = self.corner;
        [corner, corner + right, corner + right + top, corner + top]
    }

    #[inline]
    pub(crate) fn hit(&self, ray: &Ray, span: Span) -> Option<Hit> {
        let slope = ray.direction.dot(self.normal);
        let rise_m = (self.corner - ray.origin).dot(self.normal);
        // The plane is behind the ray; known without a division.
        if rise_m * slope <= 0.0 {
            return None;
        }
        let distance_m = rise_m / slope;
        if !span.holds(distance_m) {
            return None;
        }
        let SurfacePoint { u_m, v_m } = self.surface_point(ray.at(distance_m));
        let inside = (0.0..=self.width_m).contains(&u_m) && (0.0..=self.height_m).contains(&v_m);
        inside.then_some(Hit {
            distance_m,
            part: Part::Side,
        })
    }

    pub(crate) fn normal(&self) -> Vector {
        self.normal
    }

    /// Along the two edges from the corner.
    #[inline]
    pub(crate) fn surface_point(&self, place: Vector) -> SurfacePoint {
        let offset = place - self.corner;
        SurfacePoint {
            u_m: offset.dot(self.u),
            v_m: offset.dot(self.v),
        }
    }

    /// The part of edge u that the place is along, and the part of edge v that it is not: a picture stands
    /// upright if v points up.
    pub(crate) fn texture_point(&self, place: Vector) -> [f64; 2] {
        let SurfacePoint { u_m, v_m } = self.surface_point(place);
        [u_m / self.width_m, 1.0 - v_m / self.height_m]
    }
}
