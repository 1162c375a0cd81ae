//! Further files of an image, for other programs: XYZ, spectral bands, 16-bit sRGB.
//!
//! - **xyz**: EXR with the float channels X, Y, Z of CIE 1931, 2 degrees, linear; Y = 1 for a perfect diffuser
//!   under an illuminance of 1.
//! - **spectral**: EXR after Fichet, Pacanowski & Wilkie (2021), "An `OpenEXR` Layout for Spectral Images", JCGT
//!   10(3), emissive and not polarised: `S0.<wavelength>nm` with a decimal comma, radiance per nm at the middle
//!   of each band, relative as Y is; and R, G, B, linear sRGB, for viewers. It has the rays of A.
//! - **png16**: sRGB, 16 bits, white D65.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ImageBuffer, Rgb};
use protocols::{
    Access, Channel, Export, InputError, ManifestFile, PerChannel, Sha256Digest, write_atomically,
};

use crate::channel_image::ChannelImage;
use crate::error::RendererError;
use crate::float_exr::{self, FloatExr};
use crate::image_record::ImageRecord;
use crate::image_request::ImageRequest;
use crate::opponent::{linear_srgb_from_ac1c2, xyz_from_ac1c2};
use crate::sampler::Sampler;
use crate::screen_tree::ScreenTree;
use crate::shader::single;
use crate::spectral_image::spectral_images;
use crate::srgb::srgb_encode_16;

const XYZ_COMMENTS: &str =
    "X, Y, Z: CIE 1931, 2 degrees, linear; Y = 1 for a perfect diffuser under an illuminance of 1";

const SPECTRAL_COMMENTS: &str = "S0: radiance at the middle of each band, relative: summed with the CIE 1931 functions and divided by \
    the sum of y-bar, 1 for a perfect diffuser under an illuminance of 1. R, G, B: linear sRGB";

/// What an image was made from and what it is.
#[derive(Debug)]
pub(crate) struct Exporter<'a, S> {
    pub(crate) sampler: &'a S,
    pub(crate) tree: &'a ScreenTree,
    pub(crate) request: &'a ImageRequest,
    pub(crate) record: &'a ImageRecord,
    pub(crate) channels: PerChannel<&'a ChannelImage>,
}

