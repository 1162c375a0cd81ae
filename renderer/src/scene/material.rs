//! What a surface does with light: geometry here, spectra by reference.

use crate::geometry::{SurfacePoint, Vector};
use crate::spectra::Sigmoid;

/// A place in the reflectances of the scene.
pub(crate) type ReflectanceIndex = u16;

/// A place in the textures of the scene.
pub(crate) type TextureIndex = u16;

/// The spectral reflectance of a place of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Reflectance {
    /// One of the scene's.
    Table(ReflectanceIndex),
    /// A curve of its own.
    Sigmoid(Sigmoid),
}

/// What a surface is made of.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Material {
    pub(crate) body: Option<Body>,
    pub(crate) highlight: Option<Highlight>,
    pub(crate) mirror: Option<Mirror>,
    /// The light that the surface is, as a place among the lights of the scene.
    pub(crate) emission: Option<u16>,
}

/// What scatters light evenly.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Body {
    /// The same everywhere.
    Plain(ReflectanceIndex),
    /// Two reflectances that take turns.
    Patterned(Pattern),
    /// A picture on the surface.
    Textured(TextureIndex),
}

/// A second reflectance in every other place of a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pattern {
    pub(crate) layout: PatternLayout,
    pub(crate) reflectance: ReflectanceIndex,
    pub(crate) other: ReflectanceIndex,
}

/// Where the second reflectance is; the first is at the origin of the surface coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) enum PatternLayout {
    /// In every other square.
    Checker { size_m: f64 },
    /// In every other stripe; stripes part u.
    StripesAcrossU { size_m: f64 },
    /// In every other stripe; stripes part v.
    StripesAcrossV { size_m: f64 },
}

/// The gloss of a light: `strength · (cos α)^exponent`, Phong (1975).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Highlight {
    strength: f64,
    exponent: f64,
    /// Below this cosine the highlight is fainter than [`FAINTEST_HIGHLIGHT`] and left out.
    least_cos: f64,
}

/// A highlight this faint under the illuminance 1 is a hundredth of an 8-bit step in black.
const FAINTEST_HIGHLIGHT: f64 = 3e-6;

/// What mirrors the surroundings.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Mirror {
    /// A metal: the same at every angle.
    Metal {
        reflectance: ReflectanceIndex,
        /// The largest value of the reflectance: below a limit the mirrored ray is not followed.
        peak: f64,
    },
    /// A clear coat: Fresnel's formula, the same at every wavelength.
    Coat { refractive_index: f64 },
    /// A clear solid: mirrors by Fresnel's formula and passes the rest on by Snell's law.
    Glass { refractive_index: f64 },
}

impl Highlight {
    /// A highlight that is `strength` times as bright in its middle as a white surface that faces the light.
    pub(crate) fn new(strength: f64, exponent: f64) -> Self {
        let least_cos = if strength > FAINTEST_HIGHLIGHT {
            libm::pow(FAINTEST_HIGHLIGHT / strength, exponent.recip())
        } else {
            1.0
        };
        Self {
            strength,
            exponent,
            least_cos,
        }
    }

    /// How bright the highlight is, given the cosine of the angle from the mirrored direction to the light.
    #[inline]
    pub(crate) fn at(&self, cos_alpha: f64) -> f64 {
        if cos_alpha > self.least_cos {
            self.strength * libm::pow(cos_alpha, self.exponent)
        } else {
            0.0
        }
    }
}

impl Pattern {
    /// The reflectance at a place of the surface.
    #[inline]
    pub(crate) fn reflectance_at(&self, place: SurfacePoint) -> ReflectanceIndex {
        if self.layout.is_other(place) {
            self.other
        } else {
            self.reflectance
        }
    }
}

impl PatternLayout {
    fn is_other(self, place: SurfacePoint) -> bool {
        let is_odd = |length_m: f64, size_m: f64| {
            let cell = libm::floor(length_m / size_m);
            cell - 2.0 * libm::floor(0.5 * cell) == 1.0
        };
        match self {
            Self::Checker { size_m } => is_odd(place.u_m, size_m) != is_odd(place.v_m, size_m),
            Self::StripesAcrossU { size_m } => is_odd(place.u_m, size_m),
            Self::StripesAcrossV { size_m } => is_odd(place.v_m, size_m),
        }
    }
}

