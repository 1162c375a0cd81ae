//! The app: the study's steps in a window, each with its state and what can be done about it.
//!
//! It calls the same functions as the commands do, on threads of their own, and starts sessions as processes of
//! their own; so no frame waits, and the end of the app ends no session.
//!
//! Not here: the subject's screens (crate `experiment`), which look the same whatever the theme.

mod desk;
mod desktop_theme;
mod fault;
#[cfg(test)]
mod fixture;
mod gallery;
mod icon;
mod job;
mod launcher;
mod look;
mod page;
mod report_page;
mod screen_reader;
mod session_table;
mod sessions_page;
mod settings;
mod station_page;
mod step_row;
mod stimuli_page;
mod study_app;
mod study_state;
mod welcome_page;
mod zoom;

use std::env;
use std::path::Path;
use std::sync::Arc;

use anyhow::Context as _;
use eframe::egui::{self, ViewportBuilder};
use eframe::{NativeOptions, Renderer};
use experiment::StationFile;

use launcher::Processes;
use screen_reader::ScreenReader;
use settings::Settings;
use study_app::StudyApp;
use study_state::Place;
use zoom::Zoom;

/// Whether a window can be opened here at all.
pub(crate) fn has_display() -> bool {
    env::var_os("DISPLAY").is_some_and(|display| !display.is_empty())
}

/// Opens the app on a protocol, or on the question which one, and returns when its window is closed.
pub(crate) fn open(protocol: Option<&Path>) -> anyhow::Result<()> {
    let place = Place {
        root: env::current_dir().context("found no working folder; start in another")?,
        station: StationFile::default_path(),
    };
    let mut app = StudyApp::new(place, Arc::new(Processes), Settings::default_path());
    if let Some(protocol) = protocol {
        app.open(protocol);
    }
    let viewport = ViewportBuilder::default()
        .with_title("Acuity")
        .with_app_id("acuity")
        .with_icon(icon::icon())
        .with_inner_size([1280.0, 800.0])
        .with_min_inner_size([800.0, 500.0]);
    let native = NativeOptions {
        viewport,
        renderer: Renderer::Glow,
        run_and_return: true,
        ..NativeOptions::default()
    };
    let opened = eframe::run_native(
        "Acuity",
        native,
        Box::new(move |creation| {
            let context = &creation.egui_ctx;
            look::dress(context);
            ScreenReader::listen(context);
            app.ask_theme(context);
            Ok(Box::new(Window {
                app,
                zoom: Zoom::default(),
            }))
        }),
    );
    opened.map_err(|error| {
        anyhow::anyhow!(
            "no window could be opened ({error}); the app needs an X11 display with OpenGL 2 or later, the commands need none: acuity --help"
        )
    })
}

/// The app in its window.
struct Window {
    app: StudyApp,
    zoom: Zoom,
}

impl eframe::App for Window {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        self.zoom.follow(ui.ctx());
        self.app.show(ui);
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }
}
