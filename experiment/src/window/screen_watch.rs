//! Whether a screensaver covers the screen or the display sleeps, asked of the X server twice a second.
//!
//! While the watch lasts the server's own screensaver and power saving are held off (MIT-SCREEN-SAVER 1.1; the server
//! lets go by itself when the program ends). Screen lockers of a desktop that do not use the server's screensaver are
//! neither seen nor held off, and on Wayland nothing is known: the log says so.
//!
//! It has a connection and a thread of its own, so that no frame waits for the server.

use std::env;
use std::error::Error;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::thread;
use std::time::Duration;

use eframe::egui::Context;
use x11rb::connection::Connection as _;
use x11rb::protocol::dpms::{ConnectionExt as _, DPMSMode};
use x11rb::protocol::screensaver::{ConnectionExt as _, State};
use x11rb::rust_connection::RustConnection;

use crate::Noted;

const BETWEEN_LOOKS: Duration = Duration::from_millis(500);

/// What is noted, and more about it.
type Change = (Noted, String);

/// A watch that lasts as long as this value.
#[derive(Debug)]
pub(crate) struct ScreenWatch {
    changes: Receiver<Change>,
    /// Closed with the watch; then the thread ends.
    _end: Sender<()>,
}

impl ScreenWatch {
    /// Begins to watch; `wake` draws a frame when something has changed.
    pub(crate) fn start(wake: Context) -> Self {
        let (tell, changes) = mpsc::channel();
        let (end, is_ended) = mpsc::channel();
        thread::spawn(move || {
            let told = |change: Change| {
                let is_heard = tell.send(change).is_ok();
                wake.request_repaint();
                is_heard
            };
            if let Err(error) = watch(&told, &is_ended) {
                // Nobody listens once the session is over.
                _ = told((Noted::ScreenWatch, format!("not watched: {error}")));
            }
        });
        Self { changes, _end: end }
    }

    /// What has changed since this was last asked.
    pub(crate) fn take(&self) -> Vec<Change> {
        self.changes.try_iter().collect()
    }
}

/// What the server can do.
#[derive(Clone, Copy, Debug)]
struct Can {
    /// Hold its screensaver off.
    hold: bool,
    /// Say whether the display sleeps.
    sleep: bool,
}

/// What covers or darkens the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Dark {
    has_saver: bool,
    sleeps: Option<bool>,
}

fn watch(told: &impl Fn(Change) -> bool, is_ended: &Receiver<()>) -> Result<(), Box<dyn Error>> {
    let (connection, screen) = RustConnection::connect(None)?;
    let root = connection.setup().roots[screen].root;
    let version = connection.screensaver_query_version(1, 1)?.reply()?;
    let capable = connection.dpms_capable().map(x11rb::cookie::Cookie::reply);
    let can = Can {
        hold: (version.server_major_version, version.server_minor_version) >= (1, 1),
        sleep: matches!(capable, Ok(Ok(reply)) if reply.capable),
    };
    if can.hold {
        connection.screensaver_suspend(1)?.check()?;
    }
    if !told((Noted::ScreenWatch, in_words(can))) {
        return Ok(());
    }
    let mut before = Dark {
        has_saver: false,
        sleeps: can.sleep.then_some(false),
    };
    loop {
        let now = look(&connection, root, can)?;
        for change in changes(before, now) {
            if !told(change) {
                return Ok(());
            }
        }
        before = now;
        match is_ended.recv_timeout(BETWEEN_LOOKS) {
            Err(RecvTimeoutError::Timeout) => {}
            _ => return Ok(()),
        }
    }
}

fn look(connection: &RustConnection, root: u32, can: Can) -> Result<Dark, Box<dyn Error>> {
    let saver = connection.screensaver_query_info(root)?.reply()?;
    let sleeps = if can.sleep {
        let power = connection.dpms_info()?.reply()?;
        Some(power.state && power.power_level != DPMSMode::ON)
    } else {
        None
    };
    Ok(Dark {
        has_saver: saver.state == u8::from(State::ON) || saver.state == u8::from(State::CYCLE),
        sleeps,
    })
}

fn changes(before: Dark, now: Dark) -> Vec<Change> {
    let mut changes = Vec::new();
    if now.has_saver != before.has_saver {
        let event = if now.has_saver {
            Noted::ScreensaverOn
        } else {
            Noted::ScreensaverOff
        };
        changes.push((event, String::new()));
    }
    if now.sleeps != before.sleeps {
        let sleeps = now.sleeps == Some(true);
        let event = if sleeps {
            Noted::DisplayAsleep
        } else {
            Noted::DisplayAwake
        };
        changes.push((event, String::new()));
    }
    changes
}

/// What is watched and what is not.
fn in_words(can: Can) -> String {
    let hold = if can.hold { "held off" } else { "not held off" };
    let sleep = if can.sleep {
        "watched"
    } else {
        "not known (no DPMS)"
    };
    let mut words =
        format!("the X server's screensaver is watched and {hold}; sleep of the display {sleep}");
    if env::var_os("WAYLAND_DISPLAY").is_some_and(|display| !display.is_empty()) {
        words.push_str("; on Wayland neither is known: the compositor tells X11 windows nothing");
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_change_is_told_once_and_by_its_name() {
        let light = Dark {
            has_saver: false,
            sleeps: Some(false),
        };
        let dark = Dark {
            has_saver: true,
            sleeps: Some(true),
        };
        let names = |before, now| -> Vec<&str> {
            changes(before, now)
                .iter()
                .map(|(event, _)| event.as_str())
                .collect()
        };
        assert_eq!(names(light, dark), ["screensaver_on", "display_asleep"]);
        assert_eq!(names(dark, light), ["screensaver_off", "display_awake"]);
        assert!(names(dark, dark).is_empty());
    }
}
