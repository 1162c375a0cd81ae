//! Opponent channels as an 8-bit sRGB picture, and PNG files.
//!
//! The transfer curve is only evaluated for the 255 steps between codes: a primary is then looked up among
//! them, which gives the codes of [`srgb_encode`] at a small part of its cost.

use std::path::Path;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder as _};
use protocols::PerChannel;

use crate::channel_image::ChannelImage;
use crate::error::RendererError;
use crate::opponent::linear_srgb_from_ac1c2;
use crate::srgb::{is_out_of_srgb_gamut, srgb_encode};

/// A picture as a display is given it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SrgbImage {
    /// Width and height.
    pub size_px: [u32; 2],
    /// Red, green and blue of each pixel, row by row from the top.
    pub bytes: Vec<u8>,
    /// How many pixels had to be clipped to the gamut.
    pub out_of_gamut_px: u32,
}

/// Into so many parts the linear range is divided to look a code up: a power of 2, so that a place is found
/// without rounding, and so many that none holds two steps, since the curve is nowhere steeper than 12.92.
const PARTS: usize = 4096;

/// Turns opponent channels into sRGB codes.
#[derive(Clone, Debug)]
pub struct SrgbEncoder {
    /// The least linear primary of the next code, for each code.
    steps: [f64; 256],
    /// The code at the beginning of each of [`PARTS`] equal parts of the linear range, and at its end.
    codes: [u8; PARTS + 1],
    /// The least and the greatest linear primary that is not clipped.
    gamut: [f64; 2],
}

impl SrgbEncoder {
    /// Finds the steps of the transfer curve.
    pub fn new() -> Self {
        let is_shown = |linear: f64| !is_out_of_srgb_gamut([linear, 0.5, 0.5]);
        let step = |code| match code {
            255 => f64::INFINITY,
            _ => least(0.0, 1.0, |linear| usize::from(srgb_encode(linear)) > code),
        };
        let steps = std::array::from_fn(step);
        let code = |part| {
            let linear = part as f64 / PARTS as f64;
            let steps_below = steps.partition_point(|&step| step <= linear);
            u8::try_from(steps_below).unwrap_or(u8::MAX)
        };
        Self {
            steps,
            codes: std::array::from_fn(code),
            gamut: [
                least(-1.0, 0.5, is_shown),
                -least(-2.0, -0.5, |negated| is_shown(-negated)),
            ],
        }
    }

    /// The picture of three channels of the same size.
    pub fn encode(&self, channels: PerChannel<&ChannelImage>) -> SrgbImage {
        let PerChannel { a, c1, c2 } = channels;
        let mut bytes = vec![0; 3 * a.values().len()];
        let mut strip = Strip::default();
        let mut out_of_gamut_px = 0;
        let [a, c1, c2] = [a, c1, c2].map(|channel| channel.values().chunks(STRIP_PX));
        for (((a, c1), c2), codes) in a.zip(c1).zip(c2).zip(bytes.chunks_mut(3 * STRIP_PX)) {
            strip.set(a, c1, c2);
            out_of_gamut_px += strip.out_of_gamut_px(a.len(), self.gamut);
            strip.find_parts();
            for (pixel, codes) in codes.as_chunks_mut::<3>().0.iter_mut().enumerate() {
                for (primary, code) in codes.iter_mut().enumerate() {
                    *code = self.code(strip.linear[primary][pixel], strip.parts[primary][pixel]);
                }
            }
        }
        SrgbImage {
            size_px: channels.a.size_px(),
            bytes,
            out_of_gamut_px,
        }
    }

    /// The code of a linear primary that lies in this part.
    fn code(&self, linear: f64, part: i32) -> u8 {
        let part = usize::try_from(part).unwrap_or(0).min(PARTS);
        let code = self.codes[part];
        code + u8::from(self.steps[usize::from(code)] <= linear)
    }
}

/// Pixels that are worked on at a time, step by step, so that each step is done for several pixels at once.
const STRIP_PX: usize = 64;

/// Some pixels on their way to codes.
struct Strip {
    /// Red, green and blue.
    linear: [[f64; STRIP_PX]; 3],
    /// In which of [`PARTS`] each of them lies.
    parts: [[i32; STRIP_PX]; 3],
}

impl Default for Strip {
    fn default() -> Self {
        Self {
            linear: [[0.0; STRIP_PX]; 3],
            parts: [[0; STRIP_PX]; 3],
        }
    }
}

