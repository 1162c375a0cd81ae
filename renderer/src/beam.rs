//! The rays that make up the path from the eye to the lights, and which of them are worth following.

use arrayvec::ArrayVec;

use crate::geometry::{Departure, Ray};
use crate::lighting::{LIFT_M, Surface};
use crate::scene::material::refraction;
use crate::tints::TintIndex;

/// A ray that counts less than this is not followed: a quarter of an 8-bit step of white.
const LEAST_SHARE: f64 = 1.0 / 1024.0;
/// No path is longer: the camera's ray and seven more.
const MAX_DEPTH: u32 = 8;
/// No ray tree has more hits; the weaker rays of a hit are the ones left out.
pub(crate) const MAX_HITS: usize = 32;

/// A ray that waits to be followed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Beam {
    pub(crate) departure: Departure,
    /// What part of what it finds reaches the eye, whatever its colour.
    pub(crate) share: f64,
    /// The same at the wavelength at which most does.
    peak: f64,
    pub(crate) tint: TintIndex,
    pub(crate) depth: u32,
}

/// Rays that wait, the next one last.
pub(crate) type Beams = ArrayVec<Beam, MAX_HITS>;

impl Beam {
    /// The ray of the camera.
    #[inline]
    pub(crate) fn of_camera(ray: Ray) -> Self {
        Self {
            departure: Departure {
                ray,
                outside_of: None,
            },
            share: 1.0,
            peak: 1.0,
            tint: 0,
            depth: 1,
        }
    }

    /// Sends a ray on that counts for these shares of this one: whatever its colour, and at most.
    #[inline]
    pub(crate) fn send(
        &self,
        departure: Departure,
        (share, peak): (f64, f64),
        tint: TintIndex,
        beams: &mut Beams,
    ) {
        let next = Self {
            departure,
            share: self.share * share,
            peak: self.peak * share * peak,
            tint,
            depth: self.depth + 1,
        };
        if next.peak >= LEAST_SHARE && next.depth <= MAX_DEPTH && !beams.is_full() {
            beams.push(next);
        }
    }

    /// Sends on what glass mirrors and what it lets through, the stronger one to be followed first.
    pub(crate) fn pass_on(&self, surface: &Surface, relative_index: f64, beams: &mut Beams) {
        let refraction = refraction(self.departure.ray.direction, surface.normal, relative_index);
        let mirrored = (surface.sent_back(), refraction.reflectance);
        let through = refraction.direction.map(|direction| {
            let ray = Ray {
                origin: surface.place - surface.facing * LIFT_M,
                direction,
            };
            let departure = Departure {
                ray,
                outside_of: None,
            };
            (departure, 1.0 - refraction.reflectance)
        });
        let rays = match through {
            Some(through) if through.1 < mirrored.1 => [Some(through), Some(mirrored)],
            through => [Some(mirrored), through],
        };
        for (sent, share) in rays.into_iter().flatten() {
            self.send(sent, (share, 1.0), self.tint, beams);
        }
    }
}
