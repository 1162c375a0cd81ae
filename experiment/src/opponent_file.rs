//! The stimuli's own colours: EXR files with the channels A, C1 and C2.

use std::io::Cursor;
use std::path::Path;

use exr::prelude::{FlatSamples, ReadChannels as _, ReadLayers as _};
use protocols::{Channel, InputError, PerChannel};

/// The pixels of a file, row by row from the top; `path` is only named in errors.
///
/// # Errors
///
/// The bytes are no EXR file with the float channels A, C1 and C2 in this size, or a value is not finite.
pub(crate) fn read_opponent_file(
    bytes: &[u8],
    path: &Path,
    size_px: [u32; 2],
) -> Result<Vec<PerChannel<f64>>, InputError> {
    let kind = "an EXR file with the 32-bit float channels A, C1 and C2";
    let wrong = |found: String| InputError::new(path, found, kind).remedy("render the set again");
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes));
    let layer = image.map_err(|error| wrong(error.to_string()))?.layer_data;
    let found_px = [layer.size.x(), layer.size.y()];
    if found_px != size_px.map(|pixels| pixels as usize) {
        return Err(wrong(format!("{} x {} pixels", found_px[0], found_px[1])));
    }
    let find = |channel: Channel| {
        let mut list = layer.channel_data.list.iter();
        let stored = list.find(|stored| stored.name.eq(&channel.to_string()));
        match stored.map(|stored| &stored.sample_data) {
            Some(FlatSamples::F32(values)) if values.iter().all(|value| value.is_finite()) => {
                Ok(values)
            }
            Some(_) => Err(wrong(format!("channel {channel} without finite floats"))),
            None => Err(wrong(format!("no channel {channel}"))),
        }
    };
    let (a, c1, c2) = (find(Channel::A)?, find(Channel::C1)?, find(Channel::C2)?);
    let pixels = a.iter().zip(c1).zip(c2);
    let pixel = |((a, c1), c2): ((&f32, &f32), &f32)| PerChannel {
        a: f64::from(*a),
        c1: f64::from(*c1),
        c2: f64::from(*c2),
    };
    Ok(pixels.map(pixel).collect())
}
