//! Session to ratings: the session machine, its window, and its simulated observers.
//!
//! Conventions: times in seconds, lengths on the screen in pixels, 8-bit sRGB. A *submitted* time is when
//! a frame had been handed to the window system; the onset of light is not measured.
//!
//! Not here: how the images are made and how the ratings are analysed. The stimulus set comes in, and the
//! ratings go out, as files of the crate `protocols`.

#[cfg(test)]
#[path = "../tests/common/mod.rs"]
mod common;

mod arrangement;
mod bidirectional;
mod bids;
mod button;
mod calibration;
mod color_draft;
mod data_set_files;
mod display;
mod display_color;
mod error;
mod frame_clock;
mod frame_log;
mod intake;
mod intake_files;
mod latin_square;
mod note;
mod order;
mod panel;
mod patch;
mod picture;
mod prediction;
mod quality;
mod random;
mod rating_row;
mod ratings_log;
mod ready;
mod refresh;
mod response;
mod rules;
mod scielab;
mod script_fonts;
mod session;
mod session_list;
mod sidecar;
mod simulate;
mod simulated_observer;
mod sitting;
mod station;
mod station_draft;
mod stimulus_set;
mod swap_log;
mod timing_log;
mod view;
mod window;

pub use bids::export_bids;
pub use button::{Button, Key};
pub use calibration::{Calibration, Curve, Fit, Residual};
pub use display::{Characterised, Display};
pub use display_color::{DisplayColor, MeasuredColor, ProfileFile};
pub use error::ExperimentError;
pub use frame_clock::{FrameClock, FrameSummary};
pub use frame_log::{FrameLog, FrameRun};
pub use intake::{
    Axis, AxisScore, ColorPlate, DoneBefore, Finished, Intake, Letter, LetterAnswer, LetterScore,
    PlateAnswer, PlateImage, Reply, ScreeningScore, Side, Step,
};
pub use note::{Note, Noted};
pub use order::{Trial, trials};
pub use panel::ObserverPanel;
pub use patch::{Patch, Reading};
pub use picture::{First, Picture};
pub use prediction::{Prediction, Predictions, predict};
pub use quality::{Quality, qualities, visible_difference_jod};
pub use ready::{check_ready, session_hindrances};
pub use refresh::Refresh;
pub use response::Response;
pub use rules::{Breaks, Rules};
pub use session::{Answer, Ending, Event, Screen, Session};
pub use session_list::{ListedSession, SessionList, Standing, session_list};
pub use simulate::{SimulationSummary, simulate};
pub use sitting::{RunOptions, SessionEnd, ViewProgram, close_session};
pub use station::{ScreenSize, StationFile, station_for};
pub use stimulus_set::{ScreenImage, StimulusSet, faults as stimulus_faults};
pub use view::{Glance, Order};
pub use window::{ScreenReport, check_screen, experimenters_view, measure_station, run};
