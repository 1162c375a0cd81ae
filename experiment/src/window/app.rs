//! The window's loop: input to the session, ratings to disk, the frame to the screen.

use std::collections::BTreeMap;

use eframe::egui::{self, Color32, CursorIcon, ViewportCommand};
use protocols::{SessionPlan, StimulusId};

use super::Outcome;
use super::before::Before;
use super::clock::Clock;
use super::gate::{Filling, Gate, Sizes};
use super::geometry::Geometry;
use super::input;
use super::intake_page::{IntakePage, Looks};
use super::monitor::Monitor;
use super::paint::{Brush, Pictures};
use super::screen_watch::ScreenWatch;
use super::swap_watch::SwapWatch;
use super::view::ViewLink;
use crate::sitting::Sitting;
use crate::{
    Display, Event, ExperimentError, Key, Noted, Reply, Screen, Session, SessionEnd, StationFile,
    Step,
};

/// What the subject is to see.
pub(crate) struct Show {
    pub(crate) plan: SessionPlan,
    pub(crate) pictures: Pictures,
    pub(crate) pilot: Option<f64>,
    /// The monitor by its name.
    pub(crate) monitor: Option<String>,
    /// The measured screen and chair.
    pub(crate) station: Option<StationFile>,
    /// How colours get to the screen.
    pub(crate) display: Display,
    /// For each image how many pixels the display lacks.
    pub(crate) out_of_gamut_px: BTreeMap<StimulusId, u64>,
}

impl Show {
    /// The neutral grey of the screen.
    fn ground(&self) -> Color32 {
        let [red, green, blue] = self.display.grey(self.plan.background_srgb);
        Color32::from_rgb(red, green, blue)
    }

    /// Says that a trial run is one.
    fn mark(&self, brush: &Brush<'_>) {
        if let Some(speed) = self.pilot {
            brush.pilot(speed);
        }
    }
}

/// Whether the window has the keyboard, and how often it lost it while images were shown or awaited.
#[derive(Debug, Default)]
struct Focus {
    is_there: bool,
    losses: u32,
}

impl Focus {
    /// Notes when the window loses the keyboard or gets it again, also within one frame.
    ///
    /// `page` names what stands before the first trial, if it does.
    fn note(
        &mut self,
        context: &egui::Context,
        session: &mut Session,
        (page, now_s): (Option<Step>, f64),
    ) {
        let screen = session.screen();
        let words = page.map_or_else(|| format!("{screen:?}"), |page| format!("{page:?}"));
        for is_there in context.input(changes_of_focus) {
            let was_there = std::mem::replace(&mut self.is_there, is_there);
            if was_there && !is_there {
                let is_trial = screen == Screen::Blank || screen.picture().is_some();
                self.losses += u32::from(is_trial);
                session.note(Noted::FocusLost, now_s, words.clone());
            } else if !was_there && is_there {
                session.note(Noted::FocusRegained, now_s, words.clone());
            }
        }
    }
}

/// Whether the window had the keyboard, each time that this changed since the frame before, and now.
fn changes_of_focus(input: &egui::InputState) -> Vec<bool> {
    let changes = input.events.iter().filter_map(|event| match event {
        egui::Event::WindowFocused(is_there) => Some(*is_there),
        _ => None,
    });
    changes.chain([input.focused]).collect()
}

/// What goes on beside the subject's screen.
pub(crate) struct Aside {
    /// The experimenter's view, if there is one.
    pub(crate) view: Option<ViewLink>,
    pub(crate) watch: ScreenWatch,
    pub(crate) swaps: SwapWatch,
    /// Until when the subject's window asks for the keyboard: the view took it when it opened.
    pub(crate) asks_focus_until_s: f64,
}

/// How long a window that has just opened may still take the keyboard.
const OPENING_S: f64 = 2.0;

