//! A stimulus set of own pictures: each is checked, and what a session shows of it is written beside the
//! manifest.
//!
//! A picture of 8-bit RGB is copied as it is. One of 16 bits, or grey, is rounded and spread to 8-bit RGB,
//! with a remark. One with transparent pixels is refused: what stands behind them is not known.

use std::collections::BTreeMap;
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use image::{ColorType, DynamicImage, ImageFormat};
use protocols::{
    Access, InputError, ManifestFile, ManifestPicture, Picture, PictureManifest, PictureSet,
    ReadError, Sha256Digest, Study, write_atomically,
};
use rayon::prelude::*;

use crate::error::RendererError;
use crate::png_notes::foreign_colours;
use crate::srgb_png::SrgbImage;
use crate::stimulus_set::{remove_manifest, write_manifest};
use crate::watch::{Stage, Watch};

const COLOR_SPACE: &str =
    "PNG: sRGB (IEC 61966-2-1), 8 bits, white D65, whatever the source says of its colours.";
const KIND: &str = "a PNG picture of 8 or 16 bits";

/// What was made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureSetSummary {
    /// The folder of the set.
    pub folder: PathBuf,
    /// Width and height of every picture.
    pub size_px: [u32; 2],
    /// How many pictures there are, and how many of them are rated.
    pub pictures: [usize; 2],
    /// The remarks of the manifest.
    pub remarks: Vec<String>,
}

impl fmt::Display for PictureSetSummary {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([width, height], [all, rated]) = (self.size_px, self.pictures);
        let folder = self.folder.display();
        write!(
            formatter,
            "{folder}: {all} pictures of {width} x {height} pixels, {rated} of them rated, and manifest.json"
        )?;
        for remark in &self.remarks {
            write!(formatter, "\nwarning: {remark}")?;
        }
        Ok(())
    }
}

/// A picture as it was found, ready to be written.
struct Found<'a> {
    picture: &'a Picture,
    source: ManifestFile,
    size_px: [u32; 2],
    shown: Vec<u8>,
    notes: Vec<&'static str>,
    foreign: Option<String>,
}

/// Makes the set of own pictures of a study in the folder `out`.
///
/// # Errors
///
/// [`RendererError::Input`] if a picture is missing, not listed, no PNG, transparent or of another size;
/// other variants if a file could not be made. There is then no manifest.
pub fn make_picture_set(
    study: &Study,
    pictures: &PictureSet,
    out: &Path,
    watch: &Watch<'_>,
) -> Result<PictureSetSummary, RendererError> {
    pictures.check_files()?;
    check_is_another_folder(pictures, out)?;
    let listed = &pictures.table.pictures;
    let found: Result<Vec<Found<'_>>, RendererError> = (listed.par_iter())
        .map(|picture| find(pictures, picture))
        .collect();
    let found = found?;
    let size_px = common_size(pictures, &found)?;
    remove_manifest(out)?;
    let done = AtomicU64::new(0);
    let written: Result<Vec<ManifestPicture>, RendererError> = (found.par_iter())
        .map(|found| {
            let entry = write(pictures, found, out)?;
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            watch.tell(Stage::Images, done, listed.len() as u64);
            Ok(entry)
        })
        .collect();
    let manifest = PictureManifest {
        set: pictures.plan.set.clone(),
        acuity_version: env!("CARGO_PKG_VERSION").to_owned(),
        protocol_sha256: study.sha256.clone(),
        factors_sha256: pictures.table.sha256.clone(),
        plan: pictures.plan.clone(),
        color_space: COLOR_SPACE.to_owned(),
        remarks: remarks(&found),
        viewing: study.protocol.viewing.into(),
        size_px,
        pictures: written?,
    };
    write_manifest(&manifest, out)?;
    let rated = listed.iter().filter(|picture| picture.is_rated()).count();
    Ok(PictureSetSummary {
        folder: out.to_owned(),
        size_px,
        pictures: [listed.len(), rated],
        remarks: manifest.remarks,
    })
}

/// A set is never written over the pictures that it is made from.
fn check_is_another_folder(pictures: &PictureSet, out: &Path) -> Result<(), InputError> {
    let real = |folder: &Path| fs::canonicalize(folder).ok();
    if real(out).is_some() && real(out) == real(&pictures.folder) {
        let expected = "another folder for the set than that of the pictures";
        return Err(InputError::new(out, "the pictures themselves", expected)
            .remedy("name another with --out"));
    }
    Ok(())
}

