//! The report: made here, opened in the browser, its figure shown.

use std::path::PathBuf;

use analysis::{Pilots, ReportAge, ReportSummary};
use eframe::egui::{ColorImage, Image, TextureHandle, TextureOptions, Ui, vec2};
use experiment::ScreenImage;

use super::fault::Fault;
use super::gallery::small;
use super::job::{Job, WhenDropped};
use super::look::{self, Enabled};
use super::page::{Around, Asked, open};
use super::study_state::{ReportState, Step, StudyState};
use crate::predict::default_file;

/// The longer side of the figure in pixels.
const FIGURE_PX: usize = 1600;

/// The figure of the report.
#[derive(Default)]
enum Figure {
    #[default]
    Unread,
    Reading(Job<Option<ColorImage>>),
    Shown(TextureHandle),
    /// There is none that could be shown; the report has it in any case.
    None,
}

/// The page.
#[derive(Default)]
pub(crate) struct ReportPage {
    making: Option<Job<Result<ReportSummary, Fault>>>,
    opening: Option<Job<Option<PathBuf>>>,
    /// A page that no browser would open.
    unopened: Option<PathBuf>,
    warnings: Vec<String>,
    fault: Option<Fault>,
    figure: Figure,
}

impl ReportPage {
    /// Whether a report is being made.
    pub(crate) fn is_busy(&self) -> bool {
        self.making.is_some()
    }

    /// Takes what the work has come to.
    pub(crate) fn poll(&mut self) -> Asked {
        if let Some(failed) = self.opening.as_ref().and_then(Job::poll) {
            self.opening = None;
            self.unopened = failed.unwrap_or_default();
        }
        let Some(made) = self.making.as_ref().and_then(Job::poll) else {
            return Asked::Nothing;
        };
        self.making = None;
        self.figure = Figure::Unread;
        match made.and_then(|made| made) {
            Ok(summary) => self.warnings = summary.warnings,
            Err(fault) => self.fault = Some(fault),
        }
        Asked::ReadAgain
    }

    pub(crate) fn show(&mut self, ui: &mut Ui, around: Around<'_>) {
        let folder = around.state.folders.report.display();
        let words = format!("Analysis of variance, figures and tables, in {folder}");
        look::page_head(ui, "Report", &words);
        if let ReportState::Wrong(fault) = &around.state.report {
            look::fault(ui, fault);
        }
        if let Some(fault) = &self.fault {
            look::fault(ui, fault);
        }
        look::card(ui, |ui| self.state(ui, around));
        if !self.warnings.is_empty() {
            look::card(ui, |ui| {
                look::title(ui, "What its reader must know");
                for warning in &self.warnings {
                    ui.label(warning);
                }
            });
        }
        if let Some(page) = &around.state.simulated_page {
            look::card(ui, |ui| self.simulated(ui, around, page));
        }
    }

    fn state(&mut self, ui: &mut Ui, around: Around<'_>) {
        if self.making.is_some() {
            ui.horizontal(|ui| {
                ui.spinner();
                ui.label("Making the report");
            });
            return;
        }
        let (mark, words) = around.state.of(Step::Report);
        look::state(ui, mark, &words);
        let is_current = around.state.report == ReportState::Aged(ReportAge::Current);
        let is_there =
            matches!(&around.state.report, ReportState::Aged(age) if *age != ReportAge::NotMade);
        let may_make = around.hold.is_none() && around.state.report != ReportState::NoRatings;
        ui.horizontal(|ui| {
            let made = if is_current {
                look::secondary(ui, may_make.into(), "Make it again")
            } else {
                look::primary(ui, may_make.into(), "Make the report")
            };
            if made.clicked() {
                self.start(ui, around);
            }
            let opened = match (is_there, is_current) {
                (false, _) => None,
                (true, true) => Some(look::primary(ui, Enabled::Yes, "Open the report")),
                (true, false) => Some(look::secondary(ui, Enabled::Yes, "Open the old report")),
            };
            if opened.is_some_and(|button| button.clicked()) {
                let page = around.state.folders.report.join("report.html");
                self.open(ui, around, page);
            }
        });
        if let Some(reason) = around.hold {
            look::weak(ui, reason);
        }
        if let Some(page) = &self.unopened {
            ui.label("No browser would open the report. Its file:");
            ui.monospace(page.display().to_string());
        }
        if is_there {
            self.figure(ui, around.state);
        }
    }

    fn open(&mut self, ui: &Ui, around: Around<'_>, page: PathBuf) {
        self.unopened = None;
        self.opening = Some(open(ui.ctx(), around.tools, page));
    }

    fn simulated(&mut self, ui: &mut Ui, around: Around<'_>, page: &std::path::Path) {
        look::title(ui, "Simulated observers");
        look::weak(
            ui,
            "A report of model observers is there too; no person was asked.",
        );
        if look::secondary(ui, Enabled::Yes, "Open the simulated report").clicked() {
            self.open(ui, around, page.to_owned());
        }
    }

    fn start(&mut self, ui: &Ui, around: Around<'_>) {
        let (study, folders) = (around.state.study.clone(), around.state.folders.clone());
        let predictions = around.tools.place.root.join(default_file(&study));
        self.fault = None;
        self.warnings.clear();
        self.making = Some(Job::start(ui.ctx(), WhenDropped::Await, move |_| {
            let predictions = Some(predictions).filter(|file| file.is_file());
            let (data, out) = (&folders.data, Some(folders.report.as_path()));
            let pilots = Pilots::LeftOut;
            let made = analysis::report_beside(&study, data, out, pilots, predictions.as_deref());
            made.map_err(Fault::of)
        }));
    }

    /// The figure of the report, once it is read.
    fn figure(&mut self, ui: &mut Ui, state: &StudyState) {
        match &self.figure {
            Figure::Unread => {
                let folder = state.folders.report.clone();
                let read = move |_: &_| {
                    let names = ["figure-10.png", "figure.png"];
                    names
                        .iter()
                        .find_map(|name| read_figure(&folder.join(name)))
                };
                self.figure = Figure::Reading(Job::start(ui.ctx(), WhenDropped::Leave, read));
            }
            Figure::Reading(job) => {
                let Some(read) = job.poll() else { return };
                let upload = |image| {
                    let options = TextureOptions::LINEAR;
                    Figure::Shown(ui.ctx().load_texture("figure", image, options))
                };
                self.figure = read.unwrap_or_default().map_or(Figure::None, upload);
                ui.ctx().request_repaint();
            }
            Figure::Shown(figure) => {
                let size = figure.size_vec2();
                // As much of it as the window shows below the rest of the page.
                let high = (ui.ctx().content_rect().height() - 415.0).clamp(360.0, 620.0);
                let room = vec2(ui.available_width(), high);
                let size = size * (room / size).min_elem();
                let image = Image::from_texture(figure).fit_to_exact_size(size);
                let words = "The figure of the report: mean ratings";
                ui.vertical_centered(|ui| ui.add(image.corner_radius(4).alt_text(words)));
            }
            Figure::None => {}
        }
    }
}

fn read_figure(file: &std::path::Path) -> Option<ColorImage> {
    let image = image::open(file).ok()?.into_rgb8();
    let image = ScreenImage {
        size_px: [image.width(), image.height()],
        rgb: image.into_raw(),
    };
    Some(small(&image, FIGURE_PX))
}
