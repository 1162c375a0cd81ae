//! The images of a study, taken from disk only as the manifest names them.
//!
//! Every image is decoded from the very bytes whose SHA-256 was compared, so what is shown is what was
//! made.

use std::collections::BTreeMap;
use std::path::Path;

use image::{ColorType, ImageFormat};
use protocols::{
    InputError, Manifest, ManifestFile, ManifestStimulus, ReadError, Sha256Digest, StimulusId,
    Study,
};

use crate::ExperimentError;

/// An image as the screen shows it: 8-bit sRGB, row by row from the top, three bytes a pixel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScreenImage {
    /// Width and height.
    pub size_px: [u32; 2],
    /// Red, green and blue of each pixel.
    pub rgb: Vec<u8>,
}

/// All images of a study, verified and decoded.
#[derive(Clone, Debug)]
pub struct StimulusSet {
    images: BTreeMap<StimulusId, ScreenImage>,
    manifest_sha256: Sha256Digest,
}

impl StimulusSet {
    /// Reads the PNG files of every image of `study` from the folder `stimuli_dir`.
    ///
    /// # Errors
    ///
    /// The manifest or an image is missing, malformed, of another study, of another size, or not the file
    /// that was made.
    pub fn read(study: &Study, stimuli_dir: &Path) -> Result<Self, ExperimentError> {
        let manifest = Manifest::read(stimuli_dir)?;
        manifest.check_made_for(study, stimuli_dir)?;
        let path = stimuli_dir.join(Manifest::FILE_NAME);
        let manifest_sha256 =
            Sha256Digest::of_file(&path).map_err(ExperimentError::io("read", &path))?;
        let size_px = study.protocol.stimuli.size_px;
        let mut images = BTreeMap::new();
        for stimulus in study.protocol.stimuli.stimuli() {
            let Some(entry) = manifest.stimulus(&stimulus.id) else {
                continue; // `check_made_for` has refused such a manifest.
            };
            let image = read_image(&entry.png, stimuli_dir, size_px)?;
            images.insert(stimulus.id, image);
        }
        Ok(Self {
            images,
            manifest_sha256,
        })
    }

    /// The image with this name.
    ///
    /// # Errors
    ///
    /// The study has no such image.
    pub fn image(&self, id: &StimulusId) -> Result<&ScreenImage, InputError> {
        self.images.get(id).ok_or_else(|| {
            InputError::new(
                Manifest::FILE_NAME,
                "no such entry",
                format!("the stimulus {id}"),
            )
        })
    }

    /// Every image, by name.
    pub fn images(&self) -> &BTreeMap<StimulusId, ScreenImage> {
        &self.images
    }

    /// The digest of the manifest.
    pub fn manifest_sha256(&self) -> &Sha256Digest {
        &self.manifest_sha256
    }
}

fn read_image(
    file: &ManifestFile,
    stimuli_dir: &Path,
    size_px: [u32; 2],
) -> Result<ScreenImage, ReadError> {
    let path = stimuli_dir.join(&file.name);
    let bytes = file.read_verified(stimuli_dir)?;
    let kind = "an 8-bit RGB image (PNG)";
    let image = image::load_from_memory_with_format(&bytes, ImageFormat::Png).map_err(|error| {
        InputError::new(&path, error.to_string(), kind).remedy("render the set again")
    })?;
    if image.color() != ColorType::Rgb8 {
        let found = format!("pixels of the kind {:?}", image.color());
        return Err(InputError::new(path, found, kind).into());
    }
    let found_px = [image.width(), image.height()];
    if found_px != size_px {
        let found = format!("{} x {} pixels", found_px[0], found_px[1]);
        let expected = format!(
            "{} x {} as in the protocol's stimuli.size_px",
            size_px[0], size_px[1]
        );
        return Err(InputError::new(path, found, expected).into());
    }
    Ok(ScreenImage {
        size_px,
        rgb: image.into_rgb8().into_raw(),
    })
}

/// Every file of the set that is not as the manifest says: one line each.
pub(crate) fn faults(study: &Study, stimuli_dir: &Path) -> Vec<String> {
    let manifest = match Manifest::read(stimuli_dir) {
        Ok(manifest) => manifest,
        Err(error) => return vec![error.to_string()],
    };
    if let Err(error) = manifest.check_made_for(study, stimuli_dir) {
        return vec![error.to_string()];
    }
    let files = |entry: &ManifestStimulus| {
        let exr = entry.exr.read_verified(stimuli_dir).map(|_bytes| ());
        let png = read_image(&entry.png, stimuli_dir, study.protocol.stimuli.size_px);
        [exr.err(), png.map(|_image| ()).err()]
    };
    let errors = manifest.stimuli.iter().flat_map(files).flatten();
    errors.map(|error| error.to_string()).collect()
}
