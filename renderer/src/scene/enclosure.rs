//! Whether a light, or the camera, is shut up inside an object, so that the picture would be black.

use super::Scene;
use super::light::{AreaSurface, Source};
use super::material::Mirror;
use crate::geometry::{Ray, Shape, Span, Vector};

/// A warning for each light that is inside an object which the camera is not inside of, or the other way.
pub(super) fn warnings(scene: &Scene, labels: &[String], lights: &[String]) -> Vec<String> {
    let eye = scene.camera.position();
    let mut warnings = Vec::new();
    for (index, label) in (0..).zip(labels) {
        let shape = scene.shapes.shape(index);
        let material = usize::from(scene.material_of_shape[index as usize]);
        if matches!(scene.materials[material].mirror, Some(Mirror::Glass { .. })) {
            continue;
        }
        let holds_eye = encloses(shape, eye);
        let mut shut_out = !lights.is_empty();
        for (light, name) in scene.lights.iter().zip(lights) {
            let place = match light.source {
                Source::Point { position, .. } => Some(position),
                Source::Area(area) => Some(middle(&area.surface)),
                Source::Distant { .. } => None,
            };
            let holds_light = place.is_some_and(|place| encloses(shape, place));
            shut_out &= !holds_light;
            if holds_light && !holds_eye {
                warnings.push(format!(
                    "{name} is inside {label}: it lights nothing that is seen"
                ));
            }
        }
        if holds_eye && shut_out {
            warnings.push(format!("the camera is inside {label} and no light is"));
        }
    }
    warnings
}

fn middle(surface: &AreaSurface) -> Vector {
    match *surface {
        AreaSurface::Rectangle {
            corner,
            edge_u,
            edge_v,
        } => corner + (edge_u + edge_v) * 0.5,
        AreaSurface::Sphere { center, .. } => center,
    }
}

/// Whether a closed shape is left along every axis, as can be known from the side that is met first.
fn encloses(shape: &Shape, place: Vector) -> bool {
    let axes = [
        Vector::new(1.0, 0.0, 0.0),
        Vector::new(0.0, 1.0, 0.0),
        Vector::new(0.0, 0.0, 1.0),
    ];
    let leaves = |direction: Vector| {
        let ray = Ray {
            origin: place,
            direction,
        };
        let hit = shape.hit(&ray, Span::up_to(f64::INFINITY));
        hit.is_some_and(|hit| {
            let outwards = shape.normal(ray.at(hit.distance_m), hit.part);
            outwards.dot(direction) > 0.0
        })
    };
    shape.is_closed() && axes.into_iter().all(|axis| leaves(axis) && leaves(-axis))
}
