//! An SVG document as pixels.
//!
//! The only font is the one that comes with the program, so that the picture is the same everywhere.

use resvg::{tiny_skia, usvg};

use crate::AnalysisError;

/// The PNG of an SVG document, `scale` pixels for each user unit.
///
/// # Errors
///
/// [`AnalysisError::Figure`] if the document is no SVG or has no area.
pub(crate) fn png_from_svg(svg: &str, scale: f32) -> Result<Vec<u8>, AnalysisError> {
    let failed = |error: &dyn std::fmt::Display| AnalysisError::Figure(error.to_string());
    let mut options = usvg::Options::default();
    let fonts = options.fontdb_mut();
    fonts.load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
    fonts.set_sans_serif_family("Ubuntu");
    let tree = usvg::Tree::from_str(svg, &options).map_err(|error| failed(&error))?;
    let size = tree
        .size()
        .to_int_size()
        .scale_by(scale)
        .ok_or_else(|| failed(&"it has no area"))?;
    let mut pixels = tiny_skia::Pixmap::new(size.width(), size.height())
        .ok_or_else(|| failed(&"it is too large"))?;
    let transform = tiny_skia::Transform::from_scale(scale, scale);
    resvg::render(&tree, transform, &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| failed(&error))
}
