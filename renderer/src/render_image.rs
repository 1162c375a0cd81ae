//! One image: its tree, its channels, its file.

use std::fmt;
use std::path::{Path, PathBuf};

use protocols::{Access, Channel, InputError, PerChannel, Sha256Digest, write_atomically};
use rayon::prelude::*;

use crate::account::RayAccount;
use crate::channel_image::ChannelImage;
use crate::checkpoint::Checkpoint;
use crate::error::RendererError;
use crate::image_record::ImageRecord;
use crate::image_request::ImageRequest;
use crate::opponent_exr;
use crate::reconstruct::reconstruct;
use crate::remark;
use crate::sampler::Sampler;
use crate::srgb_png::SrgbEncoder;
use crate::watch::Watch;

/// What was made and what it cost.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImageSummary {
    /// The file.
    pub path: PathBuf,
    /// Its digest.
    pub sha256: Sha256Digest,
    /// Rays followed and shaded.
    pub account: RayAccount,
    /// How many rectangles each channel's image was filtered from.
    pub rectangles: PerChannel<u64>,
    /// Pixels that had to be clipped to the sRGB gamut.
    pub out_of_gamut_px: u32,
    /// What a reader of the image must know.
    pub remark: Option<&'static str>,
    /// The warnings of the scene.
    pub warnings: Vec<String>,
}

impl fmt::Display for ImageSummary {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let PerChannel { a, c1, c2 } = self.rectangles;
        writeln!(formatter, "{}", self.path.display())?;
        writeln!(formatter, "{}", self.account)?;
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
    let plan = request.trace_plan();
    let checkpoint = Checkpoint::beside(out, &plan, request.quadrature, &scene_sha256);
    let tree = checkpoint.trace(sampler, &plan, watch)?;
    let images: Vec<(ChannelImage, u64)> = Channel::ALL
        .into_par_iter()
        .filter_map(|channel| tree.leaves(channel, request.reach(channel)))
        .map(|leaves| (reconstruct(&leaves, request.size_px), leaves.len() as u64))
        .collect();
    let [(a, a_count), (c1, c1_count), (c2, c2_count)] = images.as_slice() else {
        return Err(RendererError::Encoding {
            path: out.to_owned(),
            reason: "a channel stopped before its image was complete".to_owned(),
        });
    };
    let channels = PerChannel { a, c1, c2 };
    let rectangles = PerChannel {
        a: *a_count,
        c1: *c1_count,
        c2: *c2_count,
    };
    let picture = SrgbEncoder::new().encode(channels);
    let bytes = match format {
        Format::Exr => {
            opponent_exr::encode(channels, &request.record(scene_sha256, rectangles), out)?
        }
        Format::Png => picture.to_png(out)?,
    };
    write_atomically(out, &bytes, Access::Ordinary)
        .map_err(|error| RendererError::writing(out, error))?;
    checkpoint.remove()?;
    Ok(ImageSummary {
        path: out.to_owned(),
        sha256: Sha256Digest::of(&bytes),
        account: tree.account(),
        rectangles,
        out_of_gamut_px: picture.out_of_gamut_px,
        remark: remark::of_driver(request.tree.driver),
        warnings: Vec::new(),
    })
}

impl ImageRequest {
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
            seed: self.seed,
            quadrature: self.quadrature,
            tree: self.tree.clone(),
        }
    }
}
