//! The materials and reflectances of a scene, by name.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use protocols::{InputError, ReadError};

use super::file::{
    CheckerTable, SceneFile, SpectrumValue, StripeDirection, StripesTable, TextureTable,
};
use super::material::{
    Body, Highlight, Material, Mirror, Pattern, PatternLayout, ReflectanceIndex, TextureIndex,
};
use super::table::Table;
use super::texture::Texture;
use crate::import::Picture;
use crate::spectra::uplift::sigmoid_of_linear_srgb;
use crate::spectra::{Spectrum, measured};
use crate::srgb::srgb_decoded;

/// The materials of a scene and what they refer to.
#[derive(Debug, Default)]
pub(super) struct Palette {
    pub(super) reflectances: Vec<Spectrum>,
    pub(super) materials: Vec<Material>,
    pub(super) textures: Vec<Texture>,
    /// For each name the place in `materials`.
    material_of_name: BTreeMap<String, u16>,
}

/// The reflectances that the file names, and the file for errors.
struct Known<'file> {
    file: &'file Path,
    by_name: BTreeMap<&'file str, Spectrum>,
}

impl Palette {
    /// Checks and collects the materials.
    pub(super) fn new(file: &Path, scene: &SceneFile) -> Result<Self, ReadError> {
        let known = Known::new(file, scene)?;
        let mut palette = Self::default();
        for (name, table) in &scene.diffuse {
            let place = known.table("diffuse", name);
            let fields = BodyFields {
                reflectance: table.reflectance.as_ref(),
                texture: table.texture.as_ref(),
                checker: table.checker.as_ref(),
                stripes: table.stripes.as_ref(),
            };
            let body = palette.body(&known, place, &fields)?;
            let material = Material {
                body: Some(body),
                ..Material::default()
            };
            palette.add(place, name, material)?;
        }
        for (name, table) in &scene.glossy {
            let place = known.table("glossy", name);
            let fields = BodyFields {
                reflectance: table.reflectance.as_ref(),
                texture: table.texture.as_ref(),
                checker: table.checker.as_ref(),
                stripes: table.stripes.as_ref(),
            };
            let body = palette.body(&known, place, &fields)?;
            let refractive_index = table.refractive_index.map(|refractive_index| {
                place.number_within("refractive_index", refractive_index, (1.0, 4.0))
            });
            let coat = refractive_index
                .transpose()?
                .map(|refractive_index| Mirror::Coat { refractive_index });
            let material = Material {
                body: Some(body),
                highlight: Some(highlight(place, table.highlight, table.exponent)?),
                mirror: coat,
                ..Material::default()
            };
            palette.add(place, name, material)?;
        }
        palette.add_mirrors_and_glass(&known, scene)?;
        Ok(palette)
    }

    fn add_mirrors_and_glass(
        &mut self,
        known: &Known<'_>,
        scene: &SceneFile,
    ) -> Result<(), InputError> {
        for (name, table) in &scene.mirror {
            let place = known.table("mirror", name);
            let spectrum = known.reflectance(place, "reflectance", &table.reflectance)?;
            let peak = spectrum.peak();
            let reflectance = self.index(place, spectrum)?;
            let material = Material {
                highlight: optional_highlight(place, table.highlight, table.exponent)?,
                mirror: Some(Mirror::Metal { reflectance, peak }),
                ..Material::default()
            };
            self.add(place, name, material)?;
        }
        for (name, table) in &scene.glass {
            let place = known.table("glass", name);
            let refractive_index =
                place.number_within("refractive_index", table.refractive_index, (1.0, 4.0))?;
            let material = Material {
                highlight: optional_highlight(place, table.highlight, table.exponent)?,
                mirror: Some(Mirror::Glass { refractive_index }),
                ..Material::default()
            };
            self.add(place, name, material)?;
        }
        Ok(())
    }

    /// The place of the material that an object names.
    pub(super) fn material(&self, object: Table<'_>, name: &str) -> Result<u16, InputError> {
        let known = self.material_of_name.get(name).copied();
        known.ok_or_else(|| {
            let names: Vec<&str> = self.material_of_name.keys().map(String::as_str).collect();
            let expected = format!("one of the scene's materials ({})", names.join(", "));
            object
                .error("material", format!("\"{name}\""), expected)
                .remedy("name one of these or add a table for it, such as [diffuse.NAME]")
        })
    }

    fn add(&mut self, place: Table<'_>, name: &str, material: Material) -> Result<(), InputError> {
        let index = u16::try_from(self.materials.len()).map_err(|error| too_many(place, error))?;
        self.materials.push(material);
        match self.material_of_name.insert(name.to_owned(), index) {
            None => Ok(()),
            Some(_) => Err(place.error(
                "(the table's name)",
                format!("a second material \"{name}\""),
                "each name once among diffuse, glossy, mirror and glass",
            )),
        }
    }

