//! The files for other programs, read back by a decoder that knows nothing of us.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use exr::prelude::{
    AnyChannels, FlatSamples, ReadChannels as _, ReadLayers as _, read_first_flat_layer_from_file,
};
use protocols::{Export, Manifest, PerChannel, Study};
use renderer::{
    ImageRequest, Watch, read_opponent_exr, render_image, render_image_of, render_set,
    xyz_from_ac1c2,
};

use crate::analytic::disc_and_checks;
use crate::small_study::{no_scene, request, small_study};

fn floats(path: &Path) -> BTreeMap<String, Vec<f32>> {
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_file(path)
        .unwrap();
    let AnyChannels { list } = image.layer_data.channel_data;
    let channels = list.into_iter().map(|channel| {
        let FlatSamples::F32(values) = channel.sample_data else {
            panic!("{} is not of 32-bit floats", channel.name);
        };
        (channel.name.to_string(), values)
    });
    channels.collect()
}

fn texts(path: &Path) -> BTreeMap<String, String> {
    let image = read_first_flat_layer_from_file(path).unwrap();
    let attributes = image.layer_data.attributes.other.into_iter();
    let texts = attributes.filter_map(|(name, value)| {
        let text = value.into_text().ok()?;
        Some((name.to_string(), text.to_string()))
    });
    texts.collect()
}

fn with_exports(study: &Study) -> ImageRequest {
    ImageRequest {
        exports: Export::ALL.to_vec(),
        ..request(study, 2000, 2000)
    }
}

#[test]
fn the_files_of_an_image_agree_with_it() {
    let study = small_study();
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("x.exr");
    let scene = study.scene_path().unwrap();
    let summary = render_image(&scene, &with_exports(&study), &out, &Watch::UNWATCHED).unwrap();
    let names = ["x.xyz.exr", "x.spectral.exr", "x.16.png"].map(|name| folder.path().join(name));
    assert_eq!(summary.exports, names);

    let opponent = read_opponent_exr(&fs::read(&out).unwrap(), &out).unwrap();
    let xyz = floats(&names[0]);
    assert_eq!(xyz.keys().collect::<Vec<_>>(), ["X", "Y", "Z"]);
    let spectral = floats(&names[1]);
    let bands: Vec<&String> = spectral
        .keys()
        .filter(|name| name.starts_with("S0."))
        .collect();
    // 16 bands of 18.75 nm from 400 nm on, the first in the middle of its own.
    assert_eq!((bands.len(), bands[0].as_str()), (16, "S0.409,375nm"));
    assert_eq!(bands[15], "S0.690,625nm");
    let said = texts(&names[1]);
    assert_eq!(said["spectralLayoutVersion"], "1.0");
    assert_eq!(said["emissiveUnits"], "W.m^-2.sr^-1.nm^-1");
    let in_xyz = |pixel: usize| {
        let value = |channel| f64::from(opponent[channel].values()[pixel]);
        xyz_from_ac1c2(PerChannel::from_fn(value))
    };
    for (axis, name) in ["X", "Y", "Z"].into_iter().enumerate() {
        let expected: Vec<f32> = (0..40 * 30)
            .map(|pixel| in_xyz(pixel)[axis] as f32)
            .collect();
        assert!(xyz[name] == expected, "{name}");
    }

    let png = folder.path().join("x.png");
    render_image(
        &scene,
        &request(&study, 2000, 2000),
        &png,
        &Watch::UNWATCHED,
    )
    .unwrap();
    let coarse = image::open(&png).unwrap().into_rgb8().into_raw();
    let fine = image::open(&names[2]).unwrap();
    assert_eq!(fine.color(), image::ColorType::Rgb16);
    for (fine, coarse) in fine.into_rgb16().into_raw().into_iter().zip(coarse) {
        // 257 steps of 16 bits for each of 8; both are rounded to the nearest, so by half a step of each.
        let difference = f64::from(fine) - 257.0 * f64::from(coarse);
        assert!(difference.abs() <= 0.5 * 257.0 + 0.5, "{fine} and {coarse}");
    }
}

#[test]
fn the_manifest_of_a_set_lists_the_exports_and_they_are_the_same_on_any_number_of_threads() {
    let mut study = small_study();
    study.protocol.stimuli.rendered_mut().unwrap().export = Export::ALL.to_vec();
    let sets = [1, 3].map(|threads| {
        let folder = tempfile::tempdir().unwrap();
        let threads = std::num::NonZeroUsize::new(threads);
        render_set(&study, folder.path(), threads, &Watch::UNWATCHED).unwrap();
        folder
    });
    let manifests = sets
        .each_ref()
        .map(|set| Manifest::read(set.path()).unwrap());
    assert_eq!(manifests[0], manifests[1]);
    for stimulus in &manifests[0].stimuli {
        assert_eq!(stimulus.files().count(), 5);
        for file in stimulus.files() {
            file.read_verified(sets[0].path()).unwrap();
        }
    }
}

#[test]
fn a_picture_without_a_spectrum_has_no_spectral_export() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("x.exr");
    let request = with_exports(&small_study());
    let made = render_image_of(
        &disc_and_checks(),
        no_scene(),
        &request,
        &out,
        &Watch::UNWATCHED,
    );
    let error = made.unwrap_err();
    assert!(error.is_input());
    assert!(error.to_string().contains("without a spectrum"), "{error}");
}
