//! The stimulus set: complete, true to its manifest, the same on any number of threads.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use protocols::{Channel, Manifest, PerChannel, RefinementDriver, Sha256Digest};
use renderer::{RayAccount, SrgbEncoder, read_opponent_exr};

use crate::small_study::{image_alone, render, request, small_study};

fn digests(folder: &Path) -> BTreeMap<String, Sha256Digest> {
    let files = fs::read_dir(folder).unwrap().map(|file| file.unwrap());
    files
        .map(|file| {
            let name = file.file_name().into_string().unwrap();
            (name, Sha256Digest::of_file(&file.path()).unwrap())
        })
        .collect()
}

#[test]
fn one_two_and_five_threads_make_the_same_files() {
    let study = small_study();
    let folders = [1, 2, 5].map(|threads| {
        let folder = tempfile::tempdir().unwrap();
        render(&study, folder.path(), threads);
        folder
    });
    let alone = digests(folders[0].path());
    // 4 + 4 - 1 images of the two sequences and the zero anchor, EXR and PNG, and the manifest.
    assert_eq!(alone.len(), 2 * 8 + 1);
    for folder in &folders[1..] {
        assert_eq!(digests(folder.path()), alone);
    }
}

#[test]
fn an_image_made_alone_is_byte_for_byte_that_of_the_set() {
    let study = small_study();
    let folder = tempfile::tempdir().unwrap();
    render(&study, folder.path(), 2);
    let manifest = Manifest::read(folder.path()).unwrap();
    manifest.check_made_for(&study, folder.path()).unwrap();
    for stimulus in &manifest.stimuli {
        let request = request(&study, stimulus.rays_a.get(), stimulus.rays_c1c2.get());
        for file in [&stimulus.exr, &stimulus.png] {
            let in_set = file.read_verified(folder.path()).unwrap();
            assert!(image_alone(&request, &file.name) == in_set, "{}", file.name);
        }
    }
}

#[test]
fn the_ten_anchor_and_the_sequences_recombine_the_same_channel_images() {
    let study = small_study();
    let folder = tempfile::tempdir().unwrap();
    render(&study, folder.path(), 2);
    let read = |name: &str| {
        let path = folder.path().join(name);
        read_opponent_exr(&fs::read(&path).unwrap(), &path).unwrap()
    };
    let ten = read("a004k_c004k.exr");
    let achromatic = read("a001k_c004k.exr");
    let chromatic = read("a004k_c001k.exr");
    let zero = read("a001k_c001k.exr");
    assert_eq!((&achromatic.c1, &achromatic.c2), (&ten.c1, &ten.c2));
    assert_eq!(chromatic.a, ten.a);
    assert_eq!(
        (&zero.a, &zero.c1, &zero.c2),
        (&achromatic.a, &chromatic.c1, &chromatic.c2)
    );
    assert_ne!(zero.a, ten.a);
}

#[test]
fn the_png_is_the_exr_in_srgb() {
    let study = small_study();
    let folder = tempfile::tempdir().unwrap();
    render(&study, folder.path(), 2);
    for stimulus in &Manifest::read(folder.path()).unwrap().stimuli {
        let exr = stimulus.exr.read_verified(folder.path()).unwrap();
        let PerChannel { a, c1, c2 } = read_opponent_exr(&exr, folder.path()).unwrap();
        let expected = SrgbEncoder::new().encode(PerChannel {
            a: &a,
            c1: &c1,
            c2: &c2,
        });
        let png = stimulus.png.read_verified(folder.path()).unwrap();
        let picture = image::load_from_memory(&png).unwrap().into_rgb8();
        assert_eq!(picture.dimensions(), (40, 30));
        assert!(picture.into_raw() == expected.bytes);
        assert_eq!(stimulus.out_of_gamut_px, expected.out_of_gamut_px);
    }
}

