//! The materials of a glTF, by a stated rule.
//!
//! | glTF | here |
//! |---|---|
//! | transmission above 1/2 | glass of the `ior` |
//! | metallic above 1/2 | a mirror of the base colour if roughness is below 1/4, else a matte body of it |
//! | otherwise | a body of the base colour under a clear surface of the `ior` and roughness |
//!
//! The body is matte if roughness is above 0.9; below 1/4 the surface also mirrors the surroundings.

use gltf::Material;
use gltf::material::AlphaMode;

use super::gltf_file::{GltfFile, named};
use super::{Import, ImportedMaterial, ImportedSurface, gltf_texture};

/// The refractive index of glTF where a file says nothing.
const USUAL_INDEX: f64 = 1.5;
/// Rougher metal does not mirror here.
const ROUGHEST_MIRROR: f64 = 0.25;

/// A material, with warnings for what it asks for in vain.
pub(super) fn material(
    file: &GltfFile<'_>,
    material: &Material<'_>,
    import: &mut Import,
) -> ImportedMaterial {
    let name = named("material", material.name(), material.index().unwrap_or(0));
    warn(file, material, &name, import);
    let pbr = material.pbr_metallic_roughness();
    let [r, g, b, _] = pbr.base_color_factor();
    let texture = pbr.base_color_texture();
    let texture = texture.map(|texture| gltf_texture::texture(&texture));
    ImportedMaterial {
        colour: [r, g, b].map(f64::from),
        texture,
        surface: surface(file, material, &name, import),
        name: material
            .name()
            .map_or_else(|| name.clone(), ToOwned::to_owned),
    }
}

fn surface(
    file: &GltfFile<'_>,
    material: &Material<'_>,
    name: &str,
    import: &mut Import,
) -> ImportedSurface {
    let pbr = material.pbr_metallic_roughness();
    let roughness = f64::from(pbr.roughness_factor());
    let refractive_index = refractive_index(file, material, name, import);
    let transmission = material.transmission();
    let transmission = transmission.map_or(0.0, |transmission| transmission.transmission_factor());
    let mut say = |what: &str| file.warn(import, name, what);
    let mut either = |value: f32, what: &str| {
        let taken = i32::from(value > 0.5);
        if value > 0.0 && value < 1.0 {
            say(&format!(
                "a {what} of {value} is not supported: taken as {taken}"
            ));
        }
        taken == 1
    };
    if either(transmission, "transmission") {
        if roughness > 0.0 {
            say(&format!(
                "a roughness of {roughness} of glass is not supported: taken as 0"
            ));
        }
        if pbr.base_color_factor()[..3] != [1.0; 3] || pbr.base_color_texture().is_some() {
            say("coloured glass is not supported: taken as clear");
        }
        return ImportedSurface::Glass { refractive_index };
    }
    let is_metal = either(pbr.metallic_factor(), "metallic part");
    if material.unlit() {
        say("KHR_materials_unlit is not supported: taken as matte");
        ImportedSurface::Matte
    } else if is_metal && roughness > ROUGHEST_MIRROR {
        say(&format!(
            "metal of the roughness {roughness} is not supported: taken as matte"
        ));
        ImportedSurface::Matte
    } else if is_metal {
        if roughness > 0.0 {
            say(&format!(
                "a roughness of {roughness} of metal is not supported: taken as 0"
            ));
        }
        ImportedSurface::Metal
    } else {
        ImportedSurface::Glossy {
            refractive_index,
            roughness,
        }
    }
}

fn refractive_index(
    file: &GltfFile<'_>,
    material: &Material<'_>,
    name: &str,
    import: &mut Import,
) -> f64 {
    let index = material.ior().map_or(USUAL_INDEX, f64::from);
    if (1.0..=4.0).contains(&index) {
        return index;
    }
    let what = format!("a refractive index of {index}, not 1 to 4: taken as {USUAL_INDEX}");
    file.warn(import, name, &what);
    USUAL_INDEX
}

/// Warns of what no surface here has.
fn warn(file: &GltfFile<'_>, material: &Material<'_>, name: &str, import: &mut Import) {
    let pbr = material.pbr_metallic_roughness();
    let shines = material.emissive_factor() != [0.0; 3] || material.emissive_texture().is_some();
    let transmission = material.transmission();
    let has_transmission_texture =
        transmission.is_some_and(|transmission| transmission.transmission_texture().is_some());
    for (is_there, what) in [
        (shines, "emission is not supported: ignored"),
        (
            material.normal_texture().is_some(),
            "normal textures are not supported: ignored",
        ),
        (
            material.occlusion_texture().is_some(),
            "occlusion textures are not needed: ignored",
        ),
        (
            pbr.metallic_roughness_texture().is_some(),
            "metallic-roughness textures are not supported: the factors alone count",
        ),
        (
            has_transmission_texture,
            "transmission textures are not supported: the factor alone counts",
        ),
        (
            material.alpha_mode() != AlphaMode::Opaque,
            "alpha is not supported: the surface is opaque",
        ),
    ] {
        if is_there {
            file.warn(import, name, what);
        }
    }
}
