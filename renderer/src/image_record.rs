//! What an image file says of itself: how it was made, so that it can be made again.
//!
//! Only what determines the image: an image made alone and the same image of a set have the same record.

use crate::confidence::Confidence;
use protocols::{PerChannel, Quadrature, RayCount, RefinementDriver, Sha256Digest, TreePlan};

/// How one image was made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImageRecord {
    /// The digest of the scene file.
    pub scene_sha256: Sha256Digest,
    /// How many rays made A.
    pub rays_a: RayCount,
    /// How many rays made C1 and C2.
    pub rays_c1c2: RayCount,
    /// From how many samples each channel was made: fewer than its rays, if a depth ended it before.
    pub samples: PerChannel<u64>,
    /// Below these depths of the tree a channel was not computed.
    pub stop_depths: PerChannel<Option<u32>>,
    /// How well every region was to be known, if the trace was to end by that.
    pub until: Option<Confidence>,
    /// The seed of the sample positions.
    pub seed: u64,
    /// At which wavelengths light was carried.
    pub quadrature: Quadrature,
    /// How the tree was refined.
    pub tree: TreePlan,
}

impl ImageRecord {
    /// What is written beside the pixels, as (name, text) in the order of the names.
    pub(crate) fn texts(&self) -> Vec<(&'static str, String)> {
        let depth = |depth: Option<u32>| depth.map_or("none".to_owned(), |depth| depth.to_string());
        let driver = match self.tree.driver {
            RefinementDriver::A => "A",
            RefinementDriver::All => "AC1C2",
        };
        vec![
            ("acuityVersion", env!("CARGO_PKG_VERSION").to_owned()),
            (
                "filter",
                "tent, radius 1 pixel, exact over each leaf".to_owned(),
            ),
            ("quadrature", String::from(self.quadrature)),
            ("samplesA", self.samples.a.to_string()),
            ("samplesC1", self.samples.c1.to_string()),
            ("samplesC2", self.samples.c2.to_string()),
            ("sceneSha256", self.scene_sha256.to_string()),
            ("seed", self.seed.to_string()),
            ("stopDepthA", depth(self.stop_depths.a)),
            ("stopDepthC1", depth(self.stop_depths.c1)),
            ("stopDepthC2", depth(self.stop_depths.c2)),
            ("treeDriver", driver.to_owned()),
            (
                "treeUntilWithin",
                self.until
                    .map_or("none".to_owned(), |until| until.to_string()),
            ),
            ("treeMinDepth", self.tree.min_depth.to_string()),
        ]
    }
}