fn find<'a>(pictures: &PictureSet, picture: &'a Picture) -> Result<Found<'a>, RendererError> {
    let path = pictures.folder.join(&picture.file);
    let bytes = fs::read(&path).map_err(|error| ReadError::from_io(&path, KIND, error))?;
    let image = image::load_from_memory_with_format(&bytes, ImageFormat::Png)
        .map_err(|error| InputError::new(&path, error.to_string(), KIND))?;
    let size_px = [image.width(), image.height()];
    if let Some([x, y]) = first_transparent(&image) {
        let found = format!("a transparent pixel at {x}, {y}");
        let error = InputError::new(&path, found, "opaque pixels");
        return Err(error
            .remedy("flatten the picture onto its background")
            .into());
    }
    let mut notes = Vec::new();
    if image.color().bytes_per_pixel() / image.color().channel_count() > 1 {
        notes.push("16-bit values are rounded to the 8 bits that a session shows");
    }
    if image.color().has_alpha() {
        notes.push("an alpha channel, opaque everywhere, is left out");
    }
    let is_shown_as_it_is = image.color() == ColorType::Rgb8;
    let foreign = foreign_colours(&bytes);
    let source = ManifestFile {
        name: picture.file.clone(),
        sha256: Sha256Digest::of(&bytes),
    };
    let shown = if is_shown_as_it_is {
        bytes
    } else {
        let rgb = SrgbImage {
            size_px,
            bytes: image.into_rgb8().into_raw(),
            out_of_gamut_px: 0,
        };
        rgb.to_png(&path)?
    };
    Ok(Found {
        picture,
        source,
        size_px,
        shown,
        notes,
        foreign,
    })
}

fn first_transparent(image: &DynamicImage) -> Option<[u32; 2]> {
    if !image.color().has_alpha() {
        return None;
    }
    let rgba = image.to_rgba16();
    let mut pixels = rgba.enumerate_pixels();
    pixels.find_map(|(x, y, pixel)| (pixel.0[3] != u16::MAX).then_some([x, y]))
}

fn common_size(pictures: &PictureSet, found: &[Found<'_>]) -> Result<[u32; 2], InputError> {
    let size_px = found.first().map_or([0, 0], |first| first.size_px);
    let Some(other) = found.iter().find(|found| found.size_px != size_px) else {
        return Ok(size_px);
    };
    let text = |[width, height]: [u32; 2]| format!("{width} x {height} pixels");
    let expected = format!("{} as {:?} has", text(size_px), found[0].picture.file);
    let path = pictures.folder.join(&other.picture.file);
    Err(InputError::new(path, text(other.size_px), expected)
        .remedy("bring all pictures of a study to one size"))
}

fn write(
    pictures: &PictureSet,
    found: &Found<'_>,
    out: &Path,
) -> Result<ManifestPicture, RendererError> {
    let picture = found.picture;
    let path = out.join(&picture.file);
    write_atomically(&path, &found.shown, Access::Ordinary)
        .map_err(|error| RendererError::writing(&path, error))?;
    let levels = picture.levels.iter().cloned();
    let factors: BTreeMap<String, String> =
        pictures.table.factors.iter().cloned().zip(levels).collect();
    Ok(ManifestPicture {
        id: picture.id.clone(),
        factors,
        reference: picture.reference.clone(),
        source: found.source.clone(),
        png: ManifestFile {
            name: picture.file.clone(),
            sha256: Sha256Digest::of(&found.shown),
        },
    })
}

/// One remark for each thing to know, with the pictures that it is true of.
fn remarks(found: &[Found<'_>]) -> Vec<String> {
    let mut by_note: BTreeMap<String, Vec<&str>> = BTreeMap::new();
    for found in found {
        let foreign = found
            .foreign
            .iter()
            .map(|foreign| format!("{foreign} is not applied: the pixels are shown as sRGB"));
        let notes = found.notes.iter().map(|&note| note.to_owned());
        for note in notes.chain(foreign) {
            by_note.entry(note).or_default().push(&found.picture.file);
        }
    }
    let remark = |(note, files): (String, Vec<&str>)| match files.as_slice() {
        [one] => format!("{one}: {note}"),
        [first, rest @ ..] => format!("{first} and {} more: {note}", rest.len()),
        [] => note,
    };
    by_note.into_iter().map(remark).collect()
}
