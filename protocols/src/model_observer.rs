//! The part of a protocol that says what a simulated observer is.

use serde::{Deserialize, Serialize};

/// A simulated observer: ColorVideoVDP's quality, seen through one person's bias, gain and noise.
///
/// With *q* the quality in JOD against the ten anchor, rescaled so that the anchors lie at the ends of the
/// scale, an observer answers `round(centre + gain (q - centre) + bias + noise)`, held to the scale;
/// `centre` is the middle of the scale. Bias and gain are drawn once for each observer, noise for each
/// trial.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelObserver {
    /// The peak luminance of the modelled display.
    pub peak_luminance_cd_m2: f64,
    /// Added to every rating of one observer, in steps of the scale.
    pub bias: NormalParameter,
    /// Stretches one observer's ratings about the middle of the scale.
    pub gain: NormalParameter,
    /// Added to each rating, in steps of the scale.
    pub noise: NormalParameter,
    /// How long the observer takes to answer, as the mean and SD of its natural logarithm (of seconds).
    pub ln_response_time: NormalParameter,
}

/// The mean and standard deviation of a normal distribution.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NormalParameter {
    /// The mean.
    pub mean: f64,
    /// The standard deviation; zero for a constant.
    pub sd: f64,
}

impl ModelObserver {
    pub(crate) fn fault(&self) -> Option<(&'static str, String, &'static str)> {
        let peak = self.peak_luminance_cd_m2;
        if !(peak.is_finite() && (1.0..=10_000.0).contains(&peak)) {
            let expected = "a luminance from 1 to 10000 cd/m2";
            return Some((
                "simulation.peak_luminance_cd_m2",
                peak.to_string(),
                expected,
            ));
        }
        let parameters = [
            ("simulation.bias", self.bias),
            ("simulation.gain", self.gain),
            ("simulation.noise", self.noise),
            ("simulation.ln_response_time", self.ln_response_time),
        ];
        parameters
            .into_iter()
            .find(|(_, parameter)| {
                !(parameter.mean.is_finite() && parameter.sd.is_finite() && parameter.sd >= 0.0)
            })
            .map(|(field, parameter)| {
                let found = format!("mean {} and SD {}", parameter.mean, parameter.sd);
                (field, found, "finite numbers, and an SD of zero or more")
            })
    }
}
