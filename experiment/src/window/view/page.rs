//! The page of the experimenter's view.

use std::time::Duration;

use eframe::egui::{self, Color32, Panel, RichText, Ui};

use super::super::desk;
use super::rating_plot;
use crate::{Glance, Order};

/// How long the countdown rests between two looks: seldom enough to take nothing from the subject's window.
const BETWEEN_LOOKS: Duration = Duration::from_millis(500);

/// What the page shows and remembers.
#[derive(Default)]
pub(super) struct ViewPage {
    glance: Option<Glance>,
    seen_s: f64,
    words: String,
    noted: Vec<String>,
    is_asking: bool,
}

impl ViewPage {
    /// Takes news of the session.
    pub(super) fn see(&mut self, glance: Glance, now_s: f64) {
        self.glance = Some(glance);
        self.seen_s = now_s;
    }

    /// After how long the page has something new to show by itself.
    pub(super) fn next_change(&self) -> Option<Duration> {
        let glance = self.glance.as_ref()?;
        let runs = glance.screen_left_s.is_some() || glance.session_left_s.is_some();
        runs.then_some(BETWEEN_LOOKS)
    }

    /// Draws the page; says what the experimenter asks for.
    pub(super) fn show(&mut self, ui: &mut Ui, now_s: f64) -> Option<Order> {
        let pilot = self.glance.as_ref().and_then(|glance| glance.pilot);
        if let Some(speed) = pilot {
            let band = egui::Frame::new()
                .fill(Color32::from_rgb(240, 190, 60))
                .inner_margin(6);
            Panel::top("pilot").frame(band).show(ui, |ui| {
                let words = format!("PILOT, times {speed}\u{d7} shorter: not a real session");
                ui.vertical_centered(|ui| {
                    ui.label(RichText::new(words).color(Color32::BLACK).strong())
                });
            });
        }
        let foot = egui::Frame::side_top_panel(ui.style()).inner_margin(14);
        let order = Panel::bottom("orders")
            .frame(foot)
            .show(ui, |ui| self.orders(ui))
            .inner;
        let frame = egui::Frame::central_panel(ui.style()).inner_margin(20);
        egui::CentralPanel::default()
            .frame(frame)
            .show(ui, |ui| match &self.glance {
                Some(glance) => seen(ui, glance, now_s - self.seen_s),
                None => desk::heading(
                    ui,
                    "The session opens",
                    "The window is sized and its frames are timed.",
                ),
            });
        order
    }

    /// Pause, stop and notes.
    fn orders(&mut self, ui: &mut Ui) -> Option<Order> {
        let order = ui.horizontal(|ui| self.note_field(ui)).inner;
        for words in self.noted.iter().rev().take(2).rev() {
            desk::remark(ui, format!("noted: {words}"));
        }
        ui.add_space(4.0);
        let pushed = ui.horizontal(|ui| self.buttons(ui)).inner;
        order.or(pushed)
    }

    fn note_field(&mut self, ui: &mut Ui) -> Option<Order> {
        let label = ui.label("Note");
        let width = (ui.available_width() - 130.0).max(120.0);
        let edit = egui::TextEdit::singleline(&mut self.words).desired_width(width);
        let field = ui.add(edit).labelled_by(label.id);
        let is_entered =
            field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
        let is_pushed = ui.button("Add note").clicked();
        let words = self.words.trim().to_owned();
        if !(is_entered || is_pushed) || words.is_empty() {
            return None;
        }
        self.words.clear();
        self.noted.push(words.clone());
        Some(Order::Note(words))
    }

    fn buttons(&mut self, ui: &mut Ui) -> Option<Order> {
        if self.is_asking {
            let is_stopped = ui.button("Stop now").clicked();
            self.is_asking = !(ui.button("Go on").clicked() || is_stopped);
            ui.label(RichText::new("Stop the session? Every rating is kept.").strong());
            return is_stopped.then_some(Order::Stop);
        }
        let is_resting = self.glance.as_ref().is_some_and(|glance| glance.is_resting);
        let (words, order) = if is_resting {
            ("Resume", Order::Resume)
        } else {
            ("Pause", Order::Pause)
        };
        let is_pushed = ui.button(words).clicked();
        self.is_asking = ui.button("Stop the session...").clicked();
        is_pushed.then_some(order)
    }
}

/// What there is to see, `since_s` seconds after it was told.
fn seen(ui: &mut Ui, glance: &Glance, since_s: f64) {
    desk::remark(ui, glance.title.as_str());
    let [trial, whole] = glance.trial;
    let phase = if glance.is_practice { ", practice" } else { "" };
    ui.heading(RichText::new(format!("Trial {trial} of {whole}{phase}")).strong());
    let left = |seconds: Option<f64>| seconds.map(|seconds| (seconds - since_s).max(0.0));
    ui.horizontal_wrapped(|ui| {
        let mut words = format!("The subject {}", glance.screen);
        if let Some(seconds) = left(glance.screen_left_s) {
            let left = format!(", {seconds:.0} s left");
            words.push_str(&left);
        }
        ui.label(RichText::new(words).size(20.0));
    });
    ui.add_space(6.0);
    desk::facts(ui, "session", |ui| {
        desk::fact(ui, "image", glance.stimulus.as_deref().unwrap_or("none"));
        let pace = left(glance.session_left_s).map_or_else(|| "not known yet".to_owned(), minutes);
        desk::fact(ui, "session left", pace);
        desk::fact(ui, "missed frames", glance.missed_frames.to_string());
    });
    desk::remark(ui, glance.refresh.as_str());
    ui.add_space(10.0);
    desk::remark(ui, "Ratings so far, trial by trial");
    rating_plot::show(ui, glance);
}

/// A time in words: `about 4 min`.
fn minutes(seconds: f64) -> String {
    if seconds < 60.0 {
        return "less than a minute".to_owned();
    }
    format!("about {:.0} min", seconds / 60.0)
}

#[cfg(test)]
mod tests;
