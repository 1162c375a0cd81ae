//! Boxes within boxes, four to a node, so that a ray is tried against few of many things.
//!
//! The boxes are in single precision and a little too wide, so that no hit is ever hidden: what a ray finds
//! does not depend on how the boxes were nested, nor on the machine that nested them.
//!
//! Not here: what is in the boxes. The tree only says which things may be met, nearer ones first.
//!
//! Sources: Meister & Bittner (2018) for the nesting (crate `obvhs`); Dammertz, Hanika & Keller (2008) for
//! nodes of four.

use std::ops::Range;

use arrayvec::ArrayVec;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::bvh2::node::Bvh2Node;
use wide::f32x4;

use super::{Bounds, Ray, Span, Vector};

/// How many boxes a node holds.
const WIDTH: usize = 4;
/// How many children wait at most; where there are more, a traversal begins another one.
const STACK: usize = 64;
/// By how much a box is wider than what it holds, as a part of the whole tree's size.
///
/// An origin within the tree, rounded to single precision, is off by 2⁻²⁴ of its size; so are the difference
/// from a plane, the reciprocal of the direction and their product: together less than 4 · 2⁻²⁴ = 2.4e-7.
const MARGIN: f64 = 1e-6;
/// Stands for the reciprocal of 0: finite, so that nothing becomes a number that is not one.
const STEEPEST: f64 = 1e30;

/// A tree over numbered things with boxes.
#[derive(Clone, Debug)]
pub(crate) struct BoxTree {
    /// The origin of the single-precision coordinates.
    middle: Vector,
    bounds: Option<Bounds>,
    nodes: Vec<Node>,
    /// The numbers of the things, leaf by leaf.
    order: Vec<u32>,
}

/// Four boxes side by side, and what each holds.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
struct Node {
    /// The lower and upper planes across x, y and z.
    planes: [[f32x4; 3]; 2],
    children: [Child; WIDTH],
}

#[derive(Clone, Copy, Debug, Default)]
struct Child {
    /// The first of a leaf's places, or a node.
    first: u32,
    /// How many things are in the leaf; 0 for a node.
    count: u32,
}

/// How a traversal goes on after things were tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Walk {
    /// With whatever is within the span.
    On,
    /// It is over.
    Stop,
}

/// A ray in the single-precision coordinates of a tree.
struct SingleRay {
    origin: [f32x4; 3],
    inverse: [f32x4; 3],
    /// For each axis whether the upper plane is met first.
    from_above: [usize; 3],
    /// The distance along the ray of the new origin.
    start_m: f64,
}

impl BoxTree {
    /// The tree over things with these boxes; each is known by its place among them.
    pub(crate) fn over(boxes: &[Bounds]) -> Self {
        let bounds = boxes
            .iter()
            .copied()
            .reduce(|one, other| one.joined(&other));
        let middle = bounds.map_or(Vector::default(), |bounds| bounds.center());
        let mut tree = Self {
            middle,
            bounds,
            nodes: Vec::new(),
            order: Vec::new(),
        };
        let Some(bounds) = bounds else {
            return tree;
        };
        let margin = MARGIN * (bounds.high() - bounds.low()).length();
        let padding = Vector::new(margin, margin, margin);
        let boxes: Vec<Aabb> = boxes
            .iter()
            .map(|b| Aabb {
                min: rounded(b.low() - middle - padding).into(),
                max: rounded(b.high() - middle + padding).into(),
            })
            .collect();
        let parameters = BvhBuildParams {
            max_prims_per_leaf: 4,
            // Boxes are tried four at a time: cheaper than what is in them.
            collapse_traversal_cost: 0.5,
            ..BvhBuildParams::medium_build()
        };
        let binary = build_bvh2(&boxes, parameters, &mut std::time::Duration::default());
        tree.order = binary.primitive_indices;
        tree.widen(&binary.nodes, &binary.nodes[..1]);
        tree
    }

    /// Makes a node of up to four descendants of a binary tree's nodes, and then of theirs.
    fn widen(&mut self, binary: &[Bvh2Node], from: &[Bvh2Node]) -> u32 {
        let mut members: ArrayVec<Bvh2Node, WIDTH> = from.iter().copied().collect();
        while members.len() < WIDTH {
            let inner = (0..members.len()).filter(|&place| !members[place].is_leaf());
            let widest = inner.max_by(|&one, &other| {
                let area = |place: usize| members[place].aabb().half_area();
                area(one).total_cmp(&area(other))
            });
            let Some(widest) = widest else {
                break;
            };
            let first = members[widest].first_index as usize;
            members[widest] = binary[first];
            members.push(binary[first + 1]);
        }
        let place = self.nodes.len();
        self.nodes.push(Node::of(&members));
        for (slot, member) in members.iter().enumerate() {
            self.nodes[place].children[slot] = if member.is_leaf() {
                Child {
                    first: member.first_index,
                    count: member.prim_count,
                }
            } else {
                let first = member.first_index as usize;
                Child {
                    first: self.widen(binary, &binary[first..first + 2]),
                    count: 0,
                }
            };
        }
        u32::try_from(place).unwrap_or(u32::MAX)
    }

    /// The numbers of the things in the order in which they stand in leaves.
    pub(crate) fn order(&self) -> &[u32] {
        &self.order
    }

    /// The box of all.
    pub(crate) fn bounds(&self) -> Option<Bounds> {
        self.bounds
    }

