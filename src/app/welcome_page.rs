//! Which study? The protocols of the working folder, those opened last, one that is typed, or one that is
//! dropped on the window.

use std::path::{Path, PathBuf};

use eframe::egui::{Align, Atom, Button, Key, Layout, RichText, TextStyle, Ui, vec2};
use protocols::Study;

use super::fault::Fault;
use super::job::{Job, WhenDropped};
use super::look::{self, Enabled, Palette};

/// A protocol file and what it says of itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Offer {
    pub(crate) path: PathBuf,
    /// The study's title, or why the file is none.
    pub(crate) title: Result<String, Fault>,
}

impl Offer {
    fn of(path: PathBuf) -> Self {
        let title = Study::read(&path).map(|study| study.protocol.title);
        Self {
            title: title.map_err(Fault::of),
            path,
        }
    }
}

/// The protocols in `root/protocols`, by name.
pub(crate) fn protocols_below(root: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(root.join("protocols"))
        .into_iter()
        .flatten();
    let mut files: Vec<PathBuf> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .filter(|path| path.file_name().is_some_and(|name| name != "Cargo.toml"))
        .collect();
    files.sort();
    files
}

/// What is offered.
#[derive(Debug, Default)]
struct Offers {
    here: Vec<Offer>,
    recent: Vec<Offer>,
}

/// The page.
#[derive(Default)]
pub(crate) struct WelcomePage {
    reading: Option<Job<Offers>>,
    offers: Option<Offers>,
    typed: String,
}

impl WelcomePage {
    /// The page; says which protocol is to be opened.
    pub(crate) fn show(&mut self, ui: &mut Ui, root: &Path, recent: &[PathBuf]) -> Option<PathBuf> {
        self.take(ui, root, recent);
        let words = format!(
            "Stimuli, data and reports are kept below {}",
            root.display()
        );
        look::page_head(ui, "Which study?", &words);
        let mut chosen = None;
        match &self.offers {
            None => {
                ui.spinner();
            }
            Some(Offers { here, recent }) => {
                if !here.is_empty() {
                    let list = look::card(ui, |ui| list(ui, "In this folder", here));
                    chosen = chosen.or(list);
                }
                if !recent.is_empty() {
                    let list = look::card(ui, |ui| list(ui, "Opened before", recent));
                    chosen = chosen.or(list);
                }
            }
        }
        chosen.or(look::card(ui, |ui| self.typed(ui, root)))
    }

    fn take(&mut self, ui: &Ui, root: &Path, recent: &[PathBuf]) {
        if self.offers.is_some() {
            return;
        }
        let reading = self.reading.get_or_insert_with(|| {
            let here = protocols_below(root);
            let other = recent
                .iter()
                .filter(|path| !here.contains(path) && path.is_file());
            let other: Vec<PathBuf> = other.cloned().collect();
            Job::start(ui.ctx(), WhenDropped::Leave, move |_| Offers {
                here: here.into_iter().map(Offer::of).collect(),
                recent: other.into_iter().map(Offer::of).collect(),
            })
        });
        if let Some(offers) = reading.poll() {
            self.offers = Some(offers.unwrap_or_default());
            self.reading = None;
        }
    }

    fn typed(&mut self, ui: &mut Ui, root: &Path) -> Option<PathBuf> {
        look::title(ui, "Another protocol");
        look::weak(ui, "Drop its file on this window, or type where it is.");
        let mut is_chosen = false;
        ui.horizontal(|ui| {
            let width = (ui.available_width() - 200.0).clamp(200.0, 640.0);
            let field = look::field(ui, "File", &mut self.typed, width);
            is_chosen = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
            let is_there = Enabled::from(!self.typed.trim().is_empty());
            is_chosen |= look::secondary(ui, is_there, "Open").clicked();
        });
        let path = root.join(self.typed.trim());
        (is_chosen && !self.typed.trim().is_empty()).then_some(path)
    }
}

/// The protocols under a title; says which is pressed.
fn list(ui: &mut Ui, title: &str, offers: &[Offer]) -> Option<PathBuf> {
    look::title(ui, title);
    let mut chosen = None;
    for offer in offers {
        let Offer { path, title } = offer;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let (words, color) = match title {
            Ok(title) => (title.as_str(), Palette::of(ui).weak),
            Err(fault) => (fault.line(), Palette::of(ui).wrong),
        };
        ui.allocate_ui_with_layout(
            vec2(ui.available_width(), 0.0),
            Layout::left_to_right(Align::Center),
            |ui| {
                let button = Button::new((name.as_ref(), Atom::grow()));
                let button = ui.add(button.min_size(vec2(300.0, 36.0)).wrap());
                look::focus_ring(ui, &button);
                let words = RichText::new(words)
                    .text_style(TextStyle::Small)
                    .color(color);
                ui.add(eframe::egui::Label::new(words).wrap());
                if button.clicked() {
                    chosen = Some(path.clone());
                }
            },
        );
    }
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn protocols_are_found_and_a_manifest_of_cargo_is_none() {
        let folder = tempfile::tempdir().unwrap();
        assert!(protocols_below(folder.path()).is_empty());
        let protocols = folder.path().join("protocols");
        std::fs::create_dir(&protocols).unwrap();
        for name in ["b.toml", "a.toml", "Cargo.toml", "notes.txt"] {
            std::fs::write(protocols.join(name), "").unwrap();
        }
        let found = protocols_below(folder.path());
        assert_eq!(found, [protocols.join("a.toml"), protocols.join("b.toml")]);
    }

    #[test]
    fn a_file_that_is_no_protocol_is_offered_with_what_is_wrong() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.toml");
        for text in ["", "study = ", "study = 7"] {
            std::fs::write(&path, text).unwrap();
            assert!(Offer::of(path.clone()).title.is_err(), "{text}");
        }
    }
}
