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

/// Whether the window goes on filling the monitor: it would not if its window manager died.
#[derive(Debug, Default)]
pub(crate) struct Filling {
    lost_s: Option<f64>,
}

/// For this long the window may be smaller, until what made it so is over.
const SMALLER_S: f64 = 1.0;

impl Filling {
    /// Looks once more; gives words for the log if that has changed.
    ///
    /// # Errors
    ///
    /// The window has not filled the monitor for a while.
    pub(crate) fn look(
        &mut self,
        sizes: Sizes,
        at_s: f64,
    ) -> Result<Option<String>, ExperimentError> {
        let fills = sizes.window_px == sizes.monitor_px || sizes.monitor_px == [0, 0];
        let [width, height] = sizes.window_px;
        let words = || Some(format!("{width} x {height} pixels"));
        match self.lost_s {
            None if !fills => {
                self.lost_s = Some(at_s);
                Ok(words())
            }
            Some(_) if fills => {
                self.lost_s = None;
                Ok(words())
            }
            Some(lost_s) if at_s - lost_s > SMALLER_S => Err(ExperimentError::NotFullScreen {
                window_px: sizes.window_px,
                monitor_px: sizes.monitor_px,
            }),
            _ => Ok(None),
        }
    }

    /// Whether the window is smaller now.
    pub(crate) fn is_lost(&self) -> bool {
        self.lost_s.is_some()
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_that_stays_smaller_ends_the_session_and_one_that_comes_back_does_not() {
        let sizes = |window_px| Sizes {
            window_px,
            monitor_px: [1280, 1024],
            pixels_per_point: 1.0,
        };
        let (whole, smaller) = (sizes([1280, 1024]), sizes([800, 600]));
        let mut filling = Filling::default();
        assert_eq!(filling.look(whole, 1.0).unwrap(), None);
        let words = filling.look(smaller, 2.0).unwrap();
        assert_eq!(words.as_deref(), Some("800 x 600 pixels"));
        assert_eq!(filling.look(smaller, 2.9).unwrap(), None);
        assert!(filling.look(whole, 2.95).unwrap().is_some() && !filling.is_lost());
        filling.look(smaller, 4.0).unwrap();
        assert!(filling.is_lost());
        let error = filling.look(smaller, 5.1).unwrap_err().to_string();
        assert!(error.contains("800 x 600"), "{error}");
        // The monitor is not known for a moment.
        let unknown = Sizes {
            monitor_px: [0, 0],
            ..smaller
        };
        assert_eq!(Filling::default().look(unknown, 1.0).unwrap(), None);
    }
}
