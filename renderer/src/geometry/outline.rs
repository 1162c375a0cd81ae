//! What is known of a shape as seen from one place: in which directions, how far, and what it may hide.
//!
//! Everything here errs to one side: a shape may be said to be met, or to hide another, where it does not.
//! Places are reckoned from the place of the viewer, the apex.

use arrayvec::ArrayVec;

use super::pyramid::NarrowPyramid;
use super::shape::Hull;
use super::{Shape, Vector};

/// By how much shapes are thickened: a shadow ray starts 1e-6 m off the line from its surface to the light.
const MARGIN_M: f64 = 1e-5;
/// A place this far beyond a plane still counts as on it: more than rounding, and less than a shadow ray
/// starts off its surface.
const FLAT_M: f64 = 1e-9;
/// So many planes of flat shapes are told apart, one for each bit.
const MAX_PLANES: usize = 64;

/// A plane that does not hold the apex.
#[derive(Clone, Copy, Debug)]
struct Plane {
    /// The unit normal away from the apex.
    normal: Vector,
    /// How far it is from the apex.
    rise_m: f64,
}

/// A shape as seen from an apex.
#[derive(Clone, Debug)]
pub(super) struct Outline {
    hull: Hull,
    plane: Option<Plane>,
    /// Planes through the apex or beside it: the shape is where `normal · place` is no more than this.
    limits: ArrayVec<(Vector, f64), 4>,
    near_m: f64,
    far_m: f64,
    /// Light that falls on one side of it does not meet it before.
    is_convex: bool,
    /// The bit of its plane; 0 if it has none.
    own_plane: u64,
    /// The planes that it is wholly on the apex's side of.
    before: u64,
    /// The planes that it is wholly beyond.
    beyond: u64,
}

/// Between which distances of the apex the rays of a pyramid may meet a shape.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    pub(super) near_m: f64,
    pub(super) far_m: f64,
}

impl Outline {
    /// The outlines of all shapes from a place.
    pub(super) fn from_apex(apex: Vector, shapes: &[Shape]) -> Vec<Self> {
        let mut outlines: Vec<Self> = shapes.iter().map(|shape| Self::new(apex, shape)).collect();
        let mut planes: ArrayVec<Plane, MAX_PLANES> = ArrayVec::new();
        for outline in &mut outlines {
            outline.own_plane = outline.plane.map_or(0, |plane| number(plane, &mut planes));
        }
        for outline in &mut outlines {
            for (bit, plane) in planes.iter().enumerate() {
                outline.before |= u64::from(outline.is_before(plane)) << bit;
                outline.beyond |= u64::from(outline.is_beyond(plane)) << bit;
            }
        }
        outlines
    }

    fn new(apex: Vector, shape: &Shape) -> Self {
        let from_apex = |(center, radius_m): (Vector, f64)| (center - apex, radius_m);
        let hull: Hull = shape.hull().into_iter().map(from_apex).collect();
        let to_bounds = shape.bounds().map_or(0.0, |b| b.distance_m(apex));
        let near_m = match hull.as_slice() {
            &[(center, radius_m)] => to_bounds.max(center.length() - radius_m),
            _ => to_bounds,
        };
        let reach = |&(center, radius_m): &(Vector, f64)| center.length() + radius_m;
        let far_m = hull.iter().map(reach).reduce(f64::max);
        Self {
            plane: shape
                .plane()
                .and_then(|(place, normal)| Plane::new(place - apex, normal)),
            limits: limits(&hull),
            hull,
            near_m: (near_m - MARGIN_M) * (1.0 - 1e-9),
            far_m: far_m.map_or(f64::INFINITY, |far_m| far_m + MARGIN_M),
            is_convex: shape.is_convex(),
            own_plane: 0,
            before: 0,
            beyond: 0,
        }
    }

    fn is_before(&self, plane: &Plane) -> bool {
        let reach = |&(center, radius_m): &(Vector, f64)| center.dot(plane.normal) + radius_m;
        !self.hull.is_empty()
            && self
                .hull
                .iter()
                .all(|ball| reach(ball) <= plane.rise_m + FLAT_M)
    }

    fn is_beyond(&self, plane: &Plane) -> bool {
        let reach = |&(center, radius_m): &(Vector, f64)| center.dot(plane.normal) - radius_m;
        !self.hull.is_empty()
            && self
                .hull
                .iter()
                .all(|ball| reach(ball) >= plane.rise_m - FLAT_M)
    }

    /// No ray from the apex meets the shape nearer than this.
    pub(super) fn near_m(&self) -> f32 {
        single(self.near_m * (1.0 - 1e-6))
    }

