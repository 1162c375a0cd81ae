//! From a scene file to pictures: the work of `acuity render` and `acuity image`.

use std::num::NonZeroUsize;
use std::path::Path;

use protocols::{Sha256Digest, Study};

use crate::error::RendererError;
use crate::image_request::ImageRequest;
use crate::render_image::{Format, ImageSummary, render_image_of};
use crate::scene::Scene;
use crate::set_summary::SetSummary;
use crate::stimulus_set::render_set_of;
use crate::threads::on_threads;
use crate::watch::Watch;

/// Renders the stimulus set of a study into the folder `out`.
///
/// `threads`: one for each core if not said; the files are the same with any number. `watch` is told how
/// much is done, and may end the work: a checkpoint in `out` then holds what was traced.
///
/// # Errors
///
/// [`RendererError::Input`] if the scene is wrong; other variants if a file could not be made. There is
/// then no manifest.
pub fn render_set(
    study: &Study,
    out: &Path,
    threads: Option<NonZeroUsize>,
    watch: &Watch<'_>,
) -> Result<SetSummary, RendererError> {
    let (scene, scene_sha256) = Scene::read_with_digest(&study.scene_path()?)?;
    let plan = study.render_plan()?;
    let most = plan.most_rays();
    ImageRequest::of_study(study.rendering()?, most, most).check(&study.path)?;
    let summary = on_threads(threads, out, || {
        let sampler = scene.sampler(plan.quadrature, plan.size_px);
        render_set_of(&sampler, &scene_sha256, study, out, watch)
    })?;
    let warnings = scene.warnings().to_vec();
    Ok(SetSummary {
        warnings,
        ..summary
    })
}

/// Renders one image of a scene to `out`: EXR or PNG, by its ending.
///
/// The bytes are those of the same image in a stimulus set. `watch` may end the work: a checkpoint beside
/// `out` then holds what was traced.
///
/// # Errors
///
/// [`RendererError::Input`] if the scene or the request is wrong, or the ending is unknown; other variants
/// if the file could not be made.
pub fn render_image(
    scene: &Path,
    request: &ImageRequest,
    out: &Path,
    watch: &Watch<'_>,
) -> Result<ImageSummary, RendererError> {
    Format::of(out)?;
    request.check(scene)?;
    let (scene, scene_sha256) = Scene::read_with_digest(scene)?;
    let summary = on_threads(request.threads, out, || {
        let sampler = scene.sampler(request.quadrature, request.size_px);
        render_image_of(&sampler, scene_sha256, request, out, watch)
    })?;
    let warnings = scene.warnings().to_vec();
    Ok(ImageSummary {
        warnings,
        ..summary
    })
}

/// The digest of a scene: of its file together with those that it names, as it stands in a manifest.
///
/// # Errors
///
/// [`RendererError::Input`] if the scene is missing or wrong.
pub fn scene_sha256(path: &Path) -> Result<Sha256Digest, RendererError> {
    Scene::read_with_digest(path).map(|(_scene, sha256)| sha256)
}
