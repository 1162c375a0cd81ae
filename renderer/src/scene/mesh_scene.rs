//! A mesh file as a scene of its own: with its camera and lights, or with usual ones.

use std::path::Path;

use protocols::ReadError;

use super::Scene;
use super::camera::Camera;
use super::light::{Ambient, Light, Source};
use super::meshes::add_import;
use super::palette::Palette;
use super::reader::{Parts, assemble};
use super::shapes::Objects;
use super::table::Table;
use crate::geometry::{Bounds, Shape, Vector};
use crate::import::{self, Import, ImportedLight, ImportedSource, Placement};
use crate::matrix3;
use crate::opponent::LINEAR_SRGB_FROM_XYZ;
use crate::spectra::Emission;

/// The field of view of the usual camera.
const USUAL_VIEW_DEG: f64 = 40.0;

/// Reads a mesh file as a scene.
pub(super) fn scene_from_mesh(file: &Path) -> Result<Scene, ReadError> {
    let mut import = import::read(file, &Placement::Y_UP)?;
    let table = Table {
        file,
        kind: "the file",
        number: None,
        name: None,
    };
    let (mut palette, mut objects) = (Palette::default(), Objects::default());
    add_import(table, &mut palette, &mut objects, &mut import, None)?;
    let boxes = objects.shapes.iter().filter_map(Shape::bounds);
    let bounds = boxes.reduce(|all, next| all.joined(&next));
    let (middle, radius_m) = bounds.map_or((Vector::default(), 1.0), |bounds| sphere_over(&bounds));
    let camera = camera(file, &mut import, middle, radius_m);
    let (lights, ambient) = lights(file, &mut import, middle, radius_m);
    let light_names = import
        .lights
        .iter()
        .map(|light| light.name.clone())
        .collect();
    Ok(assemble(Parts {
        camera,
        palette,
        objects,
        lights,
        light_names,
        ambient,
        imports: vec![import],
    }))
}

fn sphere_over(bounds: &Bounds) -> (Vector, f64) {
    let (least, most) = (bounds.low(), bounds.high());
    let radius_m = 0.5 * (most - least).length();
    ((least + most) * 0.5, radius_m.max(1e-6))
}

fn note(file: &Path, import: &mut Import, what: &str) {
    import
        .warnings
        .push(format!("\"{}\": {what}", file.display()));
}

fn camera(file: &Path, import: &mut Import, middle: Vector, radius_m: f64) -> Camera {
    let of_file = import.camera.map(|camera| {
        let [position, forward, up] =
            [camera.position, camera.forward, camera.up].map(Vector::from);
        (
            position,
            forward.normalized(),
            up,
            camera.vertical_field_of_view_deg,
        )
    });
    let is_usable = |(position, forward, up, view_deg): &(Vector, Vector, Vector, f64)| {
        position.length().is_finite()
            && forward.cross(*up).normalized().length().is_finite()
            && (0.01..=170.0).contains(view_deg)
    };
    let usable = of_file.filter(is_usable);
    if usable.is_none() {
        let what = match of_file {
            Some(_) => "its camera cannot be: one that sees all is taken",
            None => "no camera: one that sees all is taken",
        };
        note(file, import, what);
    }
    let (position, forward, up, view_deg) = usable.unwrap_or_else(|| {
        let towards = Vector::new(0.45, -1.0, 0.4).normalized();
        let distance_m = radius_m / libm::sin(0.5 * USUAL_VIEW_DEG.to_radians());
        let position = middle + towards * distance_m;
        (position, -towards, Vector::UP, USUAL_VIEW_DEG)
    });
    Camera::new(position, forward, up, view_deg)
}

/// The lights of the file, scaled together, or one usual light and ambient light.
fn lights(
    file: &Path,
    import: &mut Import,
    middle: Vector,
    radius_m: f64,
) -> (Vec<Light>, Option<Ambient>) {
    let arriving = |light: &ImportedLight| match light.source {
        ImportedSource::Distant { lux, .. } => lux * luminance(light.colour),
        ImportedSource::Point { position, candela } => {
            let distance_m = (Vector::from(position) - middle).length().max(radius_m);
            candela * luminance(light.colour) / (distance_m * distance_m)
        }
    };
    let total: f64 = import.lights.iter().map(arriving).sum();
    let scale = total.recip();
    let made: Vec<Light> = import
        .lights
        .iter()
        .filter_map(|light| made(light, scale))
        .collect();
    if made.len() == import.lights.len() && !made.is_empty() && scale.is_finite() {
        let what = format!(
            "its lights are all multiplied by {scale:.3e}, so that illuminance 1 arrives at its middle"
        );
        note(file, import, &what);
        return (made, None);
    }
    import.lights.clear();
    note(file, import, "no light: daylight from the left is taken");
    let daylight = || Emission::named("D65");
    let towards = Vector::new(-0.6, -0.8, 1.0).normalized();
    let source = Source::Distant {
        towards,
        illuminance: 0.8,
    };
    let light = daylight().map(|emission| Light { emission, source });
    let ambient = daylight().map(|emission| Ambient {
        emission,
        illuminance: 0.25,
    });
    (light.into_iter().collect(), ambient)
}

fn made(light: &ImportedLight, scale: f64) -> Option<Light> {
    let scale = scale * luminance(light.colour);
    let source = match light.source {
        ImportedSource::Distant { towards, lux } => {
            let towards = Vector::from(towards).normalized();
            let illuminance = scale * lux;
            towards.length().is_finite().then_some(Source::Distant {
                towards,
                illuminance,
            })?
        }
        ImportedSource::Point { position, candela } => Source::Point {
            position: position.into(),
            intensity: scale * candela,
        },
    };
    let emission = Emission::of_linear_srgb(light.colour)?;
    Some(Light { emission, source })
}

/// Y of a linear sRGB colour.
fn luminance(rgb: [f64; 3]) -> f64 {
    matrix3::times(&matrix3::inverse(&LINEAR_SRGB_FROM_XYZ), rgb)[1]
}
