//! The camera and the lights of a glTF.

use gltf::Camera;
use gltf::camera::Projection;
use gltf::khr_lights_punctual::{Kind, Light};

use super::gltf_file::{GltfFile, named};
use super::{Import, ImportedCamera, ImportedLight, ImportedSource, Placement};

/// Takes the first perspective camera: it looks along its −z, with y up.
pub(super) fn add_camera(
    file: &GltfFile<'_>,
    camera: &Camera<'_>,
    placement: &Placement,
    import: &mut Import,
) {
    let name = named("camera", camera.name(), camera.index());
    let Projection::Perspective(perspective) = camera.projection() else {
        file.warn(
            import,
            &name,
            "orthographic cameras are not supported: ignored",
        );
        return;
    };
    if import.camera.is_some() {
        file.warn(import, &name, "a further camera: left out");
        return;
    }
    import.camera = Some(ImportedCamera {
        position: placement.offset,
        forward: placement.direction([0.0, 0.0, -1.0]),
        up: placement.direction([0.0, 1.0, 0.0]),
        vertical_field_of_view_deg: f64::from(perspective.yfov()).to_degrees(),
    });
}

/// Adds a point or directional light; a directional one shines along its −z.
pub(super) fn add_light(
    file: &GltfFile<'_>,
    light: &Light<'_>,
    placement: &Placement,
    import: &mut Import,
) {
    let thing = named("light", light.name(), light.index());
    let intensity = f64::from(light.intensity());
    let source = match light.kind() {
        Kind::Directional => ImportedSource::Distant {
            towards: placement.direction([0.0, 0.0, 1.0]),
            lux: intensity,
        },
        Kind::Point => ImportedSource::Point {
            position: placement.offset,
            candela: intensity,
        },
        Kind::Spot { .. } => {
            file.warn(import, &thing, "spot lights are not supported: left out");
            return;
        }
    };
    let colour = light.color().map(f64::from);
    let is_light = |value: &f64| value.is_finite() && *value >= 0.0;
    if intensity <= 0.0
        || !intensity.is_finite()
        || !colour.iter().all(is_light)
        || colour == [0.0; 3]
    {
        file.warn(import, &thing, "no light in it: left out");
        return;
    }
    if light.range().is_some() {
        file.warn(
            import,
            &thing,
            "the range of a light is not supported: it has no end",
        );
    }
    import.lights.push(ImportedLight {
        name: thing,
        colour,
        source,
    });
}