    /// Tries what a ray may meet within the span: `try_places` is given places of [`Self::order`], and may
    /// shorten the span.
    #[inline]
    pub(crate) fn visit(
        &self,
        ray: &Ray,
        span: &mut Span,
        mut try_places: impl FnMut(Range<usize>, &mut Span) -> Walk,
    ) -> Walk {
        let Some(single) = self.single_ray(ray, *span) else {
            return Walk::On;
        };
        let root = Child { first: 0, count: 0 };
        self.descend(root, &single, span, &mut try_places)
    }

    /// The ray from where it enters the tree, if it does so within the span.
    #[inline]
    fn single_ray(&self, ray: &Ray, span: Span) -> Option<SingleRay> {
        let inverse = ray.inverse();
        let start_m = self.bounds?.entry_m(ray, inverse, span)?;
        let origin = rounded(ray.at(start_m) - self.middle);
        let inverse = rounded(inverse);
        Some(SingleRay {
            origin: origin.map(f32x4::splat),
            inverse: inverse.map(f32x4::splat),
            from_above: inverse.map(|inverse| usize::from(inverse < 0.0)),
            start_m,
        })
    }

    fn descend(
        &self,
        start: Child,
        ray: &SingleRay,
        span: &mut Span,
        try_places: &mut impl FnMut(Range<usize>, &mut Span) -> Walk,
    ) -> Walk {
        let mut waiting: ArrayVec<(Child, f32), STACK> = ArrayVec::new();
        waiting.push((start, 0.0));
        let mut end = ray.end(*span);
        while let Some((child, entry)) = waiting.pop() {
            if entry > end {
                continue;
            }
            if child.count > 0 {
                let places = child.first as usize..(child.first + child.count) as usize;
                if try_places(places, span) == Walk::Stop {
                    return Walk::Stop;
                }
                end = ray.end(*span);
                continue;
            }
            if waiting.remaining_capacity() < WIDTH {
                if self.descend(child, ray, span, try_places) == Walk::Stop {
                    return Walk::Stop;
                }
                end = ray.end(*span);
                continue;
            }
            let node = &self.nodes[child.first as usize];
            let (entries, mut met) = node.entries(ray, end);
            if met.is_power_of_two() {
                let slot = met.trailing_zeros() as usize;
                waiting.push((node.children[slot], entries[slot]));
                continue;
            }
            let bottom = waiting.len();
            while met != 0 {
                let slot = met.trailing_zeros() as usize;
                met &= met - 1;
                waiting.push((node.children[slot], entries[slot]));
                let mut place = waiting.len() - 1;
                while place > bottom && waiting[place - 1].1 < waiting[place].1 {
                    waiting.swap(place - 1, place);
                    place -= 1;
                }
            }
        }
        Walk::On
    }
}

impl SingleRay {
    /// The end of the span from the new origin on, never too near.
    #[inline]
    fn end(&self, span: Span) -> f32 {
        single(span.to_m - self.start_m).next_up()
    }
}

impl Node {
    fn of(members: &[Bvh2Node]) -> Self {
        // A place that is not used is a box that nothing meets.
        let mut planes = [[[f32::INFINITY; WIDTH]; 3], [[f32::NEG_INFINITY; WIDTH]; 3]];
        for (slot, member) in members.iter().enumerate() {
            let corners = [member.aabb().min.to_array(), member.aabb().max.to_array()];
            for (planes, corner) in planes.iter_mut().zip(corners) {
                for (plane, coordinate) in planes.iter_mut().zip(corner) {
                    plane[slot] = coordinate;
                }
            }
        }
        Self {
            planes: planes.map(|planes| planes.map(f32x4::new)),
            children: [Child::default(); WIDTH],
        }
    }

    /// Where the ray enters each box, and a bit for each box that it meets before `end`.
    #[inline]
    fn entries(&self, ray: &SingleRay, end: f32) -> ([f32; WIDTH], u32) {
        let near = |axis: usize| {
            let plane = self.planes[ray.from_above[axis]][axis];
            (plane - ray.origin[axis]) * ray.inverse[axis]
        };
        let far = |axis: usize| {
            let plane = self.planes[1 - ray.from_above[axis]][axis];
            (plane - ray.origin[axis]) * ray.inverse[axis]
        };
        let entry = near(0)
            .fast_max(near(1))
            .fast_max(near(2))
            .fast_max(f32x4::ZERO);
        let exit = far(0)
            .fast_min(far(1))
            .fast_min(far(2))
            .fast_min(f32x4::splat(end));
        (entry.to_array(), entry.simd_le(exit).to_bitmask())
    }
}

impl Ray {
    /// The reciprocals of the direction, never infinite.
    #[inline]
    pub(crate) fn inverse(&self) -> Vector {
        let inverse = |coordinate: f64| {
            let inverse = coordinate.recip();
            if inverse.abs() > STEEPEST {
                STEEPEST.copysign(inverse)
            } else {
                inverse
            }
        };
        let Vector { x, y, z } = self.direction;
        Vector::new(inverse(x), inverse(y), inverse(z))
    }
}

fn rounded(vector: Vector) -> [f32; 3] {
    [single(vector.x), single(vector.y), single(vector.z)]
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding to the nearest single is meant"
)]
fn single(value: f64) -> f32 {
    value as f32
}
