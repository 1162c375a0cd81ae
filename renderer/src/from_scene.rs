//! From a scene file to pictures: the work of `acuity render` and `acuity image`.

use std::num::NonZeroUsize;
use std::path::Path;

use protocols::Study;

use crate::error::RendererError;
use crate::image_request::ImageRequest;
use crate::render_image::{Format, ImageSummary, render_image_of};
use crate::scene::Scene;
use crate::set_summary::SetSummary;
use crate::stimulus_set::render_set_of;
use crate::threads::on_threads;

/// Renders the stimulus set of a study into the folder `out`.
///
/// `threads`: one for each core if not said; the files are the same with any number. `progress` is told how
/// much is done, and of how much.
///
/// # Errors
///
/// [`RendererError::Input`] if the scene is wrong; other variants if a file could not be made. There is
/// then no manifest.
pub fn render_set(
    study: &Study,
    out: &Path,
    threads: Option<NonZeroUsize>,
    progress: &(dyn Fn(u64, u64) + Sync),
) -> Result<SetSummary, RendererError> {
    let (scene, scene_sha256) = Scene::read_with_digest(&study.scene_path())?;
    let plan = &study.protocol.stimuli;
    on_threads(threads, out, || {
        let sampler = scene.sampler(plan.quadrature, plan.size_px);
        render_set_of(&sampler, &scene_sha256, study, out, progress)
    })
}

/// Renders one image of a scene to `out`: EXR or PNG, by its ending.
///
/// The bytes are those of the same image in a stimulus set.
///
/// # Errors
///
/// [`RendererError::Input`] if the scene or the request is wrong, or the ending is unknown; other variants
/// if the file could not be made.
pub fn render_image(
    scene: &Path,
    request: &ImageRequest,
    out: &Path,
) -> Result<ImageSummary, RendererError> {
    Format::of(out)?;
    request.check(scene)?;
    let (scene, scene_sha256) = Scene::read_with_digest(scene)?;
    on_threads(request.threads, out, || {
        let sampler = scene.sampler(request.quadrature, request.size_px);
        render_image_of(&sampler, scene_sha256, request, out)
    })
}
