//! A pyramid of directions from one place, cut into a grid of narrow ones.

use super::Vector;

/// How far outside the corners the directions a little outside them are, in radians.
const BEYOND: f64 = 1e-4;

/// A pyramid whose apex is the place of the rays: the directions `forward + s right + t up`, s and t from −1
/// to 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pyramid {
    pub(crate) apex: Vector,
    pub(crate) forward: Vector,
    pub(crate) right: Vector,
    pub(crate) up: Vector,
}

/// A square of the grid of `side` × `side` cells that a pyramid is cut into.
#[derive(Clone, Copy, Debug)]
pub(super) struct Square {
    pub(super) column: u32,
    pub(super) row: u32,
    pub(super) side: u32,
}

impl Square {
    /// The whole pyramid.
    pub(super) const WHOLE: Self = Self {
        column: 0,
        row: 0,
        side: 1,
    };

    /// The parts of this square, `parts` along each side, row by row.
    pub(super) fn parts(self, parts: u32) -> impl Iterator<Item = Self> {
        (0..parts * parts).map(move |part| Self {
            column: self.column * parts + part % parts,
            row: self.row * parts + part / parts,
            side: self.side * parts,
        })
    }
}

/// The directions of one square. Places are reckoned from the apex.
#[derive(Clone, Copy, Debug)]
pub(super) struct NarrowPyramid {
    /// Unit directions through the corners, one after another round it.
    pub(super) corners: [Vector; 4],
    /// Unit normals of its sides, towards its inside.
    pub(super) inwards: [Vector; 4],
    /// The unit direction through its middle.
    pub(super) axis: Vector,
    /// Unit directions a little outside the corners.
    pub(super) beyond_corners: [Vector; 4],
    /// The least cosine between the axis and a direction of the pyramid.
    pub(super) least_cos: f64,
}

impl Pyramid {
    /// The directions of a square of the grid; rows run downwards.
    pub(super) fn within(&self, square: Square) -> NarrowPyramid {
        let side = f64::from(square.side);
        let place = |cell: u32| 2.0 * f64::from(cell) / side - 1.0;
        let [left, right] = [square.column, square.column + 1].map(place);
        let [top, bottom] = [square.row, square.row + 1].map(|row| -place(row));
        let direction = |s: f64, t: f64| self.forward + self.right * s + self.up * t;
        let corners = [
            direction(left, top),
            direction(right, top),
            direction(right, bottom),
            direction(left, bottom),
        ]
        .map(Vector::normalized);
        let middle = corners.iter().fold(Vector::default(), |sum, &c| sum + c);
        let axis = middle.normalized();
        let inwards = std::array::from_fn(|side| {
            let across = corners[side].cross(corners[(side + 1) % 4]).normalized();
            across * across.dot(axis).signum()
        });
        let cosines = corners.map(|corner| corner.dot(axis));
        let beyond = |corner: Vector| {
            let outwards = (corner - axis).normalized();
            (corner + outwards * BEYOND).normalized()
        };
        NarrowPyramid {
            corners,
            beyond_corners: corners.map(beyond),
            inwards,
            axis,
            least_cos: cosines.into_iter().fold(1.0, f64::min),
        }
    }
}
