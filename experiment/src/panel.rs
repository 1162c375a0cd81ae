//! Model observers asked for their ratings alone, for planning a study: no session, no files.
//!
//! An observer here is drawn as those who sit a session are, from the same distributions and by the same rule; the
//! random numbers are others.

use std::collections::BTreeMap;

use protocols::{InputError, Layout, ModelObserver, Scale, StimulusId, Study};

use crate::random::Random;
use crate::simulated_observer::{draw, perceived};

/// Any number of studies of model observers who rate the same images.
#[derive(Clone, Debug)]
pub struct ObserverPanel {
    model: ModelObserver,
    scale: Scale,
    blocks: u32,
    seed: u64,
    /// For each image its quality on the scale, and that of its reference where that is rated too.
    qualities: Vec<(f64, Option<f64>)>,
}

impl ObserverPanel {
    /// Observers of `study` who rate `images`, each of a quality on the study's scale.
    ///
    /// # Errors
    ///
    /// An image, or the reference of a pair, without a quality.
    pub fn new<'a>(
        study: &Study,
        images: impl IntoIterator<Item = &'a StimulusId>,
        qualities: &BTreeMap<StimulusId, f64>,
        seed: u64,
    ) -> Result<Self, InputError> {
        let session = &study.protocol.session;
        let quality = |id: &StimulusId| {
            qualities.get(id).copied().ok_or_else(|| {
                let expected = format!("the stimulus {id}");
                InputError::new("manifest.json", "no such entry", expected)
            })
        };
        let of_image = |id: &StimulusId| {
            let is_pair = session.layout == Layout::Dscqs;
            let reference = is_pair.then(|| study.protocol.stimuli.reference_of(id));
            let reference = reference.map(|reference| reference.unwrap_or_else(|| id.clone()));
            Ok((quality(id)?, reference.as_ref().map(&quality).transpose()?))
        };
        Ok(Self {
            model: study.protocol.simulation,
            scale: session.scale,
            blocks: session.blocks,
            seed,
            qualities: images
                .into_iter()
                .map(of_image)
                .collect::<Result<_, InputError>>()?,
        })
    }

    /// The mean rating of each image by one subject of one study, both counted from 0; of pairs, test less reference.
    pub fn ratings(&self, study: u64, subject: u32) -> Vec<f64> {
        let seed = self.seed;
        let purpose = format!("acuity panel 1, seed {seed}, study {study}, subject {subject}");
        let mut random = Random::keyed_by(&purpose);
        let bias = draw(&mut random, self.model.bias);
        let gain = draw(&mut random, self.model.gain);
        let mut rating = |quality: f64| {
            let noise = draw(&mut random, self.model.noise);
            let felt = perceived(self.scale, quality, [bias, gain, noise]);
            f64::from(self.scale.nearest(felt))
        };
        let mut sums = vec![0.0; self.qualities.len()];
        for _ in 0..self.blocks {
            for (sum, &(quality, reference)) in sums.iter_mut().zip(&self.qualities) {
                *sum += rating(quality) - reference.map_or(0.0, &mut rating);
            }
        }
        (sums.into_iter())
            .map(|sum| sum / f64::from(self.blocks))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn study() -> Study {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../protocols/meyer-liu-1992.toml");
        Study::read(&path).unwrap()
    }

    #[test]
    fn without_noise_an_observer_rounds_the_quality() {
        let mut study = study();
        let still = |mean: f64| protocols::NormalParameter { mean, sd: 0.0 };
        study.protocol.simulation.bias = still(0.0);
        study.protocol.simulation.gain = still(1.0);
        study.protocol.simulation.noise = still(0.0);
        let images = ["a", "b", "c"].map(|id| StimulusId::try_from(id.to_owned()).unwrap());
        let qualities = images.iter().cloned().zip([3.4, 11.0, -2.0]).collect();
        let panel = ObserverPanel::new(&study, &images, &qualities, 1).unwrap();
        assert_eq!(panel.ratings(0, 0), [3.0, 10.0, 0.0]);
    }

    #[test]
    fn ratings_have_the_moments_that_the_protocol_states() {
        // One image in the middle of the scale, where the gain does nothing and the ends are four SD away: a rating is
        // 5 + bias + noise, rounded, so its mean is 5 and its variance .49 + 1.44 + 1/12 (Sheppard's correction).
        let study = study();
        let image = [StimulusId::try_from("a".to_owned()).unwrap()];
        let qualities = BTreeMap::from([(image[0].clone(), 5.0)]);
        let panel = ObserverPanel::new(&study, &image, &qualities, 7).unwrap();
        let n = 20_000_u32;
        let ratings: Vec<f64> = (0..n).map(|subject| panel.ratings(3, subject)[0]).collect();
        let mean = ratings.iter().sum::<f64>() / f64::from(n);
        let variance = ratings.iter().map(|r| (r - mean).powi(2)).sum::<f64>() / f64::from(n);
        // Five standard errors: .010 and .020.
        assert!((mean - 5.0).abs() < 0.05, "{mean}");
        assert!((variance - 2.0133).abs() < 0.1, "{variance}");
    }

    #[test]
    fn a_study_is_the_same_whoever_asks_first_and_unlike_the_next() {
        let image = [StimulusId::try_from("a".to_owned()).unwrap()];
        let qualities = BTreeMap::from([(image[0].clone(), 5.0)]);
        let panel = |seed| ObserverPanel::new(&study(), &image, &qualities, seed).unwrap();
        let of = |seed, study| -> Vec<f64> {
            (0..40)
                .map(|subject| panel(seed).ratings(study, subject)[0])
                .collect()
        };
        assert_eq!(of(1, 2), of(1, 2));
        assert_ne!(of(1, 2), of(1, 3));
        assert_ne!(of(1, 2), of(2, 2));
    }
}
