//! The part of a protocol that says which images are made, and how.

use serde::{Deserialize, Serialize};

use crate::{ChannelGroup, Export, RayCount, Stimulus, StimulusId};

/// The stimulus set: one scene, one trace, and the ray counts of every image read from it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StimulusPlan {
    /// The name of the set, and of its folder below `stimuli/`.
    pub set: String,
    /// The scene file, relative to the folder of the protocol.
    pub scene: String,
    /// Width and height of the images, in pixels.
    pub size_px: [u32; 2],
    /// The seed of the sample positions.
    pub seed: u64,
    /// At which wavelengths light is carried.
    pub quadrature: Quadrature,
    /// How the screen tree is refined and read.
    pub tree: TreePlan,
    /// Which further files are made of each image.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub export: Vec<Export>,
    /// The two images that stay beside the test image.
    pub anchors: Anchors,
    /// The sequences of images, one for each group of channels that is varied.
    pub sequences: Vec<Sequence>,
}

impl StimulusPlan {
    /// Every distinct image: the zero anchor, then the sequences in their order, the ten anchor where it
    /// first occurs (or last, if no sequence holds it). An image that two sequences share comes once.
    pub fn stimuli(&self) -> Vec<Stimulus> {
        let mut stimuli: Vec<Stimulus> = Vec::new();
        let mut add = |rays_a: RayCount, rays_c1c2: RayCount, sequence: Option<ChannelGroup>| {
            let id = StimulusId::from_ray_counts(rays_a, rays_c1c2);
            if let Some(known) = stimuli.iter_mut().find(|stimulus| stimulus.id == id) {
                known.sequences.extend(sequence);
            } else {
                let sequences = sequence.into_iter().collect();
                stimuli.push(Stimulus {
                    id,
                    sequences,
                    rays_a,
                    rays_c1c2,
                });
            }
        };
        add(self.anchors.zero_rays, self.anchors.zero_rays, None);
        for sequence in &self.sequences {
            for &rays in &sequence.rays {
                let (rays_a, rays_c1c2) = match sequence.varied {
                    ChannelGroup::Achromatic => (rays, sequence.held_rays),
                    ChannelGroup::Chromatic => (sequence.held_rays, rays),
                };
                add(rays_a, rays_c1c2, Some(sequence.varied));
            }
        }
        add(self.anchors.ten_rays, self.anchors.ten_rays, None);
        stimuli
    }

    /// The factors in which the images differ, as columns of the ratings: `channel` and `rays`.
    pub fn factors() -> Vec<String> {
        vec!["channel".to_owned(), "rays".to_owned()]
    }

    /// The name of the zero anchor.
    pub fn zero_anchor(&self) -> StimulusId {
        StimulusId::from_ray_counts(self.anchors.zero_rays, self.anchors.zero_rays)
    }

    /// The name of the ten anchor.
    pub fn ten_anchor(&self) -> StimulusId {
        StimulusId::from_ray_counts(self.anchors.ten_rays, self.anchors.ten_rays)
    }

    /// The largest ray count of any channel of any image: how far the one trace goes.
    pub fn most_rays(&self) -> RayCount {
        self.stimuli()
            .iter()
            .map(|stimulus| stimulus.rays_a.max(stimulus.rays_c1c2))
            .max()
            .unwrap_or(self.anchors.ten_rays)
    }

    /// What is wrong with the plan, as (field, found, expected).
    pub(crate) fn fault(&self) -> Option<(&'static str, String, &'static str)> {
        let is_plain =
            |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'-';
        if self.set.is_empty() || !self.set.bytes().all(is_plain) {
            let expected = "lower-case letters, digits and '-' (it names a folder)";
            return Some(("stimuli.set", format!("{:?}", self.set), expected));
        }
        if self
            .size_px
            .iter()
            .any(|&size| !(1..=16_384).contains(&size))
        {
            let expected = "a width and a height from 1 to 16384 pixels";
            return Some(("stimuli.size_px", format!("{:?}", self.size_px), expected));
        }
        let is_twice = |place: usize| self.export[..place].contains(&self.export[place]);
        if (0..self.export.len()).any(is_twice) {
            let found = format!("{:?}", self.export);
            return Some(("stimuli.export", found, "each export once"));
        }
        if !(1..=12).contains(&self.tree.min_depth) {
            let found = self.tree.min_depth.to_string();
            return Some(("stimuli.tree.min_depth", found, "a depth from 1 to 12"));
        }
        for sequence in &self.sequences {
            if sequence.rays.is_empty() || !sequence.rays.is_sorted_by(|left, right| left < right) {
                let found = format!("the counts of the {} sequence", sequence.varied);
                return Some((
                    "stimuli.sequences.rays",
                    found,
                    "at least one count, each larger than the one before",
                ));
            }
        }
        let fewest = self
            .stimuli()
            .iter()
            .map(|s| s.rays_a.min(s.rays_c1c2))
            .min();
        let cells = 1_u32 << self.tree.min_depth;
        match fewest {
            Some(fewest) if fewest.get() < cells => Some((
                "stimuli",
                format!(
                    "an image of {fewest} rays and a minimum depth of {} ({cells} cells)",
                    self.tree.min_depth
                ),
                "at least one ray for each cell of the minimum depth",
            )),
            _ => None,
        }
    }
}

/// At which wavelengths light is carried through the scene.
///
/// Written `16 bands` (bands of equal width over 400–700 nm, any number from 3 to 301) or `meyer 1988`
/// (his four wavelengths).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Quadrature {
    /// This many bands of equal width over 400–700 nm.
    Bands(u32),
    /// Meyer's (1988) four wavelengths, two for C1, one more for A, one for C2.
    Meyer1988,
}

impl TryFrom<String> for Quadrature {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        if text == "meyer 1988" {
            return Ok(Self::Meyer1988);
        }
        let bands = text
            .strip_suffix(" bands")
            .and_then(|count| count.parse().ok());
        match bands {
            Some(bands) if (3..=301).contains(&bands) => Ok(Self::Bands(bands)),
            _ => Err(format!(
                "found {text:?}, expected \"16 bands\" (3 to 301) or \"meyer 1988\""
            )),
        }
    }
}

impl From<Quadrature> for String {
    fn from(quadrature: Quadrature) -> Self {
        match quadrature {
            Quadrature::Bands(bands) => format!("{bands} bands"),
            Quadrature::Meyer1988 => "meyer 1988".to_owned(),
        }
    }
}

/// How the screen tree is refined and read.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TreePlan {
    /// Down to this depth every cell is split, whatever was found in it.
    pub min_depth: u32,
    /// Which channels say where the picture needs more samples.
    pub driver: RefinementDriver,
}

/// Which channels say where the picture needs more samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum RefinementDriver {
    /// A alone, as in section 3.2: stopping C1 and C2 then leaves the image of A as it is.
    A,
    /// All three channels: a channel that stops then changes the tree.
    #[serde(rename = "AC1C2")]
    All,
}

/// The ray counts of the two images that stay beside the test image; all channels alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Anchors {
    /// The image of quality zero, shown on the left.
    pub zero_rays: RayCount,
    /// The image of quality ten, shown on the right.
    pub ten_rays: RayCount,
}

/// Images in which one group of channels is varied and the other held.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sequence {
    /// The group whose ray count changes.
    pub varied: ChannelGroup,
    /// Its counts, rising.
    pub rays: Vec<RayCount>,
    /// The count of the other group.
    pub held_rays: RayCount,
}
