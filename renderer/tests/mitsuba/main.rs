//! Pictures judged by Mitsuba 3, a renderer that we did not write.
//!
//! `expected/*.exr` are Mitsuba's pictures of `scenes/*.toml` with the standard error of each pixel, made by
//! `expected.py`; no Python is needed here. The XYZ of both, filtered by the same tent, must not differ by
//! more than chance allows, neither in a pixel nor in the mean of a block of pixels. Each test also shows
//! that a picture with one light less or a reflectance 1% off is not taken for the same.
//!
//! `live.py` compares with a running Mitsuba instead, through the whole program.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod judge;
mod picture;

use std::path::{Path, PathBuf};

use judge::Verdict;
use picture::Picture;
use protocols::{Quadrature, Sha256Digest};
use renderer::Scene;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/mitsuba")
}

/// A scene and what Mitsuba makes of it.
struct Case {
    text: String,
    expected: Picture,
}

impl Case {
    fn read(name: &str) -> Self {
        let own = folder().join(format!("scenes/{name}.toml"));
        let of_project = folder().join(format!("../../../stimuli/scenes/{name}.toml"));
        let file = if own.exists() { own } else { of_project };
        let text = std::fs::read_to_string(&file).unwrap();
        let (expected, comments) = Picture::read(&folder().join(format!("expected/{name}.exr")));
        let digest = Sha256Digest::of(text.as_bytes()).to_string();
        assert!(
            comments.contains(&digest),
            "{} changed since its picture was made: run expected.py {name}",
            file.display()
        );
        Self { text, expected }
    }

    /// Our picture of the scene after `change` of its text.
    fn verdict(&self, change: impl Fn(&str) -> String) -> Verdict {
        let path = folder().join("scenes");
        let scene = Scene::from_toml(&path.join("changed.toml"), &change(&self.text)).unwrap();
        let sampler = scene.sampler(Quadrature::Bands(61), self.expected.size_px);
        judge::verdict(
            &Picture::of(&sampler, self.expected.size_px),
            &self.expected,
        )
    }

    fn assert_same(&self) {
        let verdict = self.verdict(str::to_owned);
        assert!(verdict.is_same(), "{verdict}");
    }

    /// That the scene with `found` replaced by `instead` is told apart.
    fn assert_differs(&self, found: &str, instead: &str) {
        assert!(self.text.contains(found), "no {found} in the scene");
        let verdict = self.verdict(|text| text.replacen(found, instead, 1));
        assert!(!verdict.is_same(), "{instead} is not told apart: {verdict}");
    }
}

#[test]
fn direct_light_from_all_lights() {
    let case = Case::read("lights");
    case.assert_same();
    let fourth = "    { position_m = [0.5, -2.5, 3], emittance = [[380, 0.1], [500, 0.2], [540, 1], [580, 0.3], [780, 0]], intensity = 1.5 },\n";
    case.assert_differs(fourth, "");
    case.assert_differs("illuminance = 0.3", "illuminance = 0.297");
    case.assert_differs("9000 K", "8500 K");
}

#[test]
fn hard_shadows() {
    let case = Case::read("shadows");
    case.assert_same();
    case.assert_differs("[[400, 0.8], [700, 0.8]]", "[[400, 0.792], [700, 0.792]]");
    case.assert_differs("radius_m = 0.025", "radius_m = 0.001");
    case.assert_differs(
        "position_m = [-2.2, -1.4, 3.4]",
        "position_m = [-2.19, -1.4, 3.4]",
    );
}

#[test]
fn checkers_and_stripes() {
    let case = Case::read("patterns");
    case.assert_same();
    case.assert_differs("size_m = 0.19", "size_m = 0.195");
    case.assert_differs("colorchecker neutral 8", "colorchecker white 9.5");
}

#[test]
fn a_mirror_of_a_coloured_metal() {
    let case = Case::read("mirror");
    case.assert_same();
    case.assert_differs(
        "[560, 0.6], [600, 0.9], [700, 0.97]",
        "[560, 0.594], [600, 0.891], [700, 0.96]",
    );
    case.assert_differs("radius_m = 0.9", "radius_m = 0.89");
}

#[test]
fn meshes_smooth_and_flat() {
    let case = Case::read("meshes");
    case.assert_same();
    case.assert_differs("scale = 0.7", "scale = 0.69");
    case.assert_differs("rotation_deg = 25", "rotation_deg = 30");
}

/// Mitsuba by `whitted.py`, as are the next two.
#[test]
fn coats_highlights_and_ambient_light() {
    let case = Case::read("enamel");
    case.assert_same();
    case.assert_differs("refractive_index = 1.5", "refractive_index = 1.4");
    case.assert_differs("exponent = 30", "exponent = 33");
    case.assert_differs("illuminance = 0.15", "illuminance = 0.148");
}

#[test]
fn glass_and_what_is_seen_through_it() {
    let case = Case::read("glass");
    case.assert_same();
    case.assert_differs("refractive_index = 1.5", "refractive_index = 1.47");
    case.assert_differs("refractive_index = 1.7", "refractive_index = 1.6");
}

#[test]
fn soft_shadows_of_lights_that_are_seen() {
    let case = Case::read("areas");
    case.assert_same();
    case.assert_differs("luminance = 3", "luminance = 2.95");
    case.assert_differs("radius_m = 0.12", "radius_m = 0.14");
}

#[test]
fn the_picture_of_the_study() {
    let case = Case::read("opponent-solids");
    case.assert_same();
    case.assert_differs("intensity = 109.0", "intensity = 100.0");
    let fill = "    { name = \"fill\", position_m = [4.2, -5.6, 2.6], emittance = \"blackbody 5000 K\", intensity = 2.0 },\n";
    case.assert_differs(fill, "");
}
