//! A small stimulus set of our own making, and the study that it belongs to.

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the values are clamped to 0..=255"
)]

use std::fs;
use std::path::{Path, PathBuf};

use image::{ExtendedColorType, ImageEncoder as _, codecs::png::PngEncoder};
use protocols::{Manifest, ManifestFile, ManifestStimulus, Sha256Digest, Stimulus, Study};

/// The paper's study with images of 48 x 40 pixels and short times.
pub(crate) fn small_study(folder: &Path) -> Study {
    let paper = Path::new(env!("CARGO_MANIFEST_DIR")).join("../protocols/meyer-liu-1992.toml");
    let text = fs::read_to_string(paper).unwrap();
    let text = text
        .replace("size_px = [320, 320]", "size_px = [48, 40]")
        .replace("exposure_s = 10.0", "exposure_s = 0.2")
        .replace("pause_s = 0.5", "pause_s = 0.1");
    let path = folder.join("small.toml");
    fs::write(&path, text).unwrap();
    Study::read(&path).unwrap()
}

/// Writes the images of `study` and their manifest; the fewer rays, the more the checks are disturbed.
pub(crate) fn write_stimuli(study: &Study, folder: &Path) -> PathBuf {
    let stimuli = folder.join("stimuli");
    fs::create_dir_all(&stimuli).unwrap();
    let plan = study.protocol.stimuli.rendered().unwrap().clone();
    let stimuli_of_plan = plan.stimuli();
    let entries = stimuli_of_plan.iter().map(|stimulus| {
        let png = png(stimulus, plan.size_px);
        let file = |ending: &str, bytes: &[u8]| {
            let name = format!("{}.{ending}", stimulus.id);
            fs::write(stimuli.join(&name), bytes).unwrap();
            ManifestFile {
                name,
                sha256: Sha256Digest::of(bytes),
            }
        };
        let factors = stimulus.factors();
        ManifestStimulus {
            id: stimulus.id.clone(),
            varied: factors["channel"].clone(),
            rays_a: stimulus.rays_a,
            rays_c1c2: stimulus.rays_c1c2,
            factors,
            exr: file("exr", stimulus.id.as_str().as_bytes()),
            png: file("png", &png),
            out_of_gamut_px: 0,
            exports: std::collections::BTreeMap::new(),
        }
    });
    let manifest = Manifest {
        set: plan.set.clone(),
        acuity_version: "0.0.0".to_owned(),
        protocol_sha256: study.sha256.clone(),
        scene_sha256: Sha256Digest::of(b"no scene"),
        stimuli: entries.collect(),
        plan: plan.clone(),
        color_space: "checks".to_owned(),
        remarks: Vec::new(),
        viewing: study.protocol.viewing.into(),
        acuity: study.protocol.acuity,
    };
    let text = serde_json::to_string_pretty(&manifest).unwrap();
    fs::write(stimuli.join(Manifest::FILE_NAME), text).unwrap();
    stimuli
}

/// Checks of 8 pixels; lightness is disturbed by a wave that falls with the rays of A, hue with those of
/// C1 and C2.
fn png(stimulus: &Stimulus, [width, height]: [u32; 2]) -> Vec<u8> {
    let disturbance = |rays: u32| 40.0 * (1.0 - f64::from(rays) / 140_000.0);
    let lightness = disturbance(stimulus.rays_a.get());
    let hue = disturbance(stimulus.rays_c1c2.get()) / 2.0;
    let mut rgb = Vec::new();
    for y in 0..height {
        for x in 0..width {
            let base = if (x / 8 + y / 8) % 2 == 0 {
                90.0
            } else {
                160.0
            };
            let wave = (f64::from(x) * 1.3 + f64::from(y) * 0.7).sin();
            for sign in [1.0, 0.0, -1.0] {
                let value = base + wave * (lightness + sign * hue);
                rgb.push(value.round().clamp(0.0, 255.0) as u8);
            }
        }
    }
    let mut bytes = Vec::new();
    let encoder = PngEncoder::new(&mut bytes);
    encoder
        .write_image(&rgb, width, height, ExtendedColorType::Rgb8)
        .unwrap();
    bytes
}
