//! The shapes of a scene, so that a ray is tried against few of them.
//!
//! Promises what trying every shape gives, bit for bit: the nearest hit, and of equal hits the one of the
//! shape that comes first.

use std::ops::Range;

use super::descent::{Visitor, Walk};
use super::{Bounds, BoxTree, Flock, Hit, Ray, Shape, ShapeQueues, SingleRay, Span};

/// Trying a shape costs about as much as trying eight boxes.
const MOST_IN_LEAF: usize = 1;

/// Shapes and the boxes over them.
#[derive(Clone, Debug)]
pub(crate) struct Hierarchy {
    shapes: Vec<Shape>,
    /// The shapes that no box holds.
    endless: Vec<u32>,
    tree: BoxTree,
    /// The shapes of the tree with their indices, leaf by leaf.
    sorted: Vec<(u32, Shape)>,
}

impl Hierarchy {
    /// Builds the boxes over the shapes.
    pub(crate) fn over(shapes: Vec<Shape>) -> Self {
        let endless = (0..).zip(&shapes).filter(|(_, shape)| shape.is_endless());
        let endless = endless.map(|(index, _)| index).collect();
        let boxed = (0_u32..).zip(&shapes);
        let boxed = boxed.filter_map(|(index, shape)| Some((index, shape.bounds()?)));
        let (indices, boxes): (Vec<u32>, Vec<Bounds>) = boxed.unzip();
        let tree = BoxTree::over(&boxes, MOST_IN_LEAF);
        let order = tree.order().iter().map(|&place| indices[place as usize]);
        let sorted = order.map(|index| (index, shapes[index as usize].clone()));
        Self {
            sorted: sorted.collect(),
            shapes,
            endless,
            tree,
        }
    }

    /// The shape of an index that a hit names.
    pub(crate) fn shape(&self, index: u32) -> &Shape {
        &self.shapes[index as usize]
    }

    /// All shapes, by their indices.
    pub(crate) fn shapes(&self) -> &[Shape] {
        &self.shapes
    }

    /// The shape that a ray from its outside cannot meet, so that it need not be tried.
    #[inline]
    fn left_behind(&self, outside_of: Option<u32>) -> u32 {
        let shape = outside_of.filter(|&index| self.shape(index).is_convex());
        shape.unwrap_or(u32::MAX)
    }

    /// The nearest hit within the span, and the index of the shape; the ray leaves the outside of a shape,
    /// or begins anywhere.
    pub(crate) fn nearest(
        &self,
        ray: &Ray,
        span: Span,
        outside_of: Option<u32>,
    ) -> Option<(u32, Hit)> {
        let mut search = Nearest {
            hierarchy: self,
            ray,
            left: self.left_behind(outside_of),
            best: None,
        };
        let mut span = span;
        for &index in &self.endless {
            search.try_shape(index, self.shape(index), &mut span);
        }
        self.tree.visit(ray, span, &mut search);
        search.best
    }

    /// Lets each of many rays, given with its place among all, wait for the shapes that it may meet.
    pub(crate) fn queue<'a>(
        &self,
        rays: impl Iterator<Item = (u32, &'a Ray)> + Clone,
        (flock, queues): (&mut Flock, &mut ShapeQueues),
    ) {
        for &index in &self.endless {
            queues.add_all(index, rays.clone().map(|(place, _)| place));
        }
        self.tree.visit_all(rays, flock, |places, rays| {
            for (shape, _) in &self.sorted[places] {
                queues.add_all(*shape, rays.iter().copied());
            }
        });
    }

    /// Whether anything is hit within the span, by a ray as in [`Self::nearest`].
    pub(crate) fn is_blocked(&self, ray: &Ray, span: Span, outside_of: Option<u32>) -> bool {
        let left = self.left_behind(outside_of);
        let mut endless = self.endless.iter().filter(|&&index| index != left);
        if endless.any(|&index| self.shape(index).is_hit(ray, span)) {
            return true;
        }
        let mut search = Any {
            hierarchy: self,
            ray,
            left,
        };
        self.tree.visit(ray, span, &mut search) == Walk::Stop
    }
}

