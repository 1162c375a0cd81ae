//! A pyramid of directions from one place, cut into a grid of narrow ones.

use super::Vector;

/// How far outside its edges the directions a little outside a square are, as a tangent.
const BEYOND: f64 = 1e-3;

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
    /// The least cosine between the axis and a direction of the pyramid.
    pub(super) least_cos: f64,
}

/// A pyramid with the planes through its apex that part it into columns and rows.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    pyramid: Pyramid,
    /// How many columns and rows there are.
    side: u32,
    /// Unit normals of the planes beside the columns, to the right.
    columns: Vec<Vector>,
    /// Of those above and below the rows, upwards.
    rows: Vec<Vector>,
}

impl Grid {
    /// The planes for so many columns and as many rows.
    pub(super) fn new(pyramid: &Pyramid, side: u32) -> Self {
        let Pyramid {
            forward, right, up, ..
        } = *pyramid;
        let across = |one: Vector, other: Vector, towards: Vector| {
            let normal = one.cross(other).normalized();
            normal * normal.dot(towards).signum()
        };
        let places = (0..=side).map(|edge| place(edge, side));
        let columns = places
            .clone()
            .map(|s| across(forward + right * s, up, right));
        let rows = places.map(|t| across(forward - up * t, right, up));
        Self {
            pyramid: *pyramid,
            side,
            columns: columns.collect(),
            rows: rows.collect(),
        }
    }

    /// The place of all the rays.
    pub(super) fn apex(&self) -> Vector {
        self.pyramid.apex
    }

    /// The directions of a square; rows run downwards.
    pub(super) fn within(&self, square: Square) -> NarrowPyramid {
        let corners = self.corners(square, [0.0; 2]);
        let middle = corners.iter().fold(Vector::default(), |sum, &c| sum + c);
        let axis = middle.normalized();
        let step = self.side / square.side;
        let edge = |cell: u32| (cell * step) as usize;
        let cosines = corners.map(|corner| corner.dot(axis));
        NarrowPyramid {
            corners,
            inwards: [
                self.columns[edge(square.column)],
                -self.columns[edge(square.column + 1)],
                -self.rows[edge(square.row)],
                self.rows[edge(square.row + 1)],
            ],
            axis,
            least_cos: cosines.into_iter().fold(1.0, f64::min),
        }
    }

    /// Unit directions a little outside the corners of a square.
    pub(super) fn beyond(&self, square: Square) -> [Vector; 4] {
        let Pyramid {
            forward, right, up, ..
        } = self.pyramid;
        let tangent = BEYOND * forward.length();
        self.corners(square, [tangent / right.length(), tangent / up.length()])
    }

    /// Unit directions through the corners of a square that is wider by these margins on each side.
    fn corners(&self, square: Square, [aside, above]: [f64; 2]) -> [Vector; 4] {
        let Pyramid {
            forward, right, up, ..
        } = self.pyramid;
        let [left, other] = [square.column, square.column + 1].map(|c| place(c, square.side));
        let [top, bottom] = [square.row, square.row + 1].map(|row| -place(row, square.side));
        let [left, other] = [left - aside, other + aside];
        let [top, bottom] = [top + above, bottom - above];
        let direction = |s: f64, t: f64| (forward + right * s + up * t).normalized();
        [
            direction(left, top),
            direction(other, top),
            direction(other, bottom),
            direction(left, bottom),
        ]
    }
}

/// An edge of a cell from −1 to 1.
fn place(edge: u32, side: u32) -> f64 {
    2.0 * f64::from(edge) / f64::from(side) - 1.0
}
