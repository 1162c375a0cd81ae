//! What imported materials and lights become in a scene, by a stated rule.
//!
//! A surface of roughness r has α = r² and a highlight of Phong's form that is about as wide and as high as
//! that of its facets: exponent (2/α² − 2) / 4 and strength F0 (exponent + 2) / 2, F0 = ((n − 1) / (n + 1))².
//! Rougher than 0.9 there is none; below 1/4 the surface mirrors the surroundings too. Highlights are not
//! made narrower than those of r = 1/5.
//!
//! Sources: Walter et al. (2007), *Microfacet Models for Refraction*, for α; Blinn's exponent is about four
//! times Phong's (Fisher & Woo 1994).

use std::sync::Arc;

use protocols::InputError;

use super::material::{Body, Highlight, Material, Mirror};
use super::palette::Palette;
use super::table::Table;
use super::texture::Texture;
use crate::import::{Import, ImportedMaterial, ImportedSurface, Picture};
use crate::spectra::Spectrum;
use crate::spectra::uplift::sigmoid_of_linear_srgb;

/// Rougher surfaces are matte.
const ROUGHEST_GLOSS: f64 = 0.9;
/// Smoother surfaces mirror their surroundings.
const ROUGHEST_COAT: f64 = 0.25;
/// Highlights are not narrower than those of this roughness.
const SMOOTHEST_HIGHLIGHT: f64 = 0.2;

/// Adds the materials of an import: their places, and last that of the grey of what has none.
pub(super) fn add_materials(
    table: Table<'_>,
    palette: &mut Palette,
    import: &mut Import,
) -> Result<Vec<u16>, InputError> {
    let pictures: Vec<Arc<Picture>> = import.pictures.drain(..).map(Arc::new).collect();
    let mut materials = std::mem::take(&mut import.materials);
    if import.meshes.iter().any(|mesh| mesh.material.is_none()) {
        materials.push(ImportedMaterial::grey("(none)"));
    }
    let places = materials.iter().map(|material| {
        let mut adder = Adder {
            table,
            palette,
            pictures: &pictures,
            warnings: &mut import.warnings,
        };
        let material = adder.material(material)?;
        palette.add_unnamed(table, material)
    });
    places.collect()
}

struct Adder<'all> {
    table: Table<'all>,
    palette: &'all mut Palette,
    pictures: &'all [Arc<Picture>],
    warnings: &'all mut Vec<String>,
}

impl Adder<'_> {
    fn material(&mut self, imported: &ImportedMaterial) -> Result<Material, InputError> {
        if !imported
            .colour
            .iter()
            .all(|primary| (0.0..=1.0).contains(primary))
        {
            let what = format!("a colour of {:?}: held to 0 to 1", imported.colour);
            self.warn(imported, &what);
        }
        let material = match imported.surface {
            ImportedSurface::Matte => Material {
                body: Some(self.body(imported)?),
                ..Material::default()
            },
            ImportedSurface::Glossy {
                refractive_index,
                roughness,
            } => {
                let coat = Mirror::Coat { refractive_index };
                Material {
                    body: Some(self.body(imported)?),
                    highlight: highlight(refractive_index, roughness),
                    mirror: (roughness < ROUGHEST_COAT).then_some(coat),
                    ..Material::default()
                }
            }
            ImportedSurface::Metal => {
                let spectrum = self.plain(imported);
                let peak = spectrum.peak();
                let reflectance = self.palette.index(self.table, spectrum)?;
                Material {
                    mirror: Some(Mirror::Metal { reflectance, peak }),
                    ..Material::default()
                }
            }
            ImportedSurface::Glass { refractive_index } => Material {
                mirror: Some(Mirror::Glass { refractive_index }),
                ..Material::default()
            },
        };
        Ok(material)
    }

    fn body(&mut self, imported: &ImportedMaterial) -> Result<Body, InputError> {
        if let Some(texture) = imported.texture {
            let texture = Texture {
                picture: Arc::clone(&self.pictures[texture.picture]),
                factor: imported.colour,
                wrap: texture.wrap,
                filter: texture.filter,
            };
            return self.palette.add_texture(self.table, texture);
        }
        let spectrum = Spectrum::Sigmoid(sigmoid_of_linear_srgb(imported.colour));
        Ok(Body::Plain(self.palette.index(self.table, spectrum)?))
    }

    /// One reflectance for the whole surface: of a texture, that of its mean colour.
    fn plain(&mut self, imported: &ImportedMaterial) -> Spectrum {
        let mut colour = imported.colour;
        if let Some(texture) = imported.texture {
            self.warn(
                imported,
                "a texture on metal is not supported: its mean colour is taken",
            );
            let mean = self.pictures[texture.picture].mean();
            colour = [0, 1, 2].map(|primary| colour[primary] * mean[primary]);
        }
        Spectrum::Sigmoid(sigmoid_of_linear_srgb(colour))
    }

    fn warn(&mut self, imported: &ImportedMaterial, what: &str) {
        let (file, name) = (self.table.file.display(), &imported.name);
        self.warnings
            .push(format!("\"{file}\", material \"{name}\": {what}"));
    }
}

fn highlight(refractive_index: f64, roughness: f64) -> Option<Highlight> {
    if roughness > ROUGHEST_GLOSS {
        return None;
    }
    let roughness = roughness.max(SMOOTHEST_HIGHLIGHT);
    let alpha = roughness * roughness;
    let exponent = f64::max((2.0 / (alpha * alpha) - 2.0) / 4.0, 1.0);
    let root = (refractive_index - 1.0) / (refractive_index + 1.0);
    Some(Highlight::new(
        root * root * (exponent + 2.0) / 2.0,
        exponent,
    ))
}
