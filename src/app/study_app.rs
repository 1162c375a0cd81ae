//! The app: a study on the desk, or the question which one; above it the study's name and the theme.
//!
//! It draws into any [`Ui`], so that tests can drive it without a window.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui::{
    self, Align, Button, CentralPanel, Context, Frame, Key, KeyboardShortcut, Layout, Margin,
    Modifiers, Panel, Rect, RichText, ScrollArea, Stroke, StrokeKind, Theme, Ui,
};

use super::desk::Desk;
use super::desktop_theme::desktop_theme;
use super::job::{Job, WhenDropped};
use super::launcher::Launcher;
use super::look::{self, COLUMN, Enabled, Palette};
use super::page::Tools;
use super::settings::{Settings, ThemeChoice};
use super::study_state::{Place, Step};
use super::welcome_page::WelcomePage;

/// The widths of the button for another study, of the word before the themes, of a theme, and of all of them.
const OTHER_STUDY: f32 = 130.0;
const WORD: f32 = 84.0;
const THEME: f32 = 76.0;
const SWITCHES: f32 = OTHER_STUDY + WORD + 3.0 * THEME;
const HEIGHT: f32 = 36.0;

/// The app.
pub(crate) struct StudyApp {
    tools: Tools,
    settings: Settings,
    settings_path: Option<PathBuf>,
    desk: Option<Desk>,
    welcome: WelcomePage,
    asking_theme: Option<Job<Option<Theme>>>,
    theme_of_desktop: Option<Theme>,
    was_focused: bool,
}

impl StudyApp {
    /// The app in a place; `settings_path` is where it remembers what was opened.
    pub(crate) fn new(
        place: Place,
        launcher: Arc<dyn Launcher>,
        settings_path: Option<PathBuf>,
    ) -> Self {
        let settings = settings_path.as_deref().map(Settings::read);
        Self {
            tools: Tools { launcher, place },
            settings: settings.unwrap_or_default(),
            settings_path,
            desk: None,
            welcome: WelcomePage::default(),
            asking_theme: None,
            theme_of_desktop: None,
            was_focused: true,
        }
    }

    /// Puts a protocol on the desk.
    pub(crate) fn open(&mut self, protocol: &Path) {
        let protocol = self.tools.place.root.join(protocol);
        self.settings.note(&protocol);
        self.remember();
        self.desk = Some(Desk::new(protocol));
    }

    /// Asks the desktop whether it is light or dark.
    pub(crate) fn ask_theme(&mut self, context: &Context) {
        let job = Job::start(context, WhenDropped::Leave, |_| desktop_theme());
        self.asking_theme = Some(job);
    }

    fn remember(&self) {
        if let Some(path) = &self.settings_path {
            self.settings.write(path);
        }
    }

