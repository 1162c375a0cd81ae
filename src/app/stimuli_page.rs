//! The stimuli: made here, stopped here, looked at here.

use eframe::egui::{Ui, vec2};
use renderer::{RendererError, Stage, Step, Watch};

use super::fault::Fault;
use super::gallery::Gallery;
use super::job::{Job, WhenDropped};
use super::look::{self, Enabled};
use super::page::{Around, Asked};
use super::study_state::{Mark, StimuliState, StudyState};
use crate::render;

/// How a run ended.
enum Outcome {
    Made { warnings: Vec<String> },
    Stopped { rays: u64, of_rays: u64 },
    Failed(Fault),
}

/// A run, and the first step that was seen of it.
struct Making {
    job: Job<Outcome>,
    began: Option<(f64, u64)>,
}

/// The page.
#[derive(Default)]
pub(crate) struct StimuliPage {
    making: Option<Making>,
    outcome: Option<Outcome>,
    gallery: Gallery,
}

impl StimuliPage {
    /// Whether images are being made.
    pub(crate) fn is_busy(&self) -> bool {
        self.making.is_some()
    }

    /// Takes what a run has come to.
    pub(crate) fn poll(&mut self) -> Asked {
        let answer = self.making.as_ref().and_then(|making| making.job.poll());
        let Some(answer) = answer else {
            return Asked::Nothing;
        };
        self.making = None;
        self.gallery = Gallery::default();
        self.outcome = Some(answer.unwrap_or_else(Outcome::Failed));
        Asked::ReadAgain
    }

    pub(crate) fn show(&mut self, ui: &mut Ui, around: Around<'_>) {
        look::page_head(ui, "Stimuli", &what_is_made(around.state));
        look::card(ui, |ui| self.state(ui, around));
        match &self.outcome {
            Some(Outcome::Failed(fault)) => look::fault(ui, fault),
            Some(Outcome::Made { warnings }) if !warnings.is_empty() => {
                look::card(ui, |ui| {
                    look::title(ui, "What the scene asks for in vain");
                    for warning in warnings {
                        ui.label(warning);
                    }
                });
            }
            _ => {}
        }
        if self.making.is_none() {
            match &around.state.stimuli {
                StimuliState::Ready { .. } => self.gallery.show(ui, around.state),
                StimuliState::Older(fault) => look::fault(ui, fault),
                StimuliState::Damaged(faults) => {
                    for fault in faults.iter().take(5) {
                        look::fault(ui, fault);
                    }
                }
                StimuliState::NotMade => {}
            }
        }
    }

    /// The state, and the button or the bar.
    fn state(&mut self, ui: &mut Ui, around: Around<'_>) {
        if let Some(making) = &mut self.making {
            making.show(ui);
            return;
        }
        let (mark, words) = around.state.of(super::study_state::Step::Stimuli);
        look::state(ui, mark, &words);
        if let Some(Outcome::Stopped { rays, of_rays }) = self.outcome {
            let words = format!(
                "Stopped after {rays} of {of_rays} rays. They are kept: the next run goes on from there."
            );
            ui.label(words);
        }
        let button = if mark == Mark::Done {
            let button = look::secondary(ui, around.hold.is_none().into(), "Make them again");
            button.on_hover_text("The same protocol gives the same images, byte for byte.")
        } else {
            look::primary(ui, around.hold.is_none().into(), "Make the stimuli")
        };
        match (around.hold, &around.state.stimuli) {
            (Some(reason), _) => look::weak(ui, reason),
            (None, StimuliState::Damaged(_) | StimuliState::Older(_)) => look::weak(
                ui,
                "This mends what is said below: the same protocol gives the same images, byte for byte.",
            ),
            (None, _) => {}
        }
        if button.clicked() {
            self.start(ui, around.state);
        }
    }

    fn start(&mut self, ui: &Ui, state: &StudyState) {
        let (study, out) = (state.study.clone(), state.folders.stimuli.clone());
        self.outcome = None;
        let job = Job::start(ui.ctx(), WhenDropped::Await, move |worker| {
            let told = |step| worker.tell(step);
            let watch = Watch::new(&told, worker.is_cancelled());
            match render::make(&study, &out, None, &watch) {
                Ok(made) => Outcome::Made {
                    warnings: made.warnings,
                },
                Err(RendererError::Interrupted { rays, of_rays, .. }) => {
                    Outcome::Stopped { rays, of_rays }
                }
                Err(error) => Outcome::Failed(Fault::of(error)),
            }
        });
        self.making = Some(Making { job, began: None });
    }
}

impl Making {
    /// The bar, what is counted, how fast, and the button that ends it.
    fn show(&mut self, ui: &mut Ui) {
        let now_s = ui.input(|input| input.time);
        let step = self.job.step();
        let (part, words) = match step {
            None => (0.0, "Reading the scene".to_owned()),
            Some(step) => {
                if step.stage == Stage::Rays && self.began.is_none() {
                    self.began = Some((now_s, step.done));
                }
                let part = step.done as f32 / step.total.max(1) as f32;
                (part, self.in_words(step, now_s))
            }
        };
        ui.label(words);
        look::bar(ui, vec2(ui.available_width(), 6.0), part, "Progress");
        ui.add_space(2.0);
        let is_enabled = Enabled::from(!self.job.is_cancelled());
        if look::secondary(ui, is_enabled, "Stop").clicked() {
            self.job.cancel();
        }
    }

    fn in_words(&self, step: Step, now_s: f64) -> String {
        let (done, total) = (grouped(step.done), grouped(step.total));
        match (step.stage, self.began) {
            (Stage::Images, _) => format!("Writing the images: {done} of {total}"),
            (Stage::Rays, Some((since_s, first))) if now_s > since_s => {
                let rate = (step.done - first) as f64 / (now_s - since_s);
                let left_s = step.total.saturating_sub(step.done) as f64 / rate.max(1.0);
                let rate = rate / 1000.0;
                format!("Tracing: {done} of {total} rays, {rate:.0}K rays/s, {left_s:.0} s left")
            }
            (Stage::Rays, _) => format!("Tracing: {done} of {total} rays"),
        }
    }
}

/// Where the images come from.
fn what_is_made(state: &StudyState) -> String {
    let images = state.study.protocol.stimuli.images().len();
    match state.study.scene_path() {
        Ok(scene) => {
            let name = scene.file_name().unwrap_or_default().to_string_lossy();
            format!(
                "{images} images of the scene {name}, in {}",
                state.folders.stimuli.display()
            )
        }
        Err(_) => format!(
            "{images} pictures of your own, in {}",
            state.folders.stimuli.display()
        ),
    }
}

/// The number with its thousands apart.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push('\u{a0}');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_stand_apart() {
        let spaced = |number| grouped(number).replace('\u{a0}', " ");
        assert_eq!(spaced(0), "0");
        assert_eq!(spaced(999), "999");
        assert_eq!(spaced(140_000), "140 000");
        assert_eq!(spaced(1_234_567), "1 234 567");
    }
}
