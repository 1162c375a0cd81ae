//! The sessions: who is done, who is next, who goes on, who is closed.
//!
//! A session runs in a process of its own; while it does, nothing else may begin that would cost it frames.

use std::ffi::OsString;

use eframe::egui::{Key, Ui};
use experiment::ListedSession;
use protocols::SubjectId;

use super::fault::Fault;
use super::job::Job;
use super::launcher::Ended;
use super::look::{self, Enabled};
use super::page::{Around, Asked, Tools, launch};
use super::session_table::{self, Action};
use super::study_state::{Mark, StationState, Step};

/// How often the list is read while a session runs.
const READ_EVERY_S: f64 = 2.0;
/// How many times faster a trial run is, unless the user says otherwise.
const PILOT_SPEED: f64 = 20.0;

/// What stands above the list.
#[derive(Debug, Default)]
enum Panel {
    /// The buttons.
    #[default]
    Buttons,
    /// The code of the next subject.
    Next { code: String, is_fresh: bool },
    /// The code and the speed of a trial run.
    Pilot {
        code: String,
        speed: String,
        is_fresh: bool,
    },
    /// Why a session is closed.
    Close {
        session: Box<ListedSession>,
        reason: String,
    },
}

/// A session, or the closing of one, that runs.
struct Running {
    words: String,
    job: Job<std::io::Result<Ended>>,
    read_at_s: f64,
}

/// The page.
#[derive(Default)]
pub(crate) struct SessionsPage {
    panel: Panel,
    running: Option<Running>,
    outcome: Option<Result<String, Fault>>,
    view_chosen: Option<bool>,
}

/// A session to be begun or resumed.
struct Wanted {
    subject: SubjectId,
    session: u32,
    pilot: Option<f64>,
}

impl SessionsPage {
    /// Whether a session runs.
    pub(crate) fn is_busy(&self) -> bool {
        self.running.is_some()
    }

    /// Takes what the session has come to, and looks at its ratings from time to time.
    pub(crate) fn poll(&mut self, now_s: f64) -> Asked {
        let Some(running) = &mut self.running else {
            return Asked::Nothing;
        };
        let Some(answer) = running.job.poll() else {
            if now_s - running.read_at_s < READ_EVERY_S {
                return Asked::Nothing;
            }
            running.read_at_s = now_s;
            return Asked::ReadSessions;
        };
        self.running = None;
        self.outcome = Some(outcome(answer));
        Asked::ReadAgain
    }

    pub(crate) fn show(&mut self, ui: &mut Ui, around: Around<'_>) {
        let folder = around.state.folders.data.display();
        let words = format!("One session for each subject, in {folder}");
        look::page_head(ui, "Sessions", &words);
        match &self.outcome {
            Some(Err(fault)) => look::fault(ui, fault),
            Some(Ok(said)) => {
                look::card(ui, |ui| look::state(ui, Mark::Done, said));
            }
            None => {}
        }
        let hindrances = &around.state.hindrances;
        for fault in around.state.sessions.faults.iter().chain(hindrances) {
            look::fault(ui, fault);
        }
        look::card(ui, |ui| self.head(ui, around));
        if around.state.sessions.sessions.is_empty() {
            return;
        }
        let may_act = Enabled::from(around.hold.is_none() && !self.is_busy());
        let action = look::card(ui, |ui| {
            session_table::show(ui, &around.state.sessions.sessions, may_act)
        });
        match action {
            Some(Action::Resume(session)) if around.state.hindrance().is_none() => {
                let wanted = Wanted {
                    subject: session.subject,
                    session: session.session,
                    pilot: session.pilot,
                };
                self.start(ui, around, &wanted);
            }
            Some(Action::Resume(_)) | None => {}
            Some(Action::Close(session)) => {
                self.panel = Panel::Close {
                    session: Box::new(session),
                    reason: String::new(),
                };
            }
        }
    }

    /// What stands above the list.
    fn head(&mut self, ui: &mut Ui, around: Around<'_>) {
        if let Some(running) = &self.running {
            ui.horizontal(|ui| {
                ui.spinner();
                ui.label(&running.words);
            });
            look::weak(
                ui,
                "It has a window and a process of its own; you may even close this one.",
            );
            let wait = std::time::Duration::from_secs_f64(READ_EVERY_S);
            ui.ctx().request_repaint_after(wait);
            return;
        }
        let is_starting = !matches!(self.panel, Panel::Close { .. });
        match std::mem::take(&mut self.panel) {
            Panel::Buttons => self.buttons(ui, around),
            Panel::Next { code, is_fresh } => self.next(ui, around, code, is_fresh.into()),
            Panel::Pilot {
                code,
                speed,
                is_fresh,
            } => self.pilot(ui, around, (code, speed), is_fresh.into()),
            Panel::Close { session, reason } => self.close(ui, around, session, reason),
        }
        if is_starting && self.running.is_none() {
            ui.scope(|ui| {
                ui.spacing_mut().item_spacing.y = 0.0;
                self.view_choice(ui, around);
            });
        }
    }

