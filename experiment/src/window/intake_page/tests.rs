//! The pages as a subject or a screen reader meets them: by the names of their widgets, by mouse, by keyboard.

use std::cell::RefCell;
use std::rc::Rc;

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use super::*;
use crate::common::small_study;
use crate::{DoneBefore, Finished};

/// The pages in a window of this size, and what was finished on them.
struct Pages {
    harness: Harness<'static>,
    intake: Rc<RefCell<Intake>>,
    finished: Rc<RefCell<Vec<Finished>>>,
}

fn plan() -> SessionPlan {
    let folder = tempfile::tempdir().unwrap();
    let mut plan = small_study(folder.path()).protocol.session;
    plan.consent = toml::from_str("text = \"You may stop at any time.\"").ok();
    let age = "key = \"age\"\nlabel = \"How old are you?\"\nkind = \"number\"\nlowest = 18";
    let eyes =
        "key = \"eyes\"\nlabel = \"Glasses?\"\nkind = \"choice\"\nchoices = [\"yes\", \"no\"]";
    plan.form = [age, eyes].map(|text| toml::from_str(text).unwrap()).into();
    plan.screening = toml::from_str("seed = 5\ngrades = [1.0]\nstrokes_px = [3]").ok();
    plan
}

fn pages(before: DoneBefore) -> Pages {
    pages_of(plan(), before)
}

fn pages_of(plan: SessionPlan, before: DoneBefore) -> Pages {
    let intake = Intake::new(&plan, &"S1".parse().unwrap(), 1, before);
    let intake = Rc::new(RefCell::new(intake));
    let finished = Rc::new(RefCell::new(Vec::new()));
    let (inner, told) = (Rc::clone(&intake), Rc::clone(&finished));
    let mut page = IntakePage::default();
    let size = vec2(1280.0, 800.0);
    let harness = Harness::builder().with_size(size).build_ui(move |ui| {
        // The computer need not have a font of every script; the policy holds from the next frame on.
        let tofu = egui::MissingGlyphPolicy::Tofu;
        if ui.ctx().missing_glyph_policy() != tofu {
            ui.ctx().set_missing_glyph_policy(tofu);
            return;
        }
        let geometry = Geometry {
            size_px: size,
            pixels_per_point: 1.0,
        };
        let looks = Looks {
            plan: &plan,
            geometry,
            display: &Display::Srgb,
        };
        let mut intake = inner.borrow_mut();
        let reply = page.show(ui, &looks, &mut intake);
        intake.shown(0.0);
        if let Some(reply) = reply {
            told.borrow_mut().extend(intake.reply(reply, 1.0));
        }
    });
    Pages {
        harness,
        intake,
        finished,
    }
}

impl Pages {
    fn click(&mut self, name: &str) {
        self.harness.get_by_label(name).click();
        self.harness.run();
    }

    fn key(&mut self, key: Key) {
        self.harness.key_press(key);
        self.harness.run();
    }

    fn step(&self) -> Step {
        self.intake.borrow().step()
    }
}

#[test]
fn consent_form_plates_and_letters_by_the_names_of_their_widgets() {
    let mut pages = pages(DoneBefore::default());
    pages.harness.get_by_label("You may stop at any time.");
    pages.click("I agree");
    assert_eq!(pages.step(), Step::Form);
    pages.click("Continue");
    assert_eq!(pages.step(), Step::Form);
    assert_eq!(
        pages
            .harness
            .get_all_by_label("Please check this answer.")
            .count(),
        2
    );
    // The question is the name of its field.
    let age = pages
        .harness
        .get_by_role_and_label(egui::Role::TextInput, "How old are you?");
    age.focus();
    age.type_text("42");
    pages.harness.run();
    pages.click("no");
    pages.click("Continue");
    let answers = Finished::Form(vec!["42".to_owned(), "no".to_owned()]);
    assert_eq!(pages.finished.borrow()[1], answers);

    assert_eq!(pages.step(), Step::Plate(0));
    pages.click("7");
    assert_eq!(pages.step(), Step::Plate(1));
    pages.harness.event(egui::Event::Text("3".to_owned()));
    pages.harness.run();
    pages.click("None");
    pages.click("0");
    assert_eq!(pages.step(), Step::Letter(0));
    pages.click("up");
    pages.key(Key::ArrowLeft);
    assert_eq!(pages.step(), Step::Done);
    let Some(Finished::Screening(plates, letters)) = pages.finished.borrow().last().cloned() else {
        panic!("the screening is over");
    };
    let seen: Vec<_> = plates.iter().map(|answer| answer.seen).collect();
    assert_eq!(seen, [Some(7), Some(3), None, Some(0)]);
    let seen: Vec<_> = letters.iter().map(|answer| answer.seen).collect();
    assert_eq!(seen, [Some(Side::Up), Some(Side::Left)]);
}

