//! From the text of a scene file to a scene that cannot be wrong.

use std::path::Path;

use protocols::InputError;

use super::Scene;
use super::camera::Camera;
use super::file::{AmbientTable, CameraTable, SceneFile, SpectrumValue};
use super::light::{Ambient, Light, Source};
use super::palette::{Palette, linear_of_srgb, spectrum_of_points};
use super::shapes::shapes;
use super::table::Table;
use crate::geometry::Hierarchy;
use crate::ray_tree::MAX_LIGHTS;
use crate::spectra::Emission;

/// Reads the text of a scene file.
pub(super) fn scene_from_toml(file: &Path, text: &str) -> Result<Scene, InputError> {
    let scene: SceneFile = toml::from_str(text).map_err(|error| {
        let found = error.to_string();
        InputError::new(file, found.trim_end(), "a scene (TOML)")
            .remedy("compare it with stimuli/scenes/opponent-solids.toml")
    })?;
    let palette = Palette::new(file, &scene)?;
    let (shapes, material_of_shape) = shapes(file, &scene, &palette)?;
    let ambient = scene.ambient.as_ref().map(|table| ambient(file, table));
    Ok(Scene {
        camera: camera(file, &scene.camera)?,
        shapes: Hierarchy::over(shapes),
        material_of_shape,
        materials: palette.materials,
        reflectances: palette.reflectances,
        lights: lights(file, &scene)?,
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

fn lights(file: &Path, scene: &SceneFile) -> Result<Vec<Light>, InputError> {
    let mut lights = Vec::new();
    for (number, light) in (1..).zip(&scene.distant_light) {
        let table = Table {
            file,
            kind: "distant_light",
            number: Some(number),
            name: light.name.as_deref(),
        };
        lights.push(Light {
            emission: emission(table, &light.emittance)?,
            source: Source::Distant {
                towards: table.direction("from", light.from)?,
                illuminance: table.brightness("illuminance", light.illuminance)?,
            },
        });
    }
    for (number, light) in (1..).zip(&scene.point_light) {
        let table = Table {
            file,
            kind: "point_light",
            number: Some(number),
            name: light.name.as_deref(),
        };
        lights.push(Light {
            emission: emission(table, &light.emittance)?,
            source: Source::Point {
                position: table.place("position_m", light.position_m)?,
                intensity: table.brightness("intensity", light.intensity)?,
            },
        });
    }
    if (1..=MAX_LIGHTS).contains(&lights.len()) {
        Ok(lights)
    } else {
        let found = format!("{} lights", lights.len());
        let expected = format!("from 1 to {MAX_LIGHTS} of distant_light and point_light");
        Err(InputError::new(file, found, expected))
    }
}

fn emission(table: Table<'_>, emittance: &SpectrumValue) -> Result<Emission, InputError> {
    let (emission, found) = match emittance {
        SpectrumValue::Named(name) => (Emission::named(name), format!("\"{name}\"")),
        SpectrumValue::Points(points) => {
            let spectrum = spectrum_of_points(table, "emittance", points, 1e6)?;
            let found = "control points without visible light".to_owned();
            (Emission::of(spectrum), found)
        }
        SpectrumValue::Srgb(srgb) => {
            let linear = linear_of_srgb(table, "emittance", *srgb)?;
            (Emission::of_linear_srgb(linear), "black".to_owned())
        }
    };
    emission.ok_or_else(|| {
        let expected = "\"D65\", \"A\", \"E\", \"blackbody 3200 K\" (500 to 100000 K), or control \
                        points [[nm, power], ...] with visible light, or { srgb = [r, g, b] }";
        table.error("emittance", found, expected)
    })
}
