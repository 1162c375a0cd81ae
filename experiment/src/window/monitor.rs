//! The monitor that the window is on: its name and its refresh rate, as the window system says them.

use eframe::egui::{Context, ViewportCommand};

use super::screen_mode::ScreenMode;
use crate::ExperimentError;

/// What the window system says of the monitor.
#[derive(Clone, Debug, Default)]
pub(crate) struct Monitor {
    pub(crate) name: Option<String>,
    pub(crate) nominal_hz: Option<f64>,
    /// Every monitor of the desktop, in the order of the window system.
    all: Vec<String>,
}

impl Monitor {
    pub(crate) fn of(frame: &eframe::Frame) -> Self {
        let Some(window) = frame.winit_window() else {
            return Self::default();
        };
        let current = window.current_monitor();
        let mut hertz = None;
        if let Some(monitor) = &current {
            hertz = monitor.refresh_rate_millihertz();
        }
        Self {
            name: current.and_then(|monitor| monitor.name()),
            nominal_hz: hertz.map(|millihertz| f64::from(millihertz) / 1e3),
            all: window
                .available_monitors()
                .map(|monitor| monitor.name().unwrap_or_default())
                .collect(),
        }
    }

    /// The mode that it runs; `None` if the X server does not say.
    pub(crate) fn mode(&self) -> Option<ScreenMode> {
        ScreenMode::of(self.name.as_deref()?)
    }

    /// The names of all monitors, in the order of the window system.
    pub(crate) fn all(&self) -> &[String] {
        &self.all
    }

    /// Whether the window is on the monitor with this name; if not, it is sent there.
    ///
    /// # Errors
    ///
    /// There is no such monitor.
    pub(crate) fn is_wanted(
        &self,
        wanted: Option<&str>,
        context: &Context,
    ) -> Result<bool, ExperimentError> {
        let Some(wanted) = wanted else {
            return Ok(true);
        };
        if self.name.as_deref() == Some(wanted) {
            return Ok(true);
        }
        let Some(index) = self.all.iter().position(|name| name == wanted) else {
            return Err(ExperimentError::NoMonitor {
                wanted: wanted.to_owned(),
                all: self.all.join(", "),
            });
        };
        context.send_viewport_cmd(ViewportCommand::SetMonitor(index));
        Ok(false)
    }
}
