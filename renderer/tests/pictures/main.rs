//! From samplers that are known in closed form to the files of a stimulus set.
#![expect(clippy::unwrap_used, reason = "a test may panic")]
#![expect(
    clippy::cast_possible_truncation,
    reason = "values of pictures become f32, and places of pixels are small"
)]

mod acuity;
mod analytic;
mod closed_forms;
mod confidence;
mod estimates;
mod every_scene;
mod exports;
mod files;
mod interruption;
mod own_pictures;
mod platform;
mod prefix;
mod quadrature;
mod reconstruction;
mod samples_map;
mod scene;
mod set;
mod small_study;
mod stops;
