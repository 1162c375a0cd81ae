//! When the driver swapped each frame of the window, heard from the X server.
//!
//! Drivers of the direct rendering infrastructure (Mesa's on real hardware) hand each frame to the X server's Present
//! extension, which tells whoever asks when it was done: the same unadjusted system time (UST) and media stream counter
//! that `GLX_OML_sync_control` gives, without a call into the driver. Software rendering and drivers of their own do not
//! use it; then nothing is heard, and the times of the session are software times after the swap.
//!
//! It has a connection and a thread of its own, so that no frame waits for the server.

use std::error::Error;
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread;

use eframe::egui::Context;
use raw_window_handle::{HasWindowHandle, RawWindowHandle};
use rustix::time::{ClockId, clock_gettime};
use x11rb::connection::Connection as _;
use x11rb::protocol::Event;
use x11rb::protocol::present::{
    CompleteKind, CompleteMode, CompleteNotifyEvent, ConnectionExt as _, EventMask,
};
use x11rb::protocol::xproto::Window;
use x11rb::rust_connection::RustConnection;

use super::clock::Clock;
use crate::swap_log::{Swap, SwapLog};
use crate::{Noted, Session};

/// The swaps of the subject's window.
#[derive(Debug)]
pub(crate) struct SwapWatch {
    swaps: Receiver<Swap>,
    log: SwapLog,
}

impl SwapWatch {
    /// Begins to listen; a window that is not of X is never heard.
    pub(crate) fn start(window: &impl HasWindowHandle, clock: Clock) -> Self {
        let (tell, swaps) = mpsc::channel();
        if let Some(window) = x_window(window) {
            // A server without the extension is one that tells nothing.
            thread::spawn(move || _ = hear(window, clock, &tell));
        }
        Self {
            swaps,
            log: SwapLog::default(),
        }
    }

    /// Whether the driver tells of its swaps.
    pub(crate) fn has_heard(&self) -> bool {
        self.log.has_heard()
    }

    /// A frame is begun; exposures whose swaps are certain by now are noted.
    pub(crate) fn begin(&mut self, context: &Context, session: &mut Session, now_s: f64) {
        for swap in self.swaps.try_iter() {
            self.log.heard(swap);
        }
        for exposure in self.log.begin(context.cumulative_frame_nr(), now_s) {
            let event = Noted::ExposureSwapped;
            session.note_of(exposure.trial, event, now_s, exposure.in_words());
        }
    }

    /// The frame shows what the session says now.
    pub(crate) fn drawn(&mut self, session: &Session) {
        let picture = session.screen().picture();
        let test_image = picture.filter(|(_, picture)| picture.has_test_image());
        self.log.drawn(test_image.map(|(trial, _)| trial));
    }
}

fn x_window(window: &impl HasWindowHandle) -> Option<Window> {
    match window.window_handle().ok()?.as_raw() {
        RawWindowHandle::Xlib(handle) => handle.window.try_into().ok(),
        RawWindowHandle::Xcb(handle) => Some(handle.window.get()),
        _ => None,
    }
}

/// Tells of each swap until nobody listens.
fn hear(window: Window, clock: Clock, tell: &Sender<Swap>) -> Result<(), Box<dyn Error>> {
    let (connection, _) = RustConnection::connect(None)?;
    connection.present_query_version(1, 2)?.reply()?;
    let events = connection.generate_id()?;
    let mask = EventMask::COMPLETE_NOTIFY;
    connection
        .present_select_input(events, window, mask)?
        .check()?;
    let now = clock_gettime(ClockId::Monotonic);
    let clock_began_s = now.tv_sec as f64 + now.tv_nsec as f64 * 1e-9 - clock.now_s();
    loop {
        if let Event::PresentCompleteNotify(done) = connection.wait_for_event()?
            && done.kind == CompleteKind::PIXMAP
            && tell.send(swap_of(&done, clock_began_s)).is_err()
        {
            return Ok(());
        }
    }
}

fn swap_of(done: &CompleteNotifyEvent, clock_began_s: f64) -> Swap {
    Swap {
        number: done.serial,
        at_s: done.ust as f64 * 1e-6 - clock_began_s,
        refresh: done.msc,
        is_skipped: done.mode == CompleteMode::SKIP,
    }
}
