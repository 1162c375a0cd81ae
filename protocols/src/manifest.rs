//! The manifest of a stimulus set: what was made, from what, and the digest of every file.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::{
    Acuity, Export, InputError, RayCount, ReadError, Sha256Digest, StimulusId, StimulusPlan, Study,
    Viewing,
};

/// `manifest.json`: what a stimulus set is, and the digest of every file of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// The name of the set.
    pub set: String,
    /// The version of the program that made it.
    pub acuity_version: String,
    /// The digest of the protocol that it was made from.
    pub protocol_sha256: Sha256Digest,
    /// The digest of the scene file.
    pub scene_sha256: Sha256Digest,
    /// The plan that it was made from.
    pub plan: StimulusPlan,
    /// What the numbers of the EXR files and of the PNG files mean.
    pub color_space: String,
    /// Remarks that a reader of the images must know, such as a driver that ties the channels together.
    pub remarks: Vec<String>,
    /// How the images are meant to be seen.
    pub viewing: ViewingGeometry,
    /// Beyond which cutoffs no channel was refined, if it was so limited.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub acuity: Option<Acuity>,
    /// One entry for each image.
    pub stimuli: Vec<ManifestStimulus>,
}

/// How the images are meant to be seen.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViewingGeometry {
    /// From the eye to the screen.
    pub distance_cm: f64,
    /// The angle of one pixel.
    pub degrees_per_pixel: f64,
    /// The width of a pixel that has this angle at this distance.
    pub pixel_pitch_mm: f64,
    /// The inverse of the angle.
    pub pixels_per_degree: f64,
}

impl From<Viewing> for ViewingGeometry {
    fn from(viewing: Viewing) -> Self {
        Self {
            distance_cm: viewing.distance_cm,
            degrees_per_pixel: viewing.degrees_per_pixel,
            pixel_pitch_mm: viewing.pixel_pitch_mm(),
            pixels_per_degree: viewing.pixels_per_degree(),
        }
    }
}

/// One image of the set.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ManifestStimulus {
    /// The name.
    pub id: StimulusId,
    /// The group varied: `achromatic`, `chromatic`, `both` or `neither`.
    pub varied: String,
    /// How many rays made A.
    pub rays_a: RayCount,
    /// How many rays made C1 and C2.
    pub rays_c1c2: RayCount,
    /// The level of each factor, for the ratings.
    pub factors: BTreeMap<String, String>,
    /// A, C1 and C2 as float channels.
    pub exr: ManifestFile,
    /// 8-bit sRGB, white D65.
    pub png: ManifestFile,
    /// Pixels of the PNG that had to be clipped to the sRGB gamut.
    pub out_of_gamut_px: u32,
    /// The further files that the plan asks for.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub exports: BTreeMap<Export, ManifestFile>,
}

impl ManifestStimulus {
    /// Every file of the image.
    pub fn files(&self) -> impl Iterator<Item = &ManifestFile> {
        [&self.exr, &self.png]
            .into_iter()
            .chain(self.exports.values())
    }
}

/// One file of the set.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ManifestFile {
    /// Its name, in the folder of the manifest.
    pub name: String,
    /// Its digest.
    pub sha256: Sha256Digest,
}

impl Manifest {
    /// The name of the manifest in the folder of its set.
    pub const FILE_NAME: &'static str = "manifest.json";

    /// Reads the manifest in the folder `stimuli_dir`.
    ///
    /// # Errors
    ///
    /// [`ReadError::Input`] if it is missing, malformed or contradicts itself.
    pub fn read(stimuli_dir: &Path) -> Result<Self, ReadError> {
        let path = stimuli_dir.join(Self::FILE_NAME);
        let kind = "the manifest of a stimulus set (`acuity render` makes it)";
        let text =
            fs::read_to_string(&path).map_err(|error| ReadError::from_io(&path, kind, error))?;
        let manifest: Self = serde_json::from_str(&text).map_err(|error| {
            InputError::new(&path, error.to_string(), kind).remedy("render the set again")
        })?;
        manifest.check(&path)?;
        Ok(manifest)
    }

    fn check(&self, path: &Path) -> Result<(), InputError> {
        for stimulus in &self.stimuli {
            for file in stimulus.files() {
                if !file.has_plain_name() {
                    return Err(InputError::new(
                        path,
                        format!("{:?}", file.name),
                        "a plain file name",
                    )
                    .at(format!("stimulus {}", stimulus.id)));
                }
            }
        }
        let mut ids: Vec<_> = self.stimuli.iter().map(|stimulus| &stimulus.id).collect();
        ids.sort_unstable();
        match ids.windows(2).find(|pair| pair[0] == pair[1]) {
            Some(pair) => Err(InputError::new(
                path,
                format!("the stimulus {} twice", pair[0]),
                "each stimulus once",
            )),
            None => Ok(()),
        }
    }

    /// Checks that the set is the one that `study` asks for.
    ///
    /// # Errors
    ///
    /// The plans differ, or an image of the study is not in the set.
    pub fn check_made_for(&self, study: &Study, stimuli_dir: &Path) -> Result<(), InputError> {
        let path = stimuli_dir.join(Self::FILE_NAME);
        let remedy = format!("run `acuity render {}`", study.path.display());
        let plan = study.render_plan()?;
        if self.plan != *plan {
            let expected = format!("the plan in [stimuli] of \"{}\"", study.path.display());
            return Err(
                InputError::new(path, "a set made from another plan", expected).remedy(remedy),
            );
        }
        let acuity = study.protocol.acuity;
        let viewing = ViewingGeometry::from(study.protocol.viewing);
        if self.acuity != acuity || (acuity.is_some() && self.viewing != viewing) {
            let expected = format!(
                "the limits that [acuity] and [viewing] of \"{}\" set",
                study.path.display()
            );
            let found = "a set made with other limits of acuity";
            return Err(InputError::new(path, found, expected).remedy(remedy));
        }
        for stimulus in plan.stimuli() {
            if self.stimulus(&stimulus.id).is_none() {
                return Err(InputError::new(
                    path,
                    "no such entry",
                    format!("the stimulus {}", stimulus.id),
                )
                .remedy(remedy));
            }
        }
        Ok(())
    }

    /// The entry of one image.
    pub fn stimulus(&self, id: &StimulusId) -> Option<&ManifestStimulus> {
        self.stimuli.iter().find(|stimulus| stimulus.id == *id)
    }
}

impl ManifestFile {
    /// Whether the file is in the folder of the manifest, whatever is written there.
    pub(crate) fn has_plain_name(&self) -> bool {
        !self.name.contains(['/', '\\']) && !self.name.starts_with('.') && !self.name.is_empty()
    }

    /// The bytes of the file, if they are those that the manifest names.
    ///
    /// # Errors
    ///
    /// [`ReadError::Input`] if the file is missing or its digest is another.
    pub fn read_verified(&self, stimuli_dir: &Path) -> Result<Vec<u8>, ReadError> {
        let path = stimuli_dir.join(&self.name);
        let bytes = fs::read(&path)
            .map_err(|error| ReadError::from_io(&path, "a file of the manifest", error))?;
        let found = Sha256Digest::of(&bytes);
        if found == self.sha256 {
            return Ok(bytes);
        }
        Err(InputError::new(
            path,
            format!("SHA-256 {found}"),
            format!("{} as in the manifest", self.sha256),
        )
        .remedy("the file was changed after it was made: render the set again")
        .into())
    }
}
