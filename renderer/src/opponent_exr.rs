//! EXR files whose channels are A, C1 and C2.
//!
//! Not compressed: the noise of samples leaves ZIP a tenth to gain, for half of the time that a whole set takes.
//! Beside the pixels stand the ray counts, the matrix of Eq. 2 and all that is needed to make the image again.

use std::borrow::Cow;
use std::io::Cursor;
use std::path::Path;

use exr::prelude::{
    AnyChannel, AttributeValue, FlatSamples, LayerAttributes, ReadChannels as _, ReadLayers as _,
    Text,
};
use protocols::{Channel, InputError, PerChannel};

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
    let kind = "an EXR file with the 32-bit float channels A, C1 and C2";
    let wrong = |found: String| InputError::new(path, found, kind).remedy("render the set again");
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(|error| wrong(error.to_string()))?;
    let layer = image.layer_data;
    let size_px = [layer.size.x(), layer.size.y()].map(|size| u32::try_from(size).unwrap_or(0));
    let find = |channel: Channel| {
        let mut list = layer.channel_data.list.iter();
        let found = list.find(|stored| stored.name.eq(&channel.to_string()));
        let Some(AnyChannel {
            sample_data: FlatSamples::F32(values),
            ..
        }) = found
        else {
            return Err(wrong(format!("no such channel {channel}")));
        };
        if let Some(place) = values.iter().position(|value| !value.is_finite()) {
            return Err(wrong(format!(
                "the value {} in channel {channel}",
                values[place]
            )));
        }
        ChannelImage::new(size_px, values.clone())
            .ok_or_else(|| wrong(format!("{} values in channel {channel}", values.len())))
    };
    Ok(PerChannel {
        a: find(Channel::A)?,
        c1: find(Channel::C1)?,
        c2: find(Channel::C2)?,
    })
}
