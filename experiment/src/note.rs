//! What happened in a session besides its ratings: each with its time, for the log of events.

/// Something that the data should know.
#[derive(Clone, Debug, PartialEq)]
pub struct Note {
    /// When, by the driver's clock.
    pub at_s: f64,
    /// The index of the trial that was on.
    pub trial: usize,
    /// What.
    pub event: Noted,
    /// More about it, in words or numbers.
    pub detail: String,
}

/// What was noted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Noted {
    /// Escape: the subject is asked whether to stop.
    Escape,
    /// The key P: the session rests.
    Pause,
    /// The session goes on after either.
    GoneOn,
    /// A break begins.
    Break,
    /// An exposure was cut short and is shown again.
    ExposureInterrupted,
    /// An answer sooner than the shortest response time; not taken.
    TooSoon,
    /// The longest response time was over; the images are shown again.
    TooLate,
    /// A click while an answer was being put on disk, or beside every button.
    StrayClick,
    /// The window lost the keyboard.
    FocusLost,
    /// The window has the keyboard again.
    FocusRegained,
    /// The window has another size than before, and no longer fills the monitor or does so again.
    WindowSize,
    /// What is watched of screensaver and sleep.
    ScreenWatch,
    /// The screensaver covers the screen.
    ScreensaverOn,
    /// It does no longer.
    ScreensaverOff,
    /// The display sleeps.
    DisplayAsleep,
    /// It does no longer.
    DisplayAwake,
    /// Words of the experimenter.
    Words,
    /// The experimenter's view was opened, or is gone.
    View,
    /// The experimenter let the session rest, go on or stop; the detail says which.
    Experimenter,
    /// A rating was put on disk; the detail says how long that took.
    RatingOnDisk,
    /// The frames before the first screen; the detail says what they were like.
    RefreshMeasured,
    /// Whether the driver tells when it swapped each frame.
    SwapWatch,
    /// An exposure between two swaps of the driver; the detail says how long.
    ExposureSwapped,
    /// The screenshot was compared with the images.
    PixelsCompared,
    /// The session ended.
    Ended,
}

impl Noted {
    /// The word in the log.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Escape => "escape",
            Self::Pause => "pause",
            Self::Break => "break",
            Self::GoneOn => "gone_on",
            Self::ExposureInterrupted => "exposure_interrupted",
            Self::TooSoon => "answer_too_soon",
            Self::TooLate => "answer_too_late",
            Self::StrayClick => "stray_click",
            Self::FocusLost => "focus_lost",
            Self::FocusRegained => "focus_regained",
            Self::WindowSize => "window_size",
            Self::ScreenWatch => "screen_watch",
            Self::ScreensaverOn => "screensaver_on",
            Self::ScreensaverOff => "screensaver_off",
            Self::DisplayAsleep => "display_asleep",
            Self::DisplayAwake => "display_awake",
            Self::Words => "note",
            Self::View => "experimenters_view",
            Self::Experimenter => "experimenter",
            Self::RatingOnDisk => "rating_on_disk",
            Self::RefreshMeasured => "refresh_measured",
            Self::SwapWatch => "swap_watch",
            Self::ExposureSwapped => "exposure_swapped",
            Self::PixelsCompared => "pixels_compared",
            Self::Ended => "ended",
        }
    }
}