impl Aside {
    /// Hears the experimenter, the X server and the driver.
    fn hear(&mut self, context: &egui::Context, sitting: &mut Sitting, now_s: f64) {
        for (event, detail) in self.watch.take() {
            sitting.session.note(event, now_s, detail);
        }
        self.swaps.begin(context, &mut sitting.session, now_s);
        let view = self.view.as_mut();
        if view.is_some_and(|view| view.pass_on(sitting, now_s)) {
            self.asks_focus_until_s = now_s + OPENING_S;
        }
        if now_s < self.asks_focus_until_s {
            if !context.input(|input| input.focused) {
                context.send_viewport_cmd(ViewportCommand::Focus);
            }
            context.request_repaint();
        }
    }

    /// Tells the experimenter what there is to see.
    fn tell(&mut self, sitting: &Sitting, before: Option<&'static str>, clock: Clock) {
        if let Some(view) = &mut self.view {
            view.tell(sitting, before, clock);
        }
    }
}

/// A session in its window.
pub(crate) struct SessionApp {
    aside: Aside,
    sitting: Sitting,
    show: Show,
    clock: Clock,
    outcome: Outcome,
    before: Before,
    filling: Filling,
    monitor: Monitor,
    focus: Focus,
    intake_page: IntakePage,
}

impl SessionApp {
    pub(crate) fn new(
        sitting: Sitting,
        show: Show,
        aside: Aside,
        clock: Clock,
        outcome: Outcome,
    ) -> Self {
        Self {
            aside,
            sitting,
            show,
            clock,
            outcome,
            before: Before::Sizing(Gate::new()),
            filling: Filling::default(),
            monitor: Monitor::default(),
            focus: Focus::default(),
            intake_page: IntakePage::default(),
        }
    }

    /// One frame; says how the session ended, once it has.
    fn frame(
        &mut self,
        ui: &mut egui::Ui,
        now_s: f64,
    ) -> Result<Option<SessionEnd>, ExperimentError> {
        let context = &ui.ctx().clone();
        let sizes = Sizes::of(context);
        let geometry = sizes.geometry();
        let painter = ui.painter().clone();
        let brush = Brush {
            painter: &painter,
            geometry,
            plan: &self.show.plan,
            ground: self.show.ground(),
            pointer: context.input(|input| input.pointer.latest_pos()),
        };
        brush.background();
        self.aside.hear(context, &mut self.sitting, now_s);
        if !matches!(self.before, Before::Nothing) {
            context.request_repaint();
            context.set_cursor_icon(CursorIcon::None);
            self.show.mark(&brush);
            let (sitting, show) = (&mut self.sitting, &self.show);
            let times = (now_s, self.aside.swaps.has_heard());
            let frame = (&self.monitor, sizes, times);
            if !self.before.frame(sitting, show, &brush, frame)? {
                let words = "waits: the window is sized and its frames are timed";
                self.aside.tell(&self.sitting, Some(words), self.clock);
                return Ok(None);
            }
        }

        let (filling, sitting) = (&mut self.filling, &mut self.sitting);
        keep_filling(filling, sitting, context, (sizes, now_s))?;
        let page = Some(self.sitting.intake.step()).filter(|step| *step != Step::Done);
        self.focus
            .note(context, &mut self.sitting.session, (page, now_s));
        if page.is_some() {
            return self.intake(ui, geometry, now_s);
        }
        let screen = self.sitting.session.screen();
        let mut events = input::events(context, geometry, screen, &self.show.plan);
        if context.input(|input| input.viewport().close_requested()) {
            context.send_viewport_cmd(ViewportCommand::CancelClose);
            events.extend((screen != Screen::ConfirmStop).then_some(Event::Key(Key::Escape)));
        }
        events.push(Event::Frame);
        for event in events {
            self.sitting.session.on(event, now_s);
            self.sitting.save(|| self.clock.now_s())?;
        }
        if !screen.has_scale() && self.sitting.session.screen().has_scale() {
            self.rest_pointer(context, geometry);
        }
        let session = &mut self.sitting.session;
        if let Some(ending) = session.ending() {
            return self
                .sitting
                .finish(ending, self.focus.losses, now_s)
                .map(Some);
        }
        draw(&brush, session, &self.show);
        self.aside.swaps.drawn(session);
        self.sitting.keep_words()?;
        self.aside.tell(&self.sitting, None, self.clock);
        Ok(None)
    }
}

