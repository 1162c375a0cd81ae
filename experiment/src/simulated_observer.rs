//! One simulated observer: ColorVideoVDP's quality seen through a bias, a gain and noise.
//!
//! An observer answers `centre + gain (q - centre) + bias + noise`, rounded and held to the scale, with *q*
//! the image's quality on the scale and `centre` its middle. Bias and gain are the observer's, noise is
//! drawn for each trial. Source of the form: the subject bias and inconsistency of Li, Bampis, Janowski &
//! Katsavounidis (2020), also ITU-T P.910, Annex E; the gain is our addition.

use std::collections::BTreeMap;

use protocols::{InputError, ModelObserver, NormalParameter, Protocol, StimulusId, SubjectId};

use crate::random::Random;
use crate::sidecar::ModelTraits;
use crate::{Answer, Button, Event, ExperimentError, Key, Quality, Rules, Screen, Session, Trial};

/// The virtual screen's frame time.
const FRAME_S: f64 = 1.0 / 60.0;

/// A simulated observer and its random numbers.
#[derive(Clone, Debug)]
pub(crate) struct SimulatedObserver {
    subject: SubjectId,
    model: ModelObserver,
    rules: Rules,
    traits: ModelTraits,
    random: Random,
}

/// A whole simulated session.
#[derive(Clone, Debug)]
pub(crate) struct SimulatedSession {
    pub(crate) answers: Vec<Answer>,
    pub(crate) ended_s: f64,
}

impl SimulatedObserver {
    pub(crate) fn new(protocol: &Protocol, subject: &SubjectId, seed: u64) -> Self {
        let purpose = format!("acuity model observer 1, seed {seed}, subject {subject}");
        let mut random = Random::keyed_by(&purpose);
        let model = protocol.simulation;
        let bias = draw(&mut random, model.bias);
        let gain = draw(&mut random, model.gain);
        Self {
            subject: subject.clone(),
            model,
            rules: Rules::of(&protocol.session),
            traits: ModelTraits { seed, bias, gain },
            random,
        }
    }

    pub(crate) fn traits(&self) -> ModelTraits {
        self.traits
    }

    /// Sits the whole session, answering each trial by a click on the scale.
    pub(crate) fn sit(
        mut self,
        trials: &[Trial],
        qualities: &BTreeMap<StimulusId, Quality>,
    ) -> Result<SimulatedSession, ExperimentError> {
        let mut session = Session::new(trials.to_vec(), 0, self.rules);
        let mut answers = Vec::new();
        let mut now_s = 0.0;
        // Text screens, pauses and exposures, twice over, at 60 frames a second.
        let per_trial_s = 4.0 * (self.rules.exposure_s + self.rules.pause_s + 1.0);
        let most_frames = 60.0 * (per_trial_s * 2.0 * (trials.len() + 2) as f64);
        let mut frames = 0.0;
        while session.ending().is_none() {
            session.on(Event::Frame, now_s);
            now_s += FRAME_S;
            frames += 1.0;
            if frames > most_frames {
                return Err(ExperimentError::Stuck {
                    subject: self.subject,
                });
            }
            if session.needs_frames() && session.to_save().is_none() {
                continue;
            }
            match session.screen() {
                Screen::Rating => {
                    let trial = &trials[session.rated()];
                    now_s +=
                        libm::exp(draw(&mut self.random, self.model.ln_response_time)) - FRAME_S;
                    let button = Some(Button::Rating(self.rating(trial, qualities)?));
                    session.on(Event::Press(button), now_s);
                    session.on(Event::Release(button), now_s);
                    answers.extend(session.to_save().copied());
                    session.on(Event::Saved, now_s);
                }
                Screen::Instructions | Screen::PracticeOver | Screen::Thanks => {
                    session.on(Event::Key(Key::Enter), now_s);
                }
                Screen::Blank | Screen::Exposure(..) | Screen::ConfirmStop => {}
            }
        }
        Ok(SimulatedSession {
            answers,
            ended_s: now_s,
        })
    }

    fn rating(
        &mut self,
        trial: &Trial,
        qualities: &BTreeMap<StimulusId, Quality>,
    ) -> Result<i32, InputError> {
        let id = &trial.stimulus_id;
        let quality = qualities.get(id).ok_or_else(|| {
            InputError::new(
                "manifest.json",
                "no such entry",
                format!("the stimulus {id}"),
            )
        })?;
        let scale = self.rules.scale;
        let centre = f64::midpoint(f64::from(scale.lowest), f64::from(scale.highest));
        let noise = draw(&mut self.random, self.model.noise);
        let ModelTraits { bias, gain, .. } = self.traits;
        Ok(scale.nearest(centre + gain * (quality.on_scale - centre) + bias + noise))
    }
}

fn draw(random: &mut Random, parameter: NormalParameter) -> f64 {
    parameter.mean + parameter.sd * random.normal()
}
