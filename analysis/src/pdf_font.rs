//! The fonts of a PDF: the widths of their glyphs, and the objects that put them into the file.
//!
//! A font is embedded whole, with the widths and the letters of the glyphs that are used, so that text can be searched
//! and copied.
//!
//! Source: ISO 32000-1 (PDF 1.7), sections 9.7, 9.9, 9.10.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Write as _;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use skrifa::instance::{LocationRef, Size};
use skrifa::raw::TableProvider as _;
use skrifa::{FontRef, MetadataProvider as _};

use crate::AnalysisError;
use crate::document::joined;

/// A font and the glyphs of it that are used.
pub(crate) struct PdfFont {
    name: &'static str,
    bytes: &'static [u8],
    font: FontRef<'static>,
    units_per_em: f32,
    used: BTreeMap<u16, char>,
}

impl PdfFont {
    /// A font out of the bytes of its file (TrueType).
    ///
    /// # Errors
    ///
    /// [`AnalysisError::Figure`] if they are none.
    pub(crate) fn new(name: &'static str, bytes: &'static [u8]) -> Result<Self, AnalysisError> {
        let failed = |error: &dyn std::fmt::Display| AnalysisError::Figure(error.to_string());
        let font = FontRef::new(bytes).map_err(|error| failed(&error))?;
        let units_per_em = font.head().map_err(|error| failed(&error))?.units_per_em();
        Ok(Self {
            name,
            bytes,
            font,
            units_per_em: f32::from(units_per_em),
            used: BTreeMap::new(),
        })
    }

    /// The glyph of a sign and its width in ems; `None` where the font lacks it.
    pub(crate) fn glyph(&mut self, sign: char) -> Option<(u16, f32)> {
        let glyph = self.font.charmap().map(sign)?;
        let number = u16::try_from(glyph.to_u32()).ok().filter(|&id| id > 0)?;
        self.used.entry(number).or_insert(sign);
        Some((number, self.width(number)))
    }

    fn width(&self, glyph: u16) -> f32 {
        let metrics = (self.font).glyph_metrics(Size::unscaled(), LocationRef::default());
        let width = metrics.advance_width(skrifa::GlyphId::from(glyph));
        width.unwrap_or(0.0) / self.units_per_em
    }

    /// The five objects of the font, of which the first has the number `first`.
    pub(crate) fn objects(&self, first: usize) -> Vec<Vec<u8>> {
        let [descendant, descriptor, file, unicode] = [1, 2, 3, 4].map(|place| first + place);
        let thousandth = |em: f32| (1000.0 * em).round();
        let widths = joined(self.used.keys(), |&glyph| {
            format!("{glyph} [{}] ", thousandth(self.width(glyph)))
        });
        let metrics = (self.font).metrics(Size::unscaled(), LocationRef::default());
        let of_em = |units: f32| thousandth(units / self.units_per_em);
        let bounds = metrics.bounds.unwrap_or_default();
        let bounds = [bounds.x_min, bounds.y_min, bounds.x_max, bounds.y_max].map(of_em);
        let name = self.name;
        let dictionaries = [
            format!(
                "<< /Type /Font /Subtype /Type0 /BaseFont /{name} /Encoding /Identity-H /DescendantFonts [{descendant} 0 R] \
                 /ToUnicode {unicode} 0 R >>"
            ),
            format!(
                "<< /Type /Font /Subtype /CIDFontType2 /BaseFont /{name} /CIDSystemInfo << /Registry (Adobe) /Ordering (Identity) \
                 /Supplement 0 >> /FontDescriptor {descriptor} 0 R /CIDToGIDMap /Identity /DW 500 /W [{widths}] >>"
            ),
            format!(
                "<< /Type /FontDescriptor /FontName /{name} /Flags 4 /FontBBox [{} {} {} {}] /ItalicAngle 0 /Ascent {} /Descent {} \
                 /CapHeight {} /StemV 70 /FontFile2 {file} 0 R >>",
                bounds[0],
                bounds[1],
                bounds[2],
                bounds[3],
                of_em(metrics.ascent),
                of_em(metrics.descent),
                of_em(metrics.cap_height.unwrap_or(metrics.ascent)),
            ),
        ];
        let mut objects: Vec<Vec<u8>> = dictionaries.map(String::into_bytes).into();
        let length = format!("/Length1 {} ", self.bytes.len());
        objects.push(stream(self.bytes, &length));
        objects.push(stream(self.unicode_map().as_bytes(), ""));
        objects
    }

    /// Which letter each glyph stands for.
    fn unicode_map(&self) -> String {
        let mut map = String::from(
            "/CIDInit /ProcSet findresource begin\n12 dict begin\nbegincmap\n/CIDSystemInfo << /Registry (Adobe) /Ordering (UCS) \
             /Supplement 0 >> def\n/CMapName /Adobe-Identity-UCS def\n/CMapType 2 def\n1 begincodespacerange\n<0000> <FFFF>\n\
             endcodespacerange\n",
        );
        let used: Vec<(&u16, &char)> = self.used.iter().collect();
        for part in used.chunks(100) {
            // Writing to a `String` cannot fail, here and below.
            _ = writeln!(map, "{} beginbfchar", part.len());
            for (glyph, sign) in part {
                let mut units = [0; 2];
                let units = sign.encode_utf16(&mut units);
                let hex = joined(units.iter(), |unit| format!("{unit:04X}"));
                _ = writeln!(map, "<{glyph:04X}> <{hex}>");
            }
            map.push_str("endbfchar\n");
        }
        map.push_str("endcmap\nCMapName currentdict /CMap defineresource pop\nend\nend\n");
        map
    }
}

/// A compressed stream; `more` goes into its dictionary.
pub(crate) fn stream(bytes: &[u8], more: &str) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    // Writing to a `Vec` cannot fail.
    _ = encoder.write_all(bytes);
    let packed = encoder.finish().unwrap_or_default();
    let length = packed.len();
    let mut object =
        format!("<< /Length {length} /Filter /FlateDecode {more}>>\nstream\n").into_bytes();
    object.extend(packed);
    object.extend(b"\nendstream");
    object
}
