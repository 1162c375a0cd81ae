//! Further files of each image, for other programs.

use std::fmt;

use serde::{Deserialize, Serialize};

/// A further file of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Export {
    /// EXR with the tristimulus values X, Y, Z.
    Xyz,
    /// EXR with the radiance at each wavelength.
    Spectral,
    /// PNG in sRGB of 16 bits.
    Png16,
}

impl Export {
    /// Every export.
    pub const ALL: [Self; 3] = [Self::Xyz, Self::Spectral, Self::Png16];

    /// The word in protocols and on the command line.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Xyz => "xyz",
            Self::Spectral => "spectral",
            Self::Png16 => "png16",
        }
    }
}

impl fmt::Display for Export {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.as_str())
    }
}