/// What part of unpolarised light a clear coat mirrors: Fresnel's formula.
///
/// `cos_incidence` is from 0 (grazing) to 1; the light comes from air.
#[inline]
pub(crate) fn fresnel_reflectance(cos_incidence: f64, refractive_index: f64) -> f64 {
    let sin_squared = 1.0 - cos_incidence * cos_incidence;
    let cos_inside = (1.0 - sin_squared / (refractive_index * refractive_index)).sqrt();
    let across = (cos_incidence - refractive_index * cos_inside)
        / (cos_incidence + refractive_index * cos_inside);
    let along = (refractive_index * cos_incidence - cos_inside)
        / (refractive_index * cos_incidence + cos_inside);
    0.5 * (across * across + along * along)
}

/// What becomes of a ray at the surface of glass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Refraction {
    /// The part that is mirrored.
    pub(crate) reflectance: f64,
    /// The unit direction of the rest; `None` if all is mirrored.
    pub(crate) direction: Option<Vector>,
}

/// Snell's law and Fresnel's formula for unpolarised light.
///
/// `direction` arrives at the side to which the unit `normal` points; `relative_index` is the refractive
/// index beyond the surface divided by that before it.
pub(crate) fn refraction(direction: Vector, normal: Vector, relative_index: f64) -> Refraction {
    let cos_incidence = (-direction.dot(normal)).clamp(0.0, 1.0);
    let sin_squared = (1.0 - cos_incidence * cos_incidence) / (relative_index * relative_index);
    if sin_squared >= 1.0 {
        return Refraction {
            reflectance: 1.0,
            direction: None,
        };
    }
    let cos_beyond = (1.0 - sin_squared).sqrt();
    let bent =
        direction * relative_index.recip() + normal * (cos_incidence / relative_index - cos_beyond);
    Refraction {
        reflectance: fresnel_reflectance(cos_incidence, relative_index),
        direction: Some(bent.normalized()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coat_mirrors_as_fresnel_says() {
        // Straight on ((n − 1)/(n + 1))²; grazing everything; at Brewster's angle tan θ = n only the part
        // across the plane: ((n² − 1)/(n² + 1))² / 2.
        let n = 1.5_f64;
        assert!((fresnel_reflectance(1.0, n) - 0.04).abs() < 1e-15);
        assert!((fresnel_reflectance(0.0, n) - 1.0).abs() < 1e-15);
        let brewster = (1.0 + n * n).sqrt().recip();
        let across = (n * n - 1.0) / (n * n + 1.0);
        assert!((fresnel_reflectance(brewster, n) - 0.5 * across * across).abs() < 1e-15);
    }

    #[test]
    fn glass_bends_light_as_snell_says_and_mirrors_all_beyond_the_critical_angle() {
        let n = 1.5_f64;
        let down = |angle_rad: f64| Vector::new(angle_rad.sin(), 0.0, -angle_rad.cos());
        for angle_deg in [0.0_f64, 10.0, 30.0, 60.0, 89.0] {
            let (angle_rad, inside_rad) = (angle_deg.to_radians(), {
                let sin: f64 = angle_deg.to_radians().sin() / n;
                sin.asin()
            });
            let entering = refraction(down(angle_rad), Vector::UP, n);
            let inside = entering.direction.unwrap();
            assert!((inside - down(inside_rad)).length() < 1e-12);
            // The way back: the same share, the same angle.
            let leaving = refraction(inside, Vector::UP, n.recip());
            assert!((leaving.direction.unwrap() - down(angle_rad)).length() < 1e-12);
            assert!((leaving.reflectance - entering.reflectance).abs() < 1e-12);
        }
        let straight = refraction(down(0.0), Vector::UP, n).reflectance;
        assert!((straight - ((n - 1.0) / (n + 1.0)).powi(2)).abs() < 1e-15);
        let critical_rad = n.recip().asin();
        let least = refraction(down(critical_rad - 1e-6), Vector::UP, n.recip());
        assert!(least.direction.is_some() && least.reflectance < 1.0);
        let most = refraction(down(critical_rad + 1e-6), Vector::UP, n.recip());
        assert_eq!((most.direction, most.reflectance), (None, 1.0));
    }

    #[test]
    fn squares_take_turns_on_both_sides_of_the_origin() {
        let checker = PatternLayout::Checker { size_m: 0.5 };
        let is_other = |u_m, v_m| checker.is_other(SurfacePoint { u_m, v_m });
        assert!(!is_other(0.1, 0.1) && is_other(0.6, 0.1) && is_other(0.1, 0.6));
        assert!(is_other(-0.1, 0.1) && !is_other(-0.1, -0.1) && !is_other(1.1, 0.1));
        let stripes = PatternLayout::StripesAcrossU { size_m: 0.5 };
        assert!(stripes.is_other(SurfacePoint {
            u_m: -0.1,
            v_m: 9.7
        }));
    }
}
