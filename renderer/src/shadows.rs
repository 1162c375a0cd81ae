//! The shadow rays of many surfaces towards one light, tried together.

use std::ops::ControlFlow;

use crate::arrivals::{Arrivals, Arriving};
use crate::geometry::{Ray, RoundFan, Shape, ShapeQueues, Span, Vector};
use crate::lighting::Surface;

/// Shadow rays that wait; the memory is used again.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shadows {
    /// All surfaces.
    pub(crate) surfaces: Arrivals,
    rays: Vec<(Ray, Span)>,
    /// For each ray the surface that it comes from.
    origins: Vec<usize>,
    is_blocked: Vec<bool>,
    queues: ShapeQueues,
}

impl Shadows {
    /// Forgets all rays, and finds what arrives at the surfaces from a point light; there are so many shapes.
    pub(crate) fn towards(&mut self, position: Vector, intensity: f64, shapes: usize) {
        self.surfaces.find(position, intensity);
        self.rays.clear();
        self.origins.clear();
        self.queues.make_room(shapes);
    }

    /// Adds the ray to a light with a fan, if anything may stand in its way.
    #[inline]
    pub(crate) fn add(
        &mut self,
        arriving: &Arriving,
        from: &Surface,
        fan: &RoundFan,
        surface: usize,
    ) {
        let place = u32::try_from(self.rays.len()).unwrap_or(u32::MAX);
        let queues = &mut self.queues;
        let mut is_tried = false;
        let add = |shape| {
            queues.add(shape, place);
            is_tried = true;
            ControlFlow::Continue(())
        };
        let all = fan.try_candidates_at(arriving.in_fan, from.outside_of, add);
        if all.is_continue() && is_tried {
            let span = Span::up_to(arriving.arrival.distance_m);
            self.rays.push((from.shadow_ray(&arriving.arrival), span));
            self.origins.push(surface);
        }
    }

    /// The surfaces whose rays are blocked.
    pub(crate) fn dark(&mut self, shapes: &[Shape]) -> impl Iterator<Item = usize> {
        self.is_blocked.clear();
        self.is_blocked.resize(self.rays.len(), false);
        let is_blocked = &mut self.is_blocked;
        self.queues.find_blocked(shapes, &self.rays, is_blocked);
        let surfaces = self.origins.iter().zip(&self.is_blocked);
        surfaces.filter_map(|(&surface, &is_blocked)| is_blocked.then_some(surface))
    }
}