    /// Where the rays of a pyramid may meet the shape; `None` if they all miss it.
    pub(super) fn within(&self, pyramid: &NarrowPyramid) -> Option<Reach> {
        if self.hull.is_empty() {
            return self.endless_within(pyramid);
        }
        let is_beside = |inwards: &Vector| {
            let mut balls = self.hull.iter();
            balls.all(|&(center, radius_m)| center.dot(*inwards) < -(radius_m + MARGIN_M))
        };
        if pyramid.inwards.iter().any(is_beside) {
            return None;
        }
        let along_m = self.hull.iter().map(|ball| along(ball, pyramid));
        let along_m = along_m.fold(f64::INFINITY, f64::min);
        // A place of the pyramid that is so far along its axis is Σ λ corner with Σ λ no less than that.
        let least_m = (along_m - MARGIN_M).max(0.0);
        let is_past = |&(normal, limit_m): &(Vector, f64)| {
            let corners = pyramid.corners.iter();
            let least = corners
                .map(|corner| corner.dot(normal))
                .fold(f64::INFINITY, f64::min);
            least > 0.0 && least * least_m > limit_m
        };
        if self.limits.iter().any(is_past) {
            return None;
        }
        let of_plane = self.plane.map(|plane| plane.within(pyramid));
        let near_m = of_plane.map_or(along_m, |plane| plane.near_m.max(along_m));
        let far_m = of_plane.map_or(self.far_m, |plane| plane.far_m.min(self.far_m));
        Some(Reach {
            near_m: self.near_m.max((near_m - MARGIN_M) * (1.0 - 1e-9)),
            far_m,
        })
    }

    fn endless_within(&self, pyramid: &NarrowPyramid) -> Option<Reach> {
        let Some(plane) = self.plane else {
            return Some(Reach {
                near_m: 0.0,
                far_m: f64::INFINITY,
            });
        };
        let is_away = |corner: &Vector| corner.dot(plane.normal) < 0.0;
        if pyramid.corners.iter().all(is_away) {
            return None;
        }
        let Reach { near_m, far_m } = plane.within(pyramid);
        Some(Reach {
            near_m: (near_m - MARGIN_M) * (1.0 - 1e-9),
            far_m,
        })
    }

    /// Whether this shape may stand between the apex and a place of `lit` that faces it; both are in one
    /// pyramid, at these distances.
    pub(super) fn may_hide(&self, reach: Reach, lit: &Self, lit_reach: Reach) -> bool {
        let is_lit = std::ptr::eq(self, lit);
        let is_parted = self.own_plane & lit.before != 0 || lit.own_plane & self.beyond != 0;
        !(is_parted || is_lit && self.is_convex) && reach.near_m < lit_reach.far_m
    }
}

impl Plane {
    /// The plane through a place across a unit normal; `None` if it holds the apex.
    fn new(place: Vector, normal: Vector) -> Option<Self> {
        let rise_m = place.dot(normal);
        let (normal, rise_m) = if rise_m < 0.0 {
            (-normal, -rise_m)
        } else {
            (normal, rise_m)
        };
        (rise_m > MARGIN_M).then_some(Self { normal, rise_m })
    }

    /// Where the rays of a pyramid meet the plane.
    fn within(&self, pyramid: &NarrowPyramid) -> Reach {
        let cosines = pyramid.corners.map(|corner| corner.dot(self.normal));
        let most = cosines.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let least = cosines.into_iter().fold(f64::INFINITY, f64::min);
        // A unit direction of the pyramid is Σ λ corner with Σ λ from 1 to the reciprocal of `least_cos`.
        let near_m = if most > 0.0 {
            self.rise_m / most * pyramid.least_cos
        } else {
            0.0
        };
        let far_m = if least > 0.0 {
            self.rise_m / least + MARGIN_M
        } else {
            f64::INFINITY
        };
        Reach { near_m, far_m }
    }
}

/// The bit of a plane among those known; 0 if there are too many.
fn number(plane: Plane, planes: &mut ArrayVec<Plane, MAX_PLANES>) -> u64 {
    let is_same = |known: &Plane| {
        let turned = (known.normal - plane.normal).length();
        turned <= 1e-12 && (known.rise_m - plane.rise_m).abs() <= FLAT_M / 8.0
    };
    let place = planes.iter().position(is_same);
    let place = place.or_else(|| {
        planes.try_push(plane).ok()?;
        Some(planes.len() - 1)
    });
    place.map_or(0, |bit| 1 << bit)
}

/// How far along the axis of a pyramid a ball begins.
///
/// A place at the distance d in a direction of the pyramid is at most d along its axis.
fn along(&(center, radius_m): &(Vector, f64), pyramid: &NarrowPyramid) -> f64 {
    center.dot(pyramid.axis) - radius_m
}

/// Planes beside a long or flat shape, so that a narrow pyramid that passes it by is told from one that does
/// not: those along the axis of two balls, or through the edges of a quadrangle.
fn limits(hull: &Hull) -> ArrayVec<(Vector, f64), 4> {
    let mut limits = ArrayVec::new();
    match *hull.as_slice() {
        [(one, one_m), (other, other_m)] => {
            let across = one.cross(other).normalized();
            if across.length_squared() > 0.5 {
                let limit_m = one_m.max(other_m) + MARGIN_M;
                limits.extend([(across, limit_m), (-across, limit_m)]);
            }
        }
        [(a, _), (b, _), (c, _), (d, _)] => {
            let middle = a + b + c + d;
            for (one, other) in [(a, b), (b, c), (c, d), (d, a)] {
                let across = one.cross(other).normalized();
                if across.length_squared() > 0.5 {
                    limits.push((across * -across.dot(middle).signum(), MARGIN_M));
                }
            }
        }
        _ => {}
    }
    limits
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "rounded after being made too small"
)]
fn single(value: f64) -> f32 {
    value as f32
}
