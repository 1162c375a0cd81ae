//! The station's window: five pages that fill the monitor which is measured.
//!
//! What is typed stands in a [`StationDraft`]; saving writes the station's file, whole or not at all.

mod color_page;
mod distance_page;
mod patch_view;
mod refresh_page;
mod room_page;
mod screen_page;

use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use eframe::egui::{self, Key, Panel, RichText, Ui, ViewportCommand};
use protocols::Study;

use super::clock::Clock;
use super::gate::{Gate, Sizes};
use super::monitor::Monitor;
use super::{desk, full_screen, open};
use crate::station_draft::{ModeFault, ScreenFacts, StationDraft};
use crate::{ExperimentError, StationFile};
use refresh_page::Timing;

/// A page of the station.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Page {
    #[default]
    Screen,
    Distance,
    Refresh,
    Color,
    Room,
}

impl Page {
    const ALL: [Self; 5] = [
        Self::Screen,
        Self::Distance,
        Self::Refresh,
        Self::Color,
        Self::Room,
    ];

    fn name(self) -> &'static str {
        match self {
            Self::Screen => "Screen",
            Self::Distance => "Distance",
            Self::Refresh => "Refresh",
            Self::Color => "Colour",
            Self::Room => "Room",
        }
    }
}

type Outcome = Rc<RefCell<Result<Option<StationFile>, ExperimentError>>>;

/// Measures this computer's screen in a window and writes `path`; `None` if the window was closed without saving.
/// The window is dark unless a theme is named.
///
/// # Errors
///
/// There is a station at `path` that cannot be read, the window cannot be opened, there is no such monitor, or the
/// file cannot be written.
pub fn measure_station(
    study: &Study,
    path: &Path,
    monitor: Option<String>,
    theme: Option<egui::Theme>,
) -> Result<Option<StationFile>, ExperimentError> {
    let before = if path.exists() {
        Some(StationFile::read(path)?)
    } else {
        None
    };
    let wanted = monitor.or_else(|| before.as_ref()?.monitor.clone());
    let outcome: Outcome = Rc::new(RefCell::new(Ok(None)));
    let app = StationApp {
        pages: Pages::new(StationDraft::new(study, before)),
        path: path.to_owned(),
        wanted,
        monitor: Monitor::default(),
        gate: Gate::new(),
        clock: Clock::start(),
        asked: None,
        outcome: Rc::clone(&outcome),
        is_closing: false,
    };
    let title = format!("Acuity station - {}", study.protocol.study);
    open(full_screen(&title), |creation| {
        desk::dress(&creation.egui_ctx);
        // X11 has no theme of its own.
        creation
            .egui_ctx
            .set_theme(theme.unwrap_or(egui::Theme::Dark));
        Ok(Box::new(app))
    })?;
    outcome.replace(Ok(None))
}

/// What the experimenter asked for.
#[derive(Clone, Debug, PartialEq)]
enum Wish {
    /// Measure the monitor with this index.
    Monitor(usize),
    /// Write this station.
    Save(Box<StationFile>),
    /// Close without saving.
    Close,
}

/// The pages and what they remember.
struct Pages {
    draft: StationDraft,
    page: Page,
    /// The patch that fills the screen, if one does.
    patch: Option<patch_view::PatchView>,
    timing: Timing,
    /// The names of all monitors.
    monitors: Vec<String>,
    is_asking: bool,
}

impl Pages {
    fn new(draft: StationDraft) -> Self {
        Self {
            draft,
            page: Page::default(),
            patch: None,
            timing: Timing::default(),
            monitors: Vec::new(),
            is_asking: false,
        }
    }

