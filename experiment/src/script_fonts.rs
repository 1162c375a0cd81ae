//! Fonts of this computer for characters that the program's own fonts lack.
//!
//! The program brings fonts for Latin, Greek and Cyrillic. For any other character the fonts of the system are looked
//! at, and not before: a protocol in those scripts costs nothing. Of the fonts that have a character the one is taken
//! that has most of the protocol's other characters too, so that a text is in one hand; then upright sans-serif before
//! the rest, then by name.
//!
//! Not here: the order of words that run from right to left (`bidirectional`).

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use eframe::egui::epaint::text::{
    FallbackRequest, FontData, FontDefinitions, FontFamily, FontInsert, FontPriority, FontProvider,
    Fonts, InsertFontFamily, TextOptions,
};
use eframe::egui::{Context, FontId};
use fontdb::{Database, FaceInfo, Source, Style, Weight};
use protocols::Study;
use skrifa::{FontRef, MetadataProvider as _};

/// A face in a file of the system.
#[derive(Clone, Debug)]
struct Face {
    file: PathBuf,
    index: u32,
    family: String,
}

impl Face {
    fn of(info: &FaceInfo) -> Option<Self> {
        let Source::File(file) = &info.source else {
            return None;
        };
        let is_plain =
            info.style == Style::Normal && info.weight == Weight::NORMAL && !info.monospaced;
        let (family, _) = info.families.first()?;
        is_plain.then(|| Self {
            file: file.clone(),
            index: info.index,
            family: family.clone(),
        })
    }

    /// Which of these characters it has; none if the file cannot be read.
    fn covers(&self, characters: &BTreeSet<char>) -> usize {
        let Ok(bytes) = fs::read(&self.file) else {
            return 0;
        };
        let Ok(font) = FontRef::from_index(&bytes, self.index) else {
            return 0;
        };
        let map = font.charmap();
        characters
            .iter()
            .filter(|&&character| map.map(character).is_some())
            .count()
    }

    /// The font, for texts of a family.
    fn insert(&self, family: &FontFamily) -> Option<FontInsert> {
        let bytes = fs::read(&self.file).ok()?;
        Some(FontInsert {
            name: format!("{} {}", self.file.display(), self.index),
            data: FontData::from_blob(Arc::new(bytes), self.index),
            families: vec![InsertFontFamily {
                family: family.clone(),
                priority: FontPriority::Lowest,
            }],
        })
    }
}

/// The fonts of the system, in the order in which they are asked.
pub(crate) struct ScriptFonts {
    wanted: BTreeSet<char>,
    faces: OnceLock<Vec<Face>>,
}

impl ScriptFonts {
    /// Fonts for a protocol's texts, and for what may be typed besides.
    pub(crate) fn new(study: &Study) -> Self {
        Self {
            wanted: foreign_characters(study),
            faces: OnceLock::new(),
        }
    }

    /// Lets a window use them: those that the protocol's texts need from its first frame on.
    pub(crate) fn install(self, context: &Context) {
        context.add_font_provider(Arc::new(self));
    }

    /// The fewest faces, in their order, that have every character of the protocol that any has.
    fn needed(&self) -> Vec<&Face> {
        let mut needed: Vec<&Face> = Vec::new();
        for character in &self.wanted {
            let alone = BTreeSet::from([*character]);
            if needed.iter().any(|face| face.covers(&alone) == 1) {
                continue;
            }
            needed.extend(self.face_for(*character));
        }
        needed
    }

    fn faces(&self) -> &[Face] {
        self.faces.get_or_init(|| {
            let mut system = Database::new();
            system.load_system_fonts();
            let faces = system.faces().filter_map(Face::of);
            let mut ranked: Vec<_> = faces
                .map(|face| {
                    let lacking = self.wanted.len()
                        - if self.wanted.is_empty() {
                            0
                        } else {
                            face.covers(&self.wanted)
                        };
                    let is_other = !face.family.contains("Sans");
                    (lacking, is_other, face.family.clone(), face.index, face)
                })
                .collect();
            ranked.sort_by(|one, other| {
                let key =
                    |(lacking, other, name, index, face): &(usize, bool, String, u32, Face)| {
                        (*lacking, *other, name.clone(), *index, face.file.clone())
                    };
                key(one).cmp(&key(other))
            });
            ranked.into_iter().map(|(.., face)| face).collect()
        })
    }

    /// The first face that has a character.
    fn face_for(&self, character: char) -> Option<&Face> {
        let wanted = BTreeSet::from([character]);
        self.faces().iter().find(|face| face.covers(&wanted) == 1)
    }
}

impl FontProvider for ScriptFonts {
    fn fonts_for_family(&self, family: &FontFamily) -> Vec<FontInsert> {
        if *family != FontFamily::Proportional {
            return Vec::new();
        }
        let needed = self.needed().into_iter();
        needed.filter_map(|face| face.insert(family)).collect()
    }

