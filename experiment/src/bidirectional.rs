//! Text that runs from right to left, brought into the order in which it is drawn (Unicode Standard Annex 9).
//!
//! The text engine joins and turns the letters of a word, but sets the words of a line from left to right, and breaks
//! lines by that order. So lines are broken here, by measured widths, and the words of each are put in visual order; the
//! letters of a word stay as they are written. Text without such words is left to the engine.
//!
//! Not here: what is typed into a field; its letters are turned, its words follow each other from left to right.

use std::ops::Range;

use unicode_bidi::{BidiInfo, ParagraphInfo};

/// Whether any of the text runs from right to left.
pub(crate) fn has_leftward(text: &str) -> bool {
    text.chars().any(is_leftward)
}

/// Whether the text begins on the right: by its first letter that has a direction.
pub(crate) fn begins_right(text: &str) -> bool {
    let information = BidiInfo::new(text, None);
    let first = information.paragraphs.first();
    first.is_some_and(|paragraph| paragraph.level.is_rtl())
}

/// Whether a character belongs to a script that runs from right to left (Unicode's blocks for those scripts).
fn is_leftward(character: char) -> bool {
    matches!(
        character,
        '\u{590}'..='\u{8FF}' | '\u{FB1D}'..='\u{FDFF}' | '\u{FE70}'..='\u{FEFC}' | '\u{10800}'..='\u{10FFF}' | '\u{1E800}'..='\u{1EFFF}'
    )
}

/// The text in lines no wider than `width`, as far as its words are not, each in the order in which it is drawn.
///
/// `measure` gives the width of a piece of text.
pub(crate) fn visual_lines(text: &str, width: f32, measure: impl Fn(&str) -> f32) -> Vec<String> {
    let information = BidiInfo::new(text, None);
    let mut lines = Vec::new();
    for paragraph in &information.paragraphs {
        for range in broken(text, paragraph.range.clone(), width, &measure) {
            lines.push(visual_line(&information, paragraph, range));
        }
    }
    lines
}

/// The lines of a paragraph: as many words in each as go in.
fn broken(
    text: &str,
    paragraph: Range<usize>,
    width: f32,
    measure: &impl Fn(&str) -> f32,
) -> Vec<Range<usize>> {
    let end = paragraph.start + text[paragraph.clone()].trim_end().len();
    let (mut line, mut lines) = (paragraph.start..paragraph.start, Vec::new());
    let mut used = 0.0;
    for word in text[paragraph.start..end].split_inclusive(' ') {
        let bare = measure(word.trim_end());
        if used + bare > width && !line.is_empty() {
            lines.push(line.clone());
            line.start = line.end;
            used = 0.0;
        }
        line.end += word.len();
        used += measure(word);
    }
    lines.push(line);
    lines
}

/// One line in the order in which it is drawn.
fn visual_line(
    information: &BidiInfo<'_>,
    paragraph: &ParagraphInfo,
    line: Range<usize>,
) -> String {
    let text = information.text;
    let line = line.start..line.start + text[line.clone()].trim_end().len();
    if line.is_empty() {
        return String::new();
    }
    let (levels, runs) = information.visual_runs(paragraph, line);
    let mut drawn = String::new();
    for run in runs {
        if levels[run.start].is_ltr() {
            drawn.push_str(&text[run]);
            continue;
        }
        for piece in pieces(&text[run]).into_iter().rev() {
            match mirrored(piece) {
                Some(other) => drawn.push(other),
                None => drawn.push_str(piece),
            }
        }
    }
    drawn
}

/// The words of a run, and each character between them; the letters of a word are turned by the text engine.
fn pieces(run: &str) -> Vec<&str> {
    let mut pieces: Vec<Range<usize>> = Vec::new();
    let mut is_word = false;
    for (start, character) in run.char_indices() {
        let end = start + character.len_utf8();
        let goes_on = is_leftward(character) || is_joiner(character);
        match pieces.last_mut() {
            Some(word) if is_word && goes_on => word.end = end,
            _ => pieces.push(start..end),
        }
        is_word = goes_on;
    }
    pieces.into_iter().map(|range| &run[range]).collect()
}

/// A mark or joiner that belongs to the letter before it.
fn is_joiner(character: char) -> bool {
    matches!(character, '\u{300}'..='\u{36F}' | '\u{200C}' | '\u{200D}')
}

/// The bracket that looks to the other side.
fn mirrored(piece: &str) -> Option<char> {
    const PAIRS: [[char; 2]; 6] = [
        ['(', ')'],
        ['[', ']'],
        ['{', '}'],
        ['<', '>'],
        ['«', '»'],
        ['‹', '›'],
    ];
    let mut characters = piece.chars();
    let (only, None) = (characters.next()?, characters.next()) else {
        return None;
    };
    PAIRS.into_iter().find_map(|[left, right]| match only {
        bracket if bracket == left => Some(right),
        bracket if bracket == right => Some(left),
        _ => None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEBREW: &str = "איכות התמונה (0 עד 10): בחרו מספר, ולחצו Enter.";
    const ARABIC: &str = "ما جودة الصورة؟ اختر من 0 إلى 10، ثم اضغط «متابعة».";

    /// Every character as wide as any other.
    fn count(text: &str) -> f32 {
        text.chars().count() as f32
    }

    /// What the text engine does to a word: its letters from the last to the first.
    fn turned(line: &str) -> String {
        let mut turned = String::new();
        let mut word: Vec<char> = Vec::new();
        for character in line.chars() {
            if is_leftward(character) {
                word.push(character);
            } else {
                turned.extend(word.drain(..).rev());
                turned.push(character);
            }
        }
        turned.extend(word.drain(..).rev());
        turned
    }

    /// The judge is the library's own order of single characters, which turns no bracket.
    #[test]
    fn lines_have_the_order_of_annex_9() {
        for text in [HEBREW, ARABIC, "Enter: לחצו על Enter עכשיו", "אבג"] {
            let information = BidiInfo::new(text, None);
            let paragraph = &information.paragraphs[0];
            let judged = information.reorder_line(paragraph, paragraph.range.clone());
            let [line] = &visual_lines(text, f32::INFINITY, count)[..] else {
                panic!("one line");
            };
            let brackets = |text: &str| -> String {
                let one = |character: char| mirrored(&character.to_string()).unwrap_or(character);
                let mut pairs = text.chars().map(|character| one(character).min(character));
                pairs.by_ref().collect()
            };
            assert_eq!(brackets(&turned(line)), brackets(&judged), "{text}");
        }
    }

    #[test]
    fn brackets_look_to_the_side_of_what_they_enclose() {
        let [line] = &visual_lines("אב (גד) הו", 100.0, count)[..] else {
            panic!("one line");
        };
        assert_eq!(line, "הו (גד) אב");
    }

    #[test]
    fn lines_are_broken_before_they_are_turned() {
        let lines = visual_lines("אחת שתים שלוש ארבע\n\nחמש", 9.0, count);
        assert_eq!(lines, ["שתים אחת", "ארבע שלוש", "", "חמש"]);
        // A word that is wider than a line stands alone.
        assert_eq!(visual_lines("ab אבגדהוזחטיכל ab", 5.0, count).len(), 3);
    }

    #[test]
    fn where_a_text_begins_is_known() {
        assert!(begins_right(HEBREW) && begins_right(ARABIC) && begins_right("10 שקלים"));
        assert!(!begins_right("Enter עכשיו") && !begins_right("How good?") && !begins_right(""));
        assert!(has_leftward("Enter עכשיו") && !has_leftward("Wie gut? 画質"));
    }
}