#[test]
fn the_summary_counts_one_trace_against_images_made_alone() {
    let study = small_study();
    let folder = tempfile::tempdir().unwrap();
    let summary = render(&study, folder.path(), 2);
    assert_eq!(summary.account, RayAccount::full(4000));
    // Every image but the zero anchor has one channel group at 4000 rays: 7 × 4000 + 1000.
    assert_eq!(summary.full(), RayAccount::full(29_000));
    // A says where to go, so it is shaded for every ray. C1 and C2: the zero anchor and the chromatic
    // sequence have 1000 + 1000 + 2000 + 3210, the four images of the achromatic one 4000 each.
    let alone = summary.alone();
    assert_eq!(
        alone.shadings,
        PerChannel {
            a: 29_000,
            c1: 23_210,
            c2: 23_210
        }
    );
    assert!(summary.to_string().contains("a004k_c3210"));
}

#[test]
fn channels_that_drive_together_are_remarked_in_the_manifest() {
    let mut study = small_study();
    let folder = tempfile::tempdir().unwrap();
    render(&study, folder.path(), 2);
    assert!(Manifest::read(folder.path()).unwrap().remarks.is_empty());
    study.protocol.stimuli.rendered_mut().unwrap().tree.driver = RefinementDriver::All;
    let summary = render(&study, folder.path(), 2);
    let manifest = Manifest::read(folder.path()).unwrap();
    assert_eq!(manifest.remarks, summary.remarks);
    assert!(manifest.remarks[0].contains("changes the tree"));
}

#[test]
fn a_study_that_needs_little_chroma_shades_little() {
    let mut study = small_study();
    let plan = study.protocol.stimuli.rendered_mut().unwrap();
    plan.sequences.truncate(1);
    plan.sequences[0].held_rays = plan.anchors.zero_rays;
    plan.anchors.ten_rays = plan.anchors.zero_rays;
    let folder = tempfile::tempdir().unwrap();
    let summary = render(&study, folder.path(), 2);
    assert_eq!(
        summary.account.shadings,
        PerChannel {
            a: 4000,
            c1: 1000,
            c2: 1000
        }
    );
}

#[test]
fn a_set_that_cannot_be_written_leaves_no_manifest() {
    let study = small_study();
    let folder = tempfile::tempdir().unwrap();
    render(&study, folder.path(), 2);
    // A folder where an image should go.
    fs::remove_file(folder.path().join("a001k_c001k.exr")).unwrap();
    fs::create_dir(folder.path().join("a001k_c001k.exr")).unwrap();
    let failed = renderer::render_set_of(
        &crate::analytic::disc_and_checks(),
        &crate::small_study::no_scene(),
        &study,
        folder.path(),
        &renderer::Watch::UNWATCHED,
    );
    let error = failed.unwrap_err();
    assert!(error.to_string().contains("a001k_c001k.exr"), "{error}");
    assert!(!error.is_input());
    assert!(!folder.path().join(Manifest::FILE_NAME).exists());
}

#[test]
fn a_changed_file_is_not_read() {
    let study = small_study();
    let folder = tempfile::tempdir().unwrap();
    render(&study, folder.path(), 2);
    let manifest = Manifest::read(folder.path()).unwrap();
    let file = &manifest.stimuli[0].exr;
    let path = folder.path().join(&file.name);
    let mut bytes = fs::read(&path).unwrap();
    *bytes.last_mut().unwrap() ^= 1;
    fs::write(&path, bytes).unwrap();
    let error = file.read_verified(folder.path()).unwrap_err().to_string();
    assert!(
        error.contains("SHA-256") && error.contains(&file.name),
        "{error}"
    );
}

#[test]
fn every_channel_of_an_exr_is_its_own() {
    let study = small_study();
    let bytes = image_alone(&request(&study, 1000, 1000), "x.exr");
    let channels = read_opponent_exr(&bytes, Path::new("x.exr")).unwrap();
    for channel in Channel::ALL {
        let others = Channel::ALL.iter().filter(|&&other| other != channel);
        assert!(
            others
                .clone()
                .all(|&other| channels[channel] != channels[other])
        );
        assert_eq!(channels[channel].size_px(), [40, 30]);
    }
}
