//! What a stimulus set cost, and what stopping channels saved.

use std::fmt;
use std::path::PathBuf;

use protocols::{ManifestStimulus, PerChannel, RayCount, Rendering, StimulusId};

use crate::account::RayAccount;
use crate::acuity_limits::AcuityLimits;
use crate::image_request::ImageRequest;
use crate::screen_tree::ScreenTree;

/// What was made and what it cost.
#[derive(Clone, Debug, PartialEq)]
pub struct SetSummary {
    /// The folder of the set.
    pub folder: PathBuf,
    /// The one trace from which all images were read.
    pub account: RayAccount,
    /// Each image.
    pub stimuli: Vec<StimulusSummary>,
    /// What `[acuity]` implies, if the protocol has it.
    pub acuity: Option<AcuityLimits>,
    /// The remarks of the manifest.
    pub remarks: Vec<String>,
    /// The warnings of the scene.
    pub warnings: Vec<String>,
}

/// One image of the set, and what it would cost alone.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StimulusSummary {
    /// Its name.
    pub id: StimulusId,
    /// How many rays made A.
    pub rays_a: RayCount,
    /// How many rays made C1 and C2.
    pub rays_c1c2: RayCount,
    /// What the image costs if it is traced alone and each channel stops at its ray count.
    pub alone: RayAccount,
    /// How many rectangles each channel's image was filtered from.
    pub rectangles: PerChannel<u64>,
    /// Pixels that had to be clipped to the sRGB gamut.
    pub out_of_gamut_px: u32,
}

impl StimulusSummary {
    pub(crate) fn new(
        stimulus: &ManifestStimulus,
        rendering: Rendering<'_>,
        tree: &ScreenTree,
    ) -> Self {
        let request = ImageRequest::of_study(rendering, stimulus.rays_a, stimulus.rays_c1c2);
        Self {
            id: stimulus.id.clone(),
            rays_a: stimulus.rays_a,
            rays_c1c2: stimulus.rays_c1c2,
            alone: request.account_in(tree),
            rectangles: request.rectangles_in(tree),
            out_of_gamut_px: stimulus.out_of_gamut_px,
        }
    }
}

impl SetSummary {
    /// What the images cost if each is traced alone and each channel stops at its ray count.
    pub fn alone(&self) -> RayAccount {
        self.stimuli.iter().map(|stimulus| stimulus.alone).sum()
    }

    /// What the images cost if each is traced alone with all channels to its largest ray count.
    pub fn full(&self) -> RayAccount {
        let full = |stimulus: &StimulusSummary| RayAccount::full(stimulus.alone.intersections);
        self.stimuli.iter().map(full).sum()
    }
}

impl fmt::Display for SetSummary {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let images = self.stimuli.len();
        writeln!(
            formatter,
            "{}: {images} images and manifest.json",
            self.folder.display()
        )?;
        if let Some(limits) = &self.acuity {
            writeln!(formatter, "{limits}")?;
        }
        writeln!(formatter, "one trace for all of them: {}", self.account)?;
        writeln!(
            formatter,
            "\n{:<24}{:>15}{:>12}{:>12}{:>12}",
            "", "intersections", "A", "C1", "C2"
        )?;
        let rows = [
            ("spent: one trace", self.account),
            ("each image alone", self.alone()),
            ("and no channel stopped", self.full()),
        ];
        for (
            name,
            RayAccount {
                intersections,
                shadings,
            },
        ) in rows
        {
            let PerChannel { a, c1, c2 } = shadings;
            writeln!(
                formatter,
                "{name:<24}{intersections:>15}{a:>12}{c1:>12}{c2:>12}"
            )?;
        }
        writeln!(
            formatter,
            "\n{:<18}{:>10}{:>13}{:>8}{:>12}{:>9}",
            "image alone", "shadings", "of 3 x rays", "saved", "rectangles", "clipped"
        )?;
        for stimulus in &self.stimuli {
            writeln!(formatter, "{stimulus}")?;
        }
        let clipped = self
            .stimuli
            .iter()
            .filter(|stimulus| stimulus.out_of_gamut_px > 0)
            .count();
        write!(
            formatter,
            "\n{clipped} of {images} images have pixels out of the sRGB gamut"
        )?;
        for remark in &self.remarks {
            write!(formatter, "\nremark: {remark}")?;
        }
        Ok(())
    }
}

impl fmt::Display for StimulusSummary {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let spent = self.alone.total_shadings();
        let full = 3 * self.alone.intersections;
        let percent = 100.0 * self.alone.saved_shadings() as f64 / full as f64;
        let PerChannel { a, c1, c2 } = self.rectangles;
        write!(
            formatter,
            "{:<18}{spent:>10}{full:>13}{percent:>7.1}%{:>12}{:>9}",
            self.id.as_str(),
            a + c1 + c2,
            self.out_of_gamut_px,
        )
    }
}
