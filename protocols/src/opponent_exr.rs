//! The channels of a stimulus as they are read: EXR files with the channels A, C1 and C2.
//!
//! Not here: writing them (the renderer's).

use std::io::Cursor;
use std::path::Path;

use exr::prelude::{AnyChannel, FlatSamples, ReadChannels as _, ReadLayers as _};

use crate::{Channel, InputError, PerChannel};

/// The pixels of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct OpponentPixels {
    /// Width and height.
    pub size_px: [u32; 2],
    /// The values of each channel, all finite, row by row from the top.
    pub values: PerChannel<Vec<f32>>,
}

impl OpponentPixels {
    /// Reads the bytes of a file; `path` is only named in errors.
    ///
    /// # Errors
    ///
    /// The bytes are not an EXR file with the 32-bit float channels A, C1 and C2, or a value is not finite.
    pub fn from_exr(bytes: &[u8], path: &Path) -> Result<Self, InputError> {
        let kind = "an EXR file with the 32-bit float channels A, C1 and C2";
        let wrong =
            |found: String| InputError::new(path, found, kind).remedy("render the set again");
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
        let mut stored = layer.channel_data.list;
        let mut take = |channel: Channel| {
            let found = stored
                .iter_mut()
                .find(|stored| stored.name.eq(&channel.to_string()));
            let Some(AnyChannel {
                sample_data: FlatSamples::F32(values),
                ..
            }) = found
            else {
                return Err(wrong(format!("no such channel {channel}")));
            };
            match values.iter().find(|value| !value.is_finite()) {
                Some(value) => Err(wrong(format!("the value {value} in channel {channel}"))),
                None => Ok(std::mem::take(values)),
            }
        };
        let values = PerChannel {
            a: take(Channel::A)?,
            c1: take(Channel::C1)?,
            c2: take(Channel::C2)?,
        };
        let size_px = [layer.size.x(), layer.size.y()];
        Ok(Self {
            size_px: size_px.map(|size| u32::try_from(size).unwrap_or(0)),
            values,
        })
    }
}