/// The search for the nearest shape.
struct Nearest<'a> {
    hierarchy: &'a Hierarchy,
    ray: &'a Ray,
    /// Not to be tried.
    left: u32,
    best: Option<(u32, Hit)>,
}

impl Nearest<'_> {
    #[inline]
    fn try_shape(&mut self, index: u32, shape: &Shape, span: &mut Span) {
        if index == self.left {
            return;
        }
        let Some(hit) = shape.hit(self.ray, *span) else {
            return;
        };
        let is_first = self.best.is_none_or(|(known, best)| {
            hit.distance_m < best.distance_m || (hit.distance_m == best.distance_m && index < known)
        });
        if is_first {
            self.best = Some((index, hit));
            // The next float, so that an equal hit of an earlier shape still counts.
            span.to_m = hit.distance_m.next_up();
        }
    }
}

impl Visitor for Nearest<'_> {
    const NEAREST_FIRST: bool = true;

    #[inline]
    fn visit(&mut self, places: Range<usize>, _: Option<&SingleRay>, span: &mut Span) -> Walk {
        for (index, shape) in &self.hierarchy.sorted[places] {
            self.try_shape(*index, shape, span);
        }
        Walk::On
    }
}

/// The search for any shape.
struct Any<'a> {
    hierarchy: &'a Hierarchy,
    ray: &'a Ray,
    /// Not to be tried.
    left: u32,
}

impl Visitor for Any<'_> {
    const NEAREST_FIRST: bool = false;

    #[inline]
    fn visit(&mut self, places: Range<usize>, _: Option<&SingleRay>, span: &mut Span) -> Walk {
        let mut shapes = self.hierarchy.sorted[places].iter();
        if shapes.any(|(index, shape)| *index != self.left && shape.is_hit(self.ray, *span)) {
            Walk::Stop
        } else {
            Walk::On
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::random_shapes::{Stream, by_trying_all, many};
    use super::*;

    #[test]
    fn the_hierarchy_finds_what_trying_every_shape_finds() {
        let mut stream = Stream(3);
        let shapes = many(&mut stream);
        let hierarchy = Hierarchy::over(shapes.clone());
        let mut hits = 0;
        for _ in 0..20_000 {
            let ray = stream.ray();
            let nearest = by_trying_all(&shapes, &ray);
            let span = Span::up_to(f64::INFINITY);
            assert_eq!(hierarchy.nearest(&ray, span, None), nearest);
            assert_eq!(hierarchy.is_blocked(&ray, span, None), nearest.is_some());
            if let Some((_, hit)) = nearest {
                hits += 1;
                assert!(!hierarchy.is_blocked(&ray, Span::up_to(hit.distance_m), None));
            }
        }
        assert!(hits > 10_000, "only {hits} hits");
    }
    #[test]
    fn what_a_ray_leaves_behind_need_not_be_tried() {
        let mut stream = Stream(6);
        let shapes = many(&mut stream);
        let hierarchy = Hierarchy::over(shapes.clone());
        let mut hits = 0;
        for _ in 0..20_000 {
            let ray = stream.ray();
            let Some((index, hit)) = by_trying_all(&shapes, &ray) else {
                continue;
            };
            let (shape, place) = (&shapes[index as usize], ray.at(hit.distance_m));
            let normal = shape.normal(place, hit.part);
            if normal.dot(ray.direction) > 0.0 && shape.is_closed() {
                continue;
            }
            let facing = normal * -normal.dot(ray.direction).signum();
            let mirrored = Ray {
                origin: place + facing * 1e-6,
                direction: ray.direction.reflected(facing),
            };
            let nearest = by_trying_all(&shapes, &mirrored);
            let span = Span::up_to(f64::INFINITY);
            let (found, is_blocked) = (
                hierarchy.nearest(&mirrored, span, Some(index)),
                hierarchy.is_blocked(&mirrored, span, Some(index)),
            );
            assert_eq!((found, is_blocked), (nearest, nearest.is_some()));
            hits += u32::from(nearest.is_some());
        }
        assert!(hits > 3_000, "only {hits} hits");
    }
}
