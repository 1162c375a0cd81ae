//! EXR files of any 32-bit float channels: the exports for other programs.
//!
//! Scan lines, not compressed, attributes in the order of their names, no date: the same image has the same
//! bytes.

use std::io::Cursor;
use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Encoding, FlatSamples, Image, Layer, LayerAttributes,
    Text, WritableImage as _,
};

use crate::error::RendererError;
use crate::opponent_exr::sort_attributes;

/// An image of float channels, to be encoded.
#[derive(Debug)]
pub(crate) struct FloatExr {
    pub(crate) size_px: [u32; 2],
    /// Name and values of each channel.
    pub(crate) channels: Vec<(String, Vec<f32>)>,
    /// Name and text of each attribute.
    pub(crate) texts: Vec<(&'static str, String)>,
    pub(crate) comments: &'static str,
}

impl FloatExr {
    /// The bytes of the file; `path` is only named in errors.
    ///
    /// # Errors
    ///
    /// [`RendererError::Encoding`] if the encoder refuses the image.
    pub(crate) fn encode(self, path: &Path) -> Result<Vec<u8>, RendererError> {
        let mut attributes = LayerAttributes {
            software_name: Some(Text::from("Acuity")),
            comments: Some(Text::from(self.comments)),
            ..LayerAttributes::default()
        };
        let texts = self.texts.into_iter();
        attributes.other.extend(texts.map(|(name, text)| {
            let text = AttributeValue::Text(Text::from(text.as_str()));
            (Text::from(name), text)
        }));
        let [width, height] = self.size_px.map(|size| size as usize);
        let channels = self.channels.into_iter();
        let channels =
            channels.map(|(name, values)| AnyChannel::new(name.as_str(), FlatSamples::F32(values)));
        let layer = Layer::new(
            (width, height),
            attributes,
            Encoding::UNCOMPRESSED,
            AnyChannels::sort(channels.collect()),
        );
        let refused = |reason: String| RendererError::Encoding {
            path: path.to_owned(),
            reason,
        };
        let mut bytes = Cursor::new(Vec::new());
        let image = Image::from_layer(layer);
        let written = image.write().non_parallel().to_buffered(&mut bytes);
        written.map_err(|error| refused(error.to_string()))?;
        let mut bytes = bytes.into_inner();
        sort_attributes(&mut bytes).ok_or_else(|| refused("a header without an end".to_owned()))?;
        Ok(bytes)
    }
}
