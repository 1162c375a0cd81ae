//! The session in a full-screen window, one image pixel on one pixel of the screen.

mod app;
mod before;
#[cfg(test)]
mod by_name;
mod clock;
mod desk;
mod gate;
mod geometry;
mod input;
mod intake_page;
#[cfg(test)]
mod mid_grey;
mod monitor;
mod paint;
mod proof;
mod screen_mode;
mod screen_watch;
mod server_screen;
mod set_text;
mod station;
mod swap_watch;
mod view;
mod window_manager;

use std::cell::RefCell;
use std::rc::Rc;

use eframe::egui::ViewportBuilder;
use eframe::{NativeOptions, Renderer};
use protocols::Study;

use crate::{Display, ExperimentError, RunOptions, SessionEnd, StationFile, StimulusSet};

use crate::script_fonts::ScriptFonts;
use app::{Aside, SessionApp, Show};
use clock::Clock;
use paint::Pictures;
pub use screen_mode::{ScreenReport, check_screen};
use screen_watch::ScreenWatch;
pub use station::measure_station;
use swap_watch::SwapWatch;
use view::ViewLink;
pub use view::experimenters_view;

/// The present time.
pub(crate) fn utc_now() -> jiff::Timestamp {
    Clock::start().zero()
}

/// What the window leaves behind when it is closed.
type Outcome = Rc<RefCell<Option<Result<SessionEnd, ExperimentError>>>>;

/// Runs one session in a full-screen window, or resumes it.
///
/// # Errors
///
/// The stimulus set or the ratings on disk cannot be used, another window runs the same subject, the
/// window cannot be opened or does not fill the monitor, the images do not fit, or a rating could not be
/// written. What was rated before an error is on disk.
pub fn run(study: &Study, options: &RunOptions) -> Result<SessionEnd, ExperimentError> {
    let set = StimulusSet::read(study, &options.stimuli_dir)?;
    let station = options.station.clone();
    let display = station
        .as_ref()
        .map_or(Ok(Display::Srgb), StationFile::display)?;
    let (set, out_of_gamut_px) = set.for_display(study, &options.stimuli_dir, &display)?;
    let clock = Clock::start();
    let sitting = crate::sitting::Sitting::open(study, &set, options, clock.zero())?;
    let outcome = Outcome::default();
    let app_outcome = Rc::clone(&outcome);
    let title = format!("{} - subject {}", study.protocol.study, options.subject);
    let protocol = study.protocol.clone();
    let (pilot, monitor) = (options.pilot, options.monitor.clone());
    let view_study = study.clone();
    let view_options = options.clone();
    open(full_screen(&title), move |creation| {
        ScriptFonts::new(&view_study).install(&creation.egui_ctx);
        let show = Show {
            plan: protocol.session,
            pictures: Pictures::upload(&creation.egui_ctx, set, &protocol.stimuli),
            pilot,
            monitor,
            station,
            display,
            out_of_gamut_px,
        };
        let context = &creation.egui_ctx;
        let view = view_options.view.as_ref();
        let view =
            view.map(|view| ViewLink::open(view, &view_study, &view_options, context.clone()));
        let aside = Aside {
            view: view.transpose()?,
            watch: ScreenWatch::start(context.clone()),
            swaps: SwapWatch::start(creation, clock),
            asks_focus_until_s: 0.0,
        };
        Ok(Box::new(SessionApp::new(
            sitting,
            show,
            aside,
            clock,
            app_outcome,
        )))
    })?;
    let left = outcome.borrow_mut().take();
    left.unwrap_or_else(|| {
        Err(ExperimentError::Window {
            reason: "it was closed by the system".to_owned(),
        })
    })
}

/// A window that fills a monitor.
fn full_screen(title: &str) -> ViewportBuilder {
    ViewportBuilder::default()
        .with_title(title)
        .with_app_id("acuity")
        .with_decorations(false)
        .with_fullscreen(true)
}

/// Opens a window and runs it to its end.
fn open(
    viewport: ViewportBuilder,
    app: impl FnOnce(&eframe::CreationContext<'_>) -> Result<Box<dyn eframe::App>, ExperimentError>,
) -> Result<(), ExperimentError> {
    let title = viewport.title.clone().unwrap_or_default();
    let native = NativeOptions {
        viewport,
        renderer: Renderer::Glow,
        dithering: false,
        run_and_return: true,
        ..NativeOptions::default()
    };
    let mut fault = None;
    let create = |creation: &eframe::CreationContext<'_>| {
        app(creation).map_err(|error| {
            let words = error.to_string();
            fault = Some(error);
            words.into()
        })
    };
    let opened = eframe::run_native(&title, native, Box::new(create));
    match (opened, fault) {
        (_, Some(error)) => Err(error),
        (Ok(()), None) => Ok(()),
        (Err(error), None) => Err(ExperimentError::Window {
            reason: reason(&error),
        }),
    }
}

/// Why there is no window, in words that help; winit's own name a line of its source.
fn reason(error: &eframe::Error) -> String {
    match (error, std::env::var("DISPLAY")) {
        (eframe::Error::WinitEventLoop(_), Ok(display)) if !display.is_empty() => {
            format!("the display {display:?} does not answer")
        }
        (eframe::Error::WinitEventLoop(_), _) => "DISPLAY is not set".to_owned(),
        (other, _) => other.to_string(),
    }
}