    /// The place of a reflectance, which is added if it is new.
    pub(super) fn index(
        &mut self,
        place: Table<'_>,
        spectrum: Spectrum,
    ) -> Result<ReflectanceIndex, InputError> {
        let known = self
            .reflectances
            .iter()
            .position(|known| *known == spectrum);
        let index = known.unwrap_or(self.reflectances.len());
        if known.is_none() {
            self.reflectances.push(spectrum);
        }
        ReflectanceIndex::try_from(index).map_err(|error| too_many(place, error))
    }

    /// Adds a material that has no name in the scene file.
    pub(super) fn add_unnamed(
        &mut self,
        place: Table<'_>,
        material: Material,
    ) -> Result<u16, InputError> {
        let index = u16::try_from(self.materials.len()).map_err(|error| too_many(place, error))?;
        self.materials.push(material);
        Ok(index)
    }

    /// Adds a texture.
    pub(super) fn add_texture(
        &mut self,
        place: Table<'_>,
        texture: Texture,
    ) -> Result<Body, InputError> {
        let index = TextureIndex::try_from(self.textures.len());
        let index = index.map_err(|error| too_many(place, error))?;
        self.textures.push(texture);
        Ok(Body::Textured(index))
    }

    fn body(
        &mut self,
        known: &Known<'_>,
        place: Table<'_>,
        fields: &BodyFields<'_>,
    ) -> Result<Body, ReadError> {
        let Some(reflectance) = fields.reflectance else {
            return self.textured_body(known.file, place, fields);
        };
        if fields.texture.is_some() {
            let found = "a texture beside a reflectance";
            return Err(place.error("texture", found, "one of the two").into());
        }
        let spectrum = known.reflectance(place, "reflectance", reflectance)?;
        let reflectance = self.index(place, spectrum)?;
        let (layout, field, other) = match (fields.checker, fields.stripes) {
            (None, None) => return Ok(Body::Plain(reflectance)),
            (Some(checker), None) => {
                let size_m = place.length_m("checker.size_m", checker.size_m)?;
                let layout = PatternLayout::Checker { size_m };
                (layout, "checker.reflectance", &checker.reflectance)
            }
            (None, Some(stripes)) => {
                let size_m = place.length_m("stripes.size_m", stripes.size_m)?;
                let layout = match stripes.across {
                    StripeDirection::U => PatternLayout::StripesAcrossU { size_m },
                    StripeDirection::V => PatternLayout::StripesAcrossV { size_m },
                };
                (layout, "stripes.reflectance", &stripes.reflectance)
            }
            (Some(_), Some(_)) => {
                let found = "stripes beside a checker";
                return Err(place.error("stripes", found, "one of the two").into());
            }
        };
        let other = known.reflectance(place, field, other)?;
        let other = self.index(place, other)?;
        Ok(Body::Patterned(Pattern {
            layout,
            reflectance,
            other,
        }))
    }

    fn textured_body(
        &mut self,
        file: &Path,
        place: Table<'_>,
        fields: &BodyFields<'_>,
    ) -> Result<Body, ReadError> {
        let Some(texture) = fields.texture else {
            let expected = "a reflectance or a texture";
            return Err(place.error("reflectance", "nothing", expected).into());
        };
        if fields.checker.is_some() || fields.stripes.is_some() {
            let found = "a texture beside a checker or stripes";
            return Err(place.error("texture", found, "one of them").into());
        }
        let path = file.parent().unwrap_or(Path::new("")).join(&texture.file);
        let picture = Picture::read(&path, &place.label())?;
        let texture = Texture {
            picture: Arc::new(picture),
            factor: [1.0; 3],
            wrap: [texture.wrap; 2],
            filter: texture.filter,
        };
        Ok(self.add_texture(place, texture)?)
    }
}

/// The fields of a table that say what its body is.
struct BodyFields<'file> {
    reflectance: Option<&'file SpectrumValue>,
    texture: Option<&'file TextureTable>,
    checker: Option<&'file CheckerTable>,
    stripes: Option<&'file StripesTable>,
}

impl<'file> Known<'file> {
    fn new(file: &'file Path, scene: &'file SceneFile) -> Result<Self, InputError> {
        let mut known = Self {
            file,
            by_name: BTreeMap::new(),
        };
        for (name, value) in &scene.reflectances {
            let place = known.table("reflectances", name);
            if measured::reflectance(name).is_some() {
                let found = "the name of a measured reflectance";
                return Err(place.error("(the entry's name)", found, "a name of its own"));
            }
            // Only measured names: an entry cannot refer to another one.
            let spectrum = match value {
                SpectrumValue::Named(measured) => {
                    measured::reflectance(measured).ok_or_else(|| {
                        let expected = format!(
                            "control points, or a measured reflectance ({})",
                            measured::names().join(", ")
                        );
                        place.error("(its value)", format!("\"{measured}\""), expected)
                    })?
                }
                SpectrumValue::Points(points) => {
                    reflectance_of_points(place, "(its value)", points)?
                }
                SpectrumValue::Srgb(srgb) => reflectance_of_srgb(place, "(its value)", *srgb)?,
            };
            known.by_name.insert(name, spectrum);
        }
        Ok(known)
    }

