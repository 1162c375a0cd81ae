//! The session machine, event by event.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod answer;
mod bars;
mod course;
mod experimenter;
mod exposure;
mod layouts;
mod response_time;
mod rest;
mod screening;
