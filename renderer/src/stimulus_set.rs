//! The stimulus set of a study: one trace, every channel image read from it, every stimulus put together.
//!
//! The channel image at N rays is read from the tree as it stood after N samples; a stimulus is the
//! recombination of two of them for A and for C1 and C2. The manifest is written last: a folder without
//! one is no set.

use std::collections::BTreeMap;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::SyncSender;

use protocols::{
    Access, Channel, Manifest, ManifestFile, ManifestStimulus, PerChannel, RayCount, Rendering,
    Sha256Digest, Stimulus, Study, write_atomically,
};
use rayon::prelude::*;
use serde::Serialize;

use crate::acuity_limits::AcuityLimits;
use crate::channel_image::ChannelImage;
use crate::checkpoint::Checkpoint;
use crate::error::RendererError;
use crate::export::Exporter;
use crate::file_writers::{Files, while_writing, writers_for};
use crate::image_record::ImageRecord;
use crate::image_request::ImageRequest;
use crate::opponent_exr;
use crate::refine::TracePlan;
use crate::remark;
use crate::sampler::Sampler;
use crate::screen_tree::{Reach, ScreenTree};
use crate::set_summary::{SetSummary, StimulusSummary};
use crate::snapshots::{Wanted, snapshots};
use crate::srgb_png::SrgbEncoder;
use crate::watch::{Stage, Watch};

const COLOR_SPACE: &str = "EXR: opponent channels A, C1, C2 of Meyer & Liu (1992), Eq. 2 on CIE 1931 2-degree \
    tristimulus values, linear, display white D65 at (1.0001, -0.0293, 0.5537). PNG: sRGB (IEC 61966-2-1), 8 bits, \
    white D65.";

/// The images of each channel, by their ray counts.
type ImagesByRays = PerChannel<BTreeMap<usize, ChannelImage>>;

/// Renders the stimulus set of a study into the folder `out`, from anything that can be sampled.
///
/// Runs in the current rayon pool; the files are the same in any. `watch` is told how much is done, and may
/// end the work: a checkpoint in `out` then holds what was traced.
///
/// # Errors
///
/// A file could not be made; there is then no manifest.
pub fn render_set_of(
    sampler: &impl Sampler,
    scene_sha256: &Sha256Digest,
    study: &Study,
    out: &Path,
    watch: &Watch<'_>,
) -> Result<SetSummary, RendererError> {
    let rendering = study.rendering()?;
    let plan = rendering.plan;
    let stimuli = plan.stimuli();
    let trace_plan = trace_plan(rendering);
    let checkpoint = Checkpoint::beside(
        &out.join("trace"),
        &trace_plan,
        plan.quadrature,
        scene_sha256,
    );
    let tree = checkpoint.trace(sampler, &trace_plan, watch)?;
    remove_manifest(out)?;
    let images = channel_images(&tree, rendering).unwrap_or_default();
    let encoder = SrgbEncoder::new();
    let encode = |stimulus: &Stimulus, files: &SyncSender<Files>| {
        if watch.is_cancelled() {
            return Err(checkpoint.interruption(&tree, &trace_plan));
        }
        let request = ImageRequest::of_study(rendering, stimulus.rays_a, stimulus.rays_c1c2);
        let channels = recombine(&images, &request, out)?;
        let record = request.record(scene_sha256.clone(), request.rectangles_in(&tree));
        let (mut entry, images) = encode_stimulus(stimulus, channels, &record, &encoder, out)?;
        let exporter = Exporter {
            sampler,
            tree: &tree,
            request: &request,
            record: &record,
            channels,
        };
        let exports = exporter.write(&out.join(&entry.exr.name))?;
        entry.exports = exports.into_iter().collect();
        // Writers go only when nothing more is handed over.
        let _sent = files.send(images);
        Ok(entry)
    };
    let images_done = AtomicU64::new(0);
    let written = || {
        let done = images_done.fetch_add(1, Ordering::Relaxed) + 1;
        watch.tell(Stage::Images, done, stimuli.len() as u64);
    };
    let entries = while_writing(writers_for(plan.size_px), out, &written, |files| {
        let stimuli = stimuli.par_iter().with_max_len(1);
        stimuli.map(|stimulus| encode(stimulus, files)).collect()
    });
    checkpoint.keep_if_cancelled(&tree, &trace_plan, watch)?;
    let manifest = manifest(study, plan, (scene_sha256.clone(), entries?));
    write_manifest(&manifest, out)?;
    checkpoint.remove()?;
    Ok(summary(study, rendering, manifest, (&tree, out)))
}

fn summary(
    study: &Study,
    rendering: Rendering<'_>,
    manifest: Manifest,
    (tree, out): (&ScreenTree, &Path),
) -> SetSummary {
    let stimuli = manifest.stimuli.iter();
    SetSummary {
        folder: out.to_owned(),
        account: tree.account(),
        stimuli: stimuli
            .map(|stimulus| StimulusSummary::new(stimulus, rendering, tree))
            .collect(),
        acuity: study.protocol.acuity.map(|acuity| {
            AcuityLimits::new(acuity, study.protocol.viewing, rendering.plan.size_px)
        }),
        remarks: manifest.remarks,
        warnings: Vec::new(),
    }
}

