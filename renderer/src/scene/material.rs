//! What a surface does with light: geometry here, spectra by reference.

use crate::geometry::SurfacePoint;

/// A place in the reflectances of the scene.
pub(crate) type ReflectanceIndex = u16;

/// What a surface is made of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Material {
    pub(crate) body: Option<Body>,
    pub(crate) highlight: Option<Highlight>,
    pub(crate) mirror: Option<Mirror>,
}

/// What scatters light evenly.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Body {
    pub(crate) reflectance: ReflectanceIndex,
    pub(crate) pattern: Option<Pattern>,
}

/// A second reflectance in every other place of a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pattern {
    pub(crate) layout: PatternLayout,
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

impl Body {
    /// The reflectance at a place of the surface; `place` is only asked for if there is a pattern.
    #[inline]
    pub(crate) fn reflectance_at(&self, place: impl FnOnce() -> SurfacePoint) -> ReflectanceIndex {
        match self.pattern {
            Some(pattern) if pattern.layout.is_other(place()) => pattern.other,
            _ => self.reflectance,
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
