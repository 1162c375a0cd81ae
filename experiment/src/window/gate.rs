//! The gate before the first screen: nothing is shown until the window fills the monitor.
//!
//! The first frames of a full-screen window are smaller, and without a window manager the wish for full
//! screen is ignored. So the gate waits, or does not where nobody would answer, then asks for the monitor's size
//! itself, then gives up.

use eframe::egui::{Context, Pos2, ViewportCommand};

use super::geometry::Geometry;
use super::window_manager;
use crate::ExperimentError;

/// How long a window manager may take before the window is moved and sized by hand.
const BY_HAND_S: f64 = 1.0;
/// After this long the session is not begun.
const GIVE_UP_S: f64 = 8.0;

/// What stands before the first screen.
#[derive(Debug)]
pub(crate) struct Gate {
    patience_s: f64,
    since_s: Option<f64>,
    is_sized_by_hand: bool,
}

/// The sizes of the window and of its monitor, in pixels of the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sizes {
    pub(crate) window_px: [u32; 2],
    pub(crate) monitor_px: [u32; 2],
    pub(crate) pixels_per_point: f32,
}

impl Sizes {
    /// The window, to place things in.
    pub(crate) fn geometry(self) -> Geometry {
        Geometry {
            size_px: self.window_px.map(|pixels| pixels as f32).into(),
            pixels_per_point: self.pixels_per_point,
        }
    }

    pub(crate) fn of(context: &Context) -> Self {
        let pixels_per_point = context.pixels_per_point();
        let pixels = |points: f32| {
            let pixels = (points * pixels_per_point).round();
            // Monitors are far smaller than 2^24 pixels, and sizes are never negative.
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a rounded size of a screen"
            )]
            let pixels = pixels as u32;
            pixels
        };
        let window = context.content_rect().size();
        let monitor = context
            .input(|input| input.viewport().monitor_size)
            .unwrap_or_default();
        Self {
            window_px: [pixels(window.x), pixels(window.y)],
            monitor_px: [pixels(monitor.x), pixels(monitor.y)],
            pixels_per_point,
        }
    }
}

impl Gate {
    /// A gate for a window that has just been opened.
    pub(crate) fn new() -> Self {
        Self {
            patience_s: if window_manager::is_there() {
                BY_HAND_S
            } else {
                0.0
            },
            since_s: None,
            is_sized_by_hand: false,
        }
    }

    /// Whether the window fills the monitor by now.
    ///
    /// # Errors
    ///
    /// It does not, and will not.
    pub(crate) fn is_open(
        &mut self,
        context: &Context,
        sizes: Sizes,
        at_s: f64,
    ) -> Result<bool, ExperimentError> {
        if sizes.window_px == sizes.monitor_px && sizes.window_px != [0, 0] {
            return Ok(true);
        }
        let waited_s = at_s - *self.since_s.get_or_insert(at_s);
        if waited_s > GIVE_UP_S {
            return Err(ExperimentError::NotFullScreen {
                window_px: sizes.window_px,
                monitor_px: sizes.monitor_px,
            });
        }
        if waited_s >= self.patience_s && !self.is_sized_by_hand {
            self.is_sized_by_hand = true;
            let monitor = context.input(|input| input.viewport().monitor_size);
            context.send_viewport_cmd(ViewportCommand::OuterPosition(Pos2::ZERO));
            context.send_viewport_cmd(ViewportCommand::InnerSize(monitor.unwrap_or_default()));
        }
        Ok(false)
    }
}
