//! Text of a PDF: rich text as words of known width, lines of words, and the operators that set them.

use std::fmt::Write as _;

use crate::AnalysisError;
use crate::pdf_font::PdfFont;
use crate::rich_text::{Look, Place, runs};

/// The width of a space, in ems.
const SPACE: f32 = 0.26;
/// Signs below and above the line are smaller by this.
const SMALL: f32 = 0.7;
/// The slant of italics: the tangent of 11°.
const SLANT: f32 = 0.194;
/// What stands for a sign that no font has.
const UNKNOWN: char = '?';

/// The fonts of a document: one for text, one for code.
pub(crate) struct Fonts {
    fonts: [PdfFont; 2],
}

/// Glyphs of one font and one look.
#[derive(Clone, Debug)]
struct Run {
    font: usize,
    look: Look,
    hex: String,
    width_em: f32,
}

/// Glyphs that stay together on a line.
#[derive(Clone, Debug, Default)]
pub(crate) struct Word {
    runs: Vec<Run>,
}

impl Run {
    /// The width where a line has size 1.
    fn width(&self) -> f32 {
        self.width_em * self.scale()
    }

    fn scale(&self) -> f32 {
        let code = if self.look.is_code { 0.85 } else { 1.0 };
        match self.look.place {
            Place::Line => code,
            Place::Below | Place::Above => code * SMALL,
        }
    }

    const fn rise(&self) -> f32 {
        match self.look.place {
            Place::Line => 0.0,
            Place::Below => -0.18,
            Place::Above => 0.34,
        }
    }
}

impl Word {
    /// The width where the text has size 1.
    pub(crate) fn width(&self) -> f32 {
        self.runs.iter().map(Run::width).sum()
    }
}

/// The width of words with spaces between them, at size 1.
pub(crate) fn width(words: &[Word]) -> f32 {
    let spaces = words.len().saturating_sub(1) as f32;
    words.iter().map(Word::width).sum::<f32>() + SPACE * spaces
}

impl Fonts {
    /// The fonts that come with the program.
    ///
    /// # Errors
    ///
    /// They cannot be read.
    pub(crate) fn new() -> Result<Self, AnalysisError> {
        Ok(Self {
            fonts: [
                PdfFont::new("Ubuntu-Light", epaint_default_fonts::UBUNTU_LIGHT)?,
                PdfFont::new("Hack-Regular", epaint_default_fonts::HACK_REGULAR)?,
            ],
        })
    }

    /// The objects of all fonts, of which the first has the number `first`, and their dictionary.
    pub(crate) fn objects(&self, first: usize) -> (Vec<Vec<u8>>, String) {
        let (mut objects, mut dictionary) = (Vec::new(), String::new());
        for (place, font) in self.fonts.iter().enumerate() {
            let number = first + objects.len();
            // Writing to a `String` cannot fail.
            _ = write!(dictionary, "/F{place} {number} 0 R ");
            objects.extend(font.objects(number));
        }
        (objects, dictionary)
    }

    /// Rich text as words; a no-break space holds words together.
    pub(crate) fn words(&mut self, rich: &str) -> Vec<Word> {
        let (mut words, mut word) = (Vec::new(), Word::default());
        for (look, text) in runs(rich) {
            for sign in text.chars() {
                if !matches!(sign, ' ' | '\n') {
                    self.push(&mut word, look, sign);
                } else if !word.runs.is_empty() {
                    words.push(std::mem::take(&mut word));
                }
            }
        }
        if !word.runs.is_empty() {
            words.push(word);
        }
        words
    }

    /// The same in bold.
    pub(crate) fn bold(&mut self, rich: &str) -> Vec<Word> {
        let mut words = self.words(rich);
        let runs = words.iter_mut().flat_map(|word| &mut word.runs);
        runs.for_each(|run| run.look.is_bold = true);
        words
    }

    fn push(&mut self, word: &mut Word, look: Look, sign: char) {
        let (font, glyph, width_em) = self.glyph(look, sign);
        match word.runs.last_mut() {
            Some(run) if run.font == font && run.look == look => {
                // Writing to a `String` cannot fail, here and below.
                _ = write!(run.hex, "{glyph:04X}");
                run.width_em += width_em;
            }
            _ => word.runs.push(Run {
                font,
                look,
                hex: format!("{glyph:04X}"),
                width_em,
            }),
        }
    }

    /// The font and the glyph of a sign: of the wanted font, of the other, or of a question mark.
    fn glyph(&mut self, look: Look, sign: char) -> (usize, u16, f32) {
        let wanted = usize::from(look.is_code);
        let sign = if sign == '\u{a0}' { ' ' } else { sign };
        for (font, sign) in [(wanted, sign), (1 - wanted, sign), (wanted, UNKNOWN)] {
            if let Some((glyph, width)) = self.fonts[font].glyph(sign) {
                return (font, glyph, width);
            }
        }
        (wanted, 0, 0.5)
    }
}

/// Words broken into lines no wider than `room`, at size 1; a word that is wider has a line of its own.
pub(crate) fn lines(words: Vec<Word>, room: f32) -> Vec<Vec<Word>> {
    let (mut lines, mut line, mut used) = (Vec::new(), Vec::new(), 0.0_f32);
    for word in words {
        let wider = used + SPACE + word.width();
        if line.is_empty() || wider > room {
            used = word.width();
            if !line.is_empty() {
                lines.push(std::mem::take(&mut line));
            }
        } else {
            used = wider;
        }
        line.push(word);
    }
    if !line.is_empty() {
        lines.push(line);
    }
    lines
}

/// Sets a line of words with its left end at a place, in a grey from 0 (black) to 1.
pub(crate) fn set(content: &mut String, words: &[Word], size: f32, [x, y]: [f32; 2], grey: f32) {
    let mut x = x;
    // Writing to a `String` cannot fail, here and below.
    _ = writeln!(content, "BT {grey} g {grey} G");
    for (place, word) in words.iter().enumerate() {
        for run in &word.runs {
            let size_pt = size * run.scale();
            let slant = if run.look.is_italic { SLANT } else { 0.0 };
            let (mode, pen) = if run.look.is_bold {
                (2, 0.035 * size_pt)
            } else {
                (0, 0.0)
            };
            _ = writeln!(
                content,
                "/F{} {size_pt:.2} Tf {mode} Tr {pen:.3} w 1 0 {slant} 1 {x:.2} {:.2} Tm <{}> Tj",
                run.font,
                size.mul_add(run.rise(), y),
                run.hex
            );
            x += size * run.width();
        }
        if place + 1 < words.len() {
            x += size * SPACE;
        }
    }
    content.push_str("ET\n");
}
