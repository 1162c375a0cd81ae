//! The part of a protocol that says what the eye can resolve, so that no channel is refined beyond it.

use serde::{Deserialize, Serialize};

use crate::{ChannelGroup, Viewing};

/// The highest spatial frequency that is seen in each group of channels.
///
/// The table `[acuity]` of a protocol; a key that is left out has Mullen's value.
///
/// # Source
///
/// Mullen (1985), *J. Physiol.* 359, 381–400, as cited in section 2.3 of Meyer & Liu (1992).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Acuity {
    /// Of A: 34 cycles per degree.
    pub luminance_cutoff_cpd: f64,
    /// Of C1 and C2: 11 cycles per degree.
    pub chromatic_cutoff_cpd: f64,
}

impl Acuity {
    /// The cutoffs of Mullen (1985).
    pub const MULLEN_1985: Self = Self {
        luminance_cutoff_cpd: 34.0,
        chromatic_cutoff_cpd: 11.0,
    };

    /// The cutoff of a group of channels, in cycles per degree.
    pub const fn cutoff_cpd(self, group: ChannelGroup) -> f64 {
        match group {
            ChannelGroup::Achromatic => self.luminance_cutoff_cpd,
            ChannelGroup::Chromatic => self.chromatic_cutoff_cpd,
        }
    }

    /// How far apart samples may lie, in pixels, to carry the cutoff: two to a cycle.
    ///
    /// ```text
    /// spacing = pixels per degree / (2 cutoff)
    /// ```
    ///
    /// ```
    /// use protocols::{Acuity, ChannelGroup, Viewing};
    /// // 320 pixels at 0.019 degrees and 11 cycles per degree: 133.76 samples, by geometry.py of the reference.
    /// let spacing = Acuity::MULLEN_1985.spacing_px(ChannelGroup::Chromatic, Viewing::MEYER_LIU_1992);
    /// assert!((320.0 / spacing - 133.76).abs() < 1e-9);
    /// ```
    pub fn spacing_px(self, group: ChannelGroup, viewing: Viewing) -> f64 {
        0.5 * viewing.pixels_per_degree() / self.cutoff_cpd(group)
    }

    pub(crate) fn fault(self) -> Option<(&'static str, String, &'static str)> {
        let fields = [
            ("acuity.luminance_cutoff_cpd", self.luminance_cutoff_cpd),
            ("acuity.chromatic_cutoff_cpd", self.chromatic_cutoff_cpd),
        ];
        let is_wrong = |cutoff_cpd: f64| !(0.01..=1000.0).contains(&cutoff_cpd);
        let (field, cutoff_cpd) = fields.into_iter().find(|(_, cutoff)| is_wrong(*cutoff))?;
        let expected = "a cutoff from 0.01 to 1000 cycles per degree";
        Some((field, cutoff_cpd.to_string(), expected))
    }
}

impl Default for Acuity {
    fn default() -> Self {
        Self::MULLEN_1985
    }
}
