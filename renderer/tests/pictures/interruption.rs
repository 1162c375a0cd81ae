//! Work that is ended early goes on to the same bytes, and takes no sample twice.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use protocols::{Manifest, Sha256Digest, Study};
use renderer::{RendererError, SetSummary, Stage, Step, Watch, render_image_of, render_set_of};

use crate::analytic::disc_and_checks;
use crate::small_study::{image_alone, no_scene, render, request, small_study};

/// Renders a set until `is_enough` of a step.
fn render_until(
    study: &Study,
    out: &Path,
    is_enough: impl Fn(Step) -> bool + Sync,
) -> Result<SetSummary, RendererError> {
    let is_cancelled = AtomicBool::new(false);
    let hear = |step: Step| {
        if is_enough(step) {
            is_cancelled.store(true, Ordering::Relaxed);
        }
    };
    let watch = Watch::new(&hear, &is_cancelled);
    render_set_of(&disc_and_checks(), &no_scene(), study, out, &watch)
}

fn at_rays(rays: u64) -> impl Fn(Step) -> bool + Sync {
    move |step| step.stage == Stage::Rays && step.done >= rays
}

fn files(folder: &Path) -> BTreeMap<PathBuf, Sha256Digest> {
    let paths = fs::read_dir(folder)
        .unwrap()
        .map(|file| file.unwrap().path());
    paths
        .map(|path| {
            let name = path.file_name().unwrap().into();
            (name, Sha256Digest::of_file(&path).unwrap())
        })
        .collect()
}

#[test]
fn a_set_goes_on_to_the_same_bytes_wherever_it_was_ended() {
    let study = small_study();
    let whole = tempfile::tempdir().unwrap();
    render(&study, whole.path(), 2);
    // In the first cells, at the minimum depth, at a batch's end and between, where C1C2 stop, and last.
    for rays in [1, 2, 255, 256, 1000, 1234, 3999, 4000] {
        let folder = tempfile::tempdir().unwrap();
        let error = render_until(&study, folder.path(), at_rays(rays)).unwrap_err();
        assert!(error.is_interruption() && !error.is_input(), "{error}");
        assert!(error.to_string().contains("of 4000 rays"), "{error}");
        assert!(Manifest::read(folder.path()).is_err());
        let summary = render(&study, folder.path(), 2);
        assert_eq!(summary.account.intersections, 4000);
        assert_eq!(files(folder.path()), files(whole.path()), "{rays} rays");
    }
}

#[test]
fn a_set_that_is_ended_again_and_again_or_while_it_is_written_is_the_same() {
    let study = small_study();
    let [whole, folder] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    render(&study, whole.path(), 1);
    for rays in [500, 700, 2500] {
        render_until(&study, folder.path(), at_rays(rays)).unwrap_err();
    }
    let while_written = |step: Step| step.stage == Stage::Images && step.done >= 3;
    let error = render_until(&study, folder.path(), while_written).unwrap_err();
    assert!(error.is_interruption(), "{error}");
    assert!(!folder.path().join(Manifest::FILE_NAME).exists());
    render(&study, folder.path(), 1);
    assert_eq!(files(folder.path()), files(whole.path()));
}

#[test]
fn an_image_goes_on_without_tracing_what_was_traced() {
    let request = request(&small_study(), 4000, 1000);
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("x.exr");
    let is_cancelled = AtomicBool::new(false);
    let hear = |step: Step| is_cancelled.store(step.done >= 2500, Ordering::Relaxed);
    let watch = Watch::new(&hear, &is_cancelled);
    let first = disc_and_checks();
    render_image_of(&first, no_scene(), &request, &out, &watch).unwrap_err();
    assert_eq!(files(folder.path()).len(), 1, "more than the checkpoint");

    let second = disc_and_checks();
    render_image_of(&second, no_scene(), &request, &out, &Watch::UNWATCHED).unwrap();
    let calls: Vec<u64> = (first.calls().iter().zip(second.calls()))
        .map(|(one, two)| one + two)
        .collect();
    assert_eq!(calls, [4000, 4000, 1000, 1000]);
    assert!(first.calls()[0] < 2700);
    assert!(fs::read(&out).unwrap() == image_alone(&request, "x.exr"));
    assert_eq!(files(folder.path()).len(), 1, "more than the image");
}

#[test]
fn a_set_that_stands_is_a_set_until_its_files_are_replaced() {
    let study = small_study();
    let folder = tempfile::tempdir().unwrap();
    render(&study, folder.path(), 1);
    render_until(&study, folder.path(), at_rays(700)).unwrap_err();
    assert!(Manifest::read(folder.path()).is_ok());
}

/// Ends the rendering of a set and gives the folder and the checkpoint in it.
fn ended() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let error = render_until(&small_study(), folder.path(), at_rays(700)).unwrap_err();
    let RendererError::Interrupted { checkpoint, .. } = error else {
        panic!("{error}");
    };
    assert!(checkpoint.is_file());
    (folder, checkpoint)
}

fn refusal(study: &Study, folder: &Path) -> String {
    let error = render_until(study, folder, |_| false).unwrap_err();
    assert!(error.is_input(), "{error}");
    let text = error.to_string();
    assert!(text.contains(".checkpoint"), "{text}");
    assert!(text.contains("remove it to begin anew"), "{text}");
    text
}

#[test]
fn a_checkpoint_of_another_plan_is_refused() {
    let (folder, _) = ended();
    let mut other = small_study();
    other.protocol.stimuli.rendered_mut().unwrap().seed += 1;
    assert!(refusal(&other, folder.path()).contains("another scene, plan"));
    let mut other = small_study();
    other.protocol.stimuli.rendered_mut().unwrap().size_px = [41, 30];
    assert!(refusal(&other, folder.path()).contains("another scene, plan"));
    render(&small_study(), folder.path(), 1);
}

#[test]
fn a_damaged_checkpoint_is_refused_wherever_it_is_damaged() {
    let (folder, path) = ended();
    let bytes = fs::read(&path).unwrap();
    let study = small_study();
    for end in [0, 1, 50, 200, 300, 1000, bytes.len() - 12, bytes.len() - 1] {
        fs::write(&path, &bytes[..end]).unwrap();
        refusal(&study, folder.path());
    }
    for place in (0..bytes.len()).step_by(61).chain([bytes.len() - 1]) {
        let mut changed = bytes.clone();
        changed[place] ^= 0x11;
        fs::write(&path, changed).unwrap();
        refusal(&study, folder.path());
    }
    fs::write(&path, [&bytes[..], &[0; 12]].concat()).unwrap();
    assert!(refusal(&study, folder.path()).contains("bytes of values"));
    assert!(!folder.path().join(Manifest::FILE_NAME).exists());
}
