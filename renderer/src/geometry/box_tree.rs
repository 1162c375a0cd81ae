//! Boxes within boxes, eight to a node, so that a ray is tried against few of many things.
//!
//! The boxes are in single precision and a little too wide, so that no hit is ever hidden: what a ray finds
//! does not depend on how the boxes were nested, nor on the machine that nested them.
//!
//! Not here: what is in the boxes. The tree only says which things may be met.
//!
//! Source: Wald, Benthin & Boulos (2008) for nodes of many boxes.

use std::ops::Range;

use super::box_node::{BoxNode, Child};
use super::descent::{Descent, Visitor, Walk};
use super::flock::{Flight, Flock};
use super::single_ray::rounded;
use super::split_tree::{SingleBox, SplitTree};
use super::wide_tree::WideTree;
use super::{Bounds, Ray, SingleRay, Span, Vector};

/// By how much a box is wider than what it holds, as a part of the whole tree's diameter.
///
/// With u = 2⁻²⁴, an origin near the tree, rounded to single precision, is off by u times the diameter; so are
/// the difference from a plane, the direction, its reciprocal and their product: together less than 6 u. What
/// is in the boxes may stand out of them by half of the margin, which is 16 u.
pub(crate) const MARGIN: f64 = 1e-6;
/// How far off a ray may begin, as a multiple of the radius: from there on double precision itself is no
/// finer than a part of the margin, and everything is tried.
const FARTHEST: f64 = 16_777_216.0;
/// The diameters for which nothing overflows or vanishes in single precision.
const DIAMETERS_M: Range<f64> = 1e-9..1e15;

/// A tree over numbered things with boxes.
#[derive(Clone, Debug)]
pub(crate) struct BoxTree {
    /// The origin of the single-precision coordinates; it is itself in single precision.
    middle: Vector,
    bounds: Option<Bounds>,
    /// How far from the middle the bounds reach.
    radius_m: f64,
    /// How far from the middle a ray may begin.
    farthest_m: f64,
    descent: Descent,
    nodes: Vec<BoxNode>,
    /// The numbers of the things, leaf by leaf.
    order: Vec<u32>,
    /// How many places the leaves have together.
    places: usize,
}

/// How a ray comes to a tree.
enum Approach {
    /// It may meet what the boxes say.
    Near(SingleRay),
    /// It meets nothing.
    Past,
    /// It begins so far off that it may meet anything.
    Unclear,
}

impl BoxTree {
    /// The tree over things with these boxes; each is known by its place among them. A leaf holds at most
    /// `most_in_leaf`, from 1 to 7: what costs as much as a visit.
    pub(crate) fn over(boxes: &[Bounds], most_in_leaf: usize) -> Self {
        let all = boxes.iter().copied();
        let all = all.reduce(|one, other| one.joined(&other));
        let middle = all.map_or([0.0; 3], |bounds| rounded(bounds.center()));
        let middle = Vector::from(middle.map(f64::from));
        let radius_m = all.map_or(0.0, |bounds| {
            let beside = (bounds.high() - middle).max(middle - bounds.low());
            beside.length() * (1.0 + 2.0 * MARGIN)
        });
        let margin_m = MARGIN * 2.0 * radius_m;
        let bounds = all.map(|bounds| bounds.padded(margin_m));
        let is_single = DIAMETERS_M.contains(&(2.0 * radius_m));
        let wide = nested(boxes, most_in_leaf, (middle, margin_m));
        Self {
            middle,
            bounds,
            radius_m,
            farthest_m: if is_single { FARTHEST * radius_m } else { 0.0 },
            descent: Descent::best(),
            nodes: wide.nodes,
            order: wide.order,
            places: boxes.len(),
        }
    }

    /// Renames what is in the leaves: `place_of` is given the places of each leaf, as ranges of
    /// [`Self::order`], and says the one place that stands for them from now on.
    pub(crate) fn pack(&mut self, mut place_of: impl FnMut(Range<usize>) -> u32) {
        self.places = 0;
        let children = self.nodes.iter_mut().flat_map(BoxNode::children_mut);
        for leaf in children.filter(|child| child.count() > 0) {
            let places = leaf.first()..leaf.first() + leaf.count();
            *leaf = Child::leaf(place_of(places), 1);
            self.places += 1;
        }
    }

