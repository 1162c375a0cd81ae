//! A material of a file, before it is one of the scene.

use super::picture::{Filter, Wrap};

/// What a file says of a surface.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ImportedMaterial {
    pub(crate) name: String,
    /// Linear sRGB; a texture is multiplied with it.
    pub(crate) colour: [f64; 3],
    pub(crate) texture: Option<ImportedTexture>,
    pub(crate) surface: ImportedSurface,
}

/// How a surface reflects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ImportedSurface {
    Matte,
    /// A coloured body under a clear surface.
    Glossy {
        refractive_index: f64,
        /// From 0, a mirror, to 1, as glTF has it.
        roughness: f64,
    },
    /// A coloured mirror.
    Metal,
    Glass {
        refractive_index: f64,
    },
}

/// The use of a picture as a colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ImportedTexture {
    /// A place in the import's pictures.
    pub(crate) picture: usize,
    pub(crate) wrap: [Wrap; 2],
    pub(crate) filter: Filter,
}

impl ImportedMaterial {
    /// The grey of what has no material.
    pub(crate) fn grey(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            colour: [0.5; 3],
            texture: None,
            surface: ImportedSurface::Matte,
        }
    }
}
