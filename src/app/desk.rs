//! One study on the desk: its state as last read, its four steps, and the page of the step chosen.

use std::path::PathBuf;

use eframe::egui::{Context, Ui};

use super::fault::Fault;
use super::job::{Job, WhenDropped};
use super::look;
use super::page::{Around, Asked, Tools};
use super::report_page::ReportPage;
use super::sessions_page::SessionsPage;
use super::station_page::StationPage;
use super::step_row;
use super::stimuli_page::StimuliPage;
use super::study_state::{SessionsState, Step, StudyState};

/// What is being read.
enum Reading {
    All(Job<Result<Box<StudyState>, Fault>>),
    Sessions(Job<SessionsState>),
}

/// A study that is open.
pub(crate) struct Desk {
    /// The protocol file.
    pub(crate) protocol: PathBuf,
    state: Option<Box<StudyState>>,
    fault: Option<Fault>,
    step: Option<Step>,
    reading: Option<Reading>,
    /// What is to be read when the present reading is over.
    wanted: Asked,
    stimuli: StimuliPage,
    station: StationPage,
    sessions: SessionsPage,
    report: ReportPage,
}

impl Desk {
    /// A study to be read.
    pub(crate) fn new(protocol: PathBuf) -> Self {
        Self {
            protocol,
            state: None,
            fault: None,
            step: None,
            reading: None,
            wanted: Asked::ReadAgain,
            stimuli: StimuliPage::default(),
            station: StationPage::default(),
            sessions: SessionsPage::default(),
            report: ReportPage::default(),
        }
    }

    /// The study's title, once it is known.
    pub(crate) fn title(&self) -> Option<&str> {
        let state = self.state.as_deref()?;
        Some(&state.study.protocol.title)
    }

    /// Whether something runs that another study would end.
    pub(crate) fn is_busy(&self) -> bool {
        self.stimuli.is_busy() || self.sessions.is_busy() || self.report.is_busy()
    }

    /// Reads all again, when there is time: while a session runs only its ratings are looked at.
    pub(crate) fn read_again(&mut self) {
        self.wanted = Asked::ReadAgain;
    }

    /// Goes to the page of a step.
    pub(crate) fn go(&mut self, step: Step) {
        self.step = Some(step);
    }

    /// Takes what has become of all that runs, and begins to read what has changed.
    pub(crate) fn poll(&mut self, context: &Context, tools: &Tools) {
        let now_s = context.input(|input| input.time);
        let asked = [
            self.stimuli.poll(),
            self.station.poll(),
            self.sessions.poll(now_s),
            self.report.poll(),
        ];
        self.wanted = asked.into_iter().fold(self.wanted, Asked::max);
        self.take();
        if self.reading.is_none() {
            self.read(context, tools);
        }
    }

    fn take(&mut self) {
        match &self.reading {
            Some(Reading::All(job)) => {
                let Some(read) = job.poll() else { return };
                match read.and_then(|read| read) {
                    Ok(state) => {
                        self.step = self.step.or_else(|| Some(state.first_due()));
                        self.fault = None;
                        self.state = Some(state);
                    }
                    Err(fault) => self.fault = Some(fault),
                }
            }
            Some(Reading::Sessions(job)) => {
                let Some(read) = job.poll() else { return };
                if let (Ok(sessions), Some(state)) = (read, &mut self.state) {
                    state.sessions = sessions;
                }
            }
            None => return,
        }
        self.reading = None;
    }

    fn read(&mut self, context: &Context, tools: &Tools) {
        let is_session = self.sessions.is_busy();
        let state = self.state.as_deref();
        self.reading = match (std::mem::take(&mut self.wanted), state) {
            (Asked::Nothing, _) => None,
            (Asked::ReadSessions | Asked::ReadAgain, Some(state)) if is_session => {
                let (study, data) = (state.study.clone(), state.folders.data.clone());
                let read = move |_: &_| SessionsState::read(&study, &data);
                let job = Job::start(context, WhenDropped::Leave, read);
                Some(Reading::Sessions(job))
            }
            _ => {
                let (protocol, place) = (self.protocol.clone(), tools.place.clone());
                let read = move |_: &_| StudyState::read(&protocol, &place).map(Box::new);
                Some(Reading::All(Job::start(context, WhenDropped::Leave, read)))
            }
        };
    }

    /// The steps and the page.
    pub(crate) fn show(&mut self, ui: &mut Ui, tools: &Tools) {
        if let Some(fault) = &self.fault {
            look::heading(ui, "The protocol cannot be used");
            ui.add_space(6.0);
            look::fault(ui, fault);
            return;
        }
        let (Some(state), Some(step)) = (&self.state, self.step) else {
            ui.horizontal(|ui| {
                ui.spinner();
                look::weak(ui, "Reading the study");
            });
            return;
        };
        let step = step_row::show(ui, state, step);
        self.step = Some(step);
        ui.add_space(14.0);
        let hold = self.hold();
        let around = Around { state, tools, hold };
        let asked = match step {
            Step::Stimuli => {
                self.stimuli.show(ui, around);
                Asked::Nothing
            }
            Step::Station => self.station.show(ui, around),
            Step::Sessions => {
                self.sessions.show(ui, around);
                Asked::Nothing
            }
            Step::Report => {
                self.report.show(ui, around);
                Asked::Nothing
            }
        };
        self.wanted = self.wanted.max(asked);
    }

    /// Why nothing heavy may begin now.
    fn hold(&self) -> Option<&'static str> {
        if self.sessions.is_busy() {
            Some("A session is running. Wait for its end: other work would cost it frames.")
        } else if self.stimuli.is_busy() {
            Some("The stimuli are being made.")
        } else if self.report.is_busy() {
            Some("The report is being made.")
        } else {
            None
        }
    }
}