    /// The numbers of the things in the order in which they stand in leaves.
    pub(crate) fn order(&self) -> &[u32] {
        &self.order
    }

    /// The box of all, with the margin.
    pub(crate) fn bounds(&self) -> Option<Bounds> {
        self.bounds
    }

    /// The origin of the coordinates of a [`SingleRay`].
    pub(crate) fn middle(&self) -> Vector {
        self.middle
    }

    /// The diameter of the sphere around the middle that holds all.
    pub(crate) fn diameter_m(&self) -> f64 {
        2.0 * self.radius_m
    }

    /// The same tree, as every processor goes through it.
    #[cfg(test)]
    pub(crate) fn plain(self) -> Self {
        Self {
            descent: Descent::plain(),
            ..self
        }
    }

    /// Shows the visitor what a ray may meet within the span.
    #[inline]
    pub(crate) fn visit(&self, ray: &Ray, span: Span, visitor: &mut impl Visitor) -> Walk {
        match self.approach(ray) {
            Approach::Near(single) => self.descent.visit(&self.nodes, &single, span, visitor),
            Approach::Past => Walk::On,
            Approach::Unclear => visitor.visit(0..self.places, None, &mut { span }),
        }
    }

    /// Shows `leaf` which of many rays, each with its place among all, may meet what is in which places.
    pub(crate) fn visit_all<'a>(
        &self,
        rays: impl Iterator<Item = (u32, &'a Ray)>,
        flock: &mut Flock,
        mut leaf: impl FnMut(Range<usize>, &[u32]),
    ) {
        flock.singles.clear();
        for (place, ray) in rays {
            match self.approach(ray) {
                Approach::Near(single) => flock.singles.push((single, place)),
                Approach::Past => {}
                Approach::Unclear => leaf(0..self.places, &[place]),
            }
        }
        if !flock.singles.is_empty() && !self.nodes.is_empty() {
            let nodes = &self.nodes;
            self.descent.run(Flight { nodes, flock, leaf });
        }
    }

    /// How a ray comes to the tree.
    #[inline]
    fn approach(&self, ray: &Ray) -> Approach {
        let offset = ray.origin - self.middle;
        let to_middle_m = -offset.dot(ray.direction);
        // Where the ray comes near the sphere around the tree.
        let start_m = if to_middle_m > self.radius_m {
            to_middle_m - self.radius_m
        } else {
            0.0
        };
        let origin = offset + ray.direction * start_m;
        let is_near = offset.length_squared() < self.farthest_m * self.farthest_m;
        if !is_near {
            return self.approach_from_afar(offset, origin);
        }
        // A ray that meets the sphere begins in the cylinder around it.
        if origin.length_squared() > 2.01 * self.radius_m * self.radius_m {
            return Approach::Past;
        }
        Approach::Near(SingleRay::from(ray, start_m, origin))
    }

    #[cold]
    fn approach_from_afar(&self, offset: Vector, origin: Vector) -> Approach {
        let rounding_m = 8.0 * f64::EPSILON * offset.length();
        let is_past = origin.length() > 1.5 * self.radius_m + rounding_m;
        if self.nodes.is_empty() || is_past {
            return Approach::Past;
        }
        Approach::Unclear
    }
}

/// The boxes, each with the margin, within boxes.
fn nested(boxes: &[Bounds], most_in_leaf: usize, (middle, margin_m): (Vector, f64)) -> WideTree {
    if boxes.is_empty() {
        return WideTree::default();
    }
    let single = |tight: &Bounds| {
        let padded = tight.padded(margin_m);
        SingleBox {
            low: rounded(padded.low() - middle),
            high: rounded(padded.high() - middle),
        }
    };
    let boxes: Vec<SingleBox> = boxes.iter().map(single).collect();
    WideTree::of(&SplitTree::over(&boxes, most_in_leaf))
}