    /// Draws the present page; says what the experimenter wants.
    fn show(&mut self, ui: &mut Ui, now_s: f64) -> Option<Wish> {
        if let Some(view) = &mut self.patch {
            if !view.show(ui, &mut self.draft) {
                self.patch = None;
            }
            return None;
        }
        if ui.input(|input| input.key_pressed(Key::Escape)) {
            self.is_asking = !self.is_asking;
        }
        let foot =
            egui::Frame::side_top_panel(ui.style()).inner_margin(egui::Margin::symmetric(18, 6));
        let foot = Panel::bottom("foot").frame(foot);
        let mut wish = foot.show(ui, |ui| self.foot(ui)).inner;
        let side = egui::Frame::side_top_panel(ui.style()).inner_margin(18);
        let steps = Panel::left("steps")
            .resizable(false)
            .exact_size(240.0)
            .frame(side);
        steps.show(ui, |ui| self.steps(ui));
        let frame = egui::Frame::central_panel(ui.style()).inner_margin(24);
        egui::CentralPanel::default()
            .frame(frame)
            .show(ui, |ui| match self.page {
                Page::Screen => {
                    wish = screen_page::show(ui, &mut self.draft, &self.monitors).or(wish.take());
                }
                Page::Distance => distance_page::show(ui, &mut self.draft),
                Page::Refresh => {
                    let nominal_hz = self.draft.screen().nominal_hz;
                    if let Some(refresh) = self.timing.show(ui, nominal_hz, now_s) {
                        self.draft.set_refresh(refresh);
                    }
                }
                Page::Color => self.patch = color_page::show(ui, &mut self.draft),
                Page::Room => room_page::show(ui, &mut self.draft),
            });
        wish
    }

    fn steps(&mut self, ui: &mut Ui) {
        ui.heading(RichText::new("Station").strong());
        ui.add_space(12.0);
        let layout = egui::Layout::top_down_justified(egui::Align::LEFT);
        ui.with_layout(layout, |ui| {
            for (number, page) in (1..).zip(Page::ALL) {
                let words = format!("{number}  {}", page.name());
                let button = egui::Button::selectable(self.page == page, words);
                if ui.add(button.min_size(egui::vec2(0.0, 38.0))).clicked() {
                    self.page = page;
                }
                self.state_below(ui, page);
                ui.add_space(8.0);
            }
        });
    }

    /// How far a page is, below its name, which stands after the number.
    fn state_below(&self, ui: &mut Ui, page: Page) {
        ui.scope(|ui| {
            ui.spacing_mut().interact_size.y = 18.0;
            ui.horizontal_wrapped(|ui| {
                ui.add_space(36.0);
                desk::remark(ui, self.state_of(page));
            });
        });
    }

    /// How far a page is, in a few words.
    fn state_of(&self, page: Page) -> String {
        let draft = &self.draft;
        match page {
            Page::Screen if draft.is_sized() => format!("{:.4} mm a pixel", draft.pixel_pitch_mm()),
            Page::Screen => "not measured".to_owned(),
            Page::Distance if !draft.is_sized() => "after the screen".to_owned(),
            Page::Distance => draft
                .distance_cm()
                .map_or_else(|fault| fault, |cm| format!("{cm} cm")),
            Page::Refresh => self.timing.in_short(),
            Page::Color => color_page::in_short(draft),
            Page::Room => match draft.peak_cd_m2() {
                Ok(Some(peak)) => format!("peak {peak} cd/m2"),
                _ => "notes".to_owned(),
            },
        }
    }

    /// What is missing, and the way out.
    fn foot(&mut self, ui: &mut Ui) -> Option<Wish> {
        ui.add_space(8.0);
        let row = ui.horizontal(|ui| {
            let layout = egui::Layout::right_to_left(egui::Align::Center);
            ui.with_layout(layout, |ui| self.ways_out(ui)).inner
        });
        ui.add_space(8.0);
        row.inner
    }

