//! What comes before the first trial, as a pure machine: consent, the form, and the screening of the eyes.
//!
//! What holds, whatever is clicked, and the tests check it:
//!
//! 1. nothing comes before consent, and a subject who declines answers nothing more;
//! 2. the form goes on only when every answer can stand;
//! 3. each plate and each letter is answered once, in order; nobody is told whether rightly;
//! 4. a step that was cut off is begun anew, one that was finished is not asked again.
//!
//! Not here: pictures (`color_plate`), files (`intake_files`), the window.

mod color_plate;
mod confusion;
mod digit_mask;
mod letter;
mod score;

use protocols::{ConsentPlan, FormField, ScreeningPlan, SessionPlan, Sha256Digest, SubjectId};

pub use color_plate::{ColorPlate, PlateImage};
pub use confusion::Axis;
pub use letter::{Letter, Side};
pub(crate) use score::PixelAngle;
pub use score::{AxisScore, LetterAnswer, LetterScore, PlateAnswer, ScreeningScore};

/// What a frame shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// The text to agree to.
    Consent,
    /// The questions.
    Form,
    /// The plate with this index.
    Plate(usize),
    /// The letter with this index.
    Letter(usize),
    /// Nothing is left.
    Done,
    /// The subject did not agree, or stopped.
    Left,
}

/// What the subject does.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reply {
    /// Agrees to the text.
    Agree,
    /// Does not, or wants to stop.
    Leave,
    /// Hands in the form.
    HandIn,
    /// Sees this digit, or none.
    Digit(Option<u8>),
    /// Sees this side open, or cannot tell.
    Side(Option<Side>),
}

/// What must be on disk before the next step.
#[derive(Clone, Debug, PartialEq)]
pub enum Finished {
    /// The text with this digest was agreed to.
    Consent(Sha256Digest),
    /// The answers to the form, in the order of its questions.
    Form(Vec<String>),
    /// Every plate and letter was answered.
    Screening(Vec<PlateAnswer>, Vec<LetterAnswer>),
}

/// Which steps were finished in an earlier sitting.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DoneBefore {
    /// The present text was agreed to.
    pub has_consent: bool,
    /// The form was handed in.
    pub has_form: bool,
    /// The screening was finished.
    pub has_screening: bool,
}

/// What comes before the trials of one subject.
#[derive(Clone, Debug)]
pub struct Intake {
    consent: Option<ConsentPlan>,
    form: Vec<FormField>,
    answers: Vec<String>,
    /// Whether a form was handed in that could not stand.
    is_form_refused: bool,
    plates: Vec<ColorPlate>,
    letters: Vec<Letter>,
    plate_answers: Vec<PlateAnswer>,
    letter_answers: Vec<LetterAnswer>,
    steps: Vec<Step>,
    at: usize,
    shown_s: Option<f64>,
}

impl Intake {
    /// What the protocol asks of this subject in this session.
    pub fn new(plan: &SessionPlan, subject: &SubjectId, session: u32, before: DoneBefore) -> Self {
        let screening = plan.screening.as_ref().filter(|_| !before.has_screening);
        let of_screening = |plan: &ScreeningPlan| {
            let key = format!("screening {} {subject} {session}", plan.seed);
            (
                ColorPlate::all_of(&plan.grades, &key),
                Letter::all_of(plan, &key),
            )
        };
        let (plates, letters) = screening.map(of_screening).unwrap_or_default();
        let mut steps = Vec::new();
        if plan.consent.is_some() && !before.has_consent {
            steps.push(Step::Consent);
        }
        if !plan.form.is_empty() && !before.has_form {
            steps.push(Step::Form);
        }
        steps.extend((0..plates.len()).map(Step::Plate));
        steps.extend((0..letters.len()).map(Step::Letter));
        steps.push(Step::Done);
        Self {
            consent: plan.consent.clone(),
            answers: vec![String::new(); plan.form.len()],
            form: plan.form.clone(),
            is_form_refused: false,
            plates,
            letters,
            plate_answers: Vec::new(),
            letter_answers: Vec::new(),
            steps,
            at: 0,
            shown_s: None,
        }
    }

    /// What is on the screen.
    pub fn step(&self) -> Step {
        self.steps.get(self.at).copied().unwrap_or(Step::Left)
    }

    /// The questions, and what is written under each so far.
    pub fn form(&self) -> (&[FormField], &[String]) {
        (&self.form, &self.answers)
    }

    /// What is written under a question.
    pub fn answer_mut(&mut self, index: usize) -> Option<&mut String> {
        self.answers.get_mut(index)
    }

    /// Whether this answer is to be marked as one that cannot stand.
    pub fn is_at_fault(&self, index: usize) -> bool {
        let pair = self.form.get(index).zip(self.answers.get(index));
        self.is_form_refused && pair.is_some_and(|(field, answer)| !field.takes(answer))
    }

    /// The plates.
    pub fn plates(&self) -> &[ColorPlate] {
        &self.plates
    }

    /// The letters.
    pub fn letters(&self) -> &[Letter] {
        &self.letters
    }

    /// A frame with the present step is drawn at this time.
    pub fn shown(&mut self, at_s: f64) {
        self.shown_s.get_or_insert(at_s);
    }

    /// Takes what the subject did; what is finished by it must be put on disk at once.
    pub fn reply(&mut self, reply: Reply, at_s: f64) -> Option<Finished> {
        let response_time_s = at_s - self.shown_s?;
        match (self.step(), reply) {
            (Step::Done | Step::Left, _) => None,
            (_, Reply::Leave) => {
                self.at = usize::MAX;
                None
            }
            (Step::Consent, Reply::Agree) => {
                self.next();
                let consent = self.consent.as_ref()?;
                Some(Finished::Consent(consent.sha256()))
            }
            (Step::Form, Reply::HandIn) => self.hand_in(),
            (Step::Plate(index), Reply::Digit(digit)) => {
                let plate = self.plates.get(index)?;
                let answer = PlateAnswer::new(plate, digit, response_time_s);
                self.plate_answers.push(answer);
                self.next();
                self.screening()
            }
            (Step::Letter(index), Reply::Side(side)) => {
                let letter = *self.letters.get(index)?;
                let answer = LetterAnswer::new(letter, side, response_time_s);
                self.letter_answers.push(answer);
                self.next();
                self.screening()
            }
            _ => None,
        }
    }

    fn hand_in(&mut self) -> Option<Finished> {
        let mut pairs = self.form.iter().zip(&self.answers);
        self.is_form_refused = !pairs.all(|(field, answer)| field.takes(answer));
        if self.is_form_refused {
            return None;
        }
        self.next();
        let answers = self.answers.iter().map(|answer| answer.trim().to_owned());
        Some(Finished::Form(answers.collect()))
    }

    /// The screening, if this was its last answer.
    fn screening(&self) -> Option<Finished> {
        let is_over = self.step() == Step::Done;
        is_over
            .then(|| Finished::Screening(self.plate_answers.clone(), self.letter_answers.clone()))
    }

    fn next(&mut self) {
        self.at += 1;
        self.shown_s = None;
    }
}

#[cfg(test)]
mod tests;
