//! The box along the axes that holds a shape: a quick way to know that a ray misses it.

use super::{Ray, Span, Vector};

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

    /// Where the ray enters the box, if it does so within the span.
    ///
    /// `inverse` holds the reciprocals of the ray's direction.
    #[inline]
    pub(crate) fn entry_m(&self, ray: &Ray, inverse: Vector, span: Span) -> Option<f64> {
        let slab = |low: f64, high: f64, origin: f64, inverse: f64| {
            let (one, other) = ((low - origin) * inverse, (high - origin) * inverse);
            if one < other {
                (one, other)
            } else {
                (other, one)
            }
        };
        let (x_in, x_out) = slab(self.low.x, self.high.x, ray.origin.x, inverse.x);
        let (y_in, y_out) = slab(self.low.y, self.high.y, ray.origin.y, inverse.y);
        let (z_in, z_out) = slab(self.low.z, self.high.z, ray.origin.z, inverse.z);
        let entry = larger(larger(x_in, y_in), larger(z_in, span.from_m));
        let exit = smaller(smaller(x_out, y_out), smaller(z_out, span.to_m));
        (entry <= exit).then_some(entry)
    }
}

/// One instruction, unlike `f64::max`, which minds what is not a number.
#[inline]
fn larger(one: f64, other: f64) -> f64 {
    if one > other { one } else { other }
}

#[inline]
fn smaller(one: f64, other: f64) -> f64 {
    if one < other { one } else { other }
}
