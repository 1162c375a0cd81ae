//! Boxes within boxes over the shapes of a scene, so that a ray is tried against few of them.
//!
//! Promises what trying every shape gives, bit for bit: the nearest hit, and of equal hits the one of the
//! shape that comes first.
//!
//! Source: the surface-area heuristic of Goldsmith & Salmon (1987) and Mac Donald & Booth (1990).

use super::{Bounds, Hit, Ray, Shape, Span, Vector};

/// No path from the root is longer, so that a traversal needs a stack of this size only.
const MAX_DEPTH: usize = 28;
/// What it costs to visit a node, in tests against a shape.
const VISIT_COST: f64 = 0.5;

/// Shapes and the boxes over them.
#[derive(Clone, Debug)]
pub(crate) struct Hierarchy {
    shapes: Vec<Shape>,
    /// The shapes that no box holds.
    endless: Vec<u32>,
    /// The other shapes, leaf by leaf.
    order: Vec<u32>,
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Bounds,
    content: Content,
}

#[derive(Clone, Copy, Debug)]
enum Content {
    /// A range of `order`.
    Leaf { first: u32, end: u32 },
    /// The first of two neighbouring nodes.
    Children { first: u32 },
}

/// A shape while the tree is built.
#[derive(Clone, Copy, Debug)]
struct Item {
    index: u32,
    bounds: Bounds,
}

impl Hierarchy {
    /// Builds the boxes over the shapes.
    pub(crate) fn over(shapes: Vec<Shape>) -> Self {
        let mut hierarchy = Self {
            shapes,
            endless: Vec::new(),
            order: Vec::new(),
            nodes: Vec::new(),
        };
        let mut items = Vec::new();
        for (index, shape) in (0..).zip(&hierarchy.shapes) {
            match shape.bounds() {
                Some(bounds) => items.push(Item { index, bounds }),
                None => hierarchy.endless.push(index),
            }
        }
        if let Some(root) = leaf_of(&items) {
            hierarchy.nodes.push(root);
            hierarchy.divide(0, &mut items, 0);
        }
        hierarchy
    }

    /// The shape of an index that a hit names.
    pub(crate) fn shape(&self, index: u32) -> &Shape {
        &self.shapes[index as usize]
    }

    fn divide(&mut self, node: usize, items: &mut [Item], depth: usize) {
        let split = if depth < MAX_DEPTH {
            best_split(items)
        } else {
            None
        };
        let Some(Split { axis, count }) = split else {
            let first = to_index(self.order.len());
            self.order.extend(items.iter().map(|item| item.index));
            let end = to_index(self.order.len());
            self.nodes[node].content = Content::Leaf { first, end };
            return;
        };
        sort_along(items, axis);
        let (left, right) = items.split_at_mut(count);
        let first = self.nodes.len();
        self.nodes.extend(leaf_of(left));
        self.nodes.extend(leaf_of(right));
        self.nodes[node].content = Content::Children {
            first: to_index(first),
        };
        self.divide(first, left, depth + 1);
        self.divide(first + 1, right, depth + 1);
    }

    /// The nearest hit within the span, and the index of the shape.
    pub(crate) fn nearest(&self, ray: &Ray, span: Span) -> Option<(u32, Hit)> {
        let mut nearest: Option<(u32, Hit)> = None;
        self.visit(ray, span, |index, hit| {
            let is_nearer = nearest.is_none_or(|(known, best)| {
                hit.distance_m < best.distance_m
                    || (hit.distance_m == best.distance_m && index < known)
            });
            if is_nearer {
                nearest = Some((index, hit));
            }
            Walk::Nearer(hit.distance_m)
        });
        nearest
    }

    /// Whether anything is hit within the span.
    pub(crate) fn is_blocked(&self, ray: &Ray, span: Span) -> bool {
        let mut blocked = false;
        self.visit(ray, span, |_, _| {
            blocked = true;
            Walk::Stop
        });
        blocked
    }