    fn table(&self, kind: &'file str, name: &'file str) -> Table<'file> {
        Table {
            file: self.file,
            kind,
            number: None,
            name: Some(name),
        }
    }

    fn reflectance(
        &self,
        place: Table<'_>,
        field: &str,
        value: &SpectrumValue,
    ) -> Result<Spectrum, InputError> {
        match value {
            SpectrumValue::Points(points) => reflectance_of_points(place, field, points),
            SpectrumValue::Srgb(srgb) => reflectance_of_srgb(place, field, *srgb),
            SpectrumValue::Named(name) => {
                let known = self.by_name.get(name.as_str()).cloned();
                let known = known.or_else(|| measured::reflectance(name));
                known.ok_or_else(|| {
                    let own: Vec<&str> = self.by_name.keys().copied().collect();
                    let expected = format!(
                        "an entry of [reflectances] ({}) or a measured one ({})",
                        own.join(", "),
                        measured::names().join(", ")
                    );
                    place.error(field, format!("\"{name}\""), expected)
                })
            }
        }
    }
}

/// The spectrum of control points with values from 0 to `most`.
pub(super) fn spectrum_of_points(
    place: Table<'_>,
    field: &str,
    points: &[[f64; 2]],
    most: f64,
) -> Result<Spectrum, InputError> {
    if points.is_empty() {
        return Err(place.error(field, "no control points", "at least one [nm, value]"));
    }
    for &[nm, value] in points {
        if !(100.0..=10_000.0).contains(&nm) {
            let expected = "wavelengths from 100 to 10000 nm";
            return Err(place.error(field, format!("{nm} nm"), expected));
        }
        if !(0.0..=most).contains(&value) {
            let expected = format!("values from 0 to {most}");
            return Err(place.error(field, format!("{value} at {nm} nm"), expected));
        }
    }
    if !points.iter().any(|&[nm, _]| (360.0..=830.0).contains(&nm)) {
        let found = "no control point that is seen";
        return Err(place.error(field, found, "at least one from 360 to 830 nm"));
    }
    if let Some(pair) = points.windows(2).find(|pair| pair[0][0] >= pair[1][0]) {
        let found = format!("{} nm before {} nm", pair[0][0], pair[1][0]);
        return Err(place.error(field, found, "wavelengths that rise"));
    }
    Ok(Spectrum::of_points(points.to_vec()))
}

fn reflectance_of_points(
    place: Table<'_>,
    field: &str,
    points: &[[f64; 2]],
) -> Result<Spectrum, InputError> {
    spectrum_of_points(place, field, points, 1.0)
}

/// The reflectance of an encoded sRGB colour.
fn reflectance_of_srgb(
    place: Table<'_>,
    field: &str,
    srgb: [f64; 3],
) -> Result<Spectrum, InputError> {
    let linear = linear_of_srgb(place, field, srgb)?;
    Ok(Spectrum::Sigmoid(sigmoid_of_linear_srgb(linear)))
}

/// The linear primaries of an encoded sRGB colour.
pub(super) fn linear_of_srgb(
    place: Table<'_>,
    field: &str,
    srgb: [f64; 3],
) -> Result<[f64; 3], InputError> {
    if srgb.iter().all(|primary| (0.0..=1.0).contains(primary)) {
        Ok(srgb.map(srgb_decoded))
    } else {
        let expected = "sRGB primaries from 0 to 1";
        Err(place.error(field, format!("srgb = {srgb:?}"), expected))
    }
}

fn highlight(place: Table<'_>, strength: f64, exponent: f64) -> Result<Highlight, InputError> {
    let strength = place.number_within("highlight", strength, (0.0, 100.0))?;
    let exponent = place.number_within("exponent", exponent, (1.0, 1e6))?;
    Ok(Highlight::new(strength, exponent))
}

fn optional_highlight(
    place: Table<'_>,
    strength: Option<f64>,
    exponent: Option<f64>,
) -> Result<Option<Highlight>, InputError> {
    match (strength, exponent) {
        (None, None) => Ok(None),
        (Some(strength), Some(exponent)) => highlight(place, strength, exponent).map(Some),
        (Some(_), None) => Err(alone(place, "exponent", "highlight")),
        (None, Some(_)) => Err(alone(place, "highlight", "exponent")),
    }
}

fn alone(place: Table<'_>, missing: &str, given: &str) -> InputError {
    place.error(missing, "nothing", format!("a number, as {given} is given"))
}

fn too_many(place: Table<'_>, error: std::num::TryFromIntError) -> InputError {
    let found = format!("more than 65536 of its kind ({error})");
    place.error("(the table)", found, "fewer")
}
