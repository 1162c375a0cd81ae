//! What the lights of a scene bring to a surface: illuminance, shadows, highlights.
//!
//! Lights without extent cast hard shadows; an area light is sampled at one place in each cell of a grid.
//! Nothing shines through anything: glass too casts a full shadow.

use rayon::prelude::*;

use crate::arrivals::Arriving;
use crate::geometry::{Ray, RoundFan, Span, Vector};
use crate::jitter::Jitter;
use crate::sampler::ScreenPoint;
use crate::scene::Scene;
use crate::scene::light::{AreaLight, Arrival, Light, Source};
use crate::scene::material::Highlight;
use crate::shadows::Shadows;

/// How far off a surface a new ray starts, so that it does not meet the same place again.
pub(crate) const LIFT_M: f64 = 1e-6;

/// A hit with what is needed to send rays on from it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surface {
    pub(crate) place: Vector,
    /// Of the surface itself, towards the viewer's side.
    pub(crate) facing: Vector,
    /// By which light is reckoned: that of the surface, or a smooth one.
    pub(crate) normal: Vector,
    /// Of the mirrored ray.
    pub(crate) mirrored: Vector,
    /// The shape, if what is sent on from here does not begin inside it.
    pub(crate) outside_of: Option<u32>,
}

impl Surface {
    /// Just off the surface, on the viewer's side.
    #[inline]
    pub(crate) fn lifted(&self) -> Vector {
        self.place + self.facing * LIFT_M
    }

    #[inline]
    pub(crate) fn shadow_ray(&self, arrival: &Arrival) -> Ray {
        Ray {
            origin: self.lifted(),
            direction: arrival.towards,
        }
    }
}

/// What a surface makes of a light, whatever its colour.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Lit {
    /// The illuminance.
    pub(crate) illuminance: f64,
    /// How bright the highlight is.
    pub(crate) highlight: f64,
}

/// Which hit it is that light falls on: it says where on area lights the samples lie.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HitKey {
    pub(crate) at: ScreenPoint,
    pub(crate) hit: u32,
}

/// What of a surface light can count for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Receiver {
    pub(crate) has_body: bool,
    pub(crate) highlight: Option<Highlight>,
    /// It shows lights that have an extent, so that these need no highlight.
    pub(crate) mirrors: bool,
}

/// A surface on which light falls.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lighted {
    pub(crate) surface: Surface,
    pub(crate) receiver: Receiver,
    pub(crate) key: HitKey,
}

/// The lights of a scene and what stands round them.
#[derive(Clone, Debug)]
pub(crate) struct Lighting<'scene> {
    scene: &'scene Scene,
    /// For each light without extent what stands between it and any place, where that is worth it.
    fans: Vec<Option<RoundFan>>,
}

impl<'scene> Lighting<'scene> {
    pub(crate) fn new(scene: &'scene Scene) -> Self {
        let fan = |light: &Light| match light.source {
            Source::Point { position, .. } => RoundFan::new(position, scene.shapes.shapes()),
            Source::Distant { .. } | Source::Area(_) => None,
        };
        Self {
            scene,
            fans: scene.lights.par_iter().map(fan).collect(),
        }
    }

    /// How many lights there are, without ambient light.
    pub(crate) fn lights(&self) -> u16 {
        u16::try_from(self.fans.len()).unwrap_or(u16::MAX)
    }

    /// What arrives from one of the lights.
    #[inline]
    pub(crate) fn lit(
        &self,
        light: u16,
        surface: &Surface,
        receiver: Receiver,
        key: HitKey,
    ) -> Lit {
        let place = usize::from(light);
        let shapes = &self.scene.shapes;
        match &self.scene.lights[place].source {
            Source::Area(area) => {
                let highlight = receiver.highlight.filter(|_| !receiver.mirrors);
                let receiver = Receiver {
                    highlight,
                    ..receiver
                };
                let jitter = Jitter::new(key.at, key.hit, light);
                self.lit_by_area(area, surface, receiver, jitter)
            }
            source => {
                let arrival = source.arrival(surface.place);
                let is_blocked = |ray: &Ray, span| match &self.fans[place] {
                    Some(fan) => fan.is_blocked((ray, span), surface.outside_of, shapes.shapes()),
                    None => shapes.is_blocked(ray, span, surface.outside_of),
                };
                lit_from(&arrival, surface, receiver, is_blocked)
            }
        }
    }

