//! One channel as a grey picture: A as luminance, C1 and C2 with mid-grey at zero.

use std::fmt;

use protocols::{Channel, ChannelGroup};

use crate::channel_image::ChannelImage;
use crate::srgb::srgb_encode;
use crate::srgb_png::SrgbImage;

/// The code of zero in a chromatic channel.
const MID_GREY: f64 = 128.0;

/// How the values of a channel become grey.
#[derive(Clone, Copy, Debug)]
pub(super) struct GreyScale {
    channel: Channel,
    /// The value that is white; in a chromatic channel its negative is black.
    white: f64,
}

impl GreyScale {
    /// The scale on which this image uses the whole range, but no more than sRGB can have.
    pub(super) fn of(channel: Channel, image: &ChannelImage) -> Self {
        let largest = image.values().iter().map(|value| f64::from(value.abs()));
        let largest = largest.fold(0.01, f64::max);
        // The corners of the sRGB cube: C1 from -.398 to +.368, C2 from -.014 to +.568.
        let white = match channel {
            Channel::A => 1.0,
            Channel::C1 => largest.min(0.398),
            Channel::C2 => largest.min(0.568),
        };
        Self { channel, white }
    }

    pub(super) fn picture(self, image: &ChannelImage) -> SrgbImage {
        let codes = image
            .values()
            .iter()
            .map(|&value| self.code(f64::from(value)));
        SrgbImage {
            size_px: image.size_px(),
            bytes: codes.flat_map(|code| [code; 3]).collect(),
            out_of_gamut_px: 0,
        }
    }

    fn code(self, value: f64) -> u8 {
        let share = value / self.white;
        match self.channel.group() {
            ChannelGroup::Achromatic => srgb_encode(share),
            ChannelGroup::Chromatic => {
                let code = (MID_GREY + 127.0 * share).clamp(0.0, 255.0);
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "from 0 to 255 after the clamp"
                )]
                let rounded = (code + 0.5) as u8;
                rounded
            }
        }
    }
}

impl fmt::Display for GreyScale {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.channel.group() {
            ChannelGroup::Achromatic => write!(formatter, "{}: black 0, white 1", self.channel),
            ChannelGroup::Chromatic => {
                let Self { channel, white } = self;
                write!(
                    formatter,
                    "{channel}: grey 0, black \u{2212}{white:.2}, white +{white:.2}"
                )
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zero_chroma_is_mid_grey_and_the_largest_value_is_an_end() {
        let image = ChannelImage::new([4, 1], vec![0.0, -0.2, 0.1, 0.2]).unwrap();
        let picture = GreyScale::of(Channel::C1, &image).picture(&image);
        let codes: Vec<u8> = picture.bytes.iter().copied().step_by(3).collect();
        // 128 ± 127 and 128 + 127/2 = 191.5, rounded up.
        assert_eq!(codes, [128, 1, 192, 255]);
    }

    #[test]
    fn a_is_shown_as_the_luminance_that_it_is() {
        let image = ChannelImage::new([3, 1], vec![0.0, 0.215_860_5, 1.0]).unwrap();
        let picture = GreyScale::of(Channel::A, &image).picture(&image);
        // sRGB codes of black, of 0.2158605 (128 by the formula of the standard) and of white.
        assert_eq!(picture.bytes, [0, 0, 0, 128, 128, 128, 255, 255, 255]);
    }
}
