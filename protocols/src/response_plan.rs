//! How a subject answers: the form of the scale, and when it is there.

use serde::{Deserialize, Serialize};

/// The form of the rating scale.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ResponseStyle {
    /// A row of numbers; one click, or the number and Enter.
    #[default]
    Buttons,
    /// A row of words, one for each rating (ITU-R BT.500: five grades).
    Labelled,
    /// An upright bar on which any whole number can be marked; with the layout `dscqs` one for each picture.
    Continuous,
}

/// When the scale is there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RatingTime {
    /// When the pictures have gone.
    #[default]
    AfterExposure,
    /// Below the last picture already; an answer ends the exposure.
    DuringExposure,
}
