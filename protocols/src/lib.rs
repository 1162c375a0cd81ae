//! The contract: what a study is, and the files in which its parts meet.
//!
//! A *protocol* is one TOML file that states a whole study: which stimuli, how they are shown, how the
//! ratings are analysed. The renderer, the experiment and the analysis all read that file and never each
//! other; they meet in the [`Manifest`] of the stimulus set and in the [`ratings`](rating) of the sessions.
//!
//! Conventions of every crate here: wavelengths in nm, times in seconds, angles in degrees, screen
//! coordinates from 0 to 1 with x to the right and y down, spectra as power per nm. A number without a
//! type carries its unit in its name.
//!
//! Colour has one home here too: the opponent space of the paper, and the way from it to sRGB.
//!
//! Not here: how a ray, a session or a test statistic is computed.

mod acuity;
mod analysis_plan;
mod atomic_file;
mod break_plan;
mod channel;
mod data_set;
mod export;
mod follow_up_plan;
mod input_error;
mod intake_plan;
mod manifest;
pub mod matrix3;
mod model_observer;
pub mod opponent;
mod opponent_exr;
mod order_plan;
mod picture_manifest;
mod picture_set;
mod picture_table;
mod protocol;
pub mod rating;
mod ray_count;
mod response_plan;
mod session_plan;
mod sha256;
pub mod srgb;
mod stimuli;
mod stimulus;
mod stimulus_plan;
mod study;
mod subject_id;
mod table_protocol;
mod viewing;

pub use acuity::Acuity;
pub use analysis_plan::{
    AnalysisPlan, AsymptotePlan, Correction, Exclusion, Missing, PublishedEffect, SumsOfSquares,
};
pub use atomic_file::{Access, settle_names, write_atomically, write_unsettled};
pub use break_plan::{BreakPlan, InstructionPage};
pub use channel::{Channel, ChannelGroup, PerChannel};
pub use data_set::{DataSet, Observer};
pub use export::Export;
pub use follow_up_plan::FollowUpPlan;
pub use input_error::{InputError, ReadError};
pub use intake_plan::{ConsentPlan, FieldKind, FormField, ScreeningPlan};
pub use manifest::{Manifest, ManifestFile, ManifestStimulus, ViewingGeometry};
pub use model_observer::{ModelObserver, NormalParameter};
pub use opponent_exr::OpponentPixels;
pub use order_plan::{LevelBlocks, OrderPlan, OrderScheme, RunLimit};
pub use picture_manifest::{ManifestPicture, PictureManifest};
pub use picture_set::{PictureAnchors, PicturePlan, PictureSet};
pub use picture_table::{Picture, PictureTable};
pub use protocol::Protocol;
pub use ray_count::RayCount;
pub use response_plan::{RatingTime, ResponseStyle};
pub use session_plan::{Layout, Scale, SessionPlan, SessionTexts};
pub use sha256::Sha256Digest;
pub use stimuli::{Stimuli, StudyImage};
pub use stimulus::{Stimulus, StimulusId};
pub use stimulus_plan::{Anchors, Quadrature, RefinementDriver, Sequence, StimulusPlan, TreePlan};
pub use study::{Rendering, Study};
pub use subject_id::SubjectId;
pub use table_protocol::{TablePlan, TableProtocol};
pub use viewing::Viewing;