    /// Whether the sessions that are begun have an experimenter's view: as the station says, unless it is chosen here.
    fn has_view(&self, around: Around<'_>) -> bool {
        let is_noted = view_monitor(around).is_some();
        self.view_chosen.unwrap_or(is_noted)
    }

    fn view_choice(&mut self, ui: &mut Ui, around: Around<'_>) {
        let mut has_view = self.has_view(around);
        let words = "Experimenter's view in a second window";
        if look::tick(ui, &mut has_view, words).changed() {
            self.view_chosen = Some(has_view);
        }
        if has_view {
            let words = match view_monitor(around) {
                Some(monitor) => format!("On the monitor {monitor}, as the station says."),
                None => "On the subject's own monitor it lies behind their window, and Alt-Tab fetches it; the page Station can name another.".to_owned(),
            };
            look::weak(ui, &words);
        }
    }

    fn buttons(&mut self, ui: &mut Ui, around: Around<'_>) {
        let (mark, words) = around.state.of(Step::Sessions);
        look::state(ui, mark, &words);
        let hindrance = around.hold.or_else(|| around.state.hindrance());
        let may_start = Enabled::from(hindrance.is_none());
        ui.horizontal(|ui| {
            if look::primary(ui, may_start, "Next subject").clicked() {
                self.outcome = None;
                self.panel = Panel::Next {
                    code: around.state.sessions.next_code(),
                    is_fresh: true,
                };
            }
            if look::secondary(ui, may_start, "Trial run").clicked() {
                self.outcome = None;
                self.panel = Panel::Pilot {
                    code: "try".to_owned(),
                    speed: PILOT_SPEED.to_string(),
                    is_fresh: true,
                };
            }
        });
        if let Some(reason) = hindrance {
            look::weak(ui, reason);
        }
    }

    /// The second click: the code is proposed, and may be another.
    fn next(&mut self, ui: &mut Ui, around: Around<'_>, mut code: String, is_fresh: Enabled) {
        look::title(ui, "Next subject");
        let mut has_enter = false;
        ui.horizontal(|ui| {
            let field = look::field(ui, "Code", &mut code, 140.0);
            has_enter = entered(ui, &field);
            look::weak(ui, "letters and digits, never a name");
        });
        let subject = parsed(ui, &code);
        let words = format!("Start session {code}");
        let (mut is_started, mut is_left) = (has_enter, false);
        ui.horizontal(|ui| {
            let start = look::primary(ui, subject.is_some().into(), &words);
            if is_fresh == Enabled::Yes {
                // So that the same key begins the session.
                start.request_focus();
            }
            is_started |= start.clicked();
            is_left = left(ui, "Cancel");
        });
        match subject {
            Some(subject) if is_started => {
                let wanted = Wanted {
                    subject,
                    session: 1,
                    pilot: None,
                };
                self.start(ui, around, &wanted);
            }
            _ if is_left => {}
            _ => {
                self.panel = Panel::Next {
                    code,
                    is_fresh: false,
                }
            }
        }
    }

    fn pilot(
        &mut self,
        ui: &mut Ui,
        around: Around<'_>,
        (mut code, mut speed): (String, String),
        is_fresh: Enabled,
    ) {
        look::title(ui, "Trial run");
        look::weak(
            ui,
            "Marked PILOT on every screen and in the data, and left out of the report.",
        );
        ui.horizontal(|ui| {
            look::field(ui, "Code", &mut code, 140.0);
            ui.add_space(14.0);
            look::field(ui, "Times faster", &mut speed, 60.0);
        });
        let subject = parsed(ui, &code);
        let factor = speed.trim().parse().ok();
        let factor = factor.filter(|factor: &f64| (1.0..=1000.0).contains(factor));
        if factor.is_none() {
            ui.label("Times faster: a number from 1 to 1000.");
        }
        let may_start = Enabled::from(subject.is_some() && factor.is_some());
        let (mut is_started, mut is_left) = (false, false);
        ui.horizontal(|ui| {
            let start = look::primary(ui, may_start, "Start the trial run");
            if is_fresh == Enabled::Yes {
                start.request_focus();
            }
            is_started = start.clicked();
            is_left = left(ui, "Cancel");
        });
        match (subject, factor) {
            (Some(subject), Some(factor)) if is_started => {
                let wanted = Wanted {
                    subject,
                    session: 1,
                    pilot: Some(factor),
                };
                self.start(ui, around, &wanted);
            }
            _ if is_left => {}
            _ => {
                self.panel = Panel::Pilot {
                    code,
                    speed,
                    is_fresh: false,
                }
            }
        }
    }

