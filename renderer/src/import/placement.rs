//! Where a file stands in the world: turned, scaled and moved.

use crate::matrix3::{self, Matrix3};

/// The affine map `linear · place + offset` from a file's coordinates to the world's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Placement {
    pub(crate) linear: Matrix3,
    pub(crate) offset: [f64; 3],
}

impl Placement {
    /// A quarter turn about x that makes a file's y the world's z: x stays, what was −z is y.
    pub(crate) const Y_UP: Self = Self {
        linear: [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]],
        offset: [0.0; 3],
    };

    /// Scaled, then turned about z from x towards y, then moved.
    pub(crate) fn new(scale: f64, rotation_deg: f64, position: [f64; 3]) -> Self {
        let angle_rad = rotation_deg.to_radians();
        let (sin, cos) = (scale * libm::sin(angle_rad), scale * libm::cos(angle_rad));
        Self {
            linear: [[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, scale]],
            offset: position,
        }
    }

    /// The map that takes `inner` first and then this one.
    pub(crate) fn after(&self, inner: &Self) -> Self {
        Self {
            linear: matrix3::product(&self.linear, &inner.linear),
            offset: self.place(inner.offset),
        }
    }

    /// A place in the world.
    pub(crate) fn place(&self, place: [f64; 3]) -> [f64; 3] {
        let turned = self.direction(place);
        [0, 1, 2].map(|axis| turned[axis] + self.offset[axis])
    }

    /// A direction in the world, of another length.
    pub(crate) fn direction(&self, direction: [f64; 3]) -> [f64; 3] {
        matrix3::times(&self.linear, direction)
    }

    /// The map of normals: the cofactors, which are the inverse transpose times the determinant.
    pub(crate) fn for_normals(&self) -> Matrix3 {
        let [a, b, c] = self.linear;
        let sign = if self.mirrors() { -1.0 } else { 1.0 };
        [cross(b, c), cross(c, a), cross(a, b)].map(|row| row.map(|value| sign * value))
    }

    /// Whether the map turns a right hand into a left one, and so a triangle's outside in.
    pub(crate) fn mirrors(&self) -> bool {
        matrix3::determinant(&self.linear) < 0.0
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn y_up_becomes_z_up_and_a_turn_goes_from_x_to_y() {
        assert_eq!(Placement::Y_UP.place([1.0, 2.0, 3.0]), [1.0, -3.0, 2.0]);
        let turned = Placement::new(2.0, 90.0, [0.0, 0.0, 5.0]).after(&Placement::Y_UP);
        let place = turned.place([1.0, 1.0, 0.0]);
        for (ours, expected) in place.into_iter().zip([0.0, 2.0, 7.0]) {
            assert!((ours - expected).abs() < 1e-12, "{place:?}");
        }
        assert!(!turned.mirrors());
    }

    #[test]
    fn normals_stay_at_right_angles_to_a_sheared_and_mirrored_surface() {
        let sheared = Placement {
            linear: [[-2.0, 0.5, 0.0], [0.0, 1.0, 0.3], [0.1, 0.0, 3.0]],
            offset: [1.0; 3],
        };
        assert!(sheared.mirrors());
        let (u, v) = ([1.0, 2.0, 0.5], [-1.0, 0.3, 2.0]);
        let normal = matrix3::times(&sheared.for_normals(), cross(u, v));
        for along in [u, v] {
            let along = sheared.direction(along);
            let dot: f64 = (0..3).map(|axis| along[axis] * normal[axis]).sum();
            assert!(dot.abs() < 1e-12);
        }
    }
}
