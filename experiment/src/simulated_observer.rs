//! One simulated observer: ColorVideoVDP's quality seen through a bias, a gain and noise.
//!
//! An observer answers `centre + gain (q - centre) + bias + noise`, rounded and held to the scale, with *q*
//! the image's quality on the scale and `centre` its middle. Bias and gain are the observer's, noise is
//! drawn for each trial. Source of the form: the subject bias and inconsistency of Li, Bampis, Janowski &
//! Katsavounidis (2020), also ITU-T P.910, Annex E; the gain is our addition.

use std::collections::BTreeMap;

use protocols::{
    InputError, ModelObserver, NormalParameter, Protocol, Scale, Stimuli, StimulusId, SubjectId,
};

use crate::random::Random;
use crate::sidecar::ModelTraits;
use crate::{
    Answer, Button, Event, ExperimentError, First, Key, Quality, Response, Rules, Screen, Session,
    Trial,
};

/// The virtual screen's frame time.
const FRAME_S: f64 = 1.0 / 60.0;

/// A simulated observer and its random numbers.
#[derive(Clone, Debug)]
pub(crate) struct SimulatedObserver {
    subject: SubjectId,
    model: ModelObserver,
    rules: Rules,
    stimuli: Stimuli,
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
            stimuli: protocol.stimuli.clone(),
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
        let break_s = self.rules.breaks.map_or(0.0, |breaks| breaks.seconds);
        let per_trial_s = 10.0 * (self.rules.exposure_s + self.rules.pause_s + 1.0) + break_s;
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
            let is_waiting = match session.screen() {
                Screen::Rating => !session.is_shown(),
                _ => session.needs_frames(),
            };
            if is_waiting && session.to_save().is_none() {
                continue;
            }
            if let Some(answer) = session.to_save().copied() {
                answers.push(answer);
                session.on(Event::Saved, now_s);
            } else if session.screen() == Screen::Rating {
                let trial = &trials[session.rated()];
                now_s += libm::exp(draw(&mut self.random, self.model.ln_response_time)) - FRAME_S;
                self.answer(&mut session, trial, qualities, now_s)?;
                answers.extend(session.to_save().copied());
                session.on(Event::Saved, now_s);
            } else if session.screen().picture().is_none() {
                session.on(Event::Key(Key::Enter), now_s);
            }
        }
        Ok(SimulatedSession {
            answers,
            ended_s: now_s,
        })
    }

    /// Answers by a click, or by a number for each bar in the order of the pictures.
    fn answer(
        &mut self,
        session: &mut Session,
        trial: &Trial,
        qualities: &BTreeMap<StimulusId, Quality>,
        at_s: f64,
    ) -> Result<(), InputError> {
        let rating = self.rating(&trial.stimulus_id, qualities)?;
        let mut marks = vec![rating];
        if self.rules.marks() == 2 {
            let reference = self.stimuli.reference_of(&trial.stimulus_id);
            let reference = reference.unwrap_or_else(|| trial.stimulus_id.clone());
            let reference = self.rating(&reference, qualities)?;
            let first = usize::from(trial.first == First::Test);
            marks.insert(first, reference);
        }
        let click = |session: &mut Session, button: Button| {
            session.on(Event::Press(Some(button)), at_s);
            session.on(Event::Release(Some(button)), at_s);
        };
        if !Response::has_bars(self.rules.response) {
            click(session, Button::Rating(rating));
            return Ok(());
        }
        for (bar, mark) in marks.into_iter().enumerate() {
            click(session, Button::Bar(bar, mark));
        }
        click(session, Button::Continue);
        Ok(())
    }

    fn rating(
        &mut self,
        id: &StimulusId,
        qualities: &BTreeMap<StimulusId, Quality>,
    ) -> Result<i32, InputError> {
        let quality = qualities.get(id).ok_or_else(|| {
            InputError::new(
                "manifest.json",
                "no such entry",
                format!("the stimulus {id}"),
            )
        })?;
        let scale = self.rules.scale;
        let noise = draw(&mut self.random, self.model.noise);
        let ModelTraits { bias, gain, .. } = self.traits;
        let felt = perceived(scale, quality.on_scale, [bias, gain, noise]);
        Ok(scale.nearest(felt))
    }
}

/// What an observer with this bias and gain would answer on an endless scale, with this noise.
pub(crate) fn perceived(scale: Scale, quality: f64, [bias, gain, noise]: [f64; 3]) -> f64 {
    let centre = f64::midpoint(f64::from(scale.lowest), f64::from(scale.highest));
    centre + gain * (quality - centre) + bias + noise
}

pub(crate) fn draw(random: &mut Random, parameter: NormalParameter) -> f64 {
    parameter.mean + parameter.sd * random.normal()
}
