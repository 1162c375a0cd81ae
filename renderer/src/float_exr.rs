//! EXR files of 32-bit float channels: scan lines, not compressed, attributes in the order of their names, no date.
//! The same image has the same bytes.
//!
//! The crate `exr` makes the header. The rest is nothing but the pixels, and is copied once: the place of each
//! line in the file (64 bits), then for each line its number and its length in bytes (32 bits each) and its
//! part of each channel, in the order of the channels' names, all little-endian.
//!
//! Source: "`OpenEXR` File Layout", openexr.com.

use std::borrow::Cow;
use std::path::Path;

use exr::meta::BlockDescription;
use exr::meta::header::Header;
use exr::prelude::{
    AttributeValue, ChannelDescription, Compression, LayerAttributes, LineOrder, SampleType, Text,
};

use crate::error::RendererError;

/// An image of float channels, to be encoded.
#[derive(Debug)]
pub(crate) struct FloatExr<'a> {
    pub(crate) size_px: [u32; 2],
    /// Name and values of each channel.
    pub(crate) channels: Vec<(String, Cow<'a, [f32]>)>,
    pub(crate) attributes: LayerAttributes,
}

/// The attributes of every file of ours, and some texts by their names.
pub(crate) fn attributes(
    comments: &str,
    texts: impl IntoIterator<Item = (&'static str, String)>,
) -> LayerAttributes {
    let mut attributes = LayerAttributes {
        software_name: Some(Text::from("Acuity")),
        comments: Some(Text::from(comments)),
        ..LayerAttributes::default()
    };
    let texts = texts.into_iter().map(|(name, text)| {
        let text = AttributeValue::Text(Text::from(text.as_str()));
        (Text::from(name), text)
    });
    attributes.other.extend(texts);
    attributes
}

impl FloatExr<'_> {
    /// The bytes of the file; `path` is only named in errors.
    ///
    /// # Errors
    ///
    /// [`RendererError::Encoding`] if the image has no pixels, a channel of another size, or an attribute that
    /// cannot be.
    pub(crate) fn encode(mut self, path: &Path) -> Result<Vec<u8>, RendererError> {
        let refused = |reason: String| RendererError::Encoding {
            path: path.to_owned(),
            reason,
        };
        self.channels.sort_by(|(one, _), (other, _)| one.cmp(other));
        let [width, height] = self.size_px.map(|size| size as usize);
        let is_whole = |(_, values): &(_, Cow<'_, [f32]>)| values.len() == width * height;
        if !self.channels.iter().all(is_whole) {
            return Err(refused("a channel of another size".to_owned()));
        }
        let mut bytes = self.header().map_err(refused)?;
        let line_bytes = 4 * width * self.channels.len();
        let first = bytes.len() + 8 * height;
        bytes.reserve_exact((8 + 8 + line_bytes) * height);
        for line in 0..height {
            let place = first + line * (8 + line_bytes);
            bytes.extend((place as u64).to_le_bytes());
        }
        let length = u32::try_from(line_bytes).map_err(|error| refused(error.to_string()))?;
        for line in 0..self.size_px[1] {
            bytes.extend(line.to_le_bytes());
            bytes.extend(length.to_le_bytes());
            let start = line as usize * width;
            for (_, values) in &self.channels {
                let place = bytes.len();
                bytes.resize(place + 4 * width, 0);
                let values = &values[start..start + width];
                for (bytes, value) in bytes[place..].as_chunks_mut().0.iter_mut().zip(values) {
                    *bytes = value.to_le_bytes();
                }
            }
        }
        Ok(bytes)
    }

    /// What stands before the pixels.
    fn header(&self) -> Result<Vec<u8>, String> {
        let [width, height] = self.size_px.map(|size| size as usize);
        let describe =
            |(name, _): &(String, _)| ChannelDescription::named(name.as_str(), SampleType::F32);
        let channels = self.channels.iter().map(describe).collect();
        let header = Header::new(Text::from(""), (width, height), channels)
            .with_encoding(
                Compression::Uncompressed,
                BlockDescription::ScanLines,
                LineOrder::Increasing,
            )
            .with_attributes(self.attributes.clone());
        let mut has_long_names = false;
        let checked = header.validate(false, &mut has_long_names, true);
        checked.map_err(|error| error.to_string())?;
        // The magic number, then the version and above it a bit for names of more than 31 letters.
        let version = 2 | (u32::from(has_long_names) << 10);
        let mut bytes = [20_000_630_u32, version].map(u32::to_le_bytes).concat();
        let written = Header::write_all(&[header], &mut bytes, false);
        written.map_err(|error| error.to_string())?;
        sort_attributes(&mut bytes).ok_or("a header without an end")?;
        Ok(bytes)
    }
}

/// Puts the attributes of the one header in the order of their names; their bytes stay the same.
///
/// The crate keeps them in a hash map. The header begins after the magic number and the version, 8 bytes. An
/// attribute is a name and a type, each ended by a zero, the length of its value in 4 bytes, and the value; an
/// empty name ends the header.
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

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use exr::prelude::{
        AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, WritableImage as _,
    };

    use super::*;

    /// The plain way: the crate writes the whole file.
    fn by_the_crate(picture: &FloatExr<'_>) -> Vec<u8> {
        let channels = picture.channels.iter().map(|(name, values)| {
            AnyChannel::new(name.as_str(), FlatSamples::F32(values.to_vec()))
        });
        let layer = Layer::new(
            (picture.size_px[0] as usize, picture.size_px[1] as usize),
            picture.attributes.clone(),
            Encoding::UNCOMPRESSED,
            AnyChannels::sort(channels.collect()),
        );
        let mut bytes = Cursor::new(Vec::new());
        let image = Image::from_layer(layer);
        image
            .write()
            .non_parallel()
            .to_buffered(&mut bytes)
            .unwrap();
        let mut bytes = bytes.into_inner();
        sort_attributes(&mut bytes).unwrap();
        bytes
    }

    #[test]
    fn the_bytes_are_those_that_the_crate_writes() {
        let long = "a name of an attribute that is longer than 31 letters";
        for (size_px, name) in [([1, 1], "seed"), ([7, 5], "seed"), ([64, 3], long)] {
            let pixels = (size_px[0] * size_px[1]) as usize;
            let values = |step: f32| {
                (0..pixels)
                    .map(|i| i as f32 * step - 1.0)
                    .collect::<Vec<_>>()
            };
            let channels = [
                ("C2", 0.1),
                ("A", 0.3),
                ("C1", -7.0),
                ("S0.409,375nm", 1e-9),
            ];
            let picture = FloatExr {
                size_px,
                channels: channels
                    .map(|(name, step)| (name.to_owned(), Cow::Owned(values(step))))
                    .into(),
                attributes: attributes("test", [(name, "1992".to_owned()), ("b", "2".to_owned())]),
            };
            let expected = by_the_crate(&picture);
            assert!(
                picture.encode(Path::new("x.exr")).unwrap() == expected,
                "{size_px:?}"
            );
        }
    }

    #[test]
    fn a_channel_of_another_size_is_refused() {
        let picture = FloatExr {
            size_px: [2, 2],
            channels: vec![("A".to_owned(), Cow::Owned(vec![0.0; 3]))],
            attributes: attributes("test", []),
        };
        assert!(picture.encode(Path::new("x.exr")).is_err());
    }
}
