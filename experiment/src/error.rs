//! What can go wrong with a session, and whether it is the user's to mend.

use std::io;
use std::path::{Path, PathBuf};

use protocols::{InputError, ReadError, SubjectId};

/// Why a session or a simulation could not be done.
#[derive(Debug, thiserror::Error)]
pub enum ExperimentError {
    /// A file or the command says something that cannot be used.
    #[error(transparent)]
    Input(#[from] InputError),
    /// The system would not give or take a file.
    #[error("cannot {action} \"{}\"", file.display())]
    Io {
        /// What was tried: `read`, `write`, `create`.
        action: &'static str,
        /// The file.
        file: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// Another window runs the same session.
    #[error("subject {subject} is in a session already: another program{} holds \"{}\"; close its window first. The lock goes with the program, so a crash leaves none: if no window is open, that program still runs unseen, and `kill` ends it", holder.map_or_else(String::new, |id| format!(" (process {id})")), file.display())]
    Busy {
        /// The subject.
        subject: SubjectId,
        /// The locked ratings file.
        file: PathBuf,
        /// The process that holds the lock, if the system says which one.
        holder: Option<u32>,
    },
    /// The images do not fit on the monitor at one image pixel per screen pixel.
    #[error(
        "found a screen of {} x {} pixels, expected at least {} x {} for the images and their gaps, at one image pixel for each screen pixel; use a larger monitor or a smaller stimulus set",
        found_px[0], found_px[1], needed_px[0], needed_px[1]
    )]
    TooSmall {
        /// The size of the window.
        found_px: [u32; 2],
        /// The size that the images need.
        needed_px: [u32; 2],
    },
    /// The window did not become as large as the monitor.
    #[error(
        "found a window of {} x {} pixels on a monitor of {} x {}, expected it to fill the monitor; is a window manager running on this display, and no other window in front?",
        window_px[0], window_px[1], monitor_px[0], monitor_px[1]
    )]
    NotFullScreen {
        /// The size of the window.
        window_px: [u32; 2],
        /// The size of the monitor.
        monitor_px: [u32; 2],
    },
    /// The monitor is not the one that was measured.
    #[error(
        "found a monitor {found_px} pixels wide, expected the {measured_px} of the station that was measured; choose that monitor (--monitor) and its native resolution, or measure this one: acuity station"
    )]
    OtherScreen {
        /// The width of the monitor.
        found_px: u32,
        /// The width that was measured.
        measured_px: u32,
    },
    /// Frames follow each other more slowly than the protocol allows.
    #[error(
        "found {found_hz:.2} frames a second, expected at least {lowest_hz} (session.lowest_refresh_hz); set the monitor to a higher rate, and close what keeps the computer busy"
    )]
    TooFewFrames {
        /// The rate by the median interval.
        found_hz: f64,
        /// What the protocol asks for.
        lowest_hz: f64,
    },
    /// The monitor is another than the one that was measured.
    #[error(
        "found the monitor \"{found}\", expected \"{measured}\", which the station was measured on; leave --monitor out, or measure this one: acuity station P --window --monitor {found}"
    )]
    OtherMonitor {
        /// The monitor that the window is on.
        found: String,
        /// The one that was measured.
        measured: String,
    },
    /// The graphics card scales the picture.
    #[error(
        "found a desktop of {} x {} pixels that is scaled to the {} x {} of the monitor, expected one pixel of the monitor for each pixel of an image; switch off the fractional scaling of the desktop (100 % or 200 %), or `xrandr --scale 1`",
        area_px[0], area_px[1], mode_px[0], mode_px[1]
    )]
    Scaled {
        /// The part of the desktop that the monitor shows.
        area_px: [u32; 2],
        /// What is sent to the monitor.
        mode_px: [u32; 2],
    },
    /// The monitor does not run at its own resolution.
    #[error(
        "found the monitor at {} x {} pixels, expected its own {} x {}; set that in the desktop's settings and measure the station again, or say why this is right (acuity station ... --not-native-because WORDS)",
        mode_px[0], mode_px[1], native_px[0], native_px[1]
    )]
    NotNative {
        /// What it runs at.
        mode_px: [u32; 2],
        /// What it says is its own.
        native_px: [u32; 2],
    },
    /// There is no monitor with this name.
    #[error(
        "found the monitors {all}, expected one named \"{wanted}\"; name one of those with --monitor"
    )]
    NoMonitor {
        /// The name.
        wanted: String,
        /// The names that there are.
        all: String,
    },
    /// The window or the screen holds other pixels than the images.
    #[error(
        "stimulus {stimulus}, pixel {}, {}: the {holder} holds {}, expected {expected:?}; a session is shown only byte for byte: close what lies in front, switch off scaling, colour management and compositing effects of the desktop, or use a display of 24 bits a pixel",
        place_px[0], place_px[1],
        found.as_ref().map_or_else(|| "nothing".to_owned(), |found| format!("{found:?}"))
    )]
    Pixel {
        /// What was asked: the window, or the X server's screen.
        holder: &'static str,
        /// The image.
        stimulus: String,
        /// Where in the image.
        place_px: [usize; 2],
        /// What is held there, if it reaches so far.
        found: Option<Vec<u8>>,
        /// What the image holds there.
        expected: Vec<u8>,
    },
    /// The data folder went away while a session ran.
    #[error(
        "\"{}\" was removed or replaced while the session ran; all {ratings} ratings were written to \"{}\"; find out what removed it before you go on",
        lost.display(), kept.display()
    )]
    Removed {
        /// The ratings file that went away.
        lost: PathBuf,
        /// Where the ratings are.
        kept: PathBuf,
        /// How many there are, the last one included.
        ratings: usize,
    },
    /// The window could not be opened.
    #[error(
        "no window could be opened ({reason}); a session needs an X11 display with OpenGL 2 or later"
    )]
    Window {
        /// What the window system said.
        reason: String,
    },
    /// The model of colour vision refused the images.
    #[error("ColorVideoVDP could not judge the stimulus {stimulus}: {reason}")]
    Vision {
        /// The image.
        stimulus: String,
        /// What it said.
        reason: String,
    },
    /// The session machine did not come to an end; a fault of the program.
    #[error(
        "the simulated session of subject {subject} did not come to an end; this is a fault of the program"
    )]
    Stuck {
        /// The observer.
        subject: SubjectId,
    },
}

impl ExperimentError {
    /// Whether the input or the command is wrong (exit code 2), and not the system (exit code 1).
    pub fn is_input(&self) -> bool {
        matches!(self, Self::Input(_))
    }

    pub(crate) fn io(action: &'static str, file: &Path) -> impl FnOnce(io::Error) -> Self {
        let file = file.to_owned();
        move |source| Self::Io {
            action,
            file,
            source,
        }
    }
}

impl From<ReadError> for ExperimentError {
    fn from(error: ReadError) -> Self {
        match error {
            ReadError::Input(input) => Self::Input(input),
            ReadError::Io { file, source } => Self::Io {
                action: "read",
                file,
                source,
            },
        }
    }
}