/// Every channel as far as any image needs it.
fn trace_plan(rendering: Rendering<'_>) -> TracePlan {
    let plan = rendering.plan;
    let most = |rays: fn(&Stimulus) -> RayCount| {
        let counts = plan.stimuli().iter().map(rays).max();
        counts.unwrap_or_else(|| plan.most_rays())
    };
    let rays_a = most(|stimulus| stimulus.rays_a);
    let rays_c1c2 = most(|stimulus| stimulus.rays_c1c2);
    ImageRequest::of_study(rendering, rays_a, rays_c1c2).trace_plan()
}

/// Every channel image that a stimulus needs.
fn channel_images(tree: &ScreenTree, rendering: Rendering<'_>) -> Option<ImagesByRays> {
    let mut wanted = PerChannel::<Wanted>::default();
    for stimulus in rendering.plan.stimuli() {
        let request = ImageRequest::of_study(rendering, stimulus.rays_a, stimulus.rays_c1c2);
        for channel in Channel::ALL {
            let Reach { rays, depth } = request.reach(channel);
            wanted[channel].rays.insert(rays);
            wanted[channel].depth = depth;
        }
    }
    snapshots(tree, &wanted, rendering.plan.size_px)
}

fn recombine<'a>(
    images: &'a ImagesByRays,
    request: &ImageRequest,
    out: &Path,
) -> Result<PerChannel<&'a ChannelImage>, RendererError> {
    let find = |channel: Channel| {
        let rays = request.rays(channel);
        images[channel]
            .get(&rays.as_usize())
            .ok_or_else(|| RendererError::Encoding {
                path: out.to_owned(),
                reason: format!("the trace holds no image of {channel} at {rays} rays"),
            })
    };
    Ok(PerChannel {
        a: find(Channel::A)?,
        c1: find(Channel::C1)?,
        c2: find(Channel::C2)?,
    })
}

/// The entry of a stimulus in the manifest, and its files.
fn encode_stimulus(
    stimulus: &Stimulus,
    channels: PerChannel<&ChannelImage>,
    record: &ImageRecord,
    encoder: &SrgbEncoder,
    out: &Path,
) -> Result<(ManifestStimulus, Files), RendererError> {
    let path = out.join(stimulus.id.as_str());
    let picture = encoder.encode(channels);
    let files = [
        ("exr", opponent_exr::encode(channels, record, &path)?),
        ("png", picture.to_png(&path)?),
    ];
    let [exr, png] = files.each_ref().map(|(ending, bytes)| ManifestFile {
        name: format!("{}.{ending}", stimulus.id),
        sha256: Sha256Digest::of(bytes),
    });
    let files = [&exr, &png].into_iter().zip(files);
    let files = files.map(|(file, (_, bytes))| (out.join(&file.name), bytes));
    let files = files.collect();
    let factors = stimulus.factors();
    let entry = ManifestStimulus {
        id: stimulus.id.clone(),
        varied: factors.get("channel").cloned().unwrap_or_default(),
        rays_a: stimulus.rays_a,
        rays_c1c2: stimulus.rays_c1c2,
        factors,
        exr,
        png,
        out_of_gamut_px: picture.out_of_gamut_px,
        exports: BTreeMap::new(),
    };
    Ok((entry, files))
}

fn manifest(
    study: &Study,
    plan: &protocols::StimulusPlan,
    (scene_sha256, stimuli): (Sha256Digest, Vec<ManifestStimulus>),
) -> Manifest {
    Manifest {
        set: plan.set.clone(),
        acuity_version: env!("CARGO_PKG_VERSION").to_owned(),
        protocol_sha256: study.sha256.clone(),
        scene_sha256,
        plan: plan.clone(),
        color_space: COLOR_SPACE.to_owned(),
        remarks: remark::of_driver(plan.tree.driver)
            .map(str::to_owned)
            .into_iter()
            .collect(),
        viewing: study.protocol.viewing.into(),
        acuity: study.protocol.acuity,
        stimuli,
    }
}

pub(crate) fn write_manifest(manifest: &impl Serialize, out: &Path) -> Result<(), RendererError> {
    let path = out.join(Manifest::FILE_NAME);
    let mut text =
        serde_json::to_string_pretty(manifest).map_err(|error| RendererError::Encoding {
            path: path.clone(),
            reason: error.to_string(),
        })?;
    text.push('\n');
    write_atomically(&path, text.as_bytes(), Access::Ordinary)
        .map_err(|error| RendererError::writing(&path, error))
}

/// An older set is no set while its files are replaced.
pub(crate) fn remove_manifest(out: &Path) -> Result<(), RendererError> {
    let path = out.join(Manifest::FILE_NAME);
    match fs::remove_file(&path) {
        Err(error) if error.kind() != ErrorKind::NotFound => {
            Err(RendererError::writing(&path, error))
        }
        _ => Ok(()),
    }
}
