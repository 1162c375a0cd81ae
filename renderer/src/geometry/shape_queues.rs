//! Many rays at once: for each shape the rays that may meet it wait in a queue, and then one shape after
//! another is tried against all of its own.
//!
//! Promises what trying each ray alone gives, bit for bit. It is quicker because one trial need not wait for
//! the one before, and a processor that has seen the last shape guesses well what is done with the next ray.

use super::{Hit, Ray, Shape, Span};

/// A ray that leaves the outside of a shape, or begins anywhere.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Departure {
    pub(crate) ray: Ray,
    pub(crate) outside_of: Option<u32>,
}

/// The nearest hit of a ray so far, and the index of the shape.
pub(crate) type Found = Option<(u32, Hit)>;

/// The rays that wait for each shape, by their places among all rays.
#[derive(Clone, Debug, Default)]
pub(crate) struct ShapeQueues {
    queues: Vec<Vec<u32>>,
    /// The shapes for which any ray waits.
    awaited: Vec<u32>,
}

impl ShapeQueues {
    /// Makes room for so many shapes.
    pub(crate) fn make_room(&mut self, shapes: usize) {
        if self.queues.len() < shapes {
            self.queues.resize_with(shapes, Vec::new);
        }
    }

    /// Lets a ray wait for a shape.
    #[inline]
    pub(crate) fn add(&mut self, shape: u32, ray: u32) {
        let queue = &mut self.queues[shape as usize];
        if queue.is_empty() {
            self.awaited.push(shape);
        }
        queue.push(ray);
    }

    /// Lets rays wait for a shape.
    #[inline]
    pub(crate) fn add_all(&mut self, shape: u32, rays: impl IntoIterator<Item = u32>) {
        let queue = &mut self.queues[shape as usize];
        if queue.is_empty() {
            self.awaited.push(shape);
        }
        queue.extend(rays);
    }

    /// Empties the queues into `take`, which is given each shape with its rays.
    pub(crate) fn empty(&mut self, mut take: impl FnMut(u32, &[u32])) {
        for shape in self.awaited.drain(..) {
            let queue = &mut self.queues[shape as usize];
            take(shape, queue);
            queue.clear();
        }
    }

    /// Tries each shape against its rays, and keeps the nearest hits.
    pub(crate) fn find_nearest<'a>(
        &mut self,
        shapes: &[Shape],
        departure: impl Fn(u32) -> &'a Departure,
        found: &mut [Found],
    ) {
        self.empty(|index, queue| {
            let shape = &shapes[index as usize];
            // What a ray from its outside cannot meet.
            let left = shape.is_convex().then_some(index);
            let rays = queue.iter().map(|&place| (place, departure(place)));
            let rays = rays.filter(|(_, departure)| left.is_none() || departure.outside_of != left);
            let rays = rays.map(|(place, departure)| (place as usize, &departure.ray));
            let trial = Trial { index, found };
            match shape {
                Shape::Sphere(sphere) => trial.of(rays, |ray, span| sphere.hit(ray, span)),
                Shape::Cylinder(cylinder) => trial.of(rays, |ray, span| cylinder.hit(ray, span)),
                Shape::Rectangle(rectangle) => trial.of(rays, |ray, span| rectangle.hit(ray, span)),
                Shape::Ground(ground) => trial.of(rays, |ray, span| ground.hit(ray, span)),
                other => trial.of(rays, |ray, span| other.hit(ray, span)),
            }
        });
    }

    /// Tries each shape against its rays, each with the span that counts, and marks those that are blocked.
    pub(crate) fn find_blocked(
        &mut self,
        shapes: &[Shape],
        rays: &[(Ray, Span)],
        is_blocked: &mut [bool],
    ) {
        self.empty(|index, queue| {
            let rays = queue
                .iter()
                .map(|&place| (place as usize, rays[place as usize]));
            match &shapes[index as usize] {
                Shape::Sphere(sphere) => mark(rays, is_blocked, |ray, span| {
                    sphere.hit(ray, span).is_some()
                }),
                Shape::Cylinder(cylinder) => {
                    mark(rays, is_blocked, |ray, span| {
                        cylinder.hit(ray, span).is_some()
                    });
                }
                Shape::Rectangle(rectangle) => {
                    mark(rays, is_blocked, |ray, span| {
                        rectangle.hit(ray, span).is_some()
                    });
                }
                other => mark(rays, is_blocked, |ray, span| other.is_hit(ray, span)),
            }
        });
    }
}

/// A shape that is tried against many rays.
struct Trial<'a> {
    index: u32,
    found: &'a mut [Found],
}

impl Trial<'_> {
    #[inline]
    fn of<'a>(
        self,
        rays: impl Iterator<Item = (usize, &'a Ray)>,
        hit: impl Fn(&Ray, Span) -> Option<Hit>,
    ) {
        for (place, ray) in rays {
            let best = &mut self.found[place];
            let end_m = best.map_or(f64::INFINITY, |(_, best)| best.distance_m);
            // The next float, so that an equal hit of an earlier shape still counts.
            let Some(hit) = hit(ray, Span::up_to(end_m.next_up())) else {
                continue;
            };
            let is_first = best.is_none_or(|(known, best)| {
                hit.distance_m < best.distance_m
                    || (hit.distance_m == best.distance_m && self.index < known)
            });
            if is_first {
                *best = Some((self.index, hit));
            }
        }
    }
}

#[inline]
fn mark(
    rays: impl Iterator<Item = (usize, (Ray, Span))>,
    is_blocked: &mut [bool],
    is_hit: impl Fn(&Ray, Span) -> bool,
) {
    for (place, (ray, span)) in rays {
        let is_blocked = &mut is_blocked[place];
        *is_blocked = *is_blocked || is_hit(&ray, span);
    }
}

#[cfg(test)]
mod tests {
    use super::super::random_shapes::{Stream, by_trying_all, many};
    use super::super::{Flock, Hierarchy};
    use super::*;

    #[test]
    fn many_rays_together_find_what_trying_every_shape_finds() {
        let mut stream = Stream(8);
        let shapes = many(&mut stream);
        let hierarchy = Hierarchy::over(shapes.clone());
        let (mut flock, mut queues) = (Flock::default(), ShapeQueues::default());
        queues.make_room(shapes.len());
        let mut hits = 0;
        for rays in [1, 7, 500, 3000] {
            let departures = (0..rays).map(|_| Departure {
                ray: stream.ray(),
                outside_of: None,
            });
            let departures: Vec<Departure> = departures.collect();
            let mut found: Vec<Found> = vec![None; departures.len()];
            let rays = (0..).zip(departures.iter().map(|departure| &departure.ray));
            hierarchy.queue(rays, (&mut flock, &mut queues));
            queues.find_nearest(&shapes, |place| &departures[place as usize], &mut found);
            for (departure, found) in departures.iter().zip(found) {
                assert_eq!(found, by_trying_all(&shapes, &departure.ray));
                hits += u32::from(found.is_some());
            }
        }
        assert!(hits > 1_500, "only {hits} hits");
    }
}