    fn ways_out(&mut self, ui: &mut Ui) -> Option<Wish> {
        if self.is_asking {
            let is_closed = ui.button("Close without saving").clicked();
            self.is_asking = !ui.button("Go on").clicked();
            return is_closed.then_some(Wish::Close);
        }
        let station = self.draft.station();
        let words = RichText::new("Save and close").strong();
        let save = ui.add_enabled(station.is_ok(), egui::Button::new(words));
        self.is_asking = ui.button("Close").clicked();
        let layout = egui::Layout::left_to_right(egui::Align::Center);
        ui.with_layout(layout, |ui| match &station {
            Ok(_) => desk::good(ui, "Ready to be saved"),
            Err(fault) => {
                ui.add(egui::Label::new(fault).truncate());
            }
        });
        let station = station.ok().filter(|_| save.clicked())?;
        Some(Wish::Save(Box::new(station)))
    }
}

/// What the X server said of a monitor of this name and size.
struct Asked {
    name: Option<String>,
    size_px: [u32; 2],
    one_to_one: Option<Result<(), ModeFault>>,
}

/// The window.
struct StationApp {
    pages: Pages,
    path: PathBuf,
    wanted: Option<String>,
    monitor: Monitor,
    gate: Gate,
    clock: Clock,
    asked: Option<Asked>,
    outcome: Outcome,
    /// The window is on its way out.
    is_closing: bool,
}

impl StationApp {
    fn close(&mut self, context: &egui::Context) {
        self.is_closing = true;
        context.send_viewport_cmd(ViewportCommand::Close);
    }

    /// Whether sessions could be shown here one to one; the X server is asked once for each monitor and size.
    fn one_to_one(&mut self, sizes: Sizes) -> Option<Result<(), ModeFault>> {
        let (name, size_px) = (&self.monitor.name, sizes.monitor_px);
        if let Some(asked) = &self.asked
            && (&asked.name, asked.size_px) == (name, size_px)
        {
            return asked.one_to_one.clone();
        }
        let mode = self.monitor.mode().filter(|mode| mode.is_known());
        let fault = |error: ExperimentError| ModeFault {
            may_be_right: matches!(error, ExperimentError::NotNative { .. }),
            words: error.to_string(),
        };
        let one_to_one = mode.map(|mode| mode.check(None).map_err(fault));
        self.asked = Some(Asked {
            name: name.clone(),
            size_px,
            one_to_one: one_to_one.clone(),
        });
        one_to_one
    }

    fn frame(&mut self, ui: &mut Ui) -> Result<(), ExperimentError> {
        let context = ui.ctx().clone();
        let now_s = self.clock.now_s();
        let sizes = Sizes::of(&context);
        let is_there = self.monitor.is_wanted(self.wanted.as_deref(), &context)?;
        if !is_there || !self.gate.is_open(&context, sizes, now_s)? {
            context.request_repaint();
            return Ok(());
        }
        desk::scale(&context, sizes);
        self.wanted = None;
        self.pages.monitors = self.monitor.all().to_vec();
        let one_to_one = self.one_to_one(sizes);
        self.pages.draft.stand_on(ScreenFacts {
            name: self.monitor.name.clone(),
            size_px: sizes.monitor_px,
            nominal_hz: self.monitor.nominal_hz,
            one_to_one,
        });
        if context.input(|input| input.viewport().close_requested()) {
            context.send_viewport_cmd(ViewportCommand::CancelClose);
            self.pages.is_asking = true;
        }
        match self.pages.show(ui, now_s) {
            Some(Wish::Monitor(index)) => {
                self.wanted = self.monitor.all().get(index).cloned();
                self.gate = Gate::new();
                context.request_repaint();
            }
            Some(Wish::Save(station)) => {
                station.write(&self.path)?;
                *self.outcome.borrow_mut() = Ok(Some(*station));
                self.close(&context);
            }
            Some(Wish::Close) => self.close(&context),
            None => {}
        }
        Ok(())
    }
}

impl eframe::App for StationApp {
    fn ui(&mut self, ui: &mut Ui, frame: &mut eframe::Frame) {
        if self.is_closing {
            return;
        }
        self.monitor = Monitor::of(frame);
        if let Err(error) = self.frame(ui) {
            *self.outcome.borrow_mut() = Err(error);
            self.close(ui.ctx());
        }
    }
}

#[cfg(test)]
mod tests;
