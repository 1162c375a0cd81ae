//! A box, which may be turned about z.

use super::{Bounds, Hit, Part, Ray, Span, SurfacePoint, Vector};

/// A box: its middle, half its size, and how it is turned.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cuboid {
    center: Vector,
    half_size: Vector,
    cos: f64,
    sin: f64,
}

impl Cuboid {
    /// A box turned about the vertical through its middle, from x towards y.
    pub(crate) fn new(center: Vector, size: Vector, rotation_deg: f64) -> Self {
        let rotation_rad = rotation_deg.to_radians();
        Self {
            center,
            half_size: size * 0.5,
            cos: libm::cos(rotation_rad),
            sin: libm::sin(rotation_rad),
        }
    }

    /// A direction of the world in the box's own axes.
    #[inline]
    fn local(&self, v: Vector) -> Vector {
        Vector::new(
            self.cos * v.x + self.sin * v.y,
            self.cos * v.y - self.sin * v.x,
            v.z,
        )
    }

    fn world(&self, v: Vector) -> Vector {
        Vector::new(
            self.cos * v.x - self.sin * v.y,
            self.sin * v.x + self.cos * v.y,
            v.z,
        )
    }

    pub(crate) fn bounds(&self) -> Bounds {
        let (cos, sin, half) = (self.cos.abs(), self.sin.abs(), self.half_size);
        let extent = Vector::new(
            cos * half.x + sin * half.y,
            sin * half.x + cos * half.y,
            half.z,
        );
        Bounds::of_corners(self.center - extent, self.center + extent)
    }

    /// The eight corners.
    pub(crate) fn corners(&self) -> [Vector; 8] {
        let half = self.half_size;
        Bounds::of_corners(-half, half)
            .corners()
            .map(|corner| self.center + self.world(corner))
    }

    #[inline]
    pub(crate) fn hit(&self, ray: &Ray, span: Span) -> Option<Hit> {
        let origin = self.local(ray.origin - self.center);
        let direction = self.local(ray.direction);
        let mut entry_m = f64::NEG_INFINITY;
        let mut exit_m = f64::INFINITY;
        for (origin, direction, half) in [
            (origin.x, direction.x, self.half_size.x),
            (origin.y, direction.y, self.half_size.y),
            (origin.z, direction.z, self.half_size.z),
        ] {
            if direction == 0.0 {
                if origin.abs() > half {
                    return None;
                }
                continue;
            }
            let inverse = direction.recip();
            let (one, other) = ((-half - origin) * inverse, (half - origin) * inverse);
            entry_m = entry_m.max(one.min(other));
            exit_m = exit_m.min(one.max(other));
        }
        if entry_m > exit_m {
            return None;
        }
        let distance_m = [entry_m, exit_m].into_iter().find(|&t| span.holds(t))?;
        Some(Hit {
            distance_m,
            part: Part::Side,
        })
    }

    /// The axis of the face that a place lies on, and its place in the box's own axes.
    fn face(&self, place: Vector) -> (Face, Vector) {
        let local = self.local(place - self.center);
        let depth = |coordinate: f64, half: f64| half - coordinate.abs();
        let (x, y, z) = (
            depth(local.x, self.half_size.x),
            depth(local.y, self.half_size.y),
            depth(local.z, self.half_size.z),
        );
        let face = if x <= y && x <= z {
            Face::X
        } else if y <= z {
            Face::Y
        } else {
            Face::Z
        };
        (face, local)
    }

    pub(crate) fn normal(&self, place: Vector) -> Vector {
        let (face, local) = self.face(place);
        self.world(match face {
            Face::X => Vector::new(1.0_f64.copysign(local.x), 0.0, 0.0),
            Face::Y => Vector::new(0.0, 1.0_f64.copysign(local.y), 0.0),
            Face::Z => Vector::new(0.0, 0.0, 1.0_f64.copysign(local.z)),
        })
    }

    /// From a corner of the face, along the two other axes, in the order x, y, z.
    pub(crate) fn surface_point(&self, place: Vector) -> SurfacePoint {
        let (face, local) = self.face(place);
        let corner = local + self.half_size;
        let (u_m, v_m) = match face {
            Face::X => (corner.y, corner.z),
            Face::Y => (corner.x, corner.z),
            Face::Z => (corner.x, corner.y),
        };
        SurfacePoint { u_m, v_m }
    }
}

/// The axis that a face is across.
#[derive(Clone, Copy, Debug)]
enum Face {
    X,
    Y,
    Z,
}
