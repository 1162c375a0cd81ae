//! What the app remembers of its user: the theme and the protocols opened last.
//!
//! It is a convenience, never study data: a file that is missing or damaged is as good as none, and is replaced
//! when something is next remembered.

use std::fs;
use std::path::{Path, PathBuf};

use protocols::{Access, write_atomically};
use serde::{Deserialize, Serialize};

/// How many protocols are remembered.
const MOST: usize = 6;

/// Light or dark.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum ThemeChoice {
    /// As the desktop has it.
    #[default]
    Desktop,
    /// Always light.
    Light,
    /// Always dark.
    Dark,
}

impl ThemeChoice {
    /// All, in the order of the switch.
    pub(crate) const ALL: [Self; 3] = [Self::Desktop, Self::Light, Self::Dark];

    /// The word on the switch.
    pub(crate) const fn word(self) -> &'static str {
        match self {
            Self::Desktop => "Desktop",
            Self::Light => "Light",
            Self::Dark => "Dark",
        }
    }
}

/// What is remembered.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct Settings {
    /// Light or dark.
    pub(crate) theme: ThemeChoice,
    /// Protocol files, the last one first.
    pub(crate) recent: Vec<PathBuf>,
}

impl Settings {
    /// Where they stand: beside the station, in the user's own folder.
    pub(crate) fn default_path() -> Option<PathBuf> {
        let station = experiment::StationFile::default_path()?;
        Some(station.with_file_name("app.toml"))
    }

    /// What is remembered in a file, or nothing.
    pub(crate) fn read(path: &Path) -> Self {
        let text = fs::read_to_string(path).unwrap_or_default();
        toml::from_str(&text).unwrap_or_default()
    }

    /// Puts a protocol first among those remembered.
    pub(crate) fn note(&mut self, protocol: &Path) {
        self.recent.retain(|known| known != protocol);
        self.recent.insert(0, protocol.to_owned());
        self.recent.truncate(MOST);
    }

    /// Writes what is to be remembered; what cannot be remembered is no fault worth a word.
    pub(crate) fn write(&self, path: &Path) {
        let Ok(text) = toml::to_string(self) else {
            return;
        };
        if let Some(folder) = path.parent() {
            _ = fs::create_dir_all(folder);
        }
        _ = write_atomically(path, text.as_bytes(), Access::Owner);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_protocols_come_first_and_each_once() {
        let mut settings = Settings::default();
        for number in [1, 2, 3, 2, 4, 5, 6, 7, 8] {
            settings.note(Path::new(&format!("/study/{number}.toml")));
        }
        let names = [8, 7, 6, 5, 4, 2].map(|number| PathBuf::from(format!("/study/{number}.toml")));
        assert_eq!(settings.recent, names);
    }

    #[test]
    fn settings_are_read_as_written_and_damage_is_forgotten() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("acuity/app.toml");
        assert_eq!(Settings::read(&path), Settings::default());
        let mut settings = Settings {
            theme: ThemeChoice::Dark,
            ..Settings::default()
        };
        settings.note(Path::new("/a/b.toml"));
        settings.write(&path);
        assert_eq!(Settings::read(&path), settings);
        let text = fs::read_to_string(&path).unwrap();
        for damaged in [
            &text[..text.len() - 5],
            "theme = 3",
            "\u{0}",
            "theme = \"pink\"",
        ] {
            fs::write(&path, damaged).unwrap();
            assert_eq!(Settings::read(&path), Settings::default(), "{damaged:?}");
        }
    }
}
