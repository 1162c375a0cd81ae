//! From the study's scene file to a set and its figures.

use std::fs;
use std::num::NonZeroUsize;
use std::path::Path;

use protocols::{Manifest, RayCount, Study};
use renderer::{ImageRequest, RendererError, Watch, draw_figures, render_image, render_set};

use crate::small_study::{request, small_study};

fn render(study: &Study, out: &Path, threads: usize) {
    render_set(study, out, NonZeroUsize::new(threads), &Watch::UNWATCHED).unwrap();
}

fn manifest_text(folder: &Path) -> String {
    fs::read_to_string(folder.join(Manifest::FILE_NAME)).unwrap()
}

#[test]
fn one_and_two_threads_make_the_same_set_and_an_image_alone_is_that_of_the_set() {
    let study = small_study();
    let folders = [1, 2].map(|threads| {
        let folder = tempfile::tempdir().unwrap();
        render(&study, folder.path(), threads);
        folder
    });
    // The manifest holds the digest of every file.
    assert_eq!(
        manifest_text(folders[0].path()),
        manifest_text(folders[1].path())
    );
    let alone = folders[0].path().join("alone.exr");
    let request = ImageRequest {
        threads: NonZeroUsize::new(2),
        ..request(&study, 3210, 4000)
    };
    let summary = render_image(
        &study.scene_path().unwrap(),
        &request,
        &alone,
        &Watch::UNWATCHED,
    )
    .unwrap();
    assert!(
        fs::read(&alone).unwrap() == fs::read(folders[0].path().join("a3210_c004k.exr")).unwrap()
    );
    assert_eq!(summary.account.intersections, 4000);
}

#[test]
fn a_scene_or_a_request_that_cannot_be_is_refused_before_anything_is_written() {
    let study = small_study();
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("x.exr");
    let refused = |scene: &Path, request: &ImageRequest, what: &str| {
        let error: RendererError =
            render_image(scene, request, &out, &Watch::UNWATCHED).unwrap_err();
        assert!(
            error.is_input() && error.to_string().contains(what),
            "{error}"
        );
    };
    let whole = request(&study, 1000, 1000);
    refused(Path::new("no-such-scene.toml"), &whole, "no such file");
    let few = ImageRequest {
        rays_a: RayCount::new(10).unwrap(),
        ..whole.clone()
    };
    refused(&study.scene_path().unwrap(), &few, "256 cells");
    let text = fs::read_to_string(study.scene_path().unwrap()).unwrap();
    let truncated = folder.path().join("truncated.toml");
    fs::write(&truncated, &text[..text.len() / 2 + 3]).unwrap();
    refused(&truncated, &whole, "truncated.toml");
    fs::remove_file(&truncated).unwrap();
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);

    let mut astray = study;
    astray.protocol.stimuli.rendered_mut().unwrap().scene = "no-such-scene.toml".to_owned();
    let set = folder.path().join("set");
    let error = render_set(&astray, &set, None, &Watch::UNWATCHED).unwrap_err();
    assert!(error.is_input() && !set.exists(), "{error}");
}

#[test]
fn the_figures_are_drawn_from_a_set_and_only_from_a_whole_one() {
    let study = small_study();
    let folder = tempfile::tempdir().unwrap();
    let figures = folder.path().join("figures");
    let set = folder.path().join("set");
    let error = draw_figures(&study, &set, &figures).unwrap_err();
    assert!(
        error.is_input() && error.to_string().contains("manifest.json"),
        "{error}"
    );

    render(&study, &set, 2);
    let files = draw_figures(&study, &set, &figures).unwrap();
    let names = files
        .iter()
        .map(|path| path.file_name().unwrap().to_str().unwrap());
    let expected = [
        "figure-3.svg",
        "figure-3.png",
        "figure-4.svg",
        "figure-4.png",
        "figure-6.png",
        "figure-7.png",
        "figure-8.png",
        "figure-9.png",
    ];
    assert_eq!(names.collect::<Vec<_>>(), expected);
    let again = folder.path().join("again");
    for (one, two) in files
        .iter()
        .zip(draw_figures(&study, &set, &again).unwrap())
    {
        assert!(
            fs::read(one).unwrap() == fs::read(two).unwrap(),
            "{}",
            one.display()
        );
    }
}

#[test]
fn a_set_that_is_not_the_studys_or_was_changed_gives_no_figures() {
    let study = small_study();
    let folder = tempfile::tempdir().unwrap();
    let figures = folder.path().join("figures");
    let set = folder.path().join("set");
    render(&study, &set, 2);
    let mut other = study.clone();
    other.protocol.stimuli.rendered_mut().unwrap().seed += 1;
    let error = draw_figures(&other, &set, &figures)
        .unwrap_err()
        .to_string();
    assert!(error.contains("another plan"), "{error}");

    let image = set.join("a001k_c004k.png");
    let bytes = fs::read(&image).unwrap();
    fs::write(&image, &bytes[..bytes.len() / 2]).unwrap();
    let error = draw_figures(&study, &set, &figures).unwrap_err();
    assert!(
        error.is_input() && error.to_string().contains("a001k_c004k.png"),
        "{error}"
    );

    fs::remove_file(&image).unwrap();
    let error = draw_figures(&study, &set, &figures).unwrap_err();
    assert!(
        error.is_input() && error.to_string().contains("no such file"),
        "{error}"
    );

    let manifest = set.join(Manifest::FILE_NAME);
    let text = fs::read_to_string(&manifest).unwrap();
    for broken in [
        &text[..text.len() / 2],
        "{}",
        &text.replace("\"seed\"", "\"sead\""),
    ] {
        fs::write(&manifest, broken).unwrap();
        let error = draw_figures(&study, &set, &figures).unwrap_err();
        assert!(
            error.is_input() && error.to_string().contains("manifest.json"),
            "{error}"
        );
    }
}
