//! The manifest of a set of own pictures: what each was, and the digest of what is shown.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::{
    InputError, Manifest, ManifestFile, PicturePlan, PictureSet, ReadError, Sha256Digest,
    StimulusId, Study, ViewingGeometry,
};

/// `manifest.json` of a set of own pictures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PictureManifest {
    /// The name of the set.
    pub set: String,
    /// The version of the program that made it.
    pub acuity_version: String,
    /// The digest of the protocol that it was made from.
    pub protocol_sha256: Sha256Digest,
    /// The digest of the table of factors.
    pub factors_sha256: Sha256Digest,
    /// The plan that it was made from.
    pub plan: PicturePlan,
    /// What the numbers of the PNG files mean.
    pub color_space: String,
    /// What a reader of the pictures must know.
    pub remarks: Vec<String>,
    /// How the pictures are meant to be seen.
    pub viewing: ViewingGeometry,
    /// Width and height of every picture.
    pub size_px: [u32; 2],
    /// One entry for each picture.
    pub pictures: Vec<ManifestPicture>,
}

/// One picture of the set.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ManifestPicture {
    /// The name.
    pub id: StimulusId,
    /// The level of each factor; all empty if it is not rated.
    pub factors: BTreeMap<String, String>,
    /// The undisturbed picture that simulated observers compare it with.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference: Option<StimulusId>,
    /// The file that was brought along.
    pub source: ManifestFile,
    /// What is shown: 8-bit sRGB; the very bytes of the source if that is such a file.
    pub png: ManifestFile,
}

impl PictureManifest {
    /// Reads the manifest in the folder `stimuli_dir`, and checks that the set is that of `study`.
    ///
    /// # Errors
    ///
    /// [`ReadError::Input`] if it is missing, malformed, or of another plan or table.
    pub fn read(
        study: &Study,
        pictures: &PictureSet,
        stimuli_dir: &Path,
    ) -> Result<Self, ReadError> {
        let path = stimuli_dir.join(Manifest::FILE_NAME);
        let kind = "the manifest of a set of pictures (`acuity render` makes it)";
        let remedy = format!("run `acuity render {}`", study.path.display());
        let text =
            fs::read_to_string(&path).map_err(|error| ReadError::from_io(&path, kind, error))?;
        let manifest: Self = serde_json::from_str(&text)
            .map_err(|error| InputError::new(&path, error.to_string(), kind).remedy(&remedy))?;
        let wrong = |found: &str, expected: String| {
            InputError::new(&path, found, expected)
                .remedy(&remedy)
                .into()
        };
        if manifest.plan != pictures.plan {
            let expected = format!("the plan in [stimuli] of \"{}\"", study.path.display());
            return Err(wrong("a set made from another plan", expected));
        }
        if manifest.factors_sha256 != pictures.table.sha256 {
            let expected = format!("the table \"{}\"", pictures.table.path.display());
            return Err(wrong("a set made from another table of factors", expected));
        }
        let is_plain = |file: &ManifestFile| file.has_plain_name();
        let files = |picture: &ManifestPicture| is_plain(&picture.source) && is_plain(&picture.png);
        let ids = manifest.pictures.iter().map(|picture| &picture.id);
        if !manifest.pictures.iter().all(files)
            || ids.ne(pictures.table.pictures.iter().map(|picture| &picture.id))
        {
            let expected = format!("those of \"{}\"", pictures.table.path.display());
            return Err(wrong("other pictures", expected));
        }
        Ok(manifest)
    }
}
