//! From the text of a scene file to a scene that cannot be wrong.

use std::path::Path;

use protocols::{InputError, ReadError, Sha256Digest};

use super::Scene;
use super::camera::Camera;
use super::enclosure;
use super::file::{AmbientTable, CameraTable, SceneFile};
use super::light::{Ambient, Light, Source};
use super::lights::{emission, lights};
use super::material::Material;
use super::meshes::add_meshes;
use super::palette::Palette;
use super::shapes::Objects;
use super::table::Table;
use crate::geometry::Hierarchy;
use crate::import::Import;

/// Reads the text of a scene file.
pub(super) fn scene_from_toml(file: &Path, text: &str) -> Result<Scene, ReadError> {
    let scene: SceneFile = toml::from_str(text).map_err(|error| {
        let found = error.to_string();
        InputError::new(file, found.trim_end(), "a scene (TOML)")
            .remedy("compare it with stimuli/scenes/opponent-solids.toml")
    })?;
    let mut palette = Palette::new(file, &scene)?;
    let mut objects = Objects::new(file, &scene, &palette)?;
    let imports = add_meshes(file, &scene, &mut palette, &mut objects)?;
    let ambient = scene.ambient.as_ref().map(|table| ambient(file, table));
    let (lights, light_names) = lights(file, &scene)?;
    Ok(assemble(Parts {
        camera: camera(file, &scene.camera)?,
        palette,
        objects,
        lights,
        light_names,
        ambient: ambient.transpose()?,
        imports,
    }))
}

/// All that a scene is made of.
pub(super) struct Parts {
    pub(super) camera: Camera,
    pub(super) palette: Palette,
    pub(super) objects: Objects,
    pub(super) lights: Vec<Light>,
    /// For each light how to speak of it.
    pub(super) light_names: Vec<String>,
    pub(super) ambient: Option<Ambient>,
    /// What is left of the imports: their warnings and digests.
    pub(super) imports: Vec<Import>,
}

/// Puts a scene together, with the shapes of its area lights.
pub(super) fn assemble(parts: Parts) -> Scene {
    let Parts {
        camera,
        palette,
        objects,
        lights,
        light_names,
        ambient,
        imports,
    } = parts;
    let Objects {
        mut shapes,
        materials: mut material_of_shape,
        labels,
    } = objects;
    let mut materials = palette.materials;
    for (number, light) in (0..).zip(&lights) {
        if let Source::Area(area) = &light.source {
            let material = u16::try_from(materials.len()).unwrap_or(u16::MAX);
            materials.push(Material {
                emission: Some(number),
                ..Material::default()
            });
            shapes.push(area.shape());
            material_of_shape.push(material);
        }
    }
    let mut scene = Scene {
        camera,
        shapes: Hierarchy::over(shapes),
        material_of_shape,
        materials,
        reflectances: palette.reflectances,
        textures: palette.textures,
        lights,
        ambient,
        warnings: Vec::new(),
        imported: Vec::new(),
    };
    let pictures = scene
        .textures
        .iter()
        .map(|texture| texture.picture.sha256.clone());
    let pictures: Vec<Sha256Digest> = pictures.collect();
    for import in imports {
        scene.warnings.extend(import.warnings);
        scene.imported.extend(import.digests);
    }
    scene.imported.extend(pictures);
    let shut = enclosure::warnings(&scene, &labels, &light_names);
    scene.warnings.extend(shut);
    scene
}

fn only<'file>(file: &'file Path, kind: &'file str) -> Table<'file> {
    Table {
        file,
        kind,
        number: None,
        name: None,
    }
}

fn camera(file: &Path, camera: &CameraTable) -> Result<Camera, InputError> {
    let table = only(file, "camera");
    let [position, look_at] = table.two_places(
        ("position_m", camera.position_m),
        ("look_at_m", camera.look_at_m),
    )?;
    let forward = (look_at - position).normalized();
    let up = table.direction("up", camera.up)?;
    if forward.cross(up).length() < 1e-6 {
        let expected = "a direction that is not the one in which the camera looks";
        return Err(table.error("up", format!("{:?}", camera.up), expected));
    }
    let field_of_view_deg = table.number_within(
        "vertical_field_of_view_deg",
        camera.vertical_field_of_view_deg,
        (0.01, 170.0),
    )?;
    Ok(Camera::new(position, forward, up, field_of_view_deg))
}

fn ambient(file: &Path, ambient: &AmbientTable) -> Result<Ambient, InputError> {
    let table = only(file, "ambient");
    Ok(Ambient {
        emission: emission(table, &ambient.emittance)?,
        illuminance: table.brightness("illuminance", ambient.illuminance)?,
    })
}