#[test]
fn everything_can_be_reached_by_keyboard_alone() {
    let mut pages = pages(DoneBefore::default());
    pages.key(Key::Tab);
    pages.key(Key::Enter);
    assert_eq!(pages.step(), Step::Form, "the first button agrees");
    pages.key(Key::Tab);
    pages.harness.event(egui::Event::Text("50".to_owned()));
    pages.harness.run();
    pages.key(Key::Tab);
    pages.key(Key::Space);
    pages.key(Key::Tab);
    pages.key(Key::Tab);
    pages.key(Key::Space);
    let answers = Finished::Form(vec!["50".to_owned(), "yes".to_owned()]);
    assert_eq!(pages.finished.borrow().last(), Some(&answers));
}

#[test]
fn escape_asks_first_and_goes_back() {
    let mut pages = pages(DoneBefore::default());
    pages.key(Key::Escape);
    assert!(pages.harness.query_by_label("I agree").is_none());
    pages.click("Continue");
    assert_eq!(pages.step(), Step::Consent);
    pages.key(Key::Escape);
    pages.key(Key::Escape);
    pages.harness.get_by_label("I agree");
    pages.key(Key::Escape);
    pages.click("Stop");
    assert_eq!(pages.step(), Step::Left);
    assert!(pages.finished.borrow().is_empty());
}

/// The button of one page and that of the next lie at one place: a press before and a release after push nothing.
#[test]
fn a_press_on_one_page_and_a_release_on_the_next_push_nothing() {
    let before = DoneBefore {
        has_consent: true,
        has_form: true,
        has_screening: false,
    };
    let mut pages = pages(before);
    let place = pages.harness.get_by_label("7").rect().center();
    let pointer = |pressed| egui::Event::PointerButton {
        pos: place,
        button: egui::PointerButton::Primary,
        pressed,
        modifiers: egui::Modifiers::NONE,
    };
    pages.harness.event(egui::Event::PointerMoved(place));
    pages.harness.event(pointer(true));
    pages.harness.run();
    pages.harness.event(egui::Event::Text("3".to_owned()));
    pages.harness.run();
    assert_eq!(pages.step(), Step::Plate(1));
    pages.harness.event(pointer(false));
    pages.harness.run();
    assert_eq!(pages.step(), Step::Plate(1));
}

/// The column of text is .31 of the width on each side of the middle: 243 to 1037 points.
#[test]
fn a_form_that_runs_from_right_to_left_begins_on_the_right() {
    let mut plan = plan();
    plan.texts.form = "שאלות".to_owned();
    plan.form[0].label = "בן כמה אתה".to_owned();
    plan.form[1].label = "Glasses".to_owned();
    let before = DoneBefore {
        has_consent: true,
        ..DoneBefore::default()
    };
    let mut pages = pages_of(plan, before);
    pages.harness.run();
    let side = |name: &str| pages.harness.get_by_label(name).rect();
    assert!((side("שאלות").right() - 1037.0).abs() < 2.0);
    // Its words in the order in which they are drawn, and its field below it on the same side.
    let role = egui::Role::TextInput;
    let age = pages.harness.get_by_role_and_label(role, "אתה כמה בן");
    assert!((age.rect().right() - 1037.0).abs() < 2.0);
    assert!((side("Glasses").left() - 243.0).abs() < 2.0);
}
