//! What two models of vision predict that a study will find, before anyone is asked.
//!
//! Each model's difference of an image from its reference is stretched onto the study's scale: no difference, or the ten
//! anchor, at the highest rating, the zero anchor (or else the worst image) at the lowest, and an image that differs more than
//! the zero anchor at the lowest too. A prediction has no observers: only the shape of the curves is predicted, not how
//! people use a scale.

use std::fmt::Write as _;

use protocols::{Scale, Sha256Digest, StimulusId, Study};
use rayon::prelude::*;

use crate::scielab::Scielab;
use crate::{ExperimentError, StimulusSet, qualities};

/// What both models say of one image.
#[derive(Clone, Debug, PartialEq)]
pub struct Prediction {
    /// The image.
    pub stimulus: StimulusId,
    /// The level of each factor.
    pub levels: Vec<String>,
    /// `ColorVideoVDP`, in just-objectionable differences; 10 is no visible difference.
    pub cvvdp_jod: f64,
    /// The same on the study's scale.
    pub cvvdp_rating: f64,
    /// S-CIELAB, the mean ΔE*ab.
    pub scielab_delta_e: f64,
    /// The same on the study's scale.
    pub scielab_rating: f64,
}

/// The predictions for a stimulus set.
#[derive(Clone, Debug, PartialEq)]
pub struct Predictions {
    /// The names of the factors.
    pub factors: Vec<String>,
    /// The digest of the manifest of the set.
    pub manifest_sha256: Sha256Digest,
    /// One for each image that is rated, in the order of the protocol.
    pub images: Vec<Prediction>,
}

/// Predicts the rating of every image of `study`.
///
/// # Errors
///
/// The images cannot be judged, or a model sees no difference between the ends of the scale.
pub fn predict(study: &Study, set: &StimulusSet) -> Result<Predictions, ExperimentError> {
    let stimuli = &study.protocol.stimuli;
    let by_vision = qualities(study, set)?;
    let scielab = Scielab::new(study.protocol.viewing.pixels_per_degree());
    let images: Vec<_> = (stimuli.images().into_iter())
        .filter(|image| image.is_rated)
        .collect();
    let delta_e = |id: &StimulusId| -> Result<f64, ExperimentError> {
        let reference = stimuli.reference_of(id).unwrap_or_else(|| id.clone());
        Ok(scielab.difference(set.image(id)?, set.image(&reference)?))
    };
    let differences: Vec<f64> = (images.par_iter())
        .map(|image| delta_e(&image.id))
        .collect::<Result<_, _>>()?;
    let worst = match stimuli.zero_anchor() {
        Some(anchor) => delta_e(&anchor)?,
        None => differences.iter().copied().fold(0.0, f64::max),
    };
    let scale = study.protocol.session.scale;
    let predictions = images.into_iter().zip(differences).map(|(image, delta_e)| {
        let vision = &by_vision[&image.id];
        Prediction {
            cvvdp_jod: vision.jod,
            cvvdp_rating: vision
                .on_scale
                .clamp(f64::from(scale.lowest), f64::from(scale.highest)),
            scielab_delta_e: delta_e,
            scielab_rating: rating_of_difference(scale, delta_e, worst),
            stimulus: image.id,
            levels: image.levels,
        }
    });
    Ok(Predictions {
        factors: stimuli.factors(),
        manifest_sha256: set.manifest_sha256().clone(),
        images: predictions.collect(),
    })
}

/// The rating that lies between the ends of the scale as `difference` between none and `worst`; a scale has no rating for more.
fn rating_of_difference(scale: Scale, difference: f64, worst: f64) -> f64 {
    let (lowest, highest) = (f64::from(scale.lowest), f64::from(scale.highest));
    (highest - (highest - lowest) * difference / worst.max(1e-9)).clamp(lowest, highest)
}

impl Predictions {
    /// A line for each image.
    pub fn to_csv(&self) -> String {
        let mut csv = format!(
            "stimulus_id,{},cvvdp_jod,cvvdp_rating,scielab_delta_e,scielab_rating,manifest_sha256\n",
            self.factors.join(",")
        );
        for one in &self.images {
            let levels: Vec<String> = one.levels.iter().map(|level| quoted(level)).collect();
            // Writing to a `String` cannot fail.
            _ = writeln!(
                csv,
                "{},{},{},{},{},{},{}",
                one.stimulus,
                levels.join(","),
                one.cvvdp_jod,
                one.cvvdp_rating,
                one.scielab_delta_e,
                one.scielab_rating,
                self.manifest_sha256
            );
        }
        csv
    }

    /// A line for each image, for a terminal.
    pub fn to_text(&self) -> String {
        let mut text = format!(
            "{:<28} {:>8} {:>8} {:>10} {:>8}\n",
            "image", "JOD", "rating", "S-CIELAB", "rating"
        );
        for one in &self.images {
            // Writing to a `String` cannot fail.
            _ = writeln!(
                text,
                "{:<28} {:>8.2} {:>8.1} {:>10.3} {:>8.1}",
                one.stimulus.as_str(),
                one.cvvdp_jod,
                one.cvvdp_rating,
                one.scielab_delta_e,
                one.scielab_rating
            );
        }
        text
    }
}

/// A field of CSV, in quotes where it needs them.
fn quoted(field: &str) -> String {
    if field.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rating_never_leaves_the_scale() {
        let scale = Scale {
            lowest: 2,
            highest: 10,
        };
        // A quarter of the worst difference takes a quarter of the eight steps.
        let ratings = [0.0, 1.0, 4.0, 4.4].map(|d| rating_of_difference(scale, d, 4.0));
        assert_eq!(ratings, [10.0, 8.0, 2.0, 2.0]);
        assert_eq!(rating_of_difference(scale, 0.0, 0.0), 10.0);
    }
}
