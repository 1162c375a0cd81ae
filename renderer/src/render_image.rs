//! One image: its tree, its channels, its file.

use std::fmt;
use std::path::{Path, PathBuf};

use protocols::{Access, Channel, InputError, PerChannel, Sha256Digest, write_atomically};

use crate::account::RayAccount;
use crate::channel_image::ChannelImage;
use crate::checkpoint::Checkpoint;
use crate::confidence::ConfidenceReached;
use crate::error::RendererError;
use crate::export::Exporter;
use crate::image_record::ImageRecord;
use crate::image_request::ImageRequest;
use crate::opponent_exr;
use crate::remark;
use crate::sampler::Sampler;
use crate::samples_map::{self, SamplesMap};
use crate::screen_tree::{Reach, ScreenTree};
use crate::snapshots::{Wanted, snapshots};
use crate::srgb_png::{SrgbEncoder, SrgbImage};
use crate::watch::Watch;

/// What was made and what it cost.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageSummary {
    /// The file.
    pub path: PathBuf,
    /// The further files.
    pub exports: Vec<PathBuf>,
    /// Its digest.
    pub sha256: Sha256Digest,
    /// Rays followed and shaded.
    pub account: RayAccount,
    /// How many rectangles each channel's image was filtered from.
    pub rectangles: PerChannel<u64>,
    /// Whether the picture is as well known as it was to be, if that was asked for.
    pub confidence: Option<ConfidenceReached>,
    /// Pixels that had to be clipped to the sRGB gamut.
    pub out_of_gamut_px: u32,
    /// What a reader of the image must know.
    pub remark: Option<&'static str>,
    /// The warnings of the scene.
    pub warnings: Vec<String>,
    /// The image as a display is given it.
    pub picture: SrgbImage,
}

impl fmt::Display for ImageSummary {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let PerChannel { a, c1, c2 } = self.rectangles;
        for path in [&self.path].into_iter().chain(&self.exports) {
            writeln!(formatter, "{}", path.display())?;
        }
        writeln!(formatter, "{}", self.account)?;
        if let Some(confidence) = &self.confidence {
            writeln!(formatter, "{confidence}")?;
        }
        write!(formatter, "rectangles filtered: A {a}, C1 {c1}, C2 {c2}; ")?;
        write!(
            formatter,
            "{} pixels out of the sRGB gamut",
            self.out_of_gamut_px
        )?;
        match self.remark {
            Some(remark) => write!(formatter, "\nremark: {remark}"),
            None => Ok(()),
        }
    }
}

/// The format of an image file, by the ending of its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Format {
    Exr,
    Png,
}

impl Format {
    pub(crate) fn of(path: &Path) -> Result<Self, InputError> {
        match path.extension().and_then(|ending| ending.to_str()) {
            Some("exr") => Ok(Self::Exr),
            Some("png") => Ok(Self::Png),
            _ => Err(InputError::new(
                path,
                "no such ending",
                "a file name that ends in .exr (A, C1, C2) or .png (sRGB)",
            )),
        }
    }
}

/// Renders one image of anything that can be sampled to `out`: EXR or PNG, by its ending.
///
/// Runs in the current rayon pool; `scene_sha256` goes into the record beside the pixels, and into the
/// checkpoint that is left beside `out` if `watch` ends the work.
///
/// # Errors
///
/// [`RendererError::Input`] if the ending is unknown; other variants if the file could not be made.
pub fn render_image_of(
    sampler: &impl Sampler,
    scene_sha256: Sha256Digest,
    request: &ImageRequest,
    out: &Path,
    watch: &Watch<'_>,
) -> Result<ImageSummary, RendererError> {
    let format = Format::of(out)?;
    samples_map::check_names(&request.samples_maps)?;
    let plan = request.trace_plan();
    let checkpoint = Checkpoint::beside(out, &plan, request.quadrature, &scene_sha256);
    let tree = checkpoint.trace(sampler, &plan, watch)?;
    let images = request
        .images_in(&tree)
        .ok_or_else(|| RendererError::Encoding {
            path: out.to_owned(),
            reason: "a channel stopped before its image was complete".to_owned(),
        })?;
    let PerChannel { a, c1, c2 } = &images;
    let channels = PerChannel { a, c1, c2 };
    let rectangles = request.rectangles_in(&tree);
    write_samples_maps(&tree, request)?;
    let account = tree.account();
    let confidence = confidence_reached(&tree, request);
    let record = request.record(scene_sha256, rectangles);
    let exporter = Exporter {
        sampler,
        tree: &tree,
        request,
        record: &record,
        channels,
    };
    let exports = exporter.write(out)?;
    // It may be larger than all that is still to be made.
    drop(tree);
    let picture = SrgbEncoder::new().encode(channels);
    let bytes = match format {
        Format::Exr => opponent_exr::encode(channels, &record, out)?,
        Format::Png => picture.to_png(out)?,
    };
    let write = || write_atomically(out, &bytes, Access::Ordinary);
    let (written, sha256) = rayon::join(write, || Sha256Digest::of(&bytes));
    written.map_err(|error| RendererError::writing(out, error))?;
    checkpoint.remove()?;
    Ok(ImageSummary {
        path: out.to_owned(),
        exports: (exports.iter())
            .map(|(_, file)| out.with_file_name(&file.name))
            .collect(),
        sha256,
        account,
        rectangles,
        confidence,
        out_of_gamut_px: picture.out_of_gamut_px,
        remark: remark::of_driver(request.tree.driver),
        warnings: Vec::new(),
        picture,
    })
}

/// How much of the picture is known as well as the request wants it.
fn confidence_reached(tree: &ScreenTree, request: &ImageRequest) -> Option<ConfidenceReached> {
    let (until, unknown_area) = request.until.zip(tree.unknown_area)?;
    Some(ConfidenceReached {
        until,
        rays: tree.account().intersections,
        unknown_area,
    })
}

fn write_samples_maps(tree: &ScreenTree, request: &ImageRequest) -> Result<(), RendererError> {
    if request.samples_maps.is_empty() {
        return Ok(());
    }
    let reach = PerChannel::from_fn(|channel| request.reach(channel));
    let map = SamplesMap::new(tree, reach, request.size_px);
    let mut files = request.samples_maps.iter();
    files.try_for_each(|file| map.write(file))
}

impl ImageRequest {
    /// The image of each channel; `None` if a channel stopped earlier.
    fn images_in(&self, tree: &ScreenTree) -> Option<PerChannel<ChannelImage>> {
        let wanted = PerChannel::from_fn(|channel| {
            let Reach { rays, depth } = self.reach(channel);
            let rays = [rays].into();
            Wanted { rays, depth }
        });
        let mut images = snapshots(tree, &wanted, self.size_px)?;
        let mut only = |channel: Channel| images[channel].pop_first().map(|(_, image)| image);
        Some(PerChannel {
            a: only(Channel::A)?,
            c1: only(Channel::C1)?,
            c2: only(Channel::C2)?,
        })
    }

    /// What the file of the image says, with the samples from which each channel was made.
    pub(crate) fn record(
        &self,
        scene_sha256: Sha256Digest,
        samples: PerChannel<u64>,
    ) -> ImageRecord {
        ImageRecord {
            scene_sha256,
            samples,
            rays_a: self.rays_a,
            rays_c1c2: self.rays_c1c2,
            stop_depths: self.stop_depths,
            until: self.until,
            seed: self.seed,
            quadrature: self.quadrature,
            tree: self.tree.clone(),
        }
    }
}
