//! Scene to rays to tree to channel images to stimulus set.
//!
//! Conventions: wavelengths in nm; screen coordinates from 0 to 1, x to the right, y down; world axes
//! right-handed with z up, lengths in metres.

mod account;
mod acuity_limits;
mod arrivals;
mod band_shader;
mod beam;
mod cell;
mod chacha;
mod channel_image;
mod channel_samples;
mod checkpoint;
mod confidence;
mod error;
mod estimate;
mod expected;
mod export;
mod figures;
mod file_writers;
mod filter;
mod float_exr;
mod from_scene;
mod geometry;
mod grid_cell;
mod halving;
mod image_record;
mod image_request;
mod import;
mod jitter;
mod leaf_map;
mod leaves;
mod lighting;
mod meetings;
mod opponent_exr;
mod picture_set;
mod pixel_axis;
#[cfg(test)]
mod plain_tracer;
mod png_notes;
mod priority;
mod ray_tree;
mod reconstruct;
mod refine;
mod remark;
mod render_image;
mod round;
mod sampler;
mod samples_map;
mod scene;
mod scene_sampler;
mod screen_tree;
mod set_summary;
mod shader;
mod shadows;
mod snapshots;
mod spatial_order;
mod spectra;
mod spectral_image;
mod srgb_png;
mod stimulus_set;
mod threads;
mod tints;
mod triangle_mesh;
mod watch;
mod wave;

use protocols::{matrix3, opponent, srgb};

pub use account::RayAccount;
pub use acuity_limits::{AcuityLimit, AcuityLimits};
pub use cell::{Axis, Cell, Rectangle};
pub use channel_image::ChannelImage;
pub use confidence::{Confidence, ConfidenceReached};
pub use error::RendererError;
pub use estimate::Estimate;
pub use figures::draw_figures;
pub use from_scene::{render_image, render_set, scene_sha256};
pub use image_record::ImageRecord;
pub use image_request::ImageRequest;
pub use matrix3::Matrix3;
pub use opponent::{
    AC1C2_FROM_XYZ, LINEAR_SRGB_FROM_AC1C2, LINEAR_SRGB_FROM_XYZ, SML_FROM_XYZ, XYZ_FROM_AC1C2,
    ac1c2_from_xyz, linear_srgb_from_ac1c2, xyz_from_ac1c2,
};
pub use opponent_exr::read_opponent_exr;
pub use picture_set::{PictureSetSummary, make_picture_set};
pub use ray_tree::RayTree;
pub use reconstruct::reconstruct;
pub use refine::{TracePlan, trace};
pub use render_image::{ImageSummary, render_image_of};
pub use sampler::{Sampler, ScreenPoint};
pub use samples_map::SamplesMap;
pub use scene::{Scene, is_scene};
pub use scene_sampler::SceneSampler;
pub use screen_tree::{Leaf, Reach, ScreenTree};
pub use set_summary::{SetSummary, StimulusSummary};
pub use snapshots::{Wanted, snapshots};
pub use srgb::{is_out_of_srgb_gamut, srgb_encode};
pub use srgb_png::{SrgbEncoder, SrgbImage};
pub use stimulus_set::render_set_of;
pub use triangle_mesh::TriangleMesh;
pub use watch::{Stage, Step, Watch};
