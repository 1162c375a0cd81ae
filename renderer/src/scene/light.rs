//! What lights a scene, and what of it arrives at a place.

use crate::geometry::Vector;
use crate::spectra::Emission;

/// A light that casts shadows.
#[derive(Clone, Debug)]
pub(crate) struct Light {
    pub(crate) emission: Emission,
    pub(crate) source: Source,
}

/// Where light comes from, and how much.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Source {
    /// From one place in all directions; the intensity is the illuminance at 1 m.
    Point { position: Vector, intensity: f64 },
    /// From one direction everywhere; the illuminance is that on a surface that faces it.
    Distant {
        /// The unit vector towards the light.
        towards: Vector,
        illuminance: f64,
    },
}

/// Light that would arrive at a place if nothing were in its way.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arrival {
    /// The unit vector towards the light.
    pub(crate) towards: Vector,
    /// The light is this far away, so that only what is nearer casts a shadow.
    pub(crate) distance_m: f64,
    /// On a surface that faces the light.
    pub(crate) illuminance: f64,
}

impl Source {
    #[inline]
    pub(crate) fn arrival(&self, place: Vector) -> Arrival {
        match *self {
            Self::Point {
                position,
                intensity,
            } => {
                let path = position - place;
                let distance_m = path.length();
                Arrival {
                    towards: path * distance_m.recip(),
                    distance_m,
                    illuminance: intensity / (distance_m * distance_m),
                }
            }
            Self::Distant {
                towards,
                illuminance,
            } => Arrival {
                towards,
                distance_m: f64::INFINITY,
                illuminance,
            },
        }
    }
}

/// Light from an evenly bright upper half of the sphere; it casts no shadows.
#[derive(Clone, Debug)]
pub(crate) struct Ambient {
    pub(crate) emission: Emission,
    /// On a surface that faces up.
    pub(crate) illuminance: f64,
}

impl Ambient {
    /// What a surface with this normal receives.
    #[inline]
    pub(crate) fn arrival(&self, normal: Vector) -> f64 {
        self.illuminance * 0.5 * (1.0 + normal.z)
    }
}