impl<S: Sampler> Exporter<'_, S> {
    /// Writes every export of the request beside `image`, whose name gives theirs.
    ///
    /// # Errors
    ///
    /// The sampler has no spectrum to export, or a file could not be made.
    pub(crate) fn write(&self, image: &Path) -> Result<Vec<(Export, ManifestFile)>, RendererError> {
        let write = |&export: &Export| {
            let path = export_path(image, export);
            let bytes = match export {
                Export::Xyz => self.xyz().encode(&path)?,
                Export::Spectral => self.spectral(&path)?.encode(&path)?,
                Export::Png16 => self.png16(&path)?,
            };
            write_atomically(&path, &bytes, Access::Ordinary)
                .map_err(|error| RendererError::writing(&path, error))?;
            let name = path.file_name().unwrap_or_default();
            let file = ManifestFile {
                name: name.to_string_lossy().into_owned(),
                sha256: Sha256Digest::of(&bytes),
            };
            Ok((export, file))
        };
        self.request.exports.iter().map(write).collect()
    }

    /// A function of the opponent channels of each pixel, as three planes.
    fn planes(&self, of_pixel: impl Fn(PerChannel<f64>) -> [f64; 3]) -> [Vec<f32>; 3] {
        let mut planes: [Vec<f32>; 3] = Default::default();
        for pixel in self.pixels() {
            for (plane, value) in planes.iter_mut().zip(of_pixel(pixel)) {
                plane.push(single(value));
            }
        }
        planes
    }

    fn pixels(&self) -> impl Iterator<Item = PerChannel<f64>> {
        (0..self.channels.a.values().len()).map(|pixel| {
            PerChannel::from_fn(|channel: Channel| {
                f64::from(self.channels[channel].values()[pixel])
            })
        })
    }

    fn named(names: [&str; 3], planes: [Vec<f32>; 3]) -> Vec<(String, Cow<'static, [f32]>)> {
        let planes = planes.map(Cow::Owned);
        names.map(str::to_owned).into_iter().zip(planes).collect()
    }

    fn xyz(&self) -> FloatExr<'static> {
        FloatExr {
            size_px: self.channels.a.size_px(),
            channels: Self::named(["X", "Y", "Z"], self.planes(xyz_from_ac1c2)),
            attributes: float_exr::attributes(XYZ_COMMENTS, self.record.texts()),
        }
    }

    fn spectral(&self, path: &Path) -> Result<FloatExr<'static>, RendererError> {
        let nodes_nm = self.sampler.wavelengths_nm();
        if nodes_nm.is_empty() {
            let found = "a picture without a spectrum";
            return Err(InputError::new(path, found, "a scene with spectra").into());
        }
        let reach = self.request.reach(Channel::A);
        let size_px = self.channels.a.size_px();
        let images = spectral_images(self.sampler, self.tree, reach, size_px);
        let bands = nodes_nm.iter().zip(images);
        let bands = bands.map(|(&nm, image)| (band_name(nm), Cow::Owned(image.into_values())));
        let mut channels: Vec<_> = bands.collect();
        channels.extend(Self::named(
            ["R", "G", "B"],
            self.planes(linear_srgb_from_ac1c2),
        ));
        let mut texts = self.record.texts();
        texts.push(("spectralLayoutVersion", "1.0".to_owned()));
        texts.push(("emissiveUnits", "W.m^-2.sr^-1.nm^-1".to_owned()));
        Ok(FloatExr {
            size_px,
            channels,
            attributes: float_exr::attributes(SPECTRAL_COMMENTS, texts),
        })
    }

    fn png16(&self, path: &Path) -> Result<Vec<u8>, RendererError> {
        let refused = |reason: String| RendererError::Encoding {
            path: path.to_owned(),
            reason,
        };
        let [width, height] = self.channels.a.size_px();
        let codes = self
            .pixels()
            .flat_map(|pixel| linear_srgb_from_ac1c2(pixel).map(srgb_encode_16));
        let picture = ImageBuffer::<Rgb<u16>, Vec<u16>>::from_raw(width, height, codes.collect());
        let picture = picture.ok_or_else(|| refused("too few pixels".to_owned()))?;
        let mut bytes = Vec::new();
        let encoder =
            PngEncoder::new_with_quality(&mut bytes, CompressionType::Fast, FilterType::Adaptive);
        let written = picture.write_with_encoder(encoder);
        written.map_err(|error| refused(error.to_string()))?;
        Ok(bytes)
    }
}

/// The file of an export: `picture.exr` has `picture.xyz.exr`, `picture.spectral.exr` and `picture.16.png`.
fn export_path(image: &Path, export: Export) -> PathBuf {
    image.with_extension(match export {
        Export::Xyz => "xyz.exr",
        Export::Spectral => "spectral.exr",
        Export::Png16 => "16.png",
    })
}

/// The name of the channel of a wavelength: `S0.409,375nm`, to four decimals without zeros at the end.
fn band_name(nm: f64) -> String {
    let digits = format!("{nm:.4}");
    let digits = digits.trim_end_matches('0').trim_end_matches('.');
    format!("S0.{}nm", digits.replace('.', ","))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the rule of the layout: the dot is what parts layers in EXR, so the decimals stand after a comma.
    #[test]
    fn a_wavelength_is_named_with_a_decimal_comma() {
        assert_eq!(band_name(650.5), "S0.650,5nm");
        assert_eq!(band_name(409.375), "S0.409,375nm");
        assert_eq!(band_name(500.0), "S0.500nm");
        assert_eq!(band_name(400.498_338_870_4), "S0.400,4983nm");
    }
}
