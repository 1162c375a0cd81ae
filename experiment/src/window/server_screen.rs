//! What the X server holds for the screen, asked of the server itself.
//!
//! The graphics library gives back what was drawn. What becomes of it on the way to the screen (a display of 16 bits a
//! pixel, another window in front, a desktop that composes windows anew) only the server knows. It is asked once,
//! before the first screen, on a connection of its own.
//!
//! Not here: what follows the server's memory (tables of the graphics card, the cable, the monitor); on Wayland the X
//! server does not know the screen and is not asked.

use std::env;

use eframe::egui::{Color32, ColorImage};
use x11rb::connection::Connection as _;
use x11rb::protocol::xproto::{ConnectionExt as _, ImageFormat, ImageOrder, Setup, VisualClass};
use x11rb::rust_connection::RustConnection;

/// A connection to the server, and how its pixels are packed.
#[derive(Debug)]
pub(crate) struct ServerScreen {
    connection: RustConnection,
    root: u32,
    packing: Packing,
}

/// How a pixel of the screen stands in the bytes of an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Packing {
    bytes: usize,
    /// A line of pixels takes a whole number of so many bytes.
    line_bytes: usize,
    is_most_significant_first: bool,
    /// Which bits are red, green and blue.
    masks: [u32; 3],
}

impl ServerScreen {
    /// Connects to the server of the display.
    ///
    /// # Errors
    ///
    /// Why the server cannot be asked, in words.
    pub(crate) fn open() -> Result<Self, String> {
        if env::var_os("WAYLAND_DISPLAY").is_some_and(|display| !display.is_empty()) {
            return Err("on Wayland it does not know the screen".to_owned());
        }
        let (connection, screen) =
            RustConnection::connect(None).map_err(|error| error.to_string())?;
        let is_of_wayland = connection
            .query_extension(b"XWAYLAND")
            .ok()
            .and_then(|asked| asked.reply().ok())
            .is_some_and(|reply| reply.present);
        if is_of_wayland {
            return Err("on Wayland it does not know the screen".to_owned());
        }
        let packing = Packing::of(connection.setup(), screen)
            .ok_or_else(|| "its pixels are not of red, green and blue".to_owned())?;
        let root = connection.setup().roots[screen].root;
        Ok(Self {
            connection,
            root,
            packing,
        })
    }

    /// The pixels of a rectangle of the screen; nothing if it is not wholly on it.
    pub(crate) fn part(
        &self,
        [left, top]: [i16; 2],
        [width, height]: [u16; 2],
    ) -> Option<ColorImage> {
        let asked = self.connection.get_image(
            ImageFormat::Z_PIXMAP,
            self.root,
            left,
            top,
            width,
            height,
            u32::MAX,
        );
        let reply = asked.ok()?.reply().ok()?;
        self.packing
            .image(&reply.data, [width, height].map(usize::from))
    }
}

impl Packing {
    fn of(setup: &Setup, screen: usize) -> Option<Self> {
        let screen = setup.roots.get(screen)?;
        let visuals = screen
            .allowed_depths
            .iter()
            .flat_map(|depth| &depth.visuals);
        let visual = visuals
            .filter(|visual| visual.class == VisualClass::TRUE_COLOR)
            .find(|visual| visual.visual_id == screen.root_visual)?;
        let mut formats = setup.pixmap_formats.iter();
        let format = formats.find(|format| format.depth == screen.root_depth)?;
        let bytes = usize::from(format.bits_per_pixel / 8);
        matches!(bytes, 2..=4).then(|| Self {
            bytes,
            line_bytes: usize::from(format.scanline_pad / 8).max(1),
            is_most_significant_first: setup.image_byte_order == ImageOrder::MSB_FIRST,
            masks: [visual.red_mask, visual.green_mask, visual.blue_mask],
        })
    }

    fn image(self, data: &[u8], [width, height]: [usize; 2]) -> Option<ColorImage> {
        let line = (width * self.bytes).next_multiple_of(self.line_bytes);
        let mut pixels = Vec::with_capacity(width * height);
        for bytes in data.chunks_exact(line).take(height) {
            let row = bytes.chunks_exact(self.bytes).take(width);
            pixels.extend(row.map(|pixel| self.color(pixel)));
        }
        (pixels.len() == width * height).then(|| ColorImage::new([width, height], pixels))
    }

    fn color(self, bytes: &[u8]) -> Color32 {
        let join = |pixel: u32, byte: &u8| pixel << 8 | u32::from(*byte);
        let pixel = if self.is_most_significant_first {
            bytes.iter().fold(0, join)
        } else {
            bytes.iter().rev().fold(0, join)
        };
        let [red, green, blue] = self.masks.map(|mask| level(pixel, mask));
        Color32::from_rgb(red, green, blue)
    }
}

/// The nearest of 256 levels to the part that the bits under the mask have of their whole.
fn level(pixel: u32, mask: u32) -> u8 {
    let shift = mask.trailing_zeros();
    let most = u64::from(mask.checked_shr(shift).unwrap_or(0)).max(1);
    let value = u64::from((pixel & mask).checked_shr(shift).unwrap_or(0));
    u8::try_from((2 * 255 * value + most) / (2 * most)).unwrap_or(u8::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRUE_COLOR: Packing = Packing {
        bytes: 4,
        line_bytes: 4,
        is_most_significant_first: false,
        masks: [0xff_0000, 0xff00, 0xff],
    };

    #[test]
    fn pixels_of_24_bits_are_their_bytes_in_either_order() {
        let bytes = [3, 2, 1, 0, 6, 5, 4, 0];
        let image = TRUE_COLOR.image(&bytes, [1, 2]).unwrap();
        let expected = [Color32::from_rgb(1, 2, 3), Color32::from_rgb(4, 5, 6)];
        assert_eq!(image.pixels, expected);
        let turned = Packing {
            is_most_significant_first: true,
            ..TRUE_COLOR
        };
        let image = turned.image(&[0, 1, 2, 3, 0, 4, 5, 6], [2, 1]).unwrap();
        assert_eq!(image.pixels, expected);
        assert!(TRUE_COLOR.image(&bytes, [2, 2]).is_none(), "too few bytes");
    }

    /// 16 bits: 31 or 63 levels above black. 16/31 of 255 is 131.6, 32/63 of 255 is 129.5. Lines are padded.
    #[test]
    fn pixels_of_16_bits_are_the_nearest_of_256_levels() {
        let packing = Packing {
            bytes: 2,
            masks: [0xf800, 0x07e0, 0x001f],
            ..TRUE_COLOR
        };
        let bytes = [0x10, 0x84, 0, 0, 0xff, 0xff, 0, 0];
        let image = packing.image(&bytes, [1, 2]).unwrap();
        let expected = [Color32::from_rgb(132, 130, 132), Color32::WHITE];
        assert_eq!(image.pixels, expected);
        // Ten bits: 1023 levels above black hold each of 255.
        for level_of_8 in 0..=255_u32 {
            let ten = (level_of_8 * 1023 + 127) / 255;
            assert_eq!(u32::from(level(ten << 20, 0x3ff0_0000)), level_of_8);
        }
    }
}
