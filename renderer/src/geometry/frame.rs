//! An axis with two directions across it: the local coordinates of round shapes.

use super::{SurfacePoint, Vector};

/// Three orthogonal unit vectors.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    pub(crate) axis: Vector,
    across: Vector,
    along: Vector,
}

impl Frame {
    /// A frame about a unit axis; for the axis z, `across` is x and `along` is y.
    pub(crate) fn about(axis: Vector) -> Self {
        let helper = if axis.z.abs() < 0.9 {
            Vector::UP
        } else {
            Vector::new(0.0, 1.0, 0.0)
        };
        let across = helper.cross(axis).normalized();
        let along = axis.cross(across);
        Self {
            axis,
            across,
            along,
        }
    }

    /// The two directions across the axis.
    pub(crate) const fn sides(&self) -> [Vector; 2] {
        [self.across, self.along]
    }

    /// The coordinates across the axis.
    pub(crate) fn flat(&self, offset: Vector) -> SurfacePoint {
        SurfacePoint {
            u_m: offset.dot(self.across),
            v_m: offset.dot(self.along),
        }
    }

    /// The angle about the axis, in radians from −π to π.
    pub(crate) fn angle_rad(&self, offset: Vector) -> f64 {
        let flat = self.flat(offset);
        libm::atan2(flat.v_m, flat.u_m)
    }
}
