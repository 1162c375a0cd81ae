//! EXR files whose channels are A, C1 and C2.
//!
//! 32-bit float, scan lines, not compressed: the noise of samples leaves ZIP a tenth to gain, for half of the
//! time that a whole set takes. Beside the pixels stand the ray counts, the matrix of Eq. 2 and all that
//! is needed to make the image again. The same image has the same bytes: no date, no machine, and the
//! attributes in the order of their names (the `exr` crate keeps them in a hash map).

use std::io::Cursor;
use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Encoding, FlatSamples, Image, Layer, LayerAttributes,
    ReadChannels as _, ReadLayers as _, Text, WritableImage as _,
};
use protocols::{Channel, InputError, PerChannel};

use crate::channel_image::ChannelImage;
use crate::error::RendererError;
use crate::image_record::ImageRecord;
use crate::opponent::AC1C2_FROM_XYZ;

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
    let size_px = channels.a.size_px().map(|size| size as usize);
    let samples = |channel: Channel| {
        let name = channel.to_string();
        AnyChannel::new(
            name.as_str(),
            FlatSamples::F32(channels[channel].values().to_vec()),
        )
    };
    let layer = Layer::new(
        (size_px[0], size_px[1]),
        attributes(record),
        Encoding::UNCOMPRESSED,
        AnyChannels::sort(Channel::ALL.into_iter().map(samples).collect()),
    );
    let mut bytes = Cursor::new(Vec::new());
    let image = Image::from_layer(layer);
    let refused = |reason: String| RendererError::Encoding {
        path: path.to_owned(),
        reason,
    };
    let written = image.write().non_parallel().to_buffered(&mut bytes);
    written.map_err(|error| refused(error.to_string()))?;
    let mut bytes = bytes.into_inner();
    sort_attributes(&mut bytes).ok_or_else(|| refused("a header without an end".to_owned()))?;
    Ok(bytes)
}

fn attributes(record: &ImageRecord) -> LayerAttributes {
    let mut attributes = LayerAttributes {
        software_name: Some(Text::from("Acuity")),
        comments: Some(Text::from(
            "A, C1, C2: opponent channels of Meyer & Liu (1992), Eq. 2, CIE 1931 2 degrees, linear",
        )),
        ..LayerAttributes::default()
    };
    let matrix = AC1C2_FROM_XYZ.as_flattened();
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the attribute is of 32-bit floats; Eq. 2 has four decimals"
    )]
    let matrix = std::array::from_fn(|place| matrix[place] as f32);
    let counts = [("raysA", record.rays_a), ("raysC1C2", record.rays_c1c2)];
    let texts = record
        .texts()
        .into_iter()
        .map(|(name, text)| (name, AttributeValue::Text(Text::from(text.as_str()))));
    let all = counts
        .into_iter()
        .map(|(name, rays)| {
            (
                name,
                AttributeValue::Text(Text::from(rays.get().to_string().as_str())),
            )
        })
        .chain([("ac1c2FromXyz", AttributeValue::Matrix3x3(matrix))])
        .chain(texts);
    attributes
        .other
        .extend(all.map(|(name, value)| (Text::from(name), value)));
    attributes
}

/// Puts the attributes of the one header in the order of their names; their bytes stay the same.
///
/// The header begins after the magic number and the version, 8 bytes. An attribute is a name and a type,
/// each ended by a zero, the length of its value in 4 bytes, and the value; an empty name ends the header.
pub(crate) fn sort_attributes(file: &mut [u8]) -> Option<()> {
    let mut attributes = Vec::new();
    let mut end = 8;
    while *file.get(end)? != 0 {
        let start = end;
        for _name_then_type in 0..2 {
            end += file.get(end..)?.iter().position(|&byte| byte == 0)? + 1;
        }
        let length = file.get(end..)?.first_chunk::<4>()?;
        end += 4 + usize::try_from(u32::from_le_bytes(*length)).ok()?;
        attributes.push(file.get(start..end)?.to_vec());
    }
    attributes.sort_unstable();
    file[8..end].copy_from_slice(&attributes.concat());
    Some(())
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
