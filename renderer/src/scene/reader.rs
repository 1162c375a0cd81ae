//! From the text of a scene file to a scene that cannot be wrong.

use std::path::Path;

use protocols::InputError;

use super::Scene;
use super::camera::Camera;
use super::file::{AmbientTable, CameraTable, SceneFile};
use super::light::{Ambient, Source};
use super::lights::{emission, lights};
use super::material::Material;
use super::palette::Palette;
use super::shapes::shapes;
use super::table::Table;
use crate::geometry::Hierarchy;

/// Reads the text of a scene file.
pub(super) fn scene_from_toml(file: &Path, text: &str) -> Result<Scene, InputError> {
    let scene: SceneFile = toml::from_str(text).map_err(|error| {
        let found = error.to_string();
        InputError::new(file, found.trim_end(), "a scene (TOML)")
            .remedy("compare it with stimuli/scenes/opponent-solids.toml")
    })?;
    let palette = Palette::new(file, &scene)?;
    let (mut shapes, mut material_of_shape) = shapes(file, &scene, &palette)?;
    let ambient = scene.ambient.as_ref().map(|table| ambient(file, table));
    let lights = lights(file, &scene)?;
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
    Ok(Scene {
        camera: camera(file, &scene.camera)?,
        shapes: Hierarchy::over(shapes),
        material_of_shape,
        materials,
        reflectances: palette.reflectances,
        textures: Vec::new(),
        lights,
        ambient: ambient.transpose()?,
    })
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
