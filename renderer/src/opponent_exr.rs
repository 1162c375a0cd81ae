//! EXR files whose channels are A, C1 and C2.
//!
//! Not compressed: the noise of samples leaves ZIP a tenth to gain, for half of the time that a whole set takes.
//! Beside the pixels stand the ray counts, the matrix of Eq. 2 and all that is needed to make the image again.

use std::borrow::Cow;
use std::path::Path;

use exr::prelude::{AttributeValue, LayerAttributes, Text};
use protocols::{Channel, InputError, OpponentPixels, PerChannel};

use crate::channel_image::ChannelImage;
use crate::error::RendererError;
use crate::float_exr::{self, FloatExr};
use crate::image_record::ImageRecord;
use crate::opponent::AC1C2_FROM_XYZ;

const COMMENTS: &str =
    "A, C1, C2: opponent channels of Meyer & Liu (1992), Eq. 2, CIE 1931 2 degrees, linear";

/// The bytes of the file; `path` is only named in errors.
///
/// # Errors
///
/// [`RendererError::Encoding`] if the encoder refuses the image.
pub(crate) fn encode(
    channels: PerChannel<&ChannelImage>,
    record: &ImageRecord,
    path: &Path,
) -> Result<Vec<u8>, RendererError> {
    let values = |channel: Channel| {
        let values = Cow::Borrowed(channels[channel].values());
        (channel.to_string(), values)
    };
    let file = FloatExr {
        size_px: channels.a.size_px(),
        channels: Channel::ALL.map(values).into(),
        attributes: attributes(record),
    };
    file.encode(path)
}

fn attributes(record: &ImageRecord) -> LayerAttributes {
    let counts = [("raysA", record.rays_a), ("raysC1C2", record.rays_c1c2)];
    let counts = counts.map(|(name, rays)| (name, rays.get().to_string()));
    let mut attributes = float_exr::attributes(COMMENTS, counts.into_iter().chain(record.texts()));
    let matrix = AC1C2_FROM_XYZ.as_flattened();
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the attribute is of 32-bit floats; Eq. 2 has four decimals"
    )]
    let matrix = AttributeValue::Matrix3x3(std::array::from_fn(|place| matrix[place] as f32));
    attributes.other.insert(Text::from("ac1c2FromXyz"), matrix);
    attributes
}

/// The channels in the bytes of a file; `path` is only named in errors.
///
/// # Errors
///
/// The bytes are not an EXR file with the float channels A, C1 and C2, or a value is not finite.
pub fn read_opponent_exr(
    bytes: &[u8],
    path: &Path,
) -> Result<PerChannel<ChannelImage>, InputError> {
    let OpponentPixels { size_px, values } = OpponentPixels::from_exr(bytes, path)?;
    let image = |values: Vec<f32>| {
        let count = values.len();
        ChannelImage::new(size_px, values).ok_or_else(|| {
            let found = format!("{} x {} pixels, {count} values", size_px[0], size_px[1]);
            InputError::new(path, found, "one value for each pixel").remedy("render the set again")
        })
    };
    Ok(PerChannel {
        a: image(values.a)?,
        c1: image(values.c1)?,
        c2: image(values.c2)?,
    })
}
