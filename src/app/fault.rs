//! What went wrong, in rows that a page can show: where, what was found, what was expected, what to do.

use analysis::AnalysisError;
use experiment::ExperimentError;
use protocols::{InputError, ReadError};
use renderer::RendererError;

/// What went wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Fault {
    rows: Vec<(&'static str, String)>,
}

impl Fault {
    /// An error of any part.
    pub(crate) fn of(error: impl Into<anyhow::Error>) -> Self {
        let error = error.into();
        match input_of(&error) {
            Some(input) => Self::of_input(input),
            None => Self::of_words(&format!("{error:#}")),
        }
    }

    fn of_input(input: &InputError) -> Self {
        let file = input.file().display();
        let place = match input.place() {
            Some(place) => format!("{file}, {place}"),
            None => file.to_string(),
        };
        let mut rows = vec![
            ("Where", place),
            ("Found", input.found().to_owned()),
            ("Expected", input.expected().to_owned()),
        ];
        rows.extend((input.advice()).map(|advice| ("What to do", sentence(advice))));
        Self { rows }.with_page()
    }

    /// The same fault with the page that does what a remedy says in the words of a command.
    fn with_page(mut self) -> Self {
        let remedy = self.rows.last().map_or("", |(_, text)| text);
        let pages = [
            ("acuity render", "Stimuli"),
            ("acuity station", "Station"),
            ("--monitor", "Station"),
            ("acuity run", "Sessions"),
        ];
        let page = pages.iter().find(|(words, _)| remedy.contains(words));
        let hint = page.map(|(_, page)| ("In this app", format!("The page {page}.")));
        self.rows.extend(hint);
        self
    }

    /// What a program printed: its last clause says what to do.
    pub(crate) fn of_words(text: &str) -> Self {
        let text = text.trim();
        let text = text.strip_prefix("error: ").unwrap_or(text);
        let rows = match text.rsplit_once("; ") {
            Some((what, remedy)) => vec![
                ("What happened", sentence(what)),
                ("What to do", sentence(remedy)),
            ],
            None => vec![("What happened", sentence(text))],
        };
        Self { rows }.with_page()
    }

    /// A fault of ours: a part of the program ended without an answer.
    pub(crate) fn of_program(what: &str) -> Self {
        let remedy = "Nothing that was saved is lost. Start the program again; if it comes back, tell its makers.";
        Self {
            rows: vec![
                ("What happened", format!("A fault of the program: {what}.")),
                ("What to do", remedy.to_owned()),
            ],
        }
    }

    /// Label and text, from top to bottom.
    pub(crate) fn rows(&self) -> &[(&'static str, String)] {
        &self.rows
    }

    /// The fault in a line, for a small place: the last line of what was found, which names it.
    pub(crate) fn line(&self) -> &str {
        let found = self.rows.iter().find(|(label, _)| *label == "Found");
        let row = found.or(self.rows.first());
        row.map_or("", |(_, text)| text.lines().last().unwrap_or_default())
    }
}

/// The wrong input that an error is about, whichever part found it.
fn input_of(error: &anyhow::Error) -> Option<&InputError> {
    if let Some(RendererError::Input(input)) = error.downcast_ref() {
        return Some(input);
    }
    if let Some(ExperimentError::Input(input)) = error.downcast_ref() {
        return Some(input);
    }
    if let Some(AnalysisError::Input(input)) = error.downcast_ref() {
        return Some(input);
    }
    if let Some(ReadError::Input(input)) = error.downcast_ref() {
        return Some(input);
    }
    error.downcast_ref()
}

/// The text with a capital letter at its start.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    match letters.next() {
        Some(first) => first.to_uppercase().chain(letters).collect(),
        None => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_input_error_of_any_part_becomes_the_same_rows() {
        let input = || {
            InputError::new("a.csv", "\"x\"", "a number")
                .at("line 7")
                .remedy("correct the line")
        };
        let rows = [
            ("Where", "a.csv, line 7".to_owned()),
            ("Found", "\"x\"".to_owned()),
            ("Expected", "a number".to_owned()),
            ("What to do", "Correct the line".to_owned()),
        ];
        let faults = [
            Fault::of(input()),
            Fault::of(RendererError::Input(input())),
            Fault::of(ExperimentError::Input(input())),
            Fault::of(AnalysisError::Input(input())),
            Fault::of(ReadError::Input(input())),
        ];
        for fault in faults {
            assert_eq!(fault.rows(), rows);
            assert_eq!(fault.line(), "\"x\"");
        }
    }

    #[test]
    fn a_remedy_that_is_a_command_names_its_page() {
        let fault = Fault::of_words("found no set; run `acuity render p.toml`");
        let page = ("In this app", "The page Stimuli.".to_owned());
        assert_eq!(fault.rows().last(), Some(&page));
    }

    #[test]
    fn what_a_process_printed_is_split_before_its_remedy() {
        let fault = Fault::of_words("error: found no DISPLAY; log in to the desktop\n");
        let rows = [
            ("What happened", "Found no DISPLAY".to_owned()),
            ("What to do", "Log in to the desktop".to_owned()),
        ];
        assert_eq!(fault.rows(), rows);
        assert_eq!(Fault::of_words("").rows().len(), 1);
    }
}
