//! The shapes of a scene, so that a ray is tried against few of them.
//!
//! Promises what trying every shape gives, bit for bit: the nearest hit, and of equal hits the one of the
//! shape that comes first.

use super::box_tree::Walk;
use super::{Bounds, BoxTree, Hit, Ray, Shape, Span};

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
        let tree = BoxTree::over(&boxes);
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

    /// The nearest hit within the span, and the index of the shape.
    pub(crate) fn nearest(&self, ray: &Ray, span: Span) -> Option<(u32, Hit)> {
        let mut nearest: Option<(u32, Hit)> = None;
        let mut span = span;
        let mut try_shape = |index: u32, shape: &Shape, span: &mut Span| {
            let Some(hit) = shape.hit(ray, *span) else {
                return;
            };
            let is_first = nearest.is_none_or(|(known, best)| {
                hit.distance_m < best.distance_m
                    || (hit.distance_m == best.distance_m && index < known)
            });
            if is_first {
                nearest = Some((index, hit));
                // The next float, so that an equal hit of an earlier shape still counts.
                span.to_m = hit.distance_m.next_up();
            }
        };
        for &index in &self.endless {
            try_shape(index, self.shape(index), &mut span);
        }
        self.tree.visit(ray, &mut span, |places, span| {
            for (index, shape) in &self.sorted[places] {
                try_shape(*index, shape, span);
            }
            Walk::On
        });
        nearest
    }

    /// Whether anything is hit within the span.
    pub(crate) fn is_blocked(&self, ray: &Ray, span: Span) -> bool {
        let mut endless = self.endless.iter();
        if endless.any(|&index| self.shape(index).is_hit(ray, span)) {
            return true;
        }
        let mut span = span;
        let walk = self.tree.visit(ray, &mut span, |places, span| {
            let mut shapes = self.sorted[places].iter();
            if shapes.any(|(_, shape)| shape.is_hit(ray, *span)) {
                Walk::Stop
            } else {
                Walk::On
            }
        });
        walk == Walk::Stop
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
            assert_eq!(hierarchy.nearest(&ray, span), nearest);
            assert_eq!(hierarchy.is_blocked(&ray, span), nearest.is_some());
            if let Some((_, hit)) = nearest {
                hits += 1;
                assert!(!hierarchy.is_blocked(&ray, Span::up_to(hit.distance_m)));
            }
        }
        assert!(hits > 10_000, "only {hits} hits");
    }
}