    /// Tries shapes, nearer boxes first, and tells each hit to `found`, which says how to go on.
    #[inline]
    fn visit(&self, ray: &Ray, span: Span, mut found: impl FnMut(u32, Hit) -> Walk) {
        let mut span = span;
        let mut try_shapes = |indices: &[u32], span: &mut Span| {
            for &index in indices {
                if let Some(hit) = self.shapes[index as usize].hit(ray, *span) {
                    match found(index, hit) {
                        // The next float, so that an equal hit of an earlier shape is still told.
                        Walk::Nearer(distance_m) => span.to_m = distance_m.next_up(),
                        Walk::Stop => return Walk::Stop,
                    }
                }
            }
            Walk::Nearer(span.to_m)
        };
        if matches!(try_shapes(&self.endless, &mut span), Walk::Stop) || self.nodes.is_empty() {
            return;
        }
        let direction = ray.direction;
        let inverse = Vector::new(
            direction.x.recip(),
            direction.y.recip(),
            direction.z.recip(),
        );
        let mut stack = [(0_u32, 0.0_f64); MAX_DEPTH + 2];
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let (node, entry_m) = stack[height];
            if entry_m > span.to_m {
                continue;
            }
            match self.nodes[node as usize].content {
                Content::Leaf { first, end } => {
                    let indices = &self.order[first as usize..end as usize];
                    if matches!(try_shapes(indices, &mut span), Walk::Stop) {
                        return;
                    }
                }
                Content::Children { first } => {
                    let entry_m = |node: u32| {
                        let bounds = &self.nodes[node as usize].bounds;
                        bounds
                            .entry_m(ray, inverse, span)
                            .map(|entry| (node, entry))
                    };
                    let [near, far] = match (entry_m(first), entry_m(first + 1)) {
                        (Some(left), Some(right)) if right.1 < left.1 => [Some(right), Some(left)],
                        (left, right) => [left, right],
                    };
                    for child in [far, near].into_iter().flatten() {
                        stack[height] = child;
                        height += 1;
                    }
                }
            }
        }
    }
}

/// How a traversal goes on after a hit.
enum Walk {
    /// Only hits up to this distance still count.
    Nearer(f64),
    /// It is over.
    Stop,
}

/// Where to part the items once they are sorted along an axis.
struct Split {
    axis: Axis,
    count: usize,
}

#[derive(Clone, Copy)]
enum Axis {
    X,
    Y,
    Z,
}

fn sort_along(items: &mut [Item], axis: Axis) {
    let key = |item: &Item| {
        let center = item.bounds.center();
        match axis {
            Axis::X => center.x,
            Axis::Y => center.y,
            Axis::Z => center.z,
        }
    };
    items.sort_by(|left, right| {
        let by_place = key(left).total_cmp(&key(right));
        by_place.then(left.index.cmp(&right.index))
    });
}

/// The split of least expected cost, or `None` if a leaf costs no more.
fn best_split(items: &mut [Item]) -> Option<Split> {
    let whole = join(items)?.half_area();
    let mut best = None;
    let mut least = items.len() as f64 - VISIT_COST;
    for axis in [Axis::X, Axis::Y, Axis::Z] {
        sort_along(items, axis);
        let mut areas_right = vec![0.0; items.len()];
        let mut right: Option<Bounds> = None;
        for (place, item) in items.iter().enumerate().rev() {
            let bounds = right.map_or(item.bounds, |right| right.joined(&item.bounds));
            areas_right[place] = bounds.half_area();
            right = Some(bounds);
        }
        let mut left: Option<Bounds> = None;
        for (place, item) in items.iter().enumerate().take(items.len() - 1) {
            let bounds = left.map_or(item.bounds, |left| left.joined(&item.bounds));
            left = Some(bounds);
            let count = place + 1;
            let cost_left = bounds.half_area() * count as f64;
            let cost_right = areas_right[count] * (items.len() - count) as f64;
            let cost = (cost_left + cost_right) / whole;
            if cost < least {
                least = cost;
                best = Some(Split { axis, count });
            }
        }
    }
    best
}

fn join(items: &[Item]) -> Option<Bounds> {
    let bounds = items.iter().map(|item| item.bounds);
    bounds.reduce(|left, right| left.joined(&right))
}

fn leaf_of(items: &[Item]) -> Option<Node> {
    join(items).map(|bounds| Node {
        bounds,
        content: Content::Leaf { first: 0, end: 0 },
    })
}

/// A scene holds far fewer than 2³² shapes: each is a table of a text file.
fn to_index(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}
