//! Where the samples of a picture lie and how deep its tree goes, pixel by pixel and channel by channel.
//!
//! A sample counts in the pixel that it lies in, so the counts of a channel sum to the samples from which
//! its image was made. The depth of a pixel is that of the leaf which holds its centre.
//!
//! Not here: the sheet that shows them (`figures::samples_sheet`).

use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, Text,
    WritableImage as _,
};
use protocols::{Access, Channel, InputError, PerChannel, write_atomically};

use crate::channel_image::ChannelImage;
use crate::error::RendererError;
use crate::figures::samples_sheet;
use crate::float_exr::sort_attributes;
use crate::render_image::Format;
use crate::sampler::ScreenPoint;
use crate::screen_tree::{Reach, ScreenTree};

/// The samples and depths of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct SamplesMap {
    /// How many samples of each channel lie in each pixel.
    pub samples: PerChannel<ChannelImage>,
    /// The depth of each channel's leaf at the centre of each pixel.
    pub depths: PerChannel<ChannelImage>,
}

impl SamplesMap {
    /// The map of a picture of this size whose channels go this far into a tree.
    pub fn new(tree: &ScreenTree, reach: PerChannel<Reach>, size_px: [u32; 2]) -> Self {
        let of = |values| ChannelImage::from_rows(size_px, values);
        let [[a, a_depth], [c1, c1_depth], [c2, c2_depth]] =
            Channel::ALL.map(|channel| counts_and_depths(tree, reach[channel], size_px).map(of));
        Self {
            samples: PerChannel { a, c1, c2 },
            depths: PerChannel {
                a: a_depth,
                c1: c1_depth,
                c2: c2_depth,
            },
        }
    }

    /// Writes the map to `out`: as float channels (`A.samples`, `A.depth`, ...) if it ends in `.exr`, as a
    /// sheet to look at if it ends in `.png`.
    ///
    /// # Errors
    ///
    /// [`RendererError::Input`] if the ending is another; other variants if the file could not be made.
    pub fn write(&self, out: &Path) -> Result<(), RendererError> {
        let bytes = match Format::of(out)? {
            Format::Exr => self.to_exr(out)?,
            Format::Png => samples_sheet::png(self, out)?,
        };
        if let Some(folder) = out.parent() {
            fs::create_dir_all(folder).map_err(|error| RendererError::writing(folder, error))?;
        }
        write_atomically(out, &bytes, Access::Ordinary)
            .map_err(|error| RendererError::writing(out, error))
    }

    fn to_exr(&self, out: &Path) -> Result<Vec<u8>, RendererError> {
        let [width, height] = self.samples.a.size_px().map(|size| size as usize);
        let channel = |name: String, image: &ChannelImage| {
            let values = FlatSamples::F32(image.values().to_vec());
            AnyChannel::new(name.as_str(), values)
        };
        let channels = Channel::ALL.into_iter().flat_map(|of| {
            [
                channel(format!("{of}.samples"), &self.samples[of]),
                channel(format!("{of}.depth"), &self.depths[of]),
            ]
        });
        let attributes = LayerAttributes {
            software_name: Some(Text::from("Acuity")),
            comments: Some(Text::from(
                "samples: samples that lie in a pixel; depth: of the tree's leaf at the centre of a pixel",
            )),
            ..LayerAttributes::default()
        };
        let channels = AnyChannels::sort(channels.collect());
        let layer = Layer::new(
            (width, height),
            attributes,
            Encoding::SMALL_LOSSLESS,
            channels,
        );
        let mut bytes = Cursor::new(Vec::new());
        let refused = |reason: String| RendererError::Encoding {
            path: out.to_owned(),
            reason,
        };
        let image = Image::from_layer(layer);
        let written = image.write().non_parallel().to_buffered(&mut bytes);
        written.map_err(|error| refused(error.to_string()))?;
        let mut bytes = bytes.into_inner();
        sort_attributes(&mut bytes).ok_or_else(|| refused("a header without an end".to_owned()))?;
        Ok(bytes)
    }
}

/// Refuses the name of a map that ends in no known format.
///
/// # Errors
///
/// The ending is neither `.exr` nor `.png`.
pub(crate) fn check_names(maps: &[PathBuf]) -> Result<(), InputError> {
    maps.iter().try_for_each(|map| Format::of(map).map(|_| ()))
}

/// The samples in each pixel, and the depth at the centre of each.
fn counts_and_depths(tree: &ScreenTree, reach: Reach, size_px: [u32; 2]) -> [Vec<f32>; 2] {
    let [width, height] = size_px.map(|size| size as usize);
    let [mut counts, mut depths] = [(); 2].map(|()| vec![0.0; width * height]);
    for node in tree.leaf_nodes(reach) {
        let ScreenPoint { x, y } = tree.point(node.sample);
        let (column, row) = (to_index(x * width as f64), to_index(y * height as f64));
        counts[row * width + column] += 1.0;
        let cell = node.cell.rectangle();
        let columns = centres(cell.left, cell.width, width);
        #[expect(clippy::cast_possible_truncation, reason = "at most 48")]
        let depth = f64::from(node.cell.depth()) as f32;
        for row in centres(cell.top, cell.height, height) {
            depths[row * width + columns.start..row * width + columns.end].fill(depth);
        }
    }
    [counts, depths]
}

/// The pixels whose centres lie in an interval.
fn centres(start: f64, length: f64, pixels: usize) -> std::ops::Range<usize> {
    let first_from = |place: f64| to_index((place * pixels as f64 - 0.5).ceil());
    first_from(start)..first_from(start + length)
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a pixel's place, at most 16384; below the first pixel it saturates at 0"
)]
fn to_index(place: f64) -> usize {
    place as usize
}
