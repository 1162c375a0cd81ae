//! What one ray found, geometry only: section 3.3 of Meyer & Liu (1992), step 1.
//!
//! Every way by which light reaches the eye is one entry: from a light to at most one surface that scatters
//! it, and from there by mirrors and glass to the eye. How much of the light takes that way, whatever its
//! colour, is its share; the spectra on the way are only named. A way along which nothing arrives is left out.
//!
//! Not here: how rays are followed (`scene_sampler`) and what colour they bring (`shader`).

use crate::scene::material::Reflectance;
use crate::tints::TintIndex;

/// The ways by which light reaches one ray; the memory is reused.
#[derive(Clone, Debug, Default)]
pub struct RayTree {
    /// Ways whose spectra are multiplied in advance.
    paths: Vec<LightPath>,
    /// Surfaces whose spectra are not.
    surfaces: Vec<LitSurface>,
    /// The shares of those surfaces, one surface after another.
    shares: Vec<LightShare>,
    hits: u32,
}

/// A way whose light, reflectance and mirrors are a product that the shader knows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightPath {
    pub(crate) share: f32,
    pub(crate) product: u32,
}

/// A surface that scatters light with a spectrum of its own.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LitSurface {
    pub(crate) reflectance: Reflectance,
    pub(crate) tint: TintIndex,
    /// The end of its shares; they begin where those of the surface before end.
    end: u32,
}

/// How much a light contributes at a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightShare {
    /// A place among the lights of the scene; ambient light comes after the last.
    pub(crate) light: u16,
    pub(crate) share: f32,
}

impl RayTree {
    /// How many surfaces the ray and those that it spawned met.
    pub fn hits(&self) -> u32 {
        self.hits
    }

    /// The ways whose products are known.
    #[inline]
    pub(crate) fn paths(&self) -> &[LightPath] {
        &self.paths
    }

    /// The other surfaces, each with its shares.
    pub(crate) fn surfaces(&self) -> impl Iterator<Item = (&LitSurface, &[LightShare])> {
        let mut start = 0;
        self.surfaces.iter().map(move |surface| {
            let end = surface.end as usize;
            let shares = &self.shares[start..end];
            start = end;
            (surface, shares)
        })
    }

    /// Forgets everything.
    #[inline]
    pub(crate) fn clear(&mut self) {
        self.paths.clear();
        self.surfaces.clear();
        self.shares.clear();
        self.hits = 0;
    }

    /// Counts a hit.
    #[inline]
    pub(crate) fn count_hit(&mut self) {
        self.hits += 1;
    }

    /// Adds a way.
    #[inline]
    pub(crate) fn add_path(&mut self, product: u32, share: f32) {
        self.paths.push(LightPath { share, product });
    }

    /// Adds a share of the surface that is added next.
    pub(crate) fn add_share(&mut self, light: u16, share: f32) {
        self.shares.push(LightShare { light, share });
    }

    /// Adds the surface of the shares since the last one, if there are any.
    pub(crate) fn add_surface(&mut self, reflectance: Reflectance, tint: TintIndex) {
        let end = u32::try_from(self.shares.len()).unwrap_or(u32::MAX);
        if end > self.surfaces.last().map_or(0, |last| last.end) {
            self.surfaces.push(LitSurface {
                reflectance,
                tint,
                end,
            });
        }
    }
}
