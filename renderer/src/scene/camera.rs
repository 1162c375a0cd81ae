//! A pinhole camera.

use crate::geometry::{Pyramid, Ray, Vector};
use crate::sampler::ScreenPoint;

/// A camera: where it stands and its screen at a distance of 1 m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Camera {
    position: Vector,
    forward: Vector,
    right: Vector,
    up: Vector,
    half_height: f64,
}

impl Camera {
    /// A camera at `position` that looks along the unit vector `forward`; `up` is not parallel to it.
    pub(crate) fn new(
        position: Vector,
        forward: Vector,
        up: Vector,
        vertical_field_of_view_deg: f64,
    ) -> Self {
        let right = forward.cross(up).normalized();
        Self {
            position,
            forward,
            right,
            up: right.cross(forward),
            half_height: libm::tan(0.5 * vertical_field_of_view_deg.to_radians()),
        }
    }

    /// Where it stands.
    pub(crate) fn position(&self) -> Vector {
        self.position
    }

    /// What the camera sees.
    pub(crate) fn pyramid(&self, aspect: f64) -> Pyramid {
        Pyramid {
            apex: self.position,
            forward: self.forward,
            right: self.right * (aspect * self.half_height),
            up: self.up * self.half_height,
        }
    }

    /// The ray through a point of a screen that is `aspect` times as wide as high.
    #[inline]
    pub(crate) fn ray(&self, at: ScreenPoint, aspect: f64) -> Ray {
        let across = (2.0 * at.x - 1.0) * aspect * self.half_height;
        let upwards = (1.0 - 2.0 * at.y) * self.half_height;
        let direction = self.forward + self.right * across + self.up * upwards;
        Ray {
            origin: self.position,
            direction: direction.normalized(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_corners_of_the_screen_are_half_the_field_of_view_away() {
        // Looking along y with z up, x is to the right; tan 45° = 1.
        let forward = Vector::new(0.0, 1.0, 0.0);
        let camera = Camera::new(Vector::new(1.0, 2.0, 3.0), forward, Vector::UP, 90.0);
        let middle = camera.ray(ScreenPoint { x: 0.5, y: 0.5 }, 2.0);
        assert!((middle.direction - forward).length() < 1e-15);
        assert_eq!(middle.origin, Vector::new(1.0, 2.0, 3.0));
        let top_right = camera.ray(ScreenPoint { x: 1.0, y: 0.0 }, 2.0).direction;
        let expected = Vector::new(2.0, 1.0, 1.0).normalized();
        assert!((top_right - expected).length() < 1e-15);
    }
}
