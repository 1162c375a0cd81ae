//! The window's loop: input to the session, ratings to disk, the frame to the screen.

use eframe::egui::{self, CursorIcon, ViewportCommand};
use protocols::SessionPlan;

use super::Outcome;
use super::clock::Clock;
use super::gate::{Gate, Sizes};
use super::geometry::{Geometry, needed_px};
use super::input;
use super::paint::{Brush, Pictures};
use crate::sidecar::Station;
use crate::sitting::Sitting;
use crate::{Event, ExperimentError, Key, Screen, SessionEnd};

/// What the subject is to see.
pub(crate) struct Show {
    pub(crate) plan: SessionPlan,
    pub(crate) pictures: Pictures,
    pub(crate) pilot: Option<f64>,
}

/// A session in its window.
pub(crate) struct SessionApp {
    sitting: Sitting,
    show: Show,
    clock: Clock,
    outcome: Outcome,
    gate: Option<Gate>,
    was_focused: bool,
    focus_losses: u32,
}

impl SessionApp {
    pub(crate) fn new(sitting: Sitting, show: Show, clock: Clock, outcome: Outcome) -> Self {
        Self {
            sitting,
            show,
            clock,
            outcome,
            gate: Some(Gate::default()),
            was_focused: false,
            focus_losses: 0,
        }
    }

    /// One frame; says how the session ended, once it has.
    fn frame(&mut self, ui: &egui::Ui, now_s: f64) -> Result<Option<SessionEnd>, ExperimentError> {
        let context = ui.ctx();
        let sizes = Sizes::of(context);
        let geometry = Geometry {
            size_px: sizes.window_px.map(|pixels| pixels as f32).into(),
            pixels_per_point: sizes.pixels_per_point,
        };
        let brush = Brush {
            painter: ui.painter(),
            geometry,
            plan: &self.show.plan,
            pointer: context.input(|input| input.pointer.latest_pos()),
        };
        brush.background();
        if let Some(gate) = &mut self.gate {
            context.request_repaint();
            context.set_cursor_icon(CursorIcon::None);
            if !gate.is_open(context, sizes, now_s)? {
                return Ok(None);
            }
            self.gate = None;
            check_fit(
                needed_px(&self.show.plan, self.show.pictures.image_px),
                sizes,
            )?;
            self.sitting.begin(station(sizes), now_s)?;
        }

        let screen = self.sitting.session.screen();
        let mut events = input::events(context, geometry, screen, &self.show.plan);
        if context.input(|input| input.viewport().close_requested()) {
            context.send_viewport_cmd(ViewportCommand::CancelClose);
            events.extend((screen != Screen::ConfirmStop).then_some(Event::Key(Key::Escape)));
        }
        for event in events {
            self.sitting.session.on(event, now_s);
            self.sitting.save(now_s)?;
        }
        let session = &mut self.sitting.session;
        session.on(Event::Frame, now_s);
        if !screen.has_scale() && session.screen().has_scale() {
            let rest = geometry.pointer_rest(&self.show.plan);
            context.send_viewport_cmd(ViewportCommand::CursorPosition(rest));
        }
        if let Some(ending) = session.ending() {
            return self
                .sitting
                .finish(ending, self.focus_losses, now_s)
                .map(Some);
        }
        brush.screen(session, &self.show.pictures);
        if let Some(speed) = self.show.pilot {
            brush.pilot(speed);
        }
        if matches!(session.screen(), Screen::Blank | Screen::Exposure(..)) {
            context.set_cursor_icon(CursorIcon::None);
        }
        if session.needs_frames() {
            context.request_repaint();
        }
        self.note_focus(context);
        Ok(None)
    }

    /// Counts how often the window loses the keyboard while images are shown or awaited.
    fn note_focus(&mut self, context: &egui::Context) {
        let is_focused = context.input(|input| input.focused);
        let is_trial = matches!(
            self.sitting.session.screen(),
            Screen::Blank | Screen::Exposure(..)
        );
        if self.was_focused && !is_focused && is_trial {
            self.focus_losses += 1;
        }
        self.was_focused = is_focused;
    }
}

impl eframe::App for SessionApp {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        if self.outcome.borrow().is_some() {
            return;
        }
        let now_s = self.clock.now_s();
        let end = self.frame(ui, now_s).transpose();
        if let Some(end) = end {
            *self.outcome.borrow_mut() = Some(end);
            ui.ctx().send_viewport_cmd(ViewportCommand::Close);
        }
    }

    fn clear_color(&self, _visuals: &egui::Visuals) -> [f32; 4] {
        egui::Color32::from_gray(self.show.plan.background_srgb).to_normalized_gamma_f32()
    }
}

fn check_fit(needed_px: [u32; 2], sizes: Sizes) -> Result<(), ExperimentError> {
    let found_px = sizes.window_px;
    if found_px[0] >= needed_px[0] && found_px[1] >= needed_px[1] {
        return Ok(());
    }
    Err(ExperimentError::TooSmall {
        found_px,
        needed_px,
    })
}

fn station(sizes: Sizes) -> Station {
    Station {
        operating_system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
        window_px: sizes.window_px,
        monitor_px: sizes.monitor_px,
        pixels_per_point: sizes.pixels_per_point,
    }
}
