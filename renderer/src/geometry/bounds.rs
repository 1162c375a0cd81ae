//! The box along the axes that holds a shape: a quick way to know that a ray misses it.

use super::Vector;

/// By how much a box is wider than its shape, so that rounding never hides a hit.
const MARGIN_M: f64 = 1e-7;

/// A box along the axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds {
    low: Vector,
    high: Vector,
}

impl Bounds {
    /// The box of two opposite corners, widened by the margin.
    pub(crate) fn of_corners(one: Vector, other: Vector) -> Self {
        let margin = Vector::new(MARGIN_M, MARGIN_M, MARGIN_M);
        Self {
            low: one.min(other) - margin,
            high: one.max(other) + margin,
        }
    }

    /// The box between the corner of the least coordinates and that of the greatest.
    pub(crate) const fn tight(low: Vector, high: Vector) -> Self {
        Self { low, high }
    }

    /// The box widened by this much on every side.
    #[inline]
    pub(crate) fn padded(&self, margin_m: f64) -> Self {
        let margin = Vector::new(margin_m, margin_m, margin_m);
        Self {
            low: self.low - margin,
            high: self.high + margin,
        }
    }

    /// Whether a place is in the box widened by this much.
    #[inline]
    pub(crate) fn is_within(&self, place: Vector, margin_m: f64) -> bool {
        let Self { low, high } = self.padded(margin_m);
        let is_between = |low: f64, x: f64, high: f64| low <= x && x <= high;
        is_between(low.x, place.x, high.x)
            && is_between(low.y, place.y, high.y)
            && is_between(low.z, place.z, high.z)
    }

    /// The box of two discs of the same axis, or of one given twice.
    pub(crate) fn of_discs(axis: Vector, discs: [(Vector, f64); 2]) -> Self {
        let extent = |radius_m: f64| {
            let across = |along: f64| radius_m * (1.0 - along * along).max(0.0).sqrt();
            Vector::new(across(axis.x), across(axis.y), across(axis.z))
        };
        let [one, other] = discs.map(|(center, radius_m)| {
            Self::of_corners(center - extent(radius_m), center + extent(radius_m))
        });
        one.joined(&other)
    }

    /// The box that holds both.
    pub(crate) fn joined(&self, other: &Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    /// The corner of the least coordinates.
    pub(crate) const fn low(&self) -> Vector {
        self.low
    }

    /// The corner of the greatest coordinates.
    pub(crate) const fn high(&self) -> Vector {
        self.high
    }

    /// The middle.
    pub(crate) fn center(&self) -> Vector {
        (self.low + self.high) * 0.5
    }

    /// How far a place is from the box; 0 inside.
    pub(crate) fn distance_m(&self, place: Vector) -> f64 {
        let nearest = place.max(self.low).min(self.high);
        (place - nearest).length()
    }

    /// The eight corners.
    pub(crate) fn corners(&self) -> [Vector; 8] {
        let (low, high) = (self.low, self.high);
        std::array::from_fn(|corner| {
            let pick = |bit: usize, low: f64, high: f64| if corner & bit == 0 { low } else { high };
            Vector::new(
                pick(1, low.x, high.x),
                pick(2, low.y, high.y),
                pick(4, low.z, high.z),
            )
        })
    }
}