    fn font_for(&self, request: &FallbackRequest<'_>) -> Option<FontInsert> {
        let character = request.cluster.chars().next()?;
        let face = self.face_for(character).filter(|_| is_visible(character))?;
        face.insert(request.family)
    }
}

/// Why texts of the protocol would not be shown as they are written: a line for each reason.
pub(crate) fn text_faults(study: &Study) -> Vec<String> {
    let fonts = ScriptFonts::new(study);
    let name = |character: &char| format!("'{character}' (U+{:04X})", u32::from(*character));
    let mut faults = Vec::new();
    let missing: Vec<String> = (fonts.wanted.iter())
        .filter(|character| fonts.face_for(**character).is_none())
        .map(name)
        .collect();
    if !missing.is_empty() {
        faults.push(format!(
            "texts: no font of this computer has {}; install a font of that script (for example a package of Noto fonts)",
            missing.join(", ")
        ));
    }
    faults
}

/// The characters of the protocol's session that the program's own fonts lack.
fn foreign_characters(study: &Study) -> BTreeSet<char> {
    let mut characters = BTreeSet::new();
    if let Ok(session) = serde_json::to_value(&study.protocol.session) {
        collect(&session, &mut characters);
    }
    characters.retain(|character| !character.is_ascii() && is_visible(*character));
    if characters.is_empty() {
        return characters;
    }
    let mut own = Fonts::new(TextOptions::default(), FontDefinitions::default());
    let font = FontId::new(20.0, FontFamily::Proportional);
    let mut own = own.with_pixels_per_point(1.0);
    characters.retain(|character| !own.has_glyph(&font, *character));
    characters
}

/// The characters of every text in a value.
fn collect(value: &serde_json::Value, characters: &mut BTreeSet<char>) {
    match value {
        serde_json::Value::String(text) => characters.extend(text.chars()),
        serde_json::Value::Array(values) => {
            for value in values {
                collect(value, characters);
            }
        }
        serde_json::Value::Object(fields) => {
            for value in fields.values() {
                collect(value, characters);
            }
        }
        _ => {}
    }
}

/// Whether a character has a shape of its own: no spaces, controls, joiners and selectors of variants.
fn is_visible(character: char) -> bool {
    let is_format = matches!(
        character,
        '\u{AD}' | '\u{200B}'..='\u{200F}' | '\u{2028}'..='\u{202E}' | '\u{2060}'..='\u{206F}' | '\u{FE00}'..='\u{FE0F}' | '\u{FEFF}'
    );
    !(is_format || character.is_whitespace() || character.is_control())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::small_study;

    fn study_with(question: &str) -> Study {
        let folder = tempfile::tempdir().unwrap();
        let mut study = small_study(folder.path());
        study.protocol.session.texts.question = question.to_owned();
        study
    }

    #[test]
    fn latin_greek_and_cyrillic_need_no_font_of_the_system() {
        let study =
            study_with("Wie gut ist das Bild? Façade, Žižek, Ποιότητα; Качество – ‘gut’ 5 × 3°");
        assert!(foreign_characters(&study).is_empty());
        assert!(text_faults(&study).is_empty());
    }

    #[test]
    fn what_the_own_fonts_lack_is_found_wherever_it_stands_in_the_session() {
        let mut study = study_with("画質は?\u{FE0F}");
        study.protocol.session.consent = toml::from_str("text = \"참가\"").ok();
        let expected: BTreeSet<char> = "画質は참가".chars().collect();
        assert_eq!(foreign_characters(&study), expected);
    }

    /// U+10FFFD is for private use; no font can have a character of Unicode there.
    #[test]
    fn a_character_that_no_font_has_is_named() {
        let faults = text_faults(&study_with("A \u{10FFFD} B"));
        let [fault] = faults.as_slice() else {
            panic!("{faults:?}");
        };
        assert!(
            fault.contains("U+10FFFD") && fault.contains("install a font"),
            "{fault}"
        );
    }

    /// With a font of the system for the script, a window has a glyph; without one, it is named.
    #[test]
    fn a_window_finds_the_fonts_of_the_system() {
        let study = study_with("画質");
        let is_named = !text_faults(&study).is_empty();
        let context = Context::default();
        let mut has_glyphs = false;
        let mut fonts = Some(ScriptFonts::new(&study));
        for _ in 0..2 {
            let mut output = context.run_ui(eframe::egui::RawInput::default(), |ui| {
                let font = FontId::proportional(20.0);
                if let Some(fonts) = fonts.take() {
                    fonts.install(ui.ctx());
                }
                has_glyphs = ui.ctx().fonts_mut(|fonts| fonts.has_glyphs(&font, "画質"));
            });
            output.shapes.clear();
        }
        assert_eq!(has_glyphs, !is_named);
    }
}
