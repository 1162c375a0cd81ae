//! Meshes, materials, cameras and lights from the files of other programs, in one neutral form.
//!
//! glTF 2.0 (`.gltf`, `.glb`), Wavefront OBJ with MTL, and PLY. What a file says and this program cannot do
//! is told by name in the warnings; nothing is dropped in silence. What cannot be read at all is an error.
//!
//! Coordinates leave here in the world's axes (z up, metres): every reader is given the placement of the
//! file in the world. Colours are linear sRGB.
//!
//! Not here: what the materials become (`scene::imported`).

mod gltf_accessor;
mod gltf_extensions;
mod gltf_file;
mod gltf_lights;
mod gltf_material;
mod gltf_mesh;
mod gltf_texture;
mod material;
mod mesh;
mod obj;
mod picture;
mod placement;
mod ply;
mod source;

use std::path::Path;

use protocols::{ReadError, Sha256Digest};

pub(crate) use material::{ImportedMaterial, ImportedSurface, ImportedTexture};
pub(crate) use mesh::ImportedMesh;
pub(crate) use picture::{Filter, Picture, Wrap};
pub(crate) use placement::Placement;
pub(crate) use source::{Format, Source};

/// What a file holds.
#[derive(Debug, Default)]
pub(crate) struct Import {
    pub(crate) meshes: Vec<ImportedMesh>,
    pub(crate) materials: Vec<ImportedMaterial>,
    pub(crate) pictures: Vec<Picture>,
    pub(crate) lights: Vec<ImportedLight>,
    pub(crate) camera: Option<ImportedCamera>,
    /// What the file says that is not done, and what was assumed; a line each.
    pub(crate) warnings: Vec<String>,
    /// The digests of the file and of those that it names, but for pictures, which have their own.
    pub(crate) digests: Vec<Sha256Digest>,
}

/// A light of a file, in the world.
#[derive(Clone, Debug)]
pub(crate) struct ImportedLight {
    pub(crate) name: String,
    /// Linear sRGB, of any brightness.
    pub(crate) colour: [f64; 3],
    pub(crate) source: ImportedSource,
}

/// Where the light of a file comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ImportedSource {
    /// Lux, from the direction of this vector.
    Distant { towards: [f64; 3], lux: f64 },
    /// Candela, from this place.
    Point { position: [f64; 3], candela: f64 },
}

/// The camera of a file, in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ImportedCamera {
    pub(crate) position: [f64; 3],
    pub(crate) forward: [f64; 3],
    pub(crate) up: [f64; 3],
    pub(crate) vertical_field_of_view_deg: f64,
}

/// Reads a file of any format, by its ending, and places it in the world.
///
/// # Errors
///
/// [`ReadError::Input`] if the file or one that it names is missing, malformed or without a triangle, or
/// needs what is not known here.
pub(crate) fn read(path: &Path, placement: &Placement) -> Result<Import, ReadError> {
    let source = Source::open(path)?;
    let mut import = match Format::of(path)? {
        Format::Gltf => gltf_file::read(&source, placement)?,
        Format::Obj => obj::read(&source, placement)?,
        Format::Ply => ply::read(&source, placement)?,
    };
    import.digests.push(Sha256Digest::of(&source.bytes));
    for mesh in &mut import.meshes {
        mesh.check(&source, &mut import.warnings)?;
    }
    import.meshes.retain(|mesh| !mesh.parts.faces.is_empty());
    if import.meshes.is_empty() {
        let error = source.error(
            "no triangle",
            "a mesh of at least one triangle with an area",
        );
        return Err(error.into());
    }
    Ok(import)
}