impl Strip {
    /// The linear primaries of as many pixels as there are.
    fn set(&mut self, a: &[f32], c1: &[f32], c2: &[f32]) {
        let [red, green, blue] = &mut self.linear;
        let linear = red.iter_mut().zip(green).zip(blue);
        for ((((red, green), blue), (&a, &c1)), &c2) in linear.zip(a.iter().zip(c1)).zip(c2) {
            [*red, *green, *blue] = linear_srgb_from_ac1c2(PerChannel {
                a: f64::from(a),
                c1: f64::from(c1),
                c2: f64::from(c2),
            });
        }
    }

    /// How many of the first pixels have a primary outside of these limits.
    fn out_of_gamut_px(&self, pixels: usize, [least, greatest]: [f64; 2]) -> u32 {
        let [red, green, blue] = &self.linear;
        let linear = red.iter().zip(green).zip(blue).take(pixels);
        let is_shown = |primary: &f64| (least..=greatest).contains(primary);
        let count =
            |((red, green), blue)| u32::from(!(is_shown(red) & is_shown(green) & is_shown(blue)));
        linear.map(count).sum()
    }

    fn find_parts(&mut self) {
        for (linear, parts) in self.linear.iter().zip(&mut self.parts) {
            for (linear, part) in linear.iter().zip(parts) {
                *part = part_of(*linear);
            }
        }
    }
}

fn part_of(linear: f64) -> i32 {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "rounded down on purpose, from 0 to PARTS after the clamp"
    )]
    let part = (linear.clamp(0.0, 1.0) * PARTS as f64) as i32;
    part
}

impl Default for SrgbEncoder {
    fn default() -> Self {
        Self::new()
    }
}

/// The least number from `from` to `to` of which `is_beyond` holds, which must hold of all above.
fn least(mut from: f64, mut to: f64, is_beyond: impl Fn(f64) -> bool) -> f64 {
    loop {
        let middle = f64::midpoint(from, to);
        if middle <= from || middle >= to {
            return to;
        }
        if is_beyond(middle) {
            to = middle;
        } else {
            from = middle;
        }
    }
}

impl SrgbImage {
    /// The bytes of the PNG file; `path` is only named in errors.
    ///
    /// # Errors
    ///
    /// [`RendererError::Encoding`] if the encoder refuses the image.
    pub(crate) fn to_png(&self, path: &Path) -> Result<Vec<u8>, RendererError> {
        let mut bytes = Vec::new();
        let encoder =
            PngEncoder::new_with_quality(&mut bytes, CompressionType::Fast, FilterType::Adaptive);
        let [width, height] = self.size_px;
        encoder
            .write_image(&self.bytes, width, height, ExtendedColorType::Rgb8)
            .map_err(|error| RendererError::Encoding {
                path: path.to_owned(),
                reason: error.to_string(),
            })?;
        Ok(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The plain way is the transfer curve itself, for every pixel.
    #[test]
    fn looked_up_codes_are_those_of_the_curve() {
        let encoder = SrgbEncoder::new();
        for place in -20_000..=120_000 {
            // A step that meets no code boundary exactly, over and beyond the whole range.
            let linear = f64::from(place) * 1.000_013e-5;
            let code = encoder.code(linear, part_of(linear));
            assert_eq!(code, srgb_encode(linear), "{linear}");
        }
    }

    #[test]
    fn clipped_pixels_are_those_out_of_gamut() {
        let encoder = SrgbEncoder::new();
        let values = |step: f32| (0..10_000_u16).map(|i| f32::from(i) * step).collect();
        let [a, c1, c2] = [1.2e-4, -0.4e-4, 0.6e-4]
            .map(|step| ChannelImage::new([100, 100], values(step)).unwrap());
        let picture = encoder.encode(PerChannel {
            a: &a,
            c1: &c1,
            c2: &c2,
        });
        let expected = (0..10_000)
            .filter(|&i| {
                is_out_of_srgb_gamut(linear_srgb_from_ac1c2(PerChannel {
                    a: f64::from(a.values()[i]),
                    c1: f64::from(c1.values()[i]),
                    c2: f64::from(c2.values()[i]),
                }))
            })
            .count();
        assert!(expected > 100);
        assert_eq!(picture.out_of_gamut_px as usize, expected);
    }

    #[test]
    fn a_png_is_read_back_as_it_was_written() {
        let picture = SrgbImage {
            size_px: [7, 5],
            bytes: (0..105).map(|place| place * 2).collect(),
            out_of_gamut_px: 0,
        };
        let bytes = picture.to_png(Path::new("x.png")).unwrap();
        let read = image::load_from_memory(&bytes).unwrap().into_rgb8();
        assert_eq!((read.width(), read.height()), (7, 5));
        assert_eq!(read.into_raw(), picture.bytes);
    }
}
