//! The experimenter's view: which trial, what is shown, time left, ratings so far, missed frames; pause, stop, notes.

mod link;
mod page;
mod rating_plot;

use std::cell::RefCell;
use std::io::{self, BufRead as _, Write as _};
use std::rc::Rc;
use std::sync::mpsc::{self, Receiver};
use std::thread;

use eframe::egui::{Context, Ui, Vec2, ViewportBuilder, ViewportCommand, vec2};

use super::clock::Clock;
use super::gate::Sizes;
use super::monitor::Monitor;
use super::{desk, open};
use crate::{ExperimentError, Glance, Order};

pub(crate) use link::ViewLink;
use page::ViewPage;

/// The window's size in points.
const SIZE: Vec2 = vec2(760.0, 620.0);

/// Shows the view of the session that is at the other end of this program's input and output, until it ends.
///
/// `monitor` is the one to stand on, by its name.
///
/// # Errors
///
/// The window cannot be opened, or there is no such monitor.
pub fn experimenters_view(monitor: Option<String>) -> Result<(), ExperimentError> {
    let viewport = ViewportBuilder::default()
        .with_title("Acuity - experimenter's view")
        .with_app_id("acuity-view")
        .with_inner_size(SIZE)
        .with_min_inner_size(vec2(560.0, 480.0))
        .with_active(false);
    let outcome = Rc::new(RefCell::new(None));
    let told = Rc::clone(&outcome);
    open(viewport, |creation| {
        desk::dress(&creation.egui_ctx);
        let (tell, glances) = mpsc::channel();
        let wake = creation.egui_ctx.clone();
        thread::spawn(move || {
            for line in io::stdin().lock().lines().map_while(Result::ok) {
                let glance = serde_json::from_str(&line);
                if glance.is_ok_and(|glance| tell.send(glance).is_err()) {
                    return;
                }
                wake.request_repaint();
            }
            // The session is over, and the view with it.
            drop(tell);
            wake.request_repaint();
        });
        Ok(Box::new(ViewApp {
            glances,
            page: ViewPage::default(),
            clock: Clock::start(),
            wanted: monitor,
            is_told: false,
            is_sized: false,
            outcome: told,
        }))
    })?;
    let outcome = outcome.borrow_mut().take();
    outcome.map_or(Ok(()), Err)
}

struct ViewApp {
    glances: Receiver<Glance>,
    page: ViewPage,
    clock: Clock,
    wanted: Option<String>,
    is_told: bool,
    is_sized: bool,
    outcome: Rc<RefCell<Option<ExperimentError>>>,
}

impl ViewApp {
    /// Gives points and window the size that fits the monitor, once that is known.
    fn size(&mut self, context: &Context) {
        let height_px = Sizes::of(context).monitor_px[1];
        if self.is_sized || self.wanted.is_some() || height_px == 0 {
            return;
        }
        self.is_sized = true;
        let native = context.native_pixels_per_point().unwrap_or(1.0);
        context.set_zoom_factor((height_px as f32 / 1080.0).clamp(1.0, 4.0) / native);
        context.send_viewport_cmd(ViewportCommand::InnerSize(SIZE));
    }
}

impl eframe::App for ViewApp {
    fn ui(&mut self, ui: &mut Ui, frame: &mut eframe::Frame) {
        let context = ui.ctx().clone();
        if self.wanted.is_some() {
            match Monitor::of(frame).is_wanted(self.wanted.as_deref(), &context) {
                Ok(true) => self.wanted = None,
                Ok(false) => context.request_repaint(),
                Err(error) => {
                    *self.outcome.borrow_mut() = Some(error);
                    context.send_viewport_cmd(ViewportCommand::Close);
                }
            }
        }
        self.size(&context);
        let now_s = self.clock.now_s();
        loop {
            match self.glances.try_recv() {
                Ok(glance) => self.page.see(glance, now_s),
                Err(mpsc::TryRecvError::Empty) => break,
                Err(mpsc::TryRecvError::Disconnected) => {
                    context.send_viewport_cmd(ViewportCommand::Close);
                    break;
                }
            }
        }
        let mut orders = Vec::new();
        if !self.is_told {
            self.is_told = true;
            orders.push(Order::Opened);
        }
        orders.extend(self.page.show(ui, now_s));
        for order in orders {
            if tell(&order).is_err() {
                context.send_viewport_cmd(ViewportCommand::Close);
            }
        }
        if let Some(wait) = self.page.next_change() {
            context.request_repaint_after(wait);
        }
    }
}

/// Prints an order for the session.
fn tell(order: &Order) -> io::Result<()> {
    let line = serde_json::to_string(order)?;
    let mut output = io::stdout().lock();
    writeln!(output, "{line}")?;
    output.flush()
}
