//! Mesh files from outside: what they show, what is told of them, and what is wrong with them.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod bad_gltf;
mod bad_mesh;
mod fuzz;
mod pictures;
mod quad;
mod warnings;

use std::path::Path;

use protocols::{Channel, PerChannel, Quadrature};
use renderer::{RayTree, Sampler as _, Scene, ScreenPoint, linear_srgb_from_ac1c2};

/// The linear colour at a point of a square picture.
fn colour(scene: &Scene, x: f64, y: f64) -> [f64; 3] {
    let sampler = scene.sampler(Quadrature::Bands(301), [100, 100]);
    let mut tree = RayTree::default();
    sampler.intersect(ScreenPoint { x, y }, &mut tree);
    let channels = PerChannel::from_fn(|channel: Channel| f64::from(sampler.shade(&tree, channel)));
    linear_srgb_from_ac1c2(channels)
}

/// The colours at a grid of points: what two scenes that are the same share to the last bit.
fn grid(scene: &Scene) -> Vec<[u64; 3]> {
    let places = (0..16).flat_map(|row| (0..16).map(move |column| (column, row)));
    let at = |part: i32| (f64::from(part) + 0.37) / 16.0;
    places
        .map(|(column, row)| colour(scene, at(column), at(row)).map(f64::to_bits))
        .collect()
}

/// The message of a scene that cannot be read, which is the user's to mend and names the file.
fn error_of(path: &Path) -> String {
    let Err(error) = Scene::read(path) else {
        panic!("{} was taken", path.display());
    };
    assert!(error.is_input(), "{error}");
    let message = error.to_string();
    assert!(message.contains("expected"), "{message}");
    message
}
