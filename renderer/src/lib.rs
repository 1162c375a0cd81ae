//! Scene to rays to tree to channel images to stimulus set.
//!
//! Conventions: wavelengths in nm; screen coordinates from 0 to 1, x to the right, y down; world axes
//! right-handed with z up, lengths in metres.

mod error;
mod sampler;

pub use error::RendererError;
