//! The row that an answer becomes.

use jiff::{SignedDuration, Timestamp};
use protocols::rating::{RatingRow, ShownFirst};

use crate::sidecar::SessionKey;
use crate::{Answer, First, Trial};

/// The row of `answer` to `trial`; the driver's clock read zero at `clock_zero`.
pub(crate) fn rating_row(
    key: &SessionKey,
    trial: &Trial,
    answer: &Answer,
    exposure_requested_s: f64,
    clock_zero: Timestamp,
) -> RatingRow {
    RatingRow {
        subject_id: key.subject_id.clone(),
        session_id: key.session_id,
        trial_id: trial.trial_id,
        phase: trial.phase,
        stimulus_id: trial.stimulus_id.clone(),
        repetition: trial.repetition,
        levels: trial.levels.clone(),
        rating: answer.rating,
        reference_rating: answer.reference_rating,
        shown_first: answer.reference_rating.map(|_| match trial.first {
            First::Test => ShownFirst::Test,
            First::Reference => ShownFirst::Reference,
        }),
        response_time_s: answer.response_time_s,
        exposure_requested_s,
        exposure_submitted_s: answer.exposure_submitted_s,
        missed_frames: answer.missed_frames,
        showings: answer.showings,
        started_at: utc(clock_zero, answer.started_s),
        observer: key.observer,
        pilot: key.pilot_speed.is_some(),
    }
}

/// UTC in ISO 8601, to the millisecond.
pub(crate) fn utc(clock_zero: Timestamp, elapsed_s: f64) -> String {
    let elapsed = SignedDuration::try_from_secs_f64(elapsed_s).unwrap_or_default();
    let instant = clock_zero.checked_add(elapsed).unwrap_or(clock_zero);
    format!("{instant:.3}")
}