    fn close(
        &mut self,
        ui: &mut Ui,
        around: Around<'_>,
        session: Box<ListedSession>,
        mut reason: String,
    ) {
        let ListedSession {
            subject,
            session: sitting,
            rated,
            trials,
            ..
        } = &*session;
        look::title(ui, &format!("Close the session of subject {subject}"));
        let words = format!(
            "{rated} of {trials} trials are rated. They are kept, but the session is never resumed, and the report leaves its subject out."
        );
        look::weak(ui, &words);
        ui.horizontal(|ui| {
            look::field(ui, "Reason", &mut reason, 420.0);
        });
        let may_close = Enabled::from(!reason.trim().is_empty());
        let (mut is_closed, mut is_left) = (false, false);
        ui.horizontal(|ui| {
            is_closed = look::primary(ui, may_close, "Close the session").clicked();
            is_left = left(ui, "Leave it open");
        });
        if is_closed {
            let mut words = command("close", around, subject, *sitting);
            words.extend(["--reason".into(), reason.trim().into()]);
            let said = format!("Closing the session of subject {subject}");
            self.run(ui, around.tools, said, words);
        } else if !is_left {
            self.panel = Panel::Close { session, reason };
        }
    }

    fn start(&mut self, ui: &Ui, around: Around<'_>, wanted: &Wanted) {
        let mut words = command("run", around, &wanted.subject, wanted.session);
        if let Some(speed) = wanted.pilot {
            words.extend(["--pilot".into(), speed.to_string().into()]);
        }
        if self.has_view(around) {
            words.push("--experimenter".into());
        }
        let what = match wanted.pilot {
            Some(_) => "Trial run",
            None => "Session",
        };
        let said = format!("{what} of subject {} is running.", wanted.subject);
        self.run(ui, around.tools, said, words);
    }

    fn run(&mut self, ui: &Ui, tools: &Tools, words: String, arguments: Vec<OsString>) {
        self.outcome = None;
        self.running = Some(Running {
            words,
            job: launch(ui.ctx(), tools, arguments),
            read_at_s: ui.input(|input| input.time),
        });
    }
}

/// `acuity WORD PROTOCOL --subject ID --session N`.
fn command(word: &str, around: Around<'_>, subject: &SubjectId, session: u32) -> Vec<OsString> {
    vec![
        word.into(),
        around.state.study.path.clone().into_os_string(),
        "--subject".into(),
        subject.to_string().into(),
        "--session".into(),
        session.to_string().into(),
    ]
}

/// The monitor that the station names for the experimenter's view.
fn view_monitor(around: Around<'_>) -> Option<&str> {
    match &around.state.station {
        StationState::Measured(station) => station.experimenter_monitor.as_deref(),
        _ => None,
    }
}

/// The way back to the buttons, which the key Escape goes too.
fn left(ui: &mut Ui, words: &str) -> bool {
    let is_pressed = look::secondary(ui, Enabled::Yes, words).clicked();
    is_pressed || ui.input(|input| input.key_pressed(Key::Escape))
}

/// What a process came to, in words.
fn outcome(answer: Result<std::io::Result<Ended>, Fault>) -> Result<String, Fault> {
    let ended = answer?.map_err(|error| {
        let words = format!("no session could be started ({error}); start the program again");
        Fault::of_words(&words)
    })?;
    match ended.code {
        Some(0) => Ok(ended.said.trim().to_owned()),
        Some(_) => Err(Fault::of_words(&ended.said)),
        None => Err(Fault::of_words(
            "the session was ended from outside; what was rated is kept, so resume it below",
        )),
    }
}

/// The subject of a code; where there is none, says why.
fn parsed(ui: &mut Ui, code: &str) -> Option<SubjectId> {
    match code.parse() {
        Ok(subject) => Some(subject),
        Err(_) if code.is_empty() => {
            ui.label("A code is missing, such as 01.");
            None
        }
        Err(reason) => {
            ui.label(reason);
            None
        }
    }
}

/// Whether the field was left with Enter.
fn entered(ui: &Ui, field: &eframe::egui::Response) -> bool {
    field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter))
}
