//! Rich text (see `document`) in other notations: plain, Markdown, LaTeX.

/// One piece of rich text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Piece<'a> {
    Text(&'a str),
    /// The name of a tag, with a slash before it where it closes.
    Tag(&'a str),
}

/// How a part of a text looks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Look {
    pub(crate) is_bold: bool,
    pub(crate) is_italic: bool,
    pub(crate) is_code: bool,
    pub(crate) place: Place,
}

/// Whether a part of a text stands below or above the line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Place {
    #[default]
    Line,
    Below,
    Above,
}

/// The text in parts of one look each, with the signs that entities stand for.
pub(crate) fn runs(rich: &str) -> Vec<(Look, String)> {
    let (mut look, mut runs) = (Look::default(), Vec::new());
    for piece in pieces(rich) {
        match piece {
            Piece::Text(text) => runs.push((look, unescaped(text))),
            Piece::Tag(tag) => {
                let is_open = !tag.starts_with('/');
                match tag.trim_start_matches('/') {
                    "b" | "strong" => look.is_bold = is_open,
                    "i" | "em" => look.is_italic = is_open,
                    "code" => look.is_code = is_open,
                    "sub" if is_open => look.place = Place::Below,
                    "sup" if is_open => look.place = Place::Above,
                    "sub" | "sup" => look.place = Place::Line,
                    _ => {}
                }
            }
        }
    }
    runs
}

/// The text without its tags and with the signs that entities stand for.
pub(crate) fn plain(rich: &str) -> String {
    let texts = pieces(rich).into_iter().map(|piece| match piece {
        Piece::Text(text) => unescaped(text),
        Piece::Tag(_) => String::new(),
    });
    texts.collect()
}

/// In Markdown; what Markdown has no sign for stays HTML, which Markdown allows.
pub(crate) fn markdown(rich: &str) -> String {
    let parts = pieces(rich).into_iter().map(|piece| match piece {
        Piece::Text(text) => {
            let mut escaped = text.to_owned();
            for sign in ["\\", "*", "_", "`", "[", "]", "|"] {
                escaped = escaped.replace(sign, &format!("\\{sign}"));
            }
            escaped.replace("&quot;", "\"")
        }
        Piece::Tag("i" | "/i" | "em" | "/em") => "*".to_owned(),
        Piece::Tag("b" | "/b" | "strong" | "/strong") => "**".to_owned(),
        Piece::Tag(tag) => format!("<{tag}>"),
    });
    parts.collect()
}

/// In LaTeX (UTF-8, packages textcomp and amsmath).
pub(crate) fn latex(rich: &str) -> String {
    let parts = pieces(rich).into_iter().map(|piece| match piece {
        Piece::Text(text) => latex_signs(&unescaped(text)),
        Piece::Tag("i" | "em") => "\\textit{".to_owned(),
        Piece::Tag("b" | "strong") => "\\textbf{".to_owned(),
        Piece::Tag("sub") => "\\textsubscript{".to_owned(),
        Piece::Tag("sup") => "\\textsuperscript{".to_owned(),
        Piece::Tag("code") => "\\texttt{".to_owned(),
        Piece::Tag(_) => "}".to_owned(),
    });
    parts.collect()
}

fn latex_signs(text: &str) -> String {
    let sign = |sign: char| match sign {
        '\\' => "\\textbackslash{}".to_owned(),
        '&' | '%' | '$' | '#' | '_' | '{' | '}' => format!("\\{sign}"),
        '~' => "\\textasciitilde{}".to_owned(),
        '^' => "\\textasciicircum{}".to_owned(),
        '<' => "$<$".to_owned(),
        '>' => "$>$".to_owned(),
        '−' => "$-$".to_owned(),
        '±' => "$\\pm$".to_owned(),
        '×' => "$\\times$".to_owned(),
        '·' => "$\\cdot$".to_owned(),
        'η' => "$\\eta$".to_owned(),
        'ε' => "$\\varepsilon$".to_owned(),
        'ω' => "$\\omega$".to_owned(),
        'χ' => "$\\chi$".to_owned(),
        'Δ' => "$\\Delta$".to_owned(),
        '²' => "\\textsuperscript{2}".to_owned(),
        '°' => "$^\\circ$".to_owned(),
        '–' => "--".to_owned(),
        '…' => "\\dots{}".to_owned(),
        '’' => "'".to_owned(),
        '\u{a0}' => "~".to_owned(),
        _ => sign.to_string(),
    };
    text.chars().map(sign).collect()
}

fn pieces(rich: &str) -> Vec<Piece<'_>> {
    let mut pieces = Vec::new();
    let mut rest = rich;
    while let Some(start) = rest.find('<') {
        let Some(length) = rest[start..].find('>') else {
            break;
        };
        if start > 0 {
            pieces.push(Piece::Text(&rest[..start]));
        }
        pieces.push(Piece::Tag(&rest[start + 1..start + length]));
        rest = &rest[start + length + 1..];
    }
    if !rest.is_empty() {
        pieces.push(Piece::Text(rest));
    }
    pieces
}

fn unescaped(text: &str) -> String {
    text.replace("&lt;", "<")
        .replace("&gt;", ">")
        .replace("&quot;", "\"")
        .replace("&amp;", "&")
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEST: &str = "<i>F</i>(1,\u{a0}11)\u{a0}= 137.8, <i>p</i>\u{a0}&lt;\u{a0}.001, η²<sub>p</sub> = .93 &amp; a_b 50%";

    #[test]
    fn parts_have_the_look_of_their_tags() {
        let found = runs("a <i>b</i><sub>c</sub> &lt; <b><i>d</i></b>");
        let plain = Look::default();
        let italic = Look {
            is_italic: true,
            ..plain
        };
        let below = Look {
            place: Place::Below,
            ..plain
        };
        let both = Look {
            is_bold: true,
            ..italic
        };
        let expected = [
            (plain, "a "),
            (italic, "b"),
            (below, "c"),
            (plain, " < "),
            (both, "d"),
        ];
        assert_eq!(found, expected.map(|(look, text)| (look, text.to_owned())));
    }

    #[test]
    fn each_notation_says_the_same() {
        assert_eq!(
            plain(TEST),
            "F(1,\u{a0}11)\u{a0}= 137.8, p\u{a0}<\u{a0}.001, η²p = .93 & a_b 50%"
        );
        assert_eq!(
            markdown(TEST),
            "*F*(1,\u{a0}11)\u{a0}= 137.8, *p*\u{a0}&lt;\u{a0}.001, η²<sub>p</sub> = .93 &amp; a\\_b 50%"
        );
        assert_eq!(
            latex(TEST),
            "\\textit{F}(1,~11)~= 137.8, \\textit{p}~$<$~.001, $\\eta$\\textsuperscript{2}\\textsubscript{p} = .93 \\& a\\_b 50\\%"
        );
    }
}