/// Notes when the window no longer fills the monitor, and gives up if it stays so.
fn keep_filling(
    filling: &mut Filling,
    sitting: &mut Sitting,
    context: &egui::Context,
    (sizes, now_s): (Sizes, f64),
) -> Result<(), ExperimentError> {
    let looked = filling.look(sizes, now_s);
    match &looked {
        Ok(Some(words)) => sitting
            .session
            .note(Noted::WindowSize, now_s, words.clone()),
        Err(error) => {
            let words = error.to_string();
            sitting.session.note(Noted::WindowSize, now_s, words);
            sitting.log_timing()?;
        }
        Ok(None) => {}
    }
    if filling.is_lost() {
        context.request_repaint();
    }
    looked.map(|_| ())
}

/// Draws the present screen, and asks for the next frame if one must follow.
fn draw(brush: &Brush<'_>, session: &Session, show: &Show) {
    let context = brush.painter.ctx();
    brush.screen(session, &show.pictures);
    show.mark(brush);
    brush.photodiode(session.screen());
    if matches!(session.screen(), Screen::Blank | Screen::Exposure(..)) {
        context.set_cursor_icon(CursorIcon::None);
    }
    if session.needs_frames() {
        context.request_repaint();
    }
}

impl SessionApp {
    fn rest_pointer(&self, context: &egui::Context, geometry: Geometry) {
        let rest = geometry.pointer_rest(&self.show.plan);
        context.send_viewport_cmd(ViewportCommand::CursorPosition(rest));
    }

    /// One frame of what comes before the first trial; says how the session ended, if the subject left.
    fn intake(
        &mut self,
        ui: &mut egui::Ui,
        geometry: Geometry,
        now_s: f64,
    ) -> Result<Option<SessionEnd>, ExperimentError> {
        let context = ui.ctx().clone();
        if context.input(|input| input.viewport().close_requested()) {
            context.send_viewport_cmd(ViewportCommand::CancelClose);
            self.intake_page.ask_to_stop();
        }
        if self.sitting.session.ending().is_some() {
            return self.sitting.leave(now_s).map(Some);
        }
        let words = "reads and answers what comes before the first trial";
        self.aside.tell(&self.sitting, Some(words), self.clock);
        let looks = Looks {
            plan: &self.show.plan,
            geometry,
            display: &self.show.display,
        };
        let intake = &mut self.sitting.intake;
        let (page, was_asking) = (intake.step(), self.intake_page.is_asking());
        let reply = (self.intake_page).show(ui, &looks, intake);
        intake.shown(now_s);
        let noted = match (was_asking, self.intake_page.is_asking()) {
            (false, true) => Some(Noted::Escape),
            (true, false) => Some(Noted::GoneOn),
            _ => None,
        };
        if let Some(noted) = noted.filter(|_| reply != Some(Reply::Leave)) {
            (self.sitting.session).note(noted, now_s, format!("{page:?}"));
        }
        if let Some(reply) = reply {
            let finished = intake.reply(reply, now_s);
            let step = intake.step();
            context.request_repaint();
            if let Some(finished) = finished {
                self.sitting.keep(finished, now_s)?;
            }
            if step == Step::Left {
                return self.sitting.leave(now_s).map(Some);
            }
        }
        self.show.mark(&Brush {
            painter: &ui.painter().clone(),
            geometry,
            plan: &self.show.plan,
            ground: self.show.ground(),
            pointer: None,
        });
        Ok(None)
    }
}

impl eframe::App for SessionApp {
    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        if self.outcome.borrow().is_some() {
            return;
        }
        if !matches!(self.before, Before::Nothing) {
            self.monitor = Monitor::of(frame);
        }
        let now_s = self.clock.now_s();
        let end = self.frame(ui, now_s).transpose();
        if let Some(end) = end {
            *self.outcome.borrow_mut() = Some(end);
            ui.ctx().send_viewport_cmd(ViewportCommand::Close);
        }
    }

    fn clear_color(&self, _visuals: &egui::Visuals) -> [f32; 4] {
        self.show.ground().to_normalized_gamma_f32()
    }
}
