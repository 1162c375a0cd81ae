//! What can stand on the subject's screen.
//!
//! Not here: when which of them does (the session), and how it is drawn (the window).

use crate::picture::Picture;

/// What a frame shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Screen {
    /// The instructions, with a button to begin.
    Instructions,
    /// The page with this index, which follows the instructions.
    Page(usize),
    /// A break.
    Break {
        /// How many seconds are left, rounded up.
        left_s: u32,
        /// Whether there is a button to go on.
        can_go_on: bool,
    },
    /// That a session that was cut off goes on, with a button.
    Resumed,
    /// That the practice is over, with a button to go on.
    PracticeOver,
    /// Grey.
    Blank,
    /// Images of the trial with this index.
    Exposure(usize, Picture),
    /// The same, with the rating scale below.
    RatedExposure(usize, Picture),
    /// The rating scale.
    Rating,
    /// That the answer took too long, with a button to see the images again.
    TooSlow,
    /// A rest, with a button to go on.
    Paused,
    /// Whether to stop.
    ConfirmStop,
    /// The end.
    Thanks,
}

impl Screen {
    /// Whether the rating scale is on it.
    pub fn has_scale(self) -> bool {
        matches!(self, Self::Rating | Self::RatedExposure(..))
    }

    /// The images on it.
    pub fn picture(self) -> Option<(usize, Picture)> {
        match self {
            Self::Exposure(trial, picture) | Self::RatedExposure(trial, picture) => {
                Some((trial, picture))
            }
            _ => None,
        }
    }
}
