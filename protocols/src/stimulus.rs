//! One image of the study: how many rays its channels were made from, and what it is called.

use std::collections::BTreeMap;
use std::fmt;

use serde::{Deserialize, Serialize};

use crate::{ChannelGroup, RayCount};

/// The name of a stimulus, and of its files without their ending: lower-case letters, digits, `-`, `_`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct StimulusId(String);

impl StimulusId {
    /// The name of the image with these ray counts: `a010k_c140k` has A at 10K and C1C2 at 140K.
    pub fn from_ray_counts(rays_a: RayCount, rays_c1c2: RayCount) -> Self {
        let part = |rays: RayCount| {
            let text = rays.to_string().to_lowercase();
            format!("{text:0>4}")
        };
        Self(format!("a{}_c{}", part(rays_a), part(rays_c1c2)))
    }

    /// The name.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl TryFrom<String> for StimulusId {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let is_plain =
            |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || b"-_".contains(&byte);
        if !text.is_empty() && text.len() <= 64 && text.bytes().all(is_plain) {
            Ok(Self(text))
        } else {
            Err(format!(
                "found the stimulus id {text:?}, expected 1 to 64 lower-case letters, digits, '-' and '_'"
            ))
        }
    }
}

impl From<StimulusId> for String {
    fn from(id: StimulusId) -> Self {
        id.0
    }
}

impl fmt::Display for StimulusId {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.0)
    }
}

/// One image of the study: a ray count for A, one for C1 and C2, and the sequences that it belongs to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stimulus {
    /// The name.
    pub id: StimulusId,
    /// The sequences that show it: none for an image that is only an anchor, two for the one they share.
    pub sequences: Vec<ChannelGroup>,
    /// How many rays made A.
    pub rays_a: RayCount,
    /// How many rays made C1 and C2.
    pub rays_c1c2: RayCount,
}

impl Stimulus {
    /// The level of each factor: `channel` (the group varied, `both` or `neither`) and `rays`.
    pub fn factors(&self) -> BTreeMap<String, String> {
        let (channel, rays) = match self.sequences.as_slice() {
            [] => ("neither", self.rays_a),
            [ChannelGroup::Achromatic] => (ChannelGroup::Achromatic.level(), self.rays_a),
            [ChannelGroup::Chromatic] => (ChannelGroup::Chromatic.level(), self.rays_c1c2),
            _ => ("both", self.rays_a),
        };
        BTreeMap::from([
            ("channel".to_owned(), channel.to_owned()),
            ("rays".to_owned(), rays.to_string()),
        ])
    }
}
