//! Scenes from outside: closed forms, bad input, and the study's own picture.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod bad_input;
mod closed_forms;
mod random_input;
mod study_picture;

use std::path::Path;

use protocols::{Channel, Quadrature};
use renderer::{RayTree, Sampler as _, Scene, SceneSampler, ScreenPoint};

/// The channels of D65 itself for Y = 1: `color_reference.py` (numpy), `D65_spectral_ACC`.
const D65: [f64; 3] = [
    1.000_125_114_944_255_4,
    -0.029_368_524_960_972_5,
    0.553_620_892_428_914_4,
];

fn scene(text: &str) -> Scene {
    Scene::from_toml(Path::new("test.toml"), text).unwrap()
}

/// The value of a channel at a point of a square picture.
fn value(sampler: &SceneSampler<'_>, x: f64, y: f64, channel: Channel) -> f64 {
    let mut tree = RayTree::default();
    sampler.intersect(ScreenPoint { x, y }, &mut tree);
    f64::from(sampler.shade(&tree, channel))
}

fn sampler(scene: &Scene) -> SceneSampler<'_> {
    scene.sampler(Quadrature::Bands(16), [100, 100])
}
