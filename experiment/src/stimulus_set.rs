//! The images of a study, taken from disk only as the manifest names them.
//!
//! Every image is decoded from the very bytes whose SHA-256 was compared, so what is shown is what was
//! made.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use image::{ColorType, ImageFormat};
use protocols::{
    InputError, Manifest, ManifestFile, ManifestPicture, ManifestStimulus, OpponentPixels,
    PerChannel, PictureManifest, ReadError, Sha256Digest, Stimuli, StimulusId, Study,
};

use crate::ExperimentError;
use crate::display::{Display, ac1c2_of_srgb};

/// An image as the screen shows it: 8-bit sRGB, row by row from the top, three bytes a pixel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScreenImage {
    /// Width and height.
    pub size_px: [u32; 2],
    /// Red, green and blue of each pixel.
    pub rgb: Vec<u8>,
}

/// All images of a study, verified and decoded, all of one size.
#[derive(Clone, Debug)]
pub struct StimulusSet {
    size_px: [u32; 2],
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
        let shown = ShownFiles::of(study, stimuli_dir)?;
        let path = stimuli_dir.join(Manifest::FILE_NAME);
        let manifest_sha256 =
            Sha256Digest::of_file(&path).map_err(ExperimentError::io("read", &path))?;
        let mut images = BTreeMap::new();
        for (id, file) in shown.files {
            images.insert(id, read_image(&file, stimuli_dir, shown.size_px)?);
        }
        Ok(Self {
            size_px: shown.size_px,
            images,
            manifest_sha256,
        })
    }

    /// The same set with the codes of a display, and for each image how many pixels the display lacks.
    ///
    /// The colours come from the EXR files, those of one's own pictures from their sRGB. For a display that is sRGB
    /// by declaration the bytes stay as they are.
    ///
    /// # Errors
    ///
    /// An EXR file is missing, malformed, of another size, or not the file that was made.
    pub fn for_display(
        mut self,
        study: &Study,
        stimuli_dir: &Path,
        display: &Display,
    ) -> Result<(Self, BTreeMap<StimulusId, u64>), ExperimentError> {
        let mut lacking = BTreeMap::new();
        if *display == Display::Srgb {
            return Ok((self, lacking));
        }
        let files = opponent_files(study, stimuli_dir)?;
        for (id, image) in &mut self.images {
            let colors = match files.get(id) {
                Some(file) => {
                    let bytes = file.read_verified(stimuli_dir)?;
                    opponent_colors(&bytes, &stimuli_dir.join(&file.name), self.size_px)?
                }
                None => (image.rgb.chunks_exact(3))
                    .map(|rgb| ac1c2_of_srgb([rgb[0], rgb[1], rgb[2]]))
                    .collect(),
            };
            let shown: Vec<([u8; 3], bool)> = colors
                .into_iter()
                .map(|color| display.shown(color))
                .collect();
            let out = shown.iter().filter(|(_, is_in)| !is_in).count();
            lacking.insert(id.clone(), out as u64);
            image.rgb = shown.into_iter().flat_map(|(codes, _)| codes).collect();
        }
        Ok((self, lacking))
    }

    /// Width and height of every image.
    pub const fn size_px(&self) -> [u32; 2] {
        self.size_px
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

/// Which files a manifest names, by what they are for.
pub(crate) struct ShownFiles {
    size_px: [u32; 2],
    /// What sessions show.
    pub(crate) files: Vec<(StimulusId, ManifestFile)>,
    /// What else belongs to the set, and the folder that it is in.
    others: Vec<(PathBuf, ManifestFile)>,
}

impl ShownFiles {
    pub(crate) fn of(study: &Study, stimuli_dir: &Path) -> Result<Self, ReadError> {
        match &study.protocol.stimuli {
            Stimuli::Rendered(plan) => {
                let manifest = Manifest::read(stimuli_dir)?;
                manifest.check_made_for(study, stimuli_dir)?;
                let entries = manifest.stimuli.iter();
                let others = |entry: &ManifestStimulus| -> Vec<_> {
                    let others = entry.files().filter(|file| file.name != entry.png.name);
                    others
                        .map(|file| (stimuli_dir.to_owned(), file.clone()))
                        .collect()
                };
                Ok(Self {
                    size_px: plan.size_px,
                    others: entries.clone().flat_map(others).collect(),
                    files: entries
                        .map(|entry| (entry.id.clone(), entry.png.clone()))
                        .collect(),
                })
            }
            Stimuli::Pictures(pictures) => {
                let manifest = PictureManifest::read(study, pictures, stimuli_dir)?;
                let entries = manifest.pictures.iter();
                let source =
                    |entry: &ManifestPicture| (pictures.folder.clone(), entry.source.clone());
                Ok(Self {
                    size_px: manifest.size_px,
                    others: entries.clone().map(source).collect(),
                    files: entries
                        .map(|entry| (entry.id.clone(), entry.png.clone()))
                        .collect(),
                })
            }
        }
    }
}

/// The colours in the bytes of a stimulus of this size, row by row from the top.
fn opponent_colors(
    bytes: &[u8],
    path: &Path,
    size_px: [u32; 2],
) -> Result<Vec<PerChannel<f64>>, InputError> {
    let found = OpponentPixels::from_exr(bytes, path)?;
    if found.size_px != size_px {
        let [width, height] = found.size_px;
        let expected = format!("{} x {}, as its picture has", size_px[0], size_px[1]);
        let found = format!("{width} x {height} pixels");
        return Err(InputError::new(path, found, expected).remedy("render the set again"));
    }
    let PerChannel { a, c1, c2 } = &found.values;
    let pixel = |((a, c1), c2): ((&f32, &f32), &f32)| PerChannel {
        a: f64::from(*a),
        c1: f64::from(*c1),
        c2: f64::from(*c2),
    };
    Ok(a.iter().zip(c1).zip(c2).map(pixel).collect())
}

/// The EXR file of each image of a rendered set; own pictures have none.
fn opponent_files(
    study: &Study,
    stimuli_dir: &Path,
) -> Result<BTreeMap<StimulusId, ManifestFile>, ReadError> {
    if study.protocol.stimuli.rendered().is_none() {
        return Ok(BTreeMap::new());
    }
    let manifest = Manifest::read(stimuli_dir)?;
    manifest.check_made_for(study, stimuli_dir)?;
    let entries = manifest.stimuli.into_iter();
    Ok(entries.map(|entry| (entry.id, entry.exr)).collect())
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
        let expected = format!("{} x {} as the set has", size_px[0], size_px[1]);
        return Err(InputError::new(path, found, expected).into());
    }
    Ok(ScreenImage {
        size_px,
        rgb: image.into_rgb8().into_raw(),
    })
}

/// Every file of the set that is not as the manifest says: one line each.
pub fn faults(study: &Study, stimuli_dir: &Path) -> Vec<String> {
    let mut faults = Vec::new();
    if let Some(pictures) = study.protocol.stimuli.pictures() {
        faults.extend(pictures.check_files().err().map(|error| error.to_string()));
    }
    let shown = match ShownFiles::of(study, stimuli_dir) {
        Ok(shown) => shown,
        Err(error) => return [faults, vec![error.to_string()]].concat(),
    };
    let others = shown.others.iter();
    let others = others.map(|(folder, file)| file.read_verified(folder).map(|_bytes| ()));
    let size_px = shown.size_px;
    let images = shown.files.iter();
    let images = images.map(|(_, file)| read_image(file, stimuli_dir, size_px).map(|_image| ()));
    let errors = others.chain(images).filter_map(Result::err);
    faults.extend(errors.map(|error| error.to_string()));
    faults
}
