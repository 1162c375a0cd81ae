//! A protocol with its place and its digest: what every command is given.

use std::fs;
use std::path::{Path, PathBuf};

use crate::{
    Acuity, InputError, Observer, Protocol, ReadError, Sha256Digest, StimulusPlan, Viewing,
};

/// What a set of images that are rendered follows from.
#[derive(Clone, Copy, Debug)]
pub struct Rendering<'a> {
    /// Scene, size and ray counts.
    pub plan: &'a StimulusPlan,
    /// Where the subject sits.
    pub viewing: Viewing,
    /// What the eye resolves from there, if no channel is refined beyond it.
    pub acuity: Option<Acuity>,
}

/// A protocol as it was read from a file.
#[derive(Clone, Debug)]
pub struct Study {
    /// What the file states.
    pub protocol: Protocol,
    /// The file.
    pub path: PathBuf,
    /// The digest of the file; it goes into everything that is made from it.
    pub sha256: Sha256Digest,
}

impl Study {
    /// Reads a protocol file.
    ///
    /// # Errors
    ///
    /// [`ReadError::Input`] if the file is missing or is not a protocol, [`ReadError::Io`] if the system
    /// would not give it.
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        let bytes =
            fs::read(path).map_err(|error| ReadError::from_io(path, "a protocol (TOML)", error))?;
        let sha256 = Sha256Digest::of(&bytes);
        let text = String::from_utf8(bytes).map_err(|error| {
            InputError::new(
                path,
                format!("bytes that are not UTF-8 ({})", error.utf8_error()),
                "a protocol (TOML)",
            )
        })?;
        Ok(Self {
            protocol: Protocol::from_toml(path, &text)?,
            path: path.to_owned(),
            sha256,
        })
    }

    /// What the images follow from, if they are rendered from a scene.
    ///
    /// # Errors
    ///
    /// The study shows own pictures.
    pub fn rendering(&self) -> Result<Rendering<'_>, InputError> {
        Ok(Rendering {
            plan: self.render_plan()?,
            viewing: self.protocol.viewing,
            acuity: self.protocol.acuity,
        })
    }

    /// The plan of a set that is rendered from a scene.
    ///
    /// # Errors
    ///
    /// The study shows own pictures.
    pub fn render_plan(&self) -> Result<&StimulusPlan, InputError> {
        self.protocol.stimuli.rendered().ok_or_else(|| {
            let found = "own pictures (`images`)";
            InputError::new(&self.path, found, "a `scene` to render").at("table [stimuli]")
        })
    }

    /// The scene file of the stimulus set.
    ///
    /// # Errors
    ///
    /// The study shows own pictures.
    pub fn scene_path(&self) -> Result<PathBuf, InputError> {
        let folder = self.path.parent().unwrap_or_else(|| Path::new(""));
        Ok(folder.join(&self.render_plan()?.scene))
    }

    /// Where the stimulus set stands unless the user says otherwise: `stimuli/<set>`.
    pub fn default_stimuli_dir(&self) -> PathBuf {
        Path::new("stimuli").join(self.protocol.stimuli.set())
    }

    /// Where ratings stand unless the user says otherwise: `data/<study>`, for simulated observers
    /// `data/<study>-simulated`.
    pub fn default_data_dir(&self, observer: Observer) -> PathBuf {
        Path::new("data").join(self.folder_name(observer))
    }

    /// Where the report stands unless the user says otherwise: `reports/<study>`, of simulated observers
    /// `reports/<study>-simulated`.
    pub fn default_report_dir(&self, observer: Observer) -> PathBuf {
        Path::new("reports").join(self.folder_name(observer))
    }

    fn folder_name(&self, observer: Observer) -> String {
        let study = &self.protocol.study;
        match observer {
            Observer::Person => study.clone(),
            Observer::Simulated => format!("{study}-simulated"),
        }
    }
}
