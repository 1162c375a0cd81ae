//! An SVG document as pixels, as outlines, and as PDF.
//!
//! The only font is the one that comes with the program, so that the picture is the same everywhere.

use resvg::{tiny_skia, usvg};

use crate::AnalysisError;
use crate::pdf::pdf_of;

/// Pixels of a PNG for each user unit: a unit is a hundredth of an inch, so that 300 dots make an inch.
const PIXELS_PER_UNIT: f32 = 3.0;
/// 300 dots an inch, by the metre.
const DOTS_PER_METRE: u32 = 11_811;

/// A figure, ready to be written in any format.
#[derive(Debug)]
pub(crate) struct FigurePicture {
    tree: usvg::Tree,
}

impl FigurePicture {
    /// Reads an SVG document.
    ///
    /// # Errors
    ///
    /// [`AnalysisError::Figure`] if the document is no SVG.
    pub(crate) fn new(svg: &str) -> Result<Self, AnalysisError> {
        let mut options = usvg::Options::default();
        let fonts = options.fontdb_mut();
        fonts.load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
        fonts.set_sans_serif_family("Ubuntu");
        let tree = usvg::Tree::from_str(svg, &options).map_err(failed)?;
        Ok(Self { tree })
    }

    /// The picture as a tree of paths and texts.
    pub(crate) const fn tree(&self) -> &usvg::Tree {
        &self.tree
    }

    /// The PNG, at 300 dots an inch.
    ///
    /// # Errors
    ///
    /// [`AnalysisError::Figure`] if the picture has no area or is too large.
    pub(crate) fn to_png(&self) -> Result<Vec<u8>, AnalysisError> {
        let size = (self.tree.size().to_int_size()).scale_by(PIXELS_PER_UNIT);
        let size = size.ok_or_else(|| failed("it has no area"))?;
        let mut pixels = tiny_skia::Pixmap::new(size.width(), size.height())
            .ok_or_else(|| failed("it is too large"))?;
        let transform = tiny_skia::Transform::from_scale(PIXELS_PER_UNIT, PIXELS_PER_UNIT);
        resvg::render(&self.tree, transform, &mut pixels.as_mut());
        let png = pixels.encode_png().map_err(failed)?;
        Ok(with_resolution(png))
    }

    /// The same picture as SVG with its words as outlines, for programs without the font.
    pub(crate) fn to_outlines(&self) -> String {
        self.tree.to_string(&usvg::WriteOptions::default())
    }

    /// The PDF: one page of the size of the picture, its words as outlines.
    pub(crate) fn to_pdf(&self) -> Vec<u8> {
        pdf_of(&self.tree)
    }
}

fn failed(error: impl std::fmt::Display) -> AnalysisError {
    AnalysisError::Figure(error.to_string())
}

/// A PNG with a `pHYs` chunk after its header, which has 33 bytes with the signature.
///
/// Source: *Portable Network Graphics (PNG) Specification*, 3rd ed., section 11.3.4.3.
fn with_resolution(png: Vec<u8>) -> Vec<u8> {
    let mut chunk = b"pHYs".to_vec();
    for _ in 0..2 {
        chunk.extend(DOTS_PER_METRE.to_be_bytes());
    }
    chunk.push(1); // The unit is the metre.
    let mut with = png;
    let mut inserted = 9_u32.to_be_bytes().to_vec();
    inserted.extend(&chunk);
    inserted.extend(crc32(&chunk).to_be_bytes());
    with.splice(33..33, inserted);
    with
}

/// The check sum of PNG: CRC-32 (ISO 3309).
fn crc32(bytes: &[u8]) -> u32 {
    let step = |crc: u32, byte: &u8| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| {
            (crc >> 1) ^ (0xedb8_8320 & (crc & 1).wrapping_neg())
        })
    };
    !bytes.iter().fold(u32::MAX, step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_check_sum_is_that_of_the_standard() {
        // The check value of CRC-32 for "123456789": Cook, "Catalogue of parametrised CRC algorithms".
        assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
    }
}
