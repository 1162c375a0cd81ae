//! A sheet of pictures in rows, each with a heading, under a title.
//!
//! The text is drawn as SVG; the pictures are then copied in, pixel for pixel.

use std::fmt::Write as _;
use std::path::Path;

use super::rasterizer::{FONT_FAMILY, Rasterizer};
use crate::error::RendererError;
use crate::srgb_png::SrgbImage;

const MARGIN_PX: u32 = 20;
const GAP_PX: u32 = 12;
const TITLE_PX: u32 = 26;
const HEADING_PX: u32 = 18;
/// A line of headings with the space around it.
const HEADING_ROW_PX: u32 = 32;
const ROW_HEADING_WIDTH_PX: u32 = 48;

/// A picture and what stands above it.
#[derive(Clone, Debug)]
pub(super) struct Tile {
    pub(super) heading: String,
    pub(super) picture: SrgbImage,
}

/// Pictures of one size in rows of one length.
#[derive(Clone, Debug)]
pub(super) struct Sheet {
    pub(super) title: String,
    /// One for each row, to its left; all empty for none.
    pub(super) row_headings: Vec<String>,
    pub(super) rows: Vec<Vec<Tile>>,
}

impl Sheet {
    /// The bytes of the PNG file; `path` is only named in errors.
    pub(super) fn png(
        &self,
        rasterizer: &Rasterizer,
        path: &Path,
    ) -> Result<Vec<u8>, RendererError> {
        let mut sheet = rasterizer.picture(&self.svg(), 1.0, path)?;
        for (row, tiles) in (0..).zip(&self.rows) {
            for (column, tile) in (0..).zip(tiles) {
                copy(&tile.picture, &mut sheet, self.corner(row, column));
            }
        }
        sheet.to_png(path)
    }

    fn tile_px(&self) -> [u32; 2] {
        let first = self.rows.first().and_then(|row| row.first());
        first.map_or([1, 1], |tile| tile.picture.size_px)
    }

    fn row_heading_width_px(&self) -> u32 {
        let has_any = self.row_headings.iter().any(|heading| !heading.is_empty());
        if has_any { ROW_HEADING_WIDTH_PX } else { 0 }
    }

    /// The upper left pixel of a picture.
    fn corner(&self, row: u32, column: u32) -> [u32; 2] {
        let [width, height] = self.tile_px();
        let left = MARGIN_PX + self.row_heading_width_px() + column * (width + GAP_PX);
        let top = MARGIN_PX + TITLE_PX + (row + 1) * HEADING_ROW_PX + row * (height + GAP_PX);
        [left, top]
    }

    fn svg(&self) -> String {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let [columns, rows] = [columns, self.rows.len()].map(|n| u32::try_from(n).unwrap_or(1));
        let [tile_width, tile_height] = self.tile_px();
        let [left, top] = self.corner(rows.saturating_sub(1), columns.saturating_sub(1));
        let (width, height) = (left + tile_width + MARGIN_PX, top + tile_height + MARGIN_PX);
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             font-family=\"{FONT_FAMILY}\" fill=\"#111\">"
        );
        let mut text = |x: u32, y: u32, size: u32, words: &str| {
            let words = words.replace('&', "&amp;").replace('<', "&lt;");
            // Writing to a `String` cannot fail.
            _ = write!(
                svg,
                "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\">{words}</text>"
            );
        };
        text(
            MARGIN_PX,
            MARGIN_PX + TITLE_PX - 4,
            TITLE_PX - 2,
            &self.title,
        );
        for (row, (tiles, heading)) in (0..).zip(self.rows.iter().zip(&self.row_headings)) {
            let [_, middle] = self.corner(row, 0);
            text(MARGIN_PX, middle + tile_height / 2, TITLE_PX, heading);
            for (column, tile) in (0..).zip(tiles) {
                let [left, top] = self.corner(row, column);
                text(left, top - 8, HEADING_PX, &tile.heading);
            }
        }
        svg.push_str("</svg>");
        svg
    }
}

/// Copies all pixels of a picture into a larger one.
pub(super) fn copy(picture: &SrgbImage, sheet: &mut SrgbImage, [left, top]: [u32; 2]) {
    let [width, sheet_width] = [picture, &*sheet].map(|image| image.size_px[0] as usize);
    let rows = picture.bytes.chunks_exact(3 * width);
    for (row, pixels) in (top as usize..).zip(rows) {
        let start = 3 * (row * sheet_width + left as usize);
        sheet.bytes[start..start + pixels.len()].copy_from_slice(pixels);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_stand_in_the_sheet_pixel_for_pixel_and_text_beside_them() {
        let tile = |seed: u8| Tile {
            heading: "A & B".to_owned(),
            picture: SrgbImage {
                size_px: [30, 20],
                bytes: (0..1800_u16).map(|i| (i % 251) as u8 ^ seed).collect(),
                out_of_gamut_px: 0,
            },
        };
        let sheet = Sheet {
            title: "Two rows".to_owned(),
            row_headings: vec!["one".to_owned(), "two".to_owned()],
            rows: vec![vec![tile(1), tile(2)], vec![tile(3), tile(4)]],
        };
        let png = sheet.png(&Rasterizer::new(), Path::new("x.png")).unwrap();
        let drawn = image::load_from_memory(&png).unwrap().into_rgb8();
        for (row, tiles) in (0..).zip(&sheet.rows) {
            for (column, tile) in (0..).zip(tiles) {
                let [left, top] = sheet.corner(row, column);
                let view = image::imageops::crop_imm(&drawn, left, top, 30, 20).to_image();
                assert!(view.into_raw() == tile.picture.bytes);
            }
        }
        let dark = |pixel: &&image::Rgb<u8>| pixel.0.iter().all(|&code| code < 100);
        let title = image::imageops::crop_imm(&drawn, 20, 20, 100, TITLE_PX).to_image();
        assert!(title.pixels().filter(dark).count() > 30, "no title is seen");
    }
}