    /// Adds what arrives from one of the lights at each of many surfaces, which also stand in `shadows`.
    pub(crate) fn lit_all<'a>(
        &self,
        light: u16,
        mut lighted: impl Iterator<Item = &'a Lighted>,
        shadows: &mut Shadows,
        lits: &mut Vec<Lit>,
    ) {
        let place = usize::from(light);
        let source = &self.scene.lights[place].source;
        let (
            Some(fan),
            Source::Point {
                position,
                intensity,
            },
        ) = (&self.fans[place], source)
        else {
            let alone = |of: &Lighted| self.lit(light, &of.surface, of.receiver, of.key);
            lits.extend(lighted.map(alone));
            return;
        };
        let shapes = self.scene.shapes.shapes();
        let first = lits.len();
        shadows.towards(*position, *intensity, shapes.len());
        for surface in 0..shadows.surfaces.len() {
            let Some(Lighted {
                surface: from,
                receiver,
                ..
            }) = lighted.next()
            else {
                return;
            };
            let arriving = shadows.surfaces.at(surface);
            let lit = unless_blocked(&arriving, *receiver);
            if lit.is_some() {
                shadows.add(&arriving, from, fan, surface);
            }
            lits.push(lit.unwrap_or_default());
        }
        for dark in shadows.dark(shapes) {
            lits[first + dark] = Lit::default();
        }
    }

    fn lit_by_area(
        &self,
        light: &AreaLight,
        surface: &Surface,
        receiver: Receiver,
        mut jitter: Jitter,
    ) -> Lit {
        let mut sum = Lit::default();
        if !receiver.has_body && receiver.highlight.is_none() {
            return sum;
        }
        let shapes = &self.scene.shapes;
        let is_blocked = |ray: &Ray, span| shapes.is_blocked(ray, span, surface.outside_of);
        // From where the shadow rays start, so that each ends just before the light's own surface.
        let Some(seen) = light.seen_from(surface.lifted()) else {
            return sum;
        };
        for row in 0..light.side {
            for column in 0..light.side {
                let at = jitter.within([column, row], light.side);
                let lit = lit_from(&seen.arrival(at), surface, receiver, is_blocked);
                sum.illuminance += lit.illuminance;
                sum.highlight += lit.highlight;
            }
        }
        let samples = f64::from(light.side * light.side);
        Lit {
            illuminance: sum.illuminance / samples,
            highlight: sum.highlight / samples,
        }
    }
}

/// What a surface makes of an arrival, unless the shadow ray is blocked.
#[inline]
fn lit_from(
    arrival: &Arrival,
    surface: &Surface,
    receiver: Receiver,
    is_blocked: impl Fn(&Ray, Span) -> bool,
) -> Lit {
    let arriving = Arriving {
        arrival: *arrival,
        cos_facing: arrival.towards.dot(surface.facing),
        cos_incidence: arrival.towards.dot(surface.normal),
        cos_mirrored: arrival.towards.dot(surface.mirrored),
        in_fan: Default::default(),
    };
    let lit = unless_blocked(&arriving, receiver);
    let lit = lit.filter(|_| {
        let shadow_ray = surface.shadow_ray(arrival);
        !is_blocked(&shadow_ray, Span::up_to(arrival.distance_m))
    });
    lit.unwrap_or_default()
}

/// What a surface makes of an arrival if nothing blocks it; `None` if there is nothing to block.
#[inline]
fn unless_blocked(arriving: &Arriving, receiver: Receiver) -> Option<Lit> {
    let &Arriving {
        arrival: Arrival { illuminance, .. },
        cos_incidence,
        ..
    } = arriving;
    let is_behind = cos_incidence <= 0.0 || arriving.cos_facing <= 0.0;
    if is_behind || illuminance <= 0.0 {
        return None;
    }
    let glint = receiver
        .highlight
        .map_or(0.0, |highlight| highlight.at(arriving.cos_mirrored));
    (receiver.has_body || glint != 0.0).then_some(Lit {
        illuminance: illuminance * cos_incidence,
        highlight: illuminance * glint,
    })
}
