//! How a ray goes down a tree of boxes, nearer boxes first if that matters.
#![expect(
    clippy::inline_always,
    reason = "code for a processor's own instructions is compiled for them only where it is inlined"
)]

use std::ops::Range;

use arrayvec::ArrayVec;

use super::box_node::{BoxNode, BoxTest, Child, Entries, PlainTest, WIDTH};
use super::{SingleRay, Span};

/// How many children wait at hand; more are put away.
const AT_HAND: usize = 96;

/// How a traversal goes on after things were tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Walk {
    /// With whatever is within the span.
    On,
    /// It is over.
    Stop,
}

/// What is done with the things that a ray may meet.
pub(crate) trait Visitor {
    /// Whether nearer things are to be shown first; it costs a little.
    const NEAREST_FIRST: bool;

    /// Is given places of things, and may shorten the span. It is also given the ray in single precision, if
    /// that is good for anything.
    fn visit(&mut self, places: Range<usize>, single: Option<&SingleRay>, span: &mut Span) -> Walk;
}

/// A way down a tree, by whatever the processor is best at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Descent {
    #[cfg(target_arch = "x86_64")]
    v3: Option<pulp::x86::V3>,
}

/// What goes down a tree, whatever the processor.
pub(super) trait Task {
    /// Goes down, trying boxes in the given way.
    fn run(self, test: impl BoxTest) -> Walk;
}

/// A ray on its way down.
struct Errand<'a, V> {
    nodes: &'a [BoxNode],
    ray: &'a SingleRay,
    span: Span,
    visitor: &'a mut V,
}

impl Descent {
    /// The best way of this processor.
    pub(crate) fn best() -> Self {
        Self {
            #[cfg(target_arch = "x86_64")]
            v3: pulp::x86::V3::try_new(),
        }
    }

    /// The way of every processor.
    #[cfg(test)]
    pub(crate) fn plain() -> Self {
        Self {
            #[cfg(target_arch = "x86_64")]
            v3: None,
        }
    }

    /// Shows the visitor what is in the boxes that the ray meets within the span; the first node is the root.
    #[inline]
    pub(crate) fn visit<V: Visitor>(
        self,
        nodes: &[BoxNode],
        ray: &SingleRay,
        span: Span,
        visitor: &mut V,
    ) -> Walk {
        self.run(Errand {
            nodes,
            ray,
            span,
            visitor,
        })
    }

    /// Does a task in this way.
    #[inline]
    pub(super) fn run(self, task: impl Task) -> Walk {
        #[cfg(target_arch = "x86_64")]
        if let Some(v3) = self.v3 {
            return v3.vectorize(v3::OnV3 { task, v3 });
        }
        task.run(PlainTest)
    }
}

#[cfg(target_arch = "x86_64")]
mod v3 {
    use pulp::x86::V3;

    use super::{Task, Walk};

    /// A task to be compiled for AVX2 and FMA.
    pub(super) struct OnV3<T> {
        pub(super) task: T,
        pub(super) v3: V3,
    }

    impl<T: Task> pulp::NullaryFnOnce for OnV3<T> {
        type Output = Walk;

        #[inline(always)]
        fn call(self) -> Walk {
            self.task.run(self.v3)
        }
    }
}

impl<V: Visitor> Task for Errand<'_, V> {
    #[inline(always)]
    fn run(self, test: impl BoxTest) -> Walk {
        let (ray, mut span) = (self.ray, self.span);
        let prepared = test.prepare(ray);
        let mut waiting = Waiting::default();
        let mut end = ray.end(span);
        let mut child = Child::node(0);
        loop {
            while child.count() == 0 {
                let node = &self.nodes[child.first()];
                let entries = test.entries(node, &prepared, end);
                let next = if entries.met == 0 {
                    waiting.next(end)
                } else if V::NEAREST_FIRST {
                    Some(waiting.all_but_nearest(node, &entries))
                } else {
                    Some(waiting.all_but_one(node, &entries))
                };
                let Some(next) = next else {
                    return Walk::On;
                };
                child = next;
            }
            let places = child.first()..child.first() + child.count();
            if self.visitor.visit(places, Some(ray), &mut span) == Walk::Stop {
                return Walk::Stop;
            }
            end = ray.end(span);
            let Some(next) = waiting.next(end) else {
                return Walk::On;
            };
            child = next;
        }
    }
}

/// Children that a ray meets later, below the distances at which it enters their boxes: as these are not
/// negative, their bits are ordered as they are.
#[derive(Default)]
struct Waiting {
    at_hand: ArrayVec<u64, AT_HAND>,
    put_away: Vec<u64>,
}

impl Waiting {
    /// The last of those whose boxes begin before `end`.
    #[inline(always)]
    fn next(&mut self, end: f32) -> Option<Child> {
        loop {
            let Some(key) = self.at_hand.pop() else {
                return self.next_put_away(end);
            };
            if f32::from_bits(high(key)) <= end {
                return Some(Child::of_code(low(key)));
            }
        }
    }

    #[cold]
    fn next_put_away(&mut self, end: f32) -> Option<Child> {
        let mut keys = std::iter::from_fn(|| self.put_away.pop());
        let key = keys.find(|&key| f32::from_bits(high(key)) <= end)?;
        Some(Child::of_code(low(key)))
    }

    #[cold]
    fn put_away(&mut self) {
        self.put_away.extend(self.at_hand.drain(..));
    }

    #[inline(always)]
    fn make_room(&mut self) {
        if self.at_hand.remaining_capacity() < WIDTH {
            self.put_away();
        }
    }

    /// The nearest of the children that are met, at least one; the others wait, the nearer ones for less long.
    #[inline(always)]
    fn all_but_nearest(&mut self, node: &BoxNode, entries: &Entries) -> Child {
        let key = |slots: u32| {
            let slot = slots.trailing_zeros() as usize % WIDTH;
            let distance = entries.distances[slot].to_bits();
            u64::from(distance) << 32 | u64::from(node.child(slot).code())
        };
        let mut others = without_first(entries.met);
        if others == 0 {
            return node.child(entries.met.trailing_zeros() as usize);
        }
        self.make_room();
        let bottom = self.at_hand.len();
        let mut nearest = key(entries.met);
        while others != 0 {
            let other = key(others);
            others = without_first(others);
            self.at_hand.push(nearest.max(other));
            nearest = nearest.min(other);
            let mut place = self.at_hand.len() - 1;
            while place > bottom && self.at_hand[place - 1] < self.at_hand[place] {
                self.at_hand.swap(place - 1, place);
                place -= 1;
            }
        }
        Child::of_code(low(nearest))
    }

    /// One of the children that are met, at least one; the others wait.
    #[inline(always)]
    fn all_but_one(&mut self, node: &BoxNode, entries: &Entries) -> Child {
        let mut others = without_first(entries.met);
        if others != 0 {
            self.make_room();
        }
        while others != 0 {
            let child = node.child(others.trailing_zeros() as usize);
            self.at_hand.push(u64::from(child.code()));
            others = without_first(others);
        }
        node.child(entries.met.trailing_zeros() as usize)
    }
}

#[inline(always)]
fn without_first(bits: u32) -> u32 {
    bits & bits.wrapping_sub(1)
}

#[inline(always)]
fn high(key: u64) -> u32 {
    u32::try_from(key >> 32).unwrap_or_default()
}

#[inline(always)]
fn low(key: u64) -> u32 {
    u32::try_from(key & u64::from(u32::MAX)).unwrap_or_default()
}
