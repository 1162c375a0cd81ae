//! What comes out of a session: the answer to each trial, and how the session ended.

/// The answer to one trial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// The index of the trial in the session.
    pub trial: usize,
    /// The rating of the test image.
    pub rating: i32,
    /// The rating of the reference, where both are rated.
    pub reference_rating: Option<i32>,
    /// From the first frame submitted with the scale to the answer.
    pub response_time_s: f64,
    /// From the first frame submitted with the test image to the first without it.
    pub exposure_submitted_s: f64,
    /// Frames of the test image later than one and a half frame times after the one before.
    pub missed_frames: u32,
    /// How often the trial was begun: more than once if its exposure was interrupted or the answer too late.
    pub showings: u32,
    /// When the trial began, by the driver's clock.
    pub started_s: f64,
}

/// How a session ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// Every trial is rated.
    Complete,
    /// The subject stopped; what was rated is kept.
    Stopped,
    /// The subject did not agree to take part; nothing is kept.
    Declined,
}
