//! SVG to pixels with the fonts that the program carries, so that a figure looks the same on any machine.

use std::path::Path;
use std::sync::Arc;

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};

use crate::error::RendererError;
use crate::srgb_png::SrgbImage;

/// The family of all text in figures.
pub(super) const FONT_FAMILY: &str = "Ubuntu";

/// Draws SVG.
pub(super) struct Rasterizer {
    options: Options<'static>,
}

impl Rasterizer {
    pub(super) fn new() -> Self {
        let mut fonts = fontdb::Database::new();
        fonts.load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
        fonts.set_sans_serif_family(FONT_FAMILY);
        Self {
            options: Options {
                font_family: FONT_FAMILY.to_owned(),
                fontdb: Arc::new(fonts),
                ..Options::default()
            },
        }
    }

    /// The picture of an SVG, with `scale` pixels for each of its units, on white.
    pub(super) fn picture(
        &self,
        svg: &str,
        scale: f32,
        path: &Path,
    ) -> Result<SrgbImage, RendererError> {
        let refused = |reason: String| RendererError::Encoding {
            path: path.to_owned(),
            reason,
        };
        let tree =
            Tree::from_str(svg, &self.options).map_err(|error| refused(error.to_string()))?;
        let size = tree.size().to_int_size().scale_by(scale);
        let pixmap = size.and_then(|size| Pixmap::new(size.width(), size.height()));
        let mut pixmap = pixmap.ok_or_else(|| refused("a figure without pixels".to_owned()))?;
        pixmap.fill(resvg::tiny_skia::Color::WHITE);
        resvg::render(
            &tree,
            Transform::from_scale(scale, scale),
            &mut pixmap.as_mut(),
        );
        let opaque = pixmap.pixels().iter();
        Ok(SrgbImage {
            size_px: [pixmap.width(), pixmap.height()],
            bytes: opaque
                .flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue()])
                .collect(),
            out_of_gamut_px: 0,
        })
    }

    /// The same as the bytes of a PNG file.
    pub(super) fn png(&self, svg: &str, scale: f32, path: &Path) -> Result<Vec<u8>, RendererError> {
        self.picture(svg, scale, path)?.to_png(path)
    }
}