    /// One frame.
    pub(crate) fn show(&mut self, ui: &mut Ui) {
        let context = ui.ctx().clone();
        self.take_input(&context);
        if let Some(answer) = self.asking_theme.as_ref().and_then(Job::poll) {
            self.asking_theme = None;
            self.theme_of_desktop = answer.ok().flatten();
        }
        self.follow_theme(&context);
        if let Some(desk) = &mut self.desk {
            desk.poll(&context, &self.tools);
        }
        let palette = Palette::of(ui);
        let head = Frame::new()
            .fill(palette.card)
            .stroke(Stroke::new(1.0, palette.line))
            // The line around takes the twenty-fourth point.
            .inner_margin(Margin::symmetric(23, 10));
        Panel::top("head")
            .frame(head)
            .show_separator_line(false)
            .show(ui, |ui| column(ui, |ui| self.head(ui)));
        let body = Frame::new().fill(palette.ground);
        CentralPanel::default_margins().frame(body).show(ui, |ui| {
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                let room = Frame::new().inner_margin(Margin::symmetric(24, 22));
                room.show(ui, |ui| column(ui, |ui| self.body(ui)));
            });
        });
    }

    /// The study's name, another study, the theme.
    fn head(&mut self, ui: &mut Ui) {
        let mut is_left = false;
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 0.0;
            let title = self.desk.as_ref().and_then(Desk::title).unwrap_or("Acuity");
            let title = RichText::new(title).size(17.0);
            let room = (ui.available_width() - SWITCHES).max(100.0);
            ui.allocate_ui_with_layout(
                egui::vec2(room, HEIGHT),
                Layout::left_to_right(Align::Center),
                |ui| {
                    ui.set_width(room);
                    ui.add(egui::Label::new(title).truncate());
                },
            );
            let size = egui::vec2(OTHER_STUDY, HEIGHT);
            ui.allocate_ui_with_layout(size, Layout::right_to_left(Align::Center), |ui| {
                ui.set_width(OTHER_STUDY);
                if let Some(desk) = &self.desk {
                    let may_leave = Enabled::from(!desk.is_busy());
                    is_left = look::secondary(ui, may_leave, "Other study").clicked();
                }
            });
            self.theme_switch(ui);
        });
        if is_left {
            self.desk = None;
            self.welcome = WelcomePage::default();
        }
    }

    fn theme_switch(&mut self, ui: &mut Ui) {
        let layout = Layout::left_to_right(Align::Center);
        ui.allocate_ui_with_layout(egui::vec2(WORD, HEIGHT), layout, |ui| {
            ui.set_width(WORD);
            ui.add_space(20.0);
            look::weak(ui, "Theme");
        });
        let edge = Rect::from_min_size(ui.cursor().min, egui::vec2(3.0 * THEME, HEIGHT));
        let line = Stroke::new(1.0, Palette::of(ui).line);
        ui.painter().rect_stroke(edge, 7, line, StrokeKind::Inside);
        ui.spacing_mut().button_padding.x = 4.0;
        for choice in ThemeChoice::ALL {
            let is_chosen = self.settings.theme == choice;
            let button = Button::selectable(is_chosen, choice.word());
            let response = ui.add(button.min_size(egui::vec2(THEME, HEIGHT)));
            look::focus_ring(ui, &response);
            let response = response.accessible_name(format!("Theme: {}", choice.word()));
            if response.clicked() && !is_chosen {
                self.settings.theme = choice;
                self.remember();
                self.ask_theme(ui.ctx());
            }
        }
    }

    fn body(&mut self, ui: &mut Ui) {
        ui.spacing_mut().item_spacing.y = 12.0;
        if let Some(desk) = &mut self.desk {
            desk.show(ui, &self.tools);
            return;
        }
        let root = self.tools.place.root.clone();
        if let Some(chosen) = self.welcome.show(ui, &root, &self.settings.recent) {
            self.open(&chosen);
        }
    }

    /// Files that are dropped, keys that work on every page, and the return to the window.
    fn take_input(&mut self, context: &Context) {
        let dropped = context.input(|input| {
            let first = input.raw.dropped_files.first();
            first.map(|file| file.path().to_owned())
        });
        let is_busy = self.desk.as_ref().is_some_and(Desk::is_busy);
        if let Some(dropped) = dropped.filter(|_| !is_busy) {
            self.open(&dropped);
        }
        let is_focused = context.input(|input| input.focused);
        let is_back = is_focused && !std::mem::replace(&mut self.was_focused, is_focused);
        let Some(desk) = &mut self.desk else {
            return;
        };
        let is_asked = context.input_mut(|input| input.consume_key(Modifiers::NONE, Key::F5));
        if is_asked || is_back {
            desk.read_again();
        }
        let keys = [Key::Num1, Key::Num2, Key::Num3, Key::Num4];
        for (key, step) in keys.into_iter().zip(Step::ALL) {
            let shortcut = KeyboardShortcut::new(Modifiers::COMMAND, key);
            if context.input_mut(|input| input.consume_shortcut(&shortcut)) {
                desk.go(step);
            }
        }
    }

    fn follow_theme(&self, context: &Context) {
        let theme = match self.settings.theme {
            ThemeChoice::Desktop => self.theme_of_desktop.unwrap_or(Theme::Light),
            ThemeChoice::Light => Theme::Light,
            ThemeChoice::Dark => Theme::Dark,
        };
        if context.theme() != theme {
            context.set_theme(theme);
        }
    }
}

/// A column in the middle of the window.
fn column<R>(ui: &mut Ui, add: impl FnOnce(&mut Ui) -> R) -> R {
    let width = ui.available_width().min(COLUMN);
    let margin = (ui.available_width() - width) / 2.0;
    let inner = ui.horizontal_top(|ui| {
        ui.add_space(margin);
        let layout = Layout::top_down(Align::Min);
        ui.allocate_ui_with_layout(egui::vec2(width, 0.0), layout, |ui| {
            ui.set_width(width);
            add(ui)
        })
        .inner
    });
    inner.inner
}

#[cfg(test)]
mod tests;
