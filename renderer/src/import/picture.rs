//! A picture as linear sRGB: from PNG and JPEG (encoded sRGB) or EXR (linear).

use std::io::Cursor;
use std::path::Path;

use exr::prelude::{ReadChannels as _, ReadLayers as _, read};
use image::{DynamicImage, ImageFormat, ImageReader};
use protocols::{InputError, ReadError, Sha256Digest};
use serde::Deserialize;

use super::source::bounded_bytes;
use crate::shader::single;
use crate::srgb::srgb_decoded;

/// No picture of more pixels is read.
const MOST_PIXELS: u64 = 1 << 26;

/// Pixels row by row from the top, linear sRGB.
#[derive(Clone)]
pub(crate) struct Picture {
    pub(crate) size_px: [u32; 2],
    pub(crate) pixels: Vec<[f32; 3]>,
    /// Whether the file says more than these colours: how transparent they are.
    pub(crate) has_alpha: bool,
    /// The digest of the file's bytes.
    pub(crate) sha256: Sha256Digest,
}

impl std::fmt::Debug for Picture {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [width, height] = self.size_px;
        write!(formatter, "Picture({width}x{height})")
    }
}

/// What a texture is outside of the square from 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Wrap {
    /// The picture again and again.
    #[default]
    Repeat,
    /// Again and again, every other time mirrored.
    Mirror,
    /// The colour of its border.
    Clamp,
}

/// What a texture is between its pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Filter {
    /// Straight lines between the middles of pixels.
    #[default]
    Bilinear,
    /// The nearest pixel.
    Nearest,
}

impl Picture {
    /// One black pixel.
    pub(crate) fn black() -> Self {
        Self {
            size_px: [1, 1],
            pixels: vec![[0.0; 3]],
            has_alpha: false,
            sha256: Sha256Digest::of(&[]),
        }
    }

    /// Reads a picture file; `user` names what asks for it.
    ///
    /// # Errors
    ///
    /// If the file is missing, or is no picture of a known format, or an empty or too large one.
    pub(crate) fn read(path: &Path, user: &str) -> Result<Self, ReadError> {
        let bytes = bounded_bytes(path).map_err(|error| match error {
            ReadError::Input(error) => ReadError::Input(error.at(format!("the texture of {user}"))),
            other @ ReadError::Io { .. } => other,
        })?;
        Ok(Self::decode(
            path,
            &format!("the texture of {user}"),
            &bytes,
        )?)
    }

    /// The picture of the bytes of a file, by their first ones.
    ///
    /// # Errors
    ///
    /// As for [`Picture::read`].
    pub(crate) fn decode(file: &Path, place: &str, bytes: &[u8]) -> Result<Self, InputError> {
        let wrong = |found: String| {
            let expected = "a picture (PNG, JPEG or EXR) of at least one pixel";
            InputError::new(file, found, expected).at(place)
        };
        let picture = if bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]) {
            decode_exr(bytes)
        } else {
            decode_encoded(bytes)
        };
        let mut picture = picture.map_err(wrong)?;
        picture.sha256 = Sha256Digest::of(bytes);
        if picture.pixels.is_empty() {
            return Err(wrong("a picture without pixels".to_owned()));
        }
        let is_colour = |pixel: &[f32; 3]| pixel.iter().all(|value| value.is_finite());
        if picture.pixels.iter().all(is_colour) {
            Ok(picture)
        } else {
            Err(wrong("a pixel that is not a number".to_owned()))
        }
    }

    /// The mean colour.
    pub(crate) fn mean(&self) -> [f64; 3] {
        let count = self.pixels.len() as f64;
        [0, 1, 2].map(|primary| {
            let values = self.pixels.iter().map(|pixel| f64::from(pixel[primary]));
            values.sum::<f64>() / count
        })
    }
}

fn check_size(width: u64, height: u64) -> Result<(), String> {
    if width.saturating_mul(height) <= MOST_PIXELS {
        Ok(())
    } else {
        Err(format!("{width}x{height} pixels, more than {MOST_PIXELS}"))
    }
}

fn decode_encoded(bytes: &[u8]) -> Result<Picture, String> {
    let format = image::guess_format(bytes).map_err(|error| error.to_string())?;
    if !matches!(format, ImageFormat::Png | ImageFormat::Jpeg) {
        return Err(format!("a picture of the format {format:?}"));
    }
    let reader = || ImageReader::with_format(Cursor::new(bytes), format);
    let (width, height) = reader()
        .into_dimensions()
        .map_err(|error| error.to_string())?;
    check_size(u64::from(width), u64::from(height))?;
    let image = reader().decode().map_err(|error| error.to_string())?;
    let has_alpha =
        image.color().has_alpha() && image.to_rgba8().pixels().any(|pixel| pixel.0[3] != u8::MAX);
    let pixels = match image {
        DynamicImage::ImageLuma16(_)
        | DynamicImage::ImageLumaA16(_)
        | DynamicImage::ImageRgb16(_)
        | DynamicImage::ImageRgba16(_) => {
            let rgb = image.to_rgb16();
            let linear = |code: u16| single(srgb_decoded(f64::from(code) / 65_535.0));
            rgb.pixels().map(|pixel| pixel.0.map(linear)).collect()
        }
        other => {
            let linear: [f32; 256] =
                std::array::from_fn(|code| single(srgb_decoded(code as f64 / 255.0)));
            let rgb = other.to_rgb8();
            let pixels = rgb.pixels();
            pixels
                .map(|pixel| pixel.0.map(|code| linear[usize::from(code)]))
                .collect()
        }
    };
    Ok(Picture {
        size_px: [width, height],
        pixels,
        has_alpha,
        ..Picture::black()
    })
}

fn decode_exr(bytes: &[u8]) -> Result<Picture, String> {
    let meta = exr::meta::MetaData::read_from_buffered(Cursor::new(bytes), false);
    for header in meta.map_err(|error| error.to_string())?.headers {
        let exr::math::Vec2(width, height) = header.layer_size;
        check_size(width as u64, height as u64)?;
    }
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            |size, _| Picture {
                size_px: [size.0, size.1].map(|side| u32::try_from(side).unwrap_or(u32::MAX)),
                pixels: vec![[0.0; 3]; size.0 * size.1],
                ..Picture::black()
            },
            |picture: &mut Picture, at, (r, g, b): (f32, f32, f32)| {
                let width = picture.size_px[0] as usize;
                picture.pixels[at.1 * width + at.0] = [r, g, b];
            },
        )
        .first_valid_layer()
        .all_attributes()
        .from_buffered(Cursor::new(bytes))
        .map_err(|error| error.to_string())?;
    Ok(image.layer_data.channel_data.pixels)
}
