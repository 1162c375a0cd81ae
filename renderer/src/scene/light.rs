//! What lights a scene, and what of it arrives at a place.

use std::f64::consts::{PI, TAU};

use crate::geometry::{Frame, Rectangle, Shape, Sphere, Vector};
use crate::scene::seen_rectangle::SeenRectangle;
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
    /// From a surface that is equally bright everywhere and in all directions.
    Area(AreaLight),
}

/// A surface that shines; a perfect white diffuser under the illuminance 1 has the luminance 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AreaLight {
    pub(crate) luminance: f64,
    /// Shadow rays go to one place in each cell of a grid with this many cells along each side.
    pub(crate) side: u32,
    pub(crate) surface: AreaSurface,
}

/// The surface of an area light.
#[derive(Clone, Copy, Debug)]
pub(crate) enum AreaSurface {
    /// A rectangle that shines to the side from which its edges u, v turn counter-clockwise.
    Rectangle {
        corner: Vector,
        edge_u: Vector,
        edge_v: Vector,
    },
    /// A sphere that shines outwards.
    Sphere { center: Vector, radius_m: f64 },
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

impl Arrival {
    /// From a place of an area light, which is itself a surface and must not cast its own shadow.
    fn from_surface(path: Vector, distance_m: f64, illuminance: f64) -> Self {
        Self {
            towards: path * distance_m.recip(),
            distance_m: distance_m - OWN_SURFACE_M,
            illuminance,
        }
    }

    /// No light.
    const DARK: Self = Self {
        towards: Vector::UP,
        distance_m: 0.0,
        illuminance: 0.0,
    };
}

/// By how much a shadow ray ends before the surface of an area light.
const OWN_SURFACE_M: f64 = 1e-6;

impl Source {
    /// What arrives from a light without extent; of an area light, nothing.
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
            Self::Area(_) => Arrival::DARK,
        }
    }

    /// How bright the light looks; lights without extent cannot be seen.
    pub(crate) fn luminance(&self) -> f64 {
        match self {
            Self::Point { .. } | Self::Distant { .. } => 0.0,
            Self::Area(area) => area.luminance,
        }
    }
}

impl AreaLight {
    /// The light as it is seen from a place; `None` if it is not.
    pub(crate) fn seen_from(&self, place: Vector) -> Option<SeenLight> {
        let (shape, solid_angle_sr) = match self.surface {
            AreaSurface::Rectangle {
                corner,
                edge_u,
                edge_v,
            } => {
                let (seen, solid_angle_sr) = SeenRectangle::new(place, corner, [edge_u, edge_v])?;
                (SeenShape::Rectangle(seen), solid_angle_sr)
            }
            AreaSurface::Sphere { center, radius_m } => {
                let (seen, solid_angle_sr) = SeenSphere::new(center - place, radius_m)?;
                (SeenShape::Sphere(seen), solid_angle_sr)
            }
        };
        Some(SeenLight {
            shape,
            solid_angle_sr,
            illuminance: self.luminance * solid_angle_sr / PI,
        })
    }

    /// The light as a shape that can be seen.
    pub(crate) fn shape(&self) -> Shape {
        match self.surface {
            AreaSurface::Rectangle {
                corner,
                edge_u,
                edge_v,
            } => Shape::Rectangle(Rectangle::new(corner, edge_u, edge_v)),
            AreaSurface::Sphere { center, radius_m } => Shape::Sphere(Sphere { center, radius_m }),
        }
    }
}

/// An area light as it is seen from a place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SeenLight {
    shape: SeenShape,
    solid_angle_sr: f64,
    illuminance: f64,
}

#[derive(Clone, Copy, Debug)]
enum SeenShape {
    Rectangle(SeenRectangle),
    Sphere(SeenSphere),
}

impl SeenLight {
    /// What arrives if the whole light were in one of its directions, which are uniform in its solid angle Ω for
    /// uniform coordinates from 0 to 1: the illuminance L Ω / π on a surface that faces it, whichever it is.
    pub(crate) fn arrival(&self, at: [f64; 2]) -> Arrival {
        match &self.shape {
            SeenShape::Rectangle(seen) => {
                let path = seen.path(self.solid_angle_sr, at);
                Arrival::from_surface(path, path.length(), self.illuminance)
            }
            SeenShape::Sphere(seen) => {
                let (towards, distance_m) = seen.direction(at);
                Arrival::from_surface(towards * distance_m, distance_m, self.illuminance)
            }
        }
    }
}

/// A sphere seen from outside.
#[derive(Clone, Copy, Debug)]
struct SeenSphere {
    frame: Frame,
    center_m: f64,
    radius_m: f64,
    /// 1 - cos of the half angle.
    height: f64,
}

impl SeenSphere {
    /// The sphere and its solid angle; `None` from within.
    fn new(to_center: Vector, radius_m: f64) -> Option<(Self, f64)> {
        let center_m = to_center.length();
        let sin_squared = (radius_m / center_m) * (radius_m / center_m);
        if sin_squared >= 1.0 {
            return None;
        }
        // 1 - cos of the half angle, without cancellation.
        let height = sin_squared / (1.0 + (1.0 - sin_squared).sqrt());
        let seen = Self {
            frame: Frame::about(to_center * center_m.recip()),
            center_m,
            radius_m,
            height,
        };
        Some((seen, TAU * height))
    }

    /// A direction, and how far the sphere is there.
    fn direction(&self, at: [f64; 2]) -> (Vector, f64) {
        let cos = 1.0 - at[0] * self.height;
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        let turn_rad = TAU * at[1];
        let [across, along] = self.frame.sides();
        let towards = self.frame.axis * cos
            + across * (sin * libm::cos(turn_rad))
            + along * (sin * libm::sin(turn_rad));
        let half_chord_squared =
            self.radius_m * self.radius_m - self.center_m * self.center_m * sin * sin;
        let distance_m = self.center_m * cos - half_chord_squared.max(0.0).sqrt();
        (towards, distance_m)
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
