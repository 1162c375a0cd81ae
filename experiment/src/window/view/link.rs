//! The session's end of the experimenter's view: a program of its own at the other end of two pipes.
//!
//! Threads read and write the pipes, so that no frame waits for the view; a view that does not read loses glances,
//! never frames.

use std::io::{self, BufRead as _, BufReader, Write as _};
use std::process::{ChildStdin, ChildStdout, Command, Stdio};
use std::sync::mpsc::{self, Receiver, SyncSender, TryRecvError};
use std::thread;

use eframe::egui::Context;
use protocols::Study;

use super::super::clock::Clock;
use crate::sitting::Sitting;
use crate::view::{is_practice, screen_in_words};
use crate::{ExperimentError, Glance, Noted, Order, RunOptions, Screen, ViewProgram};

/// How many glances may wait for the view.
const WAITING: usize = 8;

/// The view, while it is open.
pub(crate) struct ViewLink {
    glances: SyncSender<String>,
    orders: Receiver<Order>,
    told: Option<Told>,
    title: String,
    scale: [i32; 2],
    pilot: Option<f64>,
    /// When the first trial of this sitting began, and how many were rated by then.
    began: Option<(f64, usize)>,
    is_gone: bool,
}

/// What makes a new glance worth telling.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Told {
    before: Option<&'static str>,
    screen: Screen,
    is_shown: bool,
    rated: usize,
    missed: u32,
}

impl ViewLink {
    /// Starts the view's program.
    pub(crate) fn open(
        view: &ViewProgram,
        study: &Study,
        options: &RunOptions,
        wake: Context,
    ) -> Result<Self, ExperimentError> {
        let mut child = Command::new(&view.program)
            .args(&view.arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(ExperimentError::io("start", &view.program))?;
        let (Some(input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
            let error = io::Error::other("it has no pipes");
            return Err(ExperimentError::io("start", &view.program)(error));
        };
        let (glances, waiting) = mpsc::sync_channel(WAITING);
        let (tell, orders) = mpsc::channel();
        thread::spawn(move || write_lines(input, &waiting));
        thread::spawn(move || {
            read_orders(output, |order| {
                let is_heard = tell.send(order).is_ok();
                wake.request_repaint();
                is_heard
            });
            drop(tell);
            wake.request_repaint();
            // What the view ended with says nothing that its end does not.
            _ = child.wait();
        });
        let scale = study.protocol.session.scale;
        Ok(Self {
            glances,
            orders,
            told: None,
            title: format!(
                "{}, subject {}, session {}",
                study.protocol.study, options.subject, options.session
            ),
            scale: [scale.lowest, scale.highest],
            pilot: options.pilot,
            began: None,
            is_gone: false,
        })
    }

    /// Gives the sitting what the experimenter asked for since this was last called, and notes once that the view was
    /// closed; true if the view has just opened.
    pub(crate) fn pass_on(&mut self, sitting: &mut Sitting, now_s: f64) -> bool {
        let mut is_new = false;
        loop {
            match self.orders.try_recv() {
                Ok(order) => {
                    is_new |= order == Order::Opened;
                    sitting.order(&order, now_s);
                }
                Err(TryRecvError::Disconnected) if !self.is_gone => {
                    self.is_gone = true;
                    sitting.session.note(Noted::View, now_s, "closed");
                }
                Err(_) => return is_new,
            }
        }
    }

    /// Tells the view what there is to see, if it has changed. `before` says what comes before the first screen.
    pub(crate) fn tell(&mut self, sitting: &Sitting, before: Option<&'static str>, clock: Clock) {
        let session = &sitting.session;
        let now = Told {
            before,
            screen: session.screen(),
            is_shown: session.is_shown(),
            rated: session.rated(),
            missed: session.frame_clock().missed(),
        };
        if self.is_gone || self.told == Some(now) {
            return;
        }
        self.told = Some(now);
        let glance = self.glance(sitting, before, clock.now_s());
        if let Ok(line) = serde_json::to_string(&glance) {
            // A view that is slow or gone gets no more than it takes.
            _ = self.glances.try_send(line);
        }
    }

    fn glance(&mut self, sitting: &Sitting, before: Option<&str>, now_s: f64) -> Glance {
        let session = &sitting.session;
        let (rated, whole) = (session.rated(), session.trials().len());
        let trial = session.trials().get(rated);
        let screen = before.unwrap_or_else(|| screen_in_words(session.screen()));
        Glance {
            title: self.title.clone(),
            pilot: self.pilot,
            screen: screen.to_owned(),
            stimulus: trial.map(|trial| trial.stimulus_id.to_string()),
            trial: [(rated + 1).min(whole), whole],
            is_practice: trial.is_some_and(|trial| is_practice(trial.phase)),
            is_resting: session.is_resting(),
            screen_left_s: session.screen_left_s(now_s),
            session_left_s: self.session_left_s(sitting, now_s),
            ratings: sitting.ratings().to_vec(),
            scale: self.scale,
            missed_frames: session.frame_clock().missed(),
            refresh: sitting.refresh_in_words(),
        }
    }

    /// The trials to come at the pace of those of this sitting, once there is one.
    fn session_left_s(&mut self, sitting: &Sitting, now_s: f64) -> Option<f64> {
        let session = &sitting.session;
        let rated = session.rated();
        if self.began.is_none() && session.screen() == Screen::Blank {
            self.began = Some((now_s, rated));
        }
        let (began_s, before) = self.began?;
        let done = rated.checked_sub(before).filter(|done| *done > 0)?;
        let to_come = session.trials().len() - rated;
        Some((now_s - began_s) / done as f64 * to_come as f64)
    }
}

fn write_lines(mut input: ChildStdin, lines: &Receiver<String>) {
    for line in lines {
        if writeln!(input, "{line}")
            .and_then(|()| input.flush())
            .is_err()
        {
            return;
        }
    }
}

/// Passes each order on until the view ends or nobody listens; a line that is no order is left out.
fn read_orders(output: ChildStdout, told: impl Fn(Order) -> bool) {
    for line in BufReader::new(output).lines() {
        let Ok(line) = line else { return };
        let order = serde_json::from_str(&line);
        if order.is_ok_and(|order| !told(order)) {
            return;
        }
    }
}
